#include "tests/importers/gltf/materials.h"

static void has_gltf_defaults(void **state) {
    (void)state;
    const kiln_material *m = material("'name': 'plain'");
    assert_string_equal(m->name, "plain");
    assert_floats(m->base_color.value, (float[]){1, 1, 1}, 3);
    assert_floats((float[]){m->opacity.value, m->metallic.value, m->roughness.value, m->alpha_cutoff, m->ior},
                  (float[]){1, 1, 1, 0.5f, 1.5f}, 5);
    assert_int_equal(m->layers, 0);
    assert_int_equal(m->alpha_mode, KILN_ALPHA_OPAQUE);
    assert_false(m->double_sided);
    assert_int_equal(scene->image_count, 0);
}

/* One image as colour, alpha, metalness, roughness and normals: each use reads its own channel in its own way. */
static void uses_an_image_in_every_role(void **state) {
    (void)state;
    const kiln_material *m = material(
        "'alphaMode': 'BLEND', 'pbrMetallicRoughness': {'baseColorFactor': [0.1, 0.2, 0.3, 0.4], 'metallicFactor': 0.5, "
        "'roughnessFactor': 0.6, 'baseColorTexture': {'index': 0}, 'metallicRoughnessTexture': {'index': 0}}, "
        "'normalTexture': {'index': 0, 'scale': 0.7}, 'occlusionTexture': {'index': 0}, 'emissiveTexture': {'index': 0}, "
        "'emissiveFactor': [0.8, 0.9, 1]");
    assert_int_equal(scene->image_count, 1);
    assert_floats(m->base_color.value, (float[]){0.1f, 0.2f, 0.3f}, 3);
    assert_floats((float[]){m->opacity.value, m->metallic.value, m->roughness.value, m->normal.value},
                  (float[]){0.4f, 0.5f, 0.6f, 0.7f}, 4);
    assert_floats(m->emission.value, (float[]){0.8f, 0.9f, 1}, 3);
    const struct { const kiln_texture *t; kiln_transfer transfer; uint32_t channel; } rows[] = {
        {&m->base_color.texture, KILN_TRANSFER_SRGB, 0}, {&m->opacity.texture, KILN_TRANSFER_DATA, 3},
        {&m->metallic.texture, KILN_TRANSFER_DATA, 2},   {&m->roughness.texture, KILN_TRANSFER_DATA, 1},
        {&m->normal.texture, KILN_TRANSFER_DATA, 0},     {&m->emission.texture, KILN_TRANSFER_SRGB, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(rows[i].t->image, 1);
        assert_int_equal(rows[i].t->transfer, rows[i].transfer);
        assert_int_equal(rows[i].t->channel, rows[i].channel);
        assert_int_equal(rows[i].t->wrap_u, KILN_WRAP_REPEAT);
        assert_int_equal(rows[i].t->filter, KILN_FILTER_LINEAR);
    }
}

static void ignores_alpha_where_opaque(void **state) {
    (void)state;
    const kiln_material *m = material("'pbrMetallicRoughness': {'baseColorFactor': [1, 1, 1, 0.1], 'baseColorTexture': {'index': 0}}");
    assert_floats(&m->opacity.value, (float[]){1}, 1);
    assert_int_equal(m->opacity.texture.image, 0);
    assert_int_equal(m->base_color.texture.image, 1);
}

static void reads_alpha_modes(void **state) {
    (void)state;
    const kiln_material *m = material("'alphaMode': 'MASK', 'alphaCutoff': 0.25, 'doubleSided': true");
    assert_int_equal(m->alpha_mode, KILN_ALPHA_MASK);
    assert_floats(&m->alpha_cutoff, (float[]){0.25f}, 1);
    assert_true(m->double_sided);
    refused("'alphaMode': 'GLASS'", KILN_CODE_RANGE, "materials[0].alphaMode", "\"GLASS\"");
}

static void reads_samplers(void **state) {
    (void)state;
    const kiln_texture *t = &material("'pbrMetallicRoughness': {'baseColorTexture': {'index': 1}}")->base_color.texture;
    assert_int_equal(t->wrap_u, KILN_WRAP_CLAMP);
    assert_int_equal(t->wrap_v, KILN_WRAP_MIRROR);
    assert_int_equal(t->filter, KILN_FILTER_NEAREST);
}

/* magFilter decides; minFilter where there is none. */
static void maps_filters(void **state) {
    (void)state;
    static const struct { const char *sampler; kiln_filter filter; } rows[] = {
        {"", KILN_FILTER_LINEAR}, {"'magFilter': 9728, 'minFilter': 9987", KILN_FILTER_NEAREST},
        {"'magFilter': 9729, 'minFilter': 9728", KILN_FILTER_LINEAR}, {"'minFilter': 9728", KILN_FILTER_NEAREST},
        {"'minFilter': 9729", KILN_FILTER_LINEAR}, {"'minFilter': 9984", KILN_FILTER_NEAREST},
        {"'minFilter': 9985", KILN_FILTER_LINEAR}, {"'minFilter': 9986", KILN_FILTER_NEAREST},
        {"'minFilter': 9987", KILN_FILTER_LINEAR}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char rest[1200];
        snprintf(rest, sizeof rest, "'images': [{'uri': '" PIXEL "'}], 'textures': [{'source': 0, 'sampler': 0}], 'samplers': [{%s}], "
                 TRIANGLE ", 'nodes': [{'mesh': 0}], 'materials': [{'emissiveTexture': {'index': 0}}]", rows[i].sampler);
        scene = import_good(TRIANGLE_DATA, rest);
        assert_int_equal(scene_material(scene, 1)->emission.texture.filter, rows[i].filter);
        if (i + 1 < sizeof rows / sizeof *rows) kiln_scene_destroy(scene);
    }
}

#define TRANSFORMED(transform) \
    "'emissiveTexture': {'index': 0, 'texCoord': 1, 'extensions': {'KHR_texture_transform': {" transform "}}}"

/* The extension's two examples, as pictures: what the corners of the UV square are mapped to. */
static void transforms_textures(void **state) {
    (void)state;
    const kiln_texture *t = &material(TRANSFORMED("'offset': [0, 1], 'rotation': 1.57079632679, 'scale': [0.5, 0.5]"))->emission.texture;
    /* "the lower left quadrant of the source image, rotated clockwise 90°": the upper left corner of the surface shows
     * the quadrant's lower left one, its upper right corner the upper left one. */
    const float corners[4][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}}, expected[4][2] = {{0, 1}, {0, 0.5f}, {0.5f, 1}, {0.5f, 0.5f}};
    for (int i = 0; i < 4; i++) {
        const float *m = t->transform, u = corners[i][0], v = corners[i][1];
        const float mapped[2] = {m[0] * u + m[1] * v + m[2], m[3] * u + m[4] * v + m[5]};
        assert_floats(mapped, expected[i], 2);
    }
    assert_int_equal(t->uv_set, 1);
    kiln_scene_destroy(scene);
    /* Khronos' TextureTransformTest: the tip of its arrow, at 0.7778 in u and v, belongs on the mark "correct". */
    t = &material(TRANSFORMED("'rotation': 0.39269908169872414"))->emission.texture;
    const float *r = t->transform, mark[2] = {0.5f - 0.0790482f, 0.5f + 0.5162675f};
    assert_true(fabsf(r[0] * mark[0] + r[1] * mark[1] - 0.7778174f) < 1e-5f);
    assert_true(fabsf(r[3] * mark[0] + r[4] * mark[1] - 0.7778174f) < 1e-5f);
    kiln_scene_destroy(scene);
    t = &material(TRANSFORMED("'offset': [0, 1], 'scale': [1, -1], 'texCoord': 0"))->emission.texture; /* T inverted */
    assert_floats(t->transform, (float[]){1, 0, 0, 0, -1, 1}, 6);
    assert_int_equal(t->uv_set, 0);
    kiln_scene_destroy(scene);
    t = &material(TRANSFORMED("'rotation': 0.5, 'scale': [2, 3], 'offset': [4, 5]"))->emission.texture; /* scale first */
    const float c = cosf(0.5f), s = sinf(0.5f);
    assert_floats(t->transform, (float[]){2 * c, 3 * s, 4, -2 * s, 3 * c, 5}, 6);
    refused(TRANSFORMED("'offset': [1]"), KILN_CODE_SYNTAX, "emissiveTexture.extensions.KHR_texture_transform.offset", "2 numbers");
    refused(TRANSFORMED("'rotation': 'x'"), KILN_CODE_SYNTAX, "KHR_texture_transform.rotation", "a number");
    refused(TRANSFORMED("'texCoord': 40"), KILN_CODE_LIMIT, "materials[0].emissiveTexture", "TEXCOORD_40");
}

