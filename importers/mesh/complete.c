#include "importers/mesh/complete.h"

#include <stdlib.h>
#include <string.h>

#include "importers/mesh/normals.h"
#include "importers/mesh/tangents.h"
#include "scene/material.h"
#include "scene/scene.h"
#include "scene/triangulate.h"

static bool no_memory(kiln_report *report) { return report_no_memory(report, "completing the attributes of a mesh"); }

static const kiln_primvar *find(const kiln_mesh_desc *mesh, kiln_primvar_kind kind, uint32_t set) {
    for (uint32_t i = 0; i < mesh->primvar_count; i++)
        if (mesh->primvars[i].kind == kind && mesh->primvars[i].set == set) return &mesh->primvars[i];
    return NULL;
}

/* Takes the primvar of this kind and set out of the mesh, and puts *added, if it is given, behind the others. */
static bool exchange(kiln_mesh_desc *mesh, kiln_primvar_kind kind, uint32_t set, const kiln_primvar *added,
                     kiln_arena *arena, kiln_report *report) {
    kiln_primvar *primvars = ARENA_ARRAY(arena, kiln_primvar, (size_t)mesh->primvar_count + 1);
    if (!primvars) return no_memory(report);
    uint32_t count = 0;
    for (uint32_t i = 0; i < mesh->primvar_count; i++)
        if (mesh->primvars[i].kind != kind || mesh->primvars[i].set != set) primvars[count++] = mesh->primvars[i];
    if (added) primvars[count++] = *added;
    mesh->primvars = primvars;
    mesh->primvar_count = count;
    return true;
}

static uint32_t face_size(const kiln_mesh_desc *mesh, uint32_t face) {
    return mesh->face_sizes ? mesh->face_sizes[face] : 3;
}

/* The corners of all faces, counted; faces that nothing can be computed from are errors. */
static bool count_corners(const kiln_mesh_desc *mesh, uint32_t *corner_count, const kiln_where *where,
                          kiln_report *report) {
    uint64_t corners = 0;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t size = face_size(mesh, f);
        if (size < 3)
            return report_error(report, KILN_CODE_GEOMETRY, where, "remove the face", "face %u has %u corners", f,
                                size);
        if (corners + size > UINT32_MAX)
            return report_error(report, KILN_CODE_LIMIT, where, "split the mesh", "more than %u corners in one mesh",
                                UINT32_MAX);
        for (uint32_t i = 0; i < size; i++)
            if (mesh->face_vertices[corners + i] >= mesh->vertex_count)
                return report_error(report, KILN_CODE_RANGE, where, "repair the indices",
                                    "face %u refers to vertex %u of %u", f, mesh->face_vertices[corners + i],
                                    mesh->vertex_count);
        corners += size;
    }
    *corner_count = (uint32_t)corners;
    return true;
}

/* The triangles of a mesh: for each of their corners the corner of the face that it is. */
typedef struct triangles {
    uint32_t count, corner_count; /* corners of faces */
    uint32_t *corners, *faces;
    float *positions;
} triangles;

static void triangles_free(triangles *t) {
    free(t->corners);
    free(t->faces);
    free(t->positions);
}

static uint32_t *offsets_of(const kiln_mesh_desc *mesh) {
    uint32_t *offsets = array_alloc((size_t)mesh->face_count + 1, sizeof *offsets);
    for (uint32_t f = 0; offsets && f < mesh->face_count; f++) offsets[f + 1] = offsets[f] + face_size(mesh, f);
    return offsets;
}

static bool triangulate(const kiln_mesh_desc *mesh, triangles *t) {
    uint32_t *offsets = mesh->face_sizes ? offsets_of(mesh) : NULL;
    t->count = t->corner_count - 2 * mesh->face_count;
    t->corners = array_alloc(t->count, 3 * sizeof *t->corners);
    t->faces = array_alloc(t->count, sizeof *t->faces);
    t->positions = array_alloc(t->count, 9 * sizeof *t->positions);
    bool done = t->corners && t->faces && t->positions && (offsets || !mesh->face_sizes);
    if (done && offsets) {
        const kiln_mesh polygons = {.vertex_count = mesh->vertex_count, .time_count = 1, .face_count = mesh->face_count,
                                    .corner_count = t->corner_count, .triangle_count = t->count,
                                    .positions = mesh->positions, .face_offsets = offsets,
                                    .face_vertices = mesh->face_vertices};
        done = mesh_triangulate(&polygons, t->corners, t->faces);
    } else if (done) {
        for (uint32_t c = 0; c < t->corner_count; c++) t->corners[c] = c;
        for (uint32_t f = 0; f < t->count; f++) t->faces[f] = f;
    }
    free(offsets);
    for (size_t c = 0; done && c < 3 * (size_t)t->count; c++)
        memcpy(t->positions + 3 * c, mesh->positions + 3 * (size_t)mesh->face_vertices[t->corners[c]],
               3 * sizeof *t->positions);
    return done;
}

static bool make_triangles(const kiln_mesh_desc *mesh, triangles *t, const kiln_where *where, kiln_report *report) {
    *t = (triangles){0};
    if (!count_corners(mesh, &t->corner_count, where, report)) return false;
    if (triangulate(mesh, t)) return true;
    triangles_free(t);
    return no_memory(report);
}

