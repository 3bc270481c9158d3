#include "tests/importers/gltf/materials.h"

#include "scene/material.h"

#define TRANSFORM "'extensions': {'KHR_texture_transform': {'offset': [0.25, 0.5], 'scale': [2, 3]}}"
#define TEXTURE "{'index': 1, 'texCoord': 2, " TRANSFORM "}"
#define NORMAL_TEXTURE "{'index': 1, 'texCoord': 2, 'scale': 0.25, " TRANSFORM "}"
#define GLASS "'KHR_materials_transmission': {}, 'KHR_materials_volume': {'thicknessFactor': 1}"

/* Every property of every layer, once: what it is in the file and what becomes of it. */
typedef struct row {
    const char *extensions; /* all of them; the layer's own object holds the property alone */
    uint32_t layers;
    size_t offset;
    int width;
    float values[3];
    /* a texture beside it */
    size_t texture;
    kiln_transfer transfer;
    uint32_t channel;
} row;

#define AT(field) offsetof(kiln_material, field)
#define NO_TEXTURE 0, KILN_TRANSFER_DATA, 0
#define WITH(field, transfer, channel) AT(field.texture), KILN_TRANSFER_##transfer, channel
#define COAT "'KHR_materials_clearcoat': "
#define SHEEN "'KHR_materials_sheen': "
#define FILM "'KHR_materials_iridescence': "
#define LEAF "'KHR_materials_diffuse_transmission': "
#define BRUSHED "'KHR_materials_anisotropy': "

enum { IN_GLASS = KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME };

static const row rows[] = {
    {COAT "{'clearcoatFactor': 0.5, 'clearcoatTexture': " TEXTURE "}", KILN_LAYER_CLEARCOAT, AT(clearcoat), 1, {0.5f},
     WITH(clearcoat, DATA, 0)},
    {COAT "{'clearcoatRoughnessFactor': 0.25, 'clearcoatRoughnessTexture': " TEXTURE "}", KILN_LAYER_CLEARCOAT,
     AT(clearcoat_roughness), 1, {0.25f}, WITH(clearcoat_roughness, DATA, 1)},
    {COAT "{'clearcoatNormalTexture': " NORMAL_TEXTURE "}", KILN_LAYER_CLEARCOAT, AT(clearcoat_normal), 1, {0.25f},
     WITH(clearcoat_normal, DATA, 0)},
    {SHEEN "{'sheenColorFactor': [0.1, 0.2, 0.3], 'sheenColorTexture': " TEXTURE "}", KILN_LAYER_SHEEN, AT(sheen_color), 3,
     {0.1f, 0.2f, 0.3f}, WITH(sheen_color, SRGB, 0)},
    {SHEEN "{'sheenRoughnessFactor': 0.7, 'sheenRoughnessTexture': " TEXTURE "}", KILN_LAYER_SHEEN, AT(sheen_roughness), 1,
     {0.7f}, WITH(sheen_roughness, DATA, 3)},
    {BRUSHED "{'anisotropyStrength': 0.6, 'anisotropyTexture': " TEXTURE "}", KILN_LAYER_ANISOTROPY, AT(anisotropy), 1,
     {0.6f}, WITH(anisotropy, DATA, 2)},
    {BRUSHED "{'anisotropyRotation': -1.57}", KILN_LAYER_ANISOTROPY, AT(anisotropy_rotation), 1, {-1.57f}, NO_TEXTURE},
    {FILM "{'iridescenceFactor': 0.8, 'iridescenceTexture': " TEXTURE "}", KILN_LAYER_IRIDESCENCE, AT(iridescence), 1,
     {0.8f}, WITH(iridescence, DATA, 0)},
    {FILM "{'iridescenceIor': 1.8}", KILN_LAYER_IRIDESCENCE, AT(iridescence_ior), 1, {1.8f}, NO_TEXTURE},
    {FILM "{'iridescenceThicknessMinimum': 900, 'iridescenceThicknessTexture': " TEXTURE "}", KILN_LAYER_IRIDESCENCE,
     AT(iridescence_thickness), 1, {900}, AT(iridescence_thickness_texture), KILN_TRANSFER_DATA, 1},
    {FILM "{'iridescenceThicknessMaximum': 50}", KILN_LAYER_IRIDESCENCE, AT(iridescence_thickness[1]), 1, {50}, NO_TEXTURE},
    {LEAF "{'diffuseTransmissionFactor': 0.3, 'diffuseTransmissionTexture': " TEXTURE "}", KILN_LAYER_DIFFUSE_TRANSMISSION,
     AT(diffuse_transmission), 1, {0.3f}, WITH(diffuse_transmission, DATA, 3)},
    {LEAF "{'diffuseTransmissionColorFactor': [0.4, 0.5, 0.6], 'diffuseTransmissionColorTexture': " TEXTURE "}",
     KILN_LAYER_DIFFUSE_TRANSMISSION, AT(diffuse_transmission_color), 3, {0.4f, 0.5f, 0.6f},
     WITH(diffuse_transmission_color, SRGB, 0)},
    {GLASS ", 'KHR_materials_dispersion': {'dispersion': 2.5}", IN_GLASS | KILN_LAYER_DISPERSION, AT(dispersion), 1, {2.5f},
     NO_TEXTURE},
    {GLASS ", 'KHR_materials_volume_scatter': {'multiscatterColorFactor': [0.9, 0.8, 0.7]}",
     IN_GLASS | KILN_LAYER_VOLUME_SCATTER, AT(multiscatter_color), 3, {0.9f, 0.8f, 0.7f}, NO_TEXTURE},
    {GLASS ", 'KHR_materials_volume_scatter': {'multiscatterColor': [0.9, 0.8, 0.7]}", IN_GLASS | KILN_LAYER_VOLUME_SCATTER,
     AT(multiscatter_color), 3, {0.9f, 0.8f, 0.7f}, NO_TEXTURE},
    {GLASS ", 'KHR_materials_volume_scatter': {'scatterAnisotropy': -0.5}", IN_GLASS | KILN_LAYER_VOLUME_SCATTER,
     AT(scatter_anisotropy), 1, {-0.5f}, NO_TEXTURE},
};

