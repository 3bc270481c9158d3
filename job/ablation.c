/* job/ablation.c: what an effect does to the picture and to the time: the same picture again, with it. */
#include <math.h>

#include "job/effects.h"
#include "job/run.h"

/* Samples of the picture that is compared with: the difference needs no more, for its noise cancels. */
enum { COMPARED_SPP = 64 };

static double seconds_per_sample(const kiln_render_stats *s, const kiln_film *f) {
    return s->seconds / (double)kiln_film_samples(f);
}

static bool compare(job_run *r, const kiln_renderer *whole) {
    kiln_film_desc shape = kiln_film_describe(r->film);
    kiln_film_desc desc = {.width = shape.width, .height = shape.height, .threads = shape.threads};
    for (int k = 0; k < 4; k++) desc.crop[k] = shape.crop[k];
    kiln_render_options options = run_render_options(r);
    options.spp = r->stats.spp < COMPARED_SPP ? r->stats.spp : COMPARED_SPP;
    options.noise = options.budget_seconds = 0;
    options.progress = NULL;
    kiln_film *film;
    kiln_render_stats stats;
    if (!kiln_film_create(&desc, &film, r->report)) return false;
    bool done = kiln_render(whole, &options, film, &stats, r->report);
    if (done && stats.stop != KILN_STOP_CANCELLED) {
        r->ablation.difference = kiln_film_compare(r->film, film, exp2(r->exposure));
        r->ablation.time = seconds_per_sample(&r->stats, r->film) / seconds_per_sample(&stats, film);
    }
    kiln_film_destroy(film);
    return done;
}

static void tell(const job_run *r) {
    kiln_text names = {0};
    const job_ablation *a = &r->ablation;
    effects_list(a->removed, &names);
    if (a->difference.known)
        run_log(r, "without %s the picture differs by %.3g%%, has %+.3g%% light, and a sample takes %+.0f%% time",
                names.data, 100 * a->difference.root, 100 * a->difference.light, 100 * (a->time - 1));
    else run_log(r, "without %s: too little was rendered to tell by how much the picture differs", names.data);
    text_free(&names);
}

bool run_compare(job_run *r) {
    uint64_t removed = r->options->effects.removed;
    if (!removed || !r->stats.spp || r->stats.stop == KILN_STOP_CANCELLED) return true;
    kiln_renderer_options options = run_renderer_options(r);
    options.effects.removed = 0;
    kiln_renderer *whole;
    if (!kiln_renderer_create(r->scene, &options, &whole, r->report)) return false;
    kiln_effect_plan plan = kiln_renderer_describe_effects(whole, &r->view.camera);
    uint64_t idle = removed & ~plan.called;
    r->ablation.removed = removed & plan.called;
    if (idle) {
        kiln_text names = {0};
        effects_list(idle, &names);
        run_log(r, "the scene does not call for %s: nothing was dropped", names.data);
        text_free(&names);
    }
    bool done = !r->ablation.removed || compare(r, whole);
    kiln_renderer_destroy(whole);
    if (done && r->ablation.removed) tell(r);
    return done;
}
