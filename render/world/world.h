/* render/world/world.h: the Scene as kernels gather from it: flat arrays, one index away.
 *
 * Render space is the scene's own: moved to its centre and scaled by a power of two to about a metre, in double,
 * before anything becomes a float. Lengths, areas, intensities and absorption are converted on the way in. */
#ifndef KILN_RENDER_WORLD_WORLD_H
#define KILN_RENDER_WORLD_WORLD_H

#include "base/arena.h"
#include "base/mat.h"
#include "base/report.h"
#include "base/vec.h"
#include "kiln/render.h"
#include "render/bsdf/kernels.h"
#include "render/effects/scan.h"
#include "render/light/table.h"
#include "render/world/texture.h"
#include "scene/scene.h"

/* A vertex as a hit needs it: 32 bytes, so that a triangle is three half cache lines. */
typedef struct world_vertex {
    float p[3];
    float n[3]; /* 0: the surface is flat there */
    float uv[2]; /* of the lowest UV set in use */
} world_vertex;

enum { WORLD_UV_SETS = 4 }; /* that textures of one scene may use */

/* A copy of some triangles. Copy 0 is everything that was baked into render space, under the identity. */
typedef struct world_instance {
    float m[12];               /* rows: p' = m p + translation */
    float normal[9];           /* rows: cofactors, divided by the longest, for normals */
    uint32_t triangle_base[2]; /* of Embree's geometries 0, opaque, and 1, with coverage */
    uint32_t prototype;        /* into world.prototypes; copy 0: none */
    uint32_t light_base;       /* of the first emitting triangle of the prototype */
    float side;                /* −1: the transform mirrors, so windings turn over */
    float magnitude;           /* largest |coordinate| on the way to render space: what rounding errors scale with */
} world_instance;

/* Triangles that several instances share, or those that are baked: of Embree's geometries 0 and 1. */
typedef struct world_prototype { uint32_t first[2], count[2]; } world_prototype;

/* Which instance of the scene a hit belongs to, by handle. */
typedef struct world_objects {
    uint32_t *copies;              /* by world_instance; that of copy 0 is not read */
    uint32_t *baked;               /* what was baked, in the order of its triangles … */
    uint32_t *first[2];            /* … which begin here, opaque and with coverage: baked_count + 1 each */
    uint32_t baked_count;
} world_objects;

typedef enum material_slot {
    SLOT_BASE, SLOT_METALLIC, SLOT_ROUGHNESS, SLOT_NORMAL, SLOT_EMISSION, SLOT_SPECULAR, SLOT_SPECULAR_COLOR,
    SLOT_TRANSMISSION, SLOT_OPACITY, SLOT_CLEARCOAT, SLOT_CLEARCOAT_ROUGHNESS, SLOT_CLEARCOAT_NORMAL, SLOT_SHEEN_COLOR,
    SLOT_SHEEN_ROUGHNESS, SLOT_ANISOTROPY, SLOT_FILM, SLOT_FILM_THICKNESS, SLOT_DIFFUSE_TRANSMISSION,
    SLOT_DIFFUSE_TRANSMISSION_COLOR, SLOT_COUNT
} material_slot;

enum {
    MATERIAL_DOUBLE_SIDED = 1 << 0,
    MATERIAL_MASK = 1 << 1,
    MATERIAL_BLEND = 1 << 2,
    MATERIAL_UNLIT = 1 << 3,
    MATERIAL_TRANSMITS = 1 << 4, /* light crosses: the surface has two sides, whatever DOUBLE_SIDED says */
    MATERIAL_GLOSSINESS = 1 << 5, /* its roughness texture and factor say 1 − roughness */
    MATERIAL_TWO_SIDED = MATERIAL_DOUBLE_SIDED | MATERIAL_TRANSMITS
};

typedef struct world_material {
    float base[3], opacity, metallic, roughness, normal_scale;
    float emission[3];
    float f0, eta, specular, specular_color[3], transmission, thin;
    float alpha_cutoff;
    float clearcoat, clearcoat_roughness, clearcoat_normal_scale;
    float sheen[3], sheen_roughness;
    float anisotropy, anisotropy_x, anisotropy_y;  /* strength; direction from the tangent */
    float film, film_ior, film_thickness[2];       /* nanometres, where a texture says 0 and 1; without one [1] */
    float diffuse_transmission, diffuse_transmission_color[3];
    uint32_t medium;           /* behind the surface: into world.media; 0: none */
    uint32_t texture[SLOT_COUNT];        /* 1 + index into world.textures; 0: none */
    uint32_t flags;
    material_kind kind;
} world_material;

/* An index of refraction that stands for infinity. */
#define WORLD_IOR_MAX 1000.0f

/* What fills a solid, beside what it takes away (world.extinction). */
typedef struct world_medium {
    bool scatters;
    float g;      /* mean cosine of scattering */
    float ior;    /* at 587.6 nm */
    float spread; /* (ior − 1)/V, V the Abbe number; 0: the index is that at all wavelengths */
} world_medium;

