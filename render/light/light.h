/* render/light/light.h: sampling a light that has been chosen, and densities of light that was hit. Scalar kernels. */
#ifndef KILN_RENDER_LIGHT_LIGHT_H
#define KILN_RENDER_LIGHT_LIGHT_H

#include "render/bsdf/frame.h"
#include "render/light/environment.h"
#include "render/light/table.h"
#include "render/sample/warp.h"

/* What a light sample is made of: the light's record, without what only some kinds need to look up. `kinds` is a
 * constant mask of the kinds that occur, at every call. */
typedef struct light_sampled {
    vec3 wi;          /* unit, towards the light */
    vec3 target;      /* a point just off the light, where it has a place */
    float distance;   /* to target; infinite without */
    vec3 radiance;    /* before textures; of parallel lights: what arrives, divided by nothing */
    float pdf;        /* per solid angle; 1 for parallel lights; 0: no light comes from there */
    int parallel;     /* no ray can hit it: a point or a beam */
} light_sampled;

#define KIND(k) (1u << (k))

KERNEL light_sampled light_sample_triangle(const light *l, vec3 p, vec2 u) {
    vec2 b = warp_triangle(u);
    vec3 q = v3_madd(v3_madd(l->position, b.x, l->e1), b.y, l->e2);
    vec3 d = v3_sub(q, p);
    float distance2 = v3_dot(d, d), length = sqrtf(distance2), inverse = length > 0.0f ? 1.0f / length : 0.0f;
    vec3 wi = v3_scale(d, inverse);
    float cosine = -v3_dot(wi, l->axis), lit = l->two_sided > 0.5f ? fabsf(cosine) : cosine;
    float pdf = distance2 / (l->area * lit);
    int comes = (lit > 0.0f) & (l->area > 0.0f) & (pdf < INFINITY) & (length > 0.0f);
    /* The shadow ray ends this side of the light. */
    vec3 target = v3_madd(q, cosine > 0.0f ? l->error : -l->error, l->axis);
    return (light_sampled){wi, target, length, l->radiance, comes ? pdf : 0.0f, 0};
}

KERNEL light_sampled light_sample_point(const light *l, vec3 p) {
    vec3 d = v3_sub(l->position, p);
    float distance2 = v3_dot(d, d), length = sqrtf(distance2), inverse = length > 0.0f ? 1.0f / length : 0.0f;
    vec3 wi = v3_scale(d, inverse);
    float edge = -v3_dot(wi, l->axis) * l->spot_scale + l->spot_offset;
    edge = fm_clamp(edge, 0.0f, 1.0f);
    float spot = l->kind == LIGHT_SPOT ? edge * edge : 1.0f;
    return (light_sampled){wi, l->position, length, v3_scale(l->radiance, spot * inverse * inverse),
                           length > 0.0f ? 1.0f : 0.0f, 1};
}

/* Density per solid angle of a direction into the disk of a light that is not parallel: uniform. */
KERNEL float light_distant_pdf(float one_minus_cos) { return 0.159154943f / fm_max(one_minus_cos, 1e-30f); }

KERNEL light_sampled light_sample_distant(const light *l, vec2 u) {
    frame f = frame_make(v3_neg(l->axis));
    int parallel = !(l->one_minus_cos > 0.0f);
    vec3 wi = v3_select(parallel, f.z, frame_to_world(&f, warp_cone(u, l->one_minus_cos)));
    float pdf = parallel ? 1.0f : light_distant_pdf(l->one_minus_cos);
    return (light_sampled){v3_normalize(wi), v3(0, 0, 0), INFINITY, l->radiance, pdf, parallel};
}

/* position: what environment_direction takes, area: the density, as environment_pick leaves them. */
KERNEL light_sampled light_sample_environment(const light *l) {
    vec3 wi = environment_direction(l->position.x, l->position.y, l->position.z);
    return (light_sampled){wi, v3(0, 0, 0), INFINITY, l->radiance, l->area, 0};
}

KERNEL light_sampled light_sampled_select(int c, light_sampled a, light_sampled b) {
    return (light_sampled){v3_select(c, a.wi, b.wi), v3_select(c, a.target, b.target), c ? a.distance : b.distance,
                           v3_select(c, a.radiance, b.radiance), c ? a.pdf : b.pdf, c ? a.parallel : b.parallel};
}

KERNEL light_sampled light_sample(unsigned kinds, const light *l, vec3 p, vec2 u) {
    const unsigned points = KIND(LIGHT_POINT) | KIND(LIGHT_SPOT);
    light_sampled s = {.distance = INFINITY};
    if (kinds & KIND(LIGHT_TRIANGLE)) s = light_sample_triangle(l, p, u);
    if (kinds & points) s = light_sampled_select((l->kind == LIGHT_POINT) | (l->kind == LIGHT_SPOT), light_sample_point(l, p), s);
    if (kinds & KIND(LIGHT_DISTANT)) s = light_sampled_select(l->kind == LIGHT_DISTANT, light_sample_distant(l, u), s);
    if (kinds & KIND(LIGHT_ENVIRONMENT))
        s = light_sampled_select(l->kind == LIGHT_ENVIRONMENT, light_sample_environment(l), s);
    return s;
}

/* Density per solid angle with which light_sample_triangle finds a point that a ray met at distance t under |cos|. */
KERNEL float light_triangle_pdf(float t, float cosine, float area) {
    float denominator = area * fabsf(cosine);
    return denominator > 0.0f ? t * t / denominator : 0.0f;
}

/* Power heuristic, β = 2 (Veach 1997, 9.2.4): the weight of a strategy of density a against one of density b. */
KERNEL float mis_weight(float a, float b) {
    float ratio = b / a;
    return a > 0.0f ? 1.0f / (1.0f + ratio * ratio) : 0.0f;
}

#endif