static void assert_texture(const kiln_texture *t, kiln_transfer transfer, uint32_t channel) {
    assert_int_equal(t->image, 1);
    assert_int_equal(t->uv_set, 2);
    assert_int_equal(t->wrap_u, KILN_WRAP_CLAMP);
    assert_int_equal(t->wrap_v, KILN_WRAP_MIRROR);
    assert_int_equal(t->filter, KILN_FILTER_NEAREST);
    assert_int_equal(t->transfer, transfer);
    assert_int_equal(t->channel, channel);
    assert_floats(t->transform, (float[]){2, 0, 0.25f, 0, 3, 0.5f}, 6);
}

static void reads_every_property(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char json[700];
        snprintf(json, sizeof json, "'extensions': {%s}", rows[i].extensions);
        const kiln_material *m = material(json);
        assert_int_equal(m->layers, rows[i].layers);
        assert_floats((const float *)((const char *)m + rows[i].offset), rows[i].values, (size_t)rows[i].width);
        if (rows[i].texture)
            assert_texture((const kiln_texture *)((const char *)m + rows[i].texture), rows[i].transfer, rows[i].channel);
        const kiln_texture *all[KILN_MATERIAL_TEXTURES];
        assert_int_equal(material_textures(m, all), rows[i].texture != 0);
        /* Nothing but the property differs from the default. */
        kiln_material same = *m, none = kiln_material_default();
        size_t size = rows[i].width == 3 ? 12 : 4;
        memcpy((char *)&same + rows[i].offset, (const char *)&none + rows[i].offset, size);
        if (rows[i].texture) memset((char *)&same + rows[i].texture, 0, sizeof(kiln_texture));
        same.name = none.name;
        same.layers = 0;
        same.thickness = none.thickness;
        assert_memory_equal(&same.base_color, &none.base_color, sizeof same - offsetof(kiln_material, base_color));
        tear_down(NULL);
    }
}

