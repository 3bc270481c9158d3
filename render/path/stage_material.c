#include "render/path/cone.h"
#include "render/path/stages.h"

static void load_diffuse(const world *w, path_scratch *x, uint32_t i) {
    const world_material *m = &w->materials[x->material[i]];
    x->base_r[i] = m->base[0], x->base_g[i] = m->base[1], x->base_b[i] = m->base[2];
    x->emit_r[i] = m->emission[0], x->emit_g[i] = m->emission[1], x->emit_b[i] = m->emission[2];
}

static void load_glossy(const world *w, path_scratch *x, uint32_t i) {
    const world_material *m = &w->materials[x->material[i]];
    x->metallic[i] = m->metallic;
    x->roughness[i] = m->roughness;
    x->specular[i] = m->specular;
    x->f0[i] = m->f0;
    x->tint_r[i] = m->specular_color[0], x->tint_g[i] = m->specular_color[1], x->tint_b[i] = m->specular_color[2];
}

static void load_transmissive(const world *w, path_scratch *x, uint32_t i) {
    const world_material *m = &w->materials[x->material[i]];
    x->transmission[i] = m->transmission;
    x->thin[i] = m->thin;
    x->eta[i] = m->eta;
    x->hue_r[i] = x->hue_g[i] = x->hue_b[i] = 1.0f;
}

static void tint_by_vertices(const world *w, const path_hit *h, path_scratch *x, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t *v = w->triangles + 3 * (size_t)h->triangle[i];
        const float *a = w->colors + 4 * (size_t)v[0], *p = w->colors + 4 * (size_t)v[1], *q = w->colors + 4 * (size_t)v[2];
        float b1 = h->u[i], b2 = h->v[i], b0 = 1.0f - b1 - b2, rgb[3];
        for (int k = 0; k < 3; k++) rgb[k] = b0 * a[k] + b1 * p[k] + b2 * q[k];
        bool unlit = w->materials[x->material[i]].flags & MATERIAL_UNLIT; /* its base colour is what it emits */
        float *r = unlit ? x->emit_r : x->base_r, *g = unlit ? x->emit_g : x->base_g, *b = unlit ? x->emit_b : x->base_b;
        r[i] *= rgb[0], g[i] *= rgb[1], b[i] *= rgb[2];
    }
}

/* UV of a set that the vertices do not carry themselves. */
static vec2 further_uv(const world *w, const path_hit *h, uint32_t i, uint32_t set) {
    const uint32_t *v = w->triangles + 3 * (size_t)h->triangle[i];
    const float *uv = w->uvs[set], *a = uv + 2 * (size_t)v[0], *p = uv + 2 * (size_t)v[1], *q = uv + 2 * (size_t)v[2];
    float b1 = h->u[i], b2 = h->v[i], b0 = 1.0f - b1 - b2;
    return (vec2){b0 * a[0] + b1 * p[0] + b2 * q[0], b0 * a[1] + b1 * p[1] + b2 * q[1]};
}

/* Tangent-space normal (glTF 2.0, 3.9.3: x and y scaled) and the tangent that it is relative to. */
static void load_normal_map(const world *w, const path_hit *h, path_scratch *x, uint32_t i, texel c) {
    const world_material *m = &w->materials[x->material[i]];
    const uint32_t *v = w->triangles + 3 * (size_t)h->triangle[i];
    x->map_x[i] = (2.0f * c.r - 1.0f) * m->normal_scale;
    x->map_y[i] = (2.0f * c.g - 1.0f) * m->normal_scale;
    x->map_z[i] = 2.0f * c.b - 1.0f;
    const float *a = w->tangents + 4 * (size_t)v[0], *p = w->tangents + 4 * (size_t)v[1], *q = w->tangents + 4 * (size_t)v[2];
    float b1 = h->u[i], b2 = h->v[i], b0 = 1.0f - b1 - b2, t[3];
    for (int k = 0; k < 3; k++) t[k] = b0 * a[k] + b1 * p[k] + b2 * q[k];
    const world_instance *copy = &w->instances[h->instance[i]];
    vec3 tangent = v3_load(t);
    if (h->instance[i]) tangent = world_instance_vector(copy, tangent);
    x->tan_x[i] = tangent.x, x->tan_y[i] = tangent.y, x->tan_z[i] = tangent.z;
    x->tan_w[i] = a[3] * copy->side;
}

