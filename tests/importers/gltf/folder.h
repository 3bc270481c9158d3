/* tests/importers/gltf/folder.h: what tests of whole files share: a folder, made by mkdtemp(folder), and files in it. */
#ifndef KILN_TESTS_IMPORTERS_GLTF_FOLDER_H
#define KILN_TESTS_IMPORTERS_GLTF_FOLDER_H

#include "tests/importers/gltf/support.h"

static char folder[] = "/tmp/kiln-gltf-XXXXXX";

static inline void name_of(char path[160], const char *name) { snprintf(path, 160, "%s/%s", folder, name); }

static inline void put(const char *name, const void *data, size_t size) {
    char path[160];
    name_of(path, name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fwrite(data, 1, size, f);
    fclose(f);
}

#endif
