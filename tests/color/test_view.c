#include "tests/color/support.h"

#include <locale.h>

#include "base/threads.h"
#include "tests/color/views_table.h"

static const char neutral[] = "Khronos PBR Neutral", aces[] = "ACES 1.0 - SDR Video", plain[] = "Un-tone-mapped";
static const char *const displays[] = {"sRGB", "Rec.1886", "Display P3"};
static const char *const views[] = {neutral, aces, plain, "Raw"};

static double clamp01(double x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

static void assert_color(const float *c, double r, double g, double b, double tolerance) {
    if (!(fabs((double)c[0] - r) <= tolerance && fabs((double)c[1] - g) <= tolerance &&
          fabs((double)c[2] - b) <= tolerance))
        fail_msg("(%.9g %.9g %.9g) is not (%.9g %.9g %.9g)", (double)c[0], (double)c[1], (double)c[2], r, g, b);
}

static void show(const kiln_view *view, const float *rgb, float out[3]) {
    memcpy(out, rgb, 3 * sizeof *out);
    kiln_view_apply(view, out, 1, 3);
}

/* Log-uniform over [1e-4, 100], a third of the channels 0: what a renderer makes, and saturated. */
static void make_colors(float *rgb, size_t count) {
    uint32_t random = 7;
    for (size_t i = 0; i < 3 * count; i++) {
        random = random * 1664525u + 1013904223u;
        double u = (random >> 8) * 0x1p-24;
        rgb[i] = u < 1.0 / 3 ? 0 : (float)pow(10, 9 * (u - 1.0 / 3) - 4);
    }
}

static void agrees_with_opencolorio(void **state) {
    (void)state;
    kiln_color *color = color_of(NULL, NULL);
    for (size_t row = 0; row < views_row_count; row++) {
        kiln_view *view = view_of(color, views_rows[row].display, views_rows[row].view, NULL, 0);
        for (size_t i = 0; i < views_color_count; i++) {
            const float *e = views_rows[row].expected[i];
            float c[3];
            show(view, views_colors[i], c);
            assert_color(c, (double)e[0], (double)e[1], (double)e[2], 2e-4);
        }
        kiln_view_destroy(view);
    }
    kiln_color_destroy(color);
}

/* OpenColorIO joins the line and the power of sRGB where their slopes agree (12.9232, up to 0.0030399), the standard
 * rounds (12.92, up to 0.0031308): never more than 1.1e-5 apart. */
static const double srgb_rounding = 1.2e-5;

static void plain_views_in_closed_form(void **state) {
    (void)state;
    enum { COUNT = 4096 };
    float *colors = calloc(3 * COUNT, sizeof *colors), c[3];
    make_colors(colors, COUNT);
    kiln_color *color = color_of(NULL, NULL);
    kiln_view *srgb = view_of(color, "sRGB", plain, NULL, 0), *video = view_of(color, "Rec.1886", plain, NULL, 0),
              *raw = view_of(color, "sRGB", "Raw", NULL, 0);
    for (int i = 0; i < COUNT; i++) {
        double x[3], e[3];
        for (int k = 0; k < 3; k++) x[k] = clamp01((double)colors[3 * i + k]);
        for (int k = 0; k < 3; k++) e[k] = srgb_encode(x[k]);
        show(srgb, colors + 3 * i, c);
        assert_color(c, e[0], e[1], e[2], srgb_rounding);
        show(video, colors + 3 * i, c); /* ITU-R BT.1886 with black at 0: a power of 2.4 */
        for (int k = 0; k < 3; k++) e[k] = pow(x[k], 1 / 2.4);
        assert_color(c, e[0], e[1], e[2], 1e-5);
        show(raw, colors + 3 * i, c);
        assert_color(c, x[0], x[1], x[2], 0);
    }
    kiln_view_destroy(srgb);
    kiln_view_destroy(video);
    kiln_view_destroy(raw);
    kiln_color_destroy(color);
    free(colors);
}

/* What a P3 display shows is the colour that was asked for: decoded and taken back by the primaries' own matrices. */
static void display_p3_round_trip(void **state) {
    (void)state;
    const double p3_to_709[9] = {1.2249401763, -0.2249401763, 0, -0.0420569547, 1.0420569547, 0,
                                 -0.0196375546, -0.0786360456, 1.0982736001}; /* from the primaries, D65 both */
    kiln_color *color = color_of(NULL, NULL);
    kiln_view *view = view_of(color, "Display P3", plain, NULL, 0);
    uint32_t random = 3;
    for (int i = 0; i < 2000; i++) {
        float in[3], c[3];
        double linear[3], back[3];
        for (int k = 0; k < 3; k++) {
            random = random * 1664525u + 1013904223u;
            in[k] = (float)(random >> 8) * 0x1p-24f;
        }
        show(view, in, c);
        for (int k = 0; k < 3; k++) linear[k] = srgb_decode((double)c[k]);
        for (int row = 0; row < 3; row++)
            back[row] = p3_to_709[3 * row] * linear[0] + p3_to_709[3 * row + 1] * linear[1] +
                        p3_to_709[3 * row + 2] * linear[2];
        assert_color(in, back[0], back[1], back[2], 1e-5);
    }
    assert_false(kiln_view_is_srgb(view));
    kiln_view_destroy(view);
    kiln_color_destroy(color);
}

/* Khronos' text in double, independent of color/neutral.c's form. */
static void neutral_formula(const double in[3], double out[3]) {
    double x = fmin(in[0], fmin(in[1], in[2])), offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
    double c[3] = {in[0] - offset, in[1] - offset, in[2] - offset}, peak = fmax(c[0], fmax(c[1], c[2]));
    memcpy(out, c, sizeof c);
    if (peak < 0.76) return;
    double next = 1 - 0.24 * 0.24 / (peak + 0.24 - 0.76), g = 1 - 1 / (0.15 * (peak - next) + 1);
    for (int k = 0; k < 3; k++) out[k] = c[k] * next / peak * (1 - g) + next * g;
}

static void neutral_is_khronos_formula(void **state) {
    (void)state;
    enum { COUNT = 20000 };
    float *colors = calloc(3 * COUNT, sizeof *colors), c[3];
    make_colors(colors, COUNT);
    kiln_color *color = color_of(NULL, NULL);
    kiln_view *view = view_of(color, NULL, NULL, NULL, 0); /* the default */
    assert_string_equal(kiln_view_describe(view), "display sRGB, view Khronos PBR Neutral, exposure +0");
    for (int i = 0; i < COUNT; i++) {
        double e[3], in[3] = {(double)colors[3 * i], (double)colors[3 * i + 1], (double)colors[3 * i + 2]};
        neutral_formula(in, e);
        show(view, colors + 3 * i, c);
        assert_color(c, srgb_encode(e[0]), srgb_encode(e[1]), srgb_encode(e[2]), srgb_rounding);
    }
    kiln_view_destroy(view);
    kiln_color_destroy(color);
    free(colors);
}

/* The picture does not depend on the space that it was rendered in. */
static void working_space_makes_no_difference(void **state) {
    (void)state;
    enum { COUNT = 500 };
    float colors[3 * COUNT], a[3], b[3];
    make_colors(colors, COUNT);
    kiln_color *rec709 = color_of(NULL, NULL), *acescg = color_of(NULL, "ACEScg");
    kiln_report *report = kiln_report_create();
    kiln_decoding decoding;
    assert_true(kiln_color_working_space(acescg, &decoding, report));
    const float *m = decoding.matrix[KILN_TRANSFER_LINEAR];
    for (size_t v = 0; v < 3; v++) {
        kiln_view *from709 = view_of(rec709, "sRGB", views[v], NULL, 0);
        kiln_view *from_ap1 = view_of(acescg, "sRGB", views[v], NULL, 0);
        for (int i = 0; i < COUNT; i++) {
            const float *x = colors + 3 * i;
            float ap1[3];
            for (int row = 0; row < 3; row++)
                ap1[row] = m[3 * row] * x[0] + m[3 * row + 1] * x[1] + m[3 * row + 2] * x[2];
            show(from709, x, a);
            show(from_ap1, ap1, b);
            /* 1e-7 of the largest channel is 1e-5 of 100; encoded, near black, times 12.92. */
            assert_color(b, (double)a[0], (double)a[1], (double)a[2], 5e-4);
        }
        kiln_view_destroy(from709);
        kiln_view_destroy(from_ap1);
    }
    kiln_report_destroy(report);
    kiln_color_destroy(rec709);
    kiln_color_destroy(acescg);
}

/* Every triple of bad values, and of the values around the end of half floats. */
static void survive(const kiln_view *view) {
    static const float evil[] = {NAN, INFINITY, -INFINITY, 1e38f, -1e38f, 65504, 65510, 65519, 65536, -1, 1e-45f, 0};
    const size_t count = sizeof evil / sizeof *evil;
    for (size_t i = 0; i < count * count * count; i++) {
        const float in[] = {evil[i % count], evil[i / count % count], evil[i / count / count]};
        float c[3];
        show(view, in, c);
        for (int k = 0; k < 3; k++) assert_true(c[k] >= 0 && c[k] <= 1);
    }
}

static void survive_everywhere(const kiln_color *color) {
    const char *display, *name;
    for (size_t d = 0; (display = kiln_color_display(color, d)); d++)
        for (size_t v = 0; (name = kiln_color_view(color, display, v)); v++) {
            if (strcmp(name, "Lost") == 0) continue; /* its LUT is missing */
            for (double exposure = -64; exposure <= 64; exposure += 64) {
                kiln_view *view = view_of(color, display, name, NULL, exposure);
                survive(view);
                kiln_view_destroy(view);
            }
        }
}

static void hostile_pixels(void **state) {
    (void)state;
    kiln_color *color = color_of(NULL, NULL), *ap0 = color_of(NULL, "ACES2065-1"),
               *studio = color_of(DATA "studio.ocio", "ACEScg");
    survive_everywhere(color);
    survive_everywhere(ap0);
    survive_everywhere(studio);
    kiln_color_destroy(ap0);
    kiln_color_destroy(studio);
    float c[3];
    kiln_view *raw = view_of(color, "sRGB", "Raw", NULL, 0), *plain_view = view_of(color, "sRGB", plain, NULL, 0),
              *aces_view = view_of(color, "sRGB", aces, NULL, 0);
    show(raw, (const float[]){NAN, INFINITY, -INFINITY}, c);
    assert_color(c, 0, 1, 0, 0);
    show(plain_view, (const float[]){INFINITY, 1e38f, 65536}, c);
    assert_color(c, 1, 1, 1, 1e-6);
    show(aces_view, (const float[]){1e38f, 1e38f, INFINITY}, c); /* not black */
    assert_color(c, 1, 1, 1, 1e-3);
    show(aces_view, (const float[]){NAN, NAN, NAN}, c);
    assert_color(c, 0, 0, 0, 1e-6);
    float e[3]; /* a channel that is NaN counts as 0: the others keep their colour */
    show(aces_view, (const float[]){0, 0.5f, 0.25f}, e);
    show(aces_view, (const float[]){NAN, 0.5f, 0.25f}, c);
    assert_memory_equal(c, e, sizeof e);
    kiln_view_destroy(raw);
    kiln_view_destroy(plain_view);
    kiln_view_destroy(aces_view);
    kiln_color_destroy(color);
}

static void exposure_comes_first(void **state) {
    (void)state;
    kiln_color *color = color_of(NULL, NULL);
    kiln_view *up = view_of(color, "sRGB", plain, NULL, 1.5), *down = view_of(color, "sRGB", plain, NULL, -20);
    float c[3];
    show(up, (const float[]){0.1f, 0.2f, 0}, c);
    assert_color(c, srgb_encode(0.1 * exp2(1.5)), srgb_encode(0.2 * exp2(1.5)), 0, 2e-6);
    show(down, (const float[]){500000, 1e6f, INFINITY}, c); /* daylight in nits, far above the scrubbing limit */
    assert_color(c, srgb_encode(500000 / 1048576.0), srgb_encode(1e6 / 1048576.0), 1, 2e-6);
    assert_string_equal(kiln_view_describe(up), "display sRGB, view Un-tone-mapped, exposure +1.5");
    kiln_view_destroy(up);
    kiln_view_destroy(down);
    kiln_color_destroy(color);
}

static void alpha_is_left_alone(void **state) {
    (void)state;
    kiln_color *color = color_of(NULL, "ACEScg");
    for (size_t v = 0; v < 4; v++) {
        kiln_view *view = view_of(color, "sRGB", views[v], NULL, 1);
        float rgba[] = {0.2f, 0.4f, 3, 0.25f, 0.2f, 0.4f, 3, NAN}, rgb[] = {0.2f, 0.4f, 3};
        kiln_view_apply(view, rgba, 2, 4);
        kiln_view_apply(view, rgb, 1, 3);
        assert_memory_equal(rgba, rgb, sizeof rgb);
        assert_memory_equal(rgba + 4, rgb, sizeof rgb);
        assert_true(rgba[3] == 0.25f && rgba[7] != rgba[7]);
        kiln_view_apply(view, NULL, 0, 4);
        kiln_view_destroy(view);
    }
    kiln_color_destroy(color);
}

static void looks(void **state) {
    (void)state;
    /* The config's looks: warm × (2, 1, 0.5), dark × 0.25, in ACEScg; view Warm has warm of its own. */
    const struct {
        const char *view, *look;
        double scale[3];
    } rows[] = {{"Plain", NULL, {1, 1, 1}},
                {"Plain", "warm", {2, 1, 0.5}},
                {"Warm", NULL, {2, 1, 0.5}},
                {"Warm", "", {1, 1, 1}},
                {"Warm", "dark", {0.25, 0.25, 0.25}},
                {"Plain", "warm, dark", {0.5, 0.25, 0.125}},
                {"Plain", "+warm,-dark", {8, 4, 2}}};
    kiln_color *color = color_of(DATA "studio.ocio", "scene_linear");
    kiln_view *raw709 = view_of(color, "Monitor", "Plain", NULL, 0);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_view *view = view_of(color, "Monitor", rows[i].view, rows[i].look, 0);
        const float in[] = {0.05f, 0.05f, 0.05f};
        float graded[3], a[3], b[3];
        for (int k = 0; k < 3; k++) graded[k] = (float)(0.05 * rows[i].scale[k]);
        show(view, in, a);
        show(raw709, graded, b);
        assert_color(a, (double)b[0], (double)b[1], (double)b[2], 1e-6);
        kiln_view_destroy(view);
    }
    kiln_view *named = view_of(color, "Monitor", "Warm", "", 0);
    assert_string_equal(kiln_view_describe(named), "display Monitor, view Warm, look none, exposure +0");
    assert_true(kiln_view_is_srgb(named));
    kiln_view_destroy(named);
    kiln_view_destroy(raw709);
    kiln_color_destroy(color);
}

