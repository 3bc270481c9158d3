#include "tests/color/support.h"

#include "color/gamut.h"

static kiln_decoding decoding_of(const char *config, const char *working_space) {
    kiln_color *color = color_of(config, working_space);
    kiln_report *report = kiln_report_create();
    kiln_decoding decoding;
    assert_true(kiln_color_working_space(color, &decoding, report));
    assert_true(decoding.present);
    kiln_report_destroy(report);
    kiln_color_destroy(color);
    return decoding;
}

static void assert_matrix(const float *m, const double *expected, double tolerance) {
    for (int k = 0; k < 9; k++)
        if (!(fabs((double)m[k] - expected[k]) <= tolerance))
            fail_msg("element %d: %.9g is not %.9g", k, (double)m[k], expected[k]);
}

static const double identity[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static void curves_are_those_of_the_transfers(void **state) {
    (void)state;
    kiln_decoding d = decoding_of(NULL, NULL);
    for (int code = 0; code < 256; code++) {
        assert_true(fabs((double)d.curve[KILN_TRANSFER_SRGB][code] - srgb_decode(code / 255.0)) <= 1e-6);
        assert_true(d.curve[KILN_TRANSFER_DATA][code] == (float)code / 255);
        assert_true(d.curve[KILN_TRANSFER_LINEAR][code] == (float)code / 255);
    }
    assert_true(d.curve[KILN_TRANSFER_SRGB][0] == 0);
    for (int t = 0; t < KILN_TRANSFER_COUNT; t++)
        for (int k = 0; k < 9; k++) assert_true(d.matrix[t][k] == (float)identity[k]);
}

static void xyz_of_white(const double *xy, double xyz[3]) {
    xyz[0] = xy[0] / xy[1], xyz[1] = 1, xyz[2] = (1 - xy[0] - xy[1]) / xy[1];
}

static void transform(const double m[9], const double v[3], double out[3]) {
    for (int row = 0; row < 3; row++) out[row] = m[3 * row] * v[0] + m[3 * row + 1] * v[1] + m[3 * row + 2] * v[2];
}

/* XYZ of one white to XYZ of another: cone responses are scaled (Bradford, in CIECAM97s; Lindbloom's numbers). */
static void bradford(const double *from_xy, const double *to_xy, double m[9]) {
    const double cone[] = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
    double xyz[3], from[3], to[3], inverse[9], scaled[9];
    xyz_of_white(from_xy, xyz);
    transform(cone, xyz, from);
    xyz_of_white(to_xy, xyz);
    transform(cone, xyz, to);
    for (int k = 0; k < 9; k++) scaled[k] = cone[k] * to[k / 3] / from[k / 3];
    assert_true(matrix3_invert(cone, inverse));
    matrix3_multiply(inverse, scaled, m);
}

/* Linear Rec.709 → XYZ → XYZ of the other white → RGB of the other primaries. */
static void expected_matrix(const char *space, double m[9]) {
    const color_gamut *from = gamut_find("lin_rec709"), *to = gamut_find(space);
    double to_xyz[9], out_xyz[9], from_xyz[9], adapt[9], adapted[9];
    gamut_to_xyz(from, to_xyz);
    gamut_to_xyz(to, out_xyz);
    assert_true(matrix3_invert(out_xyz, from_xyz));
    bradford(from->xy + 6, to->xy + 6, adapt);
    matrix3_multiply(adapt, to_xyz, adapted);
    matrix3_multiply(from_xyz, adapted, m);
}

static void matrices_follow_from_primaries(void **state) {
    (void)state;
    const char *const spaces[] = {"lin_rec709",  "ACEScg",  "ACES2065-1",  "lin_p3d65",
                                  "lin_rec2020", "lin_ap1", "scene_linear"};
    const char *const same[] = {"lin_rec709",  "ACEScg", "ACES2065-1", "lin_p3d65",
                                "lin_rec2020", "ACEScg", "lin_rec709"};
    for (size_t i = 0; i < sizeof spaces / sizeof *spaces; i++) {
        double m[9];
        expected_matrix(same[i], m);
        kiln_decoding d = decoding_of(NULL, spaces[i]);
        assert_matrix(d.matrix[KILN_TRANSFER_SRGB], m, 1e-6);
        assert_matrix(d.matrix[KILN_TRANSFER_LINEAR], m, 1e-6);
        assert_matrix(d.matrix[KILN_TRANSFER_DATA], identity, 0);
    }
}

static void user_configs(void **state) {
    (void)state;
    double m[9];
    /* By the config's own name for a space, here through aces_interchange, since linear Rec.709 is kiln's. */
    expected_matrix("ACEScg", m);
    assert_matrix(decoding_of(DATA "studio.ocio", "rendering space").matrix[KILN_TRANSFER_SRGB], m, 2e-6);
    assert_matrix(decoding_of(DATA "studio.ocio", "scene_linear").matrix[KILN_TRANSFER_SRGB], m, 2e-6);
    /* By kiln's names, which the config does not have. */
    assert_matrix(decoding_of(DATA "studio.ocio", "ACEScg").matrix[KILN_TRANSFER_SRGB], m, 2e-6);
    assert_matrix(decoding_of(DATA "studio.ocio", NULL).matrix[KILN_TRANSFER_SRGB], identity, 1e-6);
    /* A config of version 1, without aliases and interchange roles. */
    assert_matrix(decoding_of(DATA "old.ocio", NULL).matrix[KILN_TRANSFER_SRGB], identity, 0);
    assert_matrix(decoding_of(DATA "old.ocio", "ACES - ACEScg").matrix[KILN_TRANSFER_SRGB], m, 1e-3);
    /* A space of the studio's own. */
    expected_matrix("ACES2065-1", m);
    for (int k = 0; k < 9; k++) m[k] /= 2;
    assert_matrix(decoding_of(DATA "studio.ocio", "twice as dark").matrix[KILN_TRANSFER_SRGB], m, 2e-6);
}

static void chromaticities_of_known_spaces(void **state) {
    (void)state;
    const char *const cases[][3] = {{NULL, NULL, "lin_rec709"},
                                    {NULL, "lin_ap1", "ACEScg"},
                                    {NULL, "ACES2065-1", "ACES2065-1"},
                                    {NULL, "lin_p3d65", "lin_p3d65"},
                                    {DATA "studio.ocio", NULL, "lin_rec709"},
                                    {DATA "studio.ocio", "rendering space", "ACEScg"},
                                    {DATA "old.ocio", "ACES - ACEScg", "ACEScg"}};
    float xy[8];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_color *color = color_of(cases[i][0], cases[i][1]);
        assert_true(kiln_color_chromaticities(color, xy));
        for (int k = 0; k < 8; k++) assert_true(xy[k] == (float)gamut_find(cases[i][2])->xy[k]);
        kiln_color_destroy(color);
    }
    kiln_color *color = color_of(DATA "studio.ocio", "half");
    assert_false(kiln_color_chromaticities(color, xy));
    kiln_color_destroy(color);
}

int main(void) {
    unsetenv("OCIO");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(curves_are_those_of_the_transfers),
        cmocka_unit_test(matrices_follow_from_primaries),
        cmocka_unit_test(user_configs),
        cmocka_unit_test(chromaticities_of_known_spaces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
