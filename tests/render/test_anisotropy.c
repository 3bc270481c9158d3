/* The tables of anisotropic microfacets: entries as their generator makes them, and what look-ups say against integrals of
 * their own. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

int generate(void);
#define main generate
#include "tools/make_anisotropy_tables.c"
#undef main

#include "base/hash.h"
#include "render/bsdf/fresnel.h"

static double off_by(int32_t a, int32_t b) {
    return fmax(abs((a & 0xffff) - (b & 0xffff)), abs((a >> 16) - (b >> 16))) * (double)ANISOTROPY_UNIT;
}

static void entries_are_the_generators(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 40; n++) {
        int i = (int)(hash_pair(n, 1) % ANISOTROPY_RATIOS), j = (int)(hash_pair(n, 2) % ANISOTROPY_ALPHAS);
        int k = (int)(hash_pair(n, 3) % ANISOTROPY_TURNS), l = (int)(hash_pair(n, 4) % ANISOTROPY_COSINES);
        int at = i * ANISOTROPY_BLOCK + j * ANISOTROPY_SLICE + k * ANISOTROPY_COSINES + l;
        if (off_by(anisotropy_table[at], entry(i, j, k, l)) > 1.5 * (double)ANISOTROPY_UNIT)
            fail_msg("entry %d %d %d %d: %08x", i, j, k, l, (unsigned)anisotropy_table[at]);
    }
}

/* Isotropic surfaces keep what the isotropic tables say, to the last bit. */
static void isotropic_factors_are_one(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 2000; n++) {
        float alpha = unit_float(hash_pair(n, 5)), mu = unit_float(hash_pair(n, 6)), s = sqrtf(1 - mu * mu);
        fm_pair turn = fm_sincos_2pi(unit_float(hash_pair(n, 7)));
        anisotropy_node a = anisotropy_make(alpha, alpha);
        anisotropy_direction d = anisotropy_stretch(v3(s * turn.cos, s * turn.sin, mu), a.stretch);
        anisotropy_factors f = anisotropy_look_up(anisotropy_table, &a, d, alpha);
        assert_true(f.loss == 1 && f.cosine == 1 && a.stretch == 1 && anisotropy_mean(alpha, a.stretch) == 1);
        assert_true(fabsf(d.mu - mu) < 1e-6f);
    }
}

/* Anywhere in the box of αx, αy and direction, as materials reach it. */
static void look_ups_are_near(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 400; n++) {
        double u = (double)unit_float(hash_pair(n, 8)), v = (double)unit_float(hash_pair(n, 9));
        double smaller = 1e-4 + 0.9999 * u * u, strength = (double)unit_float(hash_pair(n, 10));
        alphas a = {smaller + (1 - smaller) * strength * strength, smaller};
        double mu = 0.005 + 0.995 * v * v, phi = 0.5 * M_PI * (double)unit_float(hash_pair(n, 11)), s = sqrt(1 - mu * mu);
        dir w = {s * cos(phi), s * sin(phi), mu};
        anisotropy_node where = anisotropy_make((float)a.x, (float)a.y);
        anisotropy_direction d = anisotropy_stretch(v3((float)w.x, (float)w.y, (float)w.z), where.stretch);
        anisotropy_factors f = anisotropy_look_up(anisotropy_table, &where, d, (float)a.x);
        said table = isotropic((double)d.mu, (double)d.length, a);
        returned e = anisotropic_albedo(w, a);
        double off = 1 - e.full - table.loss * (double)f.loss;
        double share = (double)fresnel_schlick_weight((float)(table.cosine * (double)f.cosine));
        double off_share = share * e.full - e.schlick;
        if (!(fabs(off) < 0.006 && fabs(off_share) < 0.03))
            fail_msg("alphas %g %g, cos %g, azimuth %g: loss %.5f off, Schlick's share %.5f", a.x, a.y, mu, phi, off,
                     off_share);
    }
}

/* The mean is that of look-ups: what compensation divides by. */
static void means_are_of_look_ups(void **state) {
    (void)state;
    for (int32_t i = 0; i < ANISOTROPY_SIZE; i++) made[i] = anisotropy_table[i];
    for (uint32_t n = 0; n < 60; n++) {
        double u = (double)unit_float(hash_pair(n, 12)), strength = (double)unit_float(hash_pair(n, 13));
        double smaller = 1e-3 + 0.999 * u * u;
        alphas a = {smaller + (1 - smaller) * strength * strength, smaller};
        float root = sqrtf(sqrtf(0.5f * (float)(a.x * a.x + a.y * a.y)));
        float isotropic_mean = albedo_full_mean_loss(albedo_roughness_node(root));
        double claimed = (double)(isotropic_mean * anisotropy_mean((float)a.x, (float)(a.y / a.x)));
        double mean = mean_loss(a);
        if (fabs(claimed / mean - 1) > 0.03)
            fail_msg("alphas %g %g: said to be %g, look-ups' is %g", a.x, a.y, claimed, mean);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(entries_are_the_generators), cmocka_unit_test(isotropic_factors_are_one),
        cmocka_unit_test(look_ups_are_near), cmocka_unit_test(means_are_of_look_ups),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
