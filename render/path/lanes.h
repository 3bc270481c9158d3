/* render/path/lanes.h: what shading stages load from a batch's arrays. */
#ifndef KILN_RENDER_PATH_LANES_H
#define KILN_RENDER_PATH_LANES_H

#include "render/path/batch.h"
#include "render/path/shading.h"

KERNEL surface lane_surface(unsigned mask, const path_scratch *x, uint32_t i) {
    surface s = {.base = {x->base_r[i], x->base_g[i], x->base_b[i]}};
    if (mask & BSDF_GLOSSY) {
        s.metallic = x->metallic[i];
        s.roughness = x->roughness[i];
        s.specular = x->specular[i];
        s.specular_color = v3(x->tint_r[i], x->tint_g[i], x->tint_b[i]);
        s.f0 = x->f0[i];
    }
    if (mask & BSDF_TRANSMISSIVE) {
        s.transmission = x->transmission[i];
        s.through = v3_mul(s.base, v3(x->hue_r[i], x->hue_g[i], x->hue_b[i]));
        s.eta = x->eta[i];
        s.thin = x->thin[i];
    }
    return s;
}

KERNEL shading lane_shading(unsigned mask, const path_state *s, const path_scratch *x, uint32_t i) {
    surface u = lane_surface(mask, x, i);
    return shading_make(mask, &u, v3(x->px[i], x->py[i], x->pz[i]), v3(x->gx[i], x->gy[i], x->gz[i]),
                        v3(x->nx[i], x->ny[i], x->nz[i]), x->reach[i], v3(-s->dx[i], -s->dy[i], -s->dz[i]));
}

#endif
