#include "render/path/cone.h"
#include "render/path/stages.h"

/* Off the loop over cameras' rays: scenes without pyramids do not run it. */
void STAGE(cone_start)(const path_context *c, batch *b) {
    path_state *s = batch_state(b);
    const camera *cam = &c->camera;
    float pixel = 2.0f * cam->half_height / (float)(int32_t)c->height;
    LANE_LOOP (uint32_t i = 0; i < b->n; i++) {
        cone k = cone_camera(cam, pixel, v3(s->dx[i], s->dy[i], s->dz[i]));
        s->width[i] = k.width;
        s->spread[i] = k.spread;
    }
}

void STAGE(cone_hit)(const path_context *c, batch *b) {
    (void)c;
    const path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    LANE_LOOP (uint32_t i = 0; i < b->surfaces; i++) {
        vec3 p0 = {x->p0x[i], x->p0y[i], x->p0z[i]};
        vec3 e1 = v3_sub(v3(x->p1x[i], x->p1y[i], x->p1z[i]), p0), e2 = v3_sub(v3(x->p2x[i], x->p2y[i], x->p2z[i]), p0);
        cone_curvature k = cone_curvature_of(e1, e2, v3(x->n0x[i], x->n0y[i], x->n0z[i]),
                                             v3(x->n1x[i], x->n1y[i], x->n1z[i]), v3(x->n2x[i], x->n2y[i], x->n2z[i]),
                                             v3(x->gx[i], x->gy[i], x->gz[i]));
        float width = s->width[i] + s->spread[i] * h->t[i];
        texture_footprint f = cone_footprint(width, e1, e2, (vec2){x->s1[i] - x->s0[i], x->t1[i] - x->t0[i]},
                                             (vec2){x->s2[i] - x->s0[i], x->t2[i] - x->t0[i]});
        x->foot_uu[i] = f.xx, x->foot_uv[i] = f.xy, x->foot_vv[i] = f.yy;
        x->curve_low[i] = k.low, x->curve_high[i] = k.high;
        x->across[i] = width;
        x->came_x[i] = s->dx[i], x->came_y[i] = s->dy[i], x->came_z[i] = s->dz[i];
    }
}

/* coated: clear coats may have normal maps of their own: which normal bent the path is not asked. */
KERNEL void bounce(int transmissive, int mapped, int coated, batch *b, lane_range lanes) {
    path_state *s = batch_state(b);
    const path_scratch *x = &b->scratch;
    LANE_LOOP (uint32_t i = lanes.first; i < lanes.end; i++) {
        cone_bounce k = {.d = {x->came_x[i], x->came_y[i], x->came_z[i]},
                         .n = {x->nx[i], x->ny[i], x->nz[i]},
                         .wi = {s->dx[i], s->dy[i], s->dz[i]},
                         .curvature = {x->curve_low[i], x->curve_high[i]},
                         .pdf = s->pdf[i],
                         .eta = 1.0f};
        if (mapped) k.bumpy = (x->map_x[i] != 0.0f) | (x->map_y[i] != 0.0f);
        if (coated) k.bumpy = k.bumpy | (x->clearcoat[i] > 0.0f);
        if (transmissive) {
            int crosses = x->crosses[i] != 0, thin = x->thin[i] > 0.5f;
            k.eta = x->eta[i];
            k.bends = crosses & !thin;
            k.passes = crosses & thin;
        }
        cone next = cone_scatter((cone){x->across[i], s->spread[i]}, &k);
        s->width[i] = next.width;
        s->spread[i] = next.spread;
    }
}

void STAGE(cone_scatter)(const path_context *c, batch *b) {
    int mapped = HAS(c->effects, NORMAL_MAPS), coated = (c->world->slots & 1u << SLOT_CLEARCOAT_NORMAL) != 0;
    bounce(0, mapped, 0, b, kinds_range(b, KIND_DIFFUSE, KIND_GLOSSY));
    bounce(0, mapped, coated, b, b->kinds[KIND_COATED]);
    bounce(1, mapped, 0, b, b->kinds[KIND_TRANSMISSIVE]);
    bounce(1, mapped, coated, b, kinds_range(b, KIND_LAYERED, KIND_FILMED));
    path_state *s = batch_state(b); /* what a medium has scattered may come to a focus anywhere */
    for (uint32_t i = b->surfaces; i < b->n; i++) s->width[i] = s->spread[i] = 0.0f;
}
