#include <math.h>
#include <string.h>

#include "importers/gltf/material.h"
#include "importers/gltf/texture.h"
#include "importers/gltf/value.h"

#define UNLIT "KHR_materials_unlit"
#define GLOSSY "KHR_materials_pbrSpecularGlossiness"

/* The members of one extension: object is its value, where its place. */
typedef struct layer {
    gltf_reader *r;
    const gltf_value *object;
    const kiln_where *where;
} layer;

static bool number(const layer *l, const char *key, float *out) {
    return value_float(l->object, key, out, l->where, l->r->report);
}
static bool color(const layer *l, const char *key, float out[3]) {
    return value_floats(l->object, key, 3, out, l->where, l->r->report);
}
static bool data_texture(const layer *l, const char *key, uint32_t channel, kiln_texture *out) {
    return gltf_read_texture_member(l->r, l->object, key, KILN_TRANSFER_DATA, channel, out, l->where);
}
static bool color_texture(const layer *l, const char *key, kiln_texture *out) {
    return gltf_read_texture_member(l->r, l->object, key, KILN_TRANSFER_SRGB, 0, out, l->where);
}
static bool normal_texture(const layer *l, const char *key, kiln_param1 *out) {
    kiln_where where = where_key(l->where, key);
    return data_texture(l, key, 0, &out->texture) &&
           value_float(value_member(l->object, key), "scale", &out->value, &where, l->r->report);
}
static void warn(const layer *l, const char *key, const char *what) {
    kiln_where where = where_key(l->where, key);
    report_warning(l->r->report, KILN_CODE_IGNORED, &where, NULL, "%s", what);
}

static bool read_unlit(const layer *l, kiln_material *out) {
    (void)l;
    out->layers |= KILN_LAYER_UNLIT;
    return true;
}

/* As KHR_materials_specular says under 'Specular-glossiness materials': an ior of 0, whose
 * Fresnel term at normal incidence is 1, leaves the specular colour alone as F0. */
static bool read_specular_glossiness(const layer *l, kiln_material *out) {
    float diffuse[4] = {1, 1, 1, 1};
    out->layers |= KILN_LAYER_GLOSSINESS;
    out->metallic = (kiln_param1){.value = 0};
    out->ior = 0;
    if (!value_floats(l->object, "diffuseFactor", 4, diffuse, l->where, l->r->report) ||
        !color_texture(l, "diffuseTexture", &out->base_color.texture) ||
        !color(l, "specularFactor", out->specular_color.value) ||
        !color_texture(l, "specularGlossinessTexture", &out->specular_color.texture) ||
        !number(l, "glossinessFactor", &out->roughness.value))
        return false;
    memcpy(out->base_color.value, diffuse, sizeof out->base_color.value);
    gltf_use_alpha(out, (double)diffuse[3]);
    out->roughness.texture = out->specular_color.texture;
    out->roughness.texture.transfer = KILN_TRANSFER_DATA;
    out->roughness.texture.channel = 3;
    return true;
}

static bool read_emissive_strength(const layer *l, kiln_material *out) {
    float strength = 1;
    if (!number(l, "emissiveStrength", &strength)) return false;
    for (int k = 0; k < 3; k++) out->emission.value[k] *= strength;
    return true;
}

static bool read_ior(const layer *l, kiln_material *out) { return number(l, "ior", &out->ior); }

static bool read_specular(const layer *l, kiln_material *out) {
    return number(l, "specularFactor", &out->specular.value) &&
           color(l, "specularColorFactor", out->specular_color.value) &&
           data_texture(l, "specularTexture", 3, &out->specular.texture) &&
           color_texture(l, "specularColorTexture", &out->specular_color.texture);
}

static bool read_clearcoat(const layer *l, kiln_material *out) {
    out->layers |= KILN_LAYER_CLEARCOAT;
    return number(l, "clearcoatFactor", &out->clearcoat.value) &&
           number(l, "clearcoatRoughnessFactor", &out->clearcoat_roughness.value) &&
           data_texture(l, "clearcoatTexture", 0, &out->clearcoat.texture) &&
           data_texture(l, "clearcoatRoughnessTexture", 1, &out->clearcoat_roughness.texture) &&
           normal_texture(l, "clearcoatNormalTexture", &out->clearcoat_normal);
}

