#include <string.h>

#include "importers/gltf/parts.h"
#include "importers/gltf/value.h"

/* extras of a mesh, or of a node for the mesh that it places, ask for a limit surface:
 *
 *   "extras": {"subdivision": {"scheme": "catmull-clark", "level": 2,
 *                              "creases": [[0, 1, 10], [1, 2, 2.5]], "corners": [[7, 10]]}}
 *
 * scheme: catmull-clark, loop, bilinear, none, or auto (default: as the mesh looks). level: 1 to 6, or 0 to fit the
 * picture (default). creases: two vertices and a sharpness; corners: a vertex and a sharpness; 10 is infinitely
 * sharp. Vertices are numbered as in the attributes, those of a second primitive behind those of the first.
 * "subdivision": "loop" and "subdivision": 2 are short for scheme and level. */

enum { LEVEL_MAX = 6 };

static const struct { const char *name; kiln_scheme scheme; } schemes[] = {
    {"catmull-clark", KILN_SCHEME_CATMULL_CLARK}, {"loop", KILN_SCHEME_LOOP},  {"bilinear", KILN_SCHEME_BILINEAR},
    {"none", KILN_SCHEME_NONE},                   {"auto", KILN_SCHEME_AUTO},
};

static bool read_scheme(const gltf_value *v, kiln_scheme *scheme) {
    for (size_t i = 0; v->kind == GLTF_STRING && i < sizeof schemes / sizeof *schemes; i++)
        if (strcmp(v->string, schemes[i].name) == 0) {
            *scheme = schemes[i].scheme;
            return true;
        }
    return false;
}

static bool read_level(const gltf_value *v, int32_t *level) {
    if (v->kind != GLTF_NUMBER || !(v->number >= 0 && v->number <= LEVEL_MAX)) return false;
    *level = (int32_t)v->number;
    return v->number == (double)*level;
}

/* Rows of `vertices` vertices and a sharpness, from both lists behind one another. */
static bool read_tags(const gltf_value *list, size_t vertices, uint32_t *out, float *sharpness) {
    for (size_t i = 0; i < list->count; i++) {
        const gltf_value *row = &list->items[i];
        if (row->kind != GLTF_ARRAY || row->count != vertices + 1) return false;
        for (size_t k = 0; k <= vertices; k++)
            if (row->items[k].kind != GLTF_NUMBER) return false;
        for (size_t k = 0; k < vertices; k++) {
            double vertex = row->items[k].number;
            if (!(vertex >= 0 && vertex < UINT32_MAX)) return false;
            out[vertices * i + k] = (uint32_t)vertex;
        }
        sharpness[i] = (float)row->items[vertices].number;
    }
    return true;
}

static size_t list_count(const gltf_value *list) { return list && list->kind == GLTF_ARRAY ? list->count : 0; }

static bool read_object(mesh_parts *m, const gltf_value *object, bool *understood, uint32_t **tags, size_t *tag_count) {
    kiln_subdivision *s = &m->subdivision;
    const gltf_value *scheme = value_member(object, "scheme"), *level = value_member(object, "level"),
                     *creases = value_member(object, "creases"), *corners = value_member(object, "corners");
    size_t crease_count = list_count(creases), corner_count = list_count(corners);
    *understood = (!scheme || read_scheme(scheme, &s->scheme)) && (!level || read_level(level, &s->level)) &&
                  crease_count < UINT32_MAX / 2 && corner_count < UINT32_MAX / 2;
    if (!*understood) return true;
    *tag_count = 2 * crease_count + corner_count;
    *tags = parts_array(m, *tag_count, sizeof **tags);
    float *sharpness = *tags ? parts_array(m, crease_count + corner_count, sizeof *sharpness) : NULL;
    if (!sharpness) return false;
    *understood = (!crease_count || read_tags(creases, 2, *tags, sharpness)) &&
                  (!corner_count || read_tags(corners, 1, *tags + 2 * crease_count, sharpness + crease_count));
    s->crease_vertices = *tags;
    s->crease_sharpness = sharpness;
    s->crease_count = (uint32_t)crease_count;
    s->corner_vertices = *tags + 2 * crease_count;
    s->corner_sharpness = sharpness + crease_count;
    s->corner_count = (uint32_t)corner_count;
    return true;
}

bool parts_read_subdivision(mesh_parts *m, const gltf_value *extras, uint32_t **tags, size_t *tag_count,
                            const kiln_where *owner) {
    m->subdivision = (kiln_subdivision){.scheme = KILN_SCHEME_AUTO};
    *tags = NULL;
    *tag_count = 0;
    const gltf_value *v = value_member(extras, "subdivision");
    if (!v) return true;
    bool understood = read_scheme(v, &m->subdivision.scheme) || read_level(v, &m->subdivision.level);
    if (v->kind == GLTF_OBJECT && !read_object(m, v, &understood, tags, tag_count)) return false;
    if (understood) return true;
    kiln_where list = where_key(owner, "extras"), where = where_key(&list, "subdivision");
    report_warning(m->r->report, KILN_CODE_IGNORED, &where, "see the user guide for the form that kiln reads",
                   "the wish for subdivision is not understood: it is left out");
    m->subdivision = (kiln_subdivision){.scheme = KILN_SCHEME_AUTO};
    *tag_count = 0;
    return true;
}
