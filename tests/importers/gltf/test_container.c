#include "tests/importers/gltf/support.h"

#include "importers/gltf/container.h"

enum { JSON = 0x4E4F534A, BIN = 0x004E4942 };

typedef struct bytes {
    unsigned char data[256];
    size_t size;
} bytes;

static void put_u32(bytes *b, uint32_t v) {
    for (int i = 0; i < 4; i++) b->data[b->size++] = (unsigned char)(v >> (8 * i));
}
static void put_chunk(bytes *b, uint32_t type, const char *text, uint32_t size) {
    put_u32(b, size);
    put_u32(b, type);
    memcpy(b->data + b->size, text, size);
    b->size += size;
}
static bytes header(uint32_t version) {
    bytes b = {{0}, 0};
    memcpy(b.data, "glTF", 4);
    b.size = 4;
    put_u32(&b, version);
    put_u32(&b, 0);
    return b;
}
static void set_length(bytes *b, size_t length) {
    bytes v = {{0}, 0};
    put_u32(&v, (uint32_t)length);
    memcpy(b->data + 8, v.data, 4);
}

/* From a copy without room behind the end. */
static bool open_exact(const bytes *b, gltf_container *c, kiln_report *report) {
    kiln_where file = where_root("a.glb");
    static unsigned char *kept;
    free(kept);
    kept = malloc(b->size ? b->size : 1);
    memcpy(kept, b->data, b->size);
    bool ok = container_open(kept, b->size, c, &file, report);
    return ok;
}

static void refuse(const bytes *b, kiln_code code, const char *where, const char *what) {
    kiln_report *report = kiln_report_create();
    gltf_container c;
    assert_false(open_exact(b, &c, report));
    assert_message(report, KILN_ERROR, code, where, what);
    kiln_report_destroy(report);
}

static bytes whole(void) {
    bytes b = header(2);
    put_chunk(&b, JSON, "{}  ", 4);
    put_chunk(&b, BIN, "abcdefgh", 8);
    set_length(&b, b.size);
    return b;
}

static void finds_both_chunks(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    gltf_container c;
    bytes b = whole();
    assert_true(open_exact(&b, &c, report));
    assert_int_equal(c.json_size, 4);
    assert_memory_equal(c.json, "{}  ", 4);
    assert_int_equal(c.binary_size, 8);
    assert_memory_equal(c.binary, "abcdefgh", 8);
    b = header(2); /* without BIN, an unknown chunk, zeros for padding */
    put_chunk(&b, JSON, "{}\0\0", 4);
    put_chunk(&b, 0x12345678, "zzzz", 4);
    set_length(&b, b.size);
    assert_true(open_exact(&b, &c, report));
    assert_int_equal(c.json_size, 2);
    assert_null(c.binary);
    assert_int_equal(kiln_report_size(report), 0);
    kiln_report_destroy(report);
}

static void reads_plain_json(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    gltf_container c;
    bytes b = {"\xEF\xBB\xBF \n{}", 7};
    assert_true(open_exact(&b, &c, report));
    assert_int_equal(c.json_size, 4);
    assert_null(c.binary);
    kiln_report_destroy(report);
}

