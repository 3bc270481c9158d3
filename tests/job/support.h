/* tests/job/support.h: what the tests of jobs share: options, scenes of boxes, folders that vanish. Include after
 * cmocka.h. */
#ifndef KILN_TESTS_JOB_SUPPORT_H
#define KILN_TESTS_JOB_SUPPORT_H

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "job/options.h"
#include "scene/scene.h"

typedef struct fixture {
    kiln_report *report;
    kiln_scene *scene;
    job_options options;
    char folder[64];
} fixture;

static inline int fixture_open(void **state) {
    fixture *f = calloc(1, sizeof *f);
    f->report = kiln_report_create();
    f->scene = kiln_scene_create();
    strcpy(f->folder, "/tmp/kiln-job-XXXXXX");
    *state = f;
    return !job_options_init(&f->options, f->report) || !mkdtemp(f->folder);
}

/* Whatever a test wrote goes with its folder. */
static inline int fixture_close(void **state) {
    fixture *f = *state;
    DIR *folder = opendir(f->folder);
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", f->folder, entry->d_name);
        if (entry->d_name[0] != '.') unlink(path);
    }
    if (folder) closedir(folder);
    rmdir(f->folder);
    job_options_free(&f->options);
    kiln_scene_destroy(f->scene);
    kiln_report_destroy(f->report);
    free(f);
    return 0;
}

#define JOB_TEST(name) cmocka_unit_test_setup_teardown(name, fixture_open, fixture_close)

static inline size_t files_in(const char *path) {
    size_t count = 0;
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder && (entry = readdir(folder));) count += entry->d_name[0] != '.';
    if (folder) closedir(folder);
    return count;
}

static inline char *path_in(const fixture *f, const char *name, char path[256]) {
    snprintf(path, 256, "%s/%s", f->folder, name);
    return path;
}

static inline void print_report(const kiln_report *report) {
    for (size_t i = 0; i < kiln_report_size(report); i++) {
        kiln_message m = kiln_report_message(report, i);
        print_message("%s: %s (%s)\n", m.where, m.what, m.remedy);
    }
}

/* The last message holds this text. */
static inline bool says(const kiln_report *report, const char *text) {
    size_t count = kiln_report_size(report);
    for (size_t i = 0; i < count; i++) {
        kiln_message m = kiln_report_message(report, i);
        if (strstr(m.what, text) || strstr(m.where, text) || strstr(m.remedy, text)) return true;
    }
    print_message("nobody says '%s':\n", text);
    print_report(report);
    return false;
}

#define assert_done(f, call)                                                                                           \
    do {                                                                                                               \
        bool done_ = (call);                                                                                           \
        if (!done_) print_report((f)->report);                                                                         \
        assert_true(done_);                                                                                            \
    } while (0)

#define assert_near(a, b, tolerance)                                                                                   \
    do {                                                                                                               \
        double a_ = (a), b_ = (b);                                                                                     \
        if (!(fabs(a_ - b_) <= (tolerance))) fail_msg("%.17g is not %.17g", a_, b_);                                   \
    } while (0)

static inline void give(fixture *f, const char *name, const char *value) {
    assert_done(f, job_options_set(&f->options, name, value, NULL, f->report));
}

/* A box from `low` to `high`, wound outwards, of one material (0: the default). */
static inline void add_box(fixture *f, const float low[3], const float high[3], kiln_id material) {
    static const uint32_t quads[] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    static const uint32_t sizes[] = {4, 4, 4, 4, 4, 4};
    float p[24];
    for (int v = 0; v < 8; v++)
        for (int k = 0; k < 3; k++) p[3 * v + k] = v >> k & 1 ? high[k] : low[k];
    kiln_mesh_desc mesh = {.name = "box", .vertex_count = 8, .positions = p, .face_count = 6, .face_sizes = sizes,
                           .face_vertices = quads, .material = material};
    kiln_instance_desc instance = {.name = "box"};
    assert_done(f, kiln_scene_add_mesh(f->scene, &mesh, &instance.mesh, f->report));
    assert_done(f, kiln_scene_add_instance(f->scene, &instance, NULL, f->report));
}

static inline kiln_id add_material(fixture *f, float grey, float emission) {
    kiln_material m = kiln_material_default();
    kiln_id id;
    m.metallic.value = 0;
    m.specular.value = 0;
    for (int k = 0; k < 3; k++) m.base_color.value[k] = grey, m.emission.value[k] = emission;
    assert_done(f, kiln_scene_add_material(f->scene, &m, &id, f->report));
    return id;
}

#endif
