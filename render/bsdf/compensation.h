/* render/bsdf/compensation.h: what microfacets reflect more than once, and the base under its coat.
 *
 * Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks": (1 − E(wo))(1 − E(wi)) over π (1 − mean E),
 * reciprocal; the same form couples the base to its coat (Kelemen and Szirmay-Kalos 2001). */
#ifndef KILN_RENDER_BSDF_COMPENSATION_H
#define KILN_RENDER_BSDF_COMPENSATION_H

#include "render/bsdf/layers.h"

/* What an interface loses to multiple scattering, seen so; thin walls lose what a mirror would, and what goes straight on
 * loses nothing. Of anisotropic boundaries of solids there are no tables: where microfacets face w less than those of the
 * isotropic surface which is looked up, they reflect more and lose less; from inside, less again. Rather too little is
 * given back than too much. */
KERNEL float bsdf_interface_loss(const bsdf *b, albedo_node ior, const bsdf_seen *seen) {
    float solid = (1.0f - albedo_interface(ior, seen->mu, b->alpha, b->roughness)) * seen->interface;
    float lost = fm_lerp(ior.index < ALBEDO_IORS / 2 - 1 ? solid * b->from_inside : solid, seen->lost, b->thin);
    return lost * (bsdf_is_straight(b) ? 0.0f : 1.0f);
}
KERNEL float bsdf_interface_mean_loss(const bsdf *b, albedo_node ior, float full_mean_loss) {
    return fm_max(fm_lerp(albedo_interface_mean_loss(ior, b->roughness), full_mean_loss, b->thin), BSDF_LEAST_MEAN);
}

/* Shares of light that a lobe over a hemisphere sends up and down. */
typedef struct bsdf_up_down { vec3 up, down; } bsdf_up_down;

KERNEL vec3 bsdf_divide(vec3 a, vec3 mean) {
    return v3(a.x / fm_max(mean.x, BSDF_LEAST_MEAN), a.y / fm_max(mean.y, BSDF_LEAST_MEAN),
              a.z / fm_max(mean.z, BSDF_LEAST_MEAN));
}

/* What a coat without layers lets in, and what nothing dims of multiple scattering. */
KERNEL layers_means bsdf_plain_means(const bsdf *b, float full_mean_loss) {
    vec3 enters = complement(v3_madd(v3_scale(b->f0, 1.0f - full_mean_loss), albedo_schlick_mean(b->roughness),
                                     v3_sub(v3_splat(b->f90), b->f0)));
    return (layers_means){enters, enters, 1.0f};
}

/* The base under its coat, and under layers. means, through: theirs, the latter at wo. */
KERNEL bsdf_up_down bsdf_make_base(unsigned mask, bsdf *b, const surface *s, float opaque, const bsdf_seen *seen,
                                  const layers_means *means, float through) {
    vec3 enters = v3_scale(complement(bsdf_coat_albedo(mask, b, seen)), opaque * through);
    if (!(mask & BSDF_TRANSLUCENT)) {
        enters = v3_mul(enters, s->base);
        b->diffuse = bsdf_divide(enters, means->near);
        return (bsdf_up_down){enters, v3_splat(0.0f)};
    }
    vec3 up = v3_mul(enters, v3_scale(s->base, 1.0f - s->diffuse_transmission));
    vec3 down = v3_mul(enters, v3_scale(s->diffuse_transmission_color, s->diffuse_transmission));
    /* From either side of a solid's boundary: the larger mean keeps what crosses symmetric and below what came. */
    vec3 larger = v3(fm_max(means->near.x, means->far.x), fm_max(means->near.y, means->far.y),
                     fm_max(means->near.z, means->far.z));
    b->diffuse = bsdf_divide(up, means->near);
    vec3 passes = bsdf_divide(down, larger);
    /* Nothing bends here, yet radiance narrows by 1/η² as it does where it bends: a path that comes in one way and goes
     * out the other would gain light. */
    b->passes = v3_scale(passes, b->thin > 0.5f ? 1.0f : 1.0f / (b->eta * b->eta));
    return (bsdf_up_down){up, v3_mul(passes, means->far)};
}

/* F_ms = F² E/(1 − F (1 − E)) of the mean Fresnel term F = (20 F0 + 1)/21 and the mean albedo E. */
KERNEL vec3 bsdf_make_metal(bsdf *b, const surface *s, float lost_here, float full_mean_loss,
                            const layers_means *means, float through) {
    float full_mean = 1.0f - full_mean_loss;
    vec3 f = v3_madd(v3_splat(1.0f / 21.0f), 20.0f / 21.0f, s->base), lost = v3_scale(f, full_mean_loss);
    vec3 again = v3(f.x * f.x * full_mean / (1.0f - lost.x), f.y * f.y * full_mean / (1.0f - lost.y),
                    f.z * f.z * full_mean / (1.0f - lost.z));
    again = v3_scale(again, s->metallic * lost_here * through);
    b->metal_again = v3_scale(again, 1.0f / fm_max(full_mean_loss, BSDF_LEAST_MEAN));
    b->metal_again = v3_scale(b->metal_again, 1.0f / fm_max(means->again, BSDF_LEAST_MEAN));
    return again;
}

/* What the interface loses is shared out so that as much crosses from either side: (1 − κ_a) n_a² M_a is symmetric. */
KERNEL bsdf_up_down bsdf_make_interface(unsigned mask, bsdf *b, const bsdf_seen *seen, float full_mean_loss) {
    float loss = bsdf_interface_loss(b, b->near_ior, seen);
    /* Tables know no films: rather too little than too much. */
    if (mask & BSDF_FILM) loss *= 1.0f - 0.25f * b->film.share;
    float near_mean = bsdf_interface_mean_loss(b, b->near_ior, full_mean_loss);
    float far_mean = bsdf_interface_mean_loss(b, b->far_ior, full_mean_loss);
    float eta2 = b->thin > 0.5f ? 1.0f : b->eta * b->eta;
    float pass = eta2 * far_mean / (near_mean + eta2 * far_mean);
    float reflected = (1.0f - pass) * loss, passed = pass * loss;
    b->again_near = reflected * b->interface / near_mean;
    b->again_far = passed / (far_mean * eta2);
    return (bsdf_up_down){v3_splat(reflected * b->interface), v3_scale(b->tint, passed)};
}

#endif