static inline bool material_uses_tangents(const world_material *m) {
    return m->texture[SLOT_NORMAL] || m->texture[SLOT_CLEARCOAT_NORMAL] || m->anisotropy > 0;
}

struct accel;

typedef struct world {
    kiln_arena arena;
    kiln_effect_plan plan;
    dvec3 center; /* of render space, in the scene's */
    double scale; /* render-space units per metre; a power of two */
    float radius; /* of the scene around the origin, render space */

    world_vertex *vertices;
    float *tangents;               /* 4 a vertex; NULL: no material asks for them */
    float *colors;                 /* 4 a vertex; NULL: no vertex colours */
    float *uvs[WORLD_UV_SETS]; /* UV sets after the first, which the vertex holds: uvs[k], 2 a vertex */
    uint32_t vertex_count, triangle_count;
    uint32_t *triangles;         /* 3 a triangle */
    uint32_t *triangle_material; /* index into materials */
    uint32_t *triangle_light;    /* emitter's number in its copy, or LIGHT_NONE; NULL: nothing emits */
    world_instance *instances; /* [0] is what is baked */
    uint32_t instance_count;
    world_prototype baked, *prototypes;
    uint32_t prototype_count;
    world_objects objects;

    world_material *materials; /* by kiln_id: 0 is the default material */
    uint32_t material_count;
    world_texture *textures;
    uint32_t texture_count;
    float curves[KILN_TRANSFER_COUNT][256]; /* of 8-bit textures */
    struct world_image *images;             /* what the textures read */
    uint32_t image_count;
    uint32_t uv_sets[WORLD_UV_SETS]; /* the scene's numbers of the UV sets in use */
    uint32_t uv_set_count;
    uint32_t slots;      /* bits of material_slot that some material has a texture in */
    uint32_t kinds;      /* bits of material_kind that occur */
    world_medium *media; /* [0] is air; the higher number is there where media overlap */
    uint32_t media_count;
    float *extinction;   /* of each, 3, per length in render space */
    float *absorption;   /* the same of those that do not scatter, 0 of those that do */
    float *albedo;       /* of each, 3: what part of the extinction is scattering */
    float *spectrum;     /* spectrum.h; NULL: no medium disperses */

    light_table lights;
    struct accel *accel;
} world;

/* Does the world have the effect's data; do its stages run? */
#define HOLDS(w, id) HAS((w)->plan.held, id)
#define RUNS(w, id) HAS((w)->plan.runs, id)

typedef struct world_build_options {
    const kiln_decoding *decoding; /* never NULL */
    kiln_texture_filter filter;
    kiln_effects effects;
    uint32_t threads;
    const char *embree_config;
} world_build_options;

static inline bool world_wants_tangents(const world *w) { return HOLDS(w, NORMAL_MAPS) || HOLDS(w, ANISOTROPY); }

/* Reads scene and the options, and builds everything. false: reported. */
bool world_create(const kiln_scene *, const world_build_options *, world **, kiln_report *);
/* The plan of the world that would be built: decodes what building would, for what there is to see and for the errors,
 * and keeps nothing. */
bool world_plan(const kiln_scene *, const world_build_options *, kiln_effect_plan *, kiln_report *);
void world_destroy(world *);

/* The parts, in the order in which world_create calls them. */
void world_choose_space(world *, const kiln_scene *);
bool world_build_materials(world *, reduced_scene *, const world_build_options *, kiln_report *);
bool world_build_geometry(world *, const reduced_scene *, uint32_t threads, kiln_report *);
/* Appends a copy of a prototype whose coordinates are relative to center. */
void world_place_instance(world *, const kiln_instance *, const kiln_mesh *, uint32_t prototype, dvec3 center);
bool world_build_lights(world *, const reduced_scene *, const kiln_decoding *, uint32_t threads, kiln_report *);

/* Scene to render space. */
static inline dvec3 world_point(const world *w, dvec3 p) { return d3_scale(d3_sub(p, w->center), w->scale); }
static inline vec3 to_float(dvec3 v) { return v3((float)v.x, (float)v.y, (float)v.z); }

/* A rotation as turns in [−½, ½]: a float has digits for many turns or for a fine angle, not for both. */
static inline float to_turns(double radians) { return (float)remainder(radians / (2 * M_PI), 1); }

/* A copy's coordinates in render space. Vectors and normals come out with other lengths than they had. */
static inline vec3 world_instance_point(const world_instance *i, vec3 p) {
    const float *m = i->m;
    return v3(m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
              m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]);
}
static inline vec3 world_instance_vector(const world_instance *i, vec3 v) {
    const float *m = i->m;
    return v3(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
              m[8] * v.x + m[9] * v.y + m[10] * v.z);
}
static inline vec3 world_instance_normal(const world_instance *i, vec3 n) { return v3_transform(i->normal, n); }

#endif
