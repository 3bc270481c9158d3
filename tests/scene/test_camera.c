#include "tests/scene/support.h"

#include <math.h>

static void the_default_camera_is_valid(void **state) {
    fixture *f = *state;
    kiln_camera camera = kiln_camera_default();
    kiln_id id;
    assert_true(kiln_scene_add_camera(f->scene, &camera, &id, f->report));
    assert_int_equal(kiln_report_size(f->report), 0);
    assert_true(fabs(kiln_scene_camera(f->scene, id)->yfov_rad - 40 * M_PI / 180) < 1e-15);
    assert_null(kiln_scene_camera(f->scene, 0));
    assert_null(kiln_scene_camera(f->scene, 2));
}

static void what_frames_the_picture_is_refused(void **state) {
    fixture *f = *state;
    const double bad[] = {0, -1, NAN, INFINITY, 3.2};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        kiln_camera c = kiln_camera_default();
        c.yfov_rad = bad[i];
        assert_false(kiln_scene_add_camera(f->scene, &c, NULL, f->report));
        c = kiln_camera_default();
        c.projection = KILN_ORTHOGRAPHIC;
        c.ymag = i == 1 ? 0 : bad[i];
        if (i == 4) c.xmag = 0;
        assert_false(kiln_scene_add_camera(f->scene, &c, NULL, f->report));
        c = kiln_camera_default();
        c.transform[5] = i < 2 ? 0 : i == 4 ? -INFINITY : bad[i];
        assert_false(kiln_scene_add_camera(f->scene, &c, NULL, f->report));
    }
    struct { double aspect, znear, zfar, open, close; } rows[] = {
        {-1, 0, 0, 0, 0}, {NAN, 0, 0, 0, 0}, {0, -1, 0, 0, 0}, {0, 2, 1, 0, 0}, {0, 0, NAN, 0, 0}, {0, 0, 0, 1, 0},
        {0, 0, 0, 0, INFINITY}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_camera c = kiln_camera_default();
        c.aspect = rows[i].aspect, c.znear = rows[i].znear, c.zfar = rows[i].zfar;
        c.shutter_open = rows[i].open, c.shutter_close = rows[i].close;
        assert_false(kiln_scene_add_camera(f->scene, &c, NULL, f->report));
    }
    assert_int_equal(f->scene->camera_count, 0);
    assert_int_equal(kiln_report_count(f->report, KILN_ERROR), 22);
}

static void a_lens_that_is_none_becomes_a_pinhole(void **state) {
    fixture *f = *state;
    kiln_camera c = kiln_camera_default();
    c.name = "front";
    c.lens_radius = -1;
    c.focus_distance = NAN;
    c.blades = 2;
    c.zfar = INFINITY;
    c.znear = 1;
    assert_true(kiln_scene_add_camera(f->scene, &c, NULL, f->report));
    const kiln_camera *k = kiln_scene_camera(f->scene, 1);
    assert_true(k->lens_radius == 0 && k->focus_distance == 0 && k->blades == 0 && k->zfar == 0);
    assert_string_equal(k->name, "front");
    assert_true(says(f->report, KILN_WARNING, "camera 'front'", "lens_radius is -1: 0 is used"));
    assert_int_equal(kiln_report_count(f->report, KILN_WARNING), 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        SCENE_TEST(the_default_camera_is_valid),
        SCENE_TEST(what_frames_the_picture_is_refused),
        SCENE_TEST(a_lens_that_is_none_becomes_a_pinhole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
