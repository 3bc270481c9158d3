/* tests/golden/golden.h: texts that are kept under tests/data and compared. With KILN_GOLDEN_UPDATE=1 in the
 * environment they are written instead: read the difference before you commit it. */
#ifndef KILN_TESTS_GOLDEN_GOLDEN_H
#define KILN_TESTS_GOLDEN_GOLDEN_H

#include <stdbool.h>

#include "base/text.h"

bool golden_updates(void);

/* Is text what tests/data/NAME holds? Prints the first line that differs. */
bool golden_matches(const char *name, const char *text);

/* The same for a text of words and numbers apart by spaces, whose numbers may differ by a part of what they are. */
bool golden_matches_within(const char *name, const char *text, double tolerance);

/* A text about many files of a folder that may not be there: a section "== PATH" with what describe appends for each.
 * Sections whose file is missing are passed over; when updating, every file under root that ends in one of the
 * suffixes gets one. */
bool golden_matches_files(const char *name, const char *root, const char *const *suffixes,
                          void (*describe)(const char *path, kiln_text *));

#endif
