#include "render/accel/coverage.h"

#include "render/world/lookup.h"

static bool stops(const coverage_context *c, uint32_t ray, uint32_t triangle, uint32_t instance, float u, float v) {
    const world *w = c->world;
    const world_material *m = &w->materials[w->triangle_material[triangle]];
    float alpha = lookup_alpha(w, triangle, (vec2){u, v});
    if (m->flags & MATERIAL_MASK) return alpha >= m->alpha_cutoff;
    const ray_coverage *r = c->coverage;
    sample_point p = {r->index ? r->index[ray] : 0, r->seed ? r->seed[ray] : 0};
    return sample_keyed(r->independent, p, hash_triple(r->key, triangle, instance)).x < alpha;
}

void coverage_filter(const struct RTCFilterFunctionNArguments *args) {
    const coverage_context *context = (const coverage_context *)(const void *)args->context;
    const world *w = context->world;
    const uint32_t *ray = (const uint32_t *)(const void *)args->ray, *hit = (const uint32_t *)(const void *)args->hit;
    const float *hit_f = (const float *)(const void *)args->hit;
    size_t n = args->N;
    for (size_t k = 0; k < n; k++) {
        if (args->valid[k] != -1) continue;
        uint32_t instance, triangle = filter_triangle(w, hit, n, k, &instance);
        if (!stops(context, ray[RAY_ID * n + k], triangle, instance, hit_f[HIT_U * n + k], hit_f[HIT_V * n + k]))
            args->valid[k] = 0;
    }
}
