#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "job/exposure.h"
#include "job/machine.h"
#include "job/metadata.h"
#include "job/run.h"
#include "scene/scene.h"

static bool needs_alpha(const job_run *r) { return r->options->background.kind != KILN_BACKGROUND_ENVIRONMENT; }

/* The picture in memory at most once as floats beside the film: RGBA and all layers. */
static uint64_t output_bytes(const kiln_film_desc *d) {
    uint64_t floats = 4 + 3 * (uint64_t)d->part_count;
    for (int a = 0; a < KILN_AOV_COUNT; a++) floats += d->aovs >> a & 1 ? 3 : 0;
    for (int m = 0; m < KILN_MATTE_COUNT; m++) floats += d->mattes >> m & 1 ? 2 * KILN_MATTE_RANKS : 0;
    return floats * sizeof(float);
}

/* Parts of the picture have nothing behind them, and what sums to them has not either. */
static void note_background(const job_run *r) {
    if (r->film_desc.part_count && r->options->background.kind == KILN_BACKGROUND_COLOR)
        report_note(r->report, KILN_CODE_IGNORED, NULL, "put the colour behind it when you have put it together",
                    "with parts of the picture, .exr files have alpha in place of the background's colour");
}

static bool check_memory(const job_run *r, uint64_t bytes) {
    kiln_where where = where_root("--size");
    uint64_t machine = machine_memory();
    if (!machine || bytes <= machine / 4 * 3) return true;
    return report_error(r->report, job_given(r->options, size) ? KILN_CODE_USAGE : KILN_CODE_MEMORY, &where,
                        "render a smaller picture, or crops of it, or ask for fewer layers",
                        "%u x %u pixels need %.1f GB, and the machine has %.1f GB", r->view.width, r->view.height,
                        (double)bytes * 1e-9, (double)machine * 1e-9);
}

bool run_film(job_run *r) {
    const job_options *o = r->options;
    kiln_film_desc *d = &r->film_desc;
    *d = (kiln_film_desc){.width = r->view.width, .height = r->view.height, .aovs = o->layers.aovs,
                          .mattes = o->layers.mattes, .threads = o->threads};
    memcpy(d->crop, o->crop, sizeof o->crop);
    if (needs_alpha(r)) d->aovs |= 1u << KILN_AOV_ALPHA;
    if (o->crop[2] > r->view.width || o->crop[3] > r->view.height) {
        kiln_where where = where_root("--crop");
        return report_error(r->report, KILN_CODE_USAGE, &where,
                            "give X0,Y0,X1,Y1 in pixels, right and bottom exclusive",
                            "%u,%u,%u,%u is not a part of %u x %u pixels", o->crop[0], o->crop[1], o->crop[2],
                            o->crop[3], r->view.width, r->view.height);
    }
    if (!layers_parts(&o->layers, r->scene, &d->parts, &d->part_count, r->report)) return false;
    uint64_t pixels = o->crop[2] ? (uint64_t)(o->crop[2] - o->crop[0]) * (o->crop[3] - o->crop[1])
                                 : (uint64_t)r->view.width * r->view.height;
    bool done = check_memory(r, kiln_film_size(d) + pixels * output_bytes(d)) &&
                kiln_film_create(d, &r->film, r->report);
    note_background(r);
    free((void *)d->parts);
    d->parts = NULL;
    return done;
}

kiln_renderer_options run_renderer_options(const job_run *r) {
    const job_options *o = r->options;
    return (kiln_renderer_options){.threads = o->threads,
                                   .embree_config = o->embree_config,
                                   .decoding = &r->decoding,
                                   .texture_filter = o->texture_filter,
                                   .effects = o->effects};
}

bool run_build(job_run *r) {
    if (r->renderer) return true;
    kiln_renderer_options options = run_renderer_options(r);
    if (!kiln_renderer_create(r->scene, &options, &r->renderer, r->report)) return false;
    r->memory = kiln_renderer_describe_memory(r->renderer);
    r->plan = kiln_renderer_describe_effects(r->renderer, &r->view.camera);
    return true;
}

bool run_plan(job_run *r) {
    kiln_renderer_options options = run_renderer_options(r);
    return kiln_plan_effects(r->scene, &r->view.camera, &options, &r->plan, r->report);
}

