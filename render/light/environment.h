/* render/light/environment.h: looking up and sampling the environment. Scalar kernels. */
#ifndef KILN_RENDER_LIGHT_ENVIRONMENT_H
#define KILN_RENDER_LIGHT_ENVIRONMENT_H

#include "base/fmath.h"
#include "base/kernel.h"
#include "render/light/table.h"

/* The direction at u turns, before rotation, and at `sag` = 1 − |cos θ| from the pole on `side` (1: the top, −1: the
 * bottom). A float has digits for angles near a pole in this, and next to none in cos θ. */
KERNEL vec3 environment_direction(float u, float sag, float side) {
    fm_pair a = fm_sincos_2pi(u - 0.5f);
    float s = sqrtf(sag * (2.0f - sag)); /* sin² = 1 − cos²; 0 ≤ sag ≤ 2 */
    return v3(s * a.cos, side * (1.0f - sag), s * a.sin);
}
/* u in [0, 1] and v = θ/π in [0, 1], in the world: rotation is added on look-up. */
KERNEL vec2 environment_place(vec3 d) {
    float u = 0.5f + fm_atan2(d.z, d.x) * 0.159154943f;
    return (vec2){u, fm_atan2(sqrtf(d.x * d.x + d.z * d.z), d.y) * 0.318309886f};
}

typedef struct environment_value { vec3 radiance; float pdf; } environment_value;

/* Density per solid angle within a texel. */
static inline float environment_density(const environment *e, uint32_t row, uint32_t column) {
    return e->texels[4 * ((size_t)row * (size_t)e->width + column) + 3];
}

/* The texel around a place: its column and row. */
KERNEL void environment_texel(const environment *e, vec2 place, float *x, float *y, int32_t *column, int32_t *row) {
    float turned = place.x + e->rotation_turns, u = turned - fm_floor(turned);
    *x = u * (float)e->width, *y = place.y * (float)e->height;
    int32_t i = (int32_t)*x, j = (int32_t)*y;
    *column = i < e->width ? i : e->width - 1;
    *row = j < e->height ? j : e->height - 1;
}

/* Radiance, bilinear, and density (per solid angle, of the texel around) at a place of the world. */
static inline environment_value environment_look_up(const environment *e, vec2 place) {
    float x, y;
    int32_t column, row;
    environment_texel(e, place, &x, &y, &column, &row);
    float xf = fm_floor(x - 0.5f), yf = fm_floor(y - 0.5f), fx = x - 0.5f - xf, fy = y - 0.5f - yf;
    int32_t i = (int32_t)xf, j = (int32_t)yf;
    int32_t i0 = i < 0 ? e->width - 1 : i, i1 = i + 1 < e->width ? i + 1 : 0;
    int32_t j0 = j < 0 ? 0 : j, j1 = j + 1 < e->height ? j + 1 : e->height - 1;
    const float *row0 = e->texels + 4 * (size_t)j0 * (size_t)e->width, *row1 = e->texels + 4 * (size_t)j1 * (size_t)e->width;
    const float *a = row0 + 4 * i0, *b = row0 + 4 * i1, *c = row1 + 4 * i0, *d = row1 + 4 * i1;
    environment_value r;
    float mixed[3];
    for (int k = 0; k < 3; k++) {
        float top = a[k] + fx * (b[k] - a[k]), bottom = c[k] + fx * (d[k] - c[k]);
        mixed[k] = top + fy * (bottom - top);
    }
    r.radiance = v3_load(mixed);
    r.pdf = environment_density(e, (uint32_t)row, (uint32_t)column);
    return r;
}

/* Tells the caches what environment_look_up will read. */
KERNEL void environment_prefetch(const environment *e, int32_t row, int32_t column, int below) {
    int32_t other = below ? row + 1 : row - 1;
    other = other < 0 || other >= e->height ? row : other;
    __builtin_prefetch(e->texels + 4 * ((size_t)row * (size_t)e->width + (size_t)column));
    __builtin_prefetch(e->texels + 4 * ((size_t)other * (size_t)e->width + (size_t)column));
}
KERNEL void environment_prefetch_place(const environment *e, vec2 place) {
    float x, y;
    int32_t column, row;
    environment_texel(e, place, &x, &y, &column, &row);
    environment_prefetch(e, row, column, y - (float)row >= 0.5f);
}

/* A direction by importance, in three steps that a batch takes one after the other, so that the caches can be told what
 * the next one reads: a row and a texel of it by inversion, then a place in the texel, uniform in solid angle. */
typedef struct environment_choice {
    uint32_t row, column;
    float across, down; /* where in the texel, in [0, 1) */
} environment_choice;

KERNEL void environment_pick_row(const environment *e, float u, float fine, environment_choice *p) {
    p->row = distribution_pick(e->row_cdf, e->row_guide, (uint32_t)e->height, u, fine, &p->down);
}
KERNEL void environment_pick_column(const environment *e, float u, float fine, environment_choice *p) {
    uint32_t w = (uint32_t)e->width;
    p->column = distribution_pick(e->texel_cdf + (size_t)p->row * (w + 1), e->texel_guide + (size_t)p->row * w, w, u,
                                  fine, &p->across);
}
/* What environment_pick_column reads first. */
KERNEL const uint32_t *environment_guide(const environment *e, uint32_t row, float u) {
    return distribution_guide(e->texel_guide + (size_t)row * (size_t)e->width, (uint32_t)e->width, u);
}

/* Turns before rotation, sag and side, as environment_direction takes them. */
KERNEL vec3 environment_turn(float width, float height, float rotation_turns, const environment_choice *p) {
    /* Uniform in cos θ, counted from the nearer pole: 1 − cos θ = 2 sin²(θ/2). */
    float row = (float)(int32_t)p->row, below = row + 0.5f > 0.5f * height ? 1.0f : 0.0f;
    float nearest = below > 0.5f ? height - 1.0f - row : row, step = 0.25f / height;
    float low = fm_sincos_2pi(nearest * step).sin, high = fm_sincos_2pi((nearest + 1.0f) * step).sin;
    float sag = 2.0f * fm_lerp(low * low, high * high, below > 0.5f ? 1.0f - p->down : p->down);
    float turns = ((float)(int32_t)p->column + p->across) / width - rotation_turns;
    return v3(turns, sag, below > 0.5f ? -1.0f : 1.0f);
}
/* The place of it, for environment_look_up. */
KERNEL vec2 environment_turned_place(vec3 turned) {
    float sag = turned.y;
    return (vec2){turned.x, fm_atan2(sqrtf(sag * (2.0f - sag)), turned.z * (1.0f - sag)) * 0.318309886f};
}

/* Fills the fields of the light's record that light_sample_environment reads. */
static inline void environment_pick(const environment *e, vec2 u, float fine, light *l) {
    environment_choice p;
    environment_pick_row(e, u.y, fine, &p);
    environment_pick_column(e, u.x, fine, &p);
    l->position = environment_turn((float)e->width, (float)e->height, e->rotation_turns, &p);
    l->radiance = environment_look_up(e, environment_turned_place(l->position)).radiance;
    l->area = environment_density(e, p.row, p.column);
}

#endif
