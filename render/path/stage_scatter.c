#include "render/path/medium.h"
#include "render/path/roulette.h"
#include "render/path/shading.h"
#include "render/path/stages.h"

KERNEL void scatter(unsigned mask, const path_context *c, batch *b, lane_range lanes) {
    path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    const float *slices = c->world->slices;
    roulette r = roulette_make(c, b->depth);
    LANE_LOOP (uint32_t i = lanes.first; i < lanes.end; i++) {
        shading p = shading_load(mask, s, x, i, slices);
        bsdf_sampled next = bsdf_sample(mask, &p.bsdf, x->u_lobe[i], (vec2){x->u_bsdf_x[i], x->u_bsdf_y[i]}, slices);
        vec3 wi = v3_normalize(frame_to_world(&p.frame, next.wi));
        int goes_on = shading_side_agrees(&p, next.wi, wi);
        vec3 throughput = v3_mul(v3(s->tr[i], s->tg[i], s->tb[i]), next.multiplier);
        throughput = v3_scale(throughput, goes_on ? 1.0f : 0.0f);
        float squeeze = s->squeeze[i];
        if (mask & BSDF_TRANSMISSIVE) {
            int crosses = next.wi.z < 0.0f, bends = crosses & (p.bsdf.thin < 0.5f);
            squeeze *= bends ? p.bsdf.eta * p.bsdf.eta : 1.0f;
            s->squeeze[i] = squeeze;
            x->crosses[i] = (uint32_t)crosses;
        }
        float survival = roulette_survival(&r, throughput, squeeze);
        float kept = x->u_roulette[i] < survival ? 1.0f / survival : 0.0f;

        vec3 o = shading_leave(&p, v3(x->px[i], x->py[i], x->pz[i]), x->reach[i], wi);
        s->ox[i] = o.x, s->oy[i] = o.y, s->oz[i] = o.z;
        s->dx[i] = wi.x, s->dy[i] = wi.y, s->dz[i] = wi.z;
        s->tr[i] = throughput.x * kept, s->tg[i] = throughput.y * kept, s->tb[i] = throughput.z * kept;
        s->pdf[i] = next.pdf;
    }
}

/* Apart from the loop above: 64-bit selects would keep it from vectorising. */
static void cross_media(batch *b) {
    path_state *s = batch_state(b);
    const path_scratch *x = &b->scratch;
    for (uint32_t i = b->kinds[KIND_TRANSMISSIVE].first; i < b->kinds[KIND_TRANSMISSIVE].end; i++)
        if (x->crosses[i]) s->media[i] = medium_cross(s->media[i], x->medium[i], x->front[i] > 0.5f);
}

void STAGE(scatter)(const path_context *c, batch *b) {
    scatter(SHADING_MASK_DIFFUSE, c, b, b->kinds[KIND_DIFFUSE]);
    scatter(SHADING_MASK_GLOSSY, c, b, b->kinds[KIND_GLOSSY]);
    scatter(SHADING_MASK_TRANSMISSIVE, c, b, b->kinds[KIND_TRANSMISSIVE]);
    cross_media(b);
}
