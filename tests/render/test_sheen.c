/* The sheen lobe against its specification in double precision, its sampling, and its albedo table. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

int generate(void);
#define main generate
#include "tools/make_albedo_tables.c"
#undef main

#include "tests/render/statistics.h"

static const float roughnesses[] = {0.04f, 0.05f, 0.07f, 0.1f, 0.19f, 0.27f, 0.28f, 0.3f, 0.5f, 0.73f, 1};
static const float cosines[] = {1, 0.7f, 0.4f, 0.15f, 0.05f, 0.01f, 1e-3f, 1e-4f, 1e-6f, 1e-12f};
enum { ROUGHNESSES = sizeof roughnesses / sizeof *roughnesses, COSINES = sizeof cosines / sizeof *cosines };

static vec3 at_cosine(float cosine) { return v3(sqrtf(1 - cosine * cosine), 0, cosine); }

/* f cos of wo and wi, as KHR_materials_sheen writes it, within the bounds that sheen.h states. */
static double specified(vec3 wo, vec3 wi, double roughness) {
    double alpha = roughness * roughness, zo = (double)wo.z, zi = (double)wi.z;
    dir h = unit((dir){(double)wo.x + (double)wi.x, (double)wo.y + (double)wi.y, zo + zi});
    double d = (2 + 1 / alpha) * pow(1 - h.z * h.z, 0.5 / alpha) / (2 * M_PI), co = fmax(zo, 1e-4), ci = fmax(zi, 1e-4);
    double v = 1 / ((1 + sheen_big_lambda(co, alpha) + sheen_big_lambda(ci, alpha)) * (4 * co * ci));
    return d * v * zi * fmin(roughness / 0.28, 1);
}

static void values_are_the_specifications(void **state) {
    (void)state;
    stream random = {21, 0};
    for (int r = 0; r < ROUGHNESSES; r++)
        for (int k = 0; k < COSINES; k++)
            for (int n = 0; n < 200; n++) {
                vec3 wo = at_cosine(cosines[k]), wi = sheen_sample(stream_pair(&random), roughnesses[r]);
                double value = (double)sheen_value(wo, wi, roughnesses[r]);
                double wanted = specified(wo, wi, (double)roughnesses[r]);
                /* What float directions leave of a power as high as 1/(2 alpha). */
                double tolerance = 2e-5 + 3e-7 / (double)(roughnesses[r] * roughnesses[r]);
                if (fabs(value - wanted) > tolerance * fmax(wanted, 1e-3))
                    fail_msg("roughness %g, cos %g, %g: %g instead of %g", (double)roughnesses[r], (double)wo.z,
                             (double)wi.z, value, wanted);
                double back = (double)sheen_value(wi, wo, roughnesses[r]) * (double)wi.z, there = value * (double)wo.z;
                assert_true(fabs(back - there) <= 1e-5 * there + 1e-30);
            }
}

/* Elevations have the density that pdf says, azimuths are even, and no sample weighs much. */
static void samples_have_their_density(void **state) {
    (void)state;
    enum { CELLS = 64, N = 20000 };
    stream random = {22, 0};
    for (int r = 0; r < ROUGHNESSES; r++) {
        double counts[CELLS] = {0}, expected[CELLS] = {0}, s = (double)SHEEN_SPREAD * (double)roughnesses[r];
        for (int i = 0; i < CELLS; i++) {
            double low = (i / 4) / 16.0, high = low + 1 / 16.0; /* 16 bands of elevation by 4 of azimuth */
            for (int k = 0; k < 256; k++) {
                vec3 wi = v3(0, 0, (float)(low + (k + 0.5) / 256 * (high - low)));
                expected[i] += N * (double)sheen_pdf(wi, roughnesses[r]) * 2 * M_PI / 4 * (high - low) / 256;
            }
        }
        for (int n = 0; n < N; n++) {
            vec3 wi = sheen_sample(stream_pair(&random), roughnesses[r]);
            assert_true(fabsf(v3_length(wi) - 1) < 1e-5f && wi.z >= 0);
            double turn = atan2((double)wi.y, (double)wi.x) / (2 * M_PI);
            int band = (int)((double)wi.z * 16), sector = (int)(4 * (turn - floor(turn)));
            counts[(band < 15 ? band : 15) * 4 + (sector < 3 ? sector : 3)]++;
            for (int k = 0; k < COSINES; k++) {
                float value = sheen_value(at_cosine(cosines[k]), wi, roughnesses[r]);
                assert_true(value <= 3 * sheen_pdf(wi, roughnesses[r]));
            }
        }
        double p = chi_square_p(counts, expected, CELLS);
        if (!(p > sidak(1e-4, ROUGHNESSES))) fail_msg("roughness %g, s %g: p %g", (double)roughnesses[r], s, p);
    }
}

