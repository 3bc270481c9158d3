#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "job/camera.h"
#include "tests/job/support.h"

static void add_camera(fixture *f, const char *name, double yfov, double aspect) {
    kiln_camera c = kiln_camera_default();
    c.name = name;
    c.yfov_rad = yfov;
    c.aspect = aspect;
    assert_done(f, kiln_scene_add_camera(f->scene, &c, NULL, f->report));
}

/* A lens of 50 mm at f/2 has a diameter of 25 mm; 50 mm see 2 atan(12/50) of a sensor that is 24 mm high. */
static void f_stops_are_of_a_36_by_24_sensor(void **state) {
    (void)state;
    double yfov = 2 * atan(12.0 / 50);
    assert_near(camera_lens_radius(2, yfov), 0.0125, 1e-12);
    assert_near(camera_lens_radius(16, yfov), 0.05 / 32, 1e-12);
    assert_true(camera_lens_radius(0, yfov) == 0);
}

static void options_change_the_lens(void **state) {
    fixture *f = *state;
    job_view v;
    add_camera(f, "A", 2 * atan(12.0 / 85), 0);
    give(f, "aperture", "1.4");
    give(f, "focus", "3.5");
    give(f, "blades", "7");
    assert_done(f, view_choose(&f->options, f->scene, &v, f->report));
    assert_near(v.camera.lens_radius, 0.085 / 2.8, 1e-12);
    assert_true(v.camera.focus_distance == 3.5 && v.camera.blades == 7);
    free(v.name);
    give(f, "fov", "26.991467"); /* 2 atan(12/50) */
    assert_done(f, view_choose(&f->options, f->scene, &v, f->report));
    assert_near(v.camera.lens_radius, 0.05 / 2.8, 1e-9);
    free(v.name);
}

static void assert_size(fixture *f, const char *camera, uint32_t width, uint32_t height) {
    job_view v;
    give(f, "camera", camera);
    assert_done(f, view_choose(&f->options, f->scene, &v, f->report));
    assert_int_equal(v.width, width);
    assert_int_equal(v.height, height);
    free(v.name);
}

static void pictures_have_the_aspect_of_their_camera(void **state) {
    fixture *f = *state;
    add_camera(f, "wide", 1, 16.0 / 9);
    add_camera(f, "tall", 1, 0.5);
    add_camera(f, "any", 1, 0);
    add_camera(f, "slit", 1, 1e6);
    assert_size(f, "wide", 1024, 576);
    assert_size(f, "tall", 512, 1024);
    assert_size(f, "any", 1024, 1024);
    assert_size(f, "slit", 1024, 1);
    give(f, "size", "300x200");
    assert_size(f, "wide", 300, 200);
}

static void cameras_go_by_name_and_then_by_number(void **state) {
    fixture *f = *state;
    add_camera(f, "1", 0.5, 0);
    add_camera(f, "B", 0.6, 0);
    add_camera(f, "", 0.7, 0);
    const struct { const char *wanted, *name; double yfov; } rows[] = {
        {"1", "1", 0.5}, {"B", "B", 0.6}, {"0", "1", 0.5}, {"2", "2", 0.7}, {"auto", "auto", 30 * M_PI / 180}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        job_view v;
        give(f, "camera", rows[i].wanted);
        assert_done(f, view_choose(&f->options, f->scene, &v, f->report));
        assert_string_equal(v.name, rows[i].name);
        assert_near(v.camera.yfov_rad, rows[i].yfov, 1e-12);
        free(v.name);
    }
    job_view v;
    give(f, "camera", "C");
    assert_false(view_choose(&f->options, f->scene, &v, f->report));
    assert_true(says(f->report, "has no camera 'C'") && says(f->report, "1 'B'"));
}

static void the_first_camera_is_the_default_unless_auto_is_meant(void **state) {
    fixture *f = *state;
    job_view v;
    assert_done(f, view_choose(&f->options, f->scene, &v, f->report));
    assert_true(v.automatic);
    free(v.name);
    add_camera(f, "A", 1, 0);
    assert_done(f, view_choose(&f->options, f->scene, &v, f->report));
    assert_string_equal(v.name, "A");
    free(v.name);
    give(f, "orbit", "0,0");
    assert_done(f, view_choose(&f->options, f->scene, &v, f->report));
    assert_true(v.automatic);
    free(v.name);
    give(f, "camera", "A");
    assert_false(view_choose(&f->options, f->scene, &v, f->report));
    assert_true(says(f->report, "--orbit"));
}

static void flat_cameras_have_no_f_stop(void **state) {
    fixture *f = *state;
    job_view v;
    kiln_camera c = kiln_camera_default();
    c.projection = KILN_ORTHOGRAPHIC;
    assert_done(f, kiln_scene_add_camera(f->scene, &c, NULL, f->report));
    give(f, "aperture", "0");
    assert_done(f, view_choose(&f->options, f->scene, &v, f->report));
    free(v.name);
    give(f, "aperture", "2");
    assert_false(view_choose(&f->options, f->scene, &v, f->report));
    assert_true(says(f->report, "orthographic"));
}

static void azimuths_are_where_cameras_stand(void **state) {
    fixture *f = *state;
    for (int az = -170; az <= 180; az += 35)
        for (int el = -90; el <= 90; el += 45) {
            kiln_camera c = kiln_camera_frame(
                f->scene, &(kiln_framing){.azimuth_rad = az * M_PI / 180, .elevation_rad = el * M_PI / 180});
            double off = remainder(camera_azimuth(&c) - az * M_PI / 180, 2 * M_PI);
            if (el > -90) assert_true(fabs(off) < 1e-6);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {JOB_TEST(f_stops_are_of_a_36_by_24_sensor),
                                       JOB_TEST(options_change_the_lens),
                                       JOB_TEST(pictures_have_the_aspect_of_their_camera),
                                       JOB_TEST(cameras_go_by_name_and_then_by_number),
                                       JOB_TEST(the_first_camera_is_the_default_unless_auto_is_meant),
                                       JOB_TEST(flat_cameras_have_no_f_stop),
                                       JOB_TEST(azimuths_are_where_cameras_stand)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
