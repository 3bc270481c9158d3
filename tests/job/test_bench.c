#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "job/bench.h"
#include "tests/job/support.h"

static void generated_scenes_have_the_size_that_was_asked_for(void **state) {
    fixture *f = *state;
    static const struct { uint64_t triangles; uint32_t copies, lamps; } rows[] = {{10000, 1, 0}, {1000, 7, 0}, {1, 1, 0},
                                                                                  {1000, 1, 500}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_scene *scene;
        assert_true(bench_make_scene(rows[i].triangles, rows[i].copies, rows[i].lamps, &scene, f->report));
        kiln_scene_counts c = kiln_scene_count(scene);
        double wanted = fmax((double)rows[i].triangles, 36) * rows[i].copies + 2 + 2 * rows[i].lamps;
        assert_true(fabs((double)c.triangles / wanted - 1) < 0.05);
        assert_int_equal(c.instances, rows[i].copies + 1 + (rows[i].lamps > 0));
        assert_true(kiln_scene_commit(scene, f->report));
        kiln_bounds b = kiln_scene_bounds(scene);
        assert_true((b.max[1] < 0.5 || rows[i].lamps) && b.min[1] >= -0.46); /* the ring lies on the table */
        kiln_scene_destroy(scene);
    }
    assert_int_equal(kiln_report_size(f->report), 0);
}

static void lists_of_axes_are_checked_before_anything_is_measured(void **state) {
    fixture *f = *state;
    static const char *const good[] = {"all", "all:4", "pixels", "depth:4,threads", "triangles:1e6"},
                            *const bad[] = {"", "pixel", "depth:", "depth:x", "depth:-1", "depth,,threads", "depth:nan"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        f->options.growth = good[i];
        assert_true(bench_check_growth(&f->options, f->report));
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        f->options.growth = bad[i];
        if (bench_check_growth(&f->options, f->report)) fail_msg("'%s' was taken", bad[i]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {JOB_TEST(generated_scenes_have_the_size_that_was_asked_for),
                                       JOB_TEST(lists_of_axes_are_checked_before_anything_is_measured)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
