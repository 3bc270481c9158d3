#include <stdlib.h>
#include <string.h>

#include "importers/gltf/parts.h"

/* New numbers of the vertices, in the old order; UINT32_MAX: not used. Returns how many are left. */
static size_t number(const mesh_parts *m, uint32_t *numbers) {
    memset(numbers, 0xFF, m->vertex_count * sizeof *numbers);
    for (size_t c = 0; c < 3 * m->face_count; c++) numbers[m->corners[c]] = 0;
    size_t count = 0;
    for (size_t v = 0; v < m->vertex_count; v++)
        if (numbers[v] == 0) numbers[v] = (uint32_t)count++;
    return count;
}

static void move_values(const mesh_parts *m, const uint32_t *numbers, float *values, uint32_t width) {
    for (size_t v = 0; v < m->vertex_count; v++)
        if (numbers[v] < v) memcpy(values + width * (size_t)numbers[v], values + width * v, width * sizeof *values);
}

bool parts_compact(mesh_parts *m, uint32_t *vertices, size_t count) {
    uint32_t *numbers = array_alloc(m->vertex_count, sizeof *numbers);
    if (!numbers) return report_no_memory(m->r->report, "reading a mesh");
    size_t left = number(m, numbers);
    if (left < m->vertex_count) {
        move_values(m, numbers, m->positions, 3);
        for (uint32_t i = 0; i < m->primvar_count; i++) {
            move_values(m, numbers, (float *)m->primvars[i].values, primvar_width(m->primvars[i].kind));
            m->primvars[i].value_count = (uint32_t)left;
        }
        for (size_t c = 0; c < 3 * m->face_count; c++) m->corners[c] = numbers[m->corners[c]];
        for (size_t i = 0; i < count; i++)
            vertices[i] = vertices[i] < m->vertex_count ? numbers[vertices[i]] : UINT32_MAX;
        m->vertex_count = left;
    }
    free(numbers);
    return true;
}
