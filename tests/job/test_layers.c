/* Layers of EXR files, read back by OpenEXR's own library. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <jansson.h>
#include <openexr.h>

#include "kiln/job.h"
#include "tests/job/support.h"

enum { SIDE = 24, CHANNELS = 96 };

typedef struct layers {
    int count;
    char names[CHANNELS][64];
    float *planes[CHANNELS];
    exr_context_t file;
} layers;

static void read_chunk(layers *l, int y) {
    exr_chunk_info_t chunk;
    exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
    assert_int_equal(exr_read_scanline_chunk_info(l->file, 0, y, &chunk), 0);
    assert_int_equal(exr_decoding_initialize(l->file, 0, &chunk, &decode), 0);
    for (int c = 0; c < decode.channel_count; c++) {
        exr_coding_channel_info_t *to = &decode.channels[c];
        to->user_pixel_stride = to->user_bytes_per_element = 4;
        to->user_line_stride = 4 * SIDE;
        to->user_data_type = EXR_PIXEL_FLOAT;
        to->decode_to_ptr = (uint8_t *)(l->planes[c] + (size_t)y * SIDE);
    }
    assert_int_equal(exr_decoding_choose_default_routines(l->file, 0, &decode), 0);
    assert_int_equal(exr_decoding_run(l->file, 0, &decode), 0);
    exr_decoding_destroy(l->file, &decode);
}

static layers read_layers(const char *path) {
    layers l = {0};
    const exr_attr_chlist_t *list;
    int32_t lines;
    assert_int_equal(exr_start_read(&l.file, path, NULL), 0);
    assert_int_equal(exr_get_channels(l.file, 0, &list) + exr_get_scanlines_per_chunk(l.file, 0, &lines), 0);
    l.count = list->num_channels;
    assert_true(l.count <= CHANNELS);
    for (int c = 0; c < l.count; c++) {
        snprintf(l.names[c], sizeof l.names[c], "%s", list->entries[c].name.str);
        l.planes[c] = calloc(SIDE * SIDE, sizeof(float));
    }
    for (int y = 0; y < SIDE; y += lines) read_chunk(&l, y);
    return l;
}

static void forget(layers *l) {
    for (int c = 0; c < l->count; c++) free(l->planes[c]);
    exr_finish(&l->file);
}

/* NULL: it is not there. */
static const float *plane(const layers *l, const char *layer, const char *channel) {
    char name[80];
    snprintf(name, sizeof name, "%s%s%s", layer, *layer ? "." : "", channel);
    for (int c = 0; c < l->count; c++)
        if (strcmp(l->names[c], name) == 0) return l->planes[c];
    return NULL;
}

static void sum_to_the_picture(const layers *l, const char *const *names) {
    static const char *const channels[] = {"R", "G", "B"};
    for (int k = 0; k < 3; k++) {
        const float *picture = plane(l, "", channels[k]);
        for (int i = 0; i < SIDE * SIDE; i++) {
            float sum = 0;
            for (int n = 0; names[n]; n++) {
                const float *part = plane(l, names[n], channels[k]);
                if (!part) fail_msg("there is no layer %s, but %s", names[n], l->names[l->count - 3]);
                sum += part[i];
            }
            if (memcmp(&sum, &picture[i], sizeof sum) != 0)
                fail_msg("%s and others sum to %a in pixel %d, the picture is %a", names[0], (double)sum, i,
                         (double)picture[i]);
        }
    }
}

/* A room with a lamp, a lit box of metal and glass, and light from outside. */
static void furnish(fixture *f) {
    kiln_material metal = kiln_material_default(), glass = kiln_material_default();
    kiln_light key = kiln_light_default();
    kiln_material floor = kiln_material_default(), lamp = kiln_material_default();
    kiln_id metal_id, glass_id, floor_id, lamp_id;
    floor.name = NULL, floor.metallic.value = 0;
    lamp.name = NULL, lamp.emission.value[0] = lamp.emission.value[1] = 4;
    metal.name = "Chrome", metal.roughness.value = 0.3f;
    glass.name = "Glass", glass.metallic.value = 0, glass.roughness.value = 0, glass.layers = KILN_LAYER_TRANSMISSION;
    glass.transmission.value = 1;
    key.name = "Key.001", key.transform[12] = 2, key.transform[13] = 3, key.transform[14] = 2, key.intensity = 40;
    assert_done(f, kiln_scene_add_material(f->scene, &metal, &metal_id, f->report));
    assert_done(f, kiln_scene_add_material(f->scene, &glass, &glass_id, f->report));
    assert_done(f, kiln_scene_add_material(f->scene, &floor, &floor_id, f->report));
    assert_done(f, kiln_scene_add_material(f->scene, &lamp, &lamp_id, f->report));
    assert_done(f, kiln_scene_add_light(f->scene, &key, NULL, f->report));
    add_box(f, (float[3]){-2, -1.1f, -2}, (float[3]){2, -1, 2}, floor_id);
    add_box(f, (float[3]){-1, -1, -1}, (float[3]){-.2f, 0, 0}, metal_id);
    add_box(f, (float[3]){.2f, -1, 0}, (float[3]){1, 0, 1}, glass_id);
    add_box(f, (float[3]){-1, 1, -1}, (float[3]){1, 1.1f, 1}, lamp_id);
}

