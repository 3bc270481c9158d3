/* job/study_reference.c: what errors are measured against: the mean of several independent renders, by an estimator and
 * by seeds that the base does not use, so that a mistake of the base shows. Their scatter tells the variance of the
 * mean, which errors are then relieved of. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/clock.h"
#include "base/file.h"
#include "image/image.h"
#include "job/study.h"

enum { PASSES = 8, PASSES_MAX = 32, PILOT_SPP = 8 };

/* A family of its own: see row_seeds. */
static const uint64_t reference_seeds = 1000000;

void study_free_reference(study_reference *r) {
    free(r->rgb);
    *r = (study_reference){0};
}

static size_t pixels_of(const study *s) { return (size_t)s->run.view.width * s->run.view.height; }

static bool allocate(study *s) {
    size_t count = pixels_of(s);
    study_reference *r = &s->reference;
    r->rgb = array_alloc(count, 9 * sizeof *r->rgb);
    if (!r->rgb) return report_no_memory(s->run.report, "making a reference");
    r->variance = r->rgb + 3 * count, r->display = r->variance + 3 * count;
    memset(r->rgb, 0, 9 * count * sizeof *r->rgb);
    return true;
}

static void finish(study *s) {
    study_reference *r = &s->reference;
    size_t count = pixels_of(s);
    double scale = exp2(s->run.exposure), sum = 0;
    for (size_t i = 0; i < 3 * count; i++) {
        double value = (double)r->rgb[i] * scale;
        sum += (double)r->variance[i] * scale * scale / (value * value + 0.01);
    }
    r->relative_variance = sum / (3 * (double)count);
    memcpy(r->display, r->rgb, 3 * count * sizeof *r->rgb);
    kiln_view_apply(s->run.display, r->display, count, 3);
}

static bool read_into(study *s, const char *path, float *values) {
    picture_pixels p;
    kiln_where where = where_root(path);
    if (!picture_read(path, &p, s->run.report)) return false;
    bool same = p.width == s->run.view.width && p.height == s->run.view.height;
    bool done = p.linear || report_error(s->run.report, KILN_CODE_IMAGE, &where, "give an .exr or .hdr file",
                                         "a reference has to be scene-linear");
    if (done && !same)
        done = report_error(s->run.report, KILN_CODE_IMAGE, &where, "render it again, or give --size",
                            "has %u x %u pixels, and the study %u x %u", p.width, p.height, s->run.view.width,
                            s->run.view.height);
    if (done) memcpy(values, p.rgb, 3 * pixels_of(s) * sizeof *values);
    picture_pixels_free(&p);
    return done;
}

static bool write_from(const study *s, const char *name, const float *values) {
    char *path = study_path(s, name);
    kiln_exr_channel channels[3] = {{"R", values, 3, true}, {"G", values + 1, 3, true}, {"B", values + 2, 3, true}};
    kiln_exr_file file = {.width = s->run.view.width, .height = s->run.view.height, .channels = channels,
                          .channel_count = 3};
    bool done = path && image_write_exr(path, &file, s->run.report);
    free(path);
    return done;
}

/* Error times time, as the film tells it. */
static bool try_estimator(study *s, kiln_estimator estimator, double *price, double *relmse) {
    job_options options = s->options;
    kiln_render_options o = {.spp = PILOT_SPP, .seed = reference_seeds - 1};
    kiln_film *film;
    kiln_render_stats stats;
    double cpu;
    options.estimator = estimator;
    bool done = study_render(s, &options, &o, &film, &stats, &cpu);
    if (done) {
        kiln_film_error e = kiln_film_estimate_error(film, exp2(s->run.exposure));
        *relmse = e.known ? e.relmse : INFINITY;
        *price = *relmse * cpu;
    }
    kiln_film_destroy(film);
    return done;
}

/* Of the two that are not the base's the one that gets further in the same time. */
static bool choose(study *s, kiln_estimator *chosen, double *base_relmse) {
    static const kiln_estimator sound[] = {KILN_ESTIMATOR_NEE, KILN_ESTIMATOR_BSDF, KILN_ESTIMATOR_MIS};
    double least = INFINITY, price, relmse;
    *chosen = s->options.estimator == KILN_ESTIMATOR_NEE ? KILN_ESTIMATOR_MIS : KILN_ESTIMATOR_NEE;
    for (size_t i = 0; i < sizeof sound / sizeof *sound; i++) {
        if (!try_estimator(s, sound[i], &price, &relmse)) return false;
        if (sound[i] == s->options.estimator) *base_relmse = relmse;
        else if (price < least) least = price, *chosen = sound[i];
    }
    return true;
}

static bool add_pass(study *s, const job_options *options, uint32_t pass, double *sums, double *squares, float *rgb) {
    kiln_render_options o = {.spp = s->reference.spp, .seed = s->options.seed + reference_seeds + pass};
    kiln_film *film;
    kiln_render_stats stats;
    double cpu;
    bool done = study_render(s, options, &o, &film, &stats, &cpu);
    if (done) {
        kiln_film_beauty(film, rgb);
        for (size_t i = 0; i < 3 * pixels_of(s); i++) {
            sums[i] += (double)rgb[i];
            squares[i] += (double)rgb[i] * (double)rgb[i];
        }
    }
    kiln_film_destroy(film);
    return done;
}

