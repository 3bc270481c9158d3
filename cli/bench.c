#include <stdlib.h>

#include "cli/bench_text.h"
#include "cli/cli.h"
#include "cli/log.h"
#include "job/options.h"

static int run(const cli_command *command, cli_args *args, kiln_report *report) {
    const cli_talk *talk = &args->talk;
    (void)command;
    log_set_level(talk->quiet ? LOG_ERRORS : LOG_NORMAL);
    char *json = kiln_job_bench(args->job, args->scene, report);
    if (talk->json && json) cli_print(json, report);
    else if (json && !kiln_report_exit_code(report)) {
        kiln_text text = {0};
        bench_text(json, &text);
        cli_print(text.data ? text.data : "", report);
        text_free(&text);
    }
    free(json);
    return kiln_report_exit_code(report);
}

const cli_command cli_bench = {
    .name = "bench",
    .argument = "SCENE",
    .summary = "what a scene, or a generated one, costs: time by stage, samples a second, memory",
    .renders = true,
    .takes = JOB_BENCH,
    .talk = " json quiet help ",
    .examples = "  kiln bench helmet.glb --size 512x512 --spp 32\n"
                "  kiln bench helmet.glb --embree                beside it, the same rays through Embree alone\n"
                "  kiln bench helmet.glb --embree --json | jq .embree.render_share\n"
                "  kiln bench --growth all                       a generated scene; some minutes\n"
                "  kiln bench hall.glb --growth threads,depth:16 --size 256x256",
    .run = run};
