#include "render/path/stages.h"
#include "render/path/surface.h"

void STAGE(surface)(const path_context *c, batch *b) {
    (void)c;
    const path_state *s = batch_state(b);
    path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    LANE_LOOP (uint32_t i = 0; i < b->surfaces; i++) {
        surface_triangle t = {.p0 = {x->p0x[i], x->p0y[i], x->p0z[i]},
                              .p1 = {x->p1x[i], x->p1y[i], x->p1z[i]},
                              .p2 = {x->p2x[i], x->p2y[i], x->p2z[i]},
                              .n0 = {x->n0x[i], x->n0y[i], x->n0z[i]},
                              .n1 = {x->n1x[i], x->n1y[i], x->n1z[i]},
                              .n2 = {x->n2x[i], x->n2y[i], x->n2z[i]},
                              .uv0 = {x->s0[i], x->t0[i]},
                              .uv1 = {x->s1[i], x->t1[i]},
                              .uv2 = {x->s2[i], x->t2[i]},
                              .side = x->side[i],
                              .magnitude = x->magnitude[i],
                              .embree = {h->u[i], h->v[i], h->t[i]}};
        surface_point p = surface_at(v3(s->ox[i], s->oy[i], s->oz[i]), v3(s->dx[i], s->dy[i], s->dz[i]), &t);
        h->t[i] = p.hit.t, h->u[i] = p.hit.u, h->v[i] = p.hit.v;
        x->px[i] = p.position.x, x->py[i] = p.position.y, x->pz[i] = p.position.z;
        x->gx[i] = p.geometric.x, x->gy[i] = p.geometric.y, x->gz[i] = p.geometric.z;
        x->nx[i] = p.shading.x, x->ny[i] = p.shading.y, x->nz[i] = p.shading.z;
        x->reach[i] = p.reach;
        x->area[i] = p.area;
        x->front[i] = p.front;
        x->tu[i] = p.uv.x, x->tv[i] = p.uv.y;
    }
}