static void reads_emissive_strength(void **state) {
    (void)state;
    const kiln_material *m = material("'emissiveFactor': [1, 0.5, 0], " EXTENDED("KHR_materials_emissive_strength", "'emissiveStrength': 8"));
    assert_floats(m->emission.value, (float[]){8, 4, 0}, 3);
}

static void reads_ior(void **state) {
    (void)state;
    assert_floats(&material(EXTENDED("KHR_materials_ior", "'ior': 1.33"))->ior, (float[]){1.33f}, 1);
    kiln_scene_destroy(scene);
    assert_floats(&material(EXTENDED("KHR_materials_ior", "'ior': 0"))->ior, (float[]){0}, 1);
    kiln_scene_destroy(scene);
    assert_floats(&material(EXTENDED("KHR_materials_ior", ""))->ior, (float[]){1.5f}, 1);
    refused(EXTENDED("KHR_materials_ior", "'ior': '2'"), KILN_CODE_SYNTAX, "materials[0].extensions.KHR_materials_ior.ior", "a number");
}

static void reads_specular(void **state) {
    (void)state;
    const kiln_material *m = material(EXTENDED("KHR_materials_specular", "'specularFactor': 0.4, 'specularTexture': {'index': 0}, "
                                               "'specularColorFactor': [0.1, 2, 3], 'specularColorTexture': {'index': 1, 'texCoord': 2}"));
    assert_floats(&m->specular.value, (float[]){0.4f}, 1);
    assert_floats(m->specular_color.value, (float[]){0.1f, 2, 3}, 3);
    assert_int_equal(m->specular.texture.channel, 3);
    assert_int_equal(m->specular.texture.transfer, KILN_TRANSFER_DATA);
    assert_int_equal(m->specular_color.texture.transfer, KILN_TRANSFER_SRGB);
    assert_int_equal(m->specular_color.texture.uv_set, 2);
    assert_int_equal(m->specular_color.texture.wrap_u, KILN_WRAP_CLAMP);
    refused(EXTENDED("KHR_materials_specular", "'specularTexture': {'index': 7}"), KILN_CODE_REFERENCE,
            "KHR_materials_specular.specularTexture.index", "texture 7 does not exist (the file has 2)");
}

