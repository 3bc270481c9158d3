/* render/bsdf/bsdf.h: the BSDF of a surface: six lobes, composed by layer.
 *
 *   DIFFUSE       cosine, wo's side: the base under its coat, and what microfacets reflect more than once
 *   BELOW         cosine, far side: diffuse transmission, and what an interface passes on after more than one event
 *   REFLECTION    GGX, or a mirror under GGX_ALPHA_MIN: metal and dielectric together, for they share their roughness
 *   TRANSMISSION  GGX, or a delta: refraction at a solid, straight on through a thin wall
 *   CLEARCOAT     GGX, or a mirror, around a normal of its own
 *   SHEEN         Charlie
 *
 *     f = clearcoat + [ sheen + [ m metal + (1 − m) ((1 − t) (coat + base) + t interface) ] ]
 *
 * where [] is what layers let through (layers.h). Metal and coat use Schlick's Fresnel term as glTF 2.0, appendix B does;
 * the interface of a transmissive dielectric the exact one; a thin film replaces them. evaluate and pdf answer 0 for
 * delta lobes: only sample knows their direction. `mask` says which terms can occur and is a constant at every call. */
#ifndef KILN_RENDER_BSDF_BSDF_H
#define KILN_RENDER_BSDF_BSDF_H

#include "render/bsdf/compensation.h"
#include "render/bsdf/lobes/diffuse.h"

/* Selection weight of TRANSMISSION. Microfacets that face wo more than the surface does let light through where the
 * surface itself would reflect totally: what can be evaluated must keep a chance of being sampled. */
KERNEL float bsdf_transmission_weight(unsigned mask, const bsdf *b) {
    vec3 flat = complement(bsdf_interface_fresnel(mask, b, b->wo.z));
    vec3 rough = complement(bsdf_interface_fresnel(mask, b, b->wo.z + b->alphas.x * (1.0f - b->wo.z)));
    float least = 0.02f * average(b->tint);
    return bsdf_is_straight(b) ? average(v3_mul(b->tint, flat)) : fm_max(average(v3_mul(b->tint, rough)), least);
}

/* Anisotropy after KHR_materials_anisotropy: the alpha along x grows, the one along y is the material's. Tables know one
 * alpha: the root of the mean square. */
KERNEL void bsdf_make_roughness(unsigned mask, bsdf *b, const surface *s) {
    b->alpha = s->roughness * s->roughness;
    b->alphas = (vec2){b->alpha, b->alpha};
    b->roughness = albedo_roughness_node(s->roughness);
    if (!(mask & BSDF_LAYERED)) return;
    b->alphas.x = fm_lerp(b->alpha, 1.0f, s->anisotropy * s->anisotropy);
    b->isotropy = 1.0f - 0.4f * (1.0f - (b->alphas.y + 1e-20f) / (b->alphas.x + 1e-20f)); /* no white metal above 1 */
    b->alpha = sqrtf(0.5f * (b->alphas.x * b->alphas.x + b->alpha * b->alpha));
    b->roughness = albedo_roughness_node(sqrtf(b->alpha));
}

KERNEL void bsdf_make_fresnel(unsigned mask, bsdf *b, const surface *s, float opaque) {
    b->f90 = s->specular;
    b->f0 = v3(fm_min(s->f0 * s->specular_color.x, 1.0f) * s->specular,
               fm_min(s->f0 * s->specular_color.y, 1.0f) * s->specular,
               fm_min(s->f0 * s->specular_color.z, 1.0f) * s->specular);
    b->reflect0 = v3_madd(v3_scale(b->f0, opaque), s->metallic, s->base);
    b->reflect1 = v3_madd(v3_scale(v3_sub(v3_splat(b->f90), b->f0), opaque), s->metallic, complement(s->base));
    if (!(mask & BSDF_TRANSMISSIVE)) return;
    b->interface = (1.0f - s->metallic) * s->transmission;
    b->tint = v3_scale(s->through, b->interface);
    b->eta = s->eta;
    b->thin = s->thin;
    b->near_ior = albedo_ior_node(s->eta);
    b->far_ior = albedo_ior_node(1.0f / s->eta); /* η ≥ 1/1000 */
}

