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
    int width; /* 1: kiln_param1, 3: kiln_param3 */
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
};
#undef AT

static float *values_of(kiln_material *m, const parameter *p) { return (float *)((char *)m + p->offset); }
static size_t texture_offset(const parameter *p) {
    return p->offset + (p->width == 1 ? offsetof(kiln_param1, texture) : offsetof(kiln_param3, texture));
}
static bool is_read(const kiln_material *m, const parameter *p) { return !p->layers || (m->layers & p->layers); }

uint32_t material_textures(const kiln_material *m, const kiln_texture *textures[KILN_MATERIAL_TEXTURES]) {
    uint32_t count = 0;
    for (int i = 0; i < KILN_MATERIAL_TEXTURES; i++) {
        const kiln_texture *t = (const kiln_texture *)((const char *)m + texture_offset(&parameters[i]));
        if (t->image && is_read(m, &parameters[i])) textures[count++] = t;
    }
    return count;
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

static void check_constants(kiln_material *m, const kiln_where *where, kiln_report *report) {
    m->alpha_cutoff = check_factor(m->alpha_cutoff, 0, FLT_MAX, 0.5f, "alpha_cutoff", where, report);
    if (m->ior != 0) m->ior = check_factor(m->ior, 1, FLT_MAX, 1.5f, "ior", where, report);
    if (isinf(m->attenuation_distance) && m->attenuation_distance > 0) m->attenuation_distance = 0;
    m->attenuation_distance = check_factor(m->attenuation_distance, 0, FLT_MAX, 0, "attenuation_distance", where,
                                           report);
    for (int k = 0; k < 3; k++)
        m->attenuation_color[k] =
            check_factor(m->attenuation_color[k], 0, 1, 1, "attenuation_color", where, report);
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
