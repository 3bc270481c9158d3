#include <math.h>
#include <stdio.h>
#include <string.h>

#include "importers/gltf/parts.h"
#include "scene/material.h"

static const char repair[] = "repair the mesh in the tool that wrote it";

static bool check_shape(const mesh_parts *m, const mesh_part *part, int accessor, uint32_t low, uint32_t high,
                        const kiln_where *where) {
    const gltf_accessor *a = &m->r->document.accessors[accessor];
    if (a->columns != 1 || a->rows < low || a->rows > high)
        return report_error(m->r->report, KILN_CODE_RANGE, where, repair, "accessor %d must hold vectors of %u%s numbers",
                            accessor, low, low < high ? " or more" : "");
    return a->count == part->vertex_count ||
           report_error(m->r->report, KILN_CODE_RANGE, where, repair, "%zu values for %zu vertices", a->count,
                        part->vertex_count);
}

/* Integers that nobody marked as normalised cannot be meant as colours of up to 65,535. */
static void normalize_colors(const mesh_parts *m, const mesh_part *part, int accessor, float *out,
                             const kiln_where *where) {
    const gltf_accessor *a = &m->r->document.accessors[accessor];
    if (a->normalized || a->component_type == GLTF_FLOAT) return;
    float largest = a->component_type == GLTF_UNSIGNED_SHORT  ? 65535
                    : a->component_type == GLTF_UNSIGNED_BYTE ? 255
                                                              : 1;
    report_warning(m->r->report, KILN_CODE_RANGE, where, NULL,
                   "integer colours that are not normalized: they are read as if they were");
    for (size_t i = 0; i < part->vertex_count; i++)
        for (uint32_t k = 0; k < a->rows; k++) out[4 * i + k] /= largest;
}

/* An attribute as the file calls it, and as the scene does. */
typedef struct stream {
    const char *name;
    kiln_primvar_kind kind;
    uint32_t set, width, least; /* components: of the primvar, at least in the file */
    float fill;                 /* for parts that do not have it, and components that are not in the file */
} stream;

static bool read_stream_of(mesh_parts *m, const mesh_part *part, const stream *s, float *values) {
    int accessor = part_attribute(part, s->name);
    if (part->shared || accessor < 0) return true;
    kiln_where primitive = where_item(&m->where, "primitives", part->index),
               attributes = where_key(&primitive, "attributes"), where = where_key(&attributes, s->name);
    float *out = values + part->first_vertex * s->width;
    if (!check_shape(m, part, accessor, s->least, s->width, &where) ||
        !accessor_floats(m->r, accessor, s->width, out, &where))
        return false;
    if (s->kind == KILN_PRIMVAR_COLOR) normalize_colors(m, part, accessor, out, &where);
    return true;
}

/* The values of all parts, one per vertex of the mesh; NULL: an error was added. */
static float *read_values(mesh_parts *m, const stream *s) {
    float *values = parts_array(m, m->vertex_count, s->width * sizeof *values);
    if (!values) return NULL;
    for (size_t i = 0; s->fill != 0 && i < m->vertex_count * s->width; i++) values[i] = s->fill;
    for (size_t i = 0; i < m->count; i++)
        if (!read_stream_of(m, &m->parts[i], s, values)) return NULL;
    return values;
}

static bool add_stream(mesh_parts *m, const stream *s) {
    float *values = read_values(m, s);
    if (!values) return false;
    m->primvars[m->primvar_count++] = (kiln_primvar){.kind = s->kind, .set = s->set, .interpolation = KILN_VERTEX,
                                                     .values = values, .value_count = (uint32_t)m->vertex_count};
    return true;
}

static size_t parts_with(const mesh_parts *m, const char *name) {
    size_t count = 0;
    for (size_t i = 0; i < m->count; i++) count += part_attribute(&m->parts[i], name) >= 0;
    return count;
}

static bool needs_tangents(const mesh_parts *m, const mesh_part *part) {
    int material = part->primitive->material;
    uint32_t uv_set;
    return material >= 0 && material_tangents(scene_material(m->r->scene, m->r->materials[material]), &uv_set);
}

/* Tangents are kept when no part that needs them would be left without; else they are computed for all. */
static bool keep_tangents(const mesh_parts *m) {
    bool any = false;
    for (size_t i = 0; i < m->count; i++) {
        const mesh_part *part = &m->parts[i];
        bool both = part_attribute(part, "TANGENT") >= 0 && part_attribute(part, "NORMAL") >= 0;
        if (needs_tangents(m, part) && !both) return false;
        any |= both;
    }
    return any;
}

/* The sets that materials of the mesh read, and the first one. */
static uint32_t wanted_uv_sets(const mesh_parts *m) {
    uint32_t sets = 1;
    for (size_t i = 0; i < m->count; i++) {
        int material = m->parts[i].primitive->material;
        if (material < 0) continue;
        const kiln_texture *textures[KILN_MATERIAL_TEXTURES];
        uint32_t count = material_textures(scene_material(m->r->scene, m->r->materials[material]), textures);
        for (uint32_t t = 0; t < count; t++) sets |= 1u << textures[t]->uv_set;
    }
    return sets;
}

static bool add_uv_sets(mesh_parts *m) {
    uint32_t sets = wanted_uv_sets(m);
    for (uint32_t set = 0; set < PARTS_UV_SETS; set++) {
        char name[16];
        snprintf(name, sizeof name, "TEXCOORD_%u", set);
        stream s = {name, KILN_PRIMVAR_UV, set, 2, 2, 0};
        if (sets >> set & 1 && parts_with(m, name) && !add_stream(m, &s)) return false;
    }
    return true;
}

/* Of vertices that faces use. The scene would refuse them too, and does not know the accessor. */
static bool check_positions(const mesh_parts *m, const mesh_part *part) {
    kiln_where primitive = where_item(&m->where, "primitives", part->index),
               attributes = where_key(&primitive, "attributes"), where = where_key(&attributes, "POSITION");
    const uint32_t *corners = m->corners + 3 * part->first_face;
    for (size_t c = 0; c < 3 * part->face_count; c++) {
        const float *p = m->positions + 3 * (size_t)corners[c];
        if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]))
            return report_error(m->r->report, KILN_CODE_GEOMETRY, &where, repair,
                                "vertex %zu has a position that is not finite", corners[c] - part->first_vertex);
    }
    return true;
}

static bool read_positions(mesh_parts *m) {
    static const stream position = {"POSITION", KILN_PRIMVAR_NORMAL, 0, 3, 3, 0};
    m->positions = read_values(m, &position);
    for (size_t i = 0; m->positions && i < m->count; i++)
        if (!check_positions(m, &m->parts[i])) return false;
    return m->positions != NULL;
}

bool parts_read_primvars(mesh_parts *m) {
    static const stream normal = {"NORMAL", KILN_PRIMVAR_NORMAL, 0, 3, 3, 0},
                        tangent = {"TANGENT", KILN_PRIMVAR_TANGENT, 0, 4, 4, 0},
                        color = {"COLOR_0", KILN_PRIMVAR_COLOR, 0, 4, 3, 1};
    return read_positions(m) && (!parts_with(m, "NORMAL") || add_stream(m, &normal)) &&
           (!keep_tangents(m) || add_stream(m, &tangent)) && add_uv_sets(m) &&
           (!parts_with(m, "COLOR_0") || add_stream(m, &color));
}