/* One property of the wrong type each, and a texture that is not there. */
static void locates_what_is_wrong(void **state) {
    (void)state;
    static const struct { const char *json; kiln_code code; const char *where, *what; } bad[] = {
        {EXTENDED("KHR_materials_clearcoat", "'clearcoatFactor': '1'"), KILN_CODE_SYNTAX,
         "materials[0].extensions.KHR_materials_clearcoat.clearcoatFactor", "a number"},
        {EXTENDED("KHR_materials_clearcoat", "'clearcoatTexture': {'index': 9}"), KILN_CODE_REFERENCE,
         "KHR_materials_clearcoat.clearcoatTexture.index", "texture 9 does not exist (the file has 2)"},
        {EXTENDED("KHR_materials_clearcoat", "'clearcoatNormalTexture': {'index': 0, 'scale': [1]}"), KILN_CODE_SYNTAX,
         "KHR_materials_clearcoat.clearcoatNormalTexture.scale", "a number"},
        {EXTENDED("KHR_materials_clearcoat", "'clearcoatRoughnessFactor': 1e999"), KILN_CODE_RANGE,
         "line 1, column", "a number that is too large"},
        {EXTENDED("KHR_materials_sheen", "'sheenColorFactor': [1, 2]"), KILN_CODE_SYNTAX,
         "KHR_materials_sheen.sheenColorFactor", "an array of 3 numbers"},
        {EXTENDED("KHR_materials_anisotropy", "'anisotropyRotation': true"), KILN_CODE_SYNTAX,
         "KHR_materials_anisotropy.anisotropyRotation", "a number"},
        {EXTENDED("KHR_materials_iridescence", "'iridescenceThicknessTexture': {'index': 'x'}"), KILN_CODE_SYNTAX,
         "KHR_materials_iridescence.iridescenceThicknessTexture.index", "a number"},
        {EXTENDED("KHR_materials_diffuse_transmission", "'diffuseTransmissionColorTexture': {'index': 4}"),
         KILN_CODE_REFERENCE, "KHR_materials_diffuse_transmission.diffuseTransmissionColorTexture.index", "texture 4"},
        {EXTENDED("KHR_materials_dispersion", "'dispersion': [2]"), KILN_CODE_SYNTAX, "KHR_materials_dispersion.dispersion",
         "a number"},
        {EXTENDED("KHR_materials_volume_scatter", "'multiscatterColorFactor': 1"), KILN_CODE_SYNTAX,
         "KHR_materials_volume_scatter.multiscatterColorFactor", "an array of 3 numbers"},
        {EXTENDED("KHR_materials_pbrSpecularGlossiness", "'diffuseFactor': [1, 1, 1]"), KILN_CODE_SYNTAX,
         "KHR_materials_pbrSpecularGlossiness.diffuseFactor", "an array of 4 numbers"},
        {EXTENDED("KHR_materials_pbrSpecularGlossiness", "'specularGlossinessTexture': {'index': 7}"), KILN_CODE_REFERENCE,
         "KHR_materials_pbrSpecularGlossiness.specularGlossinessTexture.index", "texture 7"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) refused(bad[i].json, bad[i].code, bad[i].where, bad[i].what);
}

static void brings_factors_into_their_domain(void **state) {
    (void)state;
    static const struct { const char *json, *what; size_t offset; float value; } odd[] = {
        {EXTENDED("KHR_materials_clearcoat", "'clearcoatFactor': 2"), "the factor is 2: 1 is used", AT(clearcoat), 1},
        {EXTENDED("KHR_materials_clearcoat", "'clearcoatFactor': 1e300"), "not a number: 0 is used", AT(clearcoat), 0},
        {EXTENDED("KHR_materials_sheen", "'sheenColorFactor': [0.5, -1, 0]"), "the factor is -1: 0 is used", AT(sheen_color.value[1]), 0},
        {EXTENDED("KHR_materials_iridescence", "'iridescenceIor': 0.5"), "iridescence_ior is 0.5: 1 is used", AT(iridescence_ior), 1},
        {EXTENDED("KHR_materials_iridescence", "'iridescenceThicknessMaximum': -4"), "is -4: 0 is used", AT(iridescence_thickness[1]), 0},
        {EXTENDED("KHR_materials_anisotropy", "'anisotropyRotation': 1e39"), "anisotropy_rotation is not a number: 0", AT(anisotropy_rotation), 0},
        {"'extensions': {" GLASS ", 'KHR_materials_dispersion': {'dispersion': -1}}", "dispersion is -1: 0 is used", AT(dispersion), 0},
        {"'extensions': {" GLASS ", 'KHR_materials_volume_scatter': {'multiscatterColorFactor': [0, 0, 3]}}",
         "multiscatter_color is 3: 1 is used", AT(multiscatter_color[2]), 1},
        {"'extensions': {" GLASS ", 'KHR_materials_volume_scatter': {'scatterAnisotropy': 1}}",
         "scatter_anisotropy is 1: 0.999 is used", AT(scatter_anisotropy), 0.999f},
        {EXTENDED("KHR_materials_ior", "'ior': 0.5"), "ior is 0.5: 1 is used", AT(ior), 1},
        {EXTENDED("KHR_materials_ior", "'ior': -1e39"), "ior is not a number: 1.5 is used", AT(ior), 1.5f}};
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        const kiln_material *m = warned(odd[i].json, KILN_CODE_RANGE, "test.gltf: materials[0]", odd[i].what);
        assert_floats((const float *)((const char *)m + odd[i].offset), &odd[i].value, 1);
        tear_down(NULL);
    }
    assert_floats(&material(EXTENDED("KHR_materials_ior", "'ior': 1e39"))->ior, (float[]){0}, 1); /* infinity */
}