static void reads_glass(void **state) {
    (void)state;
    const kiln_material *m = material("'extensions': {'KHR_materials_transmission': {'transmissionFactor': 0.9, 'transmissionTexture': "
                                      "{'index': 0}}, 'KHR_materials_volume': {'thicknessFactor': 2, 'thicknessTexture': {'index': 0}, "
                                      "'attenuationDistance': 0.25, 'attenuationColor': [0.1, 0.2, 0.3]}}");
    assert_int_equal(m->layers, KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME);
    assert_floats((float[]){m->transmission.value, m->thickness.value, m->attenuation_distance}, (float[]){0.9f, 2, 0.25f}, 3);
    assert_floats(m->attenuation_color, (float[]){0.1f, 0.2f, 0.3f}, 3);
    assert_int_equal(m->transmission.texture.channel, 0);
    assert_int_equal(m->thickness.texture.channel, 1);
    kiln_scene_destroy(scene);
    m = material("'extensions': {'KHR_materials_transmission': {}, 'KHR_materials_volume': {}}"); /* infinitely far: clear */
    assert_floats((float[]){m->thickness.value, m->attenuation_distance}, (float[]){0, 0}, 2);
    kiln_scene_destroy(scene);
    m = warned("'extensions': {'KHR_materials_transmission': {}, 'KHR_materials_volume': {'attenuationDistance': 0}}",
               KILN_CODE_RANGE, "KHR_materials_volume", "positive");
    assert_floats(&m->attenuation_distance, (float[]){0}, 1);
}

