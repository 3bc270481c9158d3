#include "scene/material.h"

#include <float.h>

#include "scene/check.h"

kiln_material kiln_material_default(void) {
    return (kiln_material){
        .name = "default",
        .alpha_cutoff = 0.5f,
        .base_color.value = {1, 1, 1},
        .opacity.value = 1,
        .metallic.value = 1,
        .roughness.value = 1,
        .normal.value = 1,
        .ior = 1.5f,
        .specular.value = 1,
        .specular_color.value = {1, 1, 1},
        .attenuation_color = {1, 1, 1},
        .clearcoat_normal.value = 1,
        .iridescence_ior = 1.3f,
        .iridescence_thickness = {100, 400},
        .diffuse_transmission_color.value = {1, 1, 1},
    };
}

/* Every parameter that may have a texture: its domain (glTF's) and what replaces a value that is not a number. */
typedef struct parameter {
    const char *name;
    size_t offset;
    int width; /* as in material_parameter */
    float low, high, fallback;
    uint32_t layers; /* the layers that read it; 0: always read */
} parameter;

#define AT(field) #field, offsetof(kiln_material, field)
static const parameter parameters[KILN_MATERIAL_TEXTURES] = {
    {AT(base_color), 3, 0, 1, 1, 0},
    {AT(opacity), 1, 0, 1, 1, 0},
    {AT(metallic), 1, 0, 1, 1, 0},
    {AT(roughness), 1, 0, 1, 1, 0},
    {AT(normal), 1, -FLT_MAX, FLT_MAX, 1, 0},
    {AT(emission), 3, 0, FLT_MAX, 0, 0},
    {AT(specular), 1, 0, 1, 1, 0},
    {AT(specular_color), 3, 0, FLT_MAX, 1, 0},
    {AT(transmission), 1, 0, 1, 0, KILN_LAYER_TRANSMISSION},
    {AT(thickness), 1, 0, FLT_MAX, 0, KILN_LAYER_VOLUME},
    {AT(clearcoat), 1, 0, 1, 0, KILN_LAYER_CLEARCOAT},
    {AT(clearcoat_roughness), 1, 0, 1, 0, KILN_LAYER_CLEARCOAT},
    {AT(clearcoat_normal), 1, -FLT_MAX, FLT_MAX, 1, KILN_LAYER_CLEARCOAT},
    {AT(sheen_color), 3, 0, 1, 0, KILN_LAYER_SHEEN},
    {AT(sheen_roughness), 1, 0, 1, 0, KILN_LAYER_SHEEN},
    {AT(anisotropy), 1, 0, 1, 0, KILN_LAYER_ANISOTROPY},
    {AT(iridescence), 1, 0, 1, 0, KILN_LAYER_IRIDESCENCE},
    {AT(iridescence_thickness_texture), 0, 0, 0, 0, KILN_LAYER_IRIDESCENCE},
    {AT(diffuse_transmission), 1, 0, 1, 0, KILN_LAYER_DIFFUSE_TRANSMISSION},
    {AT(diffuse_transmission_color), 3, 0, 1, 1, KILN_LAYER_DIFFUSE_TRANSMISSION},
};
#undef AT

static float *values_of(kiln_material *m, const parameter *p) { return (float *)((char *)m + p->offset); }

static size_t texture_offset(const parameter *p) {
    switch (p->width) {
    case 0: return p->offset;
    case 1: return p->offset + offsetof(kiln_param1, texture);
    default: return p->offset + offsetof(kiln_param3, texture);
    }
}

bool material_parameter_of(const kiln_material *m, int i, material_parameter *out) {
    const parameter *p = &parameters[i];
    const char *base = (const char *)m;
    *out = (material_parameter){p->name, p->width, (const float *)(base + p->offset),
                                (const kiln_texture *)(base + texture_offset(p))};
    return !p->layers || (m->layers & p->layers);
}

uint32_t material_textures(const kiln_material *m, const kiln_texture *textures[KILN_MATERIAL_TEXTURES]) {
    uint32_t count = 0;
    material_parameter p;
    for (int i = 0; i < KILN_MATERIAL_TEXTURES; i++)
        if (material_parameter_of(m, i, &p) && p.texture->image) textures[count++] = p.texture;
    return count;
}

bool material_tangents(const kiln_material *m, uint32_t *uv_set) {
    bool coat = m->layers & KILN_LAYER_CLEARCOAT && m->clearcoat_normal.texture.image;
    bool anisotropic = m->layers & KILN_LAYER_ANISOTROPY && m->anisotropy.value > 0;
    if (m->normal.texture.image) *uv_set = m->normal.texture.uv_set;
    else if (anisotropic) *uv_set = m->anisotropy.texture.uv_set; /* 0 where it has no texture */
    else if (coat) *uv_set = m->clearcoat_normal.texture.uv_set;
    else return false;
    return true;
}

