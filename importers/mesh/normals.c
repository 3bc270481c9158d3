#include "importers/mesh/normals.h"

#include <stdlib.h>

#include "base/arena.h"
#include "importers/mesh/topology.h"

/* The unit vector along v; false when v has no direction. */
static bool direction(dvec3 v, float unit[3]) {
    dvec3 n = d3_normalize(v);
    double length2 = d3_dot(n, n);
    if (!(length2 > 0.5 && length2 < 2)) return false;
    unit[0] = (float)n.x, unit[1] = (float)n.y, unit[2] = (float)n.z;
    return true;
}

static void point_up(float normal[3]) { normal[0] = 0, normal[1] = 1, normal[2] = 0; }

void normals_face(const float *positions, const uint32_t *vertices, uint32_t vertex_count, float normal[3]) {
    /* From the first vertex, so that a small face far from the origin keeps its digits. */
    dvec3 origin = corner_vector(positions, vertices[0]), sum = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < vertex_count; i++)
        sum = d3_add(sum, d3_cross(d3_sub(corner_vector(positions, vertices[i]), origin),
                                   d3_sub(corner_vector(positions, vertices[i + 1]), origin)));
    if (!direction(sum, normal)) point_up(normal);
}

typedef struct soup {
    const float *positions;
    uint32_t triangle_count, corner_count;
    dvec3 *areas;   /* per triangle: normal × twice the area; zero when it has no area */
    uint8_t *skip;  /* per triangle: 1: two corners coincide */
    uint32_t *ids, *twins, *groups; /* per corner */
    dvec3 *sums;    /* per group */
} soup;

static bool finite_vector(dvec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

static void measure(soup *s) {
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        uint32_t c = 3 * t;
        dvec3 p = corner_vector(s->positions, c);
        dvec3 area = d3_cross(d3_sub(corner_vector(s->positions, c + 1), p),
                              d3_sub(corner_vector(s->positions, c + 2), p));
        s->areas[t] = finite_vector(area) ? area : (dvec3){0, 0, 0};
        s->skip[t] = s->ids[c] == s->ids[c + 1] || s->ids[c + 1] == s->ids[c + 2] || s->ids[c + 2] == s->ids[c];
    }
}

static void join_smooth_edges(soup *s, double crease_angle_rad) {
    for (uint32_t c = 0; c < s->corner_count; c++) {
        uint32_t twin = s->twins[c];
        if (twin == TOPOLOGY_NO_TWIN || twin < c) continue;
        dvec3 a = s->areas[c / 3], b = s->areas[twin / 3];
        if (d3_dot(a, a) == 0 || d3_dot(b, b) == 0 || corner_angle(a, b) > crease_angle_rad) continue;
        topology_groups_join(s->groups, c, corner_next(twin));
        topology_groups_join(s->groups, corner_next(c), twin);
    }
}

static void sum_groups(soup *s) {
    for (uint32_t c = 0; c < s->corner_count; c++) {
        dvec3 area = s->areas[c / 3], p = corner_vector(s->positions, c);
        if (d3_dot(area, area) == 0) continue;
        double angle = corner_angle(d3_sub(corner_vector(s->positions, corner_previous(c)), p),
                                    d3_sub(corner_vector(s->positions, corner_next(c)), p));
        dvec3 *sum = &s->sums[s->groups[c]];
        *sum = d3_add(*sum, d3_scale(area, angle));
    }
}

static bool smooth(soup *s, double crease_angle_rad, float *normals) {
    uint32_t id_count;
    s->areas = array_alloc(s->triangle_count, sizeof *s->areas);
    s->skip = array_alloc(s->triangle_count, 1);
    s->ids = array_alloc(s->corner_count, sizeof *s->ids);
    s->twins = array_alloc(s->corner_count, sizeof *s->twins);
    s->groups = topology_groups_create(s->corner_count);
    if (!s->areas || !s->skip || !s->ids || !s->twins || !s->groups) return false;
    if (!topology_weld(&(corner_stream){s->positions, 3}, 1, s->corner_count, s->ids, &id_count)) return false;
    measure(s);
    if (!topology_twins(s->ids, s->triangle_count, s->skip, s->twins)) return false;
    join_smooth_edges(s, crease_angle_rad);
    s->sums = array_alloc(topology_groups_number(s->groups, s->corner_count), sizeof *s->sums);
    if (!s->sums) return false;
    sum_groups(s);
    for (uint32_t c = 0; c < s->corner_count; c++) {
        float *normal = normals + 3 * (size_t)c;
        /* A sum that cancels, as around a spike that is folded flat, leaves the face's own. */
        if (!direction(s->sums[s->groups[c]], normal) && !direction(s->areas[c / 3], normal)) point_up(normal);
    }
    return true;
}

bool normals_smooth(const float *positions, uint32_t triangle_count, double crease_angle_rad, float *normals,
                    kiln_report *report) {
    if (triangle_count > TOPOLOGY_TRIANGLES_MAX)
        return report_error(report, KILN_CODE_LIMIT, NULL, "split the mesh",
                            "%u triangles in one mesh: normals can be made for %u", triangle_count,
                            TOPOLOGY_TRIANGLES_MAX);
    soup s = {.positions = positions, .triangle_count = triangle_count, .corner_count = 3 * triangle_count};
    bool done = smooth(&s, crease_angle_rad, normals);
    free(s.areas);
    free(s.skip);
    free(s.ids);
    free(s.twins);
    free(s.groups);
    free(s.sums);
    return done || report_no_memory(report, "generating normals");
}
