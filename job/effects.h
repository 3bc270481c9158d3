/* job/effects.h: the effects of a scene, as files and people are told of them. */
#ifndef KILN_JOB_EFFECTS_H
#define KILN_JOB_EFFECTS_H

#include "base/text.h"
#include "job/json.h"
#include "kiln/effects.h"

/* An array with a row for each effect: called for or not, by whom, and what follows. */
json_t *effects_facts(const kiln_effect_plan *);

/* "area-lights, textures": appends the names of a set; "none". */
void effects_list(uint64_t effects, kiln_text *);

/* The user's wish: "auto", "all", "-dispersion,+clearcoat", or the word with such a list. False: reported in *problem, one
 * line that the caller frees. */
bool effects_parse(const char *text, kiln_effects *, kiln_text *problem);
/* The text that is parsed as the same wish. */
void effects_print(const kiln_effects *, kiln_text *);

#endif
