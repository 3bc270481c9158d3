#include <string.h>

#include "render/path/cone.h"
#include "render/path/stages.h"
#include "render/world/lookup.h"

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

static void load_layers(const world *w, path_scratch *x, uint32_t i) {
    const world_material *m = &w->materials[x->material[i]];
    bool both = m->thin > 0.5f, front = x->front[i] > 0.5f; /* a solid wears its layers outside */
    x->near_layers[i] = both || front ? 1.0f : 0.0f;
    x->far_layers[i] = both || !front ? 1.0f : 0.0f;
    x->clearcoat[i] = m->clearcoat;
    x->clearcoat_roughness[i] = m->clearcoat_roughness;
    x->coat_x[i] = x->coat_y[i] = x->coat_z[i] = 0.0f;
    x->sheen_r[i] = m->sheen[0], x->sheen_g[i] = m->sheen[1], x->sheen_b[i] = m->sheen[2];
    x->sheen_roughness[i] = m->sheen_roughness;
    x->anisotropy[i] = m->anisotropy;
    x->along_u[i] = m->anisotropy_x, x->along_v[i] = m->anisotropy_y;
    x->film[i] = m->film;
    x->film_ior[i] = m->film_ior;
    x->film_thickness[i] = m->film_thickness[1];
    const float *pass = m->diffuse_transmission_color;
    x->pass[i] = m->diffuse_transmission;
    x->pass_r[i] = pass[0], x->pass_g[i] = pass[1], x->pass_b[i] = pass[2];
}

/* The first three of an attribute that has four values a vertex. */
static vec3 interpolate(const world *w, const path_hit *h, uint32_t i, const float *values) {
    const uint32_t *v = w->triangles + 3 * (size_t)h->triangle[i];
    vec3 a = v3_load(values + 4 * (size_t)v[0]), p = v3_load(values + 4 * (size_t)v[1]), q = v3_load(values + 4 * (size_t)v[2]);
    float b1 = h->u[i], b2 = h->v[i];
    return v3_madd(v3_madd(v3_scale(a, 1.0f - b1 - b2), b1, p), b2, q);
}

static void tint_by_vertices(const world *w, const path_hit *h, path_scratch *x, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        vec3 rgb = interpolate(w, h, i, w->colors);
        bool unlit = w->materials[x->material[i]].flags & MATERIAL_UNLIT; /* its base colour is what it emits */
        float *r = unlit ? x->emit_r : x->base_r, *g = unlit ? x->emit_g : x->base_g, *b = unlit ? x->emit_b : x->base_b;
        r[i] *= rgb.x, g[i] *= rgb.y, b[i] *= rgb.z;
    }
}

