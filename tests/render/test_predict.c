/* What the first samples let expect of a render: closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "render/predict.h"

/* 16 samples in 4 seconds, 8 % of error. */
static const predict_pilot even = {16, 4, 0.08, 1};

static void close_to(double value, double expected) {
    if (fabs(value - expected) > 1e-9 * expected) fail_msg("%.12g instead of %.12g", value, expected);
}

static void samples_end_it(void **state) {
    (void)state;
    kiln_prediction p = predict(&even, &(kiln_render_options){.spp = 256}, 256);
    assert_int_equal(p.spp, 16);
    close_to(p.seconds, 64);
    close_to(p.error, 0.08 / 4);
    assert_true(p.noise_seconds < 0);
}

/* 2 % needs 16 times the samples, 3 % 7.1 times, which is looked at after 8 times. */
static void noise_ends_it(void **state) {
    (void)state;
    kiln_prediction two = predict(&even, &(kiln_render_options){.noise = 0.02}, UINT32_MAX);
    close_to(two.seconds, 64);
    close_to(two.noise_seconds, 64);
    close_to(two.error, 0.02);
    kiln_prediction three = predict(&even, &(kiln_render_options){.noise = 0.03}, UINT32_MAX);
    close_to(three.seconds, 32);
    close_to(three.error, 0.08 / sqrt(8));
    kiln_prediction done = predict(&even, &(kiln_render_options){.noise = 0.1}, UINT32_MAX);
    close_to(done.seconds, 4);
    close_to(done.error, 0.08);
}

static void the_first_rule_ends_it(void **state) {
    (void)state;
    kiln_prediction p = predict(&even, &(kiln_render_options){.noise = 0.01, .budget_seconds = 36, .spp = 1024}, 1024);
    close_to(p.seconds, 36);
    close_to(p.error, 0.08 / 3);
    close_to(p.noise_seconds, 256);
    p = predict(&even, &(kiln_render_options){.noise = 0.01, .budget_seconds = 36, .spp = 64}, 64);
    close_to(p.seconds, 16);
    close_to(p.error, 0.04);
}

/* Samples that go where they are needed: a quarter of relMSE at as many, so a quarter of the samples. */
static void adaptive_samples_are_worth_more(void **state) {
    (void)state;
    predict_pilot pilot = even;
    pilot.gain = 0.25;
    kiln_prediction p = predict(&pilot, &(kiln_render_options){.noise = 0.01, .budget_seconds = 16}, UINT32_MAX);
    close_to(p.noise_seconds, 64);
    close_to(p.seconds, 16);
    close_to(p.error, 0.02);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_end_it),
        cmocka_unit_test(noise_ends_it),
        cmocka_unit_test(the_first_rule_ends_it),
        cmocka_unit_test(adaptive_samples_are_worth_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
