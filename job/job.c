/* The public face of a job. */
#include "kiln/job.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/text.h"
#include "job/bench.h"
#include "job/compare.h"
#include "job/info.h"
#include "job/inspect.h"
#include "job/run.h"
#include "job/stats.h"
#include "job/study.h"

struct kiln_job {
    job_options options;
    kiln_job_events events;
    job_run run;   /* the last one */
    json_t *stats; /* of it */
};

kiln_job *kiln_job_create(void) {
    kiln_job *job = calloc(1, sizeof *job);
    kiln_report *report = kiln_report_create();
    bool done = job && report && job_options_init(&job->options, report);
    kiln_report_destroy(report);
    if (done) return job;
    kiln_job_destroy(job);
    return NULL;
}

static void forget(kiln_job *job) {
    json_decref(job->stats);
    job->stats = NULL;
    run_free(&job->run);
}

void kiln_job_destroy(kiln_job *job) {
    if (!job) return;
    forget(job);
    job_options_free(&job->options);
    free(job);
}

bool kiln_job_set(kiln_job *job, const char *option, const char *value, kiln_report *report) {
    return job_options_set(&job->options, option, value, NULL, report);
}

void kiln_job_listen(kiln_job *job, const kiln_job_events *events) {
    job->events = events ? *events : (kiln_job_events){0};
}

/* A scene that is there becomes pictures. */
static bool draw(job_run *r) {
    return run_phase(r, "frame") && run_camera(r) && run_outputs(r) && run_film(r) &&
           run_phase(r, "subdivide") && run_subdivide(r) && run_phase(r, "light") && run_light(r) &&
           run_phase(r, "build") && run_build(r) && run_check_strict(r) &&
           run_phase(r, "expose") && run_expose(r) && run_phase(r, "render") && run_render(r) &&
           run_phase(r, "write") && run_write(r) &&
           (!r->options->effects.removed || (run_phase(r, "compare") && run_compare(r)));
}

static bool finish(job_run *r) {
    if (r->stats.stop == KILN_STOP_CANCELLED)
        return report_error(r->report, KILN_CODE_CANCELLED, NULL, NULL, "interrupted at %llu samples",
                            (unsigned long long)kiln_film_samples(r->film));
    return run_check_strict(r);
}

static bool write_stats(const kiln_job *job, const char *path, kiln_report *report) {
    char *text = kiln_job_stats(job);
    if (!text) return report_no_memory(report, "writing statistics");
    kiln_writer *writer = file_create(path, report);
    bool done = writer && file_write(writer, text, strlen(text)) && file_write(writer, "\n", 1);
    free(text);
    return writer && file_commit(writer, report) && done;
}

/* scene NULL: source is a file. */
static bool run_all(kiln_job *job, kiln_scene *scene, const char *source, kiln_report *report) {
    forget(job);
    job_run *r = &job->run;
    bool done = run_start(r, &job->options, &job->events, source, report) && run_phase(r, "color") && run_color(r);
    r->scene = scene;
    done = done && (scene || (run_phase(r, "import") && run_import(r))) && draw(r);
    if (r->rendered) done = finish(r) && done;
    run_phase(r, NULL);
    job->stats = stats_make(r);
    if (job->options.stats && r->rendered && !write_stats(job, job->options.stats, report)) {
        done = false;
        json_decref(job->stats);
        job->stats = stats_make(r); /* with that error */
    }
    r->exit_code = run_exit_code(r);
    kiln_renderer_destroy(r->renderer);
    r->renderer = NULL;
    if (r->owns_scene) kiln_scene_destroy(r->scene);
    r->scene = NULL;
    return done;
}

bool kiln_job_render(kiln_job *job, const char *path, kiln_report *report) { return run_all(job, NULL, path, report); }

bool kiln_job_render_scene(kiln_job *job, kiln_scene *scene, const char *name, kiln_report *report) {
    return run_all(job, scene, name, report);
}

kiln_job_result kiln_job_last(const kiln_job *job) {
    const job_run *r = &job->run;
    return (kiln_job_result){.film = r->rendered ? r->film : NULL,
                             .stats = r->stats,
                             .error = r->error,
                             .exposure = r->exposure,
                             .exit_code = r->exit_code,
                             .noise_missed = run_missed_noise(r),
                             .outputs_written = r->outputs_written};
}

/* Nine digits: a float's worth, and no more. */
static char *dump(const json_t *json) {
    return json ? json_dumps(json, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
}

char *kiln_job_stats(const kiln_job *job) { return dump(job->stats); }

/* Takes the JSON over. */
static char *hand_out(json_t *json, const char *doing, kiln_report *report) {
    put(json, "errors", stats_messages(report, KILN_ERROR));
    put_count(json, "exit_code", (uint64_t)kiln_report_exit_code(report));
    char *text = dump(json);
    json_decref(json);
    if (!text) report_no_memory(report, doing);
    return text;
}

char *kiln_job_bench(kiln_job *job, const char *path, kiln_report *report) {
    forget(job);
    json_t *json = NULL;
    if (run_start(&job->run, &job->options, &job->events, path ? path : "generated", report))
        bench(&job->run, path, &json);
    return hand_out(json ? json : json_object(), "measuring", report);
}

static json_t *inspect_failure(const char *path, const kiln_report *report) {
    json_t *o = json_object(), *source = json_object();
    put_text(source, "file", path);
    put(o, "source", source);
    put(o, "warnings", stats_messages(report, KILN_WARNING));
    return o;
}

char *kiln_job_inspect(kiln_job *job, const char *path, kiln_report *report) {
    forget(job);
    json_t *json = NULL;
    bool done = run_start(&job->run, &job->options, &job->events, path, report) && inspect(&job->run, &json);
    if (!done) json = inspect_failure(path, report);
    return hand_out(json, "inspecting", report);
}

char *kiln_job_study(kiln_job *job, const char *path, kiln_report *report) {
    forget(job);
    json_t *json = NULL;
    if (run_start(&job->run, &job->options, &job->events, path ? path : "generated", report))
        study_run(&job->run, path, &json);
    return hand_out(json ? json : json_object(), "studying", report);
}

char *kiln_job_compare(kiln_job *job, const char *path, const char *reference, kiln_report *report) {
    json_t *json;
    compare_files(&job->options, path, reference, &json, report);
    return hand_out(json, "comparing", report);
}

bool kiln_job_convert(kiln_job *job, const char *path, kiln_report *report) {
    return convert_file(&job->options, path, report);
}

char *kiln_job_info(kiln_job *job, kiln_report *report) {
    json_t *json = info_make(&job->options, report);
    char *text = dump(json);
    json_decref(json);
    if (json && !text) report_no_memory(report, "collecting information");
    return text;
}
