#include "tests/golden/dump.h"

#include <stdio.h>
#include <string.h>

#include "base/hash.h"
#include "scene/material.h"

/* Five digits: fewer than a float has, and −0 is 0. */
static void put_number(kiln_text *out, double value) {
    char text[32];
    snprintf(text, sizeof text, "%.5g", value);
    text_format(out, " %s", strcmp(text, "-0") == 0 ? "0" : text);
}

static void put_numbers(kiln_text *out, const char *name, const double *values, size_t count) {
    text_format(out, " %s", name);
    for (size_t i = 0; i < count; i++) put_number(out, fabs(values[i]) < 1e-12 ? 0 : values[i]);
}

static void put_floats(kiln_text *out, const char *name, const float *values, size_t count) {
    text_format(out, " %s", name);
    for (size_t i = 0; i < count; i++) put_number(out, (double)values[i]);
}

/* Three digits of the largest value: what a mathematical library rounds differently must not cross a step. */
static uint32_t hash_values(const float *values, size_t count) {
    float largest = 0;
    uint32_t hash = (uint32_t)count;
    for (size_t i = 0; i < count; i++) largest = fabsf(values[i]) > largest ? fabsf(values[i]) : largest;
    for (size_t i = 0; i < count; i++)
        hash = hash_pair(hash, (uint32_t)(int32_t)lrintf(largest > 0 ? values[i] / largest * 1e3f : 0));
    return hash;
}

static uint32_t hash_indices(const uint32_t *values, size_t count) {
    uint32_t hash = (uint32_t)count;
    for (size_t i = 0; i < count; i++) hash = hash_pair(hash, values[i]);
    return hash;
}

static void put_texture(kiln_text *out, const char *name, const kiln_texture *t) {
    static const char *const wraps[] = {"repeat", "mirror", "clamp"}, *const filters[] = {"linear", "nearest"},
                             *const transfers[] = {"data", "srgb", "linear"};
    if (!t->image) return;
    text_format(out, "  %s: image %u uv %u %s %s %s %s channel %u", name, t->image, t->uv_set, wraps[t->wrap_u],
                wraps[t->wrap_v], filters[t->filter], transfers[t->transfer], t->channel);
    put_floats(out, "transform", t->transform, 6);
    text_append(out, "\n");
}

/* Parameters of the layers that came after the first golden files: shown where they are there. */
static void dump_layers(const kiln_material *m, kiln_text *out) {
    enum { FIRST = 10 }; /* behind thickness */
    material_parameter p;
    for (int i = FIRST; i < KILN_MATERIAL_TEXTURES; i++) {
        if (!material_parameter_of(m, i, &p)) continue;
        text_append(out, " ");
        put_floats(out, p.name, p.values, (size_t)p.width);
        text_append(out, "\n");
        put_texture(out, p.name, p.texture);
    }
    const struct { uint32_t layer; const char *name; const float *values; size_t count; } constants[] = {
        {KILN_LAYER_ANISOTROPY, "rotation", &m->anisotropy_rotation, 1},
        {KILN_LAYER_IRIDESCENCE, "film-ior", &m->iridescence_ior, 1},
        {KILN_LAYER_IRIDESCENCE, "film-thickness", m->iridescence_thickness, 2},
        {KILN_LAYER_DISPERSION, "dispersion", &m->dispersion, 1},
        {KILN_LAYER_VOLUME_SCATTER, "multiscatter", m->multiscatter_color, 3},
        {KILN_LAYER_VOLUME_SCATTER, "scatter-anisotropy", &m->scatter_anisotropy, 1}};
    for (size_t i = 0; i < sizeof constants / sizeof *constants; i++) {
        if (!(m->layers & constants[i].layer)) continue;
        text_append(out, " ");
        put_floats(out, constants[i].name, constants[i].values, constants[i].count);
        text_append(out, "\n");
    }
    if (m->priority) text_format(out, "  priority %d\n", (int)m->priority);
}

