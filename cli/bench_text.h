/* cli/bench_text.h: the JSON of kiln bench for people. */
#ifndef KILN_CLI_BENCH_TEXT_H
#define KILN_CLI_BENCH_TEXT_H

#include "base/text.h"

void bench_text(const char *json, kiln_text *out);

#endif
