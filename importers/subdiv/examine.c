#include "importers/subdiv/examine.h"

#include <stdio.h>

#include "importers/subdiv/decide.h"
#include "scene/check.h"

typedef struct subject {
    const examination *x;
    const kiln_mesh *mesh;
    const mat4 *placement; /* NULL: no view */
    const kiln_where *where;
    mesh_plan *plan;
} subject;

static void say(const subject *s, const char *reason) {
    snprintf(s->plan->result->reason, sizeof s->plan->result->reason, "%s", reason);
}

/* Nobody asked for the mesh to be refined: it has to look like a smooth surface. */
static bool is_automatic(const subject *s) {
    return s->x->options->mode == KILN_SUBDIVIDE_AUTO && s->mesh->subdivision.scheme == KILN_SCHEME_AUTO &&
           s->mesh->subdivision.level <= 0;
}

/* What needs no look at the mesh; NULL: nothing. */
static const char *excuse(const subject *s) {
    if (s->x->options->mode == KILN_SUBDIVIDE_OFF) return "subdivision is off";
    if (!s->mesh->face_count) return "it has no faces";
    if (s->x->options->mode == KILN_SUBDIVIDE_LEVEL) return NULL;
    if (s->mesh->subdivision.scheme == KILN_SCHEME_NONE) return "polygons: not a subdivision surface";
    if (is_automatic(s) && !mesh_primvar(s->mesh, KILN_PRIMVAR_NORMAL, 0)) return "no authored normals: flat";
    return NULL;
}

/* False with a reason in the result, or with an error. */
static bool build_cage(const subject *s, kiln_scheme scheme, bool *error) {
    cage_options options = {scheme, s->x->options->crease_angle_rad};
    char obstacle[160];
    *error = false;
    if (cage_build(s->mesh, &options, &s->plan->arena, &s->plan->cage, obstacle, s->where, s->x->report)) return true;
    if (!obstacle[0]) return !(*error = true);
    say(s, obstacle);
    if (!is_automatic(s))
        report_warning(s->x->report, KILN_CODE_GEOMETRY, s->where, "repair the mesh", "it cannot be subdivided: %s",
                       obstacle);
    return false;
}

/* once: the cage refined once. */
static bool choose_level(const subject *s, const osd_surface *once) {
    if (!s->placement) return true;
    s->plan->result->level = level_for_view(&s->plan->cage, once, s->placement, &s->x->view);
    return s->plan->result->level > 0 || report_no_memory(s->x->report, "subdividing a mesh");
}

/* Fits the cage, and refines it where that is safe. */
static bool try_cage(const subject *s) {
    kiln_arena temporary = {0};
    osd_surface once;
    smoothness measured;
    kiln_cage *cage = &s->plan->cage;
    bool ok = osd_fit(cage, &s->plan->arena, s->where, s->x->report) &&
              osd_refine(cage, 1, &temporary, &once, s->where, s->x->report);
    if (ok && !smoothness_measure(s->mesh, cage, &once, &measured))
        ok = report_no_memory(s->x->report, "subdividing a mesh");
    if (ok && smoothness_decide(&measured, s->plan->result->reason)) {
        s->plan->result->refined = true;
        ok = choose_level(s, &once);
    }
    arena_free(&temporary);
    return ok;
}

/* Quads among triangles cannot be told apart for certain: where the likelier scheme would deform the mesh, the other
 * one may not. */
static bool examine_automatic(const subject *s) {
    kiln_subdivision_result *row = s->plan->result;
    if (row->scheme == KILN_SCHEME_BILINEAR) return say(s, "bilinear refinement changes no shape"), true;
    if (s->placement) {
        double pixels = level_edge_pixels(&s->plan->cage, s->placement, &s->x->view);
        if (pixels < 0) return report_no_memory(s->x->report, "subdividing a mesh");
        if (pixels <= 1) return say(s, "its edges are not longer than a pixel"), true;
    }
    if (!try_cage(s)) return false;
    kiln_scheme asked = s->x->options->scheme;
    bool settled = row->refined || (asked != KILN_SCHEME_NONE && asked != KILN_SCHEME_AUTO);
    if (settled || s->mesh->face_offsets) return true;
    kiln_subdivision_result first = *row;
    kiln_scheme other = first.scheme == KILN_SCHEME_LOOP ? KILN_SCHEME_CATMULL_CLARK : KILN_SCHEME_LOOP;
    bool error;
    arena_free(&s->plan->arena);
    if (!build_cage(s, other, &error)) return !error;
    if (!try_cage(s)) return false;
    if (row->refined) row->scheme = other;
    else *row = first;
    return true;
}

/* The file asks for the refinement, and leaves the level to the view. */
static bool examine_asked(const subject *s) {
    kiln_arena temporary = {0};
    osd_surface once;
    bool ok = osd_refine(&s->plan->cage, 1, &temporary, &once, s->where, s->x->report) && choose_level(s, &once);
    arena_free(&temporary);
    return ok;
}

static uint32_t asked_level(const subject *s) {
    int32_t level = s->mesh->subdivision.level;
    if (s->x->options->mode == KILN_SUBDIVIDE_LEVEL) return s->x->options->level;
    if (level > 0) return level < LEVEL_MAX ? (uint32_t)level : LEVEL_MAX;
    return LEVEL_WITHOUT_VIEW;
}

static bool examine_cage(const subject *s) {
    kiln_subdivision_result *row = s->plan->result;
    row->scheme = s->plan->cage.rules.scheme;
    row->quad_rate = s->plan->cage.quad_rate;
    row->level = asked_level(s);
    if (cage_refined_triangles(&s->plan->cage, 1) > s->x->triangle_limit)
        return say(s, "refining it would exceed the limit of triangles"), true;
    if (is_automatic(s)) return examine_automatic(s);
    row->refined = true;
    say(s, s->x->options->mode == KILN_SUBDIVIDE_LEVEL ? "asked for by the command" : "asked for by the file");
    bool level_is_given = s->x->options->mode == KILN_SUBDIVIDE_LEVEL || s->mesh->subdivision.level > 0;
    return level_is_given || examine_asked(s);
}

bool examine_mesh(const examination *x, kiln_id id, mesh_plan *plan) {
    const kiln_mesh *m = scene_mesh(x->scene, id);
    scene_place place;
    place_set(&place, x->scene, "mesh", m->name, id);
    subject s = {x, m, x->placements ? &x->placements[id - 1] : NULL, &place.where, plan};
    plan->result->mesh = id;
    const char *reason = excuse(&s);
    if (reason) return say(&s, reason), true;
    bool error = false;
    kiln_scheme asked = x->options->scheme;
    bool ok = build_cage(&s, asked, &error) ? examine_cage(&s) : !error;
    if (ok && plan->result->refined) return true;
    plan->result->refined = false;
    plan->result->level = 0;
    arena_free(&plan->arena);
    return ok;
}
