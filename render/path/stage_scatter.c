#include "render/path/flight.h"
#include "render/path/lanes.h"
#include "render/path/medium.h"
#include "render/path/roulette.h"
#include "render/path/stages.h"

KERNEL void scatter(unsigned mask, const path_context *c, batch *b, lane_range lanes) {
    path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    roulette policy = roulette_make(c, b->depth);
    LANE_LOOP (uint32_t i = lanes.first; i < lanes.end; i++) {
        shading p = lane_shading(mask, s, x, i);
        vec3 throughput = {s->tr[i], s->tg[i], s->tb[i]};
        vec2 u = {x->u_bsdf_x[i], x->u_bsdf_y[i]};
        shading_scattering r = shading_scatter(mask, &p, throughput, x->u_lobe[i], u);
        float squeeze = s->squeeze[i];
        if (mask & BSDF_TRANSMISSIVE) {
            int bends = r.crosses & (p.bsdf.thin < 0.5f);
            squeeze *= bends ? p.bsdf.eta * p.bsdf.eta : 1.0f;
            s->squeeze[i] = squeeze;
            x->crosses[i] = (uint32_t)r.crosses;
        }
        float kept = roulette_weight(&policy, r.throughput, squeeze, x->u_roulette[i]);
        s->ox[i] = r.origin.x, s->oy[i] = r.origin.y, s->oz[i] = r.origin.z;
        s->dx[i] = r.direction.x, s->dy[i] = r.direction.y, s->dz[i] = r.direction.z;
        s->tr[i] = r.throughput.x * kept, s->tg[i] = r.throughput.y * kept, s->tb[i] = r.throughput.z * kept;
        s->pdf[i] = r.pdf;
    }
}

/* Apart from the loop above: 64-bit selects would keep it from vectorising. */
static void cross_media(const world *w, batch *b) {
    path_state *s = batch_state(b);
    const path_scratch *x = &b->scratch;
    lane_range lanes = lanes_with(b, BSDF_TRANSMISSIVE);
    for (uint32_t i = lanes.first; i < lanes.end; i++)
        if (x->crosses[i]) s->media[i] = x->beyond[i], s->events[i] += x->hidden[i];
    for (uint32_t i = lanes.first; w->spectrum && i < lanes.end; i++)
        if (w->media[medium_top(s->media[i])].spread > 0.0f) s->slot[i] |= SLOT_DISPERSED;
}

/* At points in a medium: the phase function. */
static void scatter_in_media(const path_context *c, batch *b) {
    path_state *s = batch_state(b);
    const path_scratch *x = &b->scratch;
    roulette policy = roulette_in_medium(c, b->depth);
    uint32_t first = b->kinds[KIND_MEDIUM].first, end = b->kinds[KIND_MEDIUM].end;
    LANE_LOOP (uint32_t i = first; i < end; i++) {
        vec3 wo = {-s->dx[i], -s->dy[i], -s->dz[i]}, throughput = {s->tr[i], s->tg[i], s->tb[i]};
        vec3 wi = phase_sample(wo, x->g[i], (vec2){x->u_bsdf_x[i], x->u_bsdf_y[i]});
        float kept = roulette_weight(&policy, throughput, s->squeeze[i], x->u_roulette[i]);
        s->ox[i] = x->px[i], s->oy[i] = x->py[i], s->oz[i] = x->pz[i];
        s->dx[i] = wi.x, s->dy[i] = wi.y, s->dz[i] = wi.z;
        s->tr[i] = throughput.x * kept, s->tg[i] = throughput.y * kept, s->tb[i] = throughput.z * kept;
        s->pdf[i] = phase_value(wo, wi, x->g[i]);
        s->events[i]++;
    }
}

void STAGE(scatter)(const path_context *c, batch *b) {
#define SCATTER(kernel, mask) scatter(mask, c, b, b->kinds[KIND_##kernel]);
    BSDF_KERNELS(SCATTER)
#undef SCATTER
    if (HAS(c->effects, SCATTERING)) scatter_in_media(c, b);
    if (HAS(c->effects, SOLIDS)) cross_media(c->world, b);
}
