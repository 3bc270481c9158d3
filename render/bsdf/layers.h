/* render/bsdf/layers.h: what lies on a surface: a clear coat, and sheen below it.
 *
 * A layer reflects what its directional albedo E says and lets 1 − E through on the way in and on the way out. What a
 * layer covers is scaled by the smaller of the two, for light that is sent on in one event (KHR_materials_sheen,
 * 'Albedo-Scaling Technique'): reciprocal, never more than came. What is spread over a hemisphere
 * takes both as a product over its mean, which gives back what the layer sends down again (Kelemen and
 * Szirmay-Kalos 2001). */
#ifndef KILN_RENDER_BSDF_LAYERS_H
#define KILN_RENDER_BSDF_LAYERS_H

#include "render/bsdf/lobes/sheen.h"
#include "render/bsdf/reflectance.h"

/* What a coat of share 1 reflects in all, seen from a cosine to its normal. */
KERNEL float clearcoat_albedo(const bsdf_clearcoat *l, float mu) {
    return bsdf_full(mu, l->alpha, l->roughness) * clearcoat_fresnel(bsdf_mean_cosine(mu, l->alpha, l->roughness));
}

/* What goes through clear coat and sheen together, along a direction on wo's side or, mirrored, on the far one. */
typedef struct layers_pass { float clearcoat, sheen; } layers_pass;

KERNEL layers_pass layers_through(unsigned mask, const bsdf *b, float clearcoat_mu, float mu, int far) {
    layers_pass p = {1.0f, 1.0f};
    float coat = far ? b->clearcoat.far : b->clearcoat.near, sheen = far ? b->sheen.far : b->sheen.near;
    if (mask & BSDF_CLEARCOAT) p.clearcoat = 1.0f - coat * clearcoat_albedo(&b->clearcoat, clearcoat_mu);
    if (mask & BSDF_SHEEN) p.sheen = 1.0f - sheen * albedo_sheen(mu, b->sheen.node);
    return p;
}
KERNEL layers_pass layers_toward(unsigned mask, const bsdf *b, vec3 wi, int far) {
    float clearcoat_mu = fm_clamp(fabsf(v3_dot(wi, b->clearcoat.frame.z)), 0.0f, 1.0f);
    return layers_through(mask, b, clearcoat_mu, fm_min(fabsf(wi.z), 1.0f), far);
}

/* Above 0 where something lies on the surface, on either side. */
KERNEL float layers_lie(const bsdf *b) {
    return b->clearcoat.near + b->clearcoat.far + b->sheen.near + b->sheen.far + b->film.share;
}

/* On light of one event, in along wi and out along wo. */
KERNEL float layers_under(const bsdf *b, layers_pass in) {
    return fm_min(in.clearcoat, b->clearcoat.through) * fm_min(in.sheen, b->sheen.through);
}

KERNEL float clearcoat_pdf(const bsdf_clearcoat *l, vec3 h) {
    float alpha = fm_max(l->alpha, GGX_ALPHA_MIN);
    return ggx_reflection_pdf(l->wo, h, (vec2){alpha, alpha});
}

/* f cos and density of the layers themselves, towards wi above the surface. */
typedef struct layers_value { vec3 value; float pdf; } layers_value;

KERNEL layers_value clearcoat_evaluate(const bsdf_clearcoat *l, float p, vec3 wi) {
    vec3 w = frame_to_local(&l->frame, wi);
    int live = (w.z > 0.0f) & !bsdf_is_mirror(l->alpha);
    w.z = fm_max(w.z, 0.0f);
    vec3 h = v3_normalize(v3_add(l->wo, w));
    float alpha = fm_max(l->alpha, GGX_ALPHA_MIN), c = v3_dot(l->wo, h);
    float gloss = l->gloss * clearcoat_fresnel(c) * ggx_reflection_value(l->wo, w, h, (vec2){alpha, alpha});
    return (layers_value){v3_splat(live ? gloss : 0.0f), live ? p * clearcoat_pdf(l, h) : 0.0f};
}

KERNEL layers_value layers_evaluate(unsigned mask, const bsdf *b, vec3 wi, layers_pass in) {
    layers_value v = {v3_splat(0.0f), 0.0f};
    if (mask & BSDF_CLEARCOAT) v = clearcoat_evaluate(&b->clearcoat, b->p_clearcoat, wi);
    if (!(mask & BSDF_SHEEN)) return v;
    float under = fm_min(in.clearcoat, b->clearcoat.through) * sheen_value(b->wo, wi, b->sheen.roughness);
    return (layers_value){v3_madd(v.value, under, b->sheen.color), v.pdf + b->p_sheen * sheen_pdf(wi, b->sheen.roughness)};
}

