/* The rules of a render: what it refuses, when it ends, and what it tells on the way. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/arena.h"
#include "render/context.h"
#include "render/film/film.h"
#include "tests/render/scenes.h"

typedef struct stage {
    scene_builder scene;
    kiln_renderer *renderer;
    kiln_camera view;
} stage;

static int set_up(void **state) {
    stage *s = calloc(1, sizeof *s);
    s->scene = builder_make();
    add_everything(&s->scene);
    must(kiln_scene_commit(s->scene.scene, s->scene.report), s->scene.report, "committing");
    must(kiln_renderer_create(s->scene.scene, &(kiln_renderer_options){.threads = 4}, &s->renderer, s->scene.report),
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

static picture shoot(stage *s, kiln_render_options o, uint32_t width, uint32_t height) {
    o.camera = &s->view;
    return render_with(s->renderer, &o, &(kiln_film_desc){.width = width, .height = height}, s->scene.report);
}

static void wrong_options_are_refused(void **state) {
    stage *s = *state;
    const kiln_render_options wrong[] = {
        {.noise = NAN}, {.noise = -1}, {.noise = INFINITY}, {.budget_seconds = NAN}, {.budget_seconds = INFINITY},
        {.error_scale = NAN}, {.error_scale = -1}, {.filter_width = NAN}, {.filter_width = 65}, {.filter_width = -1},
        {.estimator = KILN_ESTIMATOR_DOUBLED + 1}, {.estimator = (kiln_estimator)-1}, {.sampler = (kiln_sampler)2},
        {.light_sampling = (kiln_light_sampling)3}, {.filter = (kiln_pixel_filter)3},
        {.background = (kiln_background)3}, {.background_color = {0, NAN, 0}},
        {.roulette = {.kind = (kiln_roulette_kind)4}}, {.roulette = {.kind = KILN_ROULETTE_FIXED, .p = NAN}},
        {.spp = FIXED_SAMPLES_MAX + 1},
    };
    kiln_film *f;
    must(kiln_film_create(&(kiln_film_desc){.width = 4, .height = 4}, &f, s->scene.report), s->scene.report, "a film");
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        kiln_report *report = kiln_report_create();
        kiln_render_options o = wrong[i];
        o.camera = &s->view;
        if (!o.spp) o.spp = 1;
        if (kiln_render(s->renderer, &o, f, NULL, report)) fail_msg("row %zu was not refused", i);
        assert_int_equal(kiln_report_size(report), 1);
        assert_int_equal(kiln_report_message(report, 0).code, KILN_CODE_USAGE);
        kiln_report_destroy(report);
    }
    assert_int_equal(kiln_film_samples(f), 0);
    kiln_film_destroy(f);
}

/* What listeners were told. */
typedef struct told {
    uint32_t calls, spp_done;
    uint64_t samples, stop_after; /* so many samples; 0: never */
    double fraction;
    int cancel;
} told;

static void listen(const kiln_progress *p, void *user) {
    told *t = user;
    assert_true(p->spp_done >= t->spp_done && p->samples >= t->samples && p->fraction >= 0 && p->fraction <= 1);
    t->calls++;
    t->spp_done = p->spp_done, t->samples = p->samples, t->fraction = p->fraction;
    if (t->stop_after && t->samples >= t->stop_after) __atomic_store_n(&t->cancel, 1, __ATOMIC_RELAXED);
}

/* Reports come while other threads trace: built with the thread sanitizer, this finds what they share. */
static void progress_is_told_while_threads_work(void **state) {
    told t = {0};
    picture p = shoot(*state, (kiln_render_options){.spp = 64, .progress = listen, .progress_user = &t}, 160, 120);
    assert_true(t.calls > 0 && t.spp_done == 64 && t.samples == 160 * 120 * 64 && t.fraction == 1);
    picture_free(&p);
}

static void cancelling_keeps_what_was_reached(void **state) {
    told t = {.stop_after = 1};
    kiln_render_options o = {.spp = 1 << 20, .progress = listen, .progress_user = &t, .cancel = &t.cancel};
    picture p = shoot(*state, o, 160, 120);
    assert_int_equal(p.stats.stop, KILN_STOP_CANCELLED);
    assert_true(kiln_film_samples(p.film) > 0 && p.stats.spp < 1 << 20);
    picture_free(&p);
}

/* However short the budget is: no pixel has a second sample before every pixel has its first, and what has none is
 * counted. */
static void short_budgets_leave_no_holes(void **state) {
    enum { WIDTH = 400, HEIGHT = 300 };
    for (double budget = 1e-9; budget < 1; budget *= budget < 1e-3 ? 1e6 : 3) {
        picture p = shoot(*state, (kiln_render_options){.budget_seconds = budget}, WIDTH, HEIGHT);
        uint64_t none = 0;
        uint32_t most = 0;
        for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
            none += p.film->counts[i] == 0;
            most = p.film->counts[i] > most ? p.film->counts[i] : most;
        }
        assert_int_equal(p.stats.stop, KILN_STOP_BUDGET);
        assert_int_equal(p.stats.unsampled, none);
        if (budget < 1e-3) assert_int_equal(none, WIDTH * HEIGHT);
        if (none) assert_true(most <= 1);
        picture_free(&p);
    }
}

/* A ray of the camera that is not one: the sample is black, transparent, and says nothing of a surface. */
static void refused_camera_rays_see_nothing(void **state) {
    stage *s = *state;
    kiln_film *f;
    must(kiln_film_create(&(kiln_film_desc){.width = 8, .height = 8}, &f, s->scene.report), s->scene.report, "a film");
    path_context c;
    must(context_make(s->renderer, &(kiln_render_options){.camera = &s->view}, f, &c, s->scene.report), s->scene.report,
         "a context");
    pixel_filter_make(&c.filter, KILN_PIXEL_BOX, 1e30);
    batch *b = aligned_array(1, sizeof *b);
    path_sample samples[64];
    for (uint32_t i = 0; i < 64; i++) samples[i] = (path_sample){i % 8, i / 8, 0, false};
    path_choose_tracer(NULL, NULL)(&c, samples, 64, b);
    for (int i = 0; i < 64; i++) {
        assert_int_equal(b->out.refused[i], 1);
        assert_true(b->out.alpha[i] == 0 && b->out.r[i] == 0 && b->out.g[i] == 0 && b->out.b[i] == 0);
    }
    free(b);
    kiln_film_destroy(f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_options_are_refused),         cmocka_unit_test(progress_is_told_while_threads_work),
        cmocka_unit_test(cancelling_keeps_what_was_reached), cmocka_unit_test(short_budgets_leave_no_holes),
        cmocka_unit_test(refused_camera_rays_see_nothing),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