static void luts_are_found_through_the_environment(void **state) {
    (void)state;
    kiln_color *color = color_of(DATA "studio.ocio", "ap0"); /* search_path luts/$SHOT, SHOT = sh010 */
    kiln_view *view = view_of(color, "Monitor", "Shot", NULL, 0);
    float c[3];
    show(view, (const float[]){0.25f, 0.5f, 2}, c);
    assert_color(c, 0.75, 0.5, 0, 1e-6);
    kiln_view_destroy(view);
    kiln_color_destroy(color);
}

static void srgb_tag(void **state) {
    (void)state;
    kiln_color *color = color_of(NULL, NULL);
    for (size_t d = 0; d < 3; d++)
        for (size_t v = 0; v < 4; v++) {
            kiln_view *view = view_of(color, displays[d], views[v], NULL, 0);
            assert_int_equal(kiln_view_is_srgb(view), d == 0 && v < 3);
            kiln_view_destroy(view);
        }
    kiln_color_destroy(color);
}

enum { PIXELS = 40000 };
typedef struct job {
    const kiln_view *view;
    float *pixels;
    size_t chunk;
} job;

static void run(void *context, size_t item, uint32_t thread) {
    (void)thread;
    const job *j = context;
    size_t first = item * j->chunk, count = first + j->chunk < PIXELS ? j->chunk : PIXELS - first;
    kiln_view_apply(j->view, j->pixels + 3 * first, count, 3);
}

