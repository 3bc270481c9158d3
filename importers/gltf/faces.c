#include <stdlib.h>

#include "importers/gltf/parts.h"

enum { MODE_TRIANGLES = 4, MODE_STRIP = 5, MODE_FAN = 6 };

static size_t triangle_count(const mesh_part *part) {
    size_t corners = part->corner_count;
    if (part->primitive->mode == MODE_TRIANGLES) return corners / 3;
    return corners < 3 ? 0 : corners - 2;
}

/* Which of the primitive's corners make triangle t, in the winding of section 3.7.2.1 (topology types). */
static void triangle_corners(int mode, size_t t, size_t corner[3]) {
    size_t odd = t % 2;
    switch (mode) {
    case MODE_STRIP: corner[0] = t, corner[1] = t + 1 + odd, corner[2] = t + 2 - odd; break;
    case MODE_FAN: corner[0] = t + 1, corner[1] = t + 2, corner[2] = 0; break;
    default: corner[0] = 3 * t, corner[1] = 3 * t + 1, corner[2] = 3 * t + 2;
    }
}

static bool check_indices(const mesh_parts *m, const mesh_part *part, const uint32_t *indices,
                          const kiln_where *where) {
    int type = m->r->document.accessors[part->primitive->indices].component_type;
    uint32_t restart = type == GLTF_UNSIGNED_BYTE ? UINT8_MAX : type == GLTF_UNSIGNED_SHORT ? UINT16_MAX : UINT32_MAX;
    for (size_t i = 0; i < part->corner_count; i++) {
        if (indices[i] == restart)
            return report_error(m->r->report, KILN_CODE_RANGE, where, "export without primitive restart",
                                "index %zu is %u, the primitive restart value", i, restart);
        if (indices[i] >= part->vertex_count)
            return report_error(m->r->report, KILN_CODE_RANGE, where, "repair the mesh in the tool that wrote it",
                                "index %zu is %u, but there are only %zu vertices", i, indices[i], part->vertex_count);
    }
    return true;
}

/* The indices of a part, or 0, 1, 2, …; free(). */
static uint32_t *read_indices(mesh_parts *m, const mesh_part *part) {
    kiln_where primitive = where_item(&m->where, "primitives", part->index), where = where_key(&primitive, "indices");
    if (!reader_reserve(m->r, part->corner_count * sizeof(uint32_t), &where)) return NULL;
    uint32_t *indices = array_alloc(part->corner_count, sizeof *indices);
    bool ok = indices || report_no_memory(m->r->report, "reading a mesh");
    if (ok && part->primitive->indices >= 0)
        ok = accessor_integers(m->r, part->primitive->indices, indices, &where) &&
             check_indices(m, part, indices, &where);
    else
        for (size_t i = 0; ok && i < part->corner_count; i++) indices[i] = (uint32_t)i;
    m->r->budget += part->corner_count * sizeof(uint32_t); /* it does not live long */
    if (ok) return indices;
    free(indices);
    return NULL;
}

static bool read_part(mesh_parts *m, mesh_part *part) {
    uint32_t *indices = read_indices(m, part);
    if (!indices) return false;
    part->first_face = m->face_count;
    size_t count = triangle_count(part);
    for (size_t t = 0; t < count; t++) {
        size_t corner[3];
        triangle_corners(part->primitive->mode, t, corner);
        uint32_t a = indices[corner[0]], b = indices[corner[1]], c = indices[corner[2]];
        if (a == b || b == c || c == a) continue; /* no area: strips are sewn together by them */
        uint32_t *triangle = m->corners + 3 * m->face_count++;
        triangle[0] = (uint32_t)part->first_vertex + a;
        triangle[1] = (uint32_t)part->first_vertex + b;
        triangle[2] = (uint32_t)part->first_vertex + c;
    }
    part->face_count = m->face_count - part->first_face;
    free(indices);
    return true;
}

static bool set_materials(mesh_parts *m) {
    bool differ = false;
    for (size_t i = 1; i < m->count; i++) differ |= m->parts[i].primitive->material != m->parts[0].primitive->material;
    if (!differ) return true;
    m->materials = parts_array(m, m->face_count, sizeof *m->materials);
    if (!m->materials) return false;
    for (size_t i = 0; i < m->count; i++) {
        const mesh_part *part = &m->parts[i];
        int material = part->primitive->material;
        for (size_t f = 0; f < part->face_count; f++)
            m->materials[part->first_face + f] = material < 0 ? 0 : m->r->materials[material];
    }
    return true;
}

bool parts_read_faces(mesh_parts *m) {
    size_t triangles = 0;
    for (size_t i = 0; i < m->count; i++) triangles += triangle_count(&m->parts[i]);
    if (triangles > UINT32_MAX / 3)
        return report_error(m->r->report, KILN_CODE_LIMIT, &m->where, "split the mesh", "%zu triangles in one mesh",
                            triangles);
    m->corners = parts_array(m, triangles, 3 * sizeof *m->corners);
    if (!m->corners) return false;
    for (size_t i = 0; i < m->count; i++)
        if (!read_part(m, &m->parts[i])) return false;
    return set_materials(m);
}
