#include "tests/golden/pairs.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

char **pair_names(size_t *count) {
    DIR *folder = opendir(KILN_TEST_DATA "/gltf/pairs");
    char **names = NULL;
    *count = 0;
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        size_t length = strlen(entry->d_name);
        if (length < 7 || strcmp(entry->d_name + length - 7, "_a.gltf") != 0) continue;
        names = realloc(names, (*count + 1) * sizeof *names);
        names[(*count)++] = strndup(entry->d_name, length - 7);
    }
    if (folder) closedir(folder);
    if (names) qsort(names, *count, sizeof *names, by_name);
    return names;
}

void pair_names_free(char **names, size_t count) {
    for (size_t i = 0; i < count; i++) free(names[i]);
    free(names);
}
