/* cli/cli.h: subcommands, and what they share. Only main.c leaves the process. */
#ifndef KILN_CLI_CLI_H
#define KILN_CLI_CLI_H

#include "job/option.h"
#include "kiln/job.h"

typedef enum cli_progress { PROGRESS_AUTO, PROGRESS_ALWAYS, PROGRESS_NEVER } cli_progress;

/* How a command talks. */
typedef struct cli_talk {
    bool json, quiet, verbose, help;
    bool compare, list; /* what kiln color does */
    cli_progress progress;
} cli_talk;

extern const option_table cli_talk_table;

typedef struct cli_args {
    kiln_job *job; /* has the options that were given */
    cli_talk talk;
    const char *scene; /* the first positional argument; NULL: none */
    const char *other; /* the second, of commands that take one */
    const char *folder; /* that -o named last; NULL: none */
    bool picture_on_stdout;
} cli_args;

typedef struct cli_command {
    const char *name, *argument, *summary;
    bool two;          /* takes two positional arguments */
    bool renders;      /* takes all options of a job, but those that have one of the bits below in option_row.except */
    unsigned takes;    /* takes those that have one of these bits in option_row.also */
    const char *talk; /* names of talk options that it takes, between spaces */
    const char *examples;
    int (*run)(const struct cli_command *, cli_args *, kiln_report *); /* the exit code */
} cli_command;

extern const cli_command cli_render, cli_inspect, cli_bench, cli_study, cli_color, cli_info, cli_help, cli_version;
extern const cli_command *const cli_commands[]; /* NULL at the end */

enum { EXIT_USAGE = 2 };

/* Whether the command takes the option. */
bool cli_takes_job(const cli_command *, const option_row *);
bool cli_takes_talk(const cli_command *, const option_row *);

/* arguments behind the subcommand. False: reported. */
bool cli_parse(const cli_command *, int count, char **arguments, cli_args *, kiln_report *);

/* help.c: on standard output; false: reported */
bool cli_print_overview(kiln_report *);
bool cli_print_help(const cli_command *, kiln_report *);

/* Writes text to standard output; false: reported. */
bool cli_print(const char *text, kiln_report *);
bool cli_print_text(kiln_text *, kiln_report *); /* and frees it; it must not be empty */

#endif