KERNEL void clearcoat_make(bsdf *b, const surface *s) {
    bsdf_clearcoat *l = &b->clearcoat;
    l->near = s->clearcoat * s->near;
    l->far = s->clearcoat * s->far;
    l->gloss = l->near;
    l->alpha = s->clearcoat_roughness * s->clearcoat_roughness;
    l->roughness = albedo_roughness_node(s->clearcoat_roughness);
    l->frame = frame_make(s->clearcoat_normal);
    l->wo = frame_to_local(&l->frame, b->wo);
    l->wo.z = fm_max(l->wo.z, 1e-4f); /* its normal faces wo: rounding */
}

KERNEL void sheen_make(bsdf *b, const surface *s) {
    bsdf_sheen *sheen = &b->sheen;
    float most = v3_max(s->sheen);
    sheen->color = v3_scale(s->sheen, s->near);
    sheen->near = most * s->near;
    sheen->far = most * s->far;
    sheen->roughness = sheen_roughness(s->sheen_roughness);
    sheen->node = albedo_sheen_node(sheen->roughness);
}

KERNEL void film_make(bsdf *b, const surface *s) {
    bsdf_film *film = &b->film;
    film->share = thin_film_share(s->film, s->film_thickness);
    film->ior = s->film_ior;
    film->thickness = s->film_thickness;
    film->outside_eta = s->near > 0.5f ? 0.0f : s->eta;
    film->metal_f0 = s->base;
    film->metal = s->metallic;
    film->dielectric = (1.0f - s->metallic) * (1.0f - s->transmission);
}

KERNEL void layers_make(unsigned mask, bsdf *b, const surface *s) {
    if (mask & BSDF_CLEARCOAT) clearcoat_make(b, s);
    if (mask & BSDF_SHEEN) sheen_make(b, s);
    if (mask & BSDF_FILM) film_make(b, s);
    layers_pass out = layers_through(mask, b, fm_min(b->clearcoat.wo.z, 1.0f), fm_min(b->wo.z, 1.0f), 0);
    b->clearcoat.through = out.clearcoat;
    b->sheen.through = out.sheen;
}

/* Cosine-weighted means over a hemisphere, by Gauss and Jacobi's rule of four points, exact to the seventh degree: of
 * what reaches a base through coat and layers, on wo's side and on the far one, and of what layers let through of a
 * metal's multiple scattering. */
typedef struct layers_means { vec3 near, far; float again; } layers_means;

KERNEL layers_means layers_means_select(int c, layers_means a, layers_means b) {
    return (layers_means){v3_select(c, a.near, b.near), v3_select(c, a.far, b.far), c ? a.again : b.again};
}

KERNEL void layers_add_mean(unsigned mask, const bsdf *b, float mu, float weight, layers_means *sum, float *again_weight) {
    float side = sqrtf(0.5f * (1.0f - mu * mu)); /* an azimuth of π/4 stands for all */
    bsdf_seen seen = bsdf_see(mask, b, v3(side, side, mu));
    vec3 enters = complement(bsdf_coat_albedo(mask, b, &seen));
    layers_pass near = layers_through(mask, b, mu, mu, 0), far = layers_through(mask, b, mu, mu, 1);
    float through = near.clearcoat * near.sheen;
    sum->near = v3_madd(sum->near, weight * through, enters);
    sum->far = v3_madd(sum->far, weight * far.clearcoat * far.sheen, enters);
    float lost = weight * seen.lost + 1e-9f; /* a mirror loses nothing: then the mean is plain */
    sum->again += lost * through;
    *again_weight += lost;
}
KERNEL layers_means layers_mean(unsigned mask, const bsdf *b) {
    layers_means sum = {v3_splat(0.0f), v3_splat(0.0f), 0.0f};
    float lost = 0.0f;
    layers_add_mean(mask, b, 0.139759864f, 0.0623619419f, &sum, &lost);
    layers_add_mean(mask, b, 0.416409568f, 0.259695095f, &sum, &lost);
    layers_add_mean(mask, b, 0.723156986f, 0.406929136f, &sum, &lost);
    layers_add_mean(mask, b, 0.942895804f, 0.271013827f, &sum, &lost);
    sum.again /= lost;
    return sum;
}

#endif