/* The tangent that normal maps and directions are relative to. */
static void load_tangent(const world *w, const path_hit *h, path_scratch *x, uint32_t i) {
    x->tan_x[i] = x->tan_y[i] = x->tan_z[i] = x->tan_w[i] = 0.0f;
    if (!w->tangents) return;
    const world_instance *copy = &w->instances[h->instance[i]];
    vec3 tangent = interpolate(w, h, i, w->tangents);
    if (h->instance[i]) tangent = world_instance_vector(copy, tangent);
    x->tan_x[i] = tangent.x, x->tan_y[i] = tangent.y, x->tan_z[i] = tangent.z;
    x->tan_w[i] = w->tangents[4 * (size_t)w->triangles[3 * (size_t)h->triangle[i]] + 3] * copy->side;
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

/* Tangent-space normal (glTF 2.0, 3.9.3: x and y scaled). */
static vec3 map_of(texel c, float scale) {
    return v3((2.0f * c.r - 1.0f) * scale, (2.0f * c.g - 1.0f) * scale, 2.0f * c.b - 1.0f);
}

/* The texture's direction, turned by the material's, and its share of the strength (KHR_materials_anisotropy). */
static void apply_anisotropy(const world_material *m, path_scratch *x, uint32_t i, texel c) {
    float u = 2.0f * c.r - 1.0f, v = 2.0f * c.g - 1.0f;
    x->anisotropy[i] *= c.b;
    x->along_u[i] = u * m->anisotropy_x - v * m->anisotropy_y;
    x->along_v[i] = u * m->anisotropy_y + v * m->anisotropy_x;
}

static void roughen(const world_material *m, float *roughness, float share) {
    *roughness *= share;
    if (m->flags & MATERIAL_GLOSSINESS) *roughness = 1.0f - *roughness;
}

/* A texture as one lane sees it; NULL: its material has none. second: another channel that the same look-up serves. */
typedef struct view { const world_texture *texture, *second; texture_tap tap; } view;

static texel texel_of(const view *t) { return texture_read(t->texture, &t->tap); }
static float channel_of(const view *t) { return texture_read_channel(t->texture, &t->tap); }

static void tint(const view *t, float *r, float *g, float *b) {
    texel c = texel_of(t);
    *r *= c.r, *g *= c.g, *b *= c.b;
}
static void bend(const view *t, float scale, float *x, float *y, float *z) {
    vec3 n = map_of(texel_of(t), scale);
    *x = n.x, *y = n.y, *z = n.z;
}

static const world_texture *texture_of(const world *w, uint32_t material, material_slot slot) {
    uint32_t handle = w->materials[material].texture[slot];
    return handle ? &w->textures[handle - 1] : NULL;
}

/* Do they differ by the channel alone? */
static bool is_same_place(const world_texture *a, const world_texture *b) {
    return a->texels == b->texels && a->levels == b->levels && a->wrap_u == b->wrap_u && a->wrap_v == b->wrap_v &&
           a->nearest == b->nearest && a->uv_set == b->uv_set &&
           memcmp(a->transform, b->transform, sizeof a->transform) == 0;
}

/* The roughness that metalness' look-up finds in another channel, as glTF has it; NULL: it is elsewhere. Of the material
 * that was asked for last, which most neighbours share. */
typedef struct beside { uint32_t material; const world_texture *roughness; } beside;

static const world_texture *roughness_beside(const world *w, uint32_t material, beside *known) {
    if (known->material == material) return known->roughness;
    const world_texture *a = texture_of(w, material, SLOT_METALLIC), *b = texture_of(w, material, SLOT_ROUGHNESS);
    *known = (beside){material, a && b && is_same_place(a, b) ? b : NULL};
    return known->roughness;
}

/* Finds what the lane will read, and tells the caches. */
static void look(const world *w, const path_hit *h, const path_scratch *x, uint32_t i, material_slot slot, beside *known,
                 view *t) {
    bool shares = slot == SLOT_METALLIC || slot == SLOT_ROUGHNESS;
    t->texture = texture_of(w, x->material[i], slot);
    t->second = t->texture && shares ? roughness_beside(w, x->material[i], known) : NULL;
    if (t->second && slot == SLOT_ROUGHNESS) t->texture = NULL; /* it was there before */
    if (!t->texture) return;
    uint32_t set = t->texture->uv_set;
    vec2 at = {h->u[i], h->v[i]}, uv = set ? lookup_uv(w, h->triangle[i], set, at) : (vec2){x->tu[i], x->tv[i]};
    int32_t level = t->texture->levels ? texture_level(t->texture, footprint(w, h, x, i, set)) : 0;
    texture_find(t->texture, uv.x, uv.y, level, &t->tap);
    texture_prefetch(&t->tap);
}

static void apply_texture(const world *w, const path_hit *h, path_scratch *x, uint32_t i, material_slot slot,
                          const view *t) {
    const world_material *m = &w->materials[x->material[i]];
    switch (slot) {
    case SLOT_BASE: tint(t, &x->base_r[i], &x->base_g[i], &x->base_b[i]); break;
    case SLOT_EMISSION: tint(t, &x->emit_r[i], &x->emit_g[i], &x->emit_b[i]); break;
    case SLOT_SPECULAR_COLOR: tint(t, &x->tint_r[i], &x->tint_g[i], &x->tint_b[i]); break;
    case SLOT_SHEEN_COLOR: tint(t, &x->sheen_r[i], &x->sheen_g[i], &x->sheen_b[i]); break;
    case SLOT_DIFFUSE_TRANSMISSION_COLOR: tint(t, &x->pass_r[i], &x->pass_g[i], &x->pass_b[i]); break;
    case SLOT_METALLIC:
        x->metallic[i] *= channel_of(t);
        if (t->second) roughen(m, &x->roughness[i], texture_read_channel(t->second, &t->tap));
        break;
    case SLOT_ROUGHNESS: roughen(m, &x->roughness[i], channel_of(t)); break;
    case SLOT_SPECULAR: x->specular[i] *= channel_of(t); break;
    case SLOT_TRANSMISSION: x->transmission[i] *= channel_of(t); break;
    case SLOT_CLEARCOAT: x->clearcoat[i] *= channel_of(t); break;
    case SLOT_CLEARCOAT_ROUGHNESS: x->clearcoat_roughness[i] *= channel_of(t); break;
    case SLOT_SHEEN_ROUGHNESS: x->sheen_roughness[i] *= channel_of(t); break;
    case SLOT_FILM: x->film[i] *= channel_of(t); break;
    case SLOT_FILM_THICKNESS:
        x->film_thickness[i] = fm_lerp(m->film_thickness[0], m->film_thickness[1], channel_of(t));
        break;
    case SLOT_DIFFUSE_TRANSMISSION: x->pass[i] *= channel_of(t); break;
    case SLOT_NORMAL:
        bend(t, m->normal_scale, &x->map_x[i], &x->map_y[i], &x->map_z[i]);
        load_tangent(w, h, x, i);
        break;
    case SLOT_CLEARCOAT_NORMAL:
        bend(t, m->clearcoat_normal_scale, &x->coat_x[i], &x->coat_y[i], &x->coat_z[i]);
        break;
    case SLOT_ANISOTROPY: apply_anisotropy(m, x, i, texel_of(t)); break;
    case SLOT_OPACITY:
    case SLOT_COUNT: break;
    }
}

/* Lanes that are looked at before the first of them is read: their texels are on the way meanwhile. */
enum { VIEWS = 16 };

static void apply_slot(const world *w, const path_hit *h, path_scratch *x, uint32_t n, material_slot slot) {
    view views[VIEWS];
    beside known = {UINT32_MAX, NULL};
    for (uint32_t i = 0; i < n + VIEWS; i++) {
        view *t = &views[i % VIEWS];
        if (i >= VIEWS && t->texture) apply_texture(w, h, x, i - VIEWS, slot, t);
        if (i < n) look(w, h, x, i, slot, &known, t);
    }
}

static void load_all_layers(const world *w, const path_hit *h, path_scratch *x, lane_range lanes) {
    for (uint32_t i = lanes.first; i < lanes.end; i++) {
        load_layers(w, x, i);
        load_tangent(w, h, x, i);
    }
}

void STAGE(material)(const path_context *c, batch *b) {
    const world *w = c->world;
    const path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->surfaces; i++) load_diffuse(w, x, i);
    for (uint32_t i = lanes_with(b, BSDF_GLOSSY).first; i < b->surfaces; i++) load_glossy(w, x, i);
    for (uint32_t i = lanes_with(b, BSDF_TRANSMISSIVE).first; i < b->surfaces; i++) load_transmissive(w, x, i);
    load_all_layers(w, h, x, b->kinds[KIND_COATED]);
    load_all_layers(w, h, x, kinds_range(b, KIND_LAYERED, KIND_FILMED));
    if (w->colors) tint_by_vertices(w, h, x, b->surfaces);
    for (uint32_t i = 0; HAS(c->effects, NORMAL_MAPS) && i < b->surfaces; i++) x->map_x[i] = x->map_y[i] = 0.0f;
    for (int slot = 0; slot < SLOT_COUNT; slot++)
        if (w->slots & 1u << slot) apply_slot(w, h, x, b->surfaces, (material_slot)slot);
}
