/* render/bsdf/bsdf.h: the BSDF of a surface: four lobes, composed by layer.
 *
 *   DIFFUSE       cosine, wo's side: the base under its coat, and what microfacets reflect more than once
 *   BELOW         cosine, far side: what an interface's microfacets pass on after more than one event
 *   REFLECTION    GGX, or a mirror under GGX_ALPHA_MIN: metal and dielectric together, for they share their roughness
 *   TRANSMISSION  GGX, or a delta: refraction at a solid, straight on through a thin wall
 *
 *     f = m metal + (1 − m) ((1 − t) (coat + base) + t interface)
 *
 * Metal and coat use Schlick's Fresnel term as glTF 2.0, appendix B does; the interface of a transmissive dielectric the
 * exact one. Directions are in the local frame, z the shading normal on wo's side, and point away from the surface.
 * evaluate and pdf answer 0 for delta lobes: only sample knows their direction. `mask` says which terms can occur and
 * is a constant at every call, so what it excludes costs nothing.
 *
 * Multiple scattering: Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks": (1 − E(wo))(1 − E(wi))
 * over π (1 − mean E), reciprocal; the same form couples the base to its coat (Kelemen and Szirmay-Kalos 2001). */
#ifndef KILN_RENDER_BSDF_BSDF_H
#define KILN_RENDER_BSDF_BSDF_H

#include "render/bsdf/albedo.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/lobes/diffuse.h"
#include "render/bsdf/lobes/ggx.h"

enum {
    BSDF_GLOSSY = 1 << 0,       /* REFLECTION may occur */
    BSDF_TRANSMISSIVE = 1 << 1, /* TRANSMISSION and BELOW too; implies GLOSSY */
};

/* A mean loss is a divisor, and its inverse the largest weight of a sample of what is given back: nearly smooth surfaces,
 * whose loss is all at grazing angles, get less back than they lose. */
#define BSDF_LEAST_LOSS 1e-4f

/* What the material says at a point. */
typedef struct surface {
    vec3 base;
    float metallic, roughness;
    float specular; /* the coat's F90 */
    vec3 specular_color;
    float f0;             /* ((n − 1)/(n + 1))² */
    float transmission;
    vec3 through;         /* what the interface lets through is tinted by it: base, or that of one wavelength */
    float eta;            /* n of the far side over n of wo's side; thin wall: of the wall over the air */
    float thin;           /* 1: an infinitely thin wall, 0: the boundary of a solid */
} surface;

/* Everything about a point and its wo that sampling and evaluation share. */
typedef struct bsdf {
    vec3 wo;
    float alpha, roughness;
    vec3 diffuse;                   /* base · what its coat lets in at wo / the mean of that */
    vec3 metal_again;               /* multiple scattering of the metal, but for its factor at wi */
    vec3 f0;                        /* the dielectric's, at normal incidence */
    float f90;
    vec3 reflect0, reflect1;        /* REFLECTION's F: reflect0 + reflect1 (1 − c)^5 + interface · exact */
    float interface;                /* (1 − m) t */
    vec3 tint;                      /* interface · through: TRANSMISSION's F is tint (1 − exact) */
    float eta, thin;
    float again_near, again_far;    /* multiple scattering of the interface, but for its factors at wi */
    albedo_node near_ior, far_ior;  /* of albedo_interface, seen from wo's side and from the far side */
    vec3 wide;                      /* albedo of DIFFUSE and BELOW together */
    float p_diffuse, p_below, p_reflect, p_transmit; /* selection probabilities; sum 1, or all 0: black */
} bsdf;

KERNEL int bsdf_is_mirror(float alpha) { return alpha < GGX_ALPHA_MIN; }
/* Refraction spreads less than reflection, and its half vector resolves less: by |η − 1| over the larger index. The same
 * from either side. */
KERNEL int bsdf_is_straight(const bsdf *b) {
    float spread = fabsf(b->eta - 1.0f) / fm_max(b->eta, 1.0f);
    return b->alpha * (b->thin > 0.5f ? 1.0f : spread) < GGX_ALPHA_MIN;
}

KERNEL float average(vec3 v) { return (v.x + v.y + v.z) * (1.0f / 3.0f); }

/* The interface's exact Fresnel term, stretched between the material's F0 and F90; 1 under total reflection. */
KERNEL vec3 bsdf_interface_fresnel(const bsdf *b, float c) {
    float root = (b->eta - 1.0f) / (b->eta + 1.0f), exact0 = root * root; /* < 1: eta is finite */
    float f = fresnel_dielectric(c, b->eta), shape = (f - exact0) / (1.0f - exact0);
    shape = shape > 0.0f ? shape : 0.0f;
    vec3 scaled = v3_madd(b->f0, shape, v3_sub(v3_splat(b->f90), b->f0));
    return v3_select(f >= 1.0f, v3_splat(1.0f), scaled);
}

