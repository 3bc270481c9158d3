#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/log.h"
#include "job/options.h"

typedef struct listener {
    const cli_args *args;
    const kiln_report *report;
} listener;

static void on_phase(const char *name, void *user) {
    const listener *l = user;
    if (strcmp(name, "reference") == 0) interrupt_arm(true); /* from here on there is something to keep */
    log_progress_end();
    log_flush(l->report);
}

static void on_log(const char *line, void *user) {
    (void)user;
    log_line(LOG_NORMAL, "%s", line);
}

static void on_progress(const kiln_progress *p, void *user) {
    const listener *l = user;
    log_progress(l->args->talk.progress, p);
}

static double mean_in(const json_t *o, const char *key) { return number_in(member(o, key), "mean"); }

static void append_config(kiln_text *out, const json_t *config) {
    const json_t *levels = member(config, "levels"), *top = json_array_get(levels, json_array_size(levels) - 1);
    const json_t *gain = member(member(config, "efficiency"), "over_base");
    append_name(out, text_in(config, "name"), 30);
    text_format(out, "%6.0f%9.3f", number_in(top, "spp"), mean_in(top, "seconds"));
    text_format(out, "%9.2f%9.2f", 100 * sqrt(fmax(mean_in(top, "relmse"), 0)),
                100 * sqrt(fmax(mean_in(top, "relmse_trimmed"), 0)));
    if (is_null(gain, "low")) text_append(out, "               -");
    else
        text_format(out, "%6.2f (%.2f-%.2f)", number_in(gain, "mean"), number_in(gain, "low"),
                    number_in(gain, "high"));
    text_format(out, "  %s\n", text_in(config, "biased"));
}

static void print_summary(const char *json, const char *folder, kiln_report *report) {
    json_t *root = json_loads(json, 0, NULL);
    kiln_text text = {0};
    const json_t *config, *line;
    size_t i;
    text_format(&text, "%-30s%6s%9s%9s%9s%14s  bias\n", "", "spp", "seconds", "error %", "trimmed", "efficiency");
    json_array_foreach(member(root, "configs"), i, config) append_config(&text, config);
    text_append(&text, "\n");
    json_array_foreach(member(root, "advice"), i, line) text_format(&text, "%s\n", json_string_value(line));
    if (!is_true(root, "complete"))
        text_format(&text, "%.0f of %.0f renders are done: the same command goes on\n", number_in(root, "renders"),
                    number_in(root, "renders_planned"));
    text_format(&text, "wrote %s/report.html, rows.csv and study.json\n", folder);
    cli_print_text(&text, report);
    json_decref(root);
}

static int run(const cli_command *command, cli_args *args, kiln_report *report) {
    const cli_talk *talk = &args->talk;
    listener l = {args, report};
    (void)command;
    log_set_level(talk->quiet ? LOG_ERRORS : talk->verbose ? LOG_VERBOSE : LOG_NORMAL);
    interrupt_install();
    kiln_job_listen(args->job, &(kiln_job_events){on_phase, on_log, on_progress, interrupt_flag(), &l});
    char *json = kiln_job_study(args->job, args->scene, report);
    int code = kiln_report_exit_code(report);
    enum { INTERRUPTED = 130 };
    log_progress_end();
    if (talk->json && json) cli_print(json, report);
    else if (json && !talk->quiet && (!code || code == INTERRUPTED) && args->folder)
        print_summary(json, args->folder, report);
    free(json);
    return kiln_report_exit_code(report);
}

const cli_command cli_study = {
    .name = "study",
    .argument = "SCENE",
    .summary = "what accuracy costs in time: many settings, their errors and times, which to take",
    .renders = true,
    .takes = JOB_STUDY,
    .talk = " json quiet verbose progress help ",
    .examples = "  kiln study helmet.glb -o helmet.study                  some minutes; then open report.html\n"
                "  kiln study helmet.glb -o s --size 512x512 --spp 256    larger, and further\n"
                "  kiln study hall.glb -o s --noise 1% --budget 60s       what to take for 1 %, and for a minute\n"
                "  kiln study hall.glb -o s --reference hall.exr          against a picture of yours\n"
                "  kiln study --preset roulette -o roulette               a scene of its own",
    .run = run};