/* The table's look-ups, the lobe's own integral, and what no lobe may exceed. */
static void albedos_are_the_lobes(void **state) {
    (void)state;
    for (int r = 0; r < ROUGHNESSES; r++)
        for (int k = 0; k < COSINES; k++) {
            enum { N = 256, M = 64 };
            vec3 wo = at_cosine(cosines[k]);
            double sum = 0, said = (double)albedo_sheen(cosines[k], albedo_sheen_node(roughnesses[r]));
            for (int i = 0; i < N * M; i++) {
                vec2 u = {((float)(i / M) + 0.5f) / N, ((float)(i % M) + 0.5f) / M};
                vec3 wi = sheen_sample(u, roughnesses[r]);
                sum += (double)sheen_value(wo, wi, roughnesses[r]) / (double)sheen_pdf(wi, roughnesses[r]) / (N * M);
            }
            double tolerance = cosines[k] > 2e-4f ? 0.004 : 0.009; /* SHEEN_COS_MIN is a kink between columns */
            if (!(sum <= 1) || fabs(sum - said) > tolerance)
                fail_msg("roughness %g, cos %g: albedo %.5f, table %.5f", (double)roughnesses[r], (double)cosines[k], sum,
                         said);
        }
    for (int i = 0; i < ALBEDO_SHEEN * ALBEDO_SHEEN_ROUGHNESS; i++)
        assert_true(albedo_sheen_table[i] >= 0 && albedo_sheen_table[i] < 1);
    for (int n = 0; n < 40; n++) { /* entries as their generator makes them */
        int i = n * 7 % ALBEDO_SHEEN, j = n % ALBEDO_SHEEN_ROUGHNESS;
        double roughness = sheen_row_roughness(j), mu = sheen_mu((double)i / (ALBEDO_SHEEN - 1), roughness);
        assert_true(fabs((double)albedo_sheen_table[j * ALBEDO_SHEEN + i] - sheen_albedo(mu, roughness)) < 0.6e-5);
        assert_true(fabs((double)(albedo_sheen((float)mu, albedo_sheen_node((float)roughness)) -
                                  albedo_sheen_table[j * ALBEDO_SHEEN + i])) < 1e-4);
    }
}

static void means_are_means(void **state) {
    (void)state;
    for (int r = 0; r < ROUGHNESSES; r++) {
        albedo_node row = albedo_sheen_node(roughnesses[r]);
        double sum = 0;
        for (int i = 0; i < 4096; i++) {
            double t = (i + 0.5) / 4096;
            sum += 4 * t * t * t / 4096 * (double)albedo_sheen((float)(t * t), row);
        }
        if (fabs(sum - (double)albedo_sheen_mean(row)) > 1.5e-3)
            fail_msg("roughness %g: mean %g, of look-ups %g", (double)roughnesses[r], (double)albedo_sheen_mean(row),
                     sum);
    }
}

/* Any roughness and any direction, NaN roughness too, give a finite lobe. */
static void everything_is_finite(void **state) {
    (void)state;
    const float asked[] = {-1, 0, 0.5f, 1, 2, NAN};
    for (size_t r = 0; r < sizeof asked / sizeof *asked; r++)
        for (int k = 0; k < COSINES; k++)
            for (int n = 0; n < 64; n++) {
                float roughness = sheen_roughness(asked[r]);
                vec2 u = {(float)(n % 8) / 7 * 0x1.fffffep-1f, (float)(n / 8) / 7 * 0x1.fffffep-1f};
                vec3 wo = at_cosine(cosines[k]), wi = sheen_sample(u, roughness), away = v3_scale(wi, -1);
                float value = sheen_value(wo, wi, roughness), pdf = sheen_pdf(wi, roughness);
                assert_true(isfinite(value) && value >= 0 && isfinite(pdf) && pdf >= 0);
                assert_true(sheen_value(wo, away, roughness) == 0 && sheen_pdf(away, roughness) == 0);
                vec3 up = v3(0, 0, 1); /* D is 0 there */
                assert_true(sheen_value(wo, wo, roughness) >= 0 && sheen_value(up, up, roughness) == 0);
                assert_true(isfinite(albedo_sheen(cosines[k], albedo_sheen_node(asked[r]))));
            }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_the_specifications), cmocka_unit_test(samples_have_their_density),
        cmocka_unit_test(albedos_are_the_lobes),         cmocka_unit_test(means_are_means),
        cmocka_unit_test(everything_is_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
