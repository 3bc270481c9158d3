#include "render/light/light.h"
#include "render/path/medium.h"
#include "render/path/stages.h"
#include "render/world/lookup.h"

static void load_records(const path_context *c, batch *b) {
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->n; i++) {
        const light *l = &c->world->lights.lights[x->light[i]];
        x->qx[i] = l->position.x, x->qy[i] = l->position.y, x->qz[i] = l->position.z;
        x->e1x[i] = l->e1.x, x->e1y[i] = l->e1.y, x->e1z[i] = l->e1.z;
        x->e2x[i] = l->e2.x, x->e2y[i] = l->e2.y, x->e2z[i] = l->e2.z;
        x->ax[i] = l->axis.x, x->ay[i] = l->axis.y, x->az[i] = l->axis.z;
        x->rr[i] = l->radiance.x, x->rg[i] = l->radiance.y, x->rb[i] = l->radiance.z;
        x->light_area[i] = l->area, x->light_error[i] = l->error;
        x->spot_scale[i] = l->spot_scale, x->spot_offset[i] = l->spot_offset;
        x->one_minus_cos[i] = l->one_minus_cos, x->two_sided[i] = l->two_sided;
        x->quad[i] = l->quad;
    }
}

KERNEL void sample(unsigned kinds, batch *b) {
    path_scratch *x = &b->scratch;
    LANE_LOOP (uint32_t i = 0; i < b->n; i++) {
        light l = {.kind = (light_kind)x->light_kind[i],
                   .position = {x->qx[i], x->qy[i], x->qz[i]},
                   .e1 = {x->e1x[i], x->e1y[i], x->e1z[i]},
                   .e2 = {x->e2x[i], x->e2y[i], x->e2z[i]},
                   .axis = {x->ax[i], x->ay[i], x->az[i]},
                   .radiance = {x->rr[i], x->rg[i], x->rb[i]},
                   .area = x->light_area[i],
                   .error = x->light_error[i],
                   .spot_scale = x->spot_scale[i],
                   .spot_offset = x->spot_offset[i],
                   .one_minus_cos = x->one_minus_cos[i],
                   .two_sided = x->two_sided[i],
                   .quad = x->quad[i]};
        vec3 p = {x->above_x[i], x->above_y[i], x->above_z[i]};
        light_sampled r = light_sample(kinds, &l, p, (vec2){x->u_light_x[i], x->u_light_y[i]});
        x->wx[i] = r.wi.x, x->wy[i] = r.wi.y, x->wz[i] = r.wi.z;
        x->tx[i] = r.target.x, x->ty[i] = r.target.y, x->tz[i] = r.target.z;
        x->distance[i] = r.distance;
        x->cr[i] = r.radiance.x, x->cg[i] = r.radiance.y, x->cb[i] = r.radiance.z;
        x->light_pdf[i] = r.pdf * x->probability[i];
        x->parallel[i] = r.parallel ? 1.0f : 0.0f;
    }
}

/* What the emitter's texture, its coverage and its coat say at the point. */
static void vary_emission(const world *w, batch *b) {
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->n; i++) {
        const light *l = &w->lights.lights[x->light[i]];
        if (!l->varies) continue;
        float cosine = -v3_dot(v3(x->wx[i], x->wy[i], x->wz[i]), l->axis);
        vec2 at = light_triangle_place(l, v3(x->tx[i], x->ty[i], x->tz[i]));
        vec3 e = lookup_emission(w, l->varies - 1, at, cosine);
        x->cr[i] *= e.x, x->cg[i] *= e.y, x->cb[i] *= e.z;
    }
}

/* Boundaries of solids that are hidden in another medium do not shine. Nothing lies between, so the light is looked at
 * from the medium on its side of the point. */
static void hide_emission(const world *w, batch *b) {
    const path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->n; i++) {
        uint32_t medium = w->lights.lights[x->light[i]].medium;
        if (!medium) continue;
        vec3 wi = {x->wx[i], x->wy[i], x->wz[i]}, n = {x->plane_x[i], x->plane_y[i], x->plane_z[i]};
        uint64_t media = v3_dot(wi, n) < 0.0f ? x->beyond[i] : s->media[i];
        int front = v3_dot(wi, v3(x->ax[i], x->ay[i], x->az[i])) < 0.0f;
        if (medium_hides(w->media, medium, media, front)) x->cr[i] = x->cg[i] = x->cb[i] = 0.0f;
    }
}

void STAGE(light)(const path_context *c, batch *b) {
    const light_table *t = &c->world->lights;
    STAGE(choose)(c, b);
    if (t->kinds != KIND(LIGHT_ENVIRONMENT)) load_records(c, b);
    if (t->environment.present) STAGE(surroundings)(c, b);
    if (t->kinds == KIND(LIGHT_TRIANGLE)) sample(KIND(LIGHT_TRIANGLE), b);
    else if (t->kinds == KIND(LIGHT_ENVIRONMENT)) sample(KIND(LIGHT_ENVIRONMENT), b);
    else sample(KIND(LIGHT_KINDS) - 1, b);
    if (HAS(c->effects, TEXTURED_LIGHTS)) vary_emission(c->world, b);
    if (t->bounds) hide_emission(c->world, b);
}
