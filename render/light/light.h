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

/* A triangle light's halves as a point sees them: itself and nothing, or the two triangles of a parallelogram. */
typedef struct light_view {
    vec3 a, b, c, d; /* unit directions of its corners in order; d: of a parallelogram's last */
    float height;    /* of the point above its plane, on the front's side */
    float volume[2]; /* of the parallelepiped over three unit directions: abc, acd */
    float angle[2];  /* solid angles; both 0: the light is too small, too flat or too large, and is sampled by area */
} light_view;

/* Solid angle of a triangle of unit directions, by its volume (Van Oosterom and Strackee 1983, eq. 8). */
KERNEL float light_solid_angle(float volume, vec3 a, vec3 b, vec3 c) {
    return 2.0f * fm_atan2(volume, 1.0f + v3_dot(a, b) + v3_dot(b, c) + v3_dot(c, a));
}

/* Below, the cosine and the distance vary too little over the light for the trouble; above, and from flatter than a 256th
 * of the light's size above its plane, directions have not enough digits. */
#define LIGHT_ANGLE_MIN 0x1p-12f
#define LIGHT_ANGLE_MAX 6.0f
#define LIGHT_FLATTEST 0x1p-8f

KERNEL light_view light_see(const light *l, vec3 p) {
    vec3 a = v3_sub(l->position, p), b = v3_add(a, l->e1), far = v3_add(a, l->e2);
    int quad = l->quad > 0.5f;
    vec3 c = v3_select(quad, v3_add(b, l->e2), far);
    float la = v3_length(a), lb = v3_length(b), lc = v3_length(c), ld = v3_length(far);
    float longest = fm_max(fm_max(la, lb), fm_max(lc, ld)), shortest = fm_min(fm_min(la, lb), fm_min(lc, ld));
    light_view v = {.a = v3_scale(a, 1.0f / fm_max(la, 1e-30f)),
                    .b = v3_scale(b, 1.0f / fm_max(lb, 1e-30f)),
                    .c = v3_scale(c, 1.0f / fm_max(lc, 1e-30f)),
                    .d = v3_scale(far, 1.0f / fm_max(ld, 1e-30f)),
                    .height = -v3_dot(a, l->axis)};
    /* a · (b × c) = height · |e1 × e2|: no digits are lost where the light is small. */
    float volume = fabsf(v.height) * (quad ? l->area : 2.0f * l->area), inverse = 1.0f / fm_max(la * lc, 1e-30f);
    v.volume[0] = volume * inverse / fm_max(lb, 1e-30f);
    v.volume[1] = quad ? volume * inverse / fm_max(ld, 1e-30f) : 0.0f;
    float first = light_solid_angle(v.volume[0], v.a, v.b, v.c);
    float second = quad ? light_solid_angle(v.volume[1], v.a, v.c, v.d) : 0.0f;
    int fits = (first + second > LIGHT_ANGLE_MIN) & (first + second < LIGHT_ANGLE_MAX) &
               (fabsf(v.height) > LIGHT_FLATTEST * longest) & (shortest > 0.0f);
    v.angle[0] = fits ? first : 0.0f;
    v.angle[1] = fits ? second : 0.0f;
    return v;
}

/* A direction into the triangle of unit directions a, b, c, uniform in solid angle: a part u.x of the area is cut off by
 * a great circle through b, then a part u.y of the arc is gone along, by height (Arvo 1995), in the form without
 * inverse functions of Peters 2021, "BRDF Importance Sampling for Polygonal Lights", section 5. */
KERNEL vec3 light_spherical_triangle(vec3 a, vec3 b, vec3 c, float volume, float angle, vec2 u) {
    fm_pair half = fm_sincos_2pi(u.x * angle * 0.0795774715f); /* of half of the part */
    float ac_bc = v3_dot(a, c) + v3_dot(b, c), ab = 1.0f + v3_dot(a, b);
    vec3 off = v3_madd(v3_scale(a, volume * half.cos - ac_bc * half.sin), ab * half.sin, c);
    vec3 cut = v3_sub(v3_scale(off, 2.0f * v3_dot(a, off) / fm_max(v3_dot(off, off), 1e-37f)), a);
    float least = v3_dot(b, cut), s = fm_lerp(1.0f, least, u.y), rest = 1.0f - least * least;
    float t = rest > 0.0f ? sqrtf(fm_max(1.0f - s * s, 0.0f) / rest) : u.y;
    return v3_madd(v3_scale(b, s - t * least), t, cut);
}

