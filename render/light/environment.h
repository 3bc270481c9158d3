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

/* Radiance, bilinear, and density (per solid angle, of the texel around) at a place of the world. */
static inline environment_value environment_look_up(const environment *e, vec2 place) {
    float turned = place.x + e->rotation_turns, u = turned - fm_floor(turned);
    float x = u * (float)e->width, y = place.y * (float)e->height;
    int32_t cx = (int32_t)x, cy = (int32_t)y;
    cx = cx < e->width ? cx : e->width - 1;
    cy = cy < e->height ? cy : e->height - 1;
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
    r.pdf = e->texels[4 * ((size_t)cy * (size_t)e->width + (size_t)cx) + 3];
    return r;
}

/* A direction by importance: a texel by inversion, a place in it uniform in solid angle. Fills the fields of the light's
 * record that light_sample_environment reads. */
static inline void environment_pick(const environment *e, vec2 u, float fine, light *l) {
    float across, down;
    uint32_t w = (uint32_t)e->width;
    uint32_t row = distribution_pick(e->row_cdf, e->row_guide, (uint32_t)e->height, u.y, fine, &down);
    uint32_t column = distribution_pick(e->texel_cdf + (size_t)row * (w + 1), e->texel_guide + (size_t)row * w, w, u.x,
                                        fine, &across);
    /* Uniform in cos θ, counted from the nearer pole: 1 − cos θ = 2 sin²(θ/2). */
    int below = 2 * row + 1 > (uint32_t)e->height;
    float nearest = (float)(int32_t)(below ? (uint32_t)e->height - 1 - row : row), step = 0.25f / (float)e->height;
    float low = fm_sincos_2pi(nearest * step).sin, high = fm_sincos_2pi((nearest + 1.0f) * step).sin;
    float sag = 2.0f * fm_lerp(low * low, high * high, below ? 1.0f - down : down), side = below ? -1.0f : 1.0f;
    float turns = ((float)(int32_t)column + across) / (float)e->width - e->rotation_turns;
    float v = fm_atan2(sqrtf(sag * (2.0f - sag)), side * (1.0f - sag)) * 0.318309886f;
    environment_value value = environment_look_up(e, (vec2){turns, v});
    l->position = v3(turns, sag, side);
    l->radiance = value.radiance;
    l->area = e->texels[4 * ((size_t)row * w + column) + 3];
}

#endif
