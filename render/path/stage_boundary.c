#include "render/bsdf/fresnel.h"
#include "render/path/medium.h"
#include "render/path/stages.h"

/* A boundary inside of a medium that outranks its own is not there: as a perfectly clear and dark interface without a
 * bend it needs no case of its own in what follows, but that it is no bounce. Light samples see a delta, so emission
 * beyond it counts in full. */
static void hide(path_scratch *x, uint32_t i) {
    x->emit_r[i] = x->emit_g[i] = x->emit_b[i] = 0.0f;
    x->base_r[i] = x->base_g[i] = x->base_b[i] = 1.0f;
    x->metallic[i] = x->roughness[i] = x->f0[i] = 0.0f;
    x->transmission[i] = 1.0f;
    x->near_layers[i] = x->far_layers[i] = x->anisotropy[i] = x->film[i] = x->pass[i] = 0.0f;
}

/* The index of a surface is relative to what is in front of it. */
static void set_eta(path_scratch *x, uint32_t i, const world_material *m, float eta) {
    x->eta[i] = eta;
    x->f0[i] = m->f0 < 1.0f ? fresnel_normal(eta) : 1.0f; /* 1: an infinite index */
}

/* A path takes on a wavelength where it enters a dispersive medium for the first time. */
static void set_hue(const world *w, const path_state *s, path_scratch *x, uint32_t i, const spectrum_line *line) {
    bool takes = w->media[medium_top(x->beyond[i])].spread > 0.0f && !(s->slot[i] & SLOT_DISPERSED);
    if (takes) x->hue_r[i] = line->weight.x, x->hue_g[i] = line->weight.y, x->hue_b[i] = line->weight.z;
}

static void bound(const path_context *c, const path_state *s, path_scratch *x, uint32_t i, const world_material *m) {
    const world *w = c->world;
    int entering = x->front[i] > 0.5f;
    spectrum_line line = {.wavelength = WAVELENGTH_D};
    if (w->spectrum) line = path_wavelength(c, (sample_point){s->index[i], s->seed[i]});
    medium_boundary at =
        medium_boundary_at(w->media, m->medium, s->media[i], x->beyond[i], entering, line.wavelength);
    set_eta(x, i, m, at.eta);
    x->hidden[i] = (uint32_t)at.hidden;
    if (at.hidden) hide(x, i);
    else if (w->spectrum) set_hue(w, s, x, i, &line);
}

void STAGE(boundary)(const path_context *c, batch *b) {
    const world *w = c->world;
    const path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->surfaces; i++) {
        const world_material *m = &w->materials[x->material[i]];
        uint64_t media = s->media[i];
        x->hidden[i] = 0;
        int entering = x->front[i] > 0.5f;
        x->beyond[i] = HAS(c->effects, NESTED_MEDIA) ? h->beyond[i] : medium_cross(media, m->medium, entering);
        if (m->medium) bound(c, s, x, i, m);
        else if (media && m->kind != KIND_DIFFUSE) set_eta(x, i, m, m->eta / w->media[medium_top(media)].ior);
    }
}
