#include "render/path/flight.h"
#include "render/path/medium.h"
#include "render/path/stages.h"

/* Lanes in media that scatter, and which of them scatter before the surface. */
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
        x->limit[count] = flight_limit(w, v3(s->ox[i], s->oy[i], s->oz[i]), v3(s->dx[i], s->dy[i], s->dz[i]), &met);
        x->carried_r[count] = s->tr[i], x->carried_g[count] = s->tg[i], x->carried_b[count] = s->tb[i];
        x->flight_seed[count] = s->seed[i], x->flight_index[count] = s->index[i];
        const float *sigma = w->extinction + 3 * (size_t)medium, *albedo = w->albedo + 3 * (size_t)medium;
        x->sigma_r[count] = sigma[0], x->sigma_g[count] = sigma[1], x->sigma_b[count] = sigma[2];
        x->albedo_r[count] = albedo[0], x->albedo_g[count] = albedo[1], x->albedo_b[count] = albedo[2];
        x->list[count++] = i;
    }
    int independent = c->independent;
    LANE_LOOP (uint32_t k = 0; k < count; k++) {
        vec2 u = sample_pair(independent, (sample_point){x->flight_index[k], x->flight_seed[k]}, SAMPLE_FLIGHT, depth);
        vec3 throughput = {x->carried_r[k], x->carried_g[k], x->carried_b[k]};
        vec3 extinction = {x->sigma_r[k], x->sigma_g[k], x->sigma_b[k]};
        vec3 albedo = {x->albedo_r[k], x->albedo_g[k], x->albedo_b[k]};
        flight f = flight_sample(extinction, albedo, throughput, x->limit[k], u.x, u.y);
        x->flown[k] = f.distance;
        x->scatters[k] = f.scatters ? 1.0f : 0.0f;
        x->weight_r[k] = f.weight.x, x->weight_g[k] = f.weight.y, x->weight_b[k] = f.weight.z;
    }
    for (uint32_t k = 0; k < count; k++) {
        uint32_t i = x->list[k];
        s->tr[i] *= x->weight_r[k], s->tg[i] *= x->weight_g[k], s->tb[i] *= x->weight_b[k];
        if (x->scatters[k] < 0.5f) continue;
        h->t[i] = x->flown[k];
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