/* Selection weights, by what the lobes return; w_diffuse and w_below are known. */
KERNEL void bsdf_make_weights(unsigned mask, bsdf *b, float w_diffuse, float w_below) {
    float w_reflect = average(bsdf_reflection_fresnel(mask, b, b->wo.z * (1.0f - 0.5f * b->alpha)));
    float w_transmit = mask & BSDF_TRANSMISSIVE ? bsdf_transmission_weight(mask, b) : 0.0f, sum = 0.0f;
    if (mask & BSDF_LAYERED) {
        const bsdf_clearcoat *l = &b->clearcoat;
        float under = l->through * b->sheen.through, mu = l->wo.z * (1.0f - 0.5f * l->alpha);
        w_reflect *= under;
        w_transmit *= under;
        b->p_clearcoat = l->near * clearcoat_fresnel(mu);
        b->p_sheen = average(b->sheen.color) * l->through * albedo_sheen(b->wo.z, b->sheen.node);
        sum = b->p_clearcoat + b->p_sheen;
    }
    sum = sum + w_diffuse + w_below + w_reflect + w_transmit;
    float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
    b->p_diffuse = w_diffuse * scale;
    b->p_below = w_below * scale;
    b->p_reflect = w_reflect * scale;
    b->p_transmit = w_transmit * scale;
    b->p_clearcoat *= scale;
    b->p_sheen *= scale;
}

KERNEL bsdf bsdf_make(unsigned mask, const surface *s, vec3 wo) {
    bsdf b = {.wo = wo, .diffuse = s->base, .wide = s->base, .p_diffuse = average(s->base) > 0.0f ? 1.0f : 0.0f};
    if (!(mask & BSDF_GLOSSY)) return b;
    float opaque = (1.0f - s->metallic) * (1.0f - (mask & BSDF_TRANSMISSIVE ? s->transmission : 0.0f));
    bsdf_make_roughness(mask, &b, s);
    bsdf_make_fresnel(mask, &b, s, opaque);
    float through = 1.0f;
    layers_means means = {v3_splat(1.0f), v3_splat(1.0f), 1.0f};
    if (mask & BSDF_LAYERED) {
        layers_make(&b, s);
        through = b.clearcoat.through * b.sheen.through;
        means = layers_mean(&b);
    }
    float mu = bsdf_table_mu(mask, &b, wo), full = bsdf_full(mu, b.alpha, b.roughness);
    float full_mean = albedo_full_mean(b.roughness);
    bsdf_up_down base = bsdf_make_base(mask, &b, s, opaque, mu, full, full_mean, &means, through);
    vec3 metal = bsdf_make_metal(mask, &b, s, full, full_mean, &means, through), up = v3_add(base.up, metal);
    b.wide = v3_add(up, base.down);
    float w_diffuse = average(up), w_below = average(base.down);
    if (mask & BSDF_TRANSMISSIVE) {
        bsdf_up_down again = bsdf_make_interface(mask, &b, mu, full, full_mean);
        w_diffuse += through * average(again.up);
        w_below += through * average(again.down);
        b.wide = v3_madd(b.wide, through, v3_add(again.up, again.down));
    }
    bsdf_make_weights(mask, &b, w_diffuse, w_below);
    return b;
}

/* Directional albedo at wo: what a denoiser wants to know. The interface's Fresnel term is taken about where visible
 * microfacets face wo, and so is the film's. */
KERNEL vec3 bsdf_albedo(unsigned mask, const bsdf *b) {
    if (!(mask & BSDF_GLOSSY)) return b->wide;
    float mu = bsdf_table_mu(mask, b, b->wo), full = bsdf_full(mu, b->alpha, b->roughness);
    float share = bsdf_schlick_share(mu, b->alpha, b->roughness), facing = b->wo.z + b->alpha * (1.0f - b->wo.z);
    vec3 sum = v3_madd(b->reflect0, share, b->reflect1);
    if (mask & BSDF_LAYERED) sum = bsdf_filmed(b, bsdf_mean_cosine(share), sum);
    sum = v3_scale(sum, full);
    if (mask & BSDF_TRANSMISSIVE) {
        vec3 f = bsdf_interface_fresnel(mask, b, facing), passes = v3_mul(b->tint, complement(f));
        float kept = 1.0f - bsdf_interface_loss(b, b->near_ior, mu, full);
        sum = v3_madd(sum, kept, v3_madd(passes, b->interface, f));
    }
    if (mask & BSDF_LAYERED) {
        const bsdf_clearcoat *l = &b->clearcoat;
        vec3 sheen = v3_scale(b->sheen.color, albedo_sheen(b->wo.z, b->sheen.node));
        sum = v3_scale(v3_madd(sheen, b->sheen.through, sum), l->through);
        sum = v3_add(sum, v3_splat(1.0f - l->through));
    }
    return v3_add(b->wide, sum);
}

