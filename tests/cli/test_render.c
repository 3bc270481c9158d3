#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <jansson.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include "tests/cli/run.h"

#define SCENE PAIR("roughness_factor_a")

static void the_default_output_is_here_and_named_by_the_asset(void **state) {
    const place *p = *state;
    result r = run(p, "render", SCENE, "--size", "16x12", "--spp", "2");
    assert_int_equal(r.code, 0);
    assert_int_equal(r.out_size, 0);
    assert_non_null(strstr(r.err, "wrote roughness_factor_a.png (16 x 12, "));
    assert_non_null(strstr(r.err, "2 samples per pixel"));
    assert_non_null(strstr(r.err, "ended by --spp 2"));
    assert_int_equal(files_in(p), 1);
    uint32_t width, height, channels;
    free(read_picture(p, "roughness_factor_a.png", &width, &height, &channels));
    assert_true(width == 16 && height == 12 && channels == 3);
    result_free(&r);
}

static void one_is_not_a_plural(void **state) {
    result r = run(*state, "render", SCENE, "--size", "8x8", "--spp", "1");
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.err, "1 sample per pixel"));
    result_free(&r);
}

static void quiet_is_quiet(void **state) {
    result r = run(*state, "render", SCENE, "--size", "8x8", "--spp", "1", "--quiet");
    assert_int_equal(r.code, 0);
    assert_int_equal(r.err_size + r.out_size, 0);
    result_free(&r);
}

/* In files and pipes there are lines, no cursor movements. */
static void progress_in_a_file_is_lines(void **state) {
    result r = run(*state, "render", SCENE, "--size", "8x8", "--spp", "1", "--progress", "always");
    assert_non_null(strstr(r.err, "100%"));
    assert_null(strpbrk(r.err, "\r\033"));
    result_free(&r);
    r = run(*state, "render", SCENE, "--size", "8x8", "--spp", "1");
    assert_null(strchr(r.err, '%') ? strstr(r.err, "100%") : NULL);
    assert_null(strpbrk(r.err, "\r\033"));
    result_free(&r);
}

static void a_picture_goes_through_a_pipe(void **state) {
    const place *p = *state;
    result r = run(p, "render", SCENE, "--size", "8x8", "--spp", "1", "-o", "-");
    assert_int_equal(r.code, 0);
    assert_true(r.out_size > 50 && memcmp(r.out, "\x89PNG", 4) == 0);
    assert_int_equal(files_in(p), 0);
    write_file(p, "piped.png", r.out, r.out_size);
    result_free(&r);
    assert_runs(p, "render", SCENE, "--size", "8x8", "--spp", "1", "-o", "file.png");
    assert_true(same_bytes(p, "piped.png", "file.png"));
}

/* A glb of JSON alone. */
static void a_glb_comes_from_standard_input(void **state) {
    const place *p = *state;
    FILE *file = fopen(SCENE, "rb");
    static unsigned char glb[1 << 20] = "glTF\2\0\0\0";
    assert_non_null(file);
    size_t json = fread(glb + 20, 1, sizeof glb - 64, file);
    fclose(file);
    while (json % 4) glb[20 + json++] = ' ';
    uint32_t total = (uint32_t)json + 20, length = (uint32_t)json;
    memcpy(glb + 8, &total, 4);
    memcpy(glb + 12, &length, 4);
    memcpy(glb + 16, "JSON", 4);
    write_file(p, "a.glb", glb, total);
    char input[128];
    snprintf(input, sizeof input, "<%s/a.glb", p->folder);
    assert_runs(p, "render", "-", input, "--size", "8x8", "--spp", "1", "--seed", "3");
    assert_runs(p, "render", SCENE, "--size", "8x8", "--spp", "1", "--seed", "3", "-o", "same.png");
    assert_true(same_bytes(p, "stdin.png", "same.png"));
}

