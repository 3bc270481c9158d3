/* tests/importers/subdiv/support.h: what the tests of subdivision share: shapes, and a scene for each test. */
#ifndef KILN_TESTS_IMPORTERS_SUBDIV_SUPPORT_H
#define KILN_TESTS_IMPORTERS_SUBDIV_SUPPORT_H

#include "tests/importers/subdiv/shapes.h"

typedef struct fixture {
    kiln_scene *scene;
    kiln_report *report;
    kiln_arena arena;
} fixture;

static inline int setup(void **state) {
    static fixture f;
    f = (fixture){kiln_scene_create(), kiln_report_create(), {0}};
    *state = &f;
    return !f.scene || !f.report;
}

static inline int teardown(void **state) {
    fixture *f = *state;
    kiln_scene_destroy(f->scene);
    kiln_report_destroy(f->report);
    arena_free(&f->arena);
    return 0;
}

#endif
