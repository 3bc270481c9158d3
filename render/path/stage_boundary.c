#include "render/path/medium.h"
#include "render/path/stages.h"

/* A boundary inside of a medium that outranks its own is not there: as a perfectly clear interface without a bend it
 * needs no case of its own in what follows. Light samples see a delta, so emission beyond it counts in full. */
static void hide(path_scratch *x, uint32_t i) {
    x->base_r[i] = x->base_g[i] = x->base_b[i] = 1.0f;
    x->metallic[i] = x->roughness[i] = x->f0[i] = 0.0f;
    x->transmission[i] = 1.0f;
}

static float normal_reflectance(float eta) {
    float root = (eta - 1.0f) / (eta + 1.0f);
    return root * root;
}

/* The index of a surface is relative to what is in front of it. */
static void set_eta(path_scratch *x, uint32_t i, const world_material *m, float eta) {
    x->eta[i] = eta;
    x->f0[i] = m->f0 < 1.0f ? normal_reflectance(eta) : 1.0f; /* 1: an infinite index */
}

void STAGE(boundary)(const path_context *c, batch *b) {
    const world *w = c->world;
    const path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->n; i++) {
        const world_material *m = &w->materials[x->material[i]];
        uint64_t media = s->media[i];
        int entering = x->front[i] > 0.5f;
        x->beyond[i] = w->touches ? h->beyond[i] : medium_cross(media, m->medium, entering);
        if (m->medium) {
            medium_boundary at = medium_boundary_at(w->media, m->medium, media, x->beyond[i], entering);
            set_eta(x, i, m, at.eta);
            if (at.hidden) hide(x, i);
        } else if (media && m->kind != KIND_DIFFUSE) {
            set_eta(x, i, m, m->eta / w->media[medium_top(media)].ior);
        }
    }
}
