#include "tests/scene/support.h"

#include <math.h>

#include "scene/material.h"

static void add_pixel(fixture *f) {
    const uint8_t pixel = 0;
    kiln_image_desc image = {.pixels = &pixel, .width = 1, .height = 1, .channels = 1};
    assert_true(kiln_scene_add_image(f->scene, &image, NULL, f->report));
}

/* glTF 2.0, material: the defaults of every property. */
static void defaults_are_gltfs(void **state) {
    fixture *f = *state;
    const kiln_material *m = scene_material(f->scene, 0);
    assert_true(m->base_color.value[1] == 1 && m->metallic.value == 1 && m->roughness.value == 1);
    assert_true(m->ior == 1.5f && m->alpha_cutoff == 0.5f && m->specular.value == 1 && m->emission.value[0] == 0);
    assert_true(m->layers == 0 && m->alpha_mode == KILN_ALPHA_OPAQUE && !m->double_sided);
    kiln_material again = *m;
    assert_true(kiln_scene_add_material(f->scene, &again, NULL, f->report));
    assert_int_equal(kiln_report_size(f->report), 0);
}

static void factors_are_brought_into_their_domain(void **state) {
    fixture *f = *state;
    kiln_material m = kiln_material_default();
    m.name = "odd";
    m.base_color.value[0] = 1.5f;
    m.metallic.value = -1;
    m.roughness.value = NAN;
    m.emission.value[2] = INFINITY;
    m.ior = .5f;
    m.attenuation_distance = INFINITY;
    m.attenuation_color[1] = 2;
    m.normal.value = -3;
    assert_true(kiln_scene_add_material(f->scene, &m, NULL, f->report));
    const kiln_material *k = scene_material(f->scene, 1);
    assert_true(k->base_color.value[0] == 1 && k->metallic.value == 0 && k->roughness.value == 1);
    assert_true(k->emission.value[2] == 0 && k->ior == 1 && k->attenuation_distance == 0);
    assert_true(k->attenuation_color[1] == 1 && k->normal.value == -3);
    assert_true(says(f->report, KILN_WARNING, "material 'odd': base_color", "the factor is 1.5: 1 is used"));
    assert_true(says(f->report, KILN_WARNING, "material 'odd': roughness", "the factor is not a number: 1 is used"));
    assert_true(says(f->report, KILN_WARNING, "material 'odd': emission", "the factor is not a number: 0 is used"));
    assert_true(says(f->report, KILN_WARNING, "material 'odd'", "ior is 0.5: 1 is used"));
    assert_int_equal(kiln_report_count(f->report, KILN_WARNING), 6);
}

/* Every number of a material that is none, in every layer. */
static void no_number_stays_undefined(void **state) {
    fixture *f = *state;
    const float odd[] = {NAN, INFINITY, -INFINITY};
    for (int o = 0; o < 3; o++) {
        kiln_material m = kiln_material_default();
        m.layers = 2 * KILN_LAYER_GLOSSINESS - 1;
        material_parameter p;
        for (int i = 0; i < KILN_MATERIAL_TEXTURES; i++) {
            assert_true(material_parameter_of(&m, i, &p));
            for (int k = 0; k < p.width; k++) ((float *)(uintptr_t)p.values)[k] = odd[o];
        }
        float *const constants[] = {&m.alpha_cutoff, &m.ior, &m.attenuation_distance, &m.anisotropy_rotation,
                                    &m.iridescence_ior, &m.iridescence_thickness[0], &m.iridescence_thickness[1],
                                    &m.dispersion, &m.multiscatter_color[1], &m.scatter_anisotropy};
        enum { CONSTANTS = sizeof constants / sizeof *constants };
        for (int i = 0; i < CONSTANTS; i++) *constants[i] = odd[o];
        assert_true(kiln_scene_add_material(f->scene, &m, NULL, f->report));
        const kiln_material *k = scene_material(f->scene, (kiln_id)o + 1);
        for (int i = 0; i < KILN_MATERIAL_TEXTURES; i++) {
            material_parameter_of(k, i, &p);
            for (int c = 0; c < p.width; c++) assert_true(isfinite(p.values[c]));
        }
        for (int i = 0; i < CONSTANTS; i++) {
            size_t offset = (size_t)((const char *)constants[i] - (const char *)&m);
            assert_true(isfinite(*(const float *)((const char *)k + offset)));
        }
        assert_true(k->iridescence_ior == 1.3f && k->iridescence_thickness[1] == 400 && k->scatter_anisotropy == 0);
        assert_true(k->ior == (odd[o] == INFINITY ? 0 : 1.5f));
    }
}