/* Copies a primvar to the corners of the triangles; NULL: an error was added. */
static float *spread(const kiln_mesh_desc *mesh, const triangles *t, const kiln_primvar *p, const kiln_where *where,
                     kiln_report *report) {
    uint32_t width = primvar_width(p->kind);
    float *values = array_alloc(t->count, 3 * width * sizeof *values);
    if (!values) no_memory(report);
    for (size_t c = 0; values && c < 3 * (size_t)t->count; c++) {
        uint32_t face = t->faces[c / 3], corner = t->corners[c];
        uint32_t value = primvar_index(p, face, corner, mesh->face_vertices[corner]);
        if (value >= p->value_count) {
            report_error(report, KILN_CODE_RANGE, where, "repair the indices",
                         "face %u refers to value %u of an attribute of %u", face, value, p->value_count);
            free(values);
            return NULL;
        }
        memcpy(values + width * c, p->values + (size_t)width * value, width * sizeof *values);
    }
    return values;
}

/* Makes a face-varying primvar of values at the corners of triangles. Triangles of one face share corners; the last
 * one speaks. */
static bool add_varying(kiln_mesh_desc *mesh, const triangles *t, kiln_primvar_kind kind, const float *values,
                        kiln_arena *arena, kiln_report *report) {
    uint32_t width = primvar_width(kind);
    float *varying = arena_array(arena, t->corner_count, width * sizeof *varying);
    if (!varying) return no_memory(report);
    for (size_t c = 0; c < 3 * (size_t)t->count; c++)
        memcpy(varying + (size_t)width * t->corners[c], values + width * c, width * sizeof *varying);
    kiln_primvar added = {.kind = kind, .interpolation = KILN_FACE_VARYING, .values = varying,
                          .value_count = t->corner_count};
    return exchange(mesh, kind, 0, &added, arena, report);
}

bool complete_flat_normals(kiln_mesh_desc *mesh, kiln_arena *arena, const kiln_where *where, kiln_report *report) {
    uint32_t corner_count;
    if (!count_corners(mesh, &corner_count, where, report)) return false;
    float *normals = arena_array(arena, mesh->face_count, 3 * sizeof *normals);
    if (!normals) return no_memory(report);
    const uint32_t *corner = mesh->face_vertices;
    for (uint32_t f = 0; f < mesh->face_count; corner += face_size(mesh, f), f++)
        normals_face(mesh->positions, corner, face_size(mesh, f), normals + 3 * (size_t)f);
    kiln_primvar added = {.kind = KILN_PRIMVAR_NORMAL, .interpolation = KILN_UNIFORM, .values = normals,
                          .value_count = mesh->face_count};
    return exchange(mesh, KILN_PRIMVAR_NORMAL, 0, &added, arena, report);
}

bool complete_smooth_normals(kiln_mesh_desc *mesh, double crease_angle_rad, kiln_arena *arena,
                             const kiln_where *where, kiln_report *report) {
    triangles t;
    if (!make_triangles(mesh, &t, where, report)) return false;
    float *normals = array_alloc(t.count, 9 * sizeof *normals);
    bool done = normals ? normals_smooth(t.positions, t.count, crease_angle_rad, normals, report) &&
                              add_varying(mesh, &t, KILN_PRIMVAR_NORMAL, normals, arena, report)
                        : no_memory(report);
    free(normals);
    triangles_free(&t);
    return done;
}

bool complete_tangents(kiln_mesh_desc *mesh, uint32_t uv_set, kiln_arena *arena, const kiln_where *where,
                       kiln_report *report) {
    const kiln_primvar *uv = find(mesh, KILN_PRIMVAR_UV, uv_set);
    if (!uv) return true;
    if (!find(mesh, KILN_PRIMVAR_NORMAL, 0) && !complete_flat_normals(mesh, arena, where, report)) return false;
    uv = find(mesh, KILN_PRIMVAR_UV, uv_set);
    triangles t;
    if (!make_triangles(mesh, &t, where, report)) return false;
    float *normals = spread(mesh, &t, find(mesh, KILN_PRIMVAR_NORMAL, 0), where, report);
    float *uvs = normals ? spread(mesh, &t, uv, where, report) : NULL;
    float *tangents = uvs ? array_alloc(t.count, 12 * sizeof *tangents) : NULL;
    if (uvs && !tangents) no_memory(report);
    bool done = tangents && tangents_generate(t.positions, normals, uvs, t.count, tangents, report) &&
                add_varying(mesh, &t, KILN_PRIMVAR_TANGENT, tangents, arena, report);
    free(normals);
    free(uvs);
    free(tangents);
    triangles_free(&t);
    return done;
}

/* The UV set of the first material of the mesh that needs tangents; false: there is none. */
static bool find_tangent_set(const kiln_scene *scene, const kiln_mesh_desc *mesh, uint32_t *uv_set) {
    uint32_t count = mesh->face_materials ? mesh->face_count : 1;
    for (uint32_t f = 0; f < count; f++) {
        kiln_id id = mesh->face_materials ? mesh->face_materials[f] : mesh->material;
        if (id > scene->material_count) continue; /* an error, which the scene reports */
        if (material_tangents(scene_material(scene, id), uv_set)) return true;
    }
    return false;
}

bool complete_mesh(const kiln_scene *scene, kiln_mesh_desc *mesh, kiln_arena *arena, const kiln_where *where,
                   kiln_report *report) {
    uint32_t uv_set;
    if (!find(mesh, KILN_PRIMVAR_NORMAL, 0) &&
        !(exchange(mesh, KILN_PRIMVAR_TANGENT, 0, NULL, arena, report) &&
          complete_flat_normals(mesh, arena, where, report)))
        return false;
    if (find(mesh, KILN_PRIMVAR_TANGENT, 0) || !find_tangent_set(scene, mesh, &uv_set)) return true;
    return complete_tangents(mesh, uv_set, arena, where, report);
}
