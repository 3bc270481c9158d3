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
    if (mask & BSDF_COVERED) s.near = x->near_layers[i], s.far = x->far_layers[i];
    if (mask & BSDF_ANISOTROPIC) {
        s.anisotropy = x->anisotropy[i];
        s.along = v3(x->along_x[i], x->along_y[i], x->along_z[i]);
    }
    if (mask & BSDF_CLEARCOAT) {
        s.clearcoat = x->clearcoat[i], s.clearcoat_roughness = x->clearcoat_roughness[i];
        s.clearcoat_normal = v3(x->coat_x[i], x->coat_y[i], x->coat_z[i]);
    }
    if (mask & BSDF_SHEEN) {
        s.sheen = v3(x->sheen_r[i], x->sheen_g[i], x->sheen_b[i]);
        s.sheen_roughness = x->sheen_roughness[i];
    }
    if (mask & BSDF_FILM) s.film = x->film[i], s.film_ior = x->film_ior[i], s.film_thickness = x->film_thickness[i];
    if (mask & BSDF_TRANSLUCENT) {
        s.diffuse_transmission = x->pass[i];
        s.diffuse_transmission_color = v3_mul(v3(x->pass_r[i], x->pass_g[i], x->pass_b[i]),
                                              v3(x->hue_r[i], x->hue_g[i], x->hue_b[i]));
    }
    return s;
}

KERNEL shading lane_shading(unsigned mask, const path_state *s, const path_scratch *x, uint32_t i) {
    surface u = lane_surface(mask, x, i);
    surface_sides sides = {{x->plane_x[i], x->plane_y[i], x->plane_z[i]},
                           {x->above_x[i], x->above_y[i], x->above_z[i]},
                           {x->below_x[i], x->below_y[i], x->below_z[i]}};
    return shading_make(mask, &u, sides, v3(x->gx[i], x->gy[i], x->gz[i]), v3(x->nx[i], x->ny[i], x->nz[i]),
                        v3(-s->dx[i], -s->dy[i], -s->dz[i]));
}

#endif
