/* importers/gltf/document.h: a glTF 2.0 document as plain data, with glTF's own names. Indices are as in the file, −1
 * where there is none; document_check says whether they lead anywhere. */
#ifndef KILN_IMPORTERS_GLTF_DOCUMENT_H
#define KILN_IMPORTERS_GLTF_DOCUMENT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Extensions and extras: any JSON. Empty arrays and objects inside have become null. */
typedef enum gltf_value_kind {
    GLTF_NULL,
    GLTF_BOOL,
    GLTF_NUMBER,
    GLTF_STRING,
    GLTF_ARRAY,
    GLTF_OBJECT
} gltf_value_kind;

typedef struct gltf_value {
    gltf_value_kind kind;
    bool boolean;
    double number;
    const char *string;
    size_t count;                   /* of an array or object */
    const char *const *keys;        /* of an object */
    const struct gltf_value *items; /* of an array or object */
} gltf_value;

typedef struct gltf_view {
    int buffer;
    size_t offset, length, stride; /* stride 0: none given */
} gltf_view;

/* Component types as in the file. */
enum {
    GLTF_BYTE = 5120,
    GLTF_UNSIGNED_BYTE = 5121,
    GLTF_SHORT = 5122,
    GLTF_UNSIGNED_SHORT = 5123,
    GLTF_UNSIGNED_INT = 5125,
    GLTF_FLOAT = 5126
};

typedef struct gltf_sparse {
    size_t count; /* 0: not sparse */
    int indices_view, indices_type, values_view;
    size_t indices_offset, values_offset;
} gltf_sparse;

typedef struct gltf_accessor {
    int view;
    size_t offset, count;
    int component_type;
    uint32_t rows, columns; /* VEC3: 3 × 1, MAT4: 4 × 4 */
    bool normalized;
    gltf_sparse sparse;
} gltf_accessor;

typedef struct gltf_attribute {
    const char *name;
    int accessor;
} gltf_attribute;

typedef struct gltf_attributes {
    const gltf_attribute *items;
    size_t count;
} gltf_attributes;

typedef struct gltf_primitive {
    gltf_attributes attributes;
    const gltf_attributes *targets; /* morph targets */
    size_t target_count;
    int indices, material, mode;
    gltf_value extensions;
} gltf_primitive;

typedef struct gltf_mesh {
    const char *name;
    const gltf_primitive *primitives;
    size_t primitive_count;
    gltf_value extras;
} gltf_mesh;

typedef struct gltf_numbers {
    const double *items;
    size_t count;
} gltf_numbers;

typedef struct gltf_indices {
    const int *items;
    size_t count;
} gltf_indices;

typedef struct gltf_node {
    const char *name;
    int mesh, skin, camera;
    gltf_indices children;
    gltf_numbers matrix, translation, rotation, scale; /* count 0: not given */
    gltf_value extensions, extras;
} gltf_node;

typedef struct gltf_texture_info {
    int texture; /* −1: none */
    int uv_set;
    double factor; /* scale of a normal map, strength of occlusion */
    gltf_value extensions;
} gltf_texture_info;

typedef struct gltf_material {
    const char *name, *alpha_mode;
    double base_color[4], metallic, roughness, emissive[3], alpha_cutoff;
    bool double_sided;
    gltf_texture_info base_color_texture, metallic_roughness_texture, normal_texture, occlusion_texture,
        emissive_texture;
    gltf_value extensions, extras;
} gltf_material;

typedef struct gltf_texture {
    int sampler, source;
    gltf_value extensions;
} gltf_texture;

typedef struct gltf_sampler {
    int mag_filter, min_filter; /* −1: not given */
    int wrap_s, wrap_t;
} gltf_sampler;

typedef struct gltf_camera {
    const char *name;
    bool orthographic;
    double aspect, yfov, xmag, ymag, znear, zfar; /* aspect, zfar of a perspective 0: not given */
} gltf_camera;

typedef struct gltf_light {
    const char *name, *type;
    gltf_numbers color;
    double intensity, inner_cone, outer_cone;
} gltf_light;

typedef struct gltf_skin {
    gltf_indices joints;
    int inverse_bind_matrices, skeleton;
} gltf_skin;

typedef struct gltf_channel {
    int sampler, node;
} gltf_channel;

typedef struct gltf_animation_sampler {
    int input, output;
} gltf_animation_sampler;

typedef struct gltf_animation {
    const gltf_channel *channels;
    const gltf_animation_sampler *samplers;
    size_t channel_count, sampler_count;
} gltf_animation;

typedef struct gltf_document {
    const gltf_view *views;
    const gltf_accessor *accessors;
    const gltf_mesh *meshes;
    const gltf_node *nodes;
    const gltf_indices *scenes;
    const gltf_material *materials;
    const gltf_texture *textures;
    const gltf_sampler *samplers;
    const gltf_camera *cameras;
    const gltf_light *lights;
    const gltf_skin *skins;
    const gltf_animation *animations;
    size_t view_count, accessor_count, mesh_count, node_count, scene_count, material_count, texture_count,
        sampler_count, camera_count, light_count, skin_count, animation_count;
    int scene; /* the default one; −1: not given */
} gltf_document;

#ifdef __cplusplus
}
#endif
#endif