/* What the path's cone covers of a UV set. */
static texture_footprint footprint(const world *w, const path_hit *h, const path_scratch *x, uint32_t i, uint32_t set) {
    if (!set) return (texture_footprint){x->foot_uu[i], x->foot_uv[i], x->foot_vv[i]};
    const uint32_t *v = w->triangles + 3 * (size_t)h->triangle[i];
    const float *uv = w->uvs[set], *a = uv + 2 * (size_t)v[0], *p = uv + 2 * (size_t)v[1], *q = uv + 2 * (size_t)v[2];
    vec3 p0 = {x->p0x[i], x->p0y[i], x->p0z[i]};
    vec3 e1 = v3_sub(v3(x->p1x[i], x->p1y[i], x->p1z[i]), p0), e2 = v3_sub(v3(x->p2x[i], x->p2y[i], x->p2z[i]), p0);
    return cone_footprint(x->across[i], e1, e2, (vec2){p[0] - a[0], p[1] - a[1]}, (vec2){q[0] - a[0], q[1] - a[1]});
}

static void apply_texture(const world *w, const path_hit *h, path_scratch *x, uint32_t i, material_slot slot,
                          const world_texture *t) {
    vec2 uv = t->uv_set ? further_uv(w, h, i, t->uv_set) : (vec2){x->tu[i], x->tv[i]};
    int32_t level = t->levels ? texture_level(t, footprint(w, h, x, i, t->uv_set)) : 0;
    texel c;
    switch (slot) {
    case SLOT_BASE:
        c = texture_sample_level(t, uv.x, uv.y, level);
        x->base_r[i] *= c.r, x->base_g[i] *= c.g, x->base_b[i] *= c.b;
        break;
    case SLOT_EMISSION:
        c = texture_sample_level(t, uv.x, uv.y, level);
        x->emit_r[i] *= c.r, x->emit_g[i] *= c.g, x->emit_b[i] *= c.b;
        break;
    case SLOT_SPECULAR_COLOR:
        c = texture_sample_level(t, uv.x, uv.y, level);
        x->tint_r[i] *= c.r, x->tint_g[i] *= c.g, x->tint_b[i] *= c.b;
        break;
    case SLOT_METALLIC: x->metallic[i] *= texture_channel_level(t, uv.x, uv.y, level); break;
    case SLOT_ROUGHNESS: x->roughness[i] *= texture_channel_level(t, uv.x, uv.y, level); break;
    case SLOT_SPECULAR: x->specular[i] *= texture_channel_level(t, uv.x, uv.y, level); break;
    case SLOT_TRANSMISSION: x->transmission[i] *= texture_channel_level(t, uv.x, uv.y, level); break;
    case SLOT_NORMAL: load_normal_map(w, h, x, i, texture_sample_level(t, uv.x, uv.y, level)); break;
    case SLOT_OPACITY:
    case SLOT_COUNT: break;
    }
}

static void apply_slot(const world *w, const path_hit *h, path_scratch *x, uint32_t n, material_slot slot) {
    for (uint32_t i = 0; i < n; i++) {
        uint32_t handle = w->materials[x->material[i]].texture[slot];
        if (handle) apply_texture(w, h, x, i, slot, &w->textures[handle - 1]);
    }
}

void STAGE(material)(const path_context *c, batch *b) {
    const world *w = c->world;
    const path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->surfaces; i++) load_diffuse(w, x, i);
    for (uint32_t i = b->kinds[KIND_GLOSSY].first; i < b->kinds[KIND_TRANSMISSIVE].end; i++) load_glossy(w, x, i);
    for (uint32_t i = b->kinds[KIND_TRANSMISSIVE].first; i < b->kinds[KIND_TRANSMISSIVE].end; i++)
        load_transmissive(w, x, i);
    if (w->colors) tint_by_vertices(w, h, x, b->surfaces);
    if (w->slots & 1u << SLOT_NORMAL) for (uint32_t i = 0; i < b->surfaces; i++) x->map_x[i] = x->map_y[i] = 0.0f;
    for (int slot = 0; slot < SLOT_COUNT; slot++)
        if (w->slots & 1u << slot) apply_slot(w, h, x, b->surfaces, (material_slot)slot);
}
