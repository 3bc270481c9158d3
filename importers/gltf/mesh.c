#include <stdlib.h>
#include <string.h>

#include "importers/gltf/parts.h"
#include "importers/gltf/value.h"
#include "importers/mesh/complete.h"

enum { MODE_TRIANGLES = 4 };

void *parts_array(mesh_parts *m, size_t count, size_t size) {
    size_t bytes;
    if (!size_mul(count, size, &bytes)) bytes = SIZE_MAX;
    if (!reader_reserve(m->r, bytes, &m->where)) return NULL;
    void *array = arena_array(&m->arena, count, size);
    if (!array) report_no_memory(m->r->report, "reading a mesh");
    return array;
}

int part_attribute(const mesh_part *part, const char *name) {
    const gltf_attributes *a = &part->primitive->attributes;
    for (size_t i = 0; i < a->count; i++)
        if (strcmp(a->items[i].name, name) == 0) return a->items[i].accessor;
    return -1;
}

/* tinygltf sorts attributes by name. */
static bool same_attributes(const mesh_part *a, const mesh_part *b) {
    const gltf_attributes *x = &a->primitive->attributes, *y = &b->primitive->attributes;
    if (x->count != y->count) return false;
    for (size_t i = 0; i < x->count; i++)
        if (x->items[i].accessor != y->items[i].accessor || strcmp(x->items[i].name, y->items[i].name) != 0)
            return false;
    return true;
}

/* Primitives of one vertex buffer, one for each material, are the rule in some tools. They stand side by side: looking
 * at a few before is enough, and keeps a mesh of 100,000 primitives linear. */
static void place_vertices(mesh_parts *m, mesh_part *part) {
    enum { NEIGHBOURS = 64 };
    for (size_t i = m->count; i-- > 0 && m->count - i <= NEIGHBOURS;)
        if (same_attributes(&m->parts[i], part)) {
            part->shared = true;
            part->first_vertex = m->parts[i].first_vertex;
            return;
        }
    part->first_vertex = m->vertex_count;
    m->vertex_count += part->vertex_count;
}

static void open_part(mesh_parts *m, size_t index) {
    const gltf_document *d = &m->r->document;
    const gltf_primitive *p = &m->mesh->primitives[index];
    kiln_where where = where_item(&m->where, "primitives", index);
    mesh_part part = {.primitive = p, .index = index};
    int position = part_attribute(&part, "POSITION");
    if (p->mode < MODE_TRIANGLES) {
        report_warning(m->r->report, KILN_CODE_IGNORED, &where, NULL, "points and lines are left out");
    } else if (position < 0) {
        report_warning(m->r->report, KILN_CODE_IGNORED, &where, NULL, "a primitive without positions is left out");
    } else {
        part.vertex_count = d->accessors[position].count;
        part.corner_count = p->indices >= 0 ? d->accessors[p->indices].count : part.vertex_count;
        place_vertices(m, &part);
        m->parts[m->count++] = part;
    }
}

static bool open_parts(mesh_parts *m) {
    m->parts = reader_array(m->r, m->mesh->primitive_count, sizeof *m->parts, &m->where);
    if (!m->parts) return false;
    for (size_t i = 0; i < m->mesh->primitive_count; i++) {
        open_part(m, i);
        if (m->vertex_count >= UINT32_MAX)
            return report_error(m->r->report, KILN_CODE_LIMIT, &m->where, "split the mesh",
                                "more than %u vertices in a mesh", UINT32_MAX);
    }
    return true;
}

/* What the mesh's own extras say, or else those of the node that asks for it. */
static bool read_subdivision(mesh_parts *m, int asking_node, uint32_t **tags, size_t *tag_count) {
    const gltf_value *extras = &m->mesh->extras;
    kiln_where owner = m->where;
    if (!value_member(extras, "subdivision") && asking_node >= 0) {
        extras = &m->r->document.nodes[asking_node].extras;
        owner = where_item(&m->r->file, "nodes", (size_t)asking_node);
    }
    if (!parts_read_subdivision(m, extras, tags, tag_count, &owner)) return false;
    m->subdivision.triangulated = true;
    m->subdivision.fan_encoded = true;
    for (size_t i = 0; i < m->count; i++)
        m->subdivision.fan_encoded &= value_member(&m->parts[i].primitive->extensions, "FB_ngon_encoding") != NULL;
    return true;
}

static bool add_to_scene(mesh_parts *m, kiln_id *id) {
    int material = m->parts[0].primitive->material;
    kiln_mesh_desc desc = {.name = m->mesh->name,
                           .vertex_count = (uint32_t)m->vertex_count,
                           .positions = m->positions,
                           .face_count = (uint32_t)m->face_count,
                           .face_vertices = m->corners,
                           .primvars = m->primvars,
                           .primvar_count = m->primvar_count,
                           .material = material < 0 ? 0 : m->r->materials[material],
                           .face_materials = m->materials,
                           .subdivision = m->subdivision};
    scene_locate(m->r->scene, &m->where);
    bool added = complete_mesh(m->r->scene, &desc, &m->arena, &m->where, m->r->report) &&
                 scene_adopt_mesh(m->r->scene, &m->arena, &desc, id, m->r->report);
    scene_locate(m->r->scene, &m->r->file);
    return added;
}

static bool add_mesh(gltf_reader *r, size_t index, int asking_node) {
    mesh_parts m = {.r = r, .mesh = &r->document.meshes[index], .where = where_item(&r->file, "meshes", index)};
    uint32_t *tags;
    size_t tag_count;
    bool done = open_parts(&m);
    if (done && m.count)
        done = parts_read_faces(&m) && parts_read_primvars(&m) && read_subdivision(&m, asking_node, &tags, &tag_count) &&
               parts_compact(&m, tags, tag_count) && add_to_scene(&m, &r->meshes[index]);
    arena_free(&m.arena);
    return done;
}

bool gltf_add_meshes(gltf_reader *r) {
    size_t count = r->document.mesh_count;
    bool *placed = reader_array(r, count, sizeof *placed, &r->file);
    int *asking = placed ? reader_array(r, count, sizeof *asking, &r->file) : NULL; /* nodes that want subdivision */
    if (!asking) return false;
    for (size_t i = 0; i < count; i++) asking[i] = -1;
    for (size_t i = 0; i < r->placement_count; i++) {
        const gltf_node *node = &r->document.nodes[r->placements[i].node];
        placed[node->mesh] = true;
        if (asking[node->mesh] < 0 && value_member(&node->extras, "subdivision"))
            asking[node->mesh] = (int)r->placements[i].node;
    }
    for (size_t i = 0; i < count; i++)
        if (placed[i] && !add_mesh(r, i, asking[i])) return false;
    return true;
}
