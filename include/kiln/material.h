/* kiln/material.h: textures and the one closed material description.
 *
 * The material is the metallic-roughness model of glTF 2.0 with its KHR_materials extensions; other models are
 * mapped onto it by their importers. Every parameter is a constant, times a texture where one is given. */
#ifndef KILN_MATERIAL_H
#define KILN_MATERIAL_H

#include "kiln/api.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How the numbers of a picture become scene-linear values. */
typedef enum kiln_transfer {
    KILN_TRANSFER_DATA,   /* no colour: normals, roughness, masks. Integers map to [0,1], floats are taken as they are,
                             and clamped to the domain of the parameter, with a warning */
    KILN_TRANSFER_SRGB,   /* sRGB curve and primaries */
    KILN_TRANSFER_LINEAR, /* scene-linear with Rec.709 primaries */
    KILN_TRANSFER_COUNT
} kiln_transfer;

typedef enum kiln_wrap { KILN_WRAP_REPEAT, KILN_WRAP_MIRROR, KILN_WRAP_CLAMP } kiln_wrap;
typedef enum kiln_filter { KILN_FILTER_LINEAR, KILN_FILTER_NEAREST } kiln_filter;

/* A use of an image. u runs to the right and v down from the top left corner (glTF). Zero-initialised: no texture. */
typedef struct kiln_texture {
    kiln_id image;          /* 0: no texture */
    uint32_t uv_set;        /* which UV primvar of the mesh */
    float transform[6];     /* (u', v') = (t0 u + t1 v + t2, t3 u + t4 v + t5); all zero means the identity */
    kiln_wrap wrap_u, wrap_v;
    kiln_filter filter;
    kiln_transfer transfer;
    uint32_t channel;       /* scalar parameters: which channel, 0 R … 3 A; a channel that is missing reads as glTF's
                               expansion (grey to RGB, alpha 1) */
} kiln_texture;

typedef struct kiln_param1 { float value; kiln_texture texture; } kiln_param1;    /* value × texture */
typedef struct kiln_param3 { float value[3]; kiln_texture texture; } kiln_param3; /* linear Rec.709 × texture */

typedef enum kiln_alpha_mode { KILN_ALPHA_OPAQUE, KILN_ALPHA_MASK, KILN_ALPHA_BLEND } kiln_alpha_mode;

/* Layers that a material has; parameters of an absent layer are not read. */
typedef enum kiln_layer {
    KILN_LAYER_TRANSMISSION = 1 << 0, /* KHR_materials_transmission */
    KILN_LAYER_VOLUME = 1 << 1,       /* KHR_materials_volume: the surface bounds a solid */
    KILN_LAYER_UNLIT = 1 << 2,        /* KHR_materials_unlit: base colour is seen as radiance, in cd/m², by every ray
                                         that meets it, bounces too; it reflects nothing, and is no light to sample */
    KILN_LAYER_CLEARCOAT = 1 << 3,
    KILN_LAYER_SHEEN = 1 << 4,
    KILN_LAYER_ANISOTROPY = 1 << 5,
    KILN_LAYER_IRIDESCENCE = 1 << 6,
    KILN_LAYER_DISPERSION = 1 << 7,
    KILN_LAYER_DIFFUSE_TRANSMISSION = 1 << 8,
    KILN_LAYER_VOLUME_SCATTER = 1 << 9, /* of the volume; nothing without KILN_LAYER_VOLUME */
    KILN_LAYER_GLOSSINESS = 1 << 10     /* roughness is 1 − value × texture (KHR_materials_pbrSpecularGlossiness) */
} kiln_layer;

typedef struct kiln_material {
    const char *name;
    uint32_t layers; /* of kiln_layer */
    kiln_alpha_mode alpha_mode;
    float alpha_cutoff;
    bool double_sided;
    kiln_param3 base_color;
    kiln_param1 opacity; /* alpha; BLEND: coverage, MASK: compared with alpha_cutoff */
    kiln_param1 metallic;
    kiln_param1 roughness; /* perceptual: GGX alpha = roughness² */
    kiln_param1 normal;    /* value scales x and y of the tangent-space map (texture with DATA transfer) */
    kiln_param3 emission;  /* radiance, cd/m² per channel */
    float ior;             /* KHR_materials_ior; 0 stands for infinity: a Fresnel term of 1 */
    kiln_param1 specular;  /* KHR_materials_specular */
    kiln_param3 specular_color;
    kiln_param1 transmission;
    kiln_param1 thickness;      /* > 0: the mesh is a closed solid; 0: an infinitely thin wall */
    float attenuation_distance; /* metres; 0 stands for infinity: clear */
    float attenuation_color[3];
    int32_t priority;           /* where volumes overlap the higher one is there; equal ones: that of the smaller mesh */
    kiln_param1 clearcoat, clearcoat_roughness, clearcoat_normal; /* KHR_materials_clearcoat */
    kiln_param3 sheen_color;                                      /* KHR_materials_sheen */
    kiln_param1 sheen_roughness;
    kiln_param1 anisotropy;       /* KHR_materials_anisotropy: strength; its texture holds the direction in R and G, [0,1]
                                     for [−1,1], and B × strength */
    float anisotropy_rotation;    /* radians, counter-clockwise from the tangent */
    kiln_param1 iridescence;      /* KHR_materials_iridescence */
    float iridescence_ior;        /* of the film, ≥ 1 */
    float iridescence_thickness[2]; /* nanometres, where the texture's channel is 0 and 1; without a texture [1] */
    kiln_texture iridescence_thickness_texture;
    kiln_param1 diffuse_transmission; /* KHR_materials_diffuse_transmission */
    kiln_param3 diffuse_transmission_color;
    float dispersion;             /* KHR_materials_dispersion: 20/V, V the Abbe number; 0: none */
    float multiscatter_color[3];  /* KHR_materials_volume_scatter: albedo after all scattering, [0,1] */
    float scatter_anisotropy;     /* of Henyey and Greenstein's phase function, (−1, 1) */
} kiln_material;

/* glTF's defaults: white, metallic 1, roughness 1, opaque, single-sided, ior 1.5, no layers. */
KILN_API kiln_material kiln_material_default(void);

#ifdef __cplusplus
}
#endif
#endif