static void any_division_gives_the_same_bits(void **state) {
    (void)state;
    float *pixels = calloc(3 * PIXELS, sizeof *pixels), *once = calloc(3 * PIXELS, sizeof *once);
    kiln_color *color = color_of(NULL, "ACEScg");
    for (size_t v = 0; v < 3; v++) {
        kiln_view *view = view_of(color, "Display P3", views[v], NULL, 0.25);
        make_colors(once, PIXELS);
        kiln_view_apply(view, once, PIXELS, 3);
        for (size_t chunk = 1; chunk < PIXELS; chunk = 7 * chunk + 6) {
            make_colors(pixels, PIXELS);
            job j = {view, pixels, chunk};
            threads_for(2, (PIXELS + chunk - 1) / chunk, run, &j);
            assert_memory_equal(pixels, once, 3 * PIXELS * sizeof *once);
        }
        kiln_view_destroy(view);
    }
    kiln_color_destroy(color);
    free(pixels);
    free(once);
}

/* A decimal comma changes neither configs, nor LUTs, nor messages. */
static void comma_locale(void **state) {
    (void)state;
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8"};
    bool found = false;
    for (size_t i = 0; i < sizeof names / sizeof *names && !found; i++) found = setlocale(LC_ALL, names[i]) != NULL;
    if (!found) {
        printf("skipped: no locale with a decimal comma\n");
        skip();
    }
    luts_are_found_through_the_environment(state);
    looks(state);
    exposure_comes_first(state);
    agrees_with_opencolorio(state);
    setlocale(LC_ALL, "C");
}

int main(void) {
    unsetenv("OCIO");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_opencolorio),
        cmocka_unit_test(plain_views_in_closed_form),
        cmocka_unit_test(display_p3_round_trip),
        cmocka_unit_test(neutral_is_khronos_formula),
        cmocka_unit_test(working_space_makes_no_difference),
        cmocka_unit_test(hostile_pixels),
        cmocka_unit_test(exposure_comes_first),
        cmocka_unit_test(alpha_is_left_alone),
        cmocka_unit_test(looks),
        cmocka_unit_test(luts_are_found_through_the_environment),
        cmocka_unit_test(srgb_tag),
        cmocka_unit_test(any_division_gives_the_same_bits),
        cmocka_unit_test(comma_locale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
