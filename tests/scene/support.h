/* tests/scene/support.h: what the tests of the scene share. */
#ifndef KILN_TESTS_SCENE_SUPPORT_H
#define KILN_TESTS_SCENE_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <string.h>

#include "scene/scene.h"

typedef struct fixture {
    kiln_scene *scene;
    kiln_report *report;
} fixture;

static inline int fixture_open(void **state) {
    static fixture f;
    f = (fixture){kiln_scene_create(), kiln_report_create()};
    *state = &f;
    return !f.scene || !f.report;
}
static inline int fixture_close(void **state) {
    fixture *f = *state;
    kiln_scene_destroy(f->scene);
    kiln_report_destroy(f->report);
    return 0;
}

/* The report holds a message of this severity whose place and text begin so; prints what it holds otherwise. */
static inline bool says(const kiln_report *report, kiln_severity severity, const char *where, const char *what) {
    for (size_t i = 0; i < kiln_report_size(report); i++) {
        kiln_message m = kiln_report_message(report, i);
        if (m.severity == severity && !strncmp(m.where, where, strlen(where)) && !strncmp(m.what, what, strlen(what)))
            return true;
    }
    for (size_t i = 0; i < kiln_report_size(report); i++) {
        kiln_message m = kiln_report_message(report, i);
        print_message("reported: %s | %s\n", m.where, m.what);
    }
    print_message("expected: %s | %s\n", where, what);
    return false;
}

#define SCENE_TEST(name) cmocka_unit_test_setup_teardown(name, fixture_open, fixture_close)

/* A unit triangle in the plane z = 0. */
static const float triangle_positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
static const uint32_t triangle_corners[3] = {0, 1, 2};
static inline kiln_mesh_desc triangle_desc(void) {
    return (kiln_mesh_desc){.name = "triangle", .vertex_count = 3, .positions = triangle_positions, .face_count = 1,
                            .face_vertices = triangle_corners};
}

#endif
