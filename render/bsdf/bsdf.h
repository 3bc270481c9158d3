/* render/bsdf/bsdf.h: the BSDF of a surface: seven lobes, composed by layer.
 *
 *   DIFFUSE       cosine, wo's side: the base under its coat
 *   BELOW         cosine, far side: diffuse transmission
 *   GRAZING       either side: what microfacets reflect or pass on after more than one event; an interface's half as
 *                 DIFFUSE and BELOW, for it also loses light about its critical angle
 *   REFLECTION    GGX, or a mirror under GGX_ALPHA_MIN: metal and dielectric together, for they share their roughness
 *   TRANSMISSION  GGX, or a delta: refraction at a solid, straight on through a thin wall
 *   CLEARCOAT     GGX, or a mirror, around a normal of its own
 *   SHEEN         Charlie
 *
 *     f = clearcoat + [ sheen + [ m metal + (1 − m) ((1 − t) (coat + base) + t interface) ] ]
 *
 * where [] is what layers let through (layers.h). Metal and coat use Schlick's Fresnel term as glTF 2.0, appendix B does;
 * the interface of a transmissive dielectric the exact one; a thin film replaces them. evaluate and pdf answer 0 for
 * delta lobes: only sample knows their direction. `mask` says which terms can occur and is a constant at every call. Terms
 * that a surface does not have give the same bits as a mask without them: --effects all shows them to be nothing. */
#ifndef KILN_RENDER_BSDF_BSDF_H
#define KILN_RENDER_BSDF_BSDF_H

#include "render/bsdf/compensation.h"
#include "render/bsdf/lobes/diffuse.h"

/* Anisotropy after KHR_materials_anisotropy: the alpha along x grows, the one along y is the material's. Isotropic
 * tables are asked for the root of the mean square. */