static void templates_are_filled_in(void **state) {
    const place *p = *state;
    assert_runs(p, "render", PAIR("camera_yfov_a"), "--size", "8x8", "--spp", "1", "-o",
                "{name}.{camera}.{frame:4}.{variant}.png", "-o", "x####.png", "--camera", "auto");
    assert_true(has_file(p, "camera_yfov_a.auto.0000.default.png"));
    assert_true(has_file(p, "x0000.png"));
}

static void threads_and_runs_change_no_bit(void **state) {
    const place *p = *state;
    const char *const counts[] = {"1", "2", "7"};
    char name[16];
    for (int i = 0; i < 3; i++) {
        snprintf(name, sizeof name, "%s.png", counts[i]);
        assert_runs(p, "render", PAIR("transmission_rough_a"), "--size", "48x40", "--spp", "9", "--threads", counts[i],
                    "-o", name);
    }
    assert_true(same_bytes(p, "1.png", "2.png") && same_bytes(p, "1.png", "7.png"));
    assert_runs(p, "render", PAIR("transmission_rough_a"), "--size", "48x40", "--spp", "9", "--seed", "1", "-o",
                "seed.png");
    assert_false(same_bytes(p, "1.png", "seed.png"));
}

static void a_crop_is_that_part_of_the_whole(void **state) {
    const place *p = *state;
    uint32_t w, h, c, cw, ch, cc;
    assert_runs(p, "render", SCENE, "--size", "40x30", "--spp", "6", "-o", "whole.exr");
    assert_runs(p, "render", SCENE, "--size", "40x30", "--spp", "6", "--crop", "7,5,29,18", "-o", "crop.exr");
    float *whole = read_picture(p, "whole.exr", &w, &h, &c), *crop = read_picture(p, "crop.exr", &cw, &ch, &cc);
    assert_true(w == 40 && h == 30 && cw == 40 && ch == 30 && c == 3 && cc == 3);
    for (uint32_t y = 0; y < h; y++)
        for (uint32_t x = 0; x < w; x++)
            for (uint32_t k = 0; k < 3; k++) {
                bool inside = x >= 7 && x < 29 && y >= 5 && y < 18;
                float expected = inside ? whole[(y * w + x) * 3 + k] : 0; /* outside, the file has no data */
                assert_memory_equal(&crop[(y * w + x) * 3 + k], &expected, sizeof expected);
            }
    free(whole);
    free(crop);
}

/* The corner of a picture of an asset that auto frames is empty. */
static void backgrounds_are_what_was_asked_for(void **state) {
    const place *p = *state;
    uint32_t w, h, c;
    assert_runs(p, "render", SCENE, "--camera", "auto", "--size", "16x16", "--spp", "4", "--background", "#ff8000", "-o",
                "a.png", "-o", "a.exr");
    float *shown = read_picture(p, "a.png", &w, &h, &c);
    assert_int_equal(c, 3);
    assert_true(shown[0] == 1 && shown[1] == 128 / 255.0f && shown[2] == 0);
    free(shown);
    shown = read_picture(p, "a.exr", &w, &h, &c);
    assert_true(fabsf(shown[0] - 1) < 1e-6f && fabsf(shown[1] - 0.21586f) < 1e-4f && shown[2] == 0); /* sRGB's curve */
    free(shown);
    assert_runs(p, "render", SCENE, "--camera", "auto", "--size", "16x16", "--spp", "4", "--background", "transparent",
                "-o", "a.png", "-o", "a.exr");
    const char *const names[] = {"a.png", "a.exr"};
    for (int i = 0; i < 2; i++) {
        shown = read_picture(p, names[i], &w, &h, &c);
        assert_int_equal(c, 4);
        assert_true(shown[3] == 0 && shown[4 * (8 * 16 + 8) + 3] == 1);
        free(shown);
    }
}

