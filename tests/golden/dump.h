/* tests/golden/dump.h: a scene as text that is the same on every machine: what the file said, in the order of the
 * scene, floats rounded to 6 digits, large arrays as a count, a box and a hash of the rounded values. */
#ifndef KILN_TESTS_GOLDEN_DUMP_H
#define KILN_TESTS_GOLDEN_DUMP_H

#include "base/text.h"
#include "scene/scene.h"

void dump_scene(const kiln_scene *, kiln_text *);
/* One line per message; the first root_length characters of each place, the name of the file, stay out. */
void dump_report(const kiln_report *, size_t root_length, kiln_text *);
/* A few lines: counts, bounds of a committed scene, features of its materials. */
void dump_summary(const kiln_scene *, kiln_text *);

#endif
