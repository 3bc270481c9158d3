#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "cli/cli.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/log.h"
#include "job/options.h"

typedef struct listener {
    const cli_args *args;
    const kiln_report *report;
    const char *phase;
    double phase_started;
} listener;

static void end_phase(listener *l) {
    if (l->phase) log_line(LOG_VERBOSE, "%s: %.2f s", l->phase, clock_seconds() - l->phase_started);
}

static void on_phase(const char *name, void *user) {
    listener *l = user;
    if (strcmp(name, "render") == 0) interrupt_arm(true);
    log_progress_end();
    log_flush(l->report);
    end_phase(l);
    l->phase = name;
    l->phase_started = clock_seconds();
}

static void on_log(const char *line, void *user) {
    (void)user;
    log_line(LOG_NORMAL, "%s", line);
}

static void on_progress(const kiln_progress *p, void *user) {
    const listener *l = user;
    log_progress(l->args->talk.progress, p);
}

static void log_outputs(const json_t *stats) {
    const json_t *picture = json_object_get(stats, "picture"), *crop = json_object_get(picture, "crop"), *o;
    size_t i;
    long side[2];
    for (size_t k = 0; k < 2; k++)
        side[k] = (long)(json_integer_value(json_array_get(crop, k + 2)) - json_integer_value(json_array_get(crop, k)));
    json_array_foreach(json_object_get(stats, "outputs"), i, o) {
        if (!json_is_true(json_object_get(o, "written"))) continue;
        const char *format = text_in(o, "format"), *file = text_in(o, "file");
        bool linear = strcmp(format, "OpenEXR") == 0 || strcmp(format, "Radiance HDR") == 0;
        log_line(LOG_NORMAL, "wrote %s (%ld x %ld, %s)", strcmp(file, "-") == 0 ? "a PNG to stdout" : file, side[0],
                 side[1], linear ? "scene-linear" : text_in(picture, "color_view"));
    }
}

/* "ended by --noise 3%" */
static void log_end(const kiln_job_result *result, const json_t *stats) {
    const json_t *render = json_object_get(stats, "render"), *rules = json_object_get(render, "rules");
    kiln_text line = {0};
    const kiln_render_stats *s = &result->stats;
    text_format(&line, "%u sample%s per pixel", s->spp, s->spp == 1 ? "" : "s");
    if (s->spp_most > s->spp_least) text_format(&line, " (%u to %u)", s->spp_least, s->spp_most);
    text_format(&line, " in %.2f s", s->seconds);
    if (result->error.known) text_format(&line, ", error %.2f%%", 100 * sqrt(result->error.relmse));
    switch (result->stats.stop) {
    case KILN_STOP_SPP: text_format(&line, "; ended by --spp %.0f", number_in(rules, "spp")); break;
    case KILN_STOP_NOISE: text_format(&line, "; ended by --noise %g%%", 100 * number_in(rules, "noise")); break;
    case KILN_STOP_BUDGET: text_format(&line, "; ended by --budget %gs", number_in(rules, "budget_seconds")); break;
    case KILN_STOP_CANCELLED: text_append(&line, "; interrupted"); break;
    }
    if (result->noise_missed) text_format(&line, "; the goal of %g%% was not reached", 100 * number_in(rules, "noise"));
    log_line(LOG_NORMAL, "%s", line.data ? line.data : "");
    text_free(&line);
}

static void log_times(const json_t *stats) {
    kiln_text line = {0};
    const json_t *phase;
    size_t i;
    text_format(&line, "%.2f s:", number_in(stats, "seconds"));
    json_array_foreach(json_object_get(stats, "phases"), i, phase)
        if (number_in(phase, "seconds") >= 0.005)
            text_format(&line, " %s %.2f,", text_in(phase, "name"), number_in(phase, "seconds"));
    text_format(&line, " peak memory %.0f MB", number_in(json_object_get(stats, "memory"), "peak") * 1e-6);
    log_line(LOG_NORMAL, "%s", line.data ? line.data : "");
    text_free(&line);
}

/* The longest; with --verbose all of them, and the rest of the threads' time. */
static void log_stages(const json_t *stats) {
    const json_t *render = json_object_get(stats, "render"), *stages = json_object_get(render, "stages"), *stage;
    kiln_text line = {0};
    size_t i;
    append_stages(&line, stages, 0.05);
    if (line.length) log_line(LOG_NORMAL, "render by stage: %s", line.data);
    text_free(&line);
    json_array_foreach(stages, i, stage)
        log_line(LOG_VERBOSE, "  %-12s %7.2f s of threads, %4.1f%%", text_in(stage, "name"), number_in(stage, "seconds"),
                 100 * number_in(stage, "share"));
    log_line(LOG_VERBOSE, "  %-12s %7.2f s of threads", "waiting", number_in(render, "waiting_seconds"));
}

static void summarise(const kiln_job *job, const kiln_report *report) {
    kiln_job_result result = kiln_job_last(job);
    char *text = kiln_job_stats(job);
    json_t *stats = text ? json_loads(text, 0, NULL) : NULL;
    if (stats && result.film) {
        log_outputs(stats);
        log_end(&result, stats);
        log_times(stats);
        log_stages(stats);
    }
    log_warning_counts(report);
    json_decref(stats);
    free(text);
}

static int run(const cli_command *command, cli_args *args, kiln_report *report) {
    const cli_talk *talk = &args->talk;
    log_set_level(talk->quiet ? LOG_ERRORS : talk->verbose ? LOG_VERBOSE : LOG_NORMAL);
    if (!args->scene) {
        report_error(report, KILN_CODE_USAGE, NULL, "kiln render car.glb", "kiln %s needs a scene", command->name);
        return kiln_report_exit_code(report);
    }
    listener l = {.args = args, .report = report};
    interrupt_install();
    kiln_job_listen(args->job, &(kiln_job_events){on_phase, on_log, on_progress, interrupt_flag(), &l});
    kiln_job_render(args->job, args->scene, report);
    log_progress_end();
    end_phase(&l);
    log_flush(report);
    summarise(args->job, report);
    if (talk->json) {
        char *stats = kiln_job_stats(args->job);
        if (stats) cli_print(stats, report);
        free(stats);
    }
    int code = kiln_report_exit_code(report); /* with what printing met */
    return code ? code : kiln_job_last(args->job).exit_code;
}

const cli_command cli_render = {
    .name = "render",
    .argument = "SCENE",
    .summary = "one picture of a .gltf or .glb file; '-' reads a glb from stdin",
    .renders = true,
    .takes = JOB_RENDER,
    .talk = " json quiet verbose progress help ",
    .examples = "  kiln render helmet.glb                                  helmet.png, framed and lit\n"
                "  kiln render helmet.glb --env hall.hdr -o a.png -o a.exr lit by a picture, two files\n"
                "  kiln render shoe.glb --background '#ffffff' --orbit -40,20 --size 2000x2000 -o shoe.jpg\n"
                "  kiln render set.gltf --camera Close --aperture 2.8 --noise 1% --aov albedo,normal,depth -o set.exr\n"
                "  kiln render a.glb --spp 256 --seed 7 --threads 8 --stats a.json -o - > a.png",
    .run = run};
