/* job/study_measure.c: one row of a study. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/clock.h"
#include "image/image.h"
#include "image/ramp.h"
#include "job/bench.h"
#include "job/compare.h"
#include "job/study.h"
#include "kiln/compare.h"

/* Seeds of rows and of references are of two families that never meet. */
static const uint64_t row_seeds = 1000;

static bool same_scene(const job_options *a, const job_options *b) {
    return a->subdivide.mode == b->subdivide.mode && a->subdivide.level == b->subdivide.level &&
           a->scheme == b->scheme && a->crease_angle_deg == b->crease_angle_deg;
}

static bool same_renderer(const job_options *a, const job_options *b) {
    return a->texture_filter == b->texture_filter && a->effects.forced == b->effects.forced &&
           a->effects.removed == b->effects.removed;
}

typedef struct inner {
    const study *study;
    uint32_t spp;
} inner;

static void on_progress(const kiln_progress *p, void *user) {
    const inner *i = user;
    study_tell(i->study, (uint64_t)(p->fraction * i->spp), i->spp);
}

static bool render_with(study *s, job_run *r, kiln_render_options *changes, kiln_film **film, kiln_render_stats *stats,
                        double *cpu) {
    inner in = {s, changes->spp};
    kiln_render_options o = run_render_options(r);
    kiln_film_desc desc = {.width = s->run.view.width, .height = s->run.view.height, .threads = r->options->threads};
    o.spp = changes->spp, o.seed = changes->seed;
    o.noise = o.budget_seconds = 0;
    o.camera = &s->run.view.camera; /* of the base: a refined scene may be framed a little differently */
    o.progress = on_progress, o.progress_user = &in;
    *film = NULL;
    if (!kiln_film_create(&desc, film, r->report)) return false;
    double before = clock_cpu_seconds();
    bool done = kiln_render(r->renderer, &o, *film, stats, r->report);
    *cpu = clock_cpu_seconds() - before;
    if (done && stats->stop == KILN_STOP_CANCELLED)
        done = report_error(r->report, KILN_CODE_CANCELLED, NULL, "run it again to go on",
                            "interrupted after %u of %u renders", s->row_count, s->row_total);
    return done;
}

bool study_render(study *s, const job_options *options, kiln_render_options *changes, kiln_film **film,
                  kiln_render_stats *stats, double *cpu) {
    const job_options *base = s->run.options;
    const kiln_job_events quiet = {.cancel = s->run.events->cancel};
    *film = NULL;
    if (!same_scene(options, base)) {
        job_run other;
        bool done = run_start(&other, options, &quiet, s->source, s->run.report) && bench_prepare(&other, NULL) &&
                    render_with(s, &other, changes, film, stats, cpu);
        run_free(&other);
        return done;
    }
    job_run borrowed = s->run;
    borrowed.options = options;
    if (same_renderer(options, base)) return render_with(s, &borrowed, changes, film, stats, cpu);
    borrowed.renderer = NULL;
    bool done = run_build(&borrowed) && render_with(s, &borrowed, changes, film, stats, cpu);
    kiln_renderer_destroy(borrowed.renderer);
    return done;
}

typedef struct pictures {
    float *rgb, *half[2], *display, *map;
    uint32_t width, height;
    bool halves; /* there are */
} pictures;

static bool make_pictures(const study *s, const kiln_film *film, pictures *p) {
    size_t count = (size_t)s->run.view.width * s->run.view.height;
    *p = (pictures){.width = s->run.view.width, .height = s->run.view.height};
    p->rgb = array_alloc(count, 13 * sizeof *p->rgb);
    if (!p->rgb) return report_no_memory(s->run.report, "judging a picture");
    p->half[0] = p->rgb + 3 * count, p->half[1] = p->half[0] + 3 * count;
    p->display = p->half[1] + 3 * count, p->map = p->display + 3 * count;
    kiln_film_beauty(film, p->rgb);
    p->halves = kiln_film_half(film, 0, p->half[0]) && kiln_film_half(film, 1, p->half[1]);
    memcpy(p->display, p->rgb, 3 * count * sizeof *p->rgb);
    kiln_view_apply(s->run.display, p->display, count, 3);
    return true;
}

/* Sums over a picture, of values as exposed. */
typedef struct sums {
    double relative, square, absolute, variance, light, reference_light, bias;
    uint32_t fireflies;
} sums;

static void add_value(const study *s, const pictures *p, size_t i, double scale, sums *sum, double *relative) {
    const study_reference *ref = &s->reference;
    double x = (double)p->rgb[i] * scale, r = (double)ref->rgb[i] * scale, v = (double)ref->variance[i] * scale * scale;
    double bound = r * r + 0.01, square = (x - r) * (x - r) - v;
    *relative += square / bound;
    sum->square += square;
    sum->absolute += fabs(x - r);
    sum->light += x, sum->reference_light += r;
    if (p->halves)
        sum->bias += (((double)p->half[0][i] * scale - r) * ((double)p->half[1][i] * scale - r) - v) / bound;
}

