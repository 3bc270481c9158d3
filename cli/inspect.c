#include <stdlib.h>

#include "cli/cli.h"
#include "cli/inspect_text.h"
#include "cli/log.h"
#include "job/options.h"

static int run(const cli_command *command, cli_args *args, kiln_report *report) {
    log_set_level(args->talk.quiet ? LOG_ERRORS : LOG_NORMAL);
    if (!args->scene) {
        report_error(report, KILN_CODE_USAGE, NULL, "kiln inspect car.glb", "kiln %s needs a scene", command->name);
        return kiln_report_exit_code(report);
    }
    char *json = kiln_job_inspect(args->job, args->scene, report);
    if (args->talk.json && json) cli_print(json, report);
    else if (json && !kiln_report_exit_code(report)) {
        kiln_text text = {0};
        inspect_text(json, args->talk.verbose, &text);
        cli_print_text(&text, report);
    }
    free(json);
    return kiln_report_exit_code(report);
}

const cli_command cli_inspect = {
    .name = "inspect",
    .argument = "SCENE",
    .summary = "what is in a file, and what kiln would make of it",
    .takes = JOB_INSPECT,
    .talk = " json quiet verbose help ",
    .examples = "  kiln inspect helmet.glb\n"
                "  kiln inspect helmet.glb --json | jq .bounds.size\n"
                "  kiln inspect helmet.glb --subdivide 2 --strict",
    .run = run};