static void reads_unlit(void **state) {
    (void)state;
    assert_int_equal(material(EXTENDED("KHR_materials_unlit", ""))->layers, KILN_LAYER_UNLIT);
}

static void checks_textures(void **state) {
    (void)state;
    refused("'normalTexture': {'index': 12}", KILN_CODE_REFERENCE, "materials[0].normalTexture.index",
            "texture 12 does not exist (the file has 2)");
    refused("'occlusionTexture': {'index': 12}", KILN_CODE_REFERENCE, "materials[0].occlusionTexture.index", "texture 12");
    import_bad(NULL, 0, "'images': [], 'textures': [{'source': 0}]", KILN_CODE_REFERENCE, "textures[0].source", "image 0");
    import_bad(TRIANGLE_DATA, TRIANGLE_VIEWS "'images': [{'uri': 'a.png', 'bufferView': 0}]", KILN_CODE_SYNTAX, "images[0]",
               "both uri and bufferView");
    import_bad(NULL, 0, "'textures': [{'sampler': 1}]", KILN_CODE_REFERENCE, "textures[0].sampler", "sampler 1");
    import_bad(NULL, 0, "'images': [{'uri': '" PIXEL "'}], 'textures': [{'source': 0, 'sampler': 0}], 'samplers': [{'wrapS': 1}], "
               "'materials': [{'emissiveTexture': {'index': 0}}]", KILN_CODE_RANGE, "samplers[0].wrapS", "1 is no wrap mode");
    scene = import_warned(NULL, 0, "'textures': [{}], 'materials': [{'emissiveTexture': {'index': 0}}]", KILN_CODE_IMAGE,
                          "textures[0]", "no image that kiln reads");
    assert_int_equal(scene_material(scene, 1)->emission.texture.image, 0);
}

/* Factors outside their domain are the scene's to mend; the place is the file's. */
static void locates_bad_factors(void **state) {
    (void)state;
    const kiln_material *m = warned("'pbrMetallicRoughness': {'roughnessFactor': 7}", KILN_CODE_RANGE, "test.gltf: materials[0]", "7");
    assert_floats(&m->roughness.value, (float[]){1}, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(has_gltf_defaults, tear_down),
        cmocka_unit_test_teardown(uses_an_image_in_every_role, tear_down),
        cmocka_unit_test_teardown(ignores_alpha_where_opaque, tear_down),
        cmocka_unit_test_teardown(reads_alpha_modes, tear_down),
        cmocka_unit_test_teardown(reads_samplers, tear_down),
        cmocka_unit_test_teardown(maps_filters, tear_down),
        cmocka_unit_test_teardown(transforms_textures, tear_down),
        cmocka_unit_test_teardown(reads_emissive_strength, tear_down),
        cmocka_unit_test_teardown(reads_ior, tear_down),
        cmocka_unit_test_teardown(reads_specular, tear_down),
        cmocka_unit_test_teardown(reads_glass, tear_down),
        cmocka_unit_test_teardown(reads_unlit, tear_down),
        cmocka_unit_test_teardown(checks_textures, tear_down),
        cmocka_unit_test_teardown(locates_bad_factors, tear_down),
    };
    return cmocka_run_group_tests_name("material", tests, NULL, NULL);
}