/* f(wo, wi) |cos θi| of everything that is not a delta, and the density with which sample chooses wi. */
typedef struct bsdf_value { vec3 value; float pdf; } bsdf_value;

KERNEL bsdf_value bsdf_evaluate_above(unsigned mask, const bsdf *b, vec3 wi) {
    float cosine = diffuse_pdf(wi, 1.0f);
    if (!(mask & BSDF_GLOSSY)) return (bsdf_value){v3_scale(b->diffuse, cosine), b->p_diffuse * cosine};
    vec3 up = {wi.x, wi.y, fm_max(wi.z, 0.0f)};
    float mu = bsdf_table_mu(mask, b, up), full = bsdf_full(mu, b->alpha, b->roughness);
    vec3 enters = complement(bsdf_coat_albedo(mask, b, mu, full));
    vec3 wide = v3_madd(v3_mul(b->diffuse, enters), 1.0f - full, b->metal_again);
    layers_value top = {v3_splat(0.0f), 0.0f};
    float under = 1.0f;
    if (mask & BSDF_LAYERED) {
        layers_pass in = layers_toward(b, up, 0);
        top = layers_evaluate(b, up, in);
        under = layers_under(b, in);
        wide = v3_scale(wide, in.clearcoat * in.sheen);
    }
    if (mask & BSDF_TRANSMISSIVE) {
        float loss = bsdf_interface_loss(b, b->near_ior, mu, full);
        wide = v3_add(wide, v3_splat(under * b->again_near * loss));
    }
    vec3 h = v3_normalize(v3_add(b->wo, up)); /* wo.z > 0: not zero */
    int live = (wi.z > 0.0f) & !bsdf_is_mirror(b->alphas.x);
    vec2 alphas = {fm_max(b->alphas.x, GGX_ALPHA_MIN), fm_max(b->alphas.y, GGX_ALPHA_MIN)};
    float value = live ? ggx_reflection_value(b->wo, up, h, alphas) : 0.0f;
    float pdf = live ? ggx_reflection_pdf(b->wo, h, alphas) : 0.0f;
    vec3 f = bsdf_reflection_fresnel(mask, b, v3_dot(b->wo, h));
    bsdf_value v = {v3_madd(v3_scale(wide, cosine), value * under, f), b->p_diffuse * cosine + b->p_reflect * pdf};
    if (mask & BSDF_LAYERED) v = (bsdf_value){v3_add(v.value, top.value), v.pdf + top.pdf};
    return v;
}

KERNEL bsdf_value bsdf_evaluate_below(unsigned mask, const bsdf *b, vec3 wi) {
    float cosine = diffuse_pdf(wi, -1.0f);
    vec3 mirrored = {wi.x, wi.y, fm_max(-wi.z, 0.0f)};
    float mu = bsdf_table_mu(mask, b, mirrored), full = bsdf_full(mu, b->alpha, b->roughness);
    float again = b->again_far * bsdf_interface_loss(b, b->far_ior, mu, full);
    vec2 alphas = {fm_max(b->alphas.x, GGX_ALPHA_MIN), fm_max(b->alphas.y, GGX_ALPHA_MIN)};
    int live = (wi.z < 0.0f) & !bsdf_is_straight(b), thin = b->thin > 0.5f;
    /* A thin wall passes light on as it would have reflected it, mirrored at the wall (KHR_materials_transmission). */
    vec3 hr = v3_normalize(v3_add(b->wo, mirrored));
    vec3 ht = ggx_refraction_normal(b->wo, wi, b->eta), h = v3_select(thin, hr, ht);
    float pdf_solid = ggx_refraction_pdf(b->wo, wi, ht, alphas, b->eta);
    float value_solid = pdf_solid * ggx_refraction_multiplier(wi, alphas, b->eta);
    float pdf = thin ? ggx_reflection_pdf(b->wo, hr, alphas) : pdf_solid;
    float value = thin ? ggx_reflection_value(b->wo, mirrored, hr, alphas) : value_solid;
    vec3 f = complement(bsdf_interface_fresnel(mask, b, fm_max(v3_dot(b->wo, h), 0.0f)));
    vec3 sum = v3_mul(b->tint, v3_madd(v3_splat(again * cosine), live ? value : 0.0f, f));
    if (mask & BSDF_LAYERED) {
        layers_pass in = layers_toward(b, mirrored, 1);
        vec3 enters = complement(bsdf_coat_albedo(mask, b, mu, full));
        vec3 diffuse = v3_scale(v3_mul(b->passes, enters), in.clearcoat * in.sheen * cosine);
        sum = v3_madd(diffuse, layers_under(b, in), sum);
    }
    return (bsdf_value){sum, b->p_below * cosine + (live ? b->p_transmit * pdf : 0.0f)};
}

