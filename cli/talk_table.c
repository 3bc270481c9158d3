/* How commands talk: options that are not the job's. */
#include "cli/cli.h"

#define FIELD(name) .offset = offsetof(cli_talk, name)

static const option_choice modes[] = {
    {"auto", PROGRESS_AUTO}, {"always", PROGRESS_ALWAYS}, {"never", PROGRESS_NEVER}, {NULL, 0}};

static const char talk[] = "Talk", pictures[] = "Pictures"; /* the group of the job's options about them */

static const option_row rows[] = {
    {"compare", 0, NULL, pictures, "how far the first picture is from the second; -o gets a map of the errors", NULL,
     NULL, "true or false", &option_toggle, FIELD(compare)},
    {"list", 0, NULL, pictures, "displays, views, looks and colour spaces of the config", NULL, NULL, "true or false",
     &option_toggle, FIELD(list)},
    {"json", 0, NULL, talk, "data as JSON on stdout", NULL, NULL, "true or false", &option_toggle, FIELD(json)},
    {"quiet", 'q', NULL, talk, "errors only", NULL, NULL, "true or false", &option_toggle, FIELD(quiet)},
    {"verbose", 'v', NULL, talk, "every step and its time", NULL, NULL, "true or false", &option_toggle,
     FIELD(verbose)},
    {"progress", 0, "auto|always|never", talk, "auto: on a terminal", "auto", NULL, "a mode", &option_choices, modes,
     FIELD(progress)},
    {"help", 'h', NULL, talk, "this text", NULL, NULL, "true or false", &option_toggle, FIELD(help)},
};

const option_table cli_talk_table = {rows, sizeof rows / sizeof *rows};
