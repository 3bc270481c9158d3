/* render/path/batch.h: about a thousand paths that advance together, as a structure of arrays.
 *
 * All paths of a batch are at the same depth. A stage is a loop over lanes [0, n), n a multiple of 16: the lanes that
 * fill it up are copies of a path with no throughput, whose radiance goes to a slot that nobody reads. Arrays are parts
 * of one struct, so that the compiler knows that they do not overlap, and a little longer than a power of two, so that
 * equal indices do not compete for the same cache lines. */
#ifndef KILN_RENDER_PATH_BATCH_H
#define KILN_RENDER_PATH_BATCH_H

#include <stdint.h>

#include "render/accel/accel.h"
#include "render/bsdf/bsdf.h"
#include "render/path/stage_clock.h"
#include "render/path/touch.h"
#include "render/world/world.h"

enum {
    BATCH_PATHS = 1024,
    LANE_GROUP = 16,
    LANES = BATCH_PATHS + KIND_COUNT * LANE_GROUP + 2 * LANE_GROUP, /* a group's end for each kind, and the padding */
    SLOT_NOWHERE = BATCH_PATHS /* where radiance of filling lanes goes */
};

/* What a path carries from bounce to bounce: moved when dead paths are closed up. */
#define PATH_STATE(X)                                                                                                  \
    X(float, ox) X(float, oy) X(float, oz)       /* origin of the ray */                                               \
    X(float, dx) X(float, dy) X(float, dz)       /* direction, unit length */                                          \
    X(float, tr) X(float, tg) X(float, tb)       /* throughput */                                                      \
    X(float, lr) X(float, lg) X(float, lb)       /* radiance collected */                                              \
    X(float, pdf)                                /* of the direction; 0: from the camera or a delta lobe */            \
    X(float, squeeze)                            /* η² that the throughput was divided by, for roulette */             \
    X(uint32_t, slot)                            /* which of the batch's samples this is */                            \
    X(uint32_t, seed) X(uint32_t, index)         /* sample_point */

/* The same, where the world has solids: the stack of media around the origin (medium.h). */
#define PATH_MEDIA(X) X(uint64_t, media)

/* The cone of the path (cone.h): in scenes that filter textures, moved too. */
#define PATH_CONE(X) X(float, width) X(float, spread)

/* Where the path was last lit, in scenes with area lights; the rest of a vantage (render/light/tree.h), where lights are
 * chosen by where they are. */
#define PATH_PLACE(X) X(float, from_x) X(float, from_y) X(float, from_z)
#define PATH_VANTAGE(X) X(float, up_x) X(float, up_y) X(float, up_z) X(float, far_share)

/* The same, where there are solids: how many steps were no bounces off a surface: events in media that scatter, and
 * boundaries that are hidden in another medium. */
#define PATH_EVENTS(X) X(uint32_t, events)

/* Where the ray has met a surface: moved with the path, once. Where the medium in front of it has scattered the path, t is
 * the distance to there, and u says so. */
#define HIT_SCATTERED (-1.0f)
#define PATH_HIT(X) X(float, t) X(float, u) X(float, v) X(uint32_t, triangle) X(uint32_t, instance)

/* The same, where solids may touch: the stack of media behind the surface. */
#define PATH_TOUCH(X) X(uint64_t, beyond)

#define LANE_ARRAY(type, name) _Alignas(64) type name[LANES];
typedef struct path_state {
    PATH_STATE(LANE_ARRAY) PATH_MEDIA(LANE_ARRAY) PATH_CONE(LANE_ARRAY) PATH_EVENTS(LANE_ARRAY)
    PATH_PLACE(LANE_ARRAY) PATH_VANTAGE(LANE_ARRAY)
} path_state;
typedef struct path_hit { PATH_HIT(LANE_ARRAY) PATH_TOUCH(LANE_ARRAY) } path_hit;

/* A triangle's corners, in render space. */
#define TRIANGLE_FIELDS(X)                                                                                             \
    X(float, p0x) X(float, p0y) X(float, p0z) X(float, p1x) X(float, p1y) X(float, p1z)                                \
    X(float, p2x) X(float, p2y) X(float, p2z)                                                                          \
    X(float, n0x) X(float, n0y) X(float, n0z) X(float, n1x) X(float, n1y) X(float, n1z)                                \
    X(float, n2x) X(float, n2y) X(float, n2z)                                                                          \
    X(float, s0) X(float, t0) X(float, s1) X(float, t1) X(float, s2) X(float, t2) /* UV */                             \
    X(float, side) X(float, magnitude)                                            /* of the copy */                    \
    X(uint32_t, material)