KERNEL bsdf_value bsdf_evaluate(unsigned mask, const bsdf *b, vec3 wi) {
    bsdf_value above = bsdf_evaluate_above(mask, b, wi);
    if (!(mask & BSDF_TRANSMISSIVE)) return above;
    bsdf_value below = bsdf_evaluate_below(mask, b, wi);
    int up = wi.z > 0.0f;
    return (bsdf_value){v3_select(up, above.value, below.value), up ? above.pdf : below.pdf};
}

typedef struct bsdf_sampled {
    vec3 wi;
    vec3 multiplier; /* f |cos θi| / pdf over all lobes; 0: absorbed. In closed form for Lambert alone (the albedo) and
                        for deltas; a mixture divides two sums, in which each lobe's D and cosine occur alike */
    float pdf;       /* of wi over all lobes; 0 where evaluate does not know what was sampled: for a delta, for what is
                        absorbed, and for a clear coat's light under the horizon of the bent surface below it */
    int delta;
    int crosses;     /* wi lies on the far side */
} bsdf_sampled;

/* Which lobe a number in [0, 1) chooses: flags of 0 and 1, one of them 1 but for black surfaces. */
typedef struct bsdf_choice { int below, clearcoat, sheen, reflect, transmit; } bsdf_choice;

KERNEL bsdf_choice bsdf_choose(unsigned mask, const bsdf *b, float lobe) {
    bsdf_choice c = {.reflect = lobe >= b->p_diffuse};
    float layers = 0.0f;
    if (mask & BSDF_LAYERED) {
        float from = b->p_diffuse + b->p_below, to = from + b->p_clearcoat;
        layers = b->p_clearcoat + b->p_sheen;
        c.clearcoat = (lobe >= from) & (lobe < to);
        c.sheen = (lobe >= to) & (lobe < from + layers);
    }
    if (mask & BSDF_TRANSMISSIVE) {
        float below = b->p_diffuse + b->p_below;
        c.below = c.reflect & (lobe < below);
        c.transmit = (lobe >= below + layers + b->p_reflect) & (b->p_transmit > 0.0f);
        c.reflect = c.reflect & !c.below & !c.transmit;
    }
    c.reflect = c.reflect & !c.clearcoat & !c.sheen;
    return c;
}

/* wo mirrored at a microfacet. */
KERNEL vec3 bsdf_mirror(vec3 wo, vec3 h) { return v3_sub(v3_scale(h, 2.0f * v3_dot(wo, h)), wo); }

KERNEL vec3 bsdf_sample_clearcoat(const bsdf *b, vec2 u) {
    const bsdf_clearcoat *l = &b->clearcoat;
    float alpha = fm_max(l->alpha, GGX_ALPHA_MIN);
    vec3 h = v3_select(bsdf_is_mirror(l->alpha), v3(0, 0, 1), ggx_sample_normal(l->wo, (vec2){alpha, alpha}, u));
    return frame_to_world(&l->frame, bsdf_mirror(l->wo, h));
}

/* f cos/p of the delta that was chosen, towards wi. */
KERNEL vec3 bsdf_at_delta(unsigned mask, const bsdf *b, bsdf_choice c, vec3 wi) {
    vec3 f = v3_scale(bsdf_reflection_fresnel(mask, b, b->wo.z), 1.0f / fm_max(b->p_reflect, 1e-30f));
    if (mask & BSDF_TRANSMISSIVE) {
        vec3 passes = v3_mul(b->tint, complement(bsdf_interface_fresnel(mask, b, b->wo.z)));
        float squeeze = b->thin > 0.5f ? 1.0f : b->eta * b->eta; /* radiance narrows by 1/η² */
        f = v3_select(c.transmit, v3_scale(passes, 1.0f / fm_max(b->p_transmit * squeeze, 1e-30f)), f);
    }
    if (mask & BSDF_LAYERED) {
        layers_pass up = layers_toward(b, wi, 0), down = layers_toward(b, wi, 1);
        float under = c.transmit ? layers_under(b, down) : layers_under(b, up);
        float coat = b->clearcoat.gloss * clearcoat_fresnel(b->clearcoat.wo.z) / fm_max(b->p_clearcoat, 1e-30f);
        f = v3_select(c.clearcoat, v3_splat(coat), v3_scale(f, under));
    }
    return f;
}