KERNEL void bsdf_make_roughness(unsigned mask, bsdf *b, const surface *s) {
    b->alpha = s->roughness * s->roughness;
    b->alphas = (vec2){b->alpha, b->alpha};
    b->roughness = albedo_roughness_node(s->roughness);
    b->grazing = grazing_make(fm_max(b->alpha, GGX_ALPHA_MIN));
    b->from_inside = 1.0f;
    if (!(mask & BSDF_ANISOTROPIC)) return;
    b->alphas.x = fm_lerp(b->alpha, 1.0f, s->anisotropy * s->anisotropy);
    int brushed = s->anisotropy > 0.0f;
    b->brushed = anisotropy_make(b->alphas.x, b->alphas.y);
    b->from_inside = brushed ? sqrtf(b->brushed.stretch) : 1.0f;
    float mean = sqrtf(0.5f * (b->alphas.x * b->alphas.x + b->alpha * b->alpha));
    b->alpha = brushed ? mean : b->alpha;
    b->roughness = albedo_roughness_node(brushed ? sqrtf(mean) : s->roughness);
    b->grazing = grazing_make(fm_max(b->alpha, GGX_ALPHA_MIN));
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

/* What the wide lobes return to either side, and how much of that goes by GRAZING's density. */
typedef struct bsdf_wide { float up, below, grazing, grazing_below; } bsdf_wide;

/* Selection weights, by what the lobes return. Visible microfacets face wo more than a surface does that is seen from the
 * side, and less than one that is seen from above. */
KERNEL void bsdf_make_weights(unsigned mask, bsdf *b, bsdf_wide w) {
    int straight = mask & BSDF_TRANSMISSIVE && bsdf_is_straight(b);
    bsdf_facet mean = bsdf_facet_at(mask, b, b->wo.z + (straight ? 0.0f : b->alpha * (0.5f - b->wo.z)));
    float w_glossy = average(mean.reflects), sum = 0.0f;
    if (mask & BSDF_TRANSMISSIVE) {
        w_glossy += average(mean.passes);
        b->p_straight = mean.p_passes;
    }
    const bsdf_clearcoat *l = &b->clearcoat;
    w_glossy *= l->through * b->sheen.through;
    if (mask & BSDF_CLEARCOAT) b->p_clearcoat = l->near * clearcoat_fresnel(l->wo.z * (1.0f - 0.5f * l->alpha));
    if (mask & BSDF_SHEEN) b->p_sheen = average(b->sheen.color) * l->through * albedo_sheen(b->wo.z, b->sheen.node);
    sum = b->p_clearcoat + b->p_sheen;
    sum = sum + w.up + w.below + w_glossy;
    float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
    b->p_diffuse = sum > w.up ? w.up * scale : w.up > 0.0f ? 1.0f : 0.0f; /* exactly 1 when alone */
    b->p_below = w.below * scale;
    b->p_grazing = w.grazing * scale;
    b->p_grazing_below = w.grazing_below * scale;
    b->p_glossy = w_glossy * scale;
    b->p_clearcoat *= scale;
    b->p_sheen *= scale;
}

KERNEL bsdf bsdf_make(unsigned mask, const surface *s, vec3 wo) {
    bsdf b = {.wo = wo, .diffuse = s->base, .wide = s->base, .p_diffuse = average(s->base) > 0.0f ? 1.0f : 0.0f,
              .clearcoat.through = 1.0f, .sheen.through = 1.0f};
    if (!(mask & BSDF_GLOSSY)) return b;
    float opaque = (1.0f - s->metallic) * (1.0f - (mask & BSDF_TRANSMISSIVE ? s->transmission : 0.0f));
    bsdf_make_roughness(mask, &b, s);
    bsdf_make_fresnel(mask, &b, s, opaque);
    layers_make(mask, &b, s);
    bsdf_seen seen = bsdf_see(mask, &b, wo);
    float mean_loss = albedo_full_mean_loss(b.roughness), through = b.clearcoat.through * b.sheen.through;
    /* In numbers: conditions would keep the look-ups from vectorising. */
    float brushed = mask & BSDF_ANISOTROPIC && s->anisotropy > 0.0f ? 1.0f : 0.0f;
    if (mask & BSDF_ANISOTROPIC)
        mean_loss *= fm_lerp(1.0f, anisotropy_mean(b.alphas.x, b.brushed.stretch), brushed);
    layers_means means = bsdf_plain_means(&b, mean_loss);
    if (mask & (BSDF_COVERED | BSDF_ANISOTROPIC)) /* where there is none of it, the tables' means: the same as without */
        means = layers_means_select(layers_lie(&b) + brushed > 0.0f, layers_mean(mask, &b), means);
    bsdf_up_down base = bsdf_make_base(mask, &b, s, opaque, &seen, &means, through);
    vec3 metal = bsdf_make_metal(&b, s, seen.lost, mean_loss, &means, through);
    b.wide = v3_add(v3_add(base.up, metal), base.down);
    bsdf_wide w = {.up = average(base.up), .below = average(base.down), .grazing = average(metal)};
    if (mask & BSDF_TRANSMISSIVE) {
        bsdf_up_down again = bsdf_make_interface(mask, &b, &seen, mean_loss);
        float up = 0.5f * through * average(again.up), below = 0.5f * through * average(again.down);
        w = (bsdf_wide){w.up + up, w.below + below, w.grazing + up, below};
        b.wide = v3_madd(b.wide, through, v3_add(again.up, again.down));
    }
    w.up += w.grazing;
    w.below += w.grazing_below;
    bsdf_make_weights(mask, &b, w);
    return b;
}

/* Directional albedo at wo: what a denoiser wants to know. The interface's Fresnel term is taken about where visible
 * microfacets face wo, and so is the film's. */
KERNEL vec3 bsdf_albedo(unsigned mask, const bsdf *b) {
    if (!(mask & BSDF_GLOSSY)) return b->wide;
    bsdf_seen seen = bsdf_see(mask, b, b->wo);
    float facing = b->wo.z + b->alpha * (1.0f - b->wo.z);
    vec3 sum = v3_madd(b->reflect0, fresnel_schlick_weight(seen.cosine), b->reflect1);
    if (mask & BSDF_FILM) sum = bsdf_filmed(b, seen.cosine, sum);
    sum = v3_scale(sum, seen.full);
    if (mask & BSDF_TRANSMISSIVE) {
        vec3 f = bsdf_interface_fresnel(mask, b, facing), passes = v3_mul(b->tint, complement(f));
        float kept = 1.0f - bsdf_interface_loss(b, b->near_ior, &seen);
        sum = v3_madd(sum, kept, v3_madd(passes, b->interface, f));
    }
    sum = v3_scale(sum, b->sheen.through);
    if (mask & BSDF_SHEEN) sum = v3_madd(sum, albedo_sheen(b->wo.z, b->sheen.node), b->sheen.color);
    sum = v3_madd(v3_splat(1.0f - b->clearcoat.through), b->clearcoat.through, sum);
    return v3_add(b->wide, sum);
}

/* f(wo, wi) |cos θi| of everything that is not a delta, and the density with which sample chooses wi. */
typedef struct bsdf_value { vec3 value; float pdf; } bsdf_value;

/* What a direction is asked for: mirrored up where it lies below. */
typedef struct bsdf_toward {
    vec3 wi, mirrored;
    int up;
    float cosine; /* |cos θ|/π */
    bsdf_seen seen;
    layers_pass in;
    float under;  /* layers_under of light of one event */
} bsdf_toward;

KERNEL bsdf_toward bsdf_look(unsigned mask, const bsdf *b, vec3 wi) {
    bsdf_toward t = {.wi = wi, .mirrored = {wi.x, wi.y, fm_max(wi.z, 0.0f)}, .up = wi.z > 0.0f, .in = {1.0f, 1.0f},
                     .under = 1.0f};
    if (mask & BSDF_TRANSMISSIVE) t.mirrored.z = fabsf(wi.z);
    t.cosine = diffuse_pdf(wi, mask & BSDF_TRANSMISSIVE && !t.up ? -1.0f : 1.0f);
    if (!(mask & BSDF_GLOSSY)) return t;
    t.seen = bsdf_see(mask, b, t.mirrored);
    if (mask & BSDF_COVERED) {
        t.in = layers_toward(mask, b, t.mirrored, !t.up);
        t.under = layers_under(b, t.in);
    }
    return t;
}

/* DIFFUSE, BELOW and GRAZING. */
KERNEL bsdf_value bsdf_evaluate_wide(unsigned mask, const bsdf *b, const bsdf_toward *t) {
    if (!(mask & BSDF_GLOSSY)) return (bsdf_value){v3_scale(b->diffuse, t->cosine), b->p_diffuse * t->cosine};
    vec3 enters = complement(bsdf_coat_albedo(mask, b, &t->seen));
    vec3 value = v3_madd(v3_mul(b->diffuse, enters), t->seen.lost, b->metal_again);
    float p = b->p_diffuse, grazing = b->p_grazing;
    vec3 passes = mask & BSDF_TRANSLUCENT ? v3_mul(b->passes, enters) : v3_splat(0.0f);
    if (mask & BSDF_TRANSMISSIVE) value = v3_select(t->up, value, passes);
    value = v3_scale(value, t->in.clearcoat * t->in.sheen);
    if (mask & BSDF_TRANSMISSIVE) {
        albedo_node ior = {t->up ? b->near_ior.index : b->far_ior.index,
                           t->up ? b->near_ior.fraction : b->far_ior.fraction};
        float again = t->under * bsdf_interface_loss(b, ior, &t->seen);
        vec3 share = v3_select(t->up, v3_splat(b->again_near), v3_scale(b->tint, b->again_far));
        value = v3_madd(value, again, share);
        p = t->up ? p : b->p_below;
        grazing = t->up ? grazing : b->p_grazing_below;
    }
    float pdf = (p - grazing) * t->cosine + grazing * grazing_pdf(b->grazing, t->mirrored.z);
    return (bsdf_value){v3_scale(value, t->cosine), pdf};
}

/* REFLECTION and TRANSMISSION: a microfacet is chosen first, then what it does. A thin wall passes light on as it would
 * have reflected it, mirrored at the wall (KHR_materials_transmission). */
KERNEL bsdf_value bsdf_evaluate_glossy(unsigned mask, const bsdf *b, const bsdf_toward *t) {
    vec3 h = v3_normalize(v3_add(b->wo, t->mirrored)); /* wo.z > 0: not zero */
    float alpha = b->alphas.x; /* a choice between numbers: between truth values it does not vectorise */
    vec2 alphas = {fm_max(b->alphas.x, GGX_ALPHA_MIN), fm_max(b->alphas.y, GGX_ALPHA_MIN)};
    float value = ggx_reflection_value(b->wo, t->mirrored, h, alphas), pdf = ggx_reflection_pdf(b->wo, h, alphas);
    float c = v3_dot(b->wo, h);
    if (mask & BSDF_TRANSMISSIVE) {
        int bent = (t->up == 0) & (b->thin < 0.5f);
        vec3 ht = ggx_refraction_normal(b->wo, t->wi, b->eta);
        float pdf_bent = ggx_refraction_pdf(b->wo, t->wi, ht, alphas, b->eta);
        float value_bent = pdf_bent * ggx_refraction_multiplier(t->wi, alphas, b->eta);
        c = bent ? fm_max(v3_dot(b->wo, ht), 0.0f) : c;
        value = bent ? value_bent : value;
        pdf = bent ? pdf_bent : pdf;
        alpha = t->up ? alpha : bsdf_transmission_alpha(b);
    }
    int live = (t->mirrored.z > 0.0f) & !bsdf_is_mirror(alpha);
    bsdf_facet f = bsdf_facet_at(mask, b, c);
    float p = b->p_glossy;
    if (mask & BSDF_TRANSMISSIVE) {
        float passes = bsdf_is_straight(b) ? b->p_straight : f.p_passes;
        p *= t->up ? 1.0f - passes : passes;
        f.reflects = v3_select(t->up, f.reflects, f.passes);
    }
    return (bsdf_value){v3_scale(f.reflects, live ? value * t->under : 0.0f), live ? p * pdf : 0.0f};
}

/* top: what layers do towards wi, by the clear coat's own horizon; written where there are some. */
KERNEL bsdf_value bsdf_evaluate_toward(unsigned mask, const bsdf *b, const bsdf_toward *t, layers_value *top) {
    bsdf_value v = bsdf_evaluate_wide(mask, b, t);
    if (!(mask & BSDF_GLOSSY)) return v;
    bsdf_value glossy = bsdf_evaluate_glossy(mask, b, t);
    v = (bsdf_value){v3_add(v.value, glossy.value), v.pdf + glossy.pdf};
    if (!(mask & (BSDF_CLEARCOAT | BSDF_SHEEN))) return v;
    *top = layers_evaluate(mask, b, t->wi, t->in);
    float above = t->up ? 1.0f : 0.0f;
    return (bsdf_value){v3_madd(v.value, above, top->value), v.pdf + above * top->pdf};
}

KERNEL bsdf_value bsdf_evaluate(unsigned mask, const bsdf *b, vec3 wi) {
    bsdf_toward t = bsdf_look(mask, b, wi);
    layers_value top = {v3_splat(0.0f), 0.0f};
    return bsdf_evaluate_toward(mask, b, &t, &top);
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

/* Which lobe a number in [0, 1) chooses: flags of 0 and 1; DIFFUSE where none is 1, or GRAZING. p_reflects: of the
 * microfacet that glossy lobes meet, not to let light pass. */
typedef struct bsdf_choice { int grazing, below, clearcoat, sheen, reflect, transmit; } bsdf_choice;

KERNEL bsdf_choice bsdf_choose(unsigned mask, const bsdf *b, float lobe, float p_reflects) {
    float from = b->p_diffuse;
    bsdf_choice c = {.grazing = lobe < b->p_grazing};
    if (mask & BSDF_TRANSMISSIVE) {
        c.below = (lobe >= from) & (lobe < from + b->p_below);
        c.grazing = c.grazing | (c.below & (lobe < from + b->p_grazing_below));
        from += b->p_below;
    }
    if (mask & BSDF_CLEARCOAT) {
        c.clearcoat = (lobe >= from) & (lobe < from + b->p_clearcoat);
        from += b->p_clearcoat;
    }
    if (mask & BSDF_SHEEN) {
        c.sheen = (lobe >= from) & (lobe < from + b->p_sheen);
        from += b->p_sheen;
    }
    c.reflect = lobe >= from;
    if (mask & BSDF_TRANSMISSIVE) {
        c.transmit = (lobe >= from + b->p_glossy * p_reflects) & (p_reflects < 1.0f);
        c.reflect = c.reflect & !c.transmit;
    }
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

/* f cos/p of the delta that was chosen, of a microfacet in the surface. */
KERNEL vec3 bsdf_at_delta(unsigned mask, const bsdf *b, bsdf_choice c, const bsdf_facet *flat, float under) {
    vec3 f = v3_scale(flat->reflects, 1.0f / fm_max(b->p_glossy * (1.0f - flat->p_passes), 1e-30f));
    if (mask & BSDF_TRANSMISSIVE) {
        float squeeze = b->thin > 0.5f ? 1.0f : b->eta * b->eta; /* radiance narrows by 1/η² */
        vec3 passes = v3_scale(flat->passes, 1.0f / fm_max(b->p_glossy * flat->p_passes * squeeze, 1e-30f));
        f = v3_select(c.transmit, passes, f);
    }
    f = v3_scale(f, under);
    if (!(mask & BSDF_CLEARCOAT)) return f;
    float coat = b->clearcoat.gloss * clearcoat_fresnel(b->clearcoat.wo.z) / fm_max(b->p_clearcoat, 1e-30f);
    return v3_select(c.clearcoat, v3_splat(coat), f);
}

/* Where REFLECTION and TRANSMISSION lead, by way of a microfacet. */
typedef struct bsdf_facet_sampled {
    bsdf_facet facet; /* in the surface where one of them is a delta */
    vec3 reflected, passed;
    int straight;
} bsdf_facet_sampled;

KERNEL bsdf_facet_sampled bsdf_sample_facet(unsigned mask, const bsdf *b, vec2 direction) {
    vec2 alphas = {fm_max(b->alphas.x, GGX_ALPHA_MIN), fm_max(b->alphas.y, GGX_ALPHA_MIN)};
    vec3 h = ggx_sample_normal(b->wo, alphas, direction);
    int mirror = bsdf_is_mirror(b->alphas.x);
    bsdf_facet_sampled r = {.reflected = bsdf_mirror(b->wo, v3_select(mirror, v3(0, 0, 1), h)), .straight = mirror};
    if (mask & BSDF_TRANSMISSIVE) {
        r.straight = bsdf_is_straight(b);
        h = v3_select(r.straight, v3(0, 0, 1), h);
        vec3 unbent = r.straight ? v3_neg(b->wo) : v3(r.reflected.x, r.reflected.y, -r.reflected.z);
        vec3 bent = ggx_refract(b->wo, h, v3_dot(b->wo, h), b->eta);
        r.passed = v3_select(b->thin > 0.5f, unbent, bent);
        r.facet = bsdf_facet_at(mask, b, v3_dot(b->wo, h));
    } else {
        r.facet = bsdf_facet_at(mask, b, b->wo.z);
    }
    return r;
}

/* u.lobe chooses the lobe, u.direction its direction. */
KERNEL bsdf_sampled bsdf_sample(unsigned mask, const bsdf *b, float lobe, vec2 direction) {
    vec3 wi = diffuse_sample(direction, 1.0f);
    if (!(mask & BSDF_GLOSSY))
        return (bsdf_sampled){wi, v3_scale(b->diffuse, b->p_diffuse), b->p_diffuse * diffuse_pdf(wi, 1.0f), 0, 0};

    bsdf_facet_sampled met = bsdf_sample_facet(mask, b, direction);
    bsdf_choice chosen = bsdf_choose(mask, b, lobe, 1.0f - met.facet.p_passes);
    wi = v3_select(chosen.grazing, grazing_sample(b->grazing, direction), wi);
    int possible = 1, hangs = 0;
    if (mask & BSDF_TRANSMISSIVE) {
        wi.z = chosen.below ? -wi.z : wi.z;
        wi = v3_select(chosen.transmit, met.passed, wi);
    }
    wi = v3_select(chosen.reflect, met.reflected, wi);
    /* In numbers: gcc makes of the flags a choice between truth values, which does not vectorise. */
    float spread = (chosen.reflect ? b->alphas.x : 1.0f) * (chosen.transmit & met.straight ? 0.0f : 1.0f);
    if (mask & BSDF_SHEEN) wi = v3_select(chosen.sheen, sheen_sample(direction, b->sheen.roughness), wi);
    if (mask & BSDF_CLEARCOAT) {
        wi = v3_select(chosen.clearcoat, bsdf_sample_clearcoat(b, direction), wi);
        spread *= chosen.clearcoat ? b->clearcoat.alpha : 1.0f;
        int own = v3_dot(wi, b->clearcoat.frame.z) > 0.0f;
        possible = (chosen.clearcoat == 0) | own;
        hangs = chosen.clearcoat & own & (wi.z <= 0.0f);
    }
    int delta = spread < GGX_ALPHA_MIN;
    /* A microfacet may send light to the wrong side of the surface: absorbed; the energy comes back as multiple
     * scattering. */
    int lives = ((chosen.transmit | chosen.below) ? wi.z < 0.0f : wi.z > 0.0f) & possible;
    bsdf_toward t = bsdf_look(mask, b, wi);
    layers_value top = {v3_splat(0.0f), 0.0f};
    bsdf_value v = bsdf_evaluate_toward(mask, b, &t, &top);
    float scale = lives & (v.pdf > 0.0f) ? 1.0f / v.pdf : 0.0f;
    vec3 at_delta = v3_scale(bsdf_at_delta(mask, b, chosen, &met.facet, t.under), lives | hangs ? 1.0f : 0.0f);
    /* Lambert without a coat: its albedo, as without BSDF_GLOSSY. */
    int alone = (b->p_diffuse >= 1.0f) & (fm_max(b->f90, v3_max(b->reflect1)) <= 0.0f);
    vec3 multiplier = v3_select(alone, b->diffuse, v3_scale(v.value, scale));
    if (mask & BSDF_CLEARCOAT) /* a clear coat has its own horizon */
        multiplier = v3_select(hangs, v3_scale(top.value, 1.0f / fm_max(top.pdf, 1e-30f)), multiplier);
    return (bsdf_sampled){wi, v3_select(delta, at_delta, multiplier), lives & !delta & !hangs ? v.pdf : 0.0f, delta,
                          chosen.transmit | chosen.below};
}

#endif
