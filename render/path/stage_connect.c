#include "render/path/flight.h"
#include "render/path/lanes.h"
#include "render/path/medium.h"
#include "render/path/stages.h"

KERNEL void weigh(unsigned mask, const path_context *c, batch *b, lane_range lanes) {
    const path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    kiln_estimator estimator = c->estimator;
    LANE_LOOP (uint32_t i = lanes.first; i < lanes.end; i++) {
        shading p = lane_shading(mask, s, x, i);
        light_sampled l = {.wi = {x->wx[i], x->wy[i], x->wz[i]},
                           .target = {x->tx[i], x->ty[i], x->tz[i]},
                           .distance = x->distance[i],
                           .radiance = {x->cr[i], x->cg[i], x->cb[i]},
                           .parallel = x->parallel[i] > 0.5f};
        vec3 throughput = {s->tr[i], s->tg[i], s->tb[i]};
        shading_connection r = shading_connect(mask, &p, estimator, throughput, &l, x->light_pdf[i]);
        x->cr[i] = r.contribution.x, x->cg[i] = r.contribution.y, x->cb[i] = r.contribution.z;
        x->sox[i] = r.origin.x, x->soy[i] = r.origin.y, x->soz[i] = r.origin.z;
        x->sdx[i] = r.direction.x, x->sdy[i] = r.direction.y, x->sdz[i] = r.direction.z;
        x->tfar[i] = r.far;
    }
}

/* The same at points in a medium. */
static void weigh_scattering(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    kiln_estimator estimator = c->estimator;
    uint32_t first = b->kinds[KIND_MEDIUM].first, end = b->kinds[KIND_MEDIUM].end;
    LANE_LOOP (uint32_t i = first; i < end; i++) {
        light_sampled l = {.wi = {x->wx[i], x->wy[i], x->wz[i]},
                           .radiance = {x->cr[i], x->cg[i], x->cb[i]},
                           .parallel = x->parallel[i] > 0.5f};
        vec3 throughput = {s->tr[i], s->tg[i], s->tb[i]}, p = {x->px[i], x->py[i], x->pz[i]};
        vec3 r = flight_connect(v3(-s->dx[i], -s->dy[i], -s->dz[i]), x->g[i], estimator, throughput, &l, x->light_pdf[i]);
        vec3 to = v3_sub(v3(x->tx[i], x->ty[i], x->tz[i]), p);
        int placed = x->distance[i] < INFINITY;
        float length = sqrtf(v3_dot(to, to));
        vec3 way = v3_select(placed, v3_scale(to, 1.0f / fm_max(length, 1e-30f)), l.wi);
        x->cr[i] = r.x, x->cg[i] = r.y, x->cb[i] = r.z;
        x->sox[i] = p.x, x->soy[i] = p.y, x->soz[i] = p.z;
        x->sdx[i] = way.x, x->sdy[i] = way.y, x->sdz[i] = way.z;
        x->tfar[i] = placed ? length : INFINITY;
    }
}

/* The medium between the point and the light, on whichever side of the surface that is. */
static void attenuate(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->n; i++) {
        vec3 wi = {x->wx[i], x->wy[i], x->wz[i]}, n = {x->plane_x[i], x->plane_y[i], x->plane_z[i]};
        uint64_t media = v3_dot(wi, n) < 0.0f ? x->beyond[i] : s->media[i];
        vec3 left = medium_transmittance(c->world->extinction, medium_top(media), x->distance[i]);
        x->cr[i] *= left.x, x->cg[i] *= left.y, x->cb[i] *= left.z;
    }
}

void STAGE(connect)(const path_context *c, batch *b) {
#define WEIGH(kernel, mask) weigh(mask, c, b, b->kinds[KIND_##kernel]);
    BSDF_KERNELS(WEIGH)
#undef WEIGH
    if (HAS(c->effects, SCATTERING)) weigh_scattering(c, b);
    if (HAS(c->effects, ABSORPTION) || HAS(c->effects, SCATTERING)) attenuate(c, b);

    path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    uint32_t count = 0;
    for (uint32_t i = 0; i < b->n; i++) {
        x->visible[i] = RAY_STOPPED;
        x->list[count] = i;
        count += (x->cr[i] > 0.0f) | (x->cg[i] > 0.0f) | (x->cb[i] > 0.0f);
    }
    stage_clock_read(&b->clock, KILN_STAGE_CONNECT);
    ray_coverage coverage = {s->seed, s->index, sample_key(SAMPLE_LIGHT_FINE, b->depth), c->independent};
    ray_lanes rays = {x->sox, x->soy, x->soz, x->sdx, x->sdy, x->sdz, NULL, x->tfar, coverage, x->list, count,
                      false};
    accel_visible(c->world, &rays, x->visible, &b->shadow_rays);
    stage_clock_read(&b->clock, KILN_STAGE_SHADOW_RAYS);
    for (uint32_t k = 0; k < count; k++)
        if (x->visible[x->list[k]] == RAY_REFUSED) b->out.refused[slot_index(s->slot[x->list[k]])] = 1;
    LANE_LOOP (uint32_t i = 0; i < b->n; i++) {
        float seen = x->visible[i] == RAY_REACHES ? 1.0f : 0.0f;
        s->lr[i] += seen * x->cr[i];
        s->lg[i] += seen * x->cg[i];
        s->lb[i] += seen * x->cb[i];
    }
}
