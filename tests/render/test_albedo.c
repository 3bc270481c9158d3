/* The albedo tables: entries as their generator makes them, and look-ups between. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

int generate(void);
#define main generate
#include "tools/make_albedo_tables.c"
#undef main

#include "base/hash.h"
#include "render/bsdf/fresnel.h"

/* Tables hold five digits. */
#define DIGITS 0.6e-5

/* Entries drawn at random from each table, made again. */
static void entries_are_the_generators(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 60; n++) {
        int i = (int)(hash_pair(n, 1) % ALBEDO_COSINES), j = (int)(hash_pair(n, 2) % ALBEDO_ROUGHNESS);
        int k = (int)(hash_pair(n, 3) % ALBEDO_IORS), at = j * ALBEDO_COSINES + i;
        double a = albedo_row_alpha(j), mu = column_mu(i, a), entry = albedo(FULL, mu, a, 1);
        double share = schlick_relative(mu, a), interface = albedo(INTERFACE, mu, a, slice_eta(k));
        double off = fabs((double)albedo_full_table[at] - entry);
        double off_share = fabs((double)albedo_schlick_table[at] - share);
        double off_interface = fabs((double)albedo_interface_table[k * ALBEDO_SLICE + at] - interface);
        if (off > DIGITS || off_share > DIGITS || off_interface > DIGITS)
            fail_msg("entry %d %d %d: %g, %g, %g off", i, j, k, off, off_share, off_interface);
    }
}

/* At the nodes look-ups give the entries; coordinates are the generator's. */
static void look_ups_meet_the_nodes(void **state) {
    (void)state;
    for (int j = 0; j < ALBEDO_ROUGHNESS; j++) {
        float roughness = (float)j / (ALBEDO_ROUGHNESS - 1);
        albedo_node row = albedo_roughness_node(roughness);
        for (int i = 0; i < ALBEDO_COSINES; i++) {
            double a = albedo_row_alpha(j);
            float mu = (float)column_mu(i, a), alpha = (float)a, value = albedo_full(mu, alpha, row);
            float entry = albedo_full_table[j * ALBEDO_COSINES + i];
            float share = fresnel_schlick_weight(albedo_schlick_cosine(mu, alpha, row));
            float c = albedo_schlick_table[j * ALBEDO_COSINES + i] * (mu + alpha), wanted = powf(1 - c, 5);
            if (fabsf(value - entry) > 1e-4f || fabsf(share - wanted) > 1e-4f)
                fail_msg("%d %d: full %g, not %g; share %g, not %g", i, j, (double)value, (double)entry, (double)share,
                         (double)wanted);
        }
        assert_true(fabsf(albedo_schlick_mean(row) - albedo_schlick_mean_table[j]) < 1e-5f);
    }
}

/* Between nodes, what a look-up says is near what an integral of its own says. */
static void look_ups_between_are_near(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 300; n++) {
        float u = unit_float(hash_pair(n, 4)), v = unit_float(hash_pair(n, 5)), x = unit_float(hash_pair(n, 6));
        float roughness = 0.01f + 0.99f * u * u, mu = 0.003f + 0.997f * v * v, alpha = roughness * roughness;
        float eta = 0.35f + 2.65f * x;
        albedo_node row = albedo_roughness_node(roughness);
        double a = (double)alpha, full = albedo(FULL, (double)mu, a, 1), schlick = albedo(SCHLICK, (double)mu, a, 1);
        double off = (double)albedo_full(mu, alpha, row) - full;
        double off_schlick = (double)fresnel_schlick_weight(albedo_schlick_cosine(mu, alpha, row)) * full - schlick;
        double off_interface = (double)albedo_interface(albedo_ior_node(eta), mu, alpha, row) -
                               albedo(INTERFACE, (double)mu, a, (double)eta);
        if (!(fabs(off) < 0.003 && fabs(off_schlick) < 0.003 && fabs(off_interface) < 0.003))
            fail_msg("roughness %g, cos %g, eta %g: %.5f, %.5f, %.5f off", (double)roughness, (double)mu, (double)eta, off,
                     off_schlick, off_interface);
    }
}