KERNEL vec3 bsdf_reflection_fresnel(unsigned mask, const bsdf *b, float c) {
    vec3 f = v3_madd(b->reflect0, fresnel_schlick_weight(c), b->reflect1);
    if (mask & BSDF_TRANSMISSIVE) f = v3_madd(f, b->interface, bsdf_interface_fresnel(b, c));
    return f;
}

/* Tables are read unconditionally and blended by flags of 0 and 1: a load under a condition would not vectorise. */
KERNEL float bsdf_full(float mu, float alpha, albedo_node roughness) {
    return fm_lerp(albedo_full(mu, alpha, roughness), 1.0f, bsdf_is_mirror(alpha) ? 1.0f : 0.0f);
}
/* The mean of Schlick's (1 − cos)^5 over what is reflected, seen from mu. */
KERNEL float bsdf_schlick_share(const bsdf *b, float mu, albedo_node roughness) {
    return fm_lerp(albedo_schlick_share(mu, b->alpha, roughness), fresnel_schlick_weight(mu), bsdf_is_mirror(b->alpha) ? 1.0f : 0.0f);
}
/* What the coat reflects in all, seen from mu: full is bsdf_full there. */
KERNEL vec3 bsdf_coat_albedo(const bsdf *b, float mu, float full, albedo_node roughness) {
    float share = bsdf_schlick_share(b, mu, roughness);
    return v3_scale(v3_madd(b->f0, share, v3_sub(v3_splat(b->f90), b->f0)), full);
}

/* What an interface loses to multiple scattering, seen from mu; thin walls lose what a mirror would, and what goes
 * straight on loses nothing. */
KERNEL float bsdf_interface_loss(const bsdf *b, albedo_node ior, float mu, float full,
                                 albedo_node roughness) {
    float e = fm_lerp(albedo_interface(ior, mu, b->alpha, roughness), full, b->thin);
    return (1.0f - e) * (bsdf_is_straight(b) ? 0.0f : 1.0f);
}
KERNEL float bsdf_interface_mean_loss(const bsdf *b, albedo_node ior, float full_mean,
                                      albedo_node roughness) {
    float e = fm_lerp(albedo_interface_mean(ior, roughness), full_mean, b->thin);
    return fm_max(1.0f - e, BSDF_LEAST_LOSS);
}

/* The coat over the base. */
KERNEL vec3 bsdf_make_base(bsdf *b, const surface *s, float opaque, float full, float full_mean, albedo_node roughness) {
    vec3 coat = bsdf_coat_albedo(b, b->wo.z, full, roughness);
    vec3 mean = v3_madd(v3_scale(b->f0, full_mean), albedo_schlick_mean(roughness), v3_sub(v3_splat(b->f90), b->f0));
    vec3 enters = v3_mul(v3_scale(s->base, opaque), v3_sub(v3_splat(1.0f), coat));
    b->diffuse = v3(enters.x / fm_max(1.0f - mean.x, BSDF_LEAST_LOSS), enters.y / fm_max(1.0f - mean.y, BSDF_LEAST_LOSS),
                    enters.z / fm_max(1.0f - mean.z, BSDF_LEAST_LOSS));
    return enters;
}

/* F_ms = F² E/(1 − F (1 − E)) of the mean Fresnel term F = (20 F0 + 1)/21 and the mean albedo E. */
KERNEL vec3 bsdf_make_metal(bsdf *b, const surface *s, float full, float full_mean) {
    vec3 f = v3_madd(v3_splat(1.0f / 21.0f), 20.0f / 21.0f, s->base), lost = v3_scale(f, 1.0f - full_mean);
    vec3 again = v3(f.x * f.x * full_mean / (1.0f - lost.x), f.y * f.y * full_mean / (1.0f - lost.y),
                    f.z * f.z * full_mean / (1.0f - lost.z));
    again = v3_scale(again, s->metallic * (1.0f - full));
    b->metal_again = v3_scale(again, 1.0f / fm_max(1.0f - full_mean, BSDF_LEAST_LOSS));
    return again;
}

