#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/color_text.h"
#include "cli/json_text.h"
#include "cli/log.h"
#include "job/options.h"

static void print_comparison(const char *json, kiln_report *report) {
    json_t *root = json_loads(json, 0, NULL);
    const char *name;
    const json_t *error, *file;
    size_t i;
    kiln_text text = {0};
    json_object_foreach((json_t *)member(root, "metrics"), name, error) {
        double value = json_number_value(error);
        text_format(&text, "%-9s %.6g", name, value);
        if (strcmp(name, "relmse") == 0) text_format(&text, " (its root is %.3g%%)", 100 * sqrt(value));
        text_append(&text, "\n");
    }
    json_array_foreach(member(root, "maps"), i, file)
        text_format(&text, "wrote %s: %s, brightest from %.3g\n", json_string_value(file), text_in(root, "map_metric"),
                    number_in(root, "map_end"));
    cli_print_text(&text, report);
    json_decref(root);
}

static void print_list(const char *json, kiln_report *report) {
    json_t *root = json_loads(json, 0, NULL);
    kiln_text text = {0};
    append_color(&text, member(root, "color"));
    cli_print_text(&text, report);
    json_decref(root);
}

static int compare(cli_args *args, kiln_report *report) {
    if (!args->scene || !args->other) {
        report_error(report, KILN_CODE_USAGE, NULL, "kiln color --compare picture.exr reference.exr",
                     "--compare needs two pictures");
        return kiln_report_exit_code(report);
    }
    char *json = kiln_job_compare(args->job, args->scene, args->other, report);
    int code = kiln_report_exit_code(report);
    if (args->talk.json && json) cli_print(json, report);
    else if (json && code <= EXIT_FAILURE) print_comparison(json, report);
    free(json);
    return kiln_report_exit_code(report);
}

static int list(cli_args *args, kiln_report *report) {
    char *json = kiln_job_info(args->job, report);
    if (json && args->talk.json) cli_print(json, report);
    else if (json) print_list(json, report);
    free(json);
    return kiln_report_exit_code(report);
}

static int run(const cli_command *command, cli_args *args, kiln_report *report) {
    (void)command;
    log_set_level(args->talk.quiet ? LOG_ERRORS : LOG_NORMAL);
    if (args->talk.compare) return compare(args, report);
    if (args->talk.list) return list(args, report);
    if (!args->scene || args->other)
        report_error(report, KILN_CODE_USAGE, NULL, "kiln color picture.exr -o picture.png",
                     args->scene ? "two pictures, and no --compare" : "kiln color needs a picture");
    else kiln_job_convert(args->job, args->scene, report);
    return kiln_report_exit_code(report);
}

const cli_command cli_color = {
    .name = "color",
    .argument = "PICTURE",
    .two = true,
    .summary = "compares two pictures, or shows a scene-linear one as a display does",
    .takes = JOB_COLOR,
    .talk = " compare list json quiet help ",
    .examples = "  kiln color --compare new.exr reference.exr\n"
                "  kiln color --compare new.png old.png --metric flip --threshold 0.01 -o map.png\n"
                "  kiln color render.exr --exposure 1 --view Raw -o render.png\n"
                "  kiln color --list                             displays, views, looks, spaces",
    .run = run};