/* u.lobe chooses the lobe, u.direction its direction. */
KERNEL bsdf_sampled bsdf_sample(unsigned mask, const bsdf *b, float lobe, vec2 direction) {
    vec3 wi = diffuse_sample(direction, 1.0f);
    if (!(mask & BSDF_GLOSSY))
        return (bsdf_sampled){wi, v3_scale(b->diffuse, b->p_diffuse), b->p_diffuse * diffuse_pdf(wi, 1.0f), 0, 0};

    bsdf_choice chosen = bsdf_choose(mask, b, lobe);
    int straight = 0, possible = 1, hangs = 0;
    vec2 alphas = {fm_max(b->alphas.x, GGX_ALPHA_MIN), fm_max(b->alphas.y, GGX_ALPHA_MIN)};
    vec3 h = ggx_sample_normal(b->wo, alphas, direction);
    vec3 mirrored = bsdf_mirror(b->wo, v3_select(bsdf_is_mirror(b->alphas.x), v3(0, 0, 1), h));
    if (mask & BSDF_TRANSMISSIVE) {
        straight = bsdf_is_straight(b);
        wi.z = chosen.below ? -wi.z : wi.z;
        vec3 ht = v3_select(straight, v3(0, 0, 1), h);
        float c = v3_dot(b->wo, ht);
        possible = !chosen.transmit | (b->thin > 0.5f) | (1.0f - c * c < b->eta * b->eta);
        vec3 bent = ggx_refract(b->wo, ht, c, b->eta);
        vec3 unbent = straight ? v3_neg(b->wo) : v3(mirrored.x, mirrored.y, -mirrored.z);
        wi = v3_select(chosen.transmit, v3_select(b->thin > 0.5f, unbent, bent), wi);
    }
    wi = v3_select(chosen.reflect, mirrored, wi);
    /* In numbers: gcc makes of the flags a choice between truth values, which does not vectorise. */
    float spread = (chosen.reflect ? b->alphas.x : 1.0f) * (chosen.transmit & straight ? 0.0f : 1.0f);
    if (mask & BSDF_LAYERED) {
        wi = v3_select(chosen.clearcoat, bsdf_sample_clearcoat(b, direction), wi);
        wi = v3_select(chosen.sheen, sheen_sample(direction, b->sheen.roughness), wi);
        spread *= chosen.clearcoat ? b->clearcoat.alpha : 1.0f;
        int own = v3_dot(wi, b->clearcoat.frame.z) > 0.0f;
        possible = possible & ((chosen.clearcoat == 0) | own);
        hangs = chosen.clearcoat & own & (wi.z <= 0.0f);
    }
    int delta = spread < GGX_ALPHA_MIN;
    /* A microfacet may send light to the wrong side of the surface, or refuse to refract: absorbed; the energy comes
     * back as multiple scattering. */
    int lives = ((chosen.transmit | chosen.below) ? wi.z < 0.0f : wi.z > 0.0f) & possible;
    bsdf_value v = bsdf_evaluate(mask, b, wi);
    float scale = lives & (v.pdf > 0.0f) ? 1.0f / v.pdf : 0.0f;
    vec3 at_delta = v3_scale(bsdf_at_delta(mask, b, chosen, wi), lives | hangs ? 1.0f : 0.0f);
    vec3 multiplier = v3_scale(v.value, scale);
    if (mask & BSDF_LAYERED) { /* a clear coat has its own horizon */
        layers_value coat = layers_evaluate(b, wi, layers_toward(b, wi, 0));
        multiplier = v3_select(hangs, v3_scale(coat.value, 1.0f / fm_max(coat.pdf, 1e-30f)), multiplier);
    }
    return (bsdf_sampled){wi, v3_select(delta, at_delta, multiplier), lives & !delta & !hangs ? v.pdf : 0.0f, delta,
                          chosen.transmit | chosen.below};
}

#endif
