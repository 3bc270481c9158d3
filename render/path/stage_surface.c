#include "render/path/stages.h"
#include "render/path/surface.h"

KERNEL surface_triangle corners(const path_scratch *x, uint32_t i) {
    return (surface_triangle){.p0 = {x->p0x[i], x->p0y[i], x->p0z[i]},
                              .p1 = {x->p1x[i], x->p1y[i], x->p1z[i]},
                              .p2 = {x->p2x[i], x->p2y[i], x->p2z[i]},
                              .n0 = {x->n0x[i], x->n0y[i], x->n0z[i]},
                              .n1 = {x->n1x[i], x->n1y[i], x->n1z[i]},
                              .n2 = {x->n2x[i], x->n2y[i], x->n2z[i]}};
}

KERNEL void put_sides(path_scratch *x, uint32_t i, surface_sides s) {
    x->plane_x[i] = s.normal.x, x->plane_y[i] = s.normal.y, x->plane_z[i] = s.normal.z;
    x->above_x[i] = s.above.x, x->above_y[i] = s.above.y, x->above_z[i] = s.above.z;
    x->below_x[i] = s.below.x, x->below_y[i] = s.below.y, x->below_z[i] = s.below.z;
}

static void lift(batch *b) {
    const path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    LANE_LOOP (uint32_t i = 0; i < b->surfaces; i++) {
        surface_triangle t = corners(x, i);
        surface_point p = {.hit = {h->u[i], h->v[i], h->t[i]},
                           .position = {x->px[i], x->py[i], x->pz[i]},
                           .geometric = {x->gx[i], x->gy[i], x->gz[i]},
                           .shading = {x->nx[i], x->ny[i], x->nz[i]},
                           .reach = x->reach[i]};
        put_sides(x, i, surface_smooth_sides(&p, &t, v3(-s->dx[i], -s->dy[i], -s->dz[i])));
    }
}

void STAGE(surface)(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    LANE_LOOP (uint32_t i = 0; i < b->surfaces; i++) {
        surface_triangle t = corners(x, i);
        t.uv0 = (vec2){x->s0[i], x->t0[i]}, t.uv1 = (vec2){x->s1[i], x->t1[i]}, t.uv2 = (vec2){x->s2[i], x->t2[i]};
        t.side = x->side[i];
        t.magnitude = x->magnitude[i];
        t.embree = (triangle_hit){h->u[i], h->v[i], h->t[i]};
        surface_point p = surface_at(v3(s->ox[i], s->oy[i], s->oz[i]), v3(s->dx[i], s->dy[i], s->dz[i]), &t);
        h->t[i] = p.hit.t, h->u[i] = p.hit.u, h->v[i] = p.hit.v;
        x->px[i] = p.position.x, x->py[i] = p.position.y, x->pz[i] = p.position.z;
        x->gx[i] = p.geometric.x, x->gy[i] = p.geometric.y, x->gz[i] = p.geometric.z;
        x->nx[i] = p.shading.x, x->ny[i] = p.shading.y, x->nz[i] = p.shading.z;
        x->reach[i] = p.reach;
        x->area[i] = p.area;
        x->front[i] = p.front;
        x->tu[i] = p.uv.x, x->tv[i] = p.uv.y;
        put_sides(x, i, surface_flat_sides(&p));
    }
    if (HAS(c->effects, SMOOTH_NORMALS)) lift(b);
}
