/* render/render.c: passes over a film until a stop rule holds. */
#include "kiln/render.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/threads.h"
#include "render/adaptive.h"
#include "render/context.h"
#include "render/pass.h"
#include "render/predict.h"
#include "render/record.h"
#include "scene/transfer.h"

static bool check_committed(const kiln_scene *scene, kiln_report *report) {
    return scene->committed ||
           report_error(report, KILN_CODE_USAGE, NULL, "call kiln_scene_commit first", "the scene is not committed");
}

static world_build_options build_options(const kiln_renderer_options *o, const kiln_decoding *decoding, uint32_t threads) {
    return (world_build_options){.decoding = decoding, .filter = o->texture_filter, .effects = o->effects,
                                 .threads = threads, .embree_config = o->embree_config};
}

bool kiln_renderer_create(const kiln_scene *scene, const kiln_renderer_options *options, kiln_renderer **renderer,
                          kiln_report *report) {
    static const kiln_renderer_options defaults;
    if (!options) options = &defaults;
    *renderer = NULL;
    if (!check_committed(scene, report)) return false;
    kiln_decoding rec709;
    transfer_rec709(&rec709);
    bool given = options->decoding && options->decoding->present;
    kiln_renderer *r = calloc(1, sizeof *r);
    if (!r) return report_no_memory(report, "making the renderer");
    r->scene = scene;
    r->threads = options->threads ? options->threads : threads_available();
    world_build_options build = build_options(options, given ? options->decoding : &rec709, r->threads);
    if (!world_create(scene, &build, &r->world, report)) {
        free(r);
        return false;
    }
    *renderer = r;
    return true;
}

bool kiln_plan_effects(const kiln_scene *scene, const kiln_camera *view, const kiln_renderer_options *options,
                       kiln_effect_plan *plan, kiln_report *report) {
    static const kiln_renderer_options defaults;
    if (!options) options = &defaults;
    if (!check_committed(scene, report)) return false;
    world_build_options build = build_options(options, NULL, options->threads ? options->threads : threads_available());
    if (!world_plan(scene, &build, plan, report)) return false;
    scan_camera(scene, view ? view : kiln_scene_camera(scene, 1), plan);
    return true;
}

kiln_effect_plan kiln_renderer_describe_effects(const kiln_renderer *r, const kiln_camera *view) {
    kiln_effect_plan plan = r->world->plan;
    scan_camera(r->scene, view ? view : kiln_scene_camera(r->scene, 1), &plan);
    return plan;
}

void kiln_renderer_destroy(kiln_renderer *r) {
    if (!r) return;
    world_destroy(r->world);
    free(r);
}

static const kiln_render_options no_options;

/* A render under way. */
typedef struct run {
    const kiln_render_options *options;
    kiln_film *film;
    pass pass;
    uint32_t spp_limit;
    double started, last_tick, error, scale;
    uint64_t samples_before; /* that the film came with */
    uint32_t spp_before, spp; /* in every pixel, or the mean (is_adaptive): then, and after the last pass */
    uint32_t *targets; /* by pixel; NULL: samples are not adaptive */
    kiln_prediction prediction;
} run;

static uint32_t samples_per_pixel(const run *r) {
    uint64_t pixels = (uint64_t)r->film->width * r->film->height;
    uint32_t least = kiln_film_spp(r->film);
    /* Planning rounds by up to a step in all. */
    return r->targets && least >= ADAPTIVE_SPP_MIN ? (uint32_t)((kiln_film_samples(r->film) + pixels / 2) / pixels) : least;
}

static double seconds(const run *r) { return clock_seconds() - r->started; }

/* Share of the work that is done, by the rule that will end it first; 0: no idea yet. */
static double fraction(const run *r, uint64_t samples) {
    const kiln_render_options *o = r->options;
    double pixels = (double)r->film->width * r->film->height, spp = (double)(samples + r->samples_before) / pixels;
    double by_spp = spp / r->spp_limit, by_time = o->budget_seconds > 0 ? seconds(r) / o->budget_seconds : 0;
    double needed = o->noise > 0 && r->error > 0 ? fmax(spp * pow(r->error / o->noise, 2), spp) : 0;
    double by_noise = needed > 0 ? spp / exp2(ceil(log2(needed))) : 0;
    return fmin(fmax(fmax(by_spp, by_time), by_noise), 1);
}

static void report_progress(run *r) {
    uint64_t samples = pass_samples(&r->pass);
    double done = fraction(r, samples), elapsed = seconds(r);
    kiln_progress p = {.spp_done = r->spp,
                       .samples = samples,
                       .fraction = done,
                       .seconds = elapsed,
                       .seconds_left = done > 0.001 ? elapsed * (1 - done) / done : -1,
                       .error = r->error};
    r->options->progress(&p, r->options->progress_user);
}

