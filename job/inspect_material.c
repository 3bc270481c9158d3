#include <stdlib.h>

#include "image/image.h"
#include "job/inspect.h"
#include "scene/material.h"
#include "scene/scene.h"

static json_t *texture(const char *slot, const kiln_texture *t) {
    static const char *const transfers[] = {[KILN_TRANSFER_DATA] = "data", [KILN_TRANSFER_SRGB] = "srgb",
                                            [KILN_TRANSFER_LINEAR] = "linear"};
    static const char *const wraps[] = {[KILN_WRAP_REPEAT] = "repeat", [KILN_WRAP_MIRROR] = "mirror",
                                        [KILN_WRAP_CLAMP] = "clamp"};
    static const char *const filters[] = {[KILN_FILTER_LINEAR] = "linear", [KILN_FILTER_NEAREST] = "nearest"};
    json_t *o = json_object();
    put_text(o, "slot", slot);
    put_count(o, "image", t->image - 1);
    put_count(o, "uv_set", t->uv_set);
    put_text(o, "transfer", transfers[t->transfer]);
    put_text(o, "wrap_u", wraps[t->wrap_u]);
    put_text(o, "wrap_v", wraps[t->wrap_v]);
    put_text(o, "filter", filters[t->filter]);
    return o;
}

static json_t *textures(const kiln_material *m) {
    json_t *array = json_array();
    material_parameter p;
    for (int i = 0; i < KILN_MATERIAL_TEXTURES; i++)
        if (material_parameter_of(m, i, &p) && p.texture->image)
            (void)json_array_append_new(array, texture(p.name, p.texture));
    return array;
}

static json_t *layers(const kiln_material *m) {
    static const struct { uint32_t layer; const char *name; } rows[] = {
        {KILN_LAYER_TRANSMISSION, "transmission"},
        {KILN_LAYER_VOLUME, "volume"},
        {KILN_LAYER_UNLIT, "unlit"},
        {KILN_LAYER_CLEARCOAT, "clearcoat"},
        {KILN_LAYER_SHEEN, "sheen"},
        {KILN_LAYER_ANISOTROPY, "anisotropy"},
        {KILN_LAYER_IRIDESCENCE, "iridescence"},
        {KILN_LAYER_DISPERSION, "dispersion"},
        {KILN_LAYER_DIFFUSE_TRANSMISSION, "diffuse_transmission"},
        {KILN_LAYER_VOLUME_SCATTER, "volume_scatter"},
        {KILN_LAYER_GLOSSINESS, "glossiness"}};
    json_t *array = json_array();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (m->layers & rows[i].layer) (void)json_array_append_new(array, json_string(rows[i].name));
    return array;
}

/* What may have a texture. */
static void put_parameters(json_t *o, const kiln_material *m) {
    material_parameter p;
    for (int i = 0; i < KILN_MATERIAL_TEXTURES; i++) {
        if (!material_parameter_of(m, i, &p)) continue;
        if (p.width == 1) put_number(o, p.name, (double)*p.values);
        if (p.width == 3) put(o, p.name, json_floats_of(p.values, 3));
    }
}

static void put_constants(json_t *o, const kiln_material *m) {
    put_number(o, "ior", (double)m->ior);
    if (m->layers & KILN_LAYER_VOLUME) {
        put(o, "attenuation_distance",
            m->attenuation_distance > 0 ? json_number_of((double)m->attenuation_distance) : json_null());
        put(o, "attenuation_color", json_floats_of(m->attenuation_color, 3));
        put_number(o, "priority", m->priority);
    }
    if (m->layers & KILN_LAYER_ANISOTROPY) put_number(o, "anisotropy_rotation", (double)m->anisotropy_rotation);
    if (m->layers & KILN_LAYER_IRIDESCENCE) {
        put_number(o, "iridescence_ior", (double)m->iridescence_ior);
        put(o, "iridescence_thickness", json_floats_of(m->iridescence_thickness, 2));
    }
    if (m->layers & KILN_LAYER_DISPERSION) put_number(o, "dispersion", (double)m->dispersion);
    if (m->layers & KILN_LAYER_VOLUME_SCATTER) {
        put(o, "multiscatter_color", json_floats_of(m->multiscatter_color, 3));
        put_number(o, "scatter_anisotropy", (double)m->scatter_anisotropy);
    }
}

static json_t *material(const kiln_material *m) {
    static const char *const modes[] = {[KILN_ALPHA_OPAQUE] = "opaque", [KILN_ALPHA_MASK] = "mask",
                                        [KILN_ALPHA_BLEND] = "blend"};
    json_t *o = json_object();
    put_text(o, "name", m->name);
    put(o, "layers", layers(m));
    put_text(o, "alpha_mode", modes[m->alpha_mode]);
    if (m->alpha_mode == KILN_ALPHA_MASK) put_number(o, "alpha_cutoff", (double)m->alpha_cutoff);
    put_bool(o, "double_sided", m->double_sided);
    put_parameters(o, m);
    put_constants(o, m);
    put(o, "textures", textures(m));
    return o;
}

json_t *inspect_materials(const kiln_scene *scene) {
    json_t *array = json_array();
    for (uint32_t i = 0; i < scene->material_count; i++)
        (void)json_array_append_new(array, material(&scene->materials[i]));
    return array;
}

static const char *kind_name(kiln_image_kind kind) {
    static const char *const names[] = {[KILN_IMAGE_UNKNOWN] = "pixels",   [KILN_IMAGE_PNG] = "PNG",
                                        [KILN_IMAGE_JPEG] = "JPEG",        [KILN_IMAGE_WEBP] = "WebP",
                                        [KILN_IMAGE_TIFF] = "TIFF",        [KILN_IMAGE_EXR] = "OpenEXR",
                                        [KILN_IMAGE_HDR] = "Radiance HDR", [KILN_IMAGE_KTX2] = "KTX2"};
    return names[kind];
}

/* An image whose header cannot be read has a null format; were it used, there would be an error. */
static json_t *image(const kiln_image_desc *from, uint64_t *decoded_bytes) {
    static const uint32_t bits[] = {[KILN_PIXELS_U8] = 8, [KILN_PIXELS_U16] = 16, [KILN_PIXELS_F32] = 32};
    kiln_image_info info = {KILN_IMAGE_UNKNOWN, from->width, from->height, from->channels, from->format};
    kiln_report *ignored = kiln_report_create();
    json_t *o = json_object();
    put_text(o, "name", from->name);
    bool known = ignored && (!from->encoded || image_probe(from->encoded, from->encoded_size, &info, NULL, ignored));
    kiln_report_destroy(ignored);
    put(o, "format", known ? json_string(kind_name(info.kind)) : json_null());
    if (from->encoded) put_count(o, "encoded_bytes", from->encoded_size);
    if (!known) return o;
    uint64_t bytes = (uint64_t)info.width * info.height * 4 * (info.format == KILN_PIXELS_U8 ? 1 : sizeof(float));
    put_count(o, "width", info.width);
    put_count(o, "height", info.height);
    put_count(o, "channels", info.channels);
    put_count(o, "bits", bits[info.format]);
    put_count(o, "decoded_bytes", bytes);
    *decoded_bytes += bytes;
    return o;
}

json_t *inspect_images(const kiln_scene *scene, uint32_t count, uint64_t *decoded_bytes) {
    json_t *array = json_array();
    for (uint32_t i = 0; i < count; i++) (void)json_array_append_new(array, image(&scene->images[i], decoded_bytes));
    return array;
}
