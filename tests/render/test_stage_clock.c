/* Where the time of a render goes. How long it is, no test says. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "render/path/stage_clock.h"
#include "tests/render/scenes.h"

enum { SIZE = 32, THREADS = 2 };

static kiln_render_stats shoot(scene_builder *b, const kiln_camera *camera) {
    kiln_renderer *renderer;
    must(kiln_scene_commit(b->scene, b->report), b->report, "committing");
    must(kiln_renderer_create(b->scene, &(kiln_renderer_options){.threads = THREADS}, &renderer, b->report), b->report,
         "making a renderer");
    picture p = render_with(renderer, &(kiln_render_options){.camera = camera, .spp = 4},
                            &(kiln_film_desc){.width = SIZE, .height = SIZE}, b->report);
    kiln_render_stats stats = p.stats;
    picture_free(&p);
    kiln_renderer_destroy(renderer);
    builder_free(b);
    return stats;
}

static void the_first_batch_and_then_one_in_seven_is_timed(void **state) {
    (void)state;
    stage_clock c = {0};
    int timed = 0;
    for (int batch = 0; batch < 3 * STAGE_CLOCK_EVERY; batch++) {
        uint64_t before = c.last;
        stage_clock_start(&c);
        bool now = c.last != before;
        assert_int_equal(now, batch % STAGE_CLOCK_EVERY == 0);
        timed += now;
        c.last -= now ? 1000 : 0; /* time passes */
        uint64_t sum = c.ticks[KILN_STAGE_FILM];
        stage_clock_read(&c, KILN_STAGE_FILM);
        assert_int_equal(c.ticks[KILN_STAGE_FILM] > sum, now);
    }
    assert_int_equal(timed, 3);
    assert_int_equal(c.ticks[KILN_STAGE_CAMERA], 0);
}

static void stages_that_run_take_all_of_the_threads_time(void **state) {
    (void)state;
    scene_builder b = builder_make();
    add_everything(&b);
    kiln_camera camera = everything_camera();
    kiln_render_stats s = shoot(&b, &camera);
    static const kiln_stage run[] = {KILN_STAGE_CAMERA, KILN_STAGE_CAMERA_RAYS, KILN_STAGE_BOUNCE_RAYS,
                                     KILN_STAGE_SHADOW_RAYS, KILN_STAGE_SORT, KILN_STAGE_FETCH, KILN_STAGE_SURFACE,
                                     KILN_STAGE_MATERIAL, KILN_STAGE_BOUNDARY, KILN_STAGE_NORMAL, KILN_STAGE_ABSORB,
                                     KILN_STAGE_EMISSION, KILN_STAGE_LIGHT, KILN_STAGE_CONNECT, KILN_STAGE_SCATTER,
                                     KILN_STAGE_FILM};
    double sum = s.waiting_seconds;
    for (size_t i = 0; i < sizeof run / sizeof *run; i++) assert_true(s.stage_seconds[run[i]] > 0);
    for (int i = 0; i < KILN_STAGE_COUNT; i++) sum += s.stage_seconds[i];
    if (s.waiting_seconds > 0) assert_true(fabs(sum / (THREADS * s.seconds) - 1) < 1e-4);
    assert_true(isfinite(sum));
}

static void what_is_not_run_takes_none(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material grey = diffuse_material(0.5f, 0.5f, 0.5f);
    add_quad(&b, add_material(&b, &grey), (float[]){-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0});
    kiln_camera camera = camera_at((float[]){0, 0, 3}, (float[]){0, 0, 0}, 40);
    kiln_render_stats s = shoot(&b, &camera);
    static const kiln_stage idle[] = {KILN_STAGE_SHADOW_RAYS, KILN_STAGE_TOUCH, KILN_STAGE_FLIGHT, KILN_STAGE_CONE,
                                      KILN_STAGE_BOUNDARY, KILN_STAGE_ABSORB, KILN_STAGE_AOVS, KILN_STAGE_EMISSION,
                                      KILN_STAGE_LIMIT, KILN_STAGE_LIGHT, KILN_STAGE_CONNECT, KILN_STAGE_PARTS};
    for (size_t i = 0; i < sizeof idle / sizeof *idle; i++) assert_true(s.stage_seconds[idle[i]] <= 0);
    assert_true(s.stage_seconds[KILN_STAGE_BOUNCE_RAYS] > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_first_batch_and_then_one_in_seven_is_timed),
                                       cmocka_unit_test(stages_that_run_take_all_of_the_threads_time),
                                       cmocka_unit_test(what_is_not_run_takes_none)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