static bool read_sheen(const layer *l, kiln_material *out) {
    out->layers |= KILN_LAYER_SHEEN;
    return color(l, "sheenColorFactor", out->sheen_color.value) &&
           number(l, "sheenRoughnessFactor", &out->sheen_roughness.value) &&
           color_texture(l, "sheenColorTexture", &out->sheen_color.texture) &&
           data_texture(l, "sheenRoughnessTexture", 3, &out->sheen_roughness.texture);
}

/* The texture's direction and strength stand in R, G and in B, the channel named here. */
static bool read_anisotropy(const layer *l, kiln_material *out) {
    out->layers |= KILN_LAYER_ANISOTROPY;
    return number(l, "anisotropyStrength", &out->anisotropy.value) &&
           number(l, "anisotropyRotation", &out->anisotropy_rotation) &&
           data_texture(l, "anisotropyTexture", 2, &out->anisotropy.texture);
}

static bool read_iridescence(const layer *l, kiln_material *out) {
    out->layers |= KILN_LAYER_IRIDESCENCE;
    return number(l, "iridescenceFactor", &out->iridescence.value) &&
           number(l, "iridescenceIor", &out->iridescence_ior) &&
           number(l, "iridescenceThicknessMinimum", &out->iridescence_thickness[0]) &&
           number(l, "iridescenceThicknessMaximum", &out->iridescence_thickness[1]) &&
           data_texture(l, "iridescenceTexture", 0, &out->iridescence.texture) &&
           data_texture(l, "iridescenceThicknessTexture", 1, &out->iridescence_thickness_texture);
}

static bool read_transmission(const layer *l, kiln_material *out) {
    out->layers |= KILN_LAYER_TRANSMISSION;
    return number(l, "transmissionFactor", &out->transmission.value) &&
           data_texture(l, "transmissionTexture", 0, &out->transmission.texture);
}

static bool read_diffuse_transmission(const layer *l, kiln_material *out) {
    out->layers |= KILN_LAYER_DIFFUSE_TRANSMISSION;
    return number(l, "diffuseTransmissionFactor", &out->diffuse_transmission.value) &&
           color(l, "diffuseTransmissionColorFactor", out->diffuse_transmission_color.value) &&
           data_texture(l, "diffuseTransmissionTexture", 3, &out->diffuse_transmission.texture) &&
           color_texture(l, "diffuseTransmissionColorTexture", &out->diffuse_transmission_color.texture);
}

static bool read_volume(const layer *l, kiln_material *out) {
    out->layers |= KILN_LAYER_VOLUME;
    float distance = HUGE_VALF;
    if (!number(l, "thicknessFactor", &out->thickness.value) ||
        !data_texture(l, "thicknessTexture", 1, &out->thickness.texture) ||
        !number(l, "attenuationDistance", &distance) || !color(l, "attenuationColor", out->attenuation_color))
        return false;
    if (!(distance > 0))
        report_warning(l->r->report, KILN_CODE_RANGE, l->where, NULL,
                       "attenuationDistance must be positive: the volume is taken for clear");
    out->attenuation_distance = distance > 0 && isfinite(distance) ? distance : 0;
    return true;
}

static bool read_dispersion(const layer *l, kiln_material *out) {
    out->layers |= KILN_LAYER_DISPERSION;
    return number(l, "dispersion", &out->dispersion);
}

/* A draft (KhronosGroup/glTF, pull request 2453); its earlier versions wrote multiscatterColor, some a texture. */
static bool read_volume_scatter(const layer *l, kiln_material *out) {
    out->layers |= KILN_LAYER_VOLUME_SCATTER;
    if (value_member(l->object, "multiscatterColorTexture"))
        warn(l, "multiscatterColorTexture", "the medium is homogeneous: its texture is left out");
    return color(l, "multiscatterColor", out->multiscatter_color) &&
           color(l, "multiscatterColorFactor", out->multiscatter_color) &&
           number(l, "scatterAnisotropy", &out->scatter_anisotropy);
}

