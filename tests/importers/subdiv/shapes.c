#include "tests/importers/subdiv/shapes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "importers/mesh/topology.h"
#include "importers/subdiv/edges.h"

void shape_free(shape *s) {
    arena_free(&s->arena);
    *s = (shape){0};
}

static void *keep(shape *s, const void *data, size_t count, size_t size) {
    void *p = data ? arena_copy(&s->arena, data, count, size) : arena_array(&s->arena, count, size);
    assert_non_null(p);
    return p;
}

/* Adds a primvar whose values are the shape's already. */
static void add_primvar(shape *s, kiln_primvar_kind kind, kiln_interpolation interpolation, const float *values,
                        uint32_t count) {
    s->primvars[s->desc.primvar_count++] = (kiln_primvar){kind, 0, interpolation, values, count, NULL};
    s->desc.primvars = s->primvars;
}

void shape_cube(shape *s) {
    static const float positions[24] = {-1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1, -1, 1, -1, 1, 1, -1, -1, -1, -1, 1,
                                        -1, -1};
    static const uint32_t sizes[6] = {4, 4, 4, 4, 4, 4};
    static const uint32_t corners[24] = {0, 1, 3, 2, 2, 3, 5, 4, 4, 5, 7, 6, 6, 7, 1, 0, 1, 7, 5, 3, 6, 0, 2, 4};
    *s = (shape){.desc = {.name = "cube", .vertex_count = 8, .positions = positions, .face_count = 6,
                          .face_sizes = sizes, .face_vertices = corners, .subdivision.scheme = KILN_SCHEME_CATMULL_CLARK}};
}

/* A point of a cube's surface, by its place on a lattice of n steps, blown up to the unit sphere. */
static void sphere_point(const uint32_t lattice[3], uint32_t n, double p[3]) {
    double length = 0;
    for (int k = 0; k < 3; k++) {
        p[k] = tan((2.0 * lattice[k] / n - 1) * 0.78539816339744831); /* equal angles */
        length += p[k] * p[k];
    }
    for (int k = 0; k < 3; k++) p[k] /= sqrt(length);
}

void shape_quad_sphere(shape *s, uint32_t n, float radius) {
    *s = (shape){0};
    uint32_t rows = n + 1, faces = 6 * n * n, vertices = 0;
    uint32_t *numbers = keep(s, NULL, (size_t)rows * rows * rows, sizeof *numbers);
    float *positions = keep(s, NULL, (size_t)faces + 2, 3 * sizeof *positions);
    float *normals = keep(s, NULL, (size_t)faces + 2, 3 * sizeof *normals);
    float *uvs = keep(s, NULL, 4 * (size_t)faces, 2 * sizeof *uvs);
    uint32_t *sizes = keep(s, NULL, faces, sizeof *sizes), *corners = keep(s, NULL, 4 * (size_t)faces, sizeof *corners);
    for (uint32_t c = 0; c < 4 * faces; c++) {
        uint32_t f = c / 4, k = c % 4, side = f / (n * n), axis = side % 3, lattice[3];
        uint32_t u = f % n + (k == 1 || k == 2), v = f % (n * n) / n + (k >= 2);
        lattice[axis] = side < 3 ? n : 0;
        lattice[(axis + 1) % 3] = side < 3 ? u : v; /* the far sides are seen from behind */
        lattice[(axis + 2) % 3] = side < 3 ? v : u;
        uint32_t *number = &numbers[(lattice[0] * rows + lattice[1]) * rows + lattice[2]];
        if (!*number) {
            double p[3];
            sphere_point(lattice, n, p);
            for (uint32_t i = 0; i < 3; i++) {
                normals[3 * vertices + i] = (float)p[i];
                positions[3 * vertices + i] = (float)(radius * p[i]);
            }
            *number = ++vertices;
        }
        sizes[f] = 4;
        corners[c] = *number - 1;
        uvs[2 * c] = ((float)u / (float)n + (float)axis) / 3;
        uvs[2 * c + 1] = ((float)v / (float)n + (float)(side / 3)) / 2;
    }
    s->desc = (kiln_mesh_desc){.name = "sphere", .vertex_count = vertices, .positions = positions, .face_count = faces,
                               .face_sizes = sizes, .face_vertices = corners,
                               .subdivision.scheme = KILN_SCHEME_CATMULL_CLARK};
    add_primvar(s, KILN_PRIMVAR_NORMAL, KILN_VERTEX, normals, vertices);
    add_primvar(s, KILN_PRIMVAR_UV, KILN_FACE_VARYING, uvs, 4 * faces);
}

typedef struct unit3 { double x[3]; } unit3;

static unit3 between(unit3 a, unit3 b) {
    double length = 0;
    unit3 m;
    for (int c = 0; c < 3; c++) m.x[c] = a.x[c] + b.x[c], length += m.x[c] * m.x[c];
    for (int c = 0; c < 3; c++) m.x[c] /= sqrt(length);
    return m;
}

