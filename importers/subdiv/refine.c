#include "importers/subdiv/refine.h"

#include <string.h>

#include "importers/mesh/complete.h"

typedef struct refiner {
    const kiln_mesh *mesh;
    const kiln_cage *cage;
    osd_surface surface;
    kiln_arena *arena; /* of the refined mesh */
} refiner;

static kiln_primvar primvar_of(kiln_primvar_kind kind, uint32_t set, const osd_values *v) {
    return (kiln_primvar){kind, set, v->indices ? KILN_FACE_VARYING : KILN_VERTEX, v->values, v->value_count,
                          v->indices};
}

/* A value per face goes to the face's children. */
static bool pass_to_children(const refiner *r, const kiln_primvar *p, kiln_primvar *out) {
    uint32_t width = primvar_width(p->kind);
    float *values = arena_array(r->arena, r->surface.face_count, width * sizeof *values);
    for (uint32_t f = 0; values && f < r->surface.face_count; f++)
        memcpy(values + (size_t)width * f, primvar_at(p, r->cage->face_sources[r->surface.face_parents[f]], 0, 0),
               width * sizeof *values);
    *out = (kiln_primvar){p->kind, p->set, KILN_UNIFORM, values, r->surface.face_count, NULL};
    return values != NULL;
}

static bool copy_constant(const refiner *r, const kiln_primvar *p, kiln_primvar *out) {
    float *value = arena_copy(r->arena, primvar_at(p, 0, 0, 0), primvar_width(p->kind), sizeof *value);
    *out = (kiln_primvar){p->kind, p->set, KILN_CONSTANT, value, 1, NULL};
    return value != NULL;
}

/* Limit normals replace authored ones, refined UVs and colours the cage's; tangents belong to normals that are gone. */
static bool make_primvars(const refiner *r, kiln_mesh_desc *desc) {
    kiln_primvar *primvars = ARENA_ARRAY(r->arena, kiln_primvar, (size_t)r->mesh->primvar_count + 1);
    if (!primvars) return false;
    uint32_t count = 0;
    bool limit_normals = r->surface.normals.value_count > 0;
    if (limit_normals) primvars[count++] = primvar_of(KILN_PRIMVAR_NORMAL, 0, &r->surface.normals);
    for (uint32_t i = 0; i < r->cage->channel_count; i++)
        primvars[count++] = primvar_of(r->cage->channels[i].kind, r->cage->channels[i].set, &r->surface.channels[i]);
    for (uint32_t i = 0; i < r->mesh->primvar_count; i++) {
        const kiln_primvar *p = &r->mesh->primvars[i];
        bool gone = p->kind == KILN_PRIMVAR_TANGENT || (p->kind == KILN_PRIMVAR_NORMAL && limit_normals);
        if (gone || (p->interpolation != KILN_UNIFORM && p->interpolation != KILN_CONSTANT)) continue;
        kiln_primvar *out = &primvars[count];
        bool ok = p->interpolation == KILN_UNIFORM ? pass_to_children(r, p, out) : copy_constant(r, p, out);
        if (!ok) return false;
        count++;
    }
    desc->primvars = primvars;
    desc->primvar_count = count;
    return true;
}

static bool make_faces(const refiner *r, kiln_mesh_desc *desc) {
    const osd_surface *s = &r->surface;
    uint32_t *sizes = s->face_size == 3 ? NULL : ARENA_ARRAY(r->arena, uint32_t, s->face_count);
    kiln_id *materials = r->mesh->face_materials ? ARENA_ARRAY(r->arena, kiln_id, s->face_count) : NULL;
    if ((s->face_size != 3 && !sizes) || (r->mesh->face_materials && !materials)) return false;
    for (uint32_t f = 0; f < s->face_count; f++) {
        if (sizes) sizes[f] = s->face_size;
        if (materials) materials[f] = r->mesh->face_materials[r->cage->face_sources[s->face_parents[f]]];
    }
    desc->face_sizes = sizes;
    desc->face_materials = materials;
    return true;
}

static bool make_mesh(refiner *r, kiln_mesh_desc *desc, kiln_report *report) {
    const osd_surface *s = &r->surface;
    *desc = (kiln_mesh_desc){.name = r->mesh->name,
                             .vertex_count = s->vertex_count,
                             .time_count = r->cage->time_count,
                             .positions = s->positions,
                             .face_count = s->face_count,
                             .face_vertices = s->face_vertices,
                             .material = r->mesh->material};
    return (make_faces(r, desc) && make_primvars(r, desc)) || report_no_memory(report, "subdividing a mesh");
}

bool refine_mesh(kiln_scene *scene, kiln_id id, const kiln_cage *cage, uint32_t level, const kiln_where *where,
                 kiln_report *report) {
    kiln_arena arena = {0};
    refiner r = {.mesh = scene_mesh(scene, id), .cage = cage, .arena = &arena};
    kiln_mesh_desc desc;
    if (osd_refine(cage, level, &arena, &r.surface, where, report) && make_mesh(&r, &desc, report) &&
        complete_mesh(scene, &desc, &arena, where, report))
        return scene_replace_mesh(scene, id, &arena, &desc, report);
    arena_free(&arena);
    return false;
}