static void dump_material(const kiln_material *m, uint32_t id, kiln_text *out) {
    static const char *const modes[] = {"opaque", "mask", "blend"};
    text_format(out, "material %u '%s' layers %u alpha %s %s\n ", id, m->name, m->layers, modes[m->alpha_mode],
                m->double_sided ? "double-sided" : "single-sided");
    put_floats(out, "cutoff", &m->alpha_cutoff, 1);
    put_floats(out, "color", m->base_color.value, 3);
    put_floats(out, "opacity", &m->opacity.value, 1);
    put_floats(out, "metallic", &m->metallic.value, 1);
    put_floats(out, "roughness", &m->roughness.value, 1);
    put_floats(out, "normal", &m->normal.value, 1);
    put_floats(out, "emission", m->emission.value, 3);
    text_append(out, "\n ");
    put_floats(out, "ior", &m->ior, 1);
    put_floats(out, "specular", &m->specular.value, 1);
    put_floats(out, "specular-color", m->specular_color.value, 3);
    put_floats(out, "transmission", &m->transmission.value, 1);
    put_floats(out, "thickness", &m->thickness.value, 1);
    put_floats(out, "distance", &m->attenuation_distance, 1);
    put_floats(out, "attenuation", m->attenuation_color, 3);
    text_append(out, "\n");
    dump_layers(m, out);
    put_texture(out, "color", &m->base_color.texture);
    put_texture(out, "opacity", &m->opacity.texture);
    put_texture(out, "metallic", &m->metallic.texture);
    put_texture(out, "roughness", &m->roughness.texture);
    put_texture(out, "normal", &m->normal.texture);
    put_texture(out, "emission", &m->emission.texture);
    put_texture(out, "specular", &m->specular.texture);
    put_texture(out, "specular-color", &m->specular_color.texture);
    put_texture(out, "transmission", &m->transmission.texture);
    put_texture(out, "thickness", &m->thickness.texture);
}

static void dump_mesh(const kiln_mesh *m, uint32_t id, kiln_text *out) {
    static const char *const kinds[] = {"normal", "tangent", "uv", "color"},
                             *const rates[] = {"vertex", "face-varying", "uniform", "constant"},
                             *const schemes[] = {"none", "catmull-clark", "loop", "bilinear", "auto"};
    text_format(out, "mesh %u '%s' vertices %u faces %u corners %u material %u", id, m->name, m->vertex_count,
                m->face_count, m->corner_count, m->material);
    if (m->face_materials) text_format(out, " materials %08x", hash_indices(m->face_materials, m->face_count));
    put_floats(out, "min", m->min, 3);
    put_floats(out, "max", m->max, 3);
    text_format(out, "\n  positions %08x corners %08x\n", hash_values(m->positions, 3 * (size_t)m->vertex_count),
                hash_indices(m->face_vertices, m->corner_count));
    text_format(out, "  scheme %s level %d creases %u corners %u fans %d\n", schemes[m->subdivision.scheme],
                m->subdivision.level, m->subdivision.crease_count, m->subdivision.corner_count, m->subdivision.fan_encoded);
    for (uint32_t i = 0; i < m->primvar_count; i++) {
        const kiln_primvar *p = &m->primvars[i];
        size_t count = (size_t)p->value_count * primvar_width(p->kind);
        text_format(out, "  %s %u %s %u values %08x", kinds[p->kind], p->set, rates[p->interpolation], p->value_count,
                    hash_values(p->values, count));
        put_floats(out, "first", p->values, primvar_width(p->kind));
        text_append(out, "\n");
    }
}

static void dump_light(const kiln_light *l, uint32_t id, kiln_text *out) {
    static const char *const kinds[] = {"point", "spot", "distant"};
    text_format(out, "light %u '%s' %s", id, l->name, kinds[l->kind]);
    put_floats(out, "intensity", &l->intensity, 1);
    put_floats(out, "color", l->color, 3);
    put_floats(out, "inner", &l->inner_cone_rad, 1);
    put_floats(out, "outer", &l->outer_cone_rad, 1);
    text_append(out, "\n ");
    put_numbers(out, "transform", l->transform, 16);
    text_append(out, "\n");
}

static void dump_camera(const kiln_camera *c, uint32_t id, kiln_text *out) {
    text_format(out, "camera %u '%s' %s", id, c->name, c->projection == KILN_PERSPECTIVE ? "perspective" : "orthographic");
    put_numbers(out, "yfov", &c->yfov_rad, 1);
    put_numbers(out, "mag", (double[]){c->xmag, c->ymag}, 2);
    put_numbers(out, "aspect", &c->aspect, 1);
    put_numbers(out, "range", (double[]){c->znear, c->zfar}, 2);
    text_append(out, "\n ");
    put_numbers(out, "transform", c->transform, 16);
    text_append(out, "\n");
}

