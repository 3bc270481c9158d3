#include "importers/mesh/complete.h"

#include <stdlib.h>
#include <string.h>

#include "importers/mesh/normals.h"
#include "importers/mesh/tangents.h"

static const char attribute_text[] = "completing the attributes of a mesh";

const kiln_primvar *mesh_primvar(const kiln_mesh_desc *mesh, kiln_primvar_kind kind, uint32_t set) {
    for (uint32_t i = 0; i < mesh->primvar_count; i++)
        if (mesh->primvars[i].kind == kind && mesh->primvars[i].set == set) return &mesh->primvars[i];
    return NULL;
}

static bool set_primvar(kiln_mesh_desc *mesh, kiln_primvar added, kiln_arena *arena, kiln_report *report) {
    kiln_primvar *primvars = ARENA_ARRAY(arena, kiln_primvar, (size_t)mesh->primvar_count + 1);
    if (!primvars) return report_no_memory(report, attribute_text);
    uint32_t count = 0;
    for (uint32_t i = 0; i < mesh->primvar_count; i++)
        if (mesh->primvars[i].kind != added.kind || mesh->primvars[i].set != added.set)
            primvars[count++] = mesh->primvars[i];
    primvars[count++] = added;
    mesh->primvars = primvars;
    mesh->primvar_count = count;
    return true;
}

static uint32_t face_size(const kiln_mesh_desc *mesh, uint32_t face) {
    return mesh->face_sizes ? mesh->face_sizes[face] : 3;
}

/* Corners and triangles of all faces. */
typedef struct extent {
    size_t corners, triangles;
} extent;

static bool check_faces(const kiln_mesh_desc *mesh, extent *size, const kiln_where *where, kiln_report *report) {
    *size = (extent){0};
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t corners = face_size(mesh, f);
        if (corners < 3)
            return report_error(report, KILN_CODE_GEOMETRY, where, "remove the face", "face %u has %u corners", f,
                                corners);
        for (uint32_t i = 0; i < corners; i++)
            if (mesh->face_vertices[size->corners + i] >= mesh->vertex_count)
                return report_error(report, KILN_CODE_RANGE, where, "repair the indices",
                                    "face %u refers to vertex %u of %u", f, mesh->face_vertices[size->corners + i],
                                    mesh->vertex_count);
        size->corners += corners;
        size->triangles += corners - 2;
    }
    if (size->corners <= UINT32_MAX) return true;
    return report_error(report, KILN_CODE_LIMIT, where, "split the mesh", "%zu corners in one mesh", size->corners);
}

/* Where a primvar keeps the value of a corner; false: out of range. */
static bool find_value(const kiln_primvar *p, uint32_t face, size_t corner, uint32_t vertex, size_t *value) {
    size_t element = 0;
    switch (p->interpolation) {
    case KILN_VERTEX: element = vertex; break;
    case KILN_FACE_VARYING: element = corner; break;
    case KILN_UNIFORM: element = face; break;
    case KILN_CONSTANT: break;
    }
    *value = p->indices ? p->indices[element] : element;
    return *value < p->value_count;
}

/* Copies a primvar to the corners of all triangles. The positions count as a primvar too. */
static float *spread(const kiln_mesh_desc *mesh, const kiln_primvar *p, uint32_t width, size_t triangles,
                     const kiln_where *where, kiln_report *report) {
    float *values = array_alloc(triangles, 3 * width * sizeof *values), *to = values;
    if (!values) {
        report_no_memory(report, attribute_text);
        return NULL;
    }
    size_t first = 0;
    for (uint32_t f = 0; f < mesh->face_count; first += face_size(mesh, f), f++)
        for (uint32_t i = 1; i + 1 < face_size(mesh, f); i++) {
            const size_t corners[3] = {first, first + i, first + i + 1};
            for (int k = 0; k < 3; k++, to += width) {
                size_t value;
                if (!find_value(p, f, corners[k], mesh->face_vertices[corners[k]], &value)) {
                    report_error(report, KILN_CODE_RANGE, where, "repair the indices",
                                 "face %u refers to value %zu of an attribute of %u", f, value, p->value_count);
                    free(values);
                    return NULL;
                }
                memcpy(to, p->values + width * value, width * sizeof *to);
            }
        }
    return values;
}

static float *spread_positions(const kiln_mesh_desc *mesh, size_t triangles, const kiln_where *where,
                               kiln_report *report) {
    kiln_primvar positions = {.interpolation = KILN_VERTEX, .values = mesh->positions,
                              .value_count = mesh->vertex_count};
    return spread(mesh, &positions, 3, triangles, where, report);
}

