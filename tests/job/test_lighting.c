#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/file.h"
#include "job/lighting.h"
#include "tests/job/support.h"

static const float low[3] = {0, 0, 0}, high[3] = {1, 1, 1};

static job_light kind(const fixture *f) { return lighting_choose(&f->options, f->scene).kind; }

static void add_light(fixture *f, float intensity) {
    kiln_light l = kiln_light_default();
    l.intensity = intensity;
    assert_done(f, kiln_scene_add_light(f->scene, &l, NULL, f->report));
}

static void scenes_without_light_get_the_studio(void **state) {
    fixture *f = *state;
    assert_int_equal(kind(f), JOB_LIGHT_STUDIO);
    add_box(f, low, high, add_material(f, 0.5f, 0));
    add_light(f, 0);
    assert_int_equal(kind(f), JOB_LIGHT_STUDIO);
    add_light(f, 3);
    assert_int_equal(kind(f), JOB_LIGHT_SCENE);
}

/* What glows lights nothing; what shines brighter than white does, if anything shows it. */
static void only_bright_emission_counts(void **state) {
    fixture *f = *state;
    add_box(f, low, high, add_material(f, 0.5f, 1));
    add_material(f, 0.5f, 10);
    assert_int_equal(kind(f), JOB_LIGHT_STUDIO);
    add_box(f, low, high, add_material(f, 0.5f, 1.01f));
    assert_int_equal(kind(f), JOB_LIGHT_SCENE);
    assert_true(lighting_choose(&f->options, f->scene).doubtful);
    give(f, "env", "none");
    assert_false(lighting_choose(&f->options, f->scene).doubtful);
}

static void certain_lights_need_no_trial(void **state) {
    fixture *f = *state;
    add_box(f, low, high, add_material(f, 0.5f, 10));
    assert_true(lighting_choose(&f->options, f->scene).doubtful);
    add_light(f, 3);
    assert_false(lighting_choose(&f->options, f->scene).doubtful);
}

static void unlit_surfaces_light_nothing(void **state) {
    fixture *f = *state;
    kiln_material m = kiln_material_default();
    kiln_id id;
    m.layers = KILN_LAYER_UNLIT;
    m.emission.value[0] = 100;
    assert_done(f, kiln_scene_add_material(f->scene, &m, &id, f->report));
    add_box(f, low, high, id);
    assert_int_equal(kind(f), JOB_LIGHT_STUDIO);
}

static void options_go_first(void **state) {
    fixture *f = *state;
    add_light(f, 3);
    give(f, "env", "none");
    assert_int_equal(kind(f), JOB_LIGHT_NONE);
    give(f, "env", "studio");
    assert_int_equal(kind(f), JOB_LIGHT_STUDIO);
    give(f, "env", "hall.hdr");
    assert_int_equal(kind(f), JOB_LIGHT_FILE);
}

static bool apply(fixture *f) {
    job_lighting l = lighting_choose(&f->options, f->scene);
    kiln_camera camera = kiln_camera_frame(f->scene, &(kiln_framing){.azimuth_rad = 0.5});
    return lighting_apply(&l, &f->options, &camera, f->scene, f->report);
}

static void the_studio_is_turned_and_dimmed(void **state) {
    fixture *f = *state;
    give(f, "env-rotate", "90");
    give(f, "env-intensity", "0.25");
    assert_done(f, apply(f));
    assert_near(f->scene->environment.rotation_rad, 0.5 + M_PI / 2, 1e-9);
    assert_true(f->scene->environment.color[1] == 0.25f);
}

static void surroundings_of_the_scene_are_turned_further(void **state) {
    fixture *f = *state;
    assert_done(
        f, kiln_scene_set_environment(f->scene, &(kiln_environment){.color = {2, 4, 6}, .rotation_rad = 1}, f->report));
    give(f, "env-rotate", "-90");
    give(f, "env-intensity", "0.5");
    assert_done(f, apply(f));
    assert_near(f->scene->environment.rotation_rad, 1 - M_PI / 2, 1e-9);
    assert_true(f->scene->environment.color[2] == 3);
}

static void none_takes_the_surroundings_away(void **state) {
    fixture *f = *state;
    assert_done(f, kiln_scene_set_environment(f->scene, &(kiln_environment){.color = {1, 1, 1}}, f->report));
    give(f, "env", "none");
    assert_done(f, apply(f));
    assert_false(f->scene->has_environment);
}

static void pictures_are_read(void **state) {
    fixture *f = *state;
    static const char hdr[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x80\x80\x80\x81";
    char path[256];
    assert_done(f, file_replace(path_in(f, "a.hdr", path), hdr, sizeof hdr - 1, f->report));
    give(f, "env", path);
    assert_done(f, apply(f));
    assert_true(f->scene->has_environment && f->scene->environment.transfer == KILN_TRANSFER_LINEAR);
    assert_int_equal(kiln_report_size(f->report), 0);
}

static void what_is_no_picture_is_refused(void **state) {
    fixture *f = *state;
    char path[256];
    give(f, "env", path_in(f, "missing.hdr", path));
    assert_false(apply(f));
    assert_int_equal(kiln_report_exit_code(f->report), 3);
    assert_done(f, file_replace(path_in(f, "text.hdr", path), "hello", 5, f->report));
    give(f, "env", path);
    assert_false(apply(f));
    assert_false(f->scene->has_environment);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        JOB_TEST(scenes_without_light_get_the_studio), JOB_TEST(only_bright_emission_counts),
        JOB_TEST(unlit_surfaces_light_nothing),        JOB_TEST(options_go_first),
        JOB_TEST(the_studio_is_turned_and_dimmed),     JOB_TEST(surroundings_of_the_scene_are_turned_further),
        JOB_TEST(none_takes_the_surroundings_away),    JOB_TEST(pictures_are_read),
        JOB_TEST(what_is_no_picture_is_refused),       JOB_TEST(certain_lights_need_no_trial)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
