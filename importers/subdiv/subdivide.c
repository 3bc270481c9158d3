#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/threads.h"
#include "importers/subdiv/examine.h"
#include "importers/subdiv/refine.h"
#include "scene/check.h"

static const uint64_t TRIANGLE_LIMIT = 50000000;
/* Far counts in int, over all levels. */
static const uint64_t TRIANGLE_LIMIT_MAX = (uint64_t)1 << 28;

typedef struct job {
    kiln_scene *scene;
    examination examination;
    mesh_plan *plans; /* one per mesh */
    atomic_bool failed;
} job;

static void examine(void *context, size_t index, uint32_t thread) {
    (void)thread;
    job *j = context;
    if (!examine_mesh(&j->examination, (kiln_id)index + 1, &j->plans[index])) atomic_store(&j->failed, true);
}

/* The level at which a mesh stays under `most` triangles, at most the one that it wants; 0: not even once. */
static uint32_t fitting_level(const mesh_plan *plan, uint64_t most) {
    uint32_t level = plan->result->refined ? plan->result->level : 0;
    while (level && cage_refined_triangles(&plan->cage, level) > most) level--;
    return level;
}

static uint64_t total_at(const job *j, uint64_t most) {
    const uint64_t enough = UINT64_MAX / 4;
    uint64_t total = 0;
    for (uint32_t i = 0; i < j->scene->mesh_count && total < enough; i++) {
        uint32_t level = fitting_level(&j->plans[i], most);
        total += level ? cage_refined_triangles(&j->plans[i].cage, level) : j->scene->meshes[i].triangle_count;
    }
    return total < enough ? total : enough;
}

/* Where all levels together are too much, every mesh gets the same share of triangles, the largest that fits. */
static void limit_levels(const job *j) {
    uint64_t limit = j->examination.triangle_limit, low = 0, high = limit;
    if (total_at(j, limit) <= limit) low = limit;
    while (low < high) {
        uint64_t middle = high - (high - low) / 2;
        if (total_at(j, middle) <= limit) low = middle;
        else high = middle - 1;
    }
    for (uint32_t i = 0; i < j->scene->mesh_count; i++) {
        kiln_subdivision_result *row = j->plans[i].result;
        uint32_t level = fitting_level(&j->plans[i], low);
        if (!row->refined || level == row->level) continue;
        report_warning(j->examination.report, KILN_CODE_LIMIT, j->scene->where,
                       "raise the limit, or ask for a lower level",
                       "subdivision would make more than %llu triangles: levels are lowered",
                       (unsigned long long)limit);
        row->refined = level > 0;
        row->level = level;
        if (!level) snprintf(row->reason, sizeof row->reason, "refining it would exceed the limit of triangles");
    }
}

static void refine(void *context, size_t index, uint32_t thread) {
    (void)thread;
    job *j = context;
    mesh_plan *plan = &j->plans[index];
    if (plan->result->refined && !atomic_load(&j->failed)) {
        scene_place place;
        place_set(&place, j->scene, "mesh", j->scene->meshes[index].name, index + 1);
        if (!refine_mesh(j->scene, plan->result->mesh, &plan->cage, plan->result->level, &place.where,
                         j->examination.report))
            atomic_store(&j->failed, true);
    }
    arena_free(&plan->arena);
}

static bool check_options(const kiln_scene *scene, const kiln_subdivide_options *o, kiln_report *report) {
    kiln_where where = where_key(scene->where, "subdivision");
    if (!check_open(scene, &where, report) ||
        !check_choice(o->mode, KILN_SUBDIVIDE_LEVEL + 1, "mode", &where, report) ||
        !check_choice(o->scheme, KILN_SCHEME_AUTO + 1, "scheme", &where, report))
        return false;
    if (o->mode == KILN_SUBDIVIDE_LEVEL && (o->level < 1 || o->level > LEVEL_MAX))
        return report_error(report, KILN_CODE_USAGE, &where, NULL, "level %u (1 to %d)", o->level, LEVEL_MAX);
    if (!(o->crease_angle_rad >= 0 && o->crease_angle_rad <= 3.15)) /* 180° however it was rounded */
        return report_error(report, KILN_CODE_USAGE, &where, NULL, "the crease angle must lie between 0° and 180°");
    kiln_camera camera = o->camera ? *o->camera : kiln_camera_default();
    return camera_check(&camera, &where, report);
}

static bool run(job *j, uint32_t threads) {
    uint32_t count = j->scene->mesh_count;
    threads_for(threads, count, examine, j);
    limit_levels(j);
    threads_for(threads, count, refine, j);
    return !atomic_load(&j->failed);
}

bool kiln_subdivide(kiln_scene *scene, const kiln_subdivide_options *given, kiln_subdivision_result **results,
                    uint32_t *result_count, kiln_report *report) {
    const kiln_subdivide_options defaults = {0}, *options = given ? given : &defaults;
    if (results) *results = NULL;
    if (result_count) *result_count = 0;
    if (!check_options(scene, options, report)) return false;
    uint32_t count = scene->mesh_count;
    view_scale view = view_of_camera(options->camera, options->height);
    mat4 *placements = view.present ? level_largest_instances(scene, &view) : NULL;
    kiln_subdivision_result *rows = array_alloc(count, sizeof *rows);
    job j = {.scene = scene, .plans = array_alloc(count, sizeof *j.plans)};
    uint64_t limit = options->triangle_limit ? options->triangle_limit : TRIANGLE_LIMIT;
    if (limit > TRIANGLE_LIMIT_MAX) limit = TRIANGLE_LIMIT_MAX;
    j.examination = (examination){scene, options, limit, view, placements, report};
    bool ok = (rows && j.plans && (placements || !view.present)) || report_no_memory(report, "subdividing");
    for (uint32_t i = 0; ok && i < count; i++) j.plans[i].result = &rows[i];
    ok = ok && run(&j, options->threads);
    free(j.plans);
    free(placements);
    if (ok && results) *results = rows;
    else free(rows);
    if (ok && result_count) *result_count = count;
    return ok;
}
