#include "scene/triangulate.h"

#include <stdlib.h>

#include "base/mat.h"

static dvec3 point(const kiln_mesh *m, uint32_t corner) {
    const float *p = m->positions + 3 * (size_t)m->face_vertices[corner];
    return (dvec3){p[0], p[1], p[2]};
}

/* Twice the vector area of a triangle. */
static dvec3 area(dvec3 a, dvec3 b, dvec3 c) { return d3_cross(d3_sub(b, a), d3_sub(c, a)); }

/* The sine of the sum of the angles at b and d: not negative exactly when a–c is the Delaunay diagonal (the sum of
 * the angles opposite to it is at most π). */
static double delaunay(dvec3 a, dvec3 b, dvec3 c, dvec3 d) {
    dvec3 ba = d3_sub(a, b), bc = d3_sub(c, b), da = d3_sub(a, d), dc = d3_sub(c, d);
    double cos_b = d3_dot(ba, bc), cos_d = d3_dot(da, dc);
    double sin_b = d3_length(d3_cross(ba, bc)), sin_d = d3_length(d3_cross(da, dc));
    double scale = d3_length(ba) * d3_length(bc) * d3_length(da) * d3_length(dc);
    return scale > 0 ? (sin_b * cos_d + cos_b * sin_d) / scale : 0;
}

/* True: split along 1–3 instead of 0–2. A diagonal that turns one of its triangles over (the quad is concave there)
 * is not taken when the other does not; of two possible ones the Delaunay diagonal has the better smallest angle. */
static bool split_13(const dvec3 p[4]) {
    dvec3 normal = d3_cross(d3_sub(p[2], p[0]), d3_sub(p[3], p[1])); /* twice the quad's vector area */
    bool fits_02 = d3_dot(area(p[0], p[1], p[2]), normal) > 0 && d3_dot(area(p[0], p[2], p[3]), normal) > 0;
    bool fits_13 = d3_dot(area(p[0], p[1], p[3]), normal) > 0 && d3_dot(area(p[1], p[2], p[3]), normal) > 0;
    if (fits_02 != fits_13) return fits_13;
    /* Rectangles are ties but for rounding of float positions: one choice for the whole grid. */
    const double tie = 1e-5;
    return delaunay(p[0], p[1], p[2], p[3]) < -tie;
}

static void split_quad(const kiln_mesh *m, uint32_t first, uint32_t *corners) {
    dvec3 p[4];
    for (uint32_t k = 0; k < 4; k++) p[k] = point(m, first + k);
    static const uint32_t split[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 1, 3, 1, 2, 3}};
    const uint32_t *order = split[split_13(p)];
    for (int k = 0; k < 6; k++) corners[k] = first + order[k];
}

typedef struct point2 { double x, y; } point2;

/* A polygon while its ears are cut: a ring of the corners that are left. */
typedef struct ring {
    point2 *points;
    uint32_t *next, *previous;
    bool *reflex; /* the polygon does not turn left here */
    uint32_t count, left, reflex_left;
    uint64_t budget; /* steps that may still be made, in the whole mesh */
} ring;

