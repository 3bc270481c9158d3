/* Good files with random damage: whatever comes out, nothing crashes, and success and errors exclude each other. The
 * address sanitizer sees what a plain run does not. */
#include "tests/importers/gltf/support.h"

#include "base/file.h"
#include "base/hash.h"

enum { MUTATIONS = 2000, SIZE_MAX_MUTATED = 64 * 1024 };

typedef struct mutant {
    unsigned char bytes[SIZE_MAX_MUTATED];
    size_t size;
} mutant;

/* Words that a reader of glTF may stumble over. */
static const char *const words[] = {"-1", "0", "1", "255", "65535", "4294967295", "1e308", "null", "{}", "[]", "\"\"", "true",
                                    "2147483647", "9007199254740992", "\"accessors\"", "[[", "\\u0000", "%2e%2e/", "0.5", "5126",
                                    "5121", "5125", ",", ":", "\"sparse\"", "\"extensions\"", "\"byteStride\": 4,"};

static void replace(mutant *m, size_t at, size_t removed, const void *inserted, size_t count) {
    if (at + removed > m->size) removed = m->size - at;
    if (m->size - removed + count > SIZE_MAX_MUTATED) return;
    memmove(m->bytes + at + count, m->bytes + at + removed, m->size - at - removed);
    memcpy(m->bytes + at, inserted, count);
    m->size = m->size - removed + count;
}

/* Deterministic: number n of seed s is always the same. */
static void mutate(mutant *m, uint32_t s, uint32_t n) {
    uint32_t state = hash_pair(s, n), rounds = 1 + (state & 3);
    for (uint32_t i = 0; i < rounds && m->size; i++) {
        uint32_t kind = hash_triple(state, i, 0) % 6, pick = hash_triple(state, i, 1), more = hash_triple(state, i, 2);
        size_t at = pick % m->size;
        unsigned char byte = (unsigned char)more;
        switch (kind) {
        case 0: m->bytes[at] ^= (unsigned char)(1u << (more & 7)); break;
        case 1: m->bytes[at] = byte; break;
        case 2: replace(m, at, 1 + more % 16, "", 0); break;
        case 3: { /* another number where there is one */
            while (at < m->size && !(m->bytes[at] >= '0' && m->bytes[at] <= '9')) at++;
            size_t end = at;
            while (end < m->size && m->bytes[end] >= '0' && m->bytes[end] <= '9') end++;
            const char *word = words[more % (sizeof words / sizeof *words)];
            replace(m, at, end - at, word, strlen(word));
            break;
        }
        case 4: {
            const char *word = words[more % (sizeof words / sizeof *words)];
            replace(m, at, more % 3, word, strlen(word));
            break;
        }
        default: m->size = kind == 5 && more % 8 == 0 ? at : m->size; /* cut it off */
        }
    }
}

static uint32_t accepted;

static void import_mutant(const mutant *m) {
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = kiln_scene_create();
    kiln_import_options options = {.memory_limit = 16 << 20};
    bool ok = gltf_import_memory("mutant", m->bytes, m->size, NULL, &options, scene, report);
    if (ok == (kiln_report_count(report, KILN_ERROR) > 0)) print_report(report);
    assert_int_equal(ok, kiln_report_count(report, KILN_ERROR) == 0);
    if (ok) ok = kiln_scene_commit(scene, report);
    accepted += ok;
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
}

static kiln_bytes read_seed(const char *name) {
    char path[1024];
    snprintf(path, sizeof path, "%s/gltf/pairs/%s", KILN_TEST_DATA, name);
    kiln_report *report = kiln_report_create();
    kiln_bytes bytes;
    assert_true(file_read(path, SIZE_MAX_MUTATED, &bytes, NULL, report));
    kiln_report_destroy(report);
    return bytes;
}

static void set_lengths(mutant *m) {
    const uint32_t total = (uint32_t)m->size, json = total > 20 ? total - 20 : 0;
    if (m->size >= 12) memcpy(m->bytes + 8, &total, 4);
    if (m->size >= 16) memcpy(m->bytes + 12, &json, 4);
}

static void survive(const char *name, uint32_t seed, bool as_glb) {
    kiln_bytes bytes = read_seed(name);
    static mutant original, m;
    original.size = 0;
    if (as_glb) { /* one chunk of JSON, whose data URIs stay */
        static const uint32_t head[] = {0x46546C67, 2, 0, 0, 0x4E4F534A};
        memcpy(original.bytes, head, sizeof head);
        original.size = sizeof head;
    }
    memcpy(original.bytes + original.size, bytes.data, bytes.size);
    original.size += bytes.size;
    file_free(&bytes);
    accepted = 0;
    for (uint32_t n = 0; n < MUTATIONS; n++) {
        m = original;
        mutate(&m, seed, n);
        if (as_glb && n % 4) set_lengths(&m); /* else the lengths are wrong too */
        import_mutant(&m);
    }
    print_message("  %u of %u mutants of %s were accepted\n", accepted, MUTATIONS, name);
    assert_true(accepted > MUTATIONS / 50 && accepted < MUTATIONS); /* else the damage tests nothing */
}

static void survives_text(void **state) {
    (void)state;
    survive("accessor_sparse_b.gltf", 1, false);
}
static void survives_materials(void **state) {
    (void)state;
    survive("volume_attenuation_color_b.gltf", 2, false);
}
static void survives_glb(void **state) {
    (void)state;
    survive("node_instancing_b.gltf", 3, true);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(survives_text),
        cmocka_unit_test(survives_materials),
        cmocka_unit_test(survives_glb),
    };
    return cmocka_run_group_tests_name("gltf mutations", tests, NULL, NULL);
}
