/* render/light/table.h: everything that emits, and how one of it is chosen. */
#ifndef KILN_RENDER_LIGHT_TABLE_H
#define KILN_RENDER_LIGHT_TABLE_H

#include "base/vec.h"
#include "render/light/distribution.h"

typedef enum light_kind { LIGHT_TRIANGLE, LIGHT_POINT, LIGHT_SPOT, LIGHT_DISTANT, LIGHT_ENVIRONMENT, LIGHT_KINDS } light_kind;

#define LIGHT_NONE UINT32_MAX

/* A light that can be chosen; which fields mean what depends on its kind. Render space. */
typedef struct light {
    light_kind kind;
    vec3 position; /* TRIANGLE: first vertex; POINT, SPOT */
    vec3 e1, e2;   /* TRIANGLE: edges from it */
    vec3 axis;     /* TRIANGLE: unit normal of the front; SPOT, DISTANT: the way it shines, unit length */
    vec3 radiance; /* TRIANGLE: before the texture; POINT, SPOT: intensity; DISTANT: radiance of its disk, or its
                      illuminance when it is parallel */
    float area;    /* TRIANGLE */
    float quad;      /* TRIANGLE: 1: it is a parallelogram, of twice the triangle's area */
    float two_sided; /* TRIANGLE: 1: the back emits too */
    float spot_scale, spot_offset; /* smooth edge: clamp(cos · scale + offset)² */
    float one_minus_cos;  /* DISTANT: of the half angle; 0: parallel */
    uint32_t varies;      /* TRIANGLE with an emission texture or partial coverage: 1 + its number; else 0 */
    uint32_t medium;      /* TRIANGLE: of the solid that its surface bounds; 0: none */
    float error;          /* TRIANGLE: bound on the rounding error of a point on it */
    uint32_t owner;       /* TRIANGLE: its material; ENVIRONMENT: none; else the scene's light, by handle */
} light;

/* Emission from all around: a latitude-longitude picture, bilinear, importance-sampled by texel. */
typedef struct environment {
    bool present;
    int32_t width, height;
    float *texels;                   /* 4 a texel: radiance in the working space, and the density per solid angle */
    uint32_t *row_cdf, *row_guide;   /* which row */
    uint32_t *texel_cdf, *texel_guide; /* which texel of a row: width + 1 and width values for each row */
    float rotation_turns;            /* added to u */
    float total;          /* its radiance integrated over the sphere */
    uint32_t light;       /* its index among the lights */
} environment;

/* Distributions to choose a light by: by power, all alike; only what no ray can hit; only those without a place. */
typedef enum light_choice { CHOOSE_BY_POWER, CHOOSE_UNIFORMLY, CHOOSE_POINTS, CHOOSE_FAR, LIGHT_CHOICES } light_choice;

typedef struct light_table {
    light *lights;
    uint32_t count, near_count; /* those that have a place come first */
    uint32_t kinds;        /* bits of light_kind that occur */
    bool bounds;           /* some triangle bounds a solid, and may be hidden */
    uint32_t *cdf[LIGHT_CHOICES], *guide[LIGHT_CHOICES]; /* NULL: there is nothing to choose; FAR: behind near_count */
    bool any[LIGHT_CHOICES]; /* something has a chance; without a cdf it is light 0, the only one */
    struct light_tree *tree; /* over those that have a place; NULL: nothing to choose, or nobody wants it */
    float far;             /* irradiance by the others, in units of the tree's intensities */
    uint32_t *distant;     /* the DISTANT ones with an angle: seen by rays that leave the scene */
    uint32_t distant_count;
    environment environment;
} light_table;

#endif
