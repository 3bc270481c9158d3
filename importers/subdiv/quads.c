#include <stdlib.h>
#include <string.h>

#include "base/mat.h"
#include "importers/subdiv/faces.h"

/* Halves of a quad bend by no more than this: measured on exported models, 95 to 99 % of the pairs of a quad mesh
 * pass, and few of a triangle mesh. */
static const double COS_BEND = 0.766; /* 40° */

typedef struct pairing {
    const kiln_mesh *mesh;
    const vertex_weld *weld;
    const face_list *triangles;
    const edge_table *edges;
    const uint8_t *keep_edges;
} pairing;

static dvec3 position(const pairing *p, uint32_t point) {
    const float *x = p->mesh->positions + 3 * (size_t)p->weld->sources[point];
    return (dvec3){x[0], x[1], x[2]};
}

/* What a shader sees of the mesh is the same at both corners. Tangents are not asked: they are made per triangle. */
static bool same_values(const pairing *p, uint32_t corner_a, uint32_t corner_b) {
    const kiln_mesh *m = p->mesh;
    uint32_t vertex_a = m->face_vertices[corner_a], vertex_b = m->face_vertices[corner_b];
    if (vertex_a == vertex_b) return true;
    for (uint32_t i = 0; i < m->primvar_count; i++) {
        const kiln_primvar *v = &m->primvars[i];
        if (v->kind == KILN_PRIMVAR_TANGENT) continue;
        const float *a = primvar_at(v, corner_a / 3, corner_a, vertex_a);
        const float *b = primvar_at(v, corner_b / 3, corner_b, vertex_b);
        for (uint32_t k = 0; k < primvar_width(v->kind); k++)
            if (a[k] != b[k]) return false;
    }
    return true;
}

/* The corner of triangle t (in the list) at which an edge begins that t and t + 1 share and that may go; 3: none. */
static uint32_t diagonal(const pairing *p, uint32_t t) {
    const face_list *f = p->triangles;
    if (mesh_face_material(p->mesh, f->sources[t]) != mesh_face_material(p->mesh, f->sources[t + 1])) return 3;
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t here = 3 * t + i, e = p->edges->corner_edges[here];
        const polygon_edge *edge = &p->edges->edges[e];
        if (edge->corners[0] != here || edge->corners[1] / 3 != t + 1 || p->keep_edges[e] ||
            !edge_is_regular(edge, f->points))
            continue;
        uint32_t there = edge->corners[1];
        if (same_values(p, f->corners[here], f->corners[3 * (t + 1) + (there + 1) % 3]) &&
            same_values(p, f->corners[3 * t + (i + 1) % 3], f->corners[there]))
            return i;
    }
    return 3;
}

/* The quad's corners in the list, counter-clockwise from the lower end of the diagonal in t. */
static void quad_corners(const pairing *p, uint32_t t, uint32_t i, uint32_t corners[4]) {
    uint32_t there = p->edges->edges[p->edges->corner_edges[3 * t + i]].corners[1] % 3;
    corners[0] = 3 * t + (i + 1) % 3;
    corners[1] = 3 * t + (i + 2) % 3;
    corners[2] = 3 * t + i;
    corners[3] = 3 * (t + 1) + (there + 2) % 3;
}

/* How much triangles t and t + 1 look like a quad: 0 or less not at all, 1 a flat rectangle. */
static double likeness(const pairing *p, uint32_t t) {
    uint32_t i = diagonal(p, t), corners[4];
    if (i == 3) return 0;
    quad_corners(p, t, i, corners);
    dvec3 x[4], edge[4];
    for (int k = 0; k < 4; k++) x[k] = position(p, p->triangles->points[corners[k]]);
    for (int k = 0; k < 4; k++) edge[k] = d3_normalize(d3_sub(x[(k + 1) % 4], x[k]));
    dvec3 diagonal_edge = d3_sub(x[2], x[0]);
    dvec3 n0 = d3_normalize(d3_cross(edge[0], diagonal_edge)), n1 = d3_normalize(d3_cross(diagonal_edge, edge[2]));
    double cos_bend = d3_dot(n0, n1), least_sine = 1;
    if (!(cos_bend >= COS_BEND)) return 0;
    dvec3 normal = d3_normalize(d3_add(n0, n1));
    for (int k = 0; k < 4; k++) {
        double sine = d3_dot(d3_cross(edge[k], edge[(k + 1) % 4]), normal); /* not positive: straight, or concave */
        least_sine = sine < least_sine ? sine : least_sine;
    }
    return least_sine * cos_bend;
}

/* Of all ways to pair neighbours in the list the one with the greatest sum of likenesses: a lone triangle in a row
 * of quads does not shift the pairs behind it. paired[t]: t and t + 1 are one quad. */
static bool choose_pairs(const pairing *p, uint8_t *paired) {
    uint32_t count = p->triangles->face_count;
    double *best = array_alloc((size_t)count + 1, sizeof *best); /* of the first t triangles */
    if (!best) return false;
    for (uint32_t t = 2; t <= count; t++) {
        double like = likeness(p, t - 2);
        best[t] = best[t - 1];
        if (like > 0 && best[t - 2] + like > best[t]) {
            best[t] = best[t - 2] + like;
            paired[t - 2] = 1;
        }
    }
    for (uint32_t t = count; t >= 2;) { /* backwards: keep those that lie on the best way */
        if (paired[t - 2]) {
            if (t >= 3) paired[t - 3] = 0;
            t -= 2;
        } else {
            t--;
        }
    }
    free(best);
    return true;
}

static void emit(const pairing *p, const uint8_t *paired, face_list *quads) {
    const face_list *f = p->triangles;
    for (uint32_t t = 0; t < f->face_count; t++) {
        uint32_t size = paired[t] ? 4 : 3, corners[4] = {3 * t, 3 * t + 1, 3 * t + 2};
        if (paired[t]) quad_corners(p, t, diagonal(p, t), corners);
        for (uint32_t k = 0; k < size; k++) {
            quads->corners[quads->corner_count] = f->corners[corners[k]];
            quads->points[quads->corner_count++] = f->points[corners[k]];
        }
        quads->sizes[quads->face_count] = size;
        quads->sources[quads->face_count++] = f->sources[t];
        t += paired[t];
    }
}

bool faces_pair(const kiln_mesh *mesh, const vertex_weld *w, const face_list *triangles, const edge_table *edges,
                const uint8_t *keep_edges, kiln_arena *arena, face_list *quads, double *rate) {
    pairing p = {mesh, w, triangles, edges, keep_edges};
    uint8_t *paired = array_alloc((size_t)triangles->face_count + 1, 1);
    *quads = (face_list){.sizes = ARENA_ARRAY(arena, uint32_t, triangles->face_count),
                         .corners = ARENA_ARRAY(arena, uint32_t, triangles->corner_count),
                         .sources = ARENA_ARRAY(arena, uint32_t, triangles->face_count),
                         .points = ARENA_ARRAY(arena, uint32_t, triangles->corner_count)};
    bool ok = paired && quads->sizes && quads->corners && quads->sources && quads->points && choose_pairs(&p, paired);
    if (ok) {
        emit(&p, paired, quads);
        uint32_t joined = triangles->face_count - quads->face_count;
        *rate = triangles->face_count ? 2.0 * joined / triangles->face_count : 0;
    }
    free(paired);
    return ok;
}
