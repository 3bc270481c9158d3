/* render/path/shading.h: what the shading stages load from a batch. Scalar kernels. */
#ifndef KILN_RENDER_PATH_SHADING_H
#define KILN_RENDER_PATH_SHADING_H

#include "render/bsdf/frame.h"
#include "render/path/batch.h"

/* The terms of the BSDF that a kind of material has. */
#define SHADING_MASK_DIFFUSE 0u
#define SHADING_MASK_GLOSSY ((unsigned)BSDF_GLOSSY)
#define SHADING_MASK_TRANSMISSIVE ((unsigned)(BSDF_GLOSSY | BSDF_TRANSMISSIVE))

KERNEL surface shading_surface(unsigned mask, const path_scratch *x, uint32_t i) {
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
        s.eta = x->eta[i];
        s.thin = x->thin[i];
        s.near_slice = x->near_slice[i];
        s.far_slice = x->far_slice[i];
    }
    return s;
}

/* The shading point of a lane: its frame and its BSDF. */
typedef struct shading { frame frame; bsdf bsdf; vec3 geometric; } shading;

KERNEL shading shading_load(unsigned mask, const path_state *s, const path_scratch *x, uint32_t i, const float *slices) {
    surface u = shading_surface(mask, x, i);
    frame f = frame_make(v3(x->nx[i], x->ny[i], x->nz[i]));
    vec3 wo = frame_to_local(&f, v3(-s->dx[i], -s->dy[i], -s->dz[i]));
    return (shading){f, bsdf_make(mask, &u, wo, slices), v3(x->gx[i], x->gy[i], x->gz[i])};
}

/* A direction must lie on the same side of the real surface as of the shaded one, or light would leak through. */
KERNEL int shading_side_agrees(const shading *s, vec3 wi_local, vec3 wi) {
    float real = v3_dot(wi, s->geometric);
    return (wi_local.z > 0.0f) == (real > 0.0f);
}

/* Where a ray along wi leaves from. */
KERNEL vec3 shading_leave(const shading *s, vec3 point, float reach, vec3 wi) {
    return v3_madd(point, v3_dot(wi, s->geometric) > 0.0f ? reach : -reach, s->geometric);
}

#endif
