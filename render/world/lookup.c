#include "render/world/lookup.h"

#include "render/bsdf/fresnel.h"

vec2 lookup_uv(const world *w, uint32_t triangle, uint32_t uv_set, vec2 at) {
    const uint32_t *i = w->triangles + 3 * (size_t)triangle;
    const float *uv[3];
    for (int k = 0; k < 3; k++) uv[k] = uv_set ? w->uvs[uv_set] + 2 * (size_t)i[k] : w->vertices[i[k]].uv;
    float b0 = 1.0f - at.x - at.y;
    return (vec2){b0 * uv[0][0] + at.x * uv[1][0] + at.y * uv[2][0], b0 * uv[0][1] + at.x * uv[1][1] + at.y * uv[2][1]};
}

void lookup_corners(const world *w, uint32_t triangle, uint32_t instance, vec3 corners[3]) {
    const uint32_t *v = w->triangles + 3 * (size_t)triangle;
    for (int k = 0; k < 3; k++) {
        corners[k] = v3_load(w->vertices[v[k]].p);
        if (instance) corners[k] = world_instance_point(&w->instances[instance], corners[k]);
    }
}

vec3 lookup_facing(const world *w, uint32_t triangle, uint32_t instance) {
    const uint32_t *v = w->triangles + 3 * (size_t)triangle;
    vec3 p0 = v3_load(w->vertices[v[0]].p);
    vec3 n = v3_cross(v3_sub(v3_load(w->vertices[v[1]].p), p0), v3_sub(v3_load(w->vertices[v[2]].p), p0));
    return instance ? world_instance_normal(&w->instances[instance], n) : n;
}

static const world_texture *texture_of(const world *w, uint32_t triangle, material_slot slot) {
    uint32_t handle = w->materials[w->triangle_material[triangle]].texture[slot];
    return handle ? &w->textures[handle - 1] : NULL;
}

float lookup_alpha(const world *w, uint32_t triangle, vec2 at) {
    float alpha = w->materials[w->triangle_material[triangle]].opacity;
    if (w->colors) {
        const uint32_t *i = w->triangles + 3 * (size_t)triangle;
        const float *c = w->colors + 3;
        alpha *= (1.0f - at.x - at.y) * c[4 * (size_t)i[0]] + at.x * c[4 * (size_t)i[1]] + at.y * c[4 * (size_t)i[2]];
    }
    const world_texture *t = texture_of(w, triangle, SLOT_OPACITY);
    if (t) {
        vec2 uv = lookup_uv(w, triangle, t->uv_set, at);
        alpha *= texture_channel(t, uv.x, uv.y);
    }
    return alpha;
}

static float coverage(const world *w, uint32_t triangle, vec2 at) {
    const world_material *m = &w->materials[w->triangle_material[triangle]];
    if (m->flags & MATERIAL_MASK) return lookup_alpha(w, triangle, at) >= m->alpha_cutoff ? 1.0f : 0.0f;
    if (m->flags & MATERIAL_BLEND) return fm_clamp(lookup_alpha(w, triangle, at), 0.0f, 1.0f);
    return 1.0f;
}

/* A solid wears its coat outside, a thin wall on both sides. */
static float coat_lets(const world *w, uint32_t triangle, vec2 at, float cosine) {
    const world_material *m = &w->materials[w->triangle_material[triangle]];
    if (!(m->clearcoat > 0.0f) || !(m->thin > 0.5f || cosine > 0.0f)) return 1.0f;
    const world_texture *t = texture_of(w, triangle, SLOT_CLEARCOAT);
    float share = m->clearcoat;
    if (t) {
        vec2 uv = lookup_uv(w, triangle, t->uv_set, at);
        share *= texture_channel(t, uv.x, uv.y);
    }
    return clearcoat_dims(share, fabsf(cosine));
}

vec3 lookup_emission(const world *w, uint32_t triangle, vec2 at, float cosine) {
    float stands = coverage(w, triangle, at) * coat_lets(w, triangle, at, cosine);
    const world_texture *t = texture_of(w, triangle, SLOT_EMISSION);
    if (!t) return v3(stands, stands, stands);
    vec2 uv = lookup_uv(w, triangle, t->uv_set, at);
    texel e = texture_sample(t, uv.x, uv.y);
    return v3(stands * e.r, stands * e.g, stands * e.b);
}

bool lookup_emission_varies(const world *w, uint32_t triangle) {
    const world_material *m = &w->materials[w->triangle_material[triangle]];
    return m->texture[SLOT_EMISSION] || m->flags & (MATERIAL_MASK | MATERIAL_BLEND) || m->clearcoat > 0.0f;
}

uint32_t lookup_object(const world *w, uint32_t triangle, uint32_t copy) {
    const world_objects *o = &w->objects;
    if (copy) return o->copies[copy];
    const uint32_t *first = o->first[triangle >= w->baked.first[1]];
    uint32_t low = 0, high = o->baked_count; /* first[low] <= triangle < first[high] */
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (first[middle] <= triangle) low = middle;
        else high = middle;
    }
    return o->baked[low];
}
