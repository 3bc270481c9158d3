/* tests/assets.h: where the optional collection of real assets is. Tests that read it skip without it. */
#ifndef KILN_TESTS_ASSETS_H
#define KILN_TESTS_ASSETS_H

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#ifndef KILN_SOURCE_DIR
#define KILN_SOURCE_DIR ""
#endif

/* $KILN_ASSETS, else ../shared/assets beside the checkout; NULL when that is no folder. */
static inline const char *assets_root(void) {
    static char beside[4096];
    struct stat status;
    const char *given = getenv("KILN_ASSETS");
    if (given && *given) return stat(given, &status) == 0 && S_ISDIR(status.st_mode) ? given : NULL;
    snprintf(beside, sizeof beside, "%s/../shared/assets", KILN_SOURCE_DIR);
    return stat(beside, &status) == 0 && S_ISDIR(status.st_mode) ? beside : NULL;
}

/* In a cmocka test: `const char *root = assets_or_skip();` */
#define assets_or_skip()                                                                                               \
    __extension__({                                                                                                    \
        const char *root_ = assets_root();                                                                             \
        if (!root_) {                                                                                                  \
            printf("skipped: no real assets (set KILN_ASSETS)\n");                                                     \
            skip();                                                                                                    \
        }                                                                                                              \
        root_;                                                                                                         \
    })

#endif