static bool has_text(const place *p, const char *file, const char *text) {
    size_t size, length = strlen(text);
    unsigned char *bytes = read_file(p, file, &size);
    bool found = false;
    for (size_t i = 0; bytes && !found && i + length <= size; i++) found = memcmp(bytes + i, text, length) == 0;
    free(bytes);
    return found;
}

static void holds_text(const place *p, const char *file, const char *text) {
    if (!has_text(p, file, text)) fail_msg("%s does not say '%s'", file, text);
}

/* A coverage that a background needs is no layer that anybody asked for. */
static void layers_are_those_that_were_asked_for(void **state) {
    const place *p = *state;
    assert_runs(p, "render", SCENE, "--size", "8x8", "--spp", "1", "--background", "#ff8000", "-o", "a.exr");
    assert_false(has_text(p, "a.exr", "alpha.A"));
    assert_runs(p, "render", SCENE, "--size", "8x8", "--spp", "1", "--background", "#ff8000", "-o", "a.exr", "--aov",
                "alpha");
    assert_true(has_text(p, "a.exr", "alpha.A"));
}

static void files_say_how_they_were_made(void **state) {
    const place *p = *state;
    assert_runs(p, "render", SCENE, "--size", "8x8", "--spp", "3", "--seed", "11", "--exposure", "-1.5", "-o", "a.png",
                "-o", "a.exr", "--aov", "albedo,normal,depth,samples,error,alpha");
    const char *const png[] = {"Software", "kiln 0.", "display sRGB, view Khronos PBR Neutral, exposure -1.5",
                               "embedded kiln config, working space lin_rec709", "sRGB"};
    const char *const exr[] = {"command",   "--seed 11",      "samplesPerPixel", "renderTime",  "versions",
                               "Embree ",   "OpenColorIO ",   "estimatedError",  "colorConfig", "colorView",
                               "exposure",  "chromaticities", "albedo.R",        "normal.X",    "depth.Z",
                               "samples.Y", "error.Y",        "alpha.A"};
    for (size_t i = 0; i < sizeof png / sizeof *png; i++) holds_text(p, "a.png", png[i]);
    for (size_t i = 0; i < sizeof exr / sizeof *exr; i++) holds_text(p, "a.exr", exr[i]);
}

/* A PNG is the same bytes whenever it is made: no date, no time, no path in it. */
static void pngs_are_reproducible(void **state) {
    const place *p = *state;
    assert_runs(p, "render", SCENE, "--size", "8x8", "--spp", "2", "-o", "a.png");
    assert_runs(p, "LC_ALL=de_DE.UTF-8", "render", SCENE, "--size", "8x8", "--spp", "2", "-o", "b.png", "--stats",
                "s.json");
    assert_true(same_bytes(p, "a.png", "b.png"));
}

static void numbers_do_not_depend_on_the_locale(void **state) {
    const place *p = *state;
    assert_runs(p, "LC_ALL=de_DE.UTF-8", "render", SCENE, "--size", "8x8", "--spp", "2", "--exposure", "0.5", "--stats",
                "s.json");
    assert_refused(p, 2, "'0,5' is not", "LC_ALL=de_DE.UTF-8", "render", SCENE, "--exposure", "0,5");
    size_t size;
    char *text = (char *)read_file(p, "s.json", &size);
    json_t *json = json_loads(text, 0, NULL);
    assert_non_null(json);
    assert_true(json_number_value(json_object_get(json_object_get(json, "picture"), "exposure")) == 0.5);
    json_decref(json);
    free(text);
}

static void statistics_are_json(void **state) {
    result r = run(*state, "render", SCENE, "--size", "8x8", "--spp", "2", "--json");
    assert_int_equal(r.code, 0);
    json_t *json = json_loads(r.out, 0, NULL);
    assert_non_null(json);
    const json_t *render = json_object_get(json, "render"), *stage;
    assert_int_equal(json_integer_value(json_object_get(render, "samples")), 128);
    double shares = 0;
    size_t i;
    json_array_foreach(json_object_get(render, "stages"), i, stage)
        shares += json_number_value(json_object_get(stage, "share"));
    assert_true(shares > 0.999 && shares < 1.001);
    assert_non_null(strstr(r.err, "render by stage: "));
    json_decref(json);
    result_free(&r);
}