/* Quarters every triangle of a soup on the unit sphere. */
static unit3 *quarter(unit3 *soup, uint32_t triangles) {
    unit3 *out = malloc(12 * (size_t)triangles * sizeof *out);
    assert_non_null(out);
    for (uint32_t t = 0; t < triangles; t++) {
        unit3 a = soup[3 * t], b = soup[3 * t + 1], c = soup[3 * t + 2];
        unit3 ab = between(a, b), bc = between(b, c), ca = between(c, a);
        const unit3 order[12] = {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca};
        memcpy(out + 12 * (size_t)t, order, sizeof order);
    }
    free(soup);
    return out;
}

void shape_icosphere(shape *s, uint32_t n) {
    static const int faces[60] = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6,
                                  7, 1, 8, 3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6,
                                  7, 9, 8, 1};
    const double t = 1.6180339887498949;
    const double points[12][3] = {{-1, t, 0}, {1, t, 0}, {-1, -t, 0}, {1, -t, 0}, {0, -1, t}, {0, 1, t},
                                  {0, -1, -t}, {0, 1, -t}, {t, 0, -1}, {t, 0, 1}, {-t, 0, -1}, {-t, 0, 1}};
    *s = (shape){0};
    uint32_t triangles = 20, vertices = 0;
    unit3 *soup = malloc(60 * sizeof *soup);
    assert_non_null(soup);
    for (int i = 0; i < 180; i++) soup[i / 3].x[i % 3] = points[faces[i / 3]][i % 3] / sqrt(1 + t * t);
    for (uint32_t i = 0; i < n; i++, triangles *= 4) soup = quarter(soup, triangles);
    float *all = keep(s, NULL, 3 * (size_t)triangles, 3 * sizeof *all);
    for (uint32_t i = 0; i < 9 * triangles; i++) all[i] = (float)soup[i / 3].x[i % 3];
    free(soup);
    uint32_t *corners = keep(s, NULL, 3 * (size_t)triangles, sizeof *corners);
    corner_stream stream = {all, 3};
    assert_true(topology_weld(&stream, 1, 3 * triangles, corners, &vertices));
    float *positions = keep(s, NULL, vertices, 3 * sizeof *positions);
    for (uint32_t c = 0; c < 3 * triangles; c++)
        memcpy(positions + 3 * (size_t)corners[c], all + 3 * (size_t)c, 3 * sizeof *all);
    s->desc = (kiln_mesh_desc){.name = "icosphere", .vertex_count = vertices, .positions = positions,
                               .face_count = triangles,
                               .face_vertices = corners, .subdivision.scheme = KILN_SCHEME_LOOP};
    add_primvar(s, KILN_PRIMVAR_NORMAL, KILN_VERTEX, positions, vertices);
}

void shape_strip(shape *s, uint32_t n, uint32_t seam) {
    *s = (shape){0};
    float *positions = keep(s, NULL, 2 * (size_t)n + 2, 3 * sizeof *positions);
    float *uvs = keep(s, NULL, 4 * (size_t)n, 2 * sizeof *uvs);
    uint32_t *sizes = keep(s, NULL, n, sizeof *sizes), *corners = keep(s, NULL, 4 * (size_t)n, sizeof *corners);
    for (uint32_t i = 0; i < 2 * (n + 1); i++) positions[3 * i] = (float)(i / 2), positions[3 * i + 1] = (float)(i % 2);
    for (uint32_t f = 0; f < n; f++) {
        const uint32_t face[4] = {2 * f, 2 * f + 2, 2 * f + 3, 2 * f + 1};
        sizes[f] = 4;
        for (uint32_t k = 0; k < 4; k++) {
            corners[4 * f + k] = face[k];
            uvs[8 * f + 2 * k] = (float)(face[k] / 2) / (float)n + (f > seam ? 10.0f : 0.0f);
            uvs[8 * f + 2 * k + 1] = (float)(face[k] % 2);
        }
    }
    s->desc = (kiln_mesh_desc){.name = "strip", .vertex_count = 2 * (n + 1), .positions = positions, .face_count = n,
                               .face_sizes = sizes, .face_vertices = corners,
                               .subdivision.scheme = KILN_SCHEME_CATMULL_CLARK};
    add_primvar(s, KILN_PRIMVAR_UV, KILN_FACE_VARYING, uvs, 4 * n);
}