static void tick(void *user) {
    run *r = user;
    double now = clock_seconds();
    if (!r->options->progress || now - r->last_tick < 0.1) return;
    r->last_tick = now;
    report_progress(r);
}

/* Powers of two, so that what --noise decides on does not depend on the machine. With a budget one sample comes first,
 * so that the time is enough for a whole picture if it can be, and then smaller steps, so that little is left
 * unfinished when it is up. */
static uint32_t next_target(const run *r) {
    uint32_t next = r->options->budget_seconds > 0 ? 1 : 4, spp = r->spp;
    while (next <= spp) next *= 2;
    if (r->options->budget_seconds > 0 && spp > r->spp_before) {
        double each = seconds(r) / (spp - r->spp_before), step = 0.1 * r->options->budget_seconds / each;
        if (spp + step < next) next = spp + (step > 1 ? (uint32_t)step : 1);
        if (next > 4) next = (next + 3) / 4 * 4; /* which packets of camera rays hold */
    }
    return next < r->spp_limit ? next : r->spp_limit;
}

static bool is_power_of_two(uint32_t n) { return n && !(n & (n - 1)); }

/* Fewer samples are not evidence enough to stop on. */
enum { NOISE_SPP_MIN = 16 };

/* With a budget early, for there may be no more than a few samples. Not of a film that came with samples: what they took
 * is not known. */
static void foretell(run *r) {
    uint32_t enough = r->options->budget_seconds > 0 ? 4 : NOISE_SPP_MIN;
    if (r->prediction.spp || r->error < 0 || r->spp < enough || r->spp_before) return;
    predict_pilot pilot = {r->spp, seconds(r), r->error, r->targets ? adaptive_gain(r->film, r->scale) : 1};
    r->prediction = predict(&pilot, r->options, r->spp_limit);
    if (r->options->predict) r->options->predict(&r->prediction, r->options->predict_user);
}

/* The estimate takes as long as a sample or so in every pixel: it is made when somebody wants it. */
static bool is_quiet_enough(run *r) {
    const kiln_render_options *o = r->options;
    if (!is_power_of_two(r->spp) || !(o->noise > 0 || o->progress || o->predict)) return false;
    kiln_film_error e = kiln_film_estimate_error(r->film, r->scale);
    r->error = e.known ? sqrt(e.relmse) : -1;
    foretell(r);
    return o->noise > 0 && r->spp >= NOISE_SPP_MIN && e.known && r->error <= o->noise;
}

/* Where the samples of the next pass go. What cannot be planned is spread evenly. */
static void aim(run *r) {
    uint64_t pixels = (uint64_t)r->film->width * r->film->height;
    r->pass.target = next_target(r);
    bool planned = r->targets && r->spp >= ADAPTIVE_SPP_MIN &&
                   adaptive_plan(r->film, r->scale, r->pass.target * pixels, r->targets);
    r->pass.targets = planned ? r->targets : NULL;
}

static kiln_stop run_passes(run *r) {
    const kiln_render_options *o = r->options;
    for (;;) {
        r->spp = samples_per_pixel(r);
        if (is_quiet_enough(r)) return KILN_STOP_NOISE;
        if (r->spp >= r->spp_limit) return KILN_STOP_SPP;
        aim(r);
        pass_run(&r->pass);
        if (o->cancel && __atomic_load_n(o->cancel, __ATOMIC_RELAXED)) return KILN_STOP_CANCELLED;
        if (atomic_load(&r->pass.stopped)) return KILN_STOP_BUDGET;
    }
}

static void collect(run *r, kiln_stop stop, kiln_render_stats *stats) {
    r->spp = samples_per_pixel(r);
    *stats = (kiln_render_stats){.stop = stop, .spp = r->spp, .adaptive = r->targets != NULL,
                                 .spp_least = kiln_film_spp(r->film), .seconds = seconds(r), .lost_energy = -1,
                                 .prediction = r->prediction};
    pass_stage_seconds(&r->pass, stats->stage_seconds);
    stats->waiting_seconds = stats->seconds * r->pass.threads;
    for (int s = 0; s < KILN_STAGE_COUNT; s++) stats->waiting_seconds -= stats->stage_seconds[s];
    if (stats->waiting_seconds < 0) stats->waiting_seconds = 0; /* readings of two clocks */
    fixed beyond = 0, kept = 0;
    uint64_t first[KILN_DISCARD_COUNT];
    memset(first, 0xff, sizeof first);
    for (uint32_t t = 0; t < r->pass.threads; t++) {
        const pass_worker *w = &r->pass.workers[t];
        stats->camera_rays += w->batch->camera_rays.rays;
        stats->bounce_rays += w->batch->bounce_rays.rays;
        stats->shadow_rays += w->batch->shadow_rays.rays;
        for (int k = 0; k < 3; k++) r->film->beyond[k] += w->beyond[k];
        for (int d = 0; d < KILN_DISCARD_COUNT; d++) {
            stats->discarded[d] += w->discarded[d];
            if (w->discarded_first[d] < first[d]) first[d] = w->discarded_first[d];
        }
    }
    for (int d = 0; d < KILN_DISCARD_COUNT; d++) {
        if (!stats->discarded[d]) continue;
        stats->discarded_pixel[d][0] = (uint32_t)(first[d] % r->film->desc.width);
        stats->discarded_pixel[d][1] = (uint32_t)(first[d] / r->film->desc.width);
    }
    for (size_t i = 0; i < (size_t)r->film->width * r->film->height; i++) {
        uint32_t count = r->film->counts[i];
        stats->unsampled += count == 0;
        stats->spp_most = count > stats->spp_most ? count : stats->spp_most;
        for (int s = 0; s < KILN_REPLICATES; s++)
            for (int k = 0; k < 3; k++) kept += r->film->pixels[i].sum[s][k];
    }
    for (int k = 0; k < 3; k++) beyond += r->film->beyond[k];
    double lost = PROBE_EVERY * fixed_to_double(beyond), all = lost + fixed_to_double(kept);
    if (all > 0) stats->lost_energy = lost / all;
}