/* The point that is shaded. Normals are on wo's side. */
#define POINT_FIELDS(X)                                                                                                \
    X(float, px) X(float, py) X(float, pz)                                                                             \
    X(float, gx) X(float, gy) X(float, gz)       /* geometric normal */                                                \
    X(float, nx) X(float, ny) X(float, nz)       /* shading normal */                                                  \
    X(float, reach)                              /* rays must start this far along the geometric normal */             \
    X(float, plane_x) X(float, plane_y) X(float, plane_z) /* of the plane that parts the sides (surface_sides) */       \
    X(float, above_x) X(float, above_y) X(float, above_z) /* where rays leave on wo's side */                           \
    X(float, below_x) X(float, below_y) X(float, below_z) /* where rays leave on the far side */                        \
    X(float, area)                               /* of the triangle */                                                 \
    X(float, front)                              /* 1: seen from the front, 0: from behind */                          \
    X(float, tu) X(float, tv)                    /* UV of the first set */

/* The cone at the point, where textures are filtered. */
#define CONE_FIELDS(X)                                                                                                 \
    X(float, across)                             /* its width */                                                       \
    X(float, foot_uu) X(float, foot_uv) X(float, foot_vv) /* texture_footprint in the first UV set */                  \
    X(float, curve_low) X(float, curve_high)     /* principal curvatures, on wo's side */                              \
    X(float, came_x) X(float, came_y) X(float, came_z) /* direction of the ray that met the point */

/* What the material says there. */
#define MATERIAL_FIELDS(X)                                                                                             \
    X(float, base_r) X(float, base_g) X(float, base_b)                                                                 \
    X(float, metallic) X(float, roughness) X(float, specular) X(float, f0)                                             \
    X(float, tint_r) X(float, tint_g) X(float, tint_b) /* of the coat's F0 */                                          \
    X(float, transmission) X(float, eta) X(float, thin)                                                                \
    X(float, hue_r) X(float, hue_g) X(float, hue_b) /* tints what passes: of the wavelength that the path takes on */  \
    X(uint64_t, beyond)                          /* stack of media behind the surface */                               \
    X(uint32_t, hidden)                          /* 1: a boundary that is not there, within another medium */          \
    X(float, g)                                  /* mean cosine of the medium's scattering */                          \
    X(uint32_t, crosses)                         /* the next ray lies on the far side */                               \
    X(float, emit_r) X(float, emit_g) X(float, emit_b)                                                                 \
    X(float, map_x) X(float, map_y) X(float, map_z) /* tangent-space normal */                                         \
    X(float, tan_x) X(float, tan_y) X(float, tan_z) X(float, tan_w)

/* What materials with BSDF_LAYERED, or a part of it, say besides. */
#define LAYER_FIELDS(X)                                                                                                \
    X(float, near_layers) X(float, far_layers)   /* 1: on wo's side, on the far side */                                \
    X(float, clearcoat) X(float, clearcoat_roughness)                                                                  \
    X(float, coat_x) X(float, coat_y) X(float, coat_z) /* tangent-space normal, then in render space, facing wo */     \
    X(float, sheen_r) X(float, sheen_g) X(float, sheen_b) X(float, sheen_roughness)                                    \
    X(float, anisotropy)                                                                                               \
    X(float, along_u) X(float, along_v)          /* direction of greater roughness: from the tangent */                \
    X(float, along_x) X(float, along_y) X(float, along_z) /* in render space, at a right angle to the normal */        \
    X(float, film) X(float, film_ior) X(float, film_thickness)                                                         \
    X(float, pass) X(float, pass_r) X(float, pass_g) X(float, pass_b) /* diffuse transmission, its colour */

/* The light sample. */
#define LIGHT_FIELDS(X)                                                                                                \
    X(float, wx) X(float, wy) X(float, wz)       /* direction to the light */                                          \
    X(float, sox) X(float, soy) X(float, soz)    /* shadow ray */                                                      \
    X(float, sdx) X(float, sdy) X(float, sdz)                                                                          \
    X(float, distance)                           /* of the light, for media */                                         \
    X(float, tx) X(float, ty) X(float, tz)       /* where the shadow ray ends, for lights that have a place */         \
    X(float, cr) X(float, cg) X(float, cb)       /* radiance, then what it contributes */                              \
    X(float, light_pdf)                          /* density of the direction times the light's probability */          \
    X(float, parallel)                           /* 1: nothing can hit the light: no weighting */                      \
    X(uint32_t, visible)

