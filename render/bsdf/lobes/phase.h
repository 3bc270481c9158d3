/* render/bsdf/lobes/phase.h: Henyey and Greenstein 1941, "Diffuse radiation in the galaxy": where a medium scatters to.
 *
 *     p(wo, wi) = (1 − g²)/(4 π (1 + g² + 2 g wo·wi)^(3/2)),   g the mean cosine between the ways before and after
 *
 * (KHR_materials_volume_scatter, "Phase Function"). It integrates to 1 and is sampled exactly: the density is the value.
 * All expressions keep their digits up to |g| = 0.999, where the peak is a thousandth wide: no difference of numbers
 * near 1 is formed. */
#ifndef KILN_RENDER_BSDF_LOBES_PHASE_H
#define KILN_RENDER_BSDF_LOBES_PHASE_H

#include "base/fmath.h"
#include "base/kernel.h"
#include "base/vec.h"
#include "render/bsdf/frame.h"

/* 1 + g² + 2 g c = (1 − g)² + g |wo + wi|² = (1 + g)² − g |wo − wi|², for unit vectors. */
KERNEL float phase_value(vec3 wo, vec3 wi, float g) {
    vec3 sum = v3_add(wo, wi), difference = v3_sub(wo, wi);
    float forward = (1.0f - g) * (1.0f - g) + g * v3_dot(sum, sum);
    float backward = (1.0f + g) * (1.0f + g) - g * v3_dot(difference, difference);
    float q = g > 0.0f ? forward : backward;
    return 0.0795774715f * (1.0f - g) * (1.0f + g) / (q * sqrtf(q)); /* |g| < 1: not 0 */
}

/* By inversion, about the peak: on ahead, or back where g < 0, which is the same with −g. With η = 2 u.x − 1 and
 * a = 1 + g η, one less the cosine of the turn is (1 − g)² (1 − η) (2 + g + g η)/(2 a²): no g in a denominator. */
KERNEL vec3 phase_sample(vec3 wo, float g, vec2 u) {
    float h = fabsf(g), rest = 1.0f - u.x, a = (1.0f + h) - 2.0f * h * rest; /* 1 + h η */
    float turn = (1.0f - h) * (1.0f - h) * rest * (1.0f + h + a) / (a * a);
    turn = fm_clamp(turn, 0.0f, 2.0f);
    float sine = sqrtf(turn * (2.0f - turn));
    fm_pair p = fm_sincos_2pi(u.y);
    frame f = frame_make(v3_scale(wo, g < 0.0f ? 1.0f : -1.0f));
    return v3_normalize(frame_to_world(&f, v3(sine * p.cos, sine * p.sin, 1.0f - turn)));
}

#endif