/* 2 ∫ (1 − E) μ dμ of the look-up itself, evenly over log(μ + alpha/10); ior NULL: of albedo_full. */
static double mean_loss_of_look_ups(const albedo_node *ior, float alpha, albedo_node row) {
    enum { N = 4096 };
    double sum = 0, least = 0.1 * (double)alpha, octaves = log2(1 + 1 / least);
    for (int i = 0; i < N; i++) {
        double shifted = least * exp2((i + 0.5) / N * octaves), mu = shifted - least;
        float e = ior ? albedo_interface(*ior, (float)mu, alpha, row) : albedo_full((float)mu, alpha, row);
        sum += 2 * mu * shifted * octaves * M_LN2 / N * (1 - (double)e);
    }
    return sum;
}

/* To a share of the loss itself, for it is a divisor, also where it is 10⁻⁷; between rows of roughness as well. */
static void mean_losses_are_means(void **state) {
    (void)state;
    for (float roughness = 0.0101f; roughness <= 1; roughness *= 1.043f) {
        albedo_node row = albedo_roughness_node(roughness);
        for (int k = 0; k < 6; k++) {
            float alpha = roughness * roughness, eta = (const float[]){0, 1.5f, 1 / 1.5f, 3, 1.1f, 1 / 1.1f}[k];
            albedo_node ior = albedo_ior_node(eta);
            double said = (double)(k ? albedo_interface_mean_loss(ior, row) : albedo_full_mean_loss(row));
            double mean = mean_loss_of_look_ups(k ? &ior : NULL, alpha, row);
            if (fabs(said / mean - 1) > 0.025)
                fail_msg("roughness %g, eta %g: said to be %g, look-ups' is %g", (double)roughness, (double)eta, said, mean);
        }
    }
}

/* At a slice's η a look-up gives the slice; between two it lies on the line; beyond the ends it is the end's. */
static void slices_interpolate(void **state) {
    (void)state;
    albedo_node row = {3, 0.0f};
    float alpha = (float)albedo_row_alpha(3), mu = (float)column_mu(5, (double)alpha);
    for (int k = 0; k + 1 < ALBEDO_IORS; k++) {
        double s = 2 * (k + 0.5) / (ALBEDO_IORS - 1) - 1, x = (double)ALBEDO_X_MAX * s * fabs(s);
        float at = albedo_interface(albedo_ior_node((float)slice_eta(k)), mu, alpha, row);
        float between = albedo_interface(albedo_ior_node((float)((1 + x) / (1 - x))), mu, alpha, row);
        const float *a = albedo_interface_table + k * ALBEDO_SLICE + 3 * ALBEDO_COSINES + 5, *b = a + ALBEDO_SLICE;
        if (fabsf(at - *a) > 1e-4f || fabsf(between - 0.5f * (*a + *b)) > 1e-4f)
            fail_msg("slice %d: %g, not %g; between: %g", k, (double)at, (double)*a, (double)between);
    }
    for (int end = 0; end < 2; end++) {
        albedo_node n = albedo_ior_node(end ? 1000.0f : 0.001f);
        assert_true(n.index == (end ? ALBEDO_IORS - 2 : 0) && n.fraction == (float)end);
    }
}

/* No entry creates light; nearly smooth interfaces lose nothing, seen from above. */
static void limits_are_known(void **state) {
    (void)state;
    for (int i = 0; i < ALBEDO_SLICE; i++) assert_true(albedo_full_table[i] > 0 && albedo_full_table[i] <= 1);
    for (int i = 0; i < ALBEDO_SLICE * ALBEDO_IORS; i++)
        assert_true(albedo_interface_table[i] > 0 && albedo_interface_table[i] <= 1);
    for (int k = 0; k < ALBEDO_IORS; k++)
        for (int j = 0; j < 2; j++)
            assert_true(albedo_interface_table[k * ALBEDO_SLICE + (j + 1) * ALBEDO_COSINES - 1] > 0.998f);
    assert_true(albedo_full(1, 0, albedo_roughness_node(0)) > 0.9999f);
    assert_true(albedo_full(0, 0, albedo_roughness_node(0)) > 0.9997f);
    /* What lies outside of the tables counts as their edge. */
    assert_true(albedo_roughness_node(-1).index == 0 && albedo_roughness_node(-1).fraction == 0);
    assert_true(albedo_roughness_node(7).index == ALBEDO_ROUGHNESS - 2 && albedo_roughness_node(7).fraction == 1);
    assert_true(albedo_roughness_node(NAN).index == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(entries_are_the_generators), cmocka_unit_test(look_ups_meet_the_nodes),
        cmocka_unit_test(look_ups_between_are_near),  cmocka_unit_test(mean_losses_are_means),
        cmocka_unit_test(slices_interpolate),         cmocka_unit_test(limits_are_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