/* Density per solid angle with which light_sample_triangle finds a point that a ray from p met at distance t under
 * |cos|: the same number as a sample's that leads there. */
KERNEL float light_triangle_pdf(const light *l, vec3 p, float t, float cosine) {
    light_view v = light_see(l, p);
    float angle = v.angle[0] + v.angle[1], by_area = l->area * fabsf(cosine);
    float pdf = by_area > 0.0f ? t * t / by_area : 0.0f;
    return angle > 0.0f ? 1.0f / angle : pdf;
}

KERNEL light_sampled light_sample_triangle(const light *l, vec3 p, vec2 u) {
    light_view v = light_see(l, p);
    float angle = v.angle[0] + v.angle[1];
    int quad = l->quad > 0.5f, by_angle = angle > 0.0f;
    vec2 place = warp_triangle(u);
    place.x = quad ? u.x : place.x, place.y = quad ? u.y : place.y;
    vec3 on = v3_madd(v3_madd(v3_sub(l->position, p), place.x, l->e1), place.y, l->e2);
    /* The half, and the place within it. */
    float passed = u.x * angle;
    int second = passed >= v.angle[0], last = second & quad;
    float half = last ? v.angle[1] : v.angle[0];
    float within = fm_clamp((last ? passed - v.angle[0] : passed) / fm_max(half, 1e-30f), 0.0f, 1.0f);
    vec3 way = light_spherical_triangle(v3_select(last, v.c, v.a), v3_select(last, v.d, v.b), v3_select(last, v.a, v.c),
                                        last ? v.volume[1] : v.volume[0], half, (vec2){within, u.y});
    float down = v3_dot(way, l->axis);
    vec3 hit = v3_scale(way, -v.height / (by_angle ? down : 1.0f)); /* within the light's angle, far from 0 */
    vec3 d = v3_select(by_angle, hit, on);
    float distance2 = v3_dot(d, d), length = sqrtf(distance2), inverse = length > 0.0f ? 1.0f / length : 0.0f;
    vec3 wi = v3_scale(d, inverse);
    float cosine = -v3_dot(wi, l->axis), lit = l->two_sided > 0.5f ? fabsf(cosine) : cosine;
    float pdf = by_angle ? 1.0f / angle : distance2 / (l->area * lit);
    int comes = (lit > 0.0f) & (l->area > 0.0f) & (pdf < INFINITY) & (length > 0.0f);
    /* The shadow ray ends this side of the light. */
    vec3 target = v3_madd(v3_add(p, d), cosine > 0.0f ? l->error : -l->error, l->axis);
    return (light_sampled){wi, target, length, l->radiance, comes ? pdf : 0.0f, 0};
}

/* How far along its edges from the first vertex a point of a triangle lies, which may be just off it. */
static inline vec2 light_triangle_place(const light *l, vec3 at) {
    vec3 d = v3_sub(at, l->position), n = v3_cross(l->e1, l->e2);
    float twice = v3_length(n);
    if (!(twice > 0.0f)) return (vec2){0, 0};
    n = v3_scale(n, 1.0f / twice); /* ±axis */
    float b = v3_dot(v3_cross(d, l->e2), n) / twice, c = v3_dot(v3_cross(l->e1, d), n) / twice;
    return (vec2){fm_clamp(b, 0.0f, 1.0f), fm_clamp(c, 0.0f, 1.0f)};
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

/* Power heuristic, β = 2 (Veach 1997, 9.2.4): the weight of a strategy of density a against one of density b. */
KERNEL float mis_weight(float a, float b) {
    float ratio = b / a;
    return a > 0.0f ? 1.0f / (1.0f + ratio * ratio) : 0.0f;
}

#endif
