#include "render/path/estimate.h"
#include "render/path/medium.h"
#include "render/path/shading.h"
#include "render/path/stages.h"

/* Throughput × f cos × radiance × weight / density, and the shadow ray that decides on it. */
KERNEL void weigh(unsigned mask, const path_context *c, batch *b, lane_range lanes) {
    const path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    const float *slices = c->world->slices;
    kiln_estimator estimator = c->estimator;
    LANE_LOOP (uint32_t i = lanes.first; i < lanes.end; i++) {
        shading p = shading_load(mask, s, x, i, slices);
        vec3 wi = {x->wx[i], x->wy[i], x->wz[i]}, local = frame_to_local(&p.frame, wi);
        bsdf_value f = bsdf_evaluate(mask, &p.bsdf, local, slices);
        float weight = estimate_light_weight(estimator, x->parallel[i] > 0.5f, x->light_pdf[i], f.pdf);
        int comes = shading_side_agrees(&p, local, wi) & (x->light_pdf[i] > 0.0f);
        float scale = comes ? weight / x->light_pdf[i] : 0.0f;
        x->cr[i] *= s->tr[i] * f.value.x * scale;
        x->cg[i] *= s->tg[i] * f.value.y * scale;
        x->cb[i] *= s->tb[i] * f.value.z * scale;

        vec3 o = shading_leave(&p, v3(x->px[i], x->py[i], x->pz[i]), x->reach[i], wi);
        int placed = x->distance[i] < INFINITY;
        vec3 to = v3_sub(v3(x->tx[i], x->ty[i], x->tz[i]), o);
        float length2 = v3_dot(to, to), length = sqrtf(length2);
        vec3 d = v3_select(placed, v3_scale(to, 1.0f / fm_max(length, 1e-30f)), wi);
        x->sox[i] = o.x, x->soy[i] = o.y, x->soz[i] = o.z;
        x->sdx[i] = d.x, x->sdy[i] = d.y, x->sdz[i] = d.z;
        x->tfar[i] = placed ? length : INFINITY;
    }
}

/* The medium between the point and the light, on whichever side of the surface that is. */
static void attenuate(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->n; i++) {
        vec3 wi = {x->wx[i], x->wy[i], x->wz[i]}, n = {x->gx[i], x->gy[i], x->gz[i]};
        bool solid = i >= b->kinds[KIND_TRANSMISSIVE].first && x->medium[i];
        uint64_t media = s->media[i];
        if (solid && v3_dot(wi, n) < 0.0f) media = medium_cross(media, x->medium[i], x->front[i] > 0.5f);
        vec3 left = medium_transmittance(c->world->media + 3 * (media & 0xffffu), x->distance[i]);
        x->cr[i] *= left.x, x->cg[i] *= left.y, x->cb[i] *= left.z;
    }
}

void STAGE(connect)(const path_context *c, batch *b) {
    weigh(SHADING_MASK_DIFFUSE, c, b, b->kinds[KIND_DIFFUSE]);
    weigh(SHADING_MASK_GLOSSY, c, b, b->kinds[KIND_GLOSSY]);
    weigh(SHADING_MASK_TRANSMISSIVE, c, b, b->kinds[KIND_TRANSMISSIVE]);
    if (c->world->absorbs) attenuate(c, b);

    path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    uint32_t count = 0;
    for (uint32_t i = 0; i < b->n; i++) {
        x->visible[i] = RAY_STOPPED;
        x->list[count] = i;
        count += (x->cr[i] > 0.0f) | (x->cg[i] > 0.0f) | (x->cb[i] > 0.0f);
    }
    ray_lanes rays = {x->sox, x->soy, x->soz, x->sdx, x->sdy, x->sdz, NULL, x->tfar, x->u_shadow, x->list, count};
    accel_visible(c->world, &rays, x->visible, &b->shadow_rays);
    for (uint32_t k = 0; k < count; k++)
        if (x->visible[x->list[k]] == RAY_REFUSED) b->out.refused[s->slot[x->list[k]] & ~SLOT_BEYOND] = 1;
    LANE_LOOP (uint32_t i = 0; i < b->n; i++) {
        float seen = x->visible[i] == RAY_REACHES ? 1.0f : 0.0f;
        s->lr[i] += seen * x->cr[i];
        s->lg[i] += seen * x->cg[i];
        s->lb[i] += seen * x->cb[i];
    }
}