/* The ior of 0 makes the specular colour F0; what pbrMetallicRoughness says is not read, its pictures neither. */
static void reads_specular_glossiness(void **state) {
    (void)state;
    const kiln_material *m = material(
        "'alphaMode': 'BLEND', 'pbrMetallicRoughness': {'metallicFactor': 0.5, 'baseColorFactor': [0, 0, 0, 0.1], "
        "'baseColorTexture': {'index': 1}, 'metallicRoughnessTexture': {'index': 1}}, "
        EXTENDED("KHR_materials_pbrSpecularGlossiness", "'diffuseFactor': [0.1, 0.2, 0.3, 0.4], 'diffuseTexture': {'index': 0}, "
                 "'specularFactor': [0.5, 0.6, 0.7], 'glossinessFactor': 0.8, 'specularGlossinessTexture': " TEXTURE));
    assert_int_equal(m->layers, KILN_LAYER_GLOSSINESS);
    assert_floats(m->base_color.value, (float[]){0.1f, 0.2f, 0.3f}, 3);
    assert_floats(m->specular_color.value, (float[]){0.5f, 0.6f, 0.7f}, 3);
    assert_floats((float[]){m->opacity.value, m->metallic.value, m->roughness.value, m->ior, m->specular.value},
                  (float[]){0.4f, 0, 0.8f, 0, 1}, 5);
    assert_int_equal(m->base_color.texture.transfer, KILN_TRANSFER_SRGB);
    assert_int_equal(m->base_color.texture.wrap_u, KILN_WRAP_REPEAT);
    assert_int_equal(m->opacity.texture.channel, 3);
    assert_int_equal(m->opacity.texture.transfer, KILN_TRANSFER_DATA);
    assert_int_equal(m->metallic.texture.image, 0);
    assert_texture(&m->specular_color.texture, KILN_TRANSFER_SRGB, 0);
    assert_texture(&m->roughness.texture, KILN_TRANSFER_DATA, 3);
    tear_down(NULL);
    m = material(EXTENDED("KHR_materials_pbrSpecularGlossiness", ""));
    assert_floats((float[]){m->opacity.value, m->metallic.value, m->roughness.value, m->ior}, (float[]){1, 0, 1, 0}, 4);
    tear_down(NULL);
    m = material("'emissiveFactor': [1, 1, 1], 'extensions': {'KHR_materials_pbrSpecularGlossiness': {}, "
                 "'KHR_materials_emissive_strength': {'emissiveStrength': 2}}");
    assert_floats(m->emission.value, (float[]){2, 2, 2}, 3);
}