static layers shoot(fixture *f, const char *const *options) {
    char path[256];
    kiln_job *job = kiln_job_create();
    furnish(f);
    assert_done(f, kiln_job_set(job, "size", "24x24", f->report) && kiln_job_set(job, "spp", "16", f->report) &&
                       kiln_job_set(job, "env", "studio", f->report) &&
                       kiln_job_set(job, "output", path_in(f, "a.exr", path), f->report));
    for (int i = 0; options[i]; i += 2) assert_done(f, kiln_job_set(job, options[i], options[i + 1], f->report));
    assert_done(f, kiln_job_render_scene(job, f->scene, "room", f->report));
    kiln_job_destroy(job);
    return read_layers(path);
}

static void parts_sum_to_the_picture(void **state) {
    layers l = shoot(*state, (const char *const[]){"aov", "direct,emission,indirect,lobe:*,lightgroup:*", NULL});
    sum_to_the_picture(&l, (const char *const[]){"emission", "direct", "indirect", NULL});
    sum_to_the_picture(&l, (const char *const[]){"specular", "transmission", "emission", "diffuse", "clearcoat", "sheen",
                                                 "translucency", NULL});
    sum_to_the_picture(&l, (const char *const[]){"lightgroup_environment", "lightgroup_Key_001",
                                                 "lightgroup_material_4", NULL});
    assert_int_equal(l.count, 3 * (1 + 3 + 6 + 3));
    forget(&l);
}

static void what_is_left_out_is_one_layer(void **state) {
    layers l = shoot(*state, (const char *const[]){"aov", "direct,lobe:specular,lightgroup:Key.001", "background",
                                                   "#ff0000", NULL});
    sum_to_the_picture(&l, (const char *const[]){"direct", "rest_bounce", NULL});
    sum_to_the_picture(&l, (const char *const[]){"rest_lobe", "specular", NULL});
    sum_to_the_picture(&l, (const char *const[]){"lightgroup_Key_001", "rest_lightgroup", NULL});
    assert_non_null(plane(&l, "", "A")); /* in place of the colour */
    assert_int_equal(l.count, 4 + 3 * 6);
    forget(&l);
}

static const char *attribute(const layers *l, const char *layer, const char *what) {
    char name[64], id[9];
    const char *text;
    int32_t length;
    snprintf(id, sizeof id, "%08x", kiln_matte_id(layer));
    snprintf(name, sizeof name, "cryptomatte/%.7s/%s", id, what);
    assert_int_equal(exr_attr_get_string(l->file, 0, name, &length, &text), 0);
    return text;
}

/* As a compositor reads it: names from the manifest, shares from pairs of channels. */
static void mattes_are_decoded_by_name(void **state) {
    static const char *const names[] = {"Chrome", "Glass", "material 3", "material 4"};
    layers l = shoot(*state, (const char *const[]){"aov", "cryptomatte,alpha,material", NULL});
    const float *alpha = plane(&l, "alpha", "A"), *material = plane(&l, "material", "Y");
    assert_string_equal(attribute(&l, "cryptoMaterial", "name"), "cryptoMaterial");
    assert_string_equal(attribute(&l, "cryptoMaterial", "hash"), "MurmurHash3_32");
    assert_string_equal(attribute(&l, "cryptoObject", "conversion"), "uint32_to_float32");
    json_t *manifest = json_loads(attribute(&l, "cryptoMaterial", "manifest"), 0, NULL);
    assert_int_equal(json_object_size(manifest), 4);
    float sum[SIDE * SIDE] = {0};
    for (int n = 0; n < 4; n++) {
        uint32_t id = (uint32_t)strtoul(json_string_value(json_object_get(manifest, names[n])), NULL, 16);
        int owned = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            float share = 0;
            for (int r = 0; r < KILN_MATTE_RANKS; r++) {
                char layer[32];
                snprintf(layer, sizeof layer, "cryptoMaterial%02d", r / 2);
                const float *ids = plane(&l, layer, r % 2 ? "B" : "R"), *shares = plane(&l, layer, r % 2 ? "A" : "G");
                assert_true(ids && shares);
                if (memcmp(&ids[i], &id, sizeof id) == 0 && shares[i] > 0) share = shares[i];
            }
            sum[i] += share;
            owned += share > 0.5f;
            if (share > 0.5f) assert_true(material[i] == (float)(n + 2)); /* handle n + 1 */
        }
        assert_true(owned > 0);
    }
    for (int i = 0; i < SIDE * SIDE; i++) assert_true(sum[i] == alpha[i]);
    json_decref(manifest);
    forget(&l);
}

static void a_light_that_is_not_there_is_refused_at_once(void **state) {
    fixture *f = *state;
    kiln_job *job = kiln_job_create();
    furnish(f);
    assert_done(f, kiln_job_set(job, "aov", "lightgroup:Kei.001", f->report));
    char path[256];
    assert_done(f, kiln_job_set(job, "output", path_in(f, "a.exr", path), f->report));
    assert_false(kiln_job_render_scene(job, f->scene, "room", f->report));
    assert_true(says(f->report, "the scene has no light 'lightgroup:Kei_001'"));
    assert_true(says(f->report, "did you mean 'Key_001'? give one of: *, Key_001, material_4, environment"));
    assert_int_equal(kiln_job_last(job).exit_code, 2);
    kiln_job_destroy(job);
}

int main(void) {
    const struct CMUnitTest tests[] = {JOB_TEST(parts_sum_to_the_picture), JOB_TEST(what_is_left_out_is_one_layer),
                                       JOB_TEST(mattes_are_decoded_by_name),
                                       JOB_TEST(a_light_that_is_not_there_is_refused_at_once)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