static void refuses_broken_headers(void **state) {
    (void)state;
    refuse(&(bytes){{0}, 0}, KILN_CODE_FILE_TRUNCATED, "a.glb", "empty");
    refuse(&(bytes){"hello", 5}, KILN_CODE_FILE_FORMAT, "a.glb", "neither");
    refuse(&(bytes){"PK\3\4abcd", 8}, KILN_CODE_FILE_FORMAT, "a.glb", "neither");
    bytes b = whole();
    b.data[4] = 1;
    refuse(&b, KILN_CODE_FILE_FORMAT, "a.glb", "version 1");
    b = whole();
    set_length(&b, b.size + 4);
    refuse(&b, KILN_CODE_FILE_TRUNCATED, "a.glb", "truncated");
    b = whole();
    set_length(&b, 5); /* less than its own header */
    refuse(&b, KILN_CODE_FILE_FORMAT, "a.glb", "5 bytes long");
    b = whole();
    set_length(&b, 14);
    refuse(&b, KILN_CODE_FILE_TRUNCATED, "chunk[0]", "inside a chunk header");
    b = whole();
    b.data[12] = 200;
    refuse(&b, KILN_CODE_FILE_TRUNCATED, "chunk[0]", "200 bytes");
    b = whole();
    memset(b.data + 12, 0xFF, 4);
    refuse(&b, KILN_CODE_FILE_TRUNCATED, "chunk[0]", "4294967295 bytes");
    b = header(2);
    put_chunk(&b, BIN, "abcd", 4);
    set_length(&b, b.size);
    refuse(&b, KILN_CODE_FILE_FORMAT, "chunk[0]", "not JSON");
    b = header(2);
    put_chunk(&b, JSON, "{}  ", 4);
    put_chunk(&b, JSON, "{}  ", 4);
    set_length(&b, b.size);
    refuse(&b, KILN_CODE_FILE_FORMAT, "chunk[1]", "second");
}

static void refuses_every_truncation(void **state) {
    (void)state;
    bytes b = whole();
    for (size_t size = b.size; size-- > 0;) {
        bytes cut = b;
        cut.size = size;
        kiln_report *report = kiln_report_create();
        gltf_container c;
        assert_false(open_exact(&cut, &c, report));
        assert_int_equal(kiln_report_exit_code(report), 3);
        kiln_report_destroy(report);
    }
}

static void warns_of_more_bytes(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    gltf_container c;
    bytes b = whole();
    b.size += 5;
    assert_true(open_exact(&b, &c, report));
    assert_int_equal(c.binary_size, 8);
    assert_message(report, KILN_WARNING, KILN_CODE_FILE_FORMAT, "a.glb", "behind the end");
    kiln_report_destroy(report);
}

static void checks_versions(void **state) {
    (void)state;
    static const struct { const char *asset, *what; kiln_code code; } rows[] = {
        {"'version': '1.0'", "glTF 1.0", KILN_CODE_FILE_FORMAT},
        {"'version': '3.0'", "glTF 3.0", KILN_CODE_FILE_FORMAT},
        {"'version': '2.1', 'minVersion': '2.1'", "reader of glTF 2.1", KILN_CODE_FILE_FORMAT},
        {"'version': 'two'", "a version like", KILN_CODE_SYNTAX},
        {"'version': 2.0", "a version like", KILN_CODE_SYNTAX},
        {"'version': '2'", "a version like", KILN_CODE_SYNTAX},
        {"'version': '2.0x'", "a version like", KILN_CODE_SYNTAX},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char json[200];
        snprintf(json, sizeof json, "{'asset': {%s}}", rows[i].asset);
        for (char *c = json; *c; c++)
            if (*c == '\'') *c = '"';
        import_bad_text(json, rows[i].code, "asset", rows[i].what);
    }
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = import_text("{\"asset\": {\"version\": \"2.1\", \"minVersion\": \"2.0\"}}", report);
    assert_non_null(scene);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
}

/* Of glTF 1.0, where meshes is an object, the version is the message. */
static void names_version_before_types(void **state) {
    (void)state;
    import_bad_text("{\"asset\": {\"version\": \"1.0\"}, \"meshes\": {\"a\": {}}}", KILN_CODE_FILE_FORMAT, "asset", "glTF 1.0");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_both_chunks),        cmocka_unit_test(reads_plain_json),
        cmocka_unit_test(refuses_broken_headers),   cmocka_unit_test(refuses_every_truncation),
        cmocka_unit_test(warns_of_more_bytes),      cmocka_unit_test(checks_versions),
        cmocka_unit_test(names_version_before_types),
    };
    return cmocka_run_group_tests_name("container", tests, NULL, NULL);
}
