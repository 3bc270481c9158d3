#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/log.h"

const cli_command *const cli_commands[] = {&cli_render, &cli_inspect, &cli_study, &cli_bench,   &cli_color,
                                           &cli_info,   &cli_help,    &cli_version, NULL};

static const cli_command *find(const char *name) {
    for (size_t i = 0; cli_commands[i]; i++)
        if (strcmp(cli_commands[i]->name, name) == 0) return cli_commands[i];
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) return &cli_help;
    return strcmp(name, "--version") == 0 || strcmp(name, "-V") == 0 ? &cli_version : NULL;
}

static bool unknown(const char *name, kiln_report *report) {
    const char *names[16];
    size_t count = 0;
    kiln_text remedy = {0};
    for (; cli_commands[count]; count++) names[count] = cli_commands[count]->name;
    const char *nearest = text_nearest(name, names, count), *dot = strrchr(name, '.');
    if (nearest) text_format(&remedy, "did you mean %s?", nearest);
    else if (dot && (strcasecmp(dot, ".glb") == 0 || strcasecmp(dot, ".gltf") == 0))
        text_format(&remedy, "did you mean kiln render %s?", name);
    else text_append(&remedy, "'kiln help' lists the commands");
    report_error(report, KILN_CODE_USAGE, NULL, remedy.data, "unknown command '%s'", name);
    text_free(&remedy);
    return false;
}

static int run(const cli_command *command, int count, char **arguments, kiln_report *report) {
    cli_args args = {.job = kiln_job_create()};
    int code = EXIT_FAILURE;
    if (!args.job) report_no_memory(report, "starting");
    else if (!cli_parse(command, count, arguments, &args, report)) code = kiln_report_exit_code(report);
    else if (args.talk.help) {
        cli_print_help(command, report);
        code = kiln_report_exit_code(report);
    } else code = command->run(command, &args, report);
    kiln_job_destroy(args.job);
    return code;
}

int main(int argc, char **argv) {
    kiln_report *report = kiln_report_create();
    if (!report) return EXIT_FAILURE;
    /* Writing to a pipe that nobody reads, or beyond the limit of file sizes, is an error like any other. */
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    const cli_command *command = argc > 1 ? find(argv[1]) : NULL;
    int code = EXIT_USAGE;
    if (command) code = run(command, argc - 2, argv + 2, report);
    else if (argc > 1) unknown(argv[1], report);
    else
        report_error(report, KILN_CODE_USAGE, NULL, "try 'kiln render car.glb' or 'kiln help'", "no command was given");
    log_flush(report);
    kiln_report_destroy(report);
    return code;
}