static void take_mean(study *s, uint32_t passes, const double *sums, const double *squares) {
    double n = passes;
    for (size_t i = 0; i < 3 * pixels_of(s); i++) {
        double mean = sums[i] / n;
        s->reference.rgb[i] = (float)mean;
        s->reference.variance[i] = (float)(fmax(squares[i] / n - mean * mean, 0) / (n - 1));
    }
    s->reference.passes = passes;
    finish(s);
}

/* Passes until the reference's own error is an eighth of the least that is to be measured, or enough is enough. */
static bool render_passes(study *s, kiln_estimator estimator, double goal) {
    size_t count = 3 * pixels_of(s);
    job_options options = s->options;
    double *sums = calloc(count, 2 * sizeof *sums);
    float *rgb = array_alloc(count, sizeof *rgb);
    bool done = (sums && rgb) || report_no_memory(s->run.report, "making a reference");
    options.estimator = estimator;
    for (uint32_t pass = 0; done && pass < PASSES_MAX; pass++) {
        study_tell(s, 0, 0);
        done = add_pass(s, &options, pass, sums, sums + count, rgb);
        if (!done || pass + 1 < PASSES) continue;
        take_mean(s, pass + 1, sums, sums + count);
        if (s->reference.relative_variance <= goal) break;
    }
    free(sums);
    free(rgb);
    return done;
}

static const char *name_of(kiln_estimator estimator) {
    const option_row *row = option_find(&job_option_table, "estimator");
    for (const option_choice *c = row->choices; c->name; c++)
        if (c->value == (int)estimator) return c->name;
    return "";
}

static bool keep(const study *s) {
    const study_reference *r = &s->reference;
    json_t *o = json_object();
    put_text(o, "made_by", r->made_by);
    put_count(o, "spp", r->spp);
    put_count(o, "passes", r->passes);
    put_number(o, "seconds", r->seconds);
    put_number(o, "map_end", s->map_end);
    char *text = json_dumps(o, JSON_INDENT(1)), *path = study_path(s, "reference.json");
    json_decref(o);
    bool done = text && path && write_from(s, "reference.exr", r->rgb) &&
                write_from(s, "reference_variance.exr", r->variance) &&
                file_replace(path, text, strlen(text), s->run.report); /* last: it says that the others are whole */
    free(text);
    free(path);
    return done;
}

/* One that an interrupted study has left. */
static bool restore(study *s) {
    char *path = study_path(s, "reference.json"), *rgb = study_path(s, "reference.exr"),
         *variance = study_path(s, "reference_variance.exr");
    study_reference *r = &s->reference;
    json_t *o = path ? json_load_file(path, 0, NULL) : NULL;
    kiln_report *silent = s->run.report;
    s->run.report = kiln_report_create();
    bool there = o && s->run.report && rgb && variance && read_into(s, rgb, r->rgb) &&
                 read_into(s, variance, r->variance);
    kiln_report_destroy(s->run.report);
    s->run.report = silent;
    if (there) {
        const char *made_by = json_string_value(json_object_get(o, "made_by"));
        strncpy(r->made_by, made_by ? made_by : "", sizeof r->made_by - 1);
        r->spp = (uint32_t)json_integer_value(json_object_get(o, "spp"));
        r->passes = (uint32_t)json_integer_value(json_object_get(o, "passes"));
        r->seconds = json_number_value(json_object_get(o, "seconds"));
        s->map_end = json_number_value(json_object_get(o, "map_end"));
        finish(s);
    }
    json_decref(o);
    free(path), free(rgb), free(variance);
    return there;
}

static bool make(study *s) {
    const study_config *base = &s->plan.configs[0];
    study_reference *r = &s->reference;
    uint32_t top = base->levels[base->level_count - 1];
    const char *file = s->options.reference;
    double started = clock_seconds(), base_relmse = 0, price;
    kiln_estimator estimator;
    if (file) {
        if (!read_into(s, file, r->rgb) || !try_estimator(s, s->options.estimator, &price, &base_relmse)) return false;
        finish(s);
    } else {
        if (!choose(s, &estimator, &base_relmse)) return false;
        strncpy(r->made_by, name_of(estimator), sizeof r->made_by - 1);
        r->spp = top;
        if (!render_passes(s, estimator, base_relmse * PILOT_SPP / top / 8)) return false;
    }
    r->seconds = clock_seconds() - started;
    /* Twice the root of the base's error: most pixels lie below. */
    s->map_end = 2 * sqrt(base_relmse * PILOT_SPP / top);
    if (!(s->map_end > 0) || !isfinite(s->map_end)) s->map_end = 1;
    return keep(s);
}

bool study_make_reference(study *s) {
    return allocate(s) && ((s->resumed && restore(s)) || make(s));
}
