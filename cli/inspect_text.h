/* cli/inspect_text.h: the JSON of kiln_job_inspect for people. */
#ifndef KILN_CLI_INSPECT_TEXT_H
#define KILN_CLI_INSPECT_TEXT_H

#include "base/text.h"

/* all: no list is cut short. */
void inspect_text(const char *json, bool all, kiln_text *);

#endif