/* beside: which of the models that exclude others a layer may stand with; their specifications' 'Exclusions'. */
enum { BESIDE_UNLIT = 1, BESIDE_GLOSSY = 2 };
static const struct {
    const char *name;
    bool (*read)(const layer *, kiln_material *);
    int beside;
} rows[] = {
    {UNLIT, read_unlit, BESIDE_UNLIT | BESIDE_GLOSSY},
    {GLOSSY, read_specular_glossiness, BESIDE_GLOSSY},
    {"KHR_materials_emissive_strength", read_emissive_strength, BESIDE_GLOSSY},
    {"KHR_materials_ior", read_ior, 0},
    {"KHR_materials_specular", read_specular, 0},
    {"KHR_materials_clearcoat", read_clearcoat, 0},
    {"KHR_materials_sheen", read_sheen, 0},
    {"KHR_materials_anisotropy", read_anisotropy, 0},
    {"KHR_materials_iridescence", read_iridescence, 0},
    {"KHR_materials_transmission", read_transmission, 0},
    {"KHR_materials_diffuse_transmission", read_diffuse_transmission, 0},
    {"KHR_materials_volume", read_volume, 0},
    {"KHR_materials_dispersion", read_dispersion, 0},
    {"KHR_materials_volume_scatter", read_volume_scatter, 0},
};

bool gltf_is_specular_glossy(const gltf_material *m) {
    return value_member(&m->extensions, GLOSSY) && !value_member(&m->extensions, UNLIT);
}

/* Layers that are nothing without one of others. */
static void check_needs(gltf_reader *r, kiln_material *m, const kiln_where *extensions) {
    static const struct { const char *name; uint32_t is, needs; const char *without; } needs[] = {
        {"KHR_materials_volume", KILN_LAYER_VOLUME, KILN_LAYER_TRANSMISSION | KILN_LAYER_DIFFUSE_TRANSMISSION,
         "KHR_materials_transmission or KHR_materials_diffuse_transmission no light enters the volume"},
        {"KHR_materials_dispersion", KILN_LAYER_DISPERSION, KILN_LAYER_VOLUME,
         "a KHR_materials_volume that light enters nothing disperses"},
        {"KHR_materials_volume_scatter", KILN_LAYER_VOLUME_SCATTER, KILN_LAYER_VOLUME,
         "a KHR_materials_volume that light enters nothing scatters"}};
    for (size_t i = 0; i < sizeof needs / sizeof *needs; i++) {
        if (!(m->layers & needs[i].is) || m->layers & needs[i].needs) continue;
        kiln_where where = where_key(extensions, needs[i].name);
        report_warning(r->report, KILN_CODE_IGNORED, &where, NULL, "without %s: it is left out", needs[i].without);
        m->layers &= ~needs[i].is;
    }
}

bool gltf_read_layers(gltf_reader *r, const gltf_material *m, kiln_material *out, const kiln_where *material) {
    bool unlit = value_member(&m->extensions, UNLIT), glossy = gltf_is_specular_glossy(m);
    int model = unlit ? BESIDE_UNLIT : glossy ? BESIDE_GLOSSY : 0;
    kiln_where list = where_key(material, "extensions");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_where where = where_key(&list, rows[i].name);
        layer l = {r, value_member(&m->extensions, rows[i].name), &where};
        if (!l.object) continue;
        if (model && !(rows[i].beside & model))
            report_warning(r->report, KILN_CODE_IGNORED, &where, NULL, "%s must not be used with %s: it is left out",
                           rows[i].name, unlit ? UNLIT : GLOSSY);
        else if (!rows[i].read(&l, out)) return false;
    }
    check_needs(r, out, &list);
    return true;
}