void shape_cylinder(shape *s, uint32_t sides) {
    *s = (shape){0};
    uint32_t count = 6 * sides, corner = 0;
    float *positions = keep(s, NULL, 2 * (size_t)sides, 3 * sizeof *positions);
    float *normals = keep(s, NULL, count, 3 * sizeof *normals);
    uint32_t *sizes = keep(s, NULL, (size_t)sides + 2, sizeof *sizes), *corners = keep(s, NULL, count, sizeof *corners);
    for (uint32_t i = 0; i < 2 * sides; i++) {
        double angle = 6.283185307179586 * (i / 2) / sides;
        positions[3 * i] = (float)cos(angle);
        positions[3 * i + 1] = i % 2 ? 1.0f : -1.0f;
        positions[3 * i + 2] = (float)-sin(angle);
    }
    for (uint32_t f = 0; f < sides + 2; f++) {
        sizes[f] = f < sides ? 4 : sides;
        for (uint32_t k = 0; k < sizes[f]; k++, corner++) {
            uint32_t next = (f + 1) % sides;
            const uint32_t wall[4] = {2 * f, 2 * next, 2 * next + 1, 2 * f + 1};
            corners[corner] = f < sides ? wall[k % 4] : f == sides ? 2 * k + 1 : 2 * (sides - 1 - k);
            const float *p = positions + 3 * corners[corner];
            float *normal = normals + 3 * corner;
            if (f < sides) normal[0] = p[0], normal[2] = p[2];
            else normal[1] = p[1];
        }
    }
    s->desc = (kiln_mesh_desc){.name = "cylinder", .vertex_count = 2 * sides, .positions = positions,
                               .face_count = sides + 2, .face_sizes = sizes, .face_vertices = corners,
                               .subdivision.scheme = KILN_SCHEME_CATMULL_CLARK};
    add_primvar(s, KILN_PRIMVAR_NORMAL, KILN_FACE_VARYING, normals, count);
}

static uint32_t size_of(const kiln_mesh_desc *d, uint32_t face) { return d->face_sizes ? d->face_sizes[face] : 3; }

/* The values of a primvar, or with NULL the positions, for every corner. */
static corner_stream by_corner(shape *keeper, const kiln_mesh_desc *d, const kiln_primvar *p, uint32_t count) {
    uint32_t width = p ? primvar_width(p->kind) : 3;
    float *values = keep(keeper, NULL, count, width * sizeof *values);
    for (uint32_t c = 0; c < count; c++) {
        uint32_t v = d->face_vertices[c];
        memcpy(values + (size_t)width * c, p ? primvar_at(p, 0, c, v) : d->positions + 3 * (size_t)v,
               width * sizeof *values);
    }
    return (corner_stream){values, width};
}

void shape_export(shape *result, const shape *source) {
    const kiln_mesh_desc *d = &source->desc;
    *result = (shape){0};
    uint32_t count = 0, triangles = 0, vertices = 0;
    for (uint32_t f = 0; f < d->face_count; f++) count += size_of(d, f);
    corner_stream streams[5];
    for (uint32_t i = 0; i <= d->primvar_count; i++)
        streams[i] = by_corner(result, d, i ? &d->primvars[i - 1] : NULL, count);
    uint32_t *ids = keep(result, NULL, count, sizeof *ids);
    uint32_t *corners = keep(result, NULL, 3 * (size_t)count, sizeof *corners);
    assert_true(topology_weld(streams, d->primvar_count + 1, count, ids, &vertices));
    for (uint32_t f = 0, first = 0; f < d->face_count; first += size_of(d, f++))
        for (uint32_t k = 1; k + 1 < size_of(d, f); k++, triangles++) {
            const uint32_t t[3] = {ids[first], ids[first + k], ids[first + k + 1]};
            memcpy(corners + 3 * (size_t)triangles, t, sizeof t);
        }
    result->desc = (kiln_mesh_desc){.name = d->name, .vertex_count = vertices, .face_count = triangles,
                                    .face_vertices = corners,
                                    .subdivision = {.scheme = KILN_SCHEME_AUTO, .triangulated = true}};
    for (uint32_t i = 0; i <= d->primvar_count; i++) {
        uint32_t width = streams[i].width;
        float *values = keep(result, NULL, vertices, width * sizeof *values);
        for (uint32_t c = 0; c < count; c++)
            memcpy(values + (size_t)width * ids[c], streams[i].values + (size_t)width * c, width * sizeof *values);
        if (i) add_primvar(result, d->primvars[i - 1].kind, KILN_VERTEX, values, vertices);
        else result->desc.positions = values;
    }
}

kiln_id shape_add(kiln_scene *scene, const shape *s, kiln_report *report) {
    kiln_id id = 0;
    assert_true(kiln_scene_add_mesh(scene, &s->desc, &id, report));
    return id;
}

edge_census shape_edges(const kiln_mesh *m) {
    kiln_arena arena = {0};
    uint32_t *points = ARENA_ARRAY(&arena, uint32_t, m->vertex_count);
    uint32_t *corners = ARENA_ARRAY(&arena, uint32_t, m->corner_count);
    uint32_t *sizes = ARENA_ARRAY(&arena, uint32_t, m->face_count);
    corner_stream stream = {m->positions, 3};
    polygons p = {.face_count = m->face_count, .corner_count = m->corner_count, .face_sizes = sizes,
                  .face_vertices = corners};
    assert_true(points && corners && sizes && topology_weld(&stream, 1, m->vertex_count, points, &p.vertex_count));
    for (uint32_t c = 0; c < m->corner_count; c++) corners[c] = points[m->face_vertices[c]];
    for (uint32_t f = 0; f < m->face_count; f++) sizes[f] = mesh_face_size(m, f);
    edge_table table;
    edge_census census = {0};
    assert_true(edges_build(&p, &arena, &table));
    census.edges = table.count;
    for (uint32_t e = 0; e < table.count; e++) census.open += table.edges[e].uses == 1;
    arena_free(&arena);
    return census;
}
