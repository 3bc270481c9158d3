/* How time and memory grow, one quantity at a time. Numbers of pixels, scattering events and threads vary for the scene
 * of the run, those of triangles, instances and lights for generated ones. */
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/text.h"
#include "base/threads.h"
#include "job/bench.h"
#include "job/machine.h"

enum { VALUES_MAX = 8, COPY_TRIANGLES = 1000, SIDE = 512, SPP = 4 };

typedef enum axis_kind { PIXELS, TRIANGLES, INSTANCES, LIGHTS, DEPTH, THREADS, AXES } axis_kind;

static const struct axis {
    const char *name;
    double values[VALUES_MAX]; /* 0 ends them; THREADS has as many as the machine */
} axes[AXES] = {
    [PIXELS] = {"pixels", {1 << 12, 1 << 14, 1 << 16, 1 << 18, 1 << 20, 1 << 22}},
    [TRIANGLES] = {"triangles", {1e4, 1e5, 1e6, 1e7, 2e7}},
    [INSTANCES] = {"instances", {1, 10, 100, 1000, 1e4, 1e5}},
    [LIGHTS] = {"lights", {1, 10, 100, 1000, 1e4, 1e5}},
    [DEPTH] = {"depth", {1, 2, 4, 8, 16, 32, 64}},
    [THREADS] = {"threads", {1, 2, 4, 8, 16, 32, 64, 128}},
};

/* What is asked for: a limit for each axis; 0: not that axis. */
typedef struct plan { double limits[AXES]; } plan;

static bool parse_item(const char *item, size_t length, plan *p) {
    char name[64];
    double limit = INFINITY;
    if (length >= sizeof name) return false;
    memcpy(name, item, length);
    name[length] = 0;
    char *colon = strchr(name, ':');
    if (colon) *colon = 0;
    if (colon && (!text_to_double(colon + 1, &limit) || !(limit > 0))) return false;
    bool all = strcmp(name, "all") == 0, known = all;
    for (int a = 0; a < AXES; a++) {
        if (!all && strcmp(name, axes[a].name) != 0) continue;
        p->limits[a] = limit;
        known = true;
    }
    return known;
}

static bool parse(const char *list, plan *p) {
    *p = (plan){0};
    for (const char *item = list; *item;) {
        size_t length = strcspn(item, ",");
        if (!parse_item(item, length, p)) return false;
        item += length + (item[length] == ',');
    }
    return *list != 0;
}

bool bench_check_growth(const job_options *o, kiln_report *report) {
    plan p;
    kiln_where where = where_root("--growth");
    if (!o->growth || parse(o->growth, &p)) return true;
    return report_error(report, KILN_CODE_USAGE, &where, "such as all, or pixels,triangles:1e6",
                        "'%s' is not a list of pixels, triangles, instances, lights, depth, threads, or all, each with or "
                        "without a limit",
                        o->growth);
}

static void set_axis(axis_kind axis, double value, job_options *o) {
    uint32_t side = (uint32_t)lround(sqrt(value));
    switch (axis) {
    case PIXELS: o->size[0] = o->size[1] = side; break;
    case DEPTH: o->max_depth = (uint32_t)value; break;
    case THREADS: o->threads = (uint32_t)value; break;
    case TRIANGLES:
    case INSTANCES:
    case LIGHTS:
        o->subdivide = (job_subdivision){.mode = KILN_SUBDIVIDE_OFF};
        o->camera = NULL;
        if (axis == LIGHTS) o->env = "none";
        break;
    case AXES: break;
    }
}

static json_t *describe(const job_run *r, double value, double made, const kiln_render_stats *s) {
    json_t *o = json_object();
    double build = 0, samples = (double)kiln_film_samples(r->film);
    for (uint32_t i = 0; i < r->phase_count; i++)
        if (strcmp(r->phases[i].name, "build") == 0) build = r->phases[i].seconds;
    put_number(o, "value", value);
    put_number(o, "import_seconds", made);
    put_number(o, "build_seconds", build);
    put_number(o, "render_seconds", s->seconds);
    put_number(o, "samples_per_second", samples / s->seconds);
    put_count(o, "rays", s->camera_rays + s->bounce_rays + s->shadow_rays);
    put_count(o, "acceleration", r->memory.acceleration);
    put_count(o, "scene", r->memory.scene);
    put_count(o, "textures", r->memory.textures);
    put_count(o, "film", kiln_film_bytes(r->film));
    put_count(o, "peak", machine_peak_memory());
    return o;
}

/* One row. import_seconds: of the file, or of making the scene. */
static bool measure(const job_run *of, const char *scene_file, axis_kind axis, double value, json_t **row) {
    job_options options = *of->options;
    kiln_job_events events = {.cancel = of->events->cancel};
    job_run r;
    kiln_scene *scene = NULL;
    kiln_render_stats stats;
    if (!options.size[0]) options.size[0] = options.size[1] = SIDE;
    set_axis(axis, value, &options);
    bool generated = axis == TRIANGLES || axis == INSTANCES || axis == LIGHTS || !scene_file;
    uint64_t triangles = axis == INSTANCES ? COPY_TRIANGLES : axis == TRIANGLES ? (uint64_t)value : BENCH_TRIANGLES;
    machine_forget_peak();
    double began = clock_seconds();
    bool done = run_start(&r, &options, &events, generated ? "generated" : scene_file, of->report) &&
                (!generated ||
                 bench_make_scene(triangles, axis == INSTANCES ? (uint32_t)value : 1, axis == LIGHTS ? (uint32_t)value : 0,
                                  &scene, of->report));
    double made = clock_seconds() - began;
    done = done && bench_prepare(&r, scene) && run_phase(&r, "render") &&
           bench_draw(&r, options.spp ? options.spp : SPP, NULL, &stats);
    run_phase(&r, NULL);
    for (uint32_t i = 0; !generated && i < r.phase_count; i++)
        if (strcmp(r.phases[i].name, "import") == 0) made = r.phases[i].seconds;
    if (done) *row = describe(&r, value, made, &stats);
    run_free(&r);
    return done;
}

/* A row that would take more than half of the machine's memory is not begun, judged by the one before. */
static bool fits(const json_t *last, double value) {
    double machine = (double)machine_memory(), peak = json_number_value(json_object_get(last, "peak")),
           before = json_number_value(json_object_get(last, "value"));
    return !last || !(machine > 0) || peak * value / before < machine / 2;
}

static bool measure_axis(const job_run *r, const char *scene_file, axis_kind axis, double limit, json_t *rows) {
    const json_t *last = NULL;
    if (axis == THREADS) limit = fmin(limit, threads_available());
    for (int i = 0; i < VALUES_MAX && axes[axis].values[i] > 0 && axes[axis].values[i] <= limit; i++) {
        double value = axes[axis].values[i];
        json_t *row = NULL;
        if (value > 1e6 && !fits(last, value)) break;
        if (!measure(r, scene_file, axis, value, &row)) return false;
        (void)json_array_append_new(rows, row);
        last = row;
    }
    return true;
}

bool bench_growth(const job_run *r, const char *scene_file, json_t **all) {
    plan p;
    *all = json_object();
    if (!parse(r->options->growth, &p)) return false; /* bench_check_growth has seen it */
    for (int a = 0; a < AXES; a++) {
        json_t *rows = json_array();
        if (p.limits[a] > 0) put(*all, axes[a].name, rows);
        else json_decref(rows);
        if (p.limits[a] > 0 && !measure_axis(r, scene_file, (axis_kind)a, p.limits[a], rows)) return false;
    }
    return true;
}
