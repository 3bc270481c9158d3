#include "scene/mesh_build.h"

#include <string.h>

#include "scene/check.h"

const kiln_primvar *mesh_primvar(const kiln_mesh *mesh, kiln_primvar_kind kind, uint32_t set) {
    for (uint32_t i = 0; i < mesh->primvar_count; i++)
        if (mesh->primvars[i].kind == kind && mesh->primvars[i].set == set) return &mesh->primvars[i];
    return NULL;
}

void *mesh_keep(mesh_builder *b, const void *array, size_t count, size_t size) {
    if (!array && count) {
        report_error(b->report, KILN_CODE_USAGE, b->where, NULL, "an array of %zu elements is missing", count);
        return NULL;
    }
    if (b->adopt && array) return (void *)array;
    void *copy = arena_copy(&b->mesh->arena, array, count, size);
    if (!copy) report_no_memory(b->report, "building a mesh");
    return copy;
}

static bool build_positions(mesh_builder *b) {
    kiln_mesh *m = b->mesh;
    m->vertex_count = b->desc->vertex_count;
    m->time_count = b->desc->time_count ? b->desc->time_count : 1;
    if (!check_time_count(m->time_count, b->where, b->report)) return false;
    size_t points = (size_t)m->vertex_count * m->time_count;
    m->positions = mesh_keep(b, b->desc->positions, points, 3 * sizeof(float));
    if (!m->positions) return false;
    for (int k = 0; k < 3; k++) m->min[k] = INFINITY, m->max[k] = -INFINITY;
    for (size_t i = 0; i < points; i++)
        for (int k = 0; k < 3; k++) {
            float x = m->positions[3 * i + (size_t)k];
            if (!isfinite(x))
                return report_error(b->report, KILN_CODE_GEOMETRY, b->where,
                                    "repair the mesh in the tool that wrote it",
                                    "vertex %zu has a position that is not finite", i % m->vertex_count);
            if (x < m->min[k]) m->min[k] = x;
            if (x > m->max[k]) m->max[k] = x;
        }
    return true;
}

/* Offsets from sizes; stays NULL where all faces are triangles. */
static bool build_faces(mesh_builder *b) {
    kiln_mesh *m = b->mesh;
    const uint32_t *sizes = b->desc->face_sizes;
    m->face_count = b->desc->face_count;
    uint64_t corners = sizes ? 0 : 3 * (uint64_t)m->face_count;
    bool triangles = true;
    for (uint32_t f = 0; sizes && f < m->face_count; f++) {
        if (sizes[f] < 3)
            return report_error(b->report, KILN_CODE_GEOMETRY, b->where, "remove faces without an area",
                                "face %u has %u corners", f, sizes[f]);
        triangles &= sizes[f] == 3;
        corners += sizes[f];
    }
    if (corners > UINT32_MAX)
        return report_error(b->report, KILN_CODE_LIMIT, b->where, "split the mesh",
                            "%llu corners of faces (at most %u)", (unsigned long long)corners, UINT32_MAX);
    m->corner_count = (uint32_t)corners;
    m->triangle_count = (uint32_t)(corners - 2 * (uint64_t)m->face_count);
    if (!m->face_count)
        report_warning(b->report, KILN_CODE_GEOMETRY, b->where, NULL, "the mesh has no faces: there is nothing to see");
    if (triangles) return true;
    uint32_t *offsets = ARENA_ARRAY(&m->arena, uint32_t, (size_t)m->face_count + 1);
    if (!offsets) return report_no_memory(b->report, "building a mesh");
    for (uint32_t f = 0; f < m->face_count; f++) offsets[f + 1] = offsets[f] + sizes[f];
    m->face_offsets = offsets;
    return true;
}

/* Names the first face that uses a vertex that does not exist. */
static bool refuse_vertices(const mesh_builder *b) {
    const kiln_mesh *m = b->mesh;
    for (uint32_t f = 0; f < m->face_count; f++)
        for (uint32_t c = mesh_face_first(m, f), end = c + mesh_face_size(m, f); c < end; c++)
            if (m->face_vertices[c] >= m->vertex_count)
                return report_error(b->report, KILN_CODE_RANGE, b->where, "repair the mesh in the tool that wrote it",
                                    "face %u uses vertex %u of %u", f, m->face_vertices[c], m->vertex_count);
    return false;
}

