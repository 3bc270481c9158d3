#include "tests/importers/subdiv/obj.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct list { /* of 4-byte values */
    union { float f; uint32_t u; } *items;
    uint32_t count;
} list;

typedef struct obj {
    list positions, uvs, sizes, corners, uv_corners;
    list crease_vertices, crease_sharpness, corner_vertices, corner_sharpness, holes;
    kiln_subdivision rules;
} obj;

static void push(list *l, uint32_t value) {
    l->items = realloc(l->items, ((size_t)l->count + 1) * sizeof *l->items);
    assert_non_null(l->items);
    l->items[l->count++].u = value;
}
static void push_float(list *l, const char *word) {
    float value = strtof(word, NULL);
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    push(l, bits);
}

static char *word(void) { return strtok(NULL, " \t\r\n"); }

static void read_face(obj *o) {
    uint32_t size = 0;
    for (char *w; (w = word()) != NULL; size++) { /* "vertex/uv/normal" */
        push(&o->corners, (uint32_t)strtoul(w, &w, 10) - 1);
        if (*w == '/' && w[1] != '/') push(&o->uv_corners, (uint32_t)strtoul(w + 1, NULL, 10) - 1);
    }
    push(&o->sizes, size);
}

static void read_tag(obj *o) {
    char *name = word(), *counts = word();
    uint32_t integers = counts ? (uint32_t)strtoul(counts, NULL, 10) : 0;
    list values = {0};
    for (uint32_t i = 0; i < integers; i++) push(&values, (uint32_t)strtoul(word(), NULL, 10));
    if (!name) return;
    if (!strcmp(name, "crease")) {
        push(&o->crease_vertices, values.items[0].u);
        push(&o->crease_vertices, values.items[1].u);
        push_float(&o->crease_sharpness, word());
    } else if (!strcmp(name, "corner")) {
        push(&o->corner_vertices, values.items[0].u);
        push_float(&o->corner_sharpness, word());
    } else if (!strcmp(name, "hole")) {
        for (uint32_t i = 0; i < integers; i++) push(&o->holes, values.items[i].u);
    } else if (!strcmp(name, "interpolateboundary")) { /* 0 none, 1 edge and corner, 2 edge only */
        static const kiln_boundary boundaries[4] = {KILN_BOUNDARY_NONE, KILN_BOUNDARY_EDGE_AND_CORNER,
                                                    KILN_BOUNDARY_EDGE_ONLY, KILN_BOUNDARY_NONE};
        o->rules.boundary = boundaries[values.items[0].u & 3];
    } else if (!strcmp(name, "facevaryinginterpolateboundary")) { /* 0 all, 1 corners, 2 none, 3 boundaries */
        static const kiln_fvar_boundary rules[4] = {KILN_FVAR_ALL, KILN_FVAR_CORNERS_PLUS1, KILN_FVAR_NONE,
                                                    KILN_FVAR_BOUNDARIES};
        o->rules.fvar_boundary = rules[values.items[0].u & 3];
    } else if (!strcmp(name, "smoothtriangles")) {
        o->rules.smooth_triangles = true;
    } else if (!strcmp(name, "creasemethod")) {
        char *method = word();
        o->rules.chaikin_creases = method && !strcmp(method, "chaikin");
    }
    free(values.items);
}

static void read_line(obj *o, char *line) {
    char *key = strtok(line, " \t\r\n");
    if (!key) return;
    if (!strcmp(key, "v"))
        for (int k = 0; k < 3; k++) push_float(&o->positions, word());
    else if (!strcmp(key, "vt"))
        for (int k = 0; k < 2; k++) push_float(&o->uvs, word());
    else if (!strcmp(key, "f")) read_face(o);
    else if (!strcmp(key, "t")) read_tag(o);
}

static void *take(shape *s, list *l) {
    void *copy = arena_copy(&s->arena, l->items, l->count, sizeof *l->items);
    assert_non_null(copy);
    free(l->items);
    return copy;
}

static kiln_scheme scheme_of(const char *path) {
    const char *name = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    if (!strncmp(name, "loop", 4)) return KILN_SCHEME_LOOP;
    return !strncmp(name, "bilinear", 8) ? KILN_SCHEME_BILINEAR : KILN_SCHEME_CATMULL_CLARK;
}

bool obj_read(const char *path, shape *s) {
    FILE *file = fopen(path, "re");
    if (!file) return false;
    obj o = {0};
    char line[4096];
    while (fgets(line, sizeof line, file)) read_line(&o, line);
    fclose(file);
    *s = (shape){0};
    kiln_subdivision rules = o.rules;
    rules.scheme = scheme_of(path);
    rules.crease_count = o.crease_sharpness.count;
    rules.corner_count = o.corner_sharpness.count;
    rules.hole_count = o.holes.count;
    rules.crease_vertices = take(s, &o.crease_vertices);
    rules.crease_sharpness = take(s, &o.crease_sharpness);
    rules.corner_vertices = take(s, &o.corner_vertices);
    rules.corner_sharpness = take(s, &o.corner_sharpness);
    rules.holes = take(s, &o.holes);
    bool textured = o.uvs.count && o.uv_corners.count == o.corners.count;
    s->primvars[0] = (kiln_primvar){KILN_PRIMVAR_UV, 0, KILN_FACE_VARYING, NULL, o.uvs.count / 2, NULL};
    s->desc = (kiln_mesh_desc){.vertex_count = o.positions.count / 3, .face_count = o.sizes.count, .subdivision = rules,
                               .primvars = s->primvars, .primvar_count = textured};
    s->desc.positions = take(s, &o.positions);
    s->desc.face_sizes = take(s, &o.sizes);
    s->desc.face_vertices = take(s, &o.corners);
    s->primvars[0].values = take(s, &o.uvs);
    s->primvars[0].indices = take(s, &o.uv_corners);
    s->desc.name = arena_string(&s->arena, strrchr(path, '/') ? strrchr(path, '/') + 1 : path);
    return true;
}
