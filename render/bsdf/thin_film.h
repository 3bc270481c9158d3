/* render/bsdf/thin_film.h: the reflectance of a thin film on a surface: KHR_materials_iridescence.
 *
 * Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence", in the
 * form of the extension's implementation notes: Schlick's terms at both interfaces, phases of 0 or π, two orders of
 * interference, integrated over the spectrum in closed form. The film lies in air. Colours are linear Rec.709. */
#ifndef KILN_RENDER_BSDF_THIN_FILM_H
#define KILN_RENDER_BSDF_THIN_FILM_H

#include "base/fmath.h"
#include "render/bsdf/fresnel.h"

/* What the film does at an angle, whatever it lies on. */
typedef struct thin_film {
    float ior;
    float outer;        /* reflectance of its outer interface */
    float inner_weight; /* Schlick's weight at the inner one */
    vec3 first, second; /* sensitivity of the channels to the phase difference, once and twice */
} thin_film;

/* Gaussian fits of the CIE 1931 matching functions in Fourier space (Belcour and Barla 2017, section 4 and its code): one
 * term's sensitivity to an optical path difference in nanometres, and to twice that: cos 2x = 2 cos² x − 1, and a
 * Gaussian's fourth power. */
typedef struct thin_film_wave { float first, second; } thin_film_wave;

KERNEL thin_film_wave thin_film_wave_of(float amplitude, float turns_per_nm, float spread, float path_nm) {
    float c = fm_sincos_2pi(turns_per_nm * path_nm).cos, e = fm_exp(-spread * path_nm * path_nm), e2 = e * e;
    return (thin_film_wave){amplitude * c * e, amplitude * (2.0f * c * c - 1.0f) * e2 * e2};
}

/* XYZ to Rec.709. */
KERNEL vec3 thin_film_rgb(float x, float y, float z) {
    return v3(3.2404542f * x - 1.5371385f * y - 0.4985314f * z, -0.9692660f * x + 1.8760108f * y + 0.0415560f * z,
              0.0556434f * x - 0.2040259f * y + 1.0572252f * z);
}

/* What there is of a film: thinner than 0.03 nm it fades away. Belcour and Barla let its index fade; Schlick's term would
 * still reflect at grazing angles, from nothing. */
KERNEL float thin_film_share(float share, float thickness_nm) {
    float t = fm_clamp(thickness_nm * (1.0f / 0.03f), 0.0f, 1.0f);
    return share * t * t * (3.0f - 2.0f * t);
}

/* c: cosine outside of the film, ≥ 0; n ≥ 1. A path of 0 gives no exact white: the constant term of the series does not go
 * through the fits. */
KERNEL thin_film thin_film_make(float c, float n, float thickness_nm) {
    float r0 = fresnel_normal(n);
    float inside2 = 1.0f - (1.0f - c * c) / (n * n), inside = sqrtf(inside2 > 0.0f ? inside2 : 0.0f);
    float path = fm_min(2.0f * n * thickness_nm * inside, 1e5f); /* beyond nothing interferes */
    thin_film_wave x0 = thin_film_wave_of(0.84659000f, 1.6810e-3f, 1.7085470e-7f, path);
    thin_film_wave x1 = thin_film_wave_of(0.15386831f, 2.2399e-3f, 1.7876617e-7f, path);
    thin_film_wave y = thin_film_wave_of(1.0002219f, 1.7953e-3f, 3.6733088e-7f, path);
    thin_film_wave z = thin_film_wave_of(1.0011225f, 2.2084e-3f, 2.6103525e-7f, path);
    return (thin_film){n, r0 + (1.0f - r0) * fresnel_schlick_weight(c), fresnel_schlick_weight(inside),
                       thin_film_rgb(x0.first + x1.first, y.first, z.first),
                       thin_film_rgb(x0.second + x1.second, y.second, z.second)};
}

/* One channel: f0 of what the film lies on, as it would be in air; the index behind it is taken for real. */
KERNEL float thin_film_channel(const thin_film *f, float f0, float first, float second) {
    float root = sqrtf(fm_min(f0 + 1e-4f, 0.9999f)), base = (1.0f + root) / (1.0f - root);
    float q = (base - f->ior) / (base + f->ior), r1 = q * q, inner = r1 + (1.0f - r1) * f->inner_weight;
    float passes = 1.0f - f->outer, both = fm_clamp(f->outer * inner, 1e-5f, 0.9999f);
    float again = passes * passes * inner / (1.0f - both), wave = again - passes;
    /* The first interface turns the phase by π, seen from inside; the second where the index falls. */
    float odd = base < f->ior ? 2.0f : -2.0f;
    float sum = f->outer + again + wave * (odd * sqrtf(both) * first + 2.0f * both * second);
    return fm_clamp(sum, 0.0f, 1.0f); /* two orders of a series, and saturated colours, leave the gamut */
}

KERNEL vec3 thin_film_reflectance(const thin_film *f, vec3 f0) {
    return v3(thin_film_channel(f, f0.x, f->first.x, f->second.x), thin_film_channel(f, f0.y, f->first.y, f->second.y),
              thin_film_channel(f, f0.z, f->first.z, f->second.z));
}

#endif
