/* The colours of single wavelengths, in any working space. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "render/world/spectrum.h"

static const float identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
/* Linear Rec.709 to ACEScg, rounded. */
static const float to_acescg[9] = {0.6131f, 0.3395f, 0.0474f, 0.0702f, 0.9164f, 0.0134f, 0.0206f, 0.1096f, 0.8698f};

/* All wavelengths together are white, none takes light away, and neighbours differ little: no bands. */
static void wavelengths_are_white_together(void **state) {
    (void)state;
    const float *spaces[] = {identity, to_acescg};
    for (int s = 0; s < 2; s++) {
        float table[SPECTRUM_FLOATS];
        spectrum_make(spaces[s], table);
        double sum[3] = {0, 0, 0}, before = 400;
        enum { DRAWS = 1 << 16 };
        for (int i = 0; i < DRAWS; i++) {
            spectrum_line l = spectrum_draw(table, ((float)i + 0.5f) / DRAWS);
            assert_true((double)l.wavelength >= before && l.wavelength <= 680);
            assert_true(l.weight.x >= 0 && l.weight.y >= 0 && l.weight.z >= 0);
            assert_true(fabs((double)(l.weight.x + l.weight.y + l.weight.z) - 3) < 0.02);
            sum[0] += (double)l.weight.x, sum[1] += (double)l.weight.y, sum[2] += (double)l.weight.z;
            before = (double)l.wavelength;
        }
        for (int k = 0; k < 3; k++) assert_true(fabs(sum[k] / DRAWS - 1) < 2e-5);
        for (int i = 0; i < SPECTRUM_STEPS; i++)
            for (int k = 1; k < 4; k++) assert_true(fabsf(table[4 * i + 4 + k] - table[4 * i + k]) < 0.3f);
        assert_true(table[1] + table[3] > 2.9f && table[4 * SPECTRUM_STEPS + 1] > 2.5f); /* violet, red */
    }
}

/* What each channel sees of them lies where its colour does in the spectrum. */
static void channels_see_their_colours(void **state) {
    (void)state;
    enum { DRAWS = 4096 };
    static const double low[3] = {590, 520, 440}, high[3] = {625, 560, 475};
    float table[SPECTRUM_FLOATS];
    double middle[3] = {0, 0, 0};
    spectrum_make(identity, table);
    for (int i = 0; i < DRAWS; i++) {
        spectrum_line l = spectrum_draw(table, ((float)i + 0.5f) / DRAWS);
        double nm = (double)l.wavelength / DRAWS;
        middle[0] += nm * (double)l.weight.x, middle[1] += nm * (double)l.weight.y, middle[2] += nm * (double)l.weight.z;
    }
    for (int k = 0; k < 3; k++)
        if (!(middle[k] > low[k] && middle[k] < high[k])) fail_msg("channel %d sees %.1f nm", k, middle[k]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wavelengths_are_white_together),
        cmocka_unit_test(channels_see_their_colours),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
