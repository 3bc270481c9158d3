#include "render/path/flight.h"
#include "render/path/medium.h"
#include "render/path/stages.h"

/* Lanes in media that scatter, and which of them scatter before the surface. They are gathered in arrays that the light
 * sample will need only later. */
void STAGE(flight)(const path_context *c, batch *b) {
    const world *w = c->world;
    path_state *s = batch_state(b);
    path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    uint32_t count = 0, depth = b->depth;
    for (uint32_t i = 0; i < b->n; i++) {
        uint32_t medium = medium_top(s->media[i]);
        /* Where the ray leaves the scene the mesh is open, and the medium takes nothing. */
        if (!w->media[medium].scatters || h->triangle[i] >= TRIANGLE_REFUSED) continue;
        ray_crossing met = {h->triangle[i], h->instance[i], h->t[i], h->u[i], h->v[i]};
        x->tfar[count] = flight_limit(w, v3(s->ox[i], s->oy[i], s->oz[i]), v3(s->dx[i], s->dy[i], s->dz[i]), &met);
        x->rr[count] = s->tr[i], x->rg[count] = s->tg[i], x->rb[count] = s->tb[i];
        x->light[count] = s->seed[i], x->light_kind[count] = s->index[i];
        const float *sigma = w->extinction + 3 * (size_t)medium, *albedo = w->albedo + 3 * (size_t)medium;
        x->e1x[count] = sigma[0], x->e1y[count] = sigma[1], x->e1z[count] = sigma[2];
        x->e2x[count] = albedo[0], x->e2y[count] = albedo[1], x->e2z[count] = albedo[2];
        x->list[count++] = i;
    }
    int independent = c->independent;
    LANE_LOOP (uint32_t k = 0; k < count; k++) {
        vec2 u = sample_pair(independent, (sample_point){x->light_kind[k], x->light[k]}, SAMPLE_FLIGHT, depth);
        vec3 throughput = {x->rr[k], x->rg[k], x->rb[k]};
        vec3 extinction = {x->e1x[k], x->e1y[k], x->e1z[k]}, albedo = {x->e2x[k], x->e2y[k], x->e2z[k]};
        flight f = flight_sample(extinction, albedo, throughput, x->tfar[k], u.x, u.y);
        x->distance[k] = f.distance;
        x->u_fine[k] = f.scatters ? 1.0f : 0.0f;
        x->cr[k] = f.weight.x, x->cg[k] = f.weight.y, x->cb[k] = f.weight.z;
    }
    for (uint32_t k = 0; k < count; k++) {
        uint32_t i = x->list[k];
        s->tr[i] *= x->cr[k], s->tg[i] *= x->cg[k], s->tb[i] *= x->cb[k];
        if (x->u_fine[k] < 0.5f) continue;
        h->t[i] = x->distance[k];
        h->u[i] = HIT_SCATTERED;
    }
}

/* The points at which lanes scatter, in place of a surface. */
void STAGE(scattering)(const path_context *c, batch *b) {
    const world *w = c->world;
    path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    for (uint32_t i = b->kinds[KIND_MEDIUM].first; i < b->kinds[KIND_MEDIUM].end; i++) {
        float t = h->t[i];
        x->px[i] = s->ox[i] + t * s->dx[i], x->py[i] = s->oy[i] + t * s->dy[i], x->pz[i] = s->oz[i] + t * s->dz[i];
        /* What stages ask that are not only about surfaces. */
        x->above_x[i] = x->px[i], x->above_y[i] = x->py[i], x->above_z[i] = x->pz[i];
        x->plane_x[i] = x->plane_y[i] = x->plane_z[i] = 0.0f;
        x->gx[i] = x->gy[i] = x->gz[i] = x->nx[i] = x->ny[i] = x->nz[i] = x->tu[i] = x->tv[i] = 0.0f;
        x->material[i] = w->triangle_material[h->triangle[i]];
        x->beyond[i] = s->media[i];
        x->g[i] = w->media[medium_top(s->media[i])].g;
    }
}