/* A context that holds in every detail, with the film made ready for it. */
static bool prepare(const kiln_renderer *renderer, const kiln_render_options *o, kiln_film *film, path_context *context,
                    path_parts_plan *parts, kiln_report *report) {
    *parts = (path_parts_plan){0};
    bool done = context_make(renderer, o, film, context, report) && context_name_mattes(renderer, film, report) &&
                context_plan_parts(renderer, film, parts, report);
    if (parts->count) context->parts = parts;
    return done;
}

static bool is_adaptive(const kiln_render_options *o) {
    bool judged = o->noise > 0 || o->budget_seconds > 0;
    return o->adaptive == KILN_ADAPTIVE_ON || (o->adaptive == KILN_ADAPTIVE_AUTO && judged);
}

static bool render(const kiln_renderer *renderer, const kiln_render_options *o, const path_context *context,
                   kiln_film *film, ray_tape *tapes, kiln_render_stats *stats, kiln_report *report) {
    run r = {.options = o, .film = film, .started = clock_seconds(), .error = -1,
             .scale = o->error_scale > 0 ? o->error_scale : 1};
    bool any_rule = o->spp || o->noise > 0 || o->budget_seconds > 0;
    r.spp_limit = o->spp ? o->spp : any_rule ? FIXED_SAMPLES_MAX : 64;
    r.samples_before = kiln_film_samples(film);
    r.pass = (pass){.context = context, .film = film, .threads = renderer->threads, .cancel = o->cancel, .tick = tick,
                    .tick_user = &r,
                    .tapes = tapes, .shuffle = o->tile_shuffle,
                    .batch_size = o->batch_size && o->batch_size < BATCH_PATHS ? lanes_round_up(o->batch_size) : BATCH_PATHS,
                    .deadline = o->budget_seconds > 0 ? r.started + o->budget_seconds : 0};
    r.pass.tracer = path_choose_tracer(o->isa, NULL);
    if (!r.pass.tracer)
        return report_error(report, KILN_CODE_USAGE, NULL, "leave it out", "this machine cannot run the instance '%s'", o->isa);
    if (is_adaptive(o)) r.targets = array_alloc((size_t)film->width * film->height, sizeof *r.targets);
    bool done = (pass_make_workers(&r.pass) && (r.targets || !is_adaptive(o))) ||
                report_no_memory(report, "starting the render");
    r.spp = r.spp_before = samples_per_pixel(&r);
    if (done) {
        kiln_stop stop = run_passes(&r);
        kiln_render_stats own;
        collect(&r, stop, stats ? stats : &own);
        if (o->progress) report_progress(&r);
    }
    pass_free_workers(&r.pass);
    free(r.targets);
    return done;
}

bool render_recorded(const kiln_renderer *renderer, const kiln_render_options *options, kiln_film *film,
                     ray_tape *tapes, kiln_render_stats *stats, kiln_report *report) {
    const kiln_render_options *o = options ? options : &no_options;
    path_context context;
    path_parts_plan parts;
    bool done = prepare(renderer, o, film, &context, &parts, report) &&
                render(renderer, o, &context, film, tapes, stats, report);
    context_free_parts(&parts);
    return done;
}

bool kiln_render(const kiln_renderer *renderer, const kiln_render_options *options, kiln_film *film,
                 kiln_render_stats *stats, kiln_report *report) {
    return render_recorded(renderer, options, film, NULL, stats, report);
}

uint32_t renderer_threads(const kiln_renderer *r) { return r->threads; }

double renderer_replay(const kiln_renderer *r, const ray_tape *tapes) {
    return tapes_replay(r->world, tapes, r->threads, r->threads);
}

uint64_t renderer_compare(const kiln_renderer *r, const ray_tape *tapes) {
    return tapes_compare(r->world, tapes, r->threads, r->threads);
}