kiln_render_options run_render_options(const job_run *r) {
    const job_options *o = r->options;
    return (kiln_render_options){.camera = &r->view.camera,
                                 .spp = r->rules.spp,
                                 .noise = r->rules.noise,
                                 .error_scale = exp2(r->exposure),
                                 .budget_seconds = r->rules.budget_seconds,
                                 .adaptive = o->adaptive,
                                 .seed = o->seed,
                                 .max_depth = o->max_depth ? o->max_depth : KILN_DEPTH_ZERO,
                                 .estimator = o->estimator,
                                 .roulette = o->roulette,
                                 .sampler = o->sampler,
                                 .light_sampling = o->light_sampling,
                                 .filter = o->filter.kind,
                                 .filter_width = o->filter.width,
                                 /* A background colour is put behind the finished picture. */
                                 .background =
                                     needs_alpha(r) ? KILN_BACKGROUND_TRANSPARENT : KILN_BACKGROUND_ENVIRONMENT,
                                 .cancel = r->events->cancel,
                                 .progress = r->events->progress,
                                 .progress_user = r->events->user};
}

bool run_try_emitters(job_run *r) {
    bool lit;
    kiln_render_options options = run_render_options(r);
    if (!run_build(r) ||
        !exposure_is_lit(r->renderer, &options, r->view.width, r->view.height, &lit, r->report))
        return false;
    if (lit) return true;
    r->lighting.dim = true;
    kiln_renderer_destroy(r->renderer);
    r->renderer = NULL;
    r->lighting.kind = JOB_LIGHT_STUDIO;
    scene_set_open(r->scene, true);
    bool done = lighting_apply(&r->lighting, r->options, &r->view.camera, r->scene, r->report);
    scene_set_open(r->scene, false);
    return done;
}

/* Only what is shown, or judged by its noise, needs an exposure. */
static bool needs_exposure(const job_run *r) {
    bool judged = outputs_any(&r->outputs, OUTPUT_DISPLAY) || r->rules.noise > 0;
    return judged && r->lighting.punctual && !job_given(r->options, exposure);
}

bool run_expose(job_run *r) {
    if (!needs_exposure(r)) return true;
    kiln_render_options options = run_render_options(r);
    if (!exposure_choose(r->renderer, &options, r->view.width, r->view.height, &r->exposure, r->report)) return false;
    r->exposure_chosen = true;
    kiln_view *again;
    kiln_view_options view = {r->options->display, r->options->view, r->options->look, r->exposure};
    if (!kiln_view_create(r->color, &view, &again, r->report)) return false;
    kiln_view_destroy(r->display);
    r->display = again;
    run_log(r, "the lights are in candela and lux: an exposure of %+.1f stops was chosen (--exposure overrides it)",
            r->exposure);
    return true;
}

static void warn_of_discarded(const job_run *r) {
    static const char *const causes[KILN_DISCARD_COUNT] = {
        [KILN_DISCARD_RAY] = "a ray that was not one",
        [KILN_DISCARD_RADIANCE] = "a radiance that is not a number",
        [KILN_DISCARD_OVERFLOW] = "a value beyond what the film holds",
    };
    for (int d = 0; d < KILN_DISCARD_COUNT; d++) {
        kiln_where where = where_root(r->source);
        if (!r->stats.discarded[d]) continue;
        report_warning(r->report, KILN_CODE_INTERNAL, &where, NULL,
                       "%llu samples lost light to %s, the first in pixel %u,%u",
                       (unsigned long long)r->stats.discarded[d], causes[d], r->stats.discarded_pixel[d][0],
                       r->stats.discarded_pixel[d][1]);
    }
}

static bool is_interrupted(const job_run *r) { return r->stats.stop == KILN_STOP_CANCELLED; }

static void warn_of_holes(const job_run *r) {
    kiln_where where = where_root("--budget");
    if (!r->stats.unsampled || is_interrupted(r)) return;
    report_warning(r->report, KILN_CODE_USAGE, &where, "give it more time, or make a smaller picture",
                   "the time was up before every pixel had a sample: %llu pixels are black",
                   (unsigned long long)r->stats.unsampled);
}

static void warn_of_estimator(const job_run *r) {
    kiln_where where = where_root("--estimator");
    kiln_estimator e = r->options->estimator;
    if (e == KILN_ESTIMATOR_NAIVE || e == KILN_ESTIMATOR_DOUBLED)
        report_warning(r->report, KILN_CODE_USAGE, &where, "use bsdf, nee or mis",
                       "this estimator is wrong on purpose: the picture %s",
                       e == KILN_ESTIMATOR_NAIVE ? "lacks light" : "has light twice");
}

/* About, of formats with their usual settings. */
static double seconds_of_writing(const job_run *r) {
    const double nanoseconds[] = {[OUTPUT_DISPLAY] = 200, [OUTPUT_EXR] = 400, [OUTPUT_HDR] = 80, [OUTPUT_UNKNOWN] = 0};
    double each = 0;
    for (uint32_t i = 0; i < r->outputs.count; i++) each += nanoseconds[r->outputs.items[i].kind];
    return 1e-9 * each * r->view.width * r->view.height;
}

