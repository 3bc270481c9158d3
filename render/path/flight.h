/* render/path/flight.h: how far light goes in a medium that scatters, and what happens there. Scalar kernels.
 *
 *     L = ∫₀ˢ T(t) σs ∫ p L dwi dt + T(s) L(s),   T(t) = exp(−σt t)      (the volume rendering equation)
 *
 * The distance is drawn for one channel, and weighed as if it had been drawn for each: the one-sample model with the
 * balance heuristic over the channels (Wilkie et al. 2014, "Hero Wavelength Spectral Sampling"), which are chosen by
 * what the path carries of them. So no channel's weight can explode where another's extinction is small. */
#ifndef KILN_RENDER_PATH_FLIGHT_H
#define KILN_RENDER_PATH_FLIGHT_H

#include "render/bsdf/lobes/phase.h"
#include "render/path/estimate.h"
#include "render/path/path.h"
#include "render/path/surface.h"
#include "render/world/lookup.h"

/* Events in media end a path as bounces off surfaces do (--max-depth), but later: a white medium takes thousands. */
enum { MEDIUM_EVENTS_MAX = 16384 };

typedef struct flight {
    float distance;
    int scatters; /* before the surface */
    vec3 weight;  /* of the throughput */
} flight;

/* limit: the distance to the surface. distance, channel: random numbers. */
KERNEL flight flight_sample(vec3 extinction, vec3 albedo, vec3 throughput, float limit, float distance,
                            float channel) {
    float sum = throughput.x + throughput.y + throughput.z, inverse = sum > 0.0f ? 1.0f / sum : 0.0f;
    vec3 q = v3_select(sum > 0.0f, v3_scale(throughput, inverse), v3_splat(1.0f / 3.0f));
    float chosen = channel < q.x ? extinction.x : channel < q.x + q.y ? extinction.y : extinction.z;
    /* A clear channel does not scatter. */
    float drawn = -fm_log(1.0f - distance) / fm_max(chosen, 1e-30f);
    int scatters = (drawn < limit) & (chosen > 0.0f);
    float d = scatters ? drawn : limit;
    vec3 left = v3(fm_exp(-extinction.x * d), fm_exp(-extinction.y * d), fm_exp(-extinction.z * d));
    vec3 densities = v3_select(scatters, v3_mul(left, extinction), left);
    float density = v3_dot(q, densities); /* > 0: the chosen channel's is */
    vec3 weight = v3_scale(v3_select(scatters, v3_mul(densities, albedo), densities), 1.0f / fm_max(density, 1e-37f));
    return (flight){d, scatters, weight};
}

/* The distance to a surface as the surface stage will find it: Embree's depends on the machine. */
static inline float flight_limit(const world *w, vec3 origin, vec3 direction, const ray_crossing *c) {
    vec3 p[3];
    lookup_corners(w, c->triangle, c->instance, p);
    triangle_hit embree = {c->u, c->v, c->t};
    return triangle_intersect(origin, direction, p[0], v3_sub(p[1], p[0]), v3_sub(p[2], p[0]), embree).t;
}

/* Light that reaches the medium straight from a light: throughput · p · radiance · weight/density. */
KERNEL vec3 flight_connect(vec3 wo, float g, kiln_estimator estimator, vec3 throughput, const light_sampled *l,
                           float density) {
    float value = phase_value(wo, l->wi, g), weight = estimate_light_weight(estimator, l->parallel, density, value);
    vec3 sum = v3_scale(v3_mul(throughput, l->radiance), value);
    return v3_scale(sum, density > 0.0f ? weight / density : 0.0f);
}

#endif