/* The chosen light, as a kernel reads it. */
#define CHOSEN_FIELDS(X)                                                                                               \
    X(float, qx) X(float, qy) X(float, qz) X(float, e1x) X(float, e1y) X(float, e1z)                                   \
    X(float, e2x) X(float, e2y) X(float, e2z) X(float, ax) X(float, ay) X(float, az)                                   \
    X(float, rr) X(float, rg) X(float, rb)       /* radiance */                                                        \
    X(float, light_area) X(float, light_error) X(float, spot_scale) X(float, spot_offset)                              \
    X(float, one_minus_cos) X(float, two_sided) X(float, quad) X(float, probability)                                                  \
    X(uint32_t, light) X(uint32_t, light_kind)                                                                         \
    X(uint32_t, row) X(uint32_t, column) X(float, across_texel) X(float, down_texel) /* environment_choice */

/* Lanes in media that scatter, gathered: what their flights start with, and what comes of them. */
#define FLIGHT_FIELDS(X)                                                                                               \
    X(float, carried_r) X(float, carried_g) X(float, carried_b) /* throughput */                                       \
    X(float, sigma_r) X(float, sigma_g) X(float, sigma_b) X(float, albedo_r) X(float, albedo_g) X(float, albedo_b)     \
    X(uint32_t, flight_seed) X(uint32_t, flight_index)                                                                 \
    X(float, limit) X(float, flown) X(float, scatters)                                                                 \
    X(float, weight_r) X(float, weight_g) X(float, weight_b)

/* Random numbers of a bounce. */
#define RANDOM_FIELDS(X)                                                                                               \
    X(float, u_light_x) X(float, u_light_y) X(float, u_fine)                                                           \
    X(float, u_bsdf_x) X(float, u_bsdf_y) X(float, u_lobe) X(float, u_roulette)

typedef struct path_scratch {
    TRIANGLE_FIELDS(LANE_ARRAY)
    POINT_FIELDS(LANE_ARRAY)
    CONE_FIELDS(LANE_ARRAY)
    MATERIAL_FIELDS(LANE_ARRAY)
    LAYER_FIELDS(LANE_ARRAY)
    union { /* flights are over when light is sampled */
        struct { LIGHT_FIELDS(LANE_ARRAY) CHOSEN_FIELDS(LANE_ARRAY) };
        struct { FLIGHT_FIELDS(LANE_ARRAY) };
    };
    RANDOM_FIELDS(LANE_ARRAY)
    LANE_ARRAY(float, tnear)
    LANE_ARRAY(float, tfar)
    LANE_ARRAY(uint32_t, list)
    LANE_ARRAY(uint32_t, order)
    touch touches[LANES];
} path_scratch;

/* Results, by slot. */
typedef struct path_output {
    float r[BATCH_PATHS + 1], g[BATCH_PATHS + 1], b[BATCH_PATHS + 1];
    float beyond_r[BATCH_PATHS + 1], beyond_g[BATCH_PATHS + 1], beyond_b[BATCH_PATHS + 1]; /* found past the depth limit */
    float alpha[BATCH_PATHS + 1], depth[BATCH_PATHS + 1];
    float albedo[3][BATCH_PATHS + 1], normal[3][BATCH_PATHS + 1], position[3][BATCH_PATHS + 1], uv[2][BATCH_PATHS + 1];
    uint32_t object[BATCH_PATHS + 1], material[BATCH_PATHS + 1]; /* handles */
    uint8_t refused[BATCH_PATHS + 1]; /* Embree was spared a ray of this sample */
} path_output;

/* Lanes of one material kind. */
typedef struct lane_range { uint32_t first, end; } lane_range;

struct path_parts;

typedef struct batch {
    path_state states[2]; /* the current one, and where it moves to */
    path_hit hits[2];
    path_scratch scratch;
    path_output out;
    struct path_parts *parts; /* NULL: nobody wants them */
    uint32_t current; /* of states and hits */
    uint32_t n;       /* lanes, a multiple of LANE_GROUP */
    uint32_t surfaces; /* the first of them, after a sort: at surfaces; the rest scatter in a medium */
    uint32_t depth;   /* scattering events so far */
    lane_range kinds[KIND_COUNT];
    trace_counts camera_rays, bounce_rays, shadow_rays;
    stage_clock clock;
} batch;

/* Of some kinds that follow one another. */
static inline lane_range kinds_range(const batch *b, material_kind first, material_kind last) {
    return (lane_range){b->kinds[first].first, b->kinds[last].end};
}

static inline path_state *batch_state(batch *b) { return &b->states[b->current]; }
static inline path_hit *batch_hit(batch *b) { return &b->hits[b->current]; }

/* After a sort: the lanes whose kernels have a term. */
static inline lane_range lanes_with(const batch *b, unsigned term) {
    return (lane_range){b->kinds[kernel_for(term)].first, b->surfaces};
}

static inline uint32_t lanes_round_up(uint32_t n) { return (n + LANE_GROUP - 1) / LANE_GROUP * LANE_GROUP; }

/* In front of a loop over lanes: iterations are independent. */
#define LANE_LOOP _Pragma("GCC ivdep") for

#endif