static void what_is_excluded_is_left_out(void **state) {
    (void)state;
    const kiln_material *m = warned("'extensions': {'KHR_materials_pbrSpecularGlossiness': {}, 'KHR_materials_sheen': {}}",
                                    KILN_CODE_IGNORED, "materials[0].extensions.KHR_materials_sheen",
                                    "must not be used with KHR_materials_pbrSpecularGlossiness");
    assert_int_equal(m->layers, KILN_LAYER_GLOSSINESS);
    tear_down(NULL);
    m = warned("'extensions': {'KHR_materials_pbrSpecularGlossiness': {}, 'KHR_materials_ior': {'ior': 2}}", KILN_CODE_IGNORED,
               "extensions.KHR_materials_ior", "it is left out");
    assert_floats(&m->ior, (float[]){0}, 1);
    tear_down(NULL);
    m = warned("'pbrMetallicRoughness': {'baseColorFactor': [0.5, 0.5, 0.5, 1]}, 'extensions': {'KHR_materials_unlit': {}, "
               "'KHR_materials_pbrSpecularGlossiness': {'diffuseFactor': [0, 0, 0, 1]}}", KILN_CODE_IGNORED,
               "extensions.KHR_materials_pbrSpecularGlossiness", "must not be used with KHR_materials_unlit");
    assert_int_equal(m->layers, KILN_LAYER_UNLIT);
    assert_floats(m->base_color.value, (float[]){0.5f}, 1);
    tear_down(NULL);
    m = warned("'extensions': {'KHR_materials_unlit': {}, 'KHR_materials_clearcoat': {'clearcoatTexture': {'index': 0}}}",
               KILN_CODE_IGNORED, "extensions.KHR_materials_clearcoat", "it is left out");
    assert_int_equal(m->layers, KILN_LAYER_UNLIT);
    assert_int_equal(scene->image_count, 0);
}

static void what_needs_others_is_left_out_without(void **state) {
    (void)state;
    static const struct { const char *json, *where, *what; uint32_t layers; } alone[] = {
        {EXTENDED("KHR_materials_volume", "'thicknessFactor': 1"), "extensions.KHR_materials_volume", "no light enters", 0},
        {EXTENDED("KHR_materials_dispersion", "'dispersion': 1"), "extensions.KHR_materials_dispersion", "disperses", 0},
        {EXTENDED("KHR_materials_volume_scatter", ""), "extensions.KHR_materials_volume_scatter", "scatters", 0},
        {"'extensions': {'KHR_materials_transmission': {}, 'KHR_materials_dispersion': {}}",
         "extensions.KHR_materials_dispersion", "it is left out", KILN_LAYER_TRANSMISSION}};
    for (size_t i = 0; i < sizeof alone / sizeof *alone; i++) {
        assert_int_equal(warned(alone[i].json, KILN_CODE_IGNORED, alone[i].where, alone[i].what)->layers, alone[i].layers);
        tear_down(NULL);
    }
    const uint32_t leaf = KILN_LAYER_DIFFUSE_TRANSMISSION | KILN_LAYER_VOLUME | KILN_LAYER_VOLUME_SCATTER;
    assert_int_equal(material("'extensions': {'KHR_materials_diffuse_transmission': {}, 'KHR_materials_volume': {}, "
                              "'KHR_materials_volume_scatter': {}}")->layers, leaf);
    tear_down(NULL);
    warned("'extensions': {" GLASS ", 'KHR_materials_volume_scatter': {'multiscatterColorTexture': {'index': 0}}}",
           KILN_CODE_IGNORED, "KHR_materials_volume_scatter.multiscatterColorTexture", "homogeneous");
}

static void reads_priorities(void **state) {
    (void)state;
    assert_int_equal(material("'extras': {'priority': -3}")->priority, -3);
    tear_down(NULL);
    static const char *const odd[] = {"1.5", "'high'", "3e9", "[1]", "{'a': 1}"};
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        char json[60];
        snprintf(json, sizeof json, "'extras': {'priority': %s}", odd[i]);
        assert_int_equal(warned(json, KILN_CODE_IGNORED, "materials[0].extras.priority", "not understood")->priority, 0);
        tear_down(NULL);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(reads_every_property, tear_down),
        cmocka_unit_test_teardown(locates_what_is_wrong, tear_down),
        cmocka_unit_test_teardown(brings_factors_into_their_domain, tear_down),
        cmocka_unit_test_teardown(reads_specular_glossiness, tear_down),
        cmocka_unit_test_teardown(what_is_excluded_is_left_out, tear_down),
        cmocka_unit_test_teardown(what_needs_others_is_left_out_without, tear_down),
        cmocka_unit_test_teardown(reads_priorities, tear_down),
    };
    return cmocka_run_group_tests_name("material_layers", tests, NULL, NULL);
}