static bool check_texture(kiln_texture *t, const kiln_scene *scene, const kiln_where *where, kiln_report *report) {
    if (!t->image) {
        *t = (kiln_texture){0};
        return true;
    }
    if (!check_reference(t->image, scene->image_count, true, "image", where, report) ||
        !check_choice(t->wrap_u, KILN_WRAP_CLAMP + 1, "wrap mode", where, report) ||
        !check_choice(t->wrap_v, KILN_WRAP_CLAMP + 1, "wrap mode", where, report) ||
        !check_choice(t->filter, KILN_FILTER_NEAREST + 1, "filter", where, report) ||
        !check_choice(t->transfer, KILN_TRANSFER_COUNT, "transfer", where, report) ||
        !check_choice(t->channel, 4, "channel", where, report))
        return false;
    bool finite = true, absent = true;
    for (int k = 0; k < 6; k++) {
        finite &= (bool)isfinite(t->transform[k]);
        absent &= t->transform[k] == 0;
    }
    if (!finite)
        report_warning(report, KILN_CODE_RANGE, where, NULL, "the texture transform is not finite: it is left out");
    if (!finite || absent) memcpy(t->transform, (float[6]){1, 0, 0, 0, 1, 0}, sizeof t->transform);
    return true;
}

static bool check_parameters(kiln_material *m, const kiln_scene *scene, const kiln_where *where, kiln_report *report) {
    for (int i = 0; i < KILN_MATERIAL_TEXTURES; i++) {
        const parameter *p = &parameters[i];
        kiln_where here = where_key(where, p->name);
        /* An unlit base colour is radiance and may be brighter than white. */
        bool radiance = i == 0 && (m->layers & KILN_LAYER_UNLIT);
        for (int k = 0; k < p->width; k++) {
            float *value = &values_of(m, p)[k];
            *value = check_factor(*value, p->low, radiance ? FLT_MAX : p->high, p->fallback, "the factor", &here,
                                  report);
        }
        if (!check_texture((kiln_texture *)((char *)m + texture_offset(p)), scene, &here, report)) return false;
    }
    return true;
}

/* Constants: their domain and what replaces a value that is not a number. */
static const struct {
    const char *name;
    size_t offset;
    int width;
    float low, high, fallback;
} constants[] = {
#define AT(field) #field, offsetof(kiln_material, field)
    {AT(alpha_cutoff), 1, 0, FLT_MAX, 0.5f},
    {AT(attenuation_distance), 1, 0, FLT_MAX, 0},
    {AT(attenuation_color), 3, 0, 1, 1},
    {AT(anisotropy_rotation), 1, -FLT_MAX, FLT_MAX, 0},
    {AT(iridescence_ior), 1, 1, FLT_MAX, 1.3f},
    {AT(iridescence_thickness[0]), 1, 0, FLT_MAX, 100},
    {AT(iridescence_thickness[1]), 1, 0, FLT_MAX, 400},
    {AT(dispersion), 1, 0, FLT_MAX, 0},
    {AT(multiscatter_color), 3, 0, 1, 0},
    /* The ends would be the deltas of a medium that does not scatter and of one that mirrors. */
    {AT(scatter_anisotropy), 1, -0.999f, 0.999f, 0},
#undef AT
};

static void check_constants(kiln_material *m, const kiln_where *where, kiln_report *report) {
    float *const infinite[] = {&m->attenuation_distance, &m->ior}; /* 0 stands for infinity */
    for (size_t i = 0; i < sizeof infinite / sizeof *infinite; i++)
        if (isinf(*infinite[i]) && *infinite[i] > 0) *infinite[i] = 0;
    if (m->ior != 0) m->ior = check_factor(m->ior, 1, FLT_MAX, 1.5f, "ior", where, report);
    for (size_t i = 0; i < sizeof constants / sizeof *constants; i++) {
        float *values = (float *)((char *)m + constants[i].offset);
        for (int k = 0; k < constants[i].width; k++)
            values[k] = check_factor(values[k], constants[i].low, constants[i].high, constants[i].fallback,
                                     constants[i].name, where, report);
    }
}

bool kiln_scene_add_material(kiln_scene *scene, const kiln_material *desc, kiln_id *id, kiln_report *report) {
    enum { LAYERS = 2 * KILN_LAYER_GLOSSINESS - 1 };
    scene_place place;
    place_set(&place, scene, "material", desc->name, (size_t)scene->material_count + 1);
    if (!check_open(scene, &place.where, report) ||
        !check_choice(desc->alpha_mode, KILN_ALPHA_BLEND + 1, "alpha mode", &place.where, report))
        return false;
    if (desc->layers & ~(uint32_t)LAYERS)
        return report_error(report, KILN_CODE_RANGE, &place.where, NULL, "layers 0x%x are unknown",
                            desc->layers & ~(uint32_t)LAYERS);
    kiln_material material = *desc;
    if (!check_parameters(&material, scene, &place.where, report)) return false;
    check_constants(&material, &place.where, report);
    material.name = arena_string(&scene->arena, desc->name);
    if (!material.name) return report_no_memory(report, "building the scene");
    if (!array_room((void **)&scene->materials, scene->material_count, sizeof material, report)) return false;
    scene->materials[scene->material_count++] = material;
    if (id) *id = scene->material_count;
    return true;
}