void dump_scene(const kiln_scene *s, kiln_text *out) {
    for (uint32_t i = 1; i <= s->image_count; i++) {
        const kiln_image_desc *image = scene_image(s, i);
        uint32_t hash = 0;
        for (size_t k = 0; k < image->encoded_size; k++) hash = hash_pair(hash, ((const unsigned char *)image->encoded)[k]);
        text_format(out, "image %u '%s' bytes %zu %08x\n", i, image->name, image->encoded_size, hash);
    }
    for (uint32_t i = 1; i <= s->material_count; i++) dump_material(scene_material(s, i), i, out);
    for (uint32_t i = 1; i <= s->mesh_count; i++) dump_mesh(scene_mesh(s, i), i, out);
    for (uint32_t i = 1; i <= s->instance_count; i++) {
        const kiln_instance *instance = scene_instance(s, i);
        text_format(out, "instance %u '%s' mesh %u\n ", i, instance->name, instance->mesh);
        put_numbers(out, "transform", instance->transforms[0].m, 16);
        text_append(out, "\n");
    }
    for (uint32_t i = 1; i <= s->light_count; i++) dump_light(scene_light(s, i), i, out);
    for (uint32_t i = 1; i <= s->camera_count; i++) dump_camera(kiln_scene_camera(s, i), i, out);
}

void dump_report(const kiln_report *report, size_t root_length, kiln_text *out) {
    static const char *const severities[] = {"note", "warning", "error"};
    for (size_t i = 0; i < kiln_report_size(report); i++) {
        kiln_message m = kiln_report_message(report, i);
        text_format(out, "%s %s ×%llu%s: %s\n", severities[m.severity], kiln_code_name(m.code),
                    (unsigned long long)m.count, strlen(m.where) > root_length ? m.where + root_length : "", m.what);
    }
}

static void count_features(const kiln_material *m, uint32_t *features) {
    static const kiln_texture *textures[KILN_MATERIAL_TEXTURES];
    features[0] += m->alpha_mode == KILN_ALPHA_MASK;
    features[1] += m->alpha_mode == KILN_ALPHA_BLEND;
    features[2] += m->double_sided;
    features[3] += (m->layers & KILN_LAYER_TRANSMISSION) != 0;
    features[4] += (m->layers & KILN_LAYER_VOLUME) != 0;
    features[5] += (m->layers & KILN_LAYER_UNLIT) != 0;
    features[6] += m->normal.texture.image != 0;
    features[7] += m->emission.value[0] + m->emission.value[1] + m->emission.value[2] > 0;
    features[8] += material_textures(m, textures);
    for (uint32_t k = 0; k < 8; k++) features[9 + k] += (m->layers & KILN_LAYER_CLEARCOAT << k) != 0;
}

void dump_summary(const kiln_scene *s, kiln_text *out) {
    static const char *const names[] = {"mask", "blend", "double-sided", "transmission", "volume", "unlit", "normal maps",
                                        "emissive", "textures", "clearcoat", "sheen", "anisotropy", "iridescence", "dispersion",
                                        "diffuse-transmission", "volume-scatter", "glossiness"};
    enum { FEATURES = sizeof names / sizeof *names };
    uint32_t features[FEATURES] = {0};
    kiln_scene_counts c = kiln_scene_count(s);
    kiln_bounds bounds = kiln_scene_bounds(s);
    text_format(out, "  images %u materials %u meshes %u instances %u lights %u cameras %u triangles %llu of %llu\n", c.images,
                c.materials, c.meshes, c.instances, c.lights, c.cameras, (unsigned long long)c.triangles,
                (unsigned long long)c.triangles_unique);
    put_numbers(out, " min", bounds.min, 3);
    put_numbers(out, "max", bounds.max, 3);
    text_append(out, "\n");
    for (uint32_t i = 1; i <= s->material_count; i++) count_features(scene_material(s, i), features);
    for (int i = 0; i < FEATURES; i++)
        if (features[i]) text_format(out, "  %s %u\n", names[i], features[i]);
}
