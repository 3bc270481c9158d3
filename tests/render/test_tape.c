/* Rays that are kept and traced again by Embree alone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/record.h"
#include "tests/render/scenes.h"

enum { SIDE = 48, SPP = 4, THREADS = 2, PLENTY = 40000 };

typedef struct stage {
    scene_builder scene;
    kiln_renderer *renderer;
    kiln_camera view;
} stage;

/* Coverage, touching solids and copies: whatever rays have to do with. */
static int set_up(void **state) {
    stage *s = calloc(1, sizeof *s);
    s->scene = builder_make();
    add_everything(&s->scene);
    must(kiln_scene_commit(s->scene.scene, s->scene.report), s->scene.report, "committing");
    must(kiln_renderer_create(s->scene.scene, &(kiln_renderer_options){.threads = THREADS}, &s->renderer,
                              s->scene.report),
         s->scene.report, "making a renderer");
    s->view = everything_camera();
    *state = s;
    return 0;
}
static int tear_down(void **state) {
    stage *s = *state;
    kiln_renderer_destroy(s->renderer);
    builder_free(&s->scene);
    free(s);
    return 0;
}

static kiln_film *record(const stage *s, ray_tape *tapes, kiln_render_stats *stats) {
    kiln_film *film;
    kiln_render_options o = {.camera = &s->view, .spp = SPP};
    must(kiln_film_create(&(kiln_film_desc){.width = SIDE, .height = SIDE}, &film, s->scene.report), s->scene.report,
         "a film");
    must(render_recorded(s->renderer, &o, film, tapes, stats, s->scene.report), s->scene.report, "rendering");
    return film;
}

static void every_ray_is_kept_and_meets_the_same_again(void **state) {
    const stage *s = *state;
    kiln_render_stats stats;
    ray_tape *tapes = tapes_create(THREADS, PLENTY, 1);
    kiln_film_destroy(record(s, tapes, &stats));
    tape_totals t = tapes_count(tapes, THREADS);
    assert_int_equal(t.samples, SIDE * SIDE * SPP);
    assert_int_equal(t.closest_rays, stats.camera_rays + stats.bounce_rays);
    assert_true(t.occlusion_rays > stats.shadow_rays); /* visits of touching solids too */
    assert_true(t.packets * 16 >= t.closest_rays + t.occlusion_rays);
    assert_int_equal(renderer_compare(s->renderer, tapes), 0);
    assert_true(renderer_replay(s->renderer, tapes) > 0);
    tapes_destroy(tapes, THREADS);
}

static void recording_changes_no_bit(void **state) {
    const stage *s = *state;
    enum { VALUES = SIDE * SIDE * 3 };
    float *plain = malloc(VALUES * sizeof *plain), *recorded = malloc(VALUES * sizeof *recorded);
    kiln_render_stats stats;
    ray_tape *tapes = tapes_create(THREADS, PLENTY, 1);
    kiln_film *a = record(s, NULL, &stats), *b = record(s, tapes, &stats);
    kiln_film_beauty(a, plain);
    kiln_film_beauty(b, recorded);
    assert_memory_equal(plain, recorded, VALUES * sizeof *plain);
    kiln_film_destroy(a);
    kiln_film_destroy(b);
    tapes_destroy(tapes, THREADS);
    free(plain);
    free(recorded);
}

/* A tape that ends within a batch forgets that batch. */
static void a_full_tape_holds_whole_batches(void **state) {
    const stage *s = *state;
    kiln_render_stats stats;
    ray_tape *tapes = tapes_create(THREADS, 2000, 1);
    kiln_film_destroy(record(s, tapes, &stats));
    tape_totals t = tapes_count(tapes, THREADS);
    assert_true(t.packets <= 2000 && t.packets > 500);
    assert_true(t.samples > 0 && t.samples < SIDE * SIDE * SPP);
    assert_int_equal(renderer_compare(s->renderer, tapes), 0);
    tapes_destroy(tapes, THREADS);
}

static void one_batch_in_some_is_kept(void **state) {
    const stage *s = *state;
    kiln_render_stats stats;
    ray_tape *tapes = tapes_create(THREADS, PLENTY, 2); /* made odd: 3 */
    kiln_film_destroy(record(s, tapes, &stats));
    tape_totals t = tapes_count(tapes, THREADS);
    assert_true(t.samples >= SIDE * SIDE * SPP / 5 && t.samples <= SIDE * SIDE * SPP * 3 / 4);
    tapes_destroy(tapes, THREADS);
}

/* Tilted; moving it would be no use, for a renderer moves scenes to their centre. */
static kiln_renderer *renderer_of_quad(scene_builder *b, float tilt) {
    kiln_material grey = diffuse_material(0.5f, 0.5f, 0.5f);
    kiln_renderer *renderer;
    *b = builder_make();
    add_quad(b, add_material(b, &grey), (float[]){-1, -1, 0, 1, -1, 0, 1, 1, tilt, -1, 1, tilt});
    must(kiln_scene_commit(b->scene, b->report), b->report, "committing");
    must(kiln_renderer_create(b->scene, &(kiln_renderer_options){.threads = THREADS}, &renderer, b->report), b->report,
         "making a renderer");
    return renderer;
}

/* The comparison can fail. */
static void what_has_changed_is_noticed(void **state) {
    (void)state;
    stage here = {.view = camera_at((float[]){0, 0, 3}, (float[]){0, 0, 0}, 30)};
    scene_builder tilted;
    kiln_render_stats stats;
    here.renderer = renderer_of_quad(&here.scene, 0);
    kiln_renderer *there = renderer_of_quad(&tilted, 0.3f);
    ray_tape *tapes = tapes_create(THREADS, PLENTY, 1);
    kiln_film_destroy(record(&here, tapes, &stats));
    assert_int_equal(renderer_compare(here.renderer, tapes), 0);
    assert_true(renderer_compare(there, tapes) > stats.camera_rays / 2);
    tapes_destroy(tapes, THREADS);
    kiln_renderer_destroy(here.renderer);
    kiln_renderer_destroy(there);
    builder_free(&here.scene);
    builder_free(&tilted);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_ray_is_kept_and_meets_the_same_again, set_up, tear_down),
        cmocka_unit_test_setup_teardown(recording_changes_no_bit, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_full_tape_holds_whole_batches, set_up, tear_down),
        cmocka_unit_test_setup_teardown(one_batch_in_some_is_kept, set_up, tear_down),
        cmocka_unit_test(what_has_changed_is_noticed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
