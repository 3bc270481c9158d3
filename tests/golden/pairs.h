/* tests/golden/pairs.h: the pairs of files under tests/data/gltf/pairs. */
#ifndef KILN_TESTS_GOLDEN_PAIRS_H
#define KILN_TESTS_GOLDEN_PAIRS_H

#include <stddef.h>

/* Their names, sorted; free with pair_names_free. NULL: the folder cannot be read. */
char **pair_names(size_t *count);
void pair_names_free(char **names, size_t count);

#endif