/* Back from the corners of triangles to those of faces: what the first triangle of the fan says for the first two
 * corners, and each triangle for its last. */
static float *gather(const kiln_mesh_desc *mesh, const float *triangles, uint32_t width, size_t corners,
                     kiln_arena *arena, kiln_report *report) {
    float *values = arena_array(arena, corners, width * sizeof *values), *to = values;
    if (!values) {
        report_no_memory(report, attribute_text);
        return NULL;
    }
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t size = face_size(mesh, f);
        memcpy(to, triangles, 3 * width * sizeof *to);
        for (uint32_t i = 3; i < size; i++)
            memcpy(to + i * width, triangles + (3 * (i - 2) + 2) * width, width * sizeof *to);
        to += size * width;
        triangles += 3 * (size_t)(size - 2) * width;
    }
    return values;
}

bool mesh_add_flat_normals(kiln_mesh_desc *mesh, kiln_arena *arena, const kiln_where *where, kiln_report *report) {
    extent size;
    if (!check_faces(mesh, &size, where, report)) return false;
    float *normals = arena_array(arena, mesh->face_count, 3 * sizeof *normals);
    if (!normals) return report_no_memory(report, attribute_text);
    const uint32_t *corner = mesh->face_vertices;
    for (uint32_t f = 0; f < mesh->face_count; corner += face_size(mesh, f), f++)
        normals_face(mesh->positions, corner, face_size(mesh, f), normals + 3 * (size_t)f);
    kiln_primvar added = {.kind = KILN_PRIMVAR_NORMAL, .interpolation = KILN_UNIFORM, .values = normals,
                          .value_count = mesh->face_count};
    return set_primvar(mesh, added, arena, report);
}

bool mesh_add_smooth_normals(kiln_mesh_desc *mesh, double crease_angle_rad, kiln_arena *arena,
                             const kiln_where *where, kiln_report *report) {
    extent size;
    if (!check_faces(mesh, &size, where, report)) return false;
    float *positions = spread_positions(mesh, size.triangles, where, report);
    float *normals = positions ? array_alloc(size.triangles, 9 * sizeof *normals) : NULL;
    float *values = NULL;
    if (normals && normals_smooth(positions, (uint32_t)size.triangles, crease_angle_rad, normals, report))
        values = gather(mesh, normals, 3, size.corners, arena, report);
    else if (positions && !normals) report_no_memory(report, attribute_text);
    free(positions);
    free(normals);
    kiln_primvar added = {.kind = KILN_PRIMVAR_NORMAL, .interpolation = KILN_FACE_VARYING, .values = values,
                          .value_count = (uint32_t)size.corners};
    return values && set_primvar(mesh, added, arena, report);
}

bool mesh_add_tangents(kiln_mesh_desc *mesh, uint32_t uv_set, kiln_arena *arena, const kiln_where *where,
                       kiln_report *report) {
    extent size;
    if (!mesh_primvar(mesh, KILN_PRIMVAR_UV, uv_set)) return true;
    if (!mesh_primvar(mesh, KILN_PRIMVAR_NORMAL, 0) && !mesh_add_flat_normals(mesh, arena, where, report)) return false;
    if (!check_faces(mesh, &size, where, report)) return false;
    const kiln_primvar *normal = mesh_primvar(mesh, KILN_PRIMVAR_NORMAL, 0);
    const kiln_primvar *uv = mesh_primvar(mesh, KILN_PRIMVAR_UV, uv_set);
    float *positions = spread_positions(mesh, size.triangles, where, report);
    float *normals = positions ? spread(mesh, normal, 3, size.triangles, where, report) : NULL;
    float *uvs = normals ? spread(mesh, uv, 2, size.triangles, where, report) : NULL;
    float *tangents = uvs ? array_alloc(size.triangles, 12 * sizeof *tangents) : NULL;
    float *values = NULL;
    if (tangents && tangents_generate(positions, normals, uvs, (uint32_t)size.triangles, tangents, report))
        values = gather(mesh, tangents, 4, size.corners, arena, report);
    else if (uvs && !tangents) report_no_memory(report, attribute_text);
    free(positions);
    free(normals);
    free(uvs);
    free(tangents);
    kiln_primvar added = {.kind = KILN_PRIMVAR_TANGENT, .interpolation = KILN_FACE_VARYING, .values = values,
                          .value_count = (uint32_t)size.corners};
    return values && set_primvar(mesh, added, arena, report);
}
