/* render/bsdf/reflectance.h: the Fresnel terms of a surface, and how much a rough one reflects in all. */
#ifndef KILN_RENDER_BSDF_REFLECTANCE_H
#define KILN_RENDER_BSDF_REFLECTANCE_H

#include "render/bsdf/thin_film.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/types.h"

/* The interface's exact Fresnel term, stretched between the material's F0 and F90; 1 under total reflection. */
KERNEL vec3 bsdf_exact_fresnel(const bsdf *b, float c) {
    float exact0 = fresnel_normal(b->eta); /* < 1: eta is finite */
    float f = fresnel_dielectric(c, b->eta), shape = (f - exact0) / (1.0f - exact0);
    shape = shape > 0.0f ? shape : 0.0f;
    vec3 scaled = v3_madd(b->f0, shape, v3_sub(v3_splat(b->f90), b->f0));
    return v3_select(f >= 1.0f, v3_splat(1.0f), scaled);
}

/* The film at a cosine on wo's side. A stack of clear films reflects as much from either side: seen from within a solid,
 * it is asked at the cosine outside. */
KERNEL thin_film bsdf_film_at(const bsdf *b, float c) {
    float eta = b->film.outside_eta, out2 = 1.0f - (1.0f - c * c) / (eta > 0.0f ? eta * eta : 1.0f);
    float outside = sqrtf(out2 > 0.0f ? out2 : 0.0f);
    return thin_film_make(eta > 0.0f ? outside : c, b->film.ior, b->film.thickness);
}

/* Of a transmissive interface, its film included. */
KERNEL vec3 bsdf_interface_fresnel(unsigned mask, const bsdf *b, float c) {
    vec3 exact = bsdf_exact_fresnel(b, c);
    if (!(mask & BSDF_FILM)) return exact;
    thin_film f = bsdf_film_at(b, c);
    int total = exact.x >= 1.0f;
    return v3_select(total, exact, v3_lerp(exact, thin_film_reflectance(&f, b->f0), b->film.share));
}

/* The film instead of f, the Fresnel term of metal and coat, by its share. */
KERNEL vec3 bsdf_filmed(const bsdf *b, float c, vec3 f) {
    thin_film t = bsdf_film_at(b, c);
    vec3 on_metal = v3_scale(thin_film_reflectance(&t, b->film.metal_f0), b->film.metal);
    return v3_lerp(f, v3_madd(on_metal, b->film.dielectric, thin_film_reflectance(&t, b->f0)), b->film.share);
}

/* What a microfacet does to light that meets it at a cosine on wo's side: REFLECTION's and TRANSMISSION's F, and the
 * probability with which sample lets it pass. */
typedef struct bsdf_facet {
    vec3 reflects, passes;
    float p_passes;
} bsdf_facet;

KERNEL bsdf_facet bsdf_facet_at(unsigned mask, const bsdf *b, float c) {
    vec3 f = v3_madd(b->reflect0, fresnel_schlick_weight(c), b->reflect1);
    if (mask & BSDF_FILM) f = bsdf_filmed(b, c, f);
    if (!(mask & BSDF_TRANSMISSIVE)) return (bsdf_facet){f, v3_splat(0.0f), 0.0f};
    vec3 interface = bsdf_interface_fresnel(mask, b, c), passes = v3_mul(b->tint, complement(interface));
    vec3 reflects = v3_madd(f, b->interface, interface);
    float through = average(passes);
    return (bsdf_facet){reflects, passes, through / fm_max(through + average(reflects), 1e-30f)};
}

/* Tables are read unconditionally and blended by flags of 0 and 1: a load under a condition would not vectorise. */
KERNEL float bsdf_full(float mu, float alpha, albedo_node roughness) {
    return fm_lerp(albedo_full(mu, alpha, roughness), 1.0f, bsdf_is_mirror(alpha) ? 1.0f : 0.0f);
}
/* The cosine at which Schlick's weight is its mean over what is reflected, seen from mu: about there other Fresnel terms
 * are taken for their mean. */
KERNEL float bsdf_mean_cosine(float mu, float alpha, albedo_node roughness) {
    return fm_lerp(albedo_schlick_cosine(mu, alpha, roughness), mu, bsdf_is_mirror(alpha) ? 1.0f : 0.0f);
}

/* What tables say of a direction: the cosine that they were asked for, what the microfacets of a white metal send on in
 * one event and what they do not, and the mean cosine; interface: what anisotropy leaves of an interface's loss. */
typedef struct bsdf_seen { float mu, full, lost, cosine, interface; } bsdf_seen;

/* w.z ≥ 0 */
KERNEL bsdf_seen bsdf_see(unsigned mask, const bsdf *b, vec3 w) {
    if (!(mask & BSDF_ANISOTROPIC)) {
        float full = bsdf_full(w.z, b->alpha, b->roughness);
        return (bsdf_seen){w.z, full, 1.0f - full, bsdf_mean_cosine(w.z, b->alpha, b->roughness), 1.0f};
    }
    int brushed = b->alphas.x > b->alphas.y; /* else as above, to the last bit */
    anisotropy_direction d = anisotropy_stretch(w, b->brushed.stretch);
    anisotropy_factors factors = anisotropy_look_up(anisotropy_table, &b->brushed, d, b->alphas.x);
    float mu = brushed ? d.mu : w.z, faces = brushed ? factors.cosine * d.length : 1.0f;
    float full = bsdf_full(mu, b->alpha, b->roughness), lost = (1.0f - full) * (brushed ? factors.loss : 1.0f);
    float cosine = faces * bsdf_mean_cosine(mu, b->alpha, b->roughness);
    return (bsdf_seen){mu, brushed ? 1.0f - lost : full, lost, cosine, fm_min(faces, 1.0f)};
}

/* What the dielectric's coat reflects in all. */
KERNEL vec3 bsdf_coat_albedo(unsigned mask, const bsdf *b, const bsdf_seen *seen) {
    vec3 f = v3_madd(b->f0, fresnel_schlick_weight(seen->cosine), v3_sub(v3_splat(b->f90), b->f0));
    if (mask & BSDF_FILM) {
        thin_film t = bsdf_film_at(b, seen->cosine);
        f = v3_lerp(f, thin_film_reflectance(&t, b->f0), b->film.share);
    }
    return v3_scale(f, seen->full);
}

#endif