/* What the interface loses is shared out so that as much crosses from either side: (1 − κ_a) n_a² M_a is symmetric. */
KERNEL void bsdf_make_interface(bsdf *b, float full, float full_mean,
                                albedo_node roughness, float *reflected, float *passed) {
    float loss = bsdf_interface_loss(b, b->near_ior, b->wo.z, full, roughness);
    float near_mean = bsdf_interface_mean_loss(b, b->near_ior, full_mean, roughness);
    float far_mean = bsdf_interface_mean_loss(b, b->far_ior, full_mean, roughness);
    float eta2 = b->thin > 0.5f ? 1.0f : b->eta * b->eta;
    float pass = eta2 * far_mean / (near_mean + eta2 * far_mean);
    *reflected = (1.0f - pass) * loss;
    *passed = pass * loss;
    b->again_near = *reflected * b->interface / near_mean;
    b->again_far = *passed / (far_mean * eta2);
}

/* Selection weight of TRANSMISSION. Microfacets that face wo more than the surface does let light through where the
 * surface itself would reflect totally: what can be evaluated must keep a chance of being sampled. */
KERNEL float bsdf_transmission_weight(const bsdf *b) {
    vec3 flat = v3_sub(v3_splat(1.0f), bsdf_interface_fresnel(b, b->wo.z));
    vec3 rough = v3_sub(v3_splat(1.0f), bsdf_interface_fresnel(b, b->wo.z + b->alpha * (1.0f - b->wo.z)));
    float least = 0.02f * average(b->tint);
    return bsdf_is_straight(b) ? average(v3_mul(b->tint, flat)) : fm_max(average(v3_mul(b->tint, rough)), least);
}

KERNEL bsdf bsdf_make(unsigned mask, const surface *s, vec3 wo) {
    bsdf b = {.wo = wo, .diffuse = s->base, .wide = s->base, .p_diffuse = average(s->base) > 0.0f ? 1.0f : 0.0f};
    if (!(mask & BSDF_GLOSSY)) return b;
    float dielectric = 1.0f - s->metallic, t = mask & BSDF_TRANSMISSIVE ? s->transmission : 0.0f;
    b.roughness = s->roughness;
    b.alpha = s->roughness * s->roughness;
    b.f90 = s->specular;
    b.f0 = v3(fm_min(s->f0 * s->specular_color.x, 1.0f) * s->specular,
              fm_min(s->f0 * s->specular_color.y, 1.0f) * s->specular,
              fm_min(s->f0 * s->specular_color.z, 1.0f) * s->specular);
    albedo_node roughness = albedo_roughness_node(b.roughness);
    float full = bsdf_full(wo.z, b.alpha, roughness), full_mean = albedo_full_mean(roughness);
    float opaque = dielectric * (1.0f - t);
    vec3 base = bsdf_make_base(&b, s, opaque, full, full_mean, roughness);
    vec3 metal = bsdf_make_metal(&b, s, full, full_mean);
    b.reflect0 = v3_madd(v3_scale(b.f0, opaque), s->metallic, s->base);
    b.reflect1 = v3_madd(v3_scale(v3_sub(v3_splat(b.f90), b.f0), opaque), s->metallic,
                         v3_sub(v3_splat(1.0f), s->base));
    b.wide = v3_add(base, metal);
    float w_diffuse = average(b.wide), w_below = 0.0f, w_transmit = 0.0f;
    if (mask & BSDF_TRANSMISSIVE) {
        float reflected, passed;
        b.interface = dielectric * t;
        b.tint = v3_scale(s->through, b.interface);
        b.eta = s->eta;
        b.thin = s->thin;
        b.near_ior = albedo_ior_node(s->eta);
        b.far_ior = albedo_ior_node(1.0f / s->eta); /* η ≥ 1/1000 */
        bsdf_make_interface(&b, full, full_mean, roughness, &reflected, &passed);
        w_diffuse += b.interface * reflected;
        w_below = average(b.tint) * passed;
        w_transmit = bsdf_transmission_weight(&b);
        b.wide = v3_madd(v3_add(b.wide, v3_splat(b.interface * reflected)), passed, b.tint);
    }
    float w_reflect = average(bsdf_reflection_fresnel(mask, &b, wo.z * (1.0f - 0.5f * b.alpha)));
    float sum = w_diffuse + w_below + w_reflect + w_transmit, scale = sum > 0.0f ? 1.0f / sum : 0.0f;
    b.p_diffuse = w_diffuse * scale;
    b.p_below = w_below * scale;
    b.p_reflect = w_reflect * scale;
    b.p_transmit = w_transmit * scale;
    return b;
}

/* Directional albedo at wo: what a denoiser wants to know. The interface's Fresnel term is taken about where visible
 * microfacets face wo. */