/* --budget is for the whole run: what has gone, and what writing will take, is not there for samples; some always is. */
static double budget_left(const job_run *r) {
    double budget = r->rules.budget_seconds, left = budget - (clock_seconds() - r->started) - seconds_of_writing(r);
    const double least = 0.05;
    return budget > 0 ? fmax(left, least * budget) : 0;
}

/* What takes no longer is soon known. */
#define WORTH_FORETELLING 5.0

static void tell_prediction(const kiln_prediction *p, void *user) {
    const job_run *r = user;
    kiln_text line = {0};
    double goal = 100 * r->rules.noise, before = clock_seconds() - r->started;
    if (fmax(p->seconds, p->noise_seconds) < WORTH_FORETELLING) return;
    if (p->noise_seconds >= 0) text_format(&line, "%g%% needs about %.0f s on this machine", goal, before + p->noise_seconds);
    if (p->noise_seconds < 0 || p->noise_seconds > p->seconds)
        text_format(&line, "%sin %.0f s the error will be about %.2g%%", line.length ? "; " : "", before + p->seconds,
                    100 * p->error);
    run_log(r, "%s", line.data ? line.data : "");
    text_free(&line);
}

bool run_render(job_run *r) {
    kiln_render_options options = run_render_options(r);
    options.budget_seconds = budget_left(r);
    options.predict = tell_prediction;
    options.predict_user = r;
    r->rendered = true;
    warn_of_estimator(r);
    if (!kiln_render(r->renderer, &options, r->film, &r->stats, r->report)) return false;
    r->error = kiln_film_estimate_error(r->film, exp2(r->exposure));
    warn_of_discarded(r);
    warn_of_holes(r);
    if (r->error.known && r->error.heavy_tail)
        report_note(r->report, KILN_CODE_IGNORED, NULL, NULL,
                    "one pixel in a hundred holds most of the error: rare bright paths are at work, and the estimate "
                    "of the noise may be too low");
    if (r->stats.lost_energy > 0.001)
        report_note(r->report, KILN_CODE_IGNORED, NULL, "raise --max-depth",
                    "the depth limit cuts an estimated %.1f %% of the light", 100 * r->stats.lost_energy);
    return true;
}

/* sRGB's curve (IEC 61966-2-1), then from linear Rec.709 into the working space. */
static void background_to_working(const job_run *r, float out[3]) {
    double linear[3];
    const float *m = r->decoding.matrix[KILN_TRANSFER_LINEAR];
    for (int k = 0; k < 3; k++) {
        double v = r->options->background.rgb[k] / 255.0;
        linear[k] = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    }
    for (int k = 0; k < 3; k++)
        out[k] =
            (float)((double)m[3 * k] * linear[0] + (double)m[3 * k + 1] * linear[1] + (double)m[3 * k + 2] * linear[2]);
}

bool run_write(job_run *r) {
    if (is_interrupted(r) && !kiln_film_samples(r->film)) return true; /* before anything could be seen */
    const job_background *b = &r->options->background;
    job_metadata metadata;
    if (!metadata_make(&metadata, r)) return report_no_memory(r->report, "writing pictures");
    picture p = {.film = r->film, .color = r->color, .view = r->display,
                 .transparent = b->kind == KILN_BACKGROUND_TRANSPARENT, .layers = r->options->layers.aovs,
                 .background = b->kind == KILN_BACKGROUND_COLOR ? b->rgb : NULL,
                 .threads = r->options->threads,
                 .text = metadata.text, .text_count = metadata.text_count,
                 .attributes = metadata.attributes, .attribute_count = metadata.attribute_count};
    background_to_working(r, p.background_linear);
    bool all = true;
    for (uint32_t i = 0; i < r->outputs.count; i++) {
        output *out = &r->outputs.items[i];
        out->written = picture_write(&p, out->path, r->report);
        r->outputs_written += out->written;
        all = all && out->written;
    }
    metadata_free(&metadata);
    return all;
}

bool run_check_strict(job_run *r) {
    uint64_t warnings = kiln_report_count(r->report, KILN_WARNING);
    if (!r->options->strict || !warnings) return true;
    kiln_where where = where_root(r->source);
    return report_error(r->report, KILN_CODE_STRICT, &where, "mend what the warnings say, or leave out --strict",
                        "%llu warning%s, and --strict was given", (unsigned long long)warnings,
                        warnings == 1 ? "" : "s");
}

int run_exit_code(const job_run *r) {
    enum { NOISE_MISSED = 4 };
    int code = kiln_report_exit_code(r->report);
    return code ? code : run_missed_noise(r) ? NOISE_MISSED : 0;
}

bool run_missed_noise(const job_run *r) {
    bool asked = job_given(r->options, noise_percent) && r->rules.noise > 0;
    bool reached = r->stats.stop == KILN_STOP_NOISE || (r->error.known && sqrt(r->error.relmse) <= r->rules.noise);
    return r->rendered && asked && !reached;
}