static bool is_firefly(const study *s, const pictures *p, size_t pixel, double scale) {
    double x = 0, r = 0;
    for (size_t k = 3 * pixel; k < 3 * pixel + 3; k++)
        x += (double)p->rgb[k] * scale / 3, r += (double)s->reference.rgb[k] * scale / 3;
    return x - r > 5 * sqrt(r * r + 0.01);
}

static int by_value(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Relative errors of pixels without the worst thousandth, at least one. Sorts the map. */
static double trim(float *map, size_t count) {
    size_t kept = count - count / 1000 - (count < 1000);
    double sum = 0;
    qsort(map, count, sizeof *map, by_value);
    for (size_t i = 0; i < kept; i++) sum += (double)map[i];
    return kept ? sum / (double)kept : NAN;
}

static bool judge(const study *s, pictures *p, double *values) {
    size_t count = (size_t)p->width * p->height;
    double scale = exp2(s->run.exposure), n = 3 * (double)count;
    sums sum = {0};
    for (size_t i = 0; i < count; i++) {
        double relative = 0;
        for (size_t k = 0; k < 3; k++) add_value(s, p, 3 * i + k, scale, &sum, &relative);
        p->map[i] = (float)(relative / 3);
        sum.relative += relative;
        sum.fireflies += is_firefly(s, p, i, scale);
    }
    values[STUDY_RELMSE] = sum.relative / n;
    values[STUDY_MSE] = sum.square / n;
    values[STUDY_MAE] = sum.absolute / n;
    values[STUDY_BIAS] = p->halves ? sum.bias / n : NAN;
    values[STUDY_LIGHT] = sum.reference_light > 0 ? sum.light / sum.reference_light - 1 : NAN;
    values[STUDY_FIREFLIES] = sum.fireflies;
    kiln_comparison c = {.metric = KILN_METRIC_FLIP, .width = p->width, .height = p->height, .image = p->display,
                         .reference = s->reference.display, .threads = s->run.options->threads};
    return kiln_compare(&c, &values[STUDY_FLIP], NULL, s->run.report);
}

static void describe(const kiln_film *film, const kiln_render_stats *stats, double cpu, double scale, double *values) {
    kiln_film_error e = kiln_film_estimate_error(film, scale);
    values[STUDY_SECONDS] = stats->seconds;
    values[STUDY_CPU] = cpu;
    values[STUDY_PREDICTED] = e.known ? e.relmse : NAN;
    values[STUDY_LOST] = stats->lost_energy >= 0 ? stats->lost_energy : NAN;
    values[STUDY_CAMERA_RAYS] = (double)stats->camera_rays;
    values[STUDY_BOUNCE_RAYS] = (double)stats->bounce_rays;
    values[STUDY_SHADOW_RAYS] = (double)stats->shadow_rays;
    for (int k = 0; k < KILN_STAGE_COUNT; k++) values[STUDY_STAGES + k] = stats->stage_seconds[k];
}

/* The picture as displayed, and where it is off: the root of a pixel's relative error, on one scale in a study. */
static bool write_pictures(const study *s, const study_config *c, pictures *p) {
    size_t count = (size_t)p->width * p->height;
    kiln_text name = {0}, map_name = {0};
    const kiln_image_write_options options = {.srgb = true, .quality = 90};
    kiln_image image = {p->width, p->height, 3, KILN_PIXELS_F32, p->display};
    text_format(&name, "%s/pictures/%s.webp", s->folder, c->name);
    text_format(&map_name, "%s/pictures/%s.error.webp", s->folder, c->name);
    bool done = name.data && map_name.data && image_write_display(name.data, &image, &options, s->run.report);
    float *root = p->half[0]; /* has been looked at */
    for (size_t i = 0; i < count; i++) root[i] = sqrtf(fmaxf(p->map[i], 0));
    done = done && compare_write_map(map_name.data, root, p->width, p->height, (float)s->map_end, s->run.report);
    text_free(&name);
    text_free(&map_name);
    return done;
}

bool study_measure(study *s, uint32_t config, uint32_t level, uint32_t seed, study_row *row) {
    const study_config *c = &s->plan.configs[config];
    kiln_render_options o = {.spp = c->levels[level], .seed = s->run.options->seed + row_seeds + seed};
    kiln_render_stats stats;
    kiln_film *film;
    pictures p = {0};
    double cpu;
    *row = (study_row){.config = config, .level = level, .seed = seed};
    bool done = study_render(s, &c->options, &o, &film, &stats, &cpu) && make_pictures(s, film, &p) &&
                judge(s, &p, row->values);
    if (done) {
        size_t count = (size_t)p.width * p.height;
        describe(film, &stats, cpu, exp2(s->run.exposure), row->values);
        if (seed == 0 && level + 1 == c->level_count) done = write_pictures(s, c, &p);
        row->values[STUDY_TRIMMED] = done ? trim(p.map, count) : NAN;
    }
    free(p.rgb);
    kiln_film_destroy(film);
    return done;
}