KERNEL vec3 bsdf_albedo(unsigned mask, const bsdf *b) {
    if (!(mask & BSDF_GLOSSY)) return b->wide;
    albedo_node roughness = albedo_roughness_node(b->roughness);
    float full = bsdf_full(b->wo.z, b->alpha, roughness), share = bsdf_schlick_share(b, b->wo.z, roughness);
    vec3 sum = v3_madd(b->wide, full, v3_madd(b->reflect0, share, b->reflect1));
    if (!(mask & BSDF_TRANSMISSIVE)) return sum;
    float kept = 1.0f - bsdf_interface_loss(b, b->near_ior, b->wo.z, full, roughness);
    vec3 f = bsdf_interface_fresnel(b, b->wo.z + b->alpha * (1.0f - b->wo.z)), passes = v3_mul(b->tint, v3_sub(v3_splat(1.0f), f));
    return v3_madd(sum, kept, v3_madd(passes, b->interface, f));
}

/* f(wo, wi) |cos θi| of everything that is not a delta, and the density with which sample chooses wi. */
typedef struct bsdf_value { vec3 value; float pdf; } bsdf_value;

KERNEL bsdf_value bsdf_evaluate_above(unsigned mask, const bsdf *b, vec3 wi) {
    float cosine = diffuse_pdf(wi, 1.0f);
    if (!(mask & BSDF_GLOSSY)) return (bsdf_value){v3_scale(b->diffuse, cosine), b->p_diffuse * cosine};
    float mu = fm_max(wi.z, 0.0f);
    albedo_node roughness = albedo_roughness_node(b->roughness);
    float full = bsdf_full(mu, b->alpha, roughness);
    vec3 enters = v3_sub(v3_splat(1.0f), bsdf_coat_albedo(b, mu, full, roughness));
    vec3 wide = v3_madd(v3_mul(b->diffuse, enters), 1.0f - full, b->metal_again);
    if (mask & BSDF_TRANSMISSIVE) {
        float loss = bsdf_interface_loss(b, b->near_ior, mu, full, roughness);
        wide = v3_add(wide, v3_splat(b->again_near * loss));
    }
    vec3 h = v3_normalize(v3_add(b->wo, v3(wi.x, wi.y, mu))); /* wo.z > 0: not zero */
    int live = (wi.z > 0.0f) & !bsdf_is_mirror(b->alpha);
    float alpha = fm_max(b->alpha, GGX_ALPHA_MIN);
    float value = live ? ggx_reflection_value(b->wo, v3(wi.x, wi.y, mu), h, alpha) : 0.0f;
    float pdf = live ? ggx_reflection_pdf(b->wo, h, alpha) : 0.0f;
    vec3 f = bsdf_reflection_fresnel(mask, b, v3_dot(b->wo, h));
    return (bsdf_value){v3_madd(v3_scale(wide, cosine), value, f), b->p_diffuse * cosine + b->p_reflect * pdf};
}

KERNEL bsdf_value bsdf_evaluate_below(const bsdf *b, vec3 wi) {
    float cosine = diffuse_pdf(wi, -1.0f), mu = fm_max(-wi.z, 0.0f);
    albedo_node roughness = albedo_roughness_node(b->roughness);
    float full = bsdf_full(mu, b->alpha, roughness);
    float again = b->again_far * bsdf_interface_loss(b, b->far_ior, mu, full, roughness);
    float alpha = fm_max(b->alpha, GGX_ALPHA_MIN);
    int live = (wi.z < 0.0f) & !bsdf_is_straight(b), thin = b->thin > 0.5f;
    /* A thin wall passes light on as it would have reflected it, mirrored at the wall (KHR_materials_transmission). */
    vec3 mirrored = v3(wi.x, wi.y, mu), hr = v3_normalize(v3_add(b->wo, mirrored));
    vec3 ht = ggx_refraction_normal(b->wo, wi, b->eta), h = v3_select(thin, hr, ht);
    float pdf_solid = ggx_refraction_pdf(b->wo, wi, ht, alpha, b->eta);
    float value_solid = pdf_solid * ggx_refraction_multiplier(wi, alpha, b->eta);
    float pdf = thin ? ggx_reflection_pdf(b->wo, hr, alpha) : pdf_solid;
    float value = thin ? ggx_reflection_value(b->wo, mirrored, hr, alpha) : value_solid;
    vec3 f = v3_sub(v3_splat(1.0f), bsdf_interface_fresnel(b, fm_max(v3_dot(b->wo, h), 0.0f)));
    vec3 sum = v3_scale(v3_madd(v3_splat(again * cosine), live ? value : 0.0f, f), 1.0f);
    return (bsdf_value){v3_mul(b->tint, sum), b->p_below * cosine + (live ? b->p_transmit * pdf : 0.0f)};
}

