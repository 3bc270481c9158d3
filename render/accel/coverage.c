#include "render/accel/coverage.h"

float coverage_alpha(const world *w, uint32_t triangle, float u, float v) {
    const world_material *m = &w->materials[w->triangle_material[triangle]];
    const uint32_t *i = w->triangles + 3 * (size_t)triangle;
    float b0 = 1.0f - u - v, alpha = m->opacity;
    if (w->colors) {
        const float *c = w->colors + 3;
        alpha *= b0 * c[4 * (size_t)i[0]] + u * c[4 * (size_t)i[1]] + v * c[4 * (size_t)i[2]];
    }
    if (m->texture[SLOT_OPACITY]) {
        const world_texture *t = &w->textures[m->texture[SLOT_OPACITY] - 1];
        const float *uv[3];
        for (int k = 0; k < 3; k++) uv[k] = t->uv_set ? w->uvs[t->uv_set] + 2 * (size_t)i[k] : w->vertices[i[k]].uv;
        alpha *= texture_channel(t, b0 * uv[0][0] + u * uv[1][0] + v * uv[2][0],
                                 b0 * uv[0][1] + u * uv[1][1] + v * uv[2][1]);
    }
    return alpha;
}

static bool stops(const coverage_context *c, uint32_t ray, uint32_t triangle, uint32_t instance, float u, float v) {
    const world *w = c->world;
    const world_material *m = &w->materials[w->triangle_material[triangle]];
    float alpha = coverage_alpha(w, triangle, u, v);
    if (m->flags & MATERIAL_MASK) return alpha >= m->alpha_cutoff;
    const ray_coverage *r = c->coverage;
    sample_point p = {r->index ? r->index[ray] : 0, r->seed ? r->seed[ray] : 0};
    return sample_keyed(r->independent, p, hash_triple(r->key, triangle, instance)).x < alpha;
}

/* Arrays of N, as Embree lays out RTCRayN and RTCHitN; its C++ accessors are no use to C. */
enum { RAY_ID = 10, HIT_U = 3, HIT_V = 4, HIT_PRIMITIVE = 5, HIT_GEOMETRY = 6, HIT_INSTANCE = 7 };

void coverage_filter(const struct RTCFilterFunctionNArguments *args) {
    const coverage_context *context = (const coverage_context *)(const void *)args->context;
    const world *w = context->world;
    const uint32_t *ray = (const uint32_t *)(const void *)args->ray, *hit = (const uint32_t *)(const void *)args->hit;
    const float *hit_f = (const float *)(const void *)args->hit;
    size_t n = args->N;
    for (size_t k = 0; k < n; k++) {
        if (args->valid[k] != -1) continue;
        uint32_t placed = hit[HIT_INSTANCE * n + k];
        uint32_t instance = placed == RTC_INVALID_GEOMETRY_ID ? 0 : placed - 1;
        uint32_t triangle = w->instances[instance].triangle_base[hit[HIT_GEOMETRY * n + k]] + hit[HIT_PRIMITIVE * n + k];
        if (!stops(context, ray[RAY_ID * n + k], triangle, instance, hit_f[HIT_U * n + k], hit_f[HIT_V * n + k]))
            args->valid[k] = 0;
    }
}