static void tangents_follow_the_map_that_needs_them(void **state) {
    (void)state;
    kiln_material m = kiln_material_default();
    uint32_t set = 9;
    m.anisotropy.value = 1;
    m.clearcoat_normal.texture = (kiln_texture){.image = 1, .uv_set = 3};
    assert_false(material_tangents(&m, &set)); /* layers that are not there */
    m.layers = KILN_LAYER_CLEARCOAT;
    assert_true(material_tangents(&m, &set) && set == 3);
    m.layers |= KILN_LAYER_ANISOTROPY;
    m.anisotropy.texture = (kiln_texture){.image = 1, .uv_set = 2};
    assert_true(material_tangents(&m, &set) && set == 2);
    m.normal.texture = (kiln_texture){.image = 1, .uv_set = 1};
    assert_true(material_tangents(&m, &set) && set == 1);
}

static void some_values_outside_the_unit_are_meant(void **state) {
    fixture *f = *state;
    kiln_material m = kiln_material_default();
    m.ior = 0; /* infinity */
    m.layers = KILN_LAYER_UNLIT;
    m.base_color.value[0] = 12; /* radiance */
    m.specular_color.value[0] = 3;
    m.emission.value[0] = 1e6f;
    assert_true(kiln_scene_add_material(f->scene, &m, NULL, f->report));
    const kiln_material *k = scene_material(f->scene, 1);
    assert_true(k->ior == 0 && k->base_color.value[0] == 12 && k->specular_color.value[0] == 3 &&
                k->emission.value[0] == 1e6f);
    assert_int_equal(kiln_report_size(f->report), 0);
}

static void textures_become_explicit(void **state) {
    fixture *f = *state;
    add_pixel(f);
    kiln_material m = kiln_material_default();
    m.base_color.texture.image = 1;
    m.normal.texture = (kiln_texture){.image = 1, .transform = {NAN, 0, 0, 0, 1, 0}};
    m.emission.texture = (kiln_texture){.image = 1, .transform = {2, 0, 0, 0, 3, 0}};
    assert_true(kiln_scene_add_material(f->scene, &m, NULL, f->report));
    const kiln_material *k = scene_material(f->scene, 1);
    const float identity[6] = {1, 0, 0, 0, 1, 0}, scaled[6] = {2, 0, 0, 0, 3, 0};
    assert_memory_equal(k->base_color.texture.transform, identity, sizeof identity);
    assert_memory_equal(k->normal.texture.transform, identity, sizeof identity);
    assert_memory_equal(k->emission.texture.transform, scaled, sizeof scaled);
    assert_true(says(f->report, KILN_WARNING, "material 'default': normal", "the texture transform is not finite"));
    const kiln_texture *used[KILN_MATERIAL_TEXTURES];
    assert_int_equal(material_textures(k, used), 3);
    assert_ptr_equal(used[0], &k->base_color.texture);
    assert_ptr_equal(used[2], &k->emission.texture);
}

static void references_and_choices_are_checked(void **state) {
    fixture *f = *state;
    add_pixel(f);
    struct {
        kiln_texture texture;
        const char *what;
    } bad[] = {
        {{.image = 2}, "image 2 does not exist (the scene has 1)"},
        {{.image = 1, .wrap_u = (kiln_wrap)3}, "wrap mode 3"},
        {{.image = 1, .wrap_v = (kiln_wrap)3}, "wrap mode 3"},
        {{.image = 1, .filter = (kiln_filter)2}, "filter 2"},
        {{.image = 1, .transfer = KILN_TRANSFER_COUNT}, "transfer 3"},
        {{.image = 1, .channel = 4}, "channel 4"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        kiln_material m = kiln_material_default();
        m.thickness.texture = bad[i].texture;
        assert_false(kiln_scene_add_material(f->scene, &m, NULL, f->report));
        assert_true(says(f->report, KILN_ERROR, "material 'default': thickness", bad[i].what));
    }
    kiln_material m = kiln_material_default();
    m.layers = 1u << 30;
    assert_false(kiln_scene_add_material(f->scene, &m, NULL, f->report));
    assert_true(says(f->report, KILN_ERROR, "material 'default'", "layers 0x40000000 are unknown"));
    m = kiln_material_default();
    m.alpha_mode = (kiln_alpha_mode)3;
    assert_false(kiln_scene_add_material(f->scene, &m, NULL, f->report));
    assert_int_equal(f->scene->material_count, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        SCENE_TEST(defaults_are_gltfs),
        SCENE_TEST(factors_are_brought_into_their_domain),
        SCENE_TEST(no_number_stays_undefined),
        SCENE_TEST(tangents_follow_the_map_that_needs_them),
        SCENE_TEST(some_values_outside_the_unit_are_meant),
        SCENE_TEST(textures_become_explicit),
        SCENE_TEST(references_and_choices_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
