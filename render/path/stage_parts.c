#include "render/bsdf/shares.h"
#include "render/path/lanes.h"
#include "render/path/parts.h"
#include "render/path/stages.h"

/* Lanes whose radiance is the picture's. */
static bool counts(const path_state *s, uint32_t i) {
    return !(s->slot[i] & SLOT_BEYOND) && slot_index(s->slot[i]) != SLOT_NOWHERE;
}

static bsdf_parts *shares_of(const batch *b, const path_state *s, uint32_t i) {
    return &b->parts->shares[slot_index(s->slot[i])];
}

static vec3 radiance_of(const path_state *s, uint32_t i) { return v3(s->lr[i], s->lg[i], s->lb[i]); }

void STAGE(part_found)(const path_context *c, batch *b, uint32_t i, uint8_t group) {
    const path_state *s = batch_state(b);
    path_bounce bounce = b->depth == 0 ? BOUNCE_EMISSION : b->depth == 1 ? BOUNCE_DIRECT : BOUNCE_INDIRECT;
    if (!counts(s, i)) return;
    parts_record(c->parts, b->parts, slot_index(s->slot[i]), radiance_of(s, i), bounce, group, shares_of(b, s, i));
}

void STAGE(part_emission)(const path_context *c, batch *b) {
    for (uint32_t i = 0; i < b->surfaces; i++) STAGE(part_found)(c, b, i, c->parts->of_material[b->scratch.material[i]]);
}

static uint8_t part_of_light(const path_context *c, const path_scratch *x, uint32_t i) {
    const path_parts_plan *plan = c->parts;
    switch ((light_kind)x->light_kind[i]) {
    case LIGHT_TRIANGLE: return plan->of_material[c->world->lights.lights[x->light[i]].owner];
    case LIGHT_POINT:
    case LIGHT_SPOT:
    case LIGHT_DISTANT: return plan->of_light[c->world->lights.lights[x->light[i]].owner];
    case LIGHT_ENVIRONMENT:
    case LIGHT_KINDS: break;
    }
    return plan->of_environment;
}

/* What a medium scatters has come through. */
static const bsdf_parts scattered = {.of[KILN_LOBE_TRANSMISSION] = {1, 1, 1}};

KERNEL void record_first(unsigned mask, const path_context *c, batch *b, lane_range lanes) {
    const path_state *s = batch_state(b);
    const path_scratch *x = &b->scratch;
    for (uint32_t i = lanes.first; i < lanes.end; i++) {
        if (!counts(s, i) || x->visible[i] != RAY_REACHES) continue;
        shading p = lane_shading(mask, s, x, i);
        bsdf_parts shares = bsdf_shares(mask, &p.bsdf, frame_to_local(&p.frame, v3(x->wx[i], x->wy[i], x->wz[i])));
        parts_record(c->parts, b->parts, slot_index(s->slot[i]), radiance_of(s, i), BOUNCE_DIRECT,
                     part_of_light(c, x, i), &shares);
    }
}

void STAGE(part_light)(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    const path_scratch *x = &b->scratch;
    if (b->depth == 0) {
#define RECORD_FIRST(kernel, mask) record_first(mask, c, b, b->kinds[KIND_##kernel]);
        BSDF_KERNELS(RECORD_FIRST)
#undef RECORD_FIRST
        for (uint32_t i = b->surfaces; i < b->n; i++)
            if (counts(s, i) && x->visible[i] == RAY_REACHES)
                parts_record(c->parts, b->parts, slot_index(s->slot[i]), radiance_of(s, i), BOUNCE_DIRECT,
                             part_of_light(c, x, i), &scattered);
        return;
    }
    for (uint32_t i = 0; i < b->n; i++)
        if (counts(s, i) && x->visible[i] == RAY_REACHES)
            parts_record(c->parts, b->parts, slot_index(s->slot[i]), radiance_of(s, i), BOUNCE_INDIRECT,
                         part_of_light(c, x, i), shares_of(b, s, i));
}

/* The direction that scatter is about to take is drawn here too, so that scatter need not say what it was made of. */
KERNEL void share_first(unsigned mask, batch *b, lane_range lanes) {
    const path_state *s = batch_state(b);
    const path_scratch *x = &b->scratch;
    for (uint32_t i = lanes.first; i < lanes.end; i++) {
        if (!counts(s, i)) continue;
        shading p = lane_shading(mask, s, x, i);
        vec2 u = {x->u_bsdf_x[i], x->u_bsdf_y[i]};
        *shares_of(b, s, i) = bsdf_shares_of_sample(mask, &p.bsdf, x->u_lobe[i], u);
    }
}

void STAGE(part_scatter)(const path_context *c, batch *b) {
    (void)c;
#define SHARE_FIRST(kernel, mask) share_first(mask, b, b->kinds[KIND_##kernel]);
    BSDF_KERNELS(SHARE_FIRST)
#undef SHARE_FIRST
    const path_state *s = batch_state(b);
    for (uint32_t i = b->surfaces; i < b->n; i++)
        if (counts(s, i)) *shares_of(b, s, i) = scattered;
}
