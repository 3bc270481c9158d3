#include "render/path/stages.h"
#include "render/path/surface.h"

void STAGE(surface)(const path_context *c, batch *b) {
    (void)c;
    const path_state *s = batch_state(b);
    path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    LANE_LOOP (uint32_t i = 0; i < b->n; i++) {
        vec3 o = {s->ox[i], s->oy[i], s->oz[i]}, d = {s->dx[i], s->dy[i], s->dz[i]};
        vec3 p0 = {x->p0x[i], x->p0y[i], x->p0z[i]};
        vec3 e1 = v3_sub(v3(x->p1x[i], x->p1y[i], x->p1z[i]), p0);
        vec3 e2 = v3_sub(v3(x->p2x[i], x->p2y[i], x->p2z[i]), p0);
        triangle_hit hit = triangle_intersect(o, d, p0, e1, e2, (triangle_hit){h->u[i], h->v[i], h->t[i]});
        float b0 = 1.0f - hit.u - hit.v;
        vec3 p = v3_madd(v3_madd(p0, hit.u, e1), hit.v, e2);

        vec3 n = v3_scale(v3_cross(e1, e2), x->side[i]);
        float twice = sqrtf(v3_dot(n, n));
        n = v3_scale(n, 1.0f / fm_max(twice, 1e-37f));
        float front = v3_dot(n, d) < 0.0f ? 1.0f : 0.0f;
        n = v3_scale(n, front > 0.5f ? 1.0f : -1.0f);
        vec3 smooth = v3_scale(v3(x->n0x[i], x->n0y[i], x->n0z[i]), b0);
        smooth = v3_madd(smooth, hit.u, v3(x->n1x[i], x->n1y[i], x->n1z[i]));
        smooth = v3_madd(smooth, hit.v, v3(x->n2x[i], x->n2y[i], x->n2z[i]));
        vec3 shading = surface_normal(smooth, n);

        h->t[i] = hit.t, h->u[i] = hit.u, h->v[i] = hit.v;
        x->px[i] = p.x, x->py[i] = p.y, x->pz[i] = p.z;
        x->gx[i] = n.x, x->gy[i] = n.y, x->gz[i] = n.z;
        x->nx[i] = shading.x, x->ny[i] = shading.y, x->nz[i] = shading.z;
        x->reach[i] = surface_reach(n, p0, e1, e2, x->magnitude[i]);
        x->area[i] = 0.5f * twice;
        x->front[i] = front;
        x->tu[i] = b0 * x->s0[i] + hit.u * x->s1[i] + hit.v * x->s2[i];
        x->tv[i] = b0 * x->t0[i] + hit.u * x->t1[i] + hit.v * x->t2[i];
    }
}