static bool build_corners(mesh_builder *b) {
    kiln_mesh *m = b->mesh;
    m->face_vertices = mesh_keep(b, b->desc->face_vertices, m->corner_count, sizeof(uint32_t));
    if (!m->face_vertices) return false;
    uint32_t largest = 0;
    for (uint32_t c = 0; c < m->corner_count; c++)
        largest = m->face_vertices[c] > largest ? m->face_vertices[c] : largest;
    return !m->corner_count || largest < m->vertex_count || refuse_vertices(b);
}

static bool build_materials(mesh_builder *b) {
    kiln_mesh *m = b->mesh;
    uint32_t count = b->scene->material_count;
    m->material = b->desc->material;
    if (!check_reference(m->material, count, true, "material", b->where, b->report)) return false;
    if (!b->desc->face_materials) return true;
    m->face_materials = mesh_keep(b, b->desc->face_materials, m->face_count, sizeof(kiln_id));
    if (!m->face_materials) return false;
    for (uint32_t f = 0; f < m->face_count; f++)
        if (!check_reference(m->face_materials[f], count, true, "material", b->where, b->report)) return false;
    return true;
}

/* On failure the mesh's arena is freed. */
static bool build(mesh_builder *b) {
    b->mesh->name = arena_string(&b->mesh->arena, b->desc->name);
    bool ok = b->mesh->name || report_no_memory(b->report, "building a mesh");
    ok = ok && build_positions(b) && build_faces(b) && build_corners(b) && build_materials(b) &&
         mesh_build_primvars(b) && mesh_build_tags(b);
    if (!ok) arena_free(&b->mesh->arena);
    return ok;
}

/* Builds the mesh in mesh->arena, which already holds the description's arrays where adopt is set. */
static bool add(kiln_scene *scene, kiln_mesh *mesh, const kiln_mesh_desc *desc, bool adopt, kiln_id *id,
                kiln_report *report) {
    scene_place place;
    place_set(&place, scene, "mesh", desc->name, (size_t)scene->mesh_count + 1);
    mesh_builder b = {scene, desc, mesh, adopt, &place.where, report};
    if (!check_open(scene, &place.where, report) ||
        !array_room((void **)&scene->meshes, scene->mesh_count, sizeof *mesh, report)) {
        arena_free(&mesh->arena);
        return false;
    }
    if (!build(&b)) return false;
    scene->meshes[scene->mesh_count++] = *mesh;
    if (id) *id = scene->mesh_count;
    return true;
}

bool kiln_scene_add_mesh(kiln_scene *scene, const kiln_mesh_desc *desc, kiln_id *id, kiln_report *report) {
    kiln_mesh mesh = {0};
    return add(scene, &mesh, desc, false, id, report);
}

bool scene_adopt_mesh(kiln_scene *scene, kiln_arena *arena, const kiln_mesh_desc *desc, kiln_id *id,
                      kiln_report *report) {
    kiln_mesh mesh = {.arena = *arena};
    *arena = (kiln_arena){0};
    return add(scene, &mesh, desc, true, id, report);
}

bool scene_replace_mesh(kiln_scene *scene, kiln_id id, kiln_arena *arena, const kiln_mesh_desc *desc,
                        kiln_report *report) {
    scene_place place;
    place_set(&place, scene, "mesh", desc->name, id);
    kiln_mesh mesh = {.arena = *arena};
    *arena = (kiln_arena){0};
    mesh_builder b = {scene, desc, &mesh, true, &place.where, report};
    if (!check_open(scene, &place.where, report)) {
        arena_free(&mesh.arena);
        return false;
    }
    if (!build(&b)) return false;
    arena_free(&scene->meshes[id - 1].arena);
    scene->meshes[id - 1] = mesh;
    return true;
}