static void a_missed_goal_is_exit_code_4(void **state) {
    const place *p = *state;
    result r = run(p, "render", SCENE, "--size", "16x16", "--noise", "0.01%", "--spp", "8");
    assert_int_equal(r.code, 4);
    assert_non_null(strstr(r.err, "the goal of 0.01% was not reached"));
    assert_true(has_file(p, "roughness_factor_a.png"));
    result_free(&r);
    assert_runs(p, "render", SCENE, "--size", "16x16", "--noise", "90%", "--spp", "64");
    assert_runs(p, "render", SCENE, "--size", "16x16", "--noise", "0", "--spp", "4");
}

static void a_budget_ends_the_render(void **state) {
    result r = run(*state, "render", SCENE, "--size", "64x64", "--budget", "300ms");
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.err, "ended by --budget 0.3s"));
    result_free(&r);
}

static void strict_turns_warnings_into_failures(void **state) {
    const place *p = *state;
    result r = run(p, "render", PAIR("mode_lines_b"), "--size", "8x8", "--spp", "1", "--strict");
    assert_int_equal(r.code, 1);
    assert_non_null(strstr(r.err, "warning: "));
    assert_non_null(strstr(r.err, "--strict"));
    assert_int_equal(files_in(p), 0);
    result_free(&r);
    assert_runs(p, "render", SCENE, "--size", "8x8", "--spp", "1", "--strict");
}