KERNEL bsdf_value bsdf_evaluate(unsigned mask, const bsdf *b, vec3 wi) {
    bsdf_value above = bsdf_evaluate_above(mask, b, wi);
    if (!(mask & BSDF_TRANSMISSIVE)) return above;
    bsdf_value below = bsdf_evaluate_below(b, wi);
    int up = wi.z > 0.0f;
    return (bsdf_value){v3_select(up, above.value, below.value), up ? above.pdf : below.pdf};
}

typedef struct bsdf_sampled {
    vec3 wi;
    vec3 multiplier; /* f |cos θi| / pdf over all lobes; 0: absorbed. In closed form for Lambert alone (the albedo) and
                        for deltas; a mixture divides two sums, in which each lobe's D and cosine occur alike */
    float pdf;       /* of wi over all lobes; 0 for a delta */
    int delta;
} bsdf_sampled;

/* u.lobe chooses the lobe, u.direction its direction. */
KERNEL bsdf_sampled bsdf_sample(unsigned mask, const bsdf *b, float lobe, vec2 direction) {
    vec3 wi = diffuse_sample(direction, 1.0f);
    if (!(mask & BSDF_GLOSSY))
        return (bsdf_sampled){wi, v3_scale(b->diffuse, b->p_diffuse), b->p_diffuse * diffuse_pdf(wi, 1.0f), 0};

    int mirror = bsdf_is_mirror(b->alpha), straight = 0;
    int below = 0, transmit = 0, reflect = lobe >= b->p_diffuse, refracts = 1;
    vec3 h = ggx_sample_normal(b->wo, fm_max(b->alpha, GGX_ALPHA_MIN), direction);
    vec3 hr = v3_select(mirror, v3(0, 0, 1), h);
    vec3 mirrored = v3_sub(v3_scale(hr, 2.0f * v3_dot(b->wo, hr)), b->wo);
    if (mask & BSDF_TRANSMISSIVE) {
        straight = bsdf_is_straight(b);
        float a = b->p_diffuse + b->p_below, r = a + b->p_reflect;
        below = reflect & (lobe < a);
        transmit = (lobe >= r) & (b->p_transmit > 0.0f);
        reflect = reflect & !below & !transmit;
        wi.z = below ? -wi.z : wi.z;
        vec3 ht = v3_select(straight, v3(0, 0, 1), h);
        float c = v3_dot(b->wo, ht);
        refracts = !transmit | (b->thin > 0.5f) | (1.0f - c * c < b->eta * b->eta);
        vec3 bent = ggx_refract(b->wo, ht, c, b->eta);
        vec3 unbent = straight ? v3_neg(b->wo) : v3(mirrored.x, mirrored.y, -mirrored.z);
        wi = v3_select(transmit, v3_select(b->thin > 0.5f, unbent, bent), wi);
    }
    wi = v3_select(reflect, mirrored, wi);

    /* In numbers: gcc makes of the flags a choice between truth values, which does not vectorise. */
    float reflect_spread = reflect ? b->alpha : 1.0f, transmit_spread = transmit & straight ? 0.0f : 1.0f;
    int delta = reflect_spread * transmit_spread < GGX_ALPHA_MIN;
    /* A microfacet may send light to the wrong side of the surface, or refuse to refract: absorbed; the energy comes
     * back as multiple scattering. */
    int lives = ((transmit | below) ? wi.z < 0.0f : wi.z > 0.0f) & refracts;
    bsdf_value v = bsdf_evaluate(mask, b, wi);
    float scale = lives & (v.pdf > 0.0f) ? 1.0f / v.pdf : 0.0f;
    vec3 multiplier = v3_scale(v.value, scale);
    vec3 at_delta = v3_scale(bsdf_reflection_fresnel(mask, b, b->wo.z), 1.0f / fm_max(b->p_reflect, 1e-30f));
    if (mask & BSDF_TRANSMISSIVE) {
        vec3 passes = v3_mul(b->tint, v3_sub(v3_splat(1.0f), bsdf_interface_fresnel(b, b->wo.z)));
        float squeeze = b->thin > 0.5f ? 1.0f : b->eta * b->eta; /* radiance narrows by 1/η² */
        at_delta = v3_select(transmit, v3_scale(passes, 1.0f / fm_max(b->p_transmit * squeeze, 1e-30f)), at_delta);
    }
    return (bsdf_sampled){wi, v3_select(delta, at_delta, multiplier), delta ? 0.0f : v.pdf, delta};
}

#endif
