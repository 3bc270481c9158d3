#include <stdlib.h>

#include "image/image.h"
#include "job/inspect.h"
#include "scene/scene.h"

/* The textures of a material by the parameter that they multiply. */
typedef struct slot {
    const char *name;
    const kiln_texture *texture;
    uint32_t needs; /* bits of kiln_layer without which it is not read */
} slot;

static json_t *texture(const slot *s) {
    static const char *const transfers[] = {[KILN_TRANSFER_DATA] = "data", [KILN_TRANSFER_SRGB] = "srgb",
                                            [KILN_TRANSFER_LINEAR] = "linear"};
    static const char *const wraps[] = {[KILN_WRAP_REPEAT] = "repeat", [KILN_WRAP_MIRROR] = "mirror",
                                        [KILN_WRAP_CLAMP] = "clamp"};
    static const char *const filters[] = {[KILN_FILTER_LINEAR] = "linear", [KILN_FILTER_NEAREST] = "nearest"};
    const kiln_texture *t = s->texture;
    json_t *o = json_object();
    put_text(o, "slot", s->name);
    put_count(o, "image", t->image - 1);
    put_count(o, "uv_set", t->uv_set);
    put_text(o, "transfer", transfers[t->transfer]);
    put_text(o, "wrap_u", wraps[t->wrap_u]);
    put_text(o, "wrap_v", wraps[t->wrap_v]);
    put_text(o, "filter", filters[t->filter]);
    return o;
}

static json_t *textures(const kiln_material *m) {
    const uint32_t transmission = KILN_LAYER_TRANSMISSION, volume = KILN_LAYER_VOLUME;
    const slot slots[] = {{"base_color", &m->base_color.texture, 0},
                          {"opacity", &m->opacity.texture, 0},
                          {"metallic", &m->metallic.texture, 0},
                          {"roughness", &m->roughness.texture, 0},
                          {"normal", &m->normal.texture, 0},
                          {"emission", &m->emission.texture, 0},
                          {"specular", &m->specular.texture, 0},
                          {"specular_color", &m->specular_color.texture, 0},
                          {"transmission", &m->transmission.texture, transmission},
                          {"thickness", &m->thickness.texture, volume}};
    json_t *array = json_array();
    for (size_t i = 0; i < sizeof slots / sizeof *slots; i++)
        if (slots[i].texture->image && (m->layers & slots[i].needs) == slots[i].needs)
            (void)json_array_append_new(array, texture(&slots[i]));
    return array;
}

static json_t *layers(const kiln_material *m) {
    const struct { uint32_t layer; const char *name; } rows[] = {{KILN_LAYER_TRANSMISSION, "transmission"},
                                                                 {KILN_LAYER_VOLUME, "volume"},
                                                                 {KILN_LAYER_UNLIT, "unlit"}};
    json_t *array = json_array();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (m->layers & rows[i].layer) (void)json_array_append_new(array, json_string(rows[i].name));
    return array;
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
    put(o, "base_color", json_floats_of(m->base_color.value, 3));
    put_number(o, "opacity", (double)m->opacity.value);
    put_number(o, "metallic", (double)m->metallic.value);
    put_number(o, "roughness", (double)m->roughness.value);
    put(o, "emission", json_floats_of(m->emission.value, 3));
    put_number(o, "ior", (double)m->ior);
    put_number(o, "specular", (double)m->specular.value);
    put(o, "specular_color", json_floats_of(m->specular_color.value, 3));
    if (m->layers & KILN_LAYER_TRANSMISSION) put_number(o, "transmission", (double)m->transmission.value);
    if (m->layers & KILN_LAYER_VOLUME) {
        put_number(o, "thickness", (double)m->thickness.value);
        put(o, "attenuation_distance",
            m->attenuation_distance > 0 ? json_number_of((double)m->attenuation_distance) : json_null());
        put(o, "attenuation_color", json_floats_of(m->attenuation_color, 3));
    }
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