static double turn(point2 a, point2 b, point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

static double turn_at(const ring *r, uint32_t i) {
    return turn(r->points[r->previous[i]], r->points[i], r->points[r->next[i]]);
}

static void classify(ring *r, uint32_t i) {
    bool reflex = turn_at(r, i) <= 0;
    r->reflex_left = r->reflex_left + reflex - r->reflex[i];
    r->reflex[i] = reflex;
}

/* Counts one step of work; false when too much was done. */
static bool spend(ring *r) { return r->budget && r->budget--; }

/* The triangle at i lies inside the polygon: it turns left and holds no reflex corner. A corner that coincides with
 * one of the triangle's does not count: bridges to holes pass the same point twice. */
static bool is_ear(ring *r, uint32_t i) {
    if (r->reflex[i]) return false;
    uint32_t before = r->previous[i], after = r->next[i];
    point2 a = r->points[before], b = r->points[i], c = r->points[after];
    for (uint32_t j = r->next[after]; j != before && r->reflex_left; j = r->next[j]) {
        if (!spend(r)) return true;
        if (!r->reflex[j]) continue;
        point2 p = r->points[j];
        bool same = (p.x == a.x && p.y == a.y) || (p.x == b.x && p.y == b.y) || (p.x == c.x && p.y == c.y);
        if (!same && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
}

static void cut(ring *r, uint32_t i) {
    uint32_t before = r->previous[i], after = r->next[i];
    r->next[before] = after;
    r->previous[after] = before;
    r->reflex_left -= r->reflex[i];
    r->left--;
    classify(r, before);
    classify(r, after);
}

/* The corner to cut next, at i or behind it: an ear (Meisters 1975). A polygon that touches or crosses itself, or has
 * no area, may run out of ears; then, of the corners that do not turn left, the one that turns right the least: where
 * the polygon runs back along itself, nothing is lost. */
static uint32_t choose(ring *r, uint32_t i) {
    uint32_t best = i;
    double best_turn = -INFINITY;
    for (uint32_t tried = 0; tried < r->left && spend(r); tried++, i = r->next[i]) {
        if (is_ear(r, i)) return i;
        double t = r->reflex[i] ? turn_at(r, i) : -INFINITY;
        if (t > best_turn) best_turn = t, best = i;
    }
    return best;
}

static void clip_ears(ring *r, uint32_t first, uint32_t *corners) {
    for (uint32_t i = 0;;) {
        i = r->left > 3 ? choose(r, i) : i;
        *corners++ = first + r->previous[i];
        *corners++ = first + i;
        *corners++ = first + r->next[i];
        if (r->left == 3) return;
        cut(r, i);
        i = r->next[r->next[i]]; /* skip one: strips and fans both give slivers */
    }
}

/* Into the plane across the vector area (Newell's normal), where the polygon winds counter-clockwise. */
static void project(const kiln_mesh *m, uint32_t first, ring *r) {
    dvec3 origin = point(m, first), normal = {0, 0, 0};
    for (uint32_t k = 1; k + 1 < r->count; k++)
        normal = d3_add(normal, area(origin, point(m, first + k), point(m, first + k + 1)));
    normal = d3_normalize(normal);
    dvec3 side = fabs(normal.x) < 0.6 ? (dvec3){1, 0, 0} : (dvec3){0, 1, 0};
    dvec3 u = d3_normalize(d3_cross(side, normal)), v = d3_cross(normal, u);
    for (uint32_t k = 0; k < r->count; k++) {
        dvec3 p = d3_sub(point(m, first + k), origin);
        r->points[k] = (point2){d3_dot(p, u), d3_dot(p, v)};
        r->next[k] = k + 1 < r->count ? k + 1 : 0;
        r->previous[k] = k ? k - 1 : r->count - 1;
        r->reflex[k] = false;
    }
    r->reflex_left = 0;
    for (uint32_t k = 0; k < r->count; k++) classify(r, k);
}

static void split_polygon(const kiln_mesh *m, uint32_t first, uint32_t size, ring *r, uint32_t *corners) {
    r->count = r->left = size;
    project(m, first, r);
    clip_ears(r, first, corners);
}

static uint32_t largest_face(const kiln_mesh *m) {
    uint32_t largest = 0;
    for (uint32_t f = 0; f < m->face_count; f++)
        if (mesh_face_size(m, f) > largest) largest = mesh_face_size(m, f);
    return largest;
}

static void split_face(const kiln_mesh *m, uint32_t f, ring *r, uint32_t *corners) {
    uint32_t first = mesh_face_first(m, f), size = mesh_face_size(m, f);
    if (size > 4) split_polygon(m, first, size, r, corners);
    else if (size == 4) split_quad(m, first, corners);
    else
        for (uint32_t k = 0; k < 3; k++) corners[k] = first + k;
}

bool mesh_triangulate(const kiln_mesh *m, uint32_t *corners, uint32_t *faces) {
    uint32_t largest = largest_face(m);
    size_t room = largest > 4 ? largest : 1;
    /* A fraction of a second: n² steps cut any polygon of 5,000 corners. What is left of a larger hostile one is cut
     * as it comes. */
    ring r = {.budget = (uint64_t)1 << 25,
              .points = array_alloc(room, sizeof *r.points),
              .next = array_alloc(room, sizeof *r.next),
              .previous = array_alloc(room, sizeof *r.previous),
              .reflex = array_alloc(room, sizeof *r.reflex)};
    bool ok = r.points && r.next && r.previous && r.reflex;
    for (uint32_t f = 0, t = 0; ok && f < m->face_count; f++) {
        uint32_t count = mesh_face_size(m, f) - 2;
        split_face(m, f, &r, corners + 3 * (size_t)t);
        for (uint32_t k = 0; faces && k < count; k++) faces[t + k] = f;
        t += count;
    }
    free(r.points);
    free(r.next);
    free(r.previous);
    free(r.reflex);
    return ok;
}
