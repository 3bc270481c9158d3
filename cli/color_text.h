/* cli/color_text.h: what a colour config offers, for people. */
#ifndef KILN_CLI_COLOR_TEXT_H
#define KILN_CLI_COLOR_TEXT_H

#include "cli/json_text.h"

void append_names(kiln_text *out, const char *heading, const json_t *names);
/* The member "color" of kiln info. */
void append_color(kiln_text *out, const json_t *color);

#endif
