#include <stdlib.h>

#include "cli/cli.h"
#include "cli/color_text.h"
#include "cli/json_text.h"
#include "job/options.h"

static void print_machine(kiln_text *out, const json_t *m) {
    text_format(
        out, "\nMachine\n  cpu          %s\n  features     %s\n  kernels      %s\n  threads      %.0f\n  memory       ",
        text_in(m, "cpu"), text_in(m, "features"), text_in(m, "isa"), number_in(m, "threads"));
    append_bytes(out, number_in(m, "memory"));
    text_append(out, "\n");
}

static void print_info(const char *json, kiln_text *out) {
    json_t *root = json_loads(json, 0, NULL);
    const json_t *formats = member(root, "formats"), *version;
    const char *name;
    text_append(out, "Versions\n");
    json_object_foreach((json_t *)member(root, "versions"), name, version)
        text_format(out, "  %-14s %s\n", name, json_string_value(version));
    print_machine(out, member(root, "machine"));
    text_append(out, "\nColour\n");
    append_color(out, member(root, "color"));
    text_append(out, "\nFormats\n");
    append_names(out, "scenes", member(formats, "scenes"));
    append_names(out, "textures", member(formats, "pictures_read"));
    append_names(out, "pictures", member(formats, "pictures_written"));
    json_decref(root);
}

static int run(const cli_command *command, cli_args *args, kiln_report *report) {
    (void)command;
    char *json = kiln_job_info(args->job, report);
    if (!json) return kiln_report_exit_code(report);
    if (args->talk.json) cli_print(json, report);
    else {
        kiln_text text = {0};
        print_info(json, &text);
        cli_print_text(&text, report);
    }
    free(json);
    return kiln_report_exit_code(report);
}

const cli_command cli_info = {
    .name = "info",
    .summary = "versions, machine, colour config, formats",
    .takes = JOB_INFO,
    .talk = " json help ",
    .examples = "  kiln info\n  kiln info --ocio /show/config.ocio\n  kiln info --json | jq .versions",
    .run = run};