/* The call that the benchmarks make. */
static void benchmarks_can_call_it(void **state) {
    const place *p = *state;
    static const char hdr[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x80\x80\x80\x81";
    write_file(p, "a.hdr", hdr, sizeof hdr - 1);
    assert_runs(p, "render", SCENE, "--size", "16x16", "--subdivide", "off", "--filter", "box:1", "--env", "a.hdr",
                "--env-intensity", "0.5", "--aperture", "2.800000", "--focus", "3", "-o", "out.exr", "--spp", "4",
                "--noise", "0", "--seed", "1000", "--max-depth", "9", "--threads", "2");
    assert_true(has_file(p, "out.exr"));
    assert_runs(p, "render", SCENE, "--size", "16x16", "--env", "none", "-o", "out.exr", "--spp", "1", "--noise", "0");
}

static void interrupt(const place *p, int signal) {
    const char *const arguments[] = {"render",   SCENE,        "--size",  "64x64",  "--spp",
                                     "16000000", "--progress", "always",  "-o",     "a.png",
                                     "-o",       "a.exr",      "--stats", "s.json", NULL};
    pid_t child = run_start(p, arguments);
    assert_true(run_says(p, " spp")); /* of a progress line: it renders */
    assert_int_equal(kill(child, signal), 0);
    result r = run_wait(p, child);
    assert_int_equal(r.code, 130);
    assert_non_null(strstr(r.err, "wrote a.png"));
    assert_non_null(strstr(r.err, "interrupted"));
    assert_true(has_file(p, "a.png") && has_file(p, "a.exr") && has_file(p, "s.json"));
    assert_int_equal(files_in(p), 3);
    uint32_t w, h, c;
    free(read_picture(p, "a.png", &w, &h, &c));
    result_free(&r);
}

static void interrupted_renders_are_written(void **state) {
    interrupt(*state, SIGINT);
    interrupt(*state, SIGTERM);
}

/* What a caller has told to be ignored stays so: a job in the background goes on when the terminal's Ctrl-C comes. */
static void ignored_interrupts_stay_ignored(void **state) {
    const place *p = *state;
    const char *const arguments[] = {"render", SCENE,        "--size", "32x32", "--budget",
                                     "700ms",  "--progress", "always", NULL};
    signal(SIGINT, SIG_IGN);
    pid_t child = run_start(p, arguments);
    assert_true(run_says(p, " spp"));
    kill(child, SIGINT);
    result r = run_wait(p, child);
    signal(SIGINT, SIG_DFL);
    assert_int_equal(r.code, 0);
    result_free(&r);
}

/* The second Ctrl-C quits in the middle of a write, and leaves no half of a file. */
static void a_second_interrupt_leaves_nothing_half_written(void **state) {
    const place *p = *state;
    const char *const arguments[] = {"render", SCENE, "--size", "2000x2000", "--spp", "1", "-v", "-o", "a.exr", NULL};
    const struct timespec nap = {.tv_nsec = 20000000};
    pid_t child = run_start(p, arguments);
    assert_true(run_says(p, "render: "));
    while (!files_in(p)) nanosleep(&(struct timespec){.tv_nsec = 100000}, NULL);
    kill(child, SIGINT);
    nanosleep(&nap, NULL); /* equal signals that wait are one */
    kill(child, SIGINT);
    result r = run_wait(p, child);
    assert_true(r.code == 130 || has_file(p, "a.exr"));
    assert_int_equal(files_in(p), has_file(p, "a.exr"));
    result_free(&r);
}

static void a_limit_of_file_sizes_is_an_error_like_any_other(void **state) {
    const place *p = *state;
    struct rlimit before, low = {1024, 1024}; /* for messages too */
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    low.rlim_max = before.rlim_max;
    const char *const outputs[] = {"a.png", "a.exr", "a.hdr", "a.tif", "a.webp", "a.jpg"};
    for (size_t i = 0; i < sizeof outputs / sizeof *outputs; i++) {
        setrlimit(RLIMIT_FSIZE, &low);
        result r = run(p, "render", SCENE, "--size", "256x256", "--spp", "1", "-q", "-o", outputs[i]);
        setrlimit(RLIMIT_FSIZE, &before);
        if (r.code != 1) fail_msg("%s: exit code %d, '%s'", outputs[i], r.code, r.err);
        assert_non_null(strstr(r.err, "cannot be written: File too large"));
        assert_int_equal(files_in(p), 0);
        result_free(&r);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {CLI_TEST(the_default_output_is_here_and_named_by_the_asset),
                                       CLI_TEST(one_is_not_a_plural),
                                       CLI_TEST(quiet_is_quiet),
                                       CLI_TEST(progress_in_a_file_is_lines),
                                       CLI_TEST(a_picture_goes_through_a_pipe),
                                       CLI_TEST(a_glb_comes_from_standard_input),
                                       CLI_TEST(templates_are_filled_in),
                                       CLI_TEST(threads_and_runs_change_no_bit),
                                       CLI_TEST(a_crop_is_that_part_of_the_whole),
                                       CLI_TEST(backgrounds_are_what_was_asked_for),
                                       CLI_TEST(layers_are_those_that_were_asked_for),
                                       CLI_TEST(files_say_how_they_were_made),
                                       CLI_TEST(pngs_are_reproducible),
                                       CLI_TEST(numbers_do_not_depend_on_the_locale),
                                       CLI_TEST(statistics_are_json),
                                       CLI_TEST(a_missed_goal_is_exit_code_4),
                                       CLI_TEST(a_budget_ends_the_render),
                                       CLI_TEST(strict_turns_warnings_into_failures),
                                       CLI_TEST(benchmarks_can_call_it),
                                       CLI_TEST(interrupted_renders_are_written),
                                       CLI_TEST(ignored_interrupts_stay_ignored),
                                       CLI_TEST(a_second_interrupt_leaves_nothing_half_written),
                                       CLI_TEST(a_limit_of_file_sizes_is_an_error_like_any_other)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
