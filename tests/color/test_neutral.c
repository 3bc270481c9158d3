#include "tests/color/support.h"

#include "color/neutral.h"

static void apply(float r, float g, float b, float out[3]) {
    out[0] = r, out[1] = g, out[2] = b;
    neutral_apply(out, 1);
}

static void assert_color(const float *c, double r, double g, double b) {
    if (fabs((double)c[0] - r) > 1e-6 || fabs((double)c[1] - g) > 1e-6 || fabs((double)c[2] - b) > 1e-6)
        fail_msg("(%.9g %.9g %.9g) is not (%.9g %.9g %.9g)", (double)c[0], (double)c[1], (double)c[2], r, g, b);
}

/* Worked by hand from Khronos' text. */
static void closed_forms(void **state) {
    (void)state;
    float c[3];
    apply(0, 0, 0, c);
    assert_color(c, 0, 0, 0);
    apply(0.5f, 0.3f, 0.2f, c); /* not compressed: less 0.04 */
    assert_color(c, 0.46, 0.26, 0.16);
    apply(0.5f, 0.3f, 0.04f, c); /* offset 0.04 − 6.25 · 0.0016 = 0.03 */
    assert_color(c, 0.47, 0.27, 0.01);
    apply(0.8f, 0.8f, 0.8f, c); /* peak 0.76: where compression starts */
    assert_color(c, 0.76, 0.76, 0.76);
    /* Grey 1.04: peak 1, 1 − 0.0576 / 0.48 = 0.88. */
    apply(1.04f, 1.04f, 1.04f, c);
    assert_color(c, 0.88, 0.88, 0.88);
    /* Red 1: peak 1 → 0.88; grey share 1 − 1 / (0.15 · 0.12 + 1). */
    apply(1, 0, 0, c);
    assert_color(c, 0.88, 0.88 * (1 - 1 / 1.018), 0.88 * (1 - 1 / 1.018));
    apply(-5, 1, 0, c); /* negative counts as 0 */
    assert_color(c, 0.88 * (1 - 1 / 1.018), 0.88, 0.88 * (1 - 1 / 1.018));
}

/* Brighter stays brighter, hue stays, nothing leaves [0, 1], from 1e-6 to the largest half float. */
static void keeps_order_and_hue(void **state) {
    (void)state;
    const float colors[][3] = {{1, 1, 1}, {1, 0, 0}, {0, 1, 0.5f}, {0.2f, 0.9f, 1}, {1, 0.98f, 0.97f}};
    for (size_t i = 0; i < sizeof colors / sizeof *colors; i++) {
        const float *d = colors[i];
        float before = 0, c[3];
        for (double s = 1e-6; s < 65504; s *= 1.02) {
            apply((float)s * d[0], (float)s * d[1], (float)s * d[2], c);
            float peak = fmaxf(c[0], fmaxf(c[1], c[2])), least = fminf(c[0], fminf(c[1], c[2]));
            assert_true(least >= -1e-7f && peak <= 1 && peak >= before - 1e-7f);
            before = peak;
            /* Where the middle channel lies between the others does not change. */
            for (int k = 0; k < 3 && peak - least > 1e-3f && s < 8; k++) {
                double hue = ((double)d[k] - fmin(d[0], fmin(d[1], d[2]))) /
                             (fmax(d[0], fmax(d[1], d[2])) - fmin(d[0], fmin(d[1], d[2])));
                assert_true(fabs((double)((c[k] - least) / (peak - least)) - hue) < 2e-3);
            }
        }
        assert_true(before > 0.999f);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(closed_forms), cmocka_unit_test(keeps_order_and_hue)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
