#include "importers/mesh/tangents.h"

#include <float.h>
#include <stdlib.h>

#include "base/arena.h"
#include "importers/mesh/topology.h"

typedef enum handedness {
    MIRRORED,  /* with v up, the uvs turn against the corners */
    UPRIGHT,   /* … with the corners */
    FLAT,      /* no area in uv: goes with whatever it touches */
    DEGENERATE /* no extent in space: takes no part */
} handedness;

typedef struct soup {
    const float *positions, *normals, *uvs;
    uint32_t triangle_count, corner_count;
    dvec3 *along_u;    /* per triangle: unit derivative of position by u */
    uint8_t *kinds;    /* per triangle: handedness; a FLAT one becomes MIRRORED or UPRIGHT once it has touched one */
    uint8_t *weights;  /* per triangle: 1: along_u says something */
    uint8_t *skip;     /* per triangle: 1: DEGENERATE */
    uint32_t *ids, *twins, *groups; /* per corner */
    uint32_t id_count, group_count;
    dvec3 *sums;       /* per group */
} soup;

static bool same_point(dvec3 a, dvec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/* Derivatives of the linear map from uv to space: with e1, e2 the edges and (a1, b1), (a2, b2) their uvs,
 * area = a1 b2 − a2 b1 and dP/du = (b2 e1 − b1 e2) / area; only its direction is needed. */
static handedness measure(const soup *s, uint32_t triangle, dvec3 *along_u) {
    uint32_t c = 3 * triangle;
    dvec3 p0 = corner_vector(s->positions, c), p1 = corner_vector(s->positions, c + 1),
          p2 = corner_vector(s->positions, c + 2);
    *along_u = (dvec3){0, 0, 0};
    if (same_point(p0, p1) || same_point(p1, p2) || same_point(p2, p0)) return DEGENERATE;
    const float *uv = s->uvs + 2 * (size_t)c;
    double a1 = (double)uv[2] - (double)uv[0], b1 = (double)uv[1] - (double)uv[3];
    double a2 = (double)uv[4] - (double)uv[0], b2 = (double)uv[1] - (double)uv[5]; /* v up */
    dvec3 e1 = d3_sub(p1, p0), e2 = d3_sub(p2, p0);
    double area = a1 * b2 - a2 * b1;
    dvec3 s_axis = d3_sub(d3_scale(e1, b2), d3_scale(e2, b1)), t_axis = d3_sub(d3_scale(e2, a1), d3_scale(e1, a2));
    double length = d3_length(s_axis);
    if (!isfinite(area) || !isfinite(length)) return DEGENERATE;
    /* FLT_MIN: the reference calls an area or length below it zero. */
    if (!(fabs(area) > FLT_MIN && length > FLT_MIN && d3_length(t_axis) > FLT_MIN)) return FLAT;
    *along_u = d3_scale(s_axis, (area > 0 ? 1 : -1) / length);
    return area > 0 ? UPRIGHT : MIRRORED;
}

/* Triangles without uv area take the handedness of the nearest triangle that has one, across edges. */
static bool spread_handedness(soup *s) {
    uint32_t *queue = array_alloc(s->triangle_count, sizeof *queue), begin = 0, end = 0;
    if (!queue) return false;
    for (uint32_t t = 0; t < s->triangle_count; t++)
        if (s->kinds[t] <= UPRIGHT) queue[end++] = t;
    for (; begin < end; begin++)
        for (uint32_t c = 3 * queue[begin]; c < 3 * queue[begin] + 3; c++) {
            if (s->twins[c] == TOPOLOGY_NO_TWIN) continue;
            uint32_t beyond = s->twins[c] / 3;
            if (s->kinds[beyond] != FLAT) continue;
            s->kinds[beyond] = s->kinds[queue[begin]];
            queue[end++] = beyond;
        }
    free(queue);
    return true;
}

static void join_across_edges(soup *s) {
    for (uint32_t c = 0; c < s->corner_count; c++) {
        uint32_t twin = s->twins[c];
        if (twin == TOPOLOGY_NO_TWIN || twin < c || s->kinds[c / 3] != s->kinds[twin / 3]) continue;
        topology_groups_join(s->groups, c, corner_next(twin));
        topology_groups_join(s->groups, corner_next(c), twin);
    }
}

static dvec3 unit_normal(const soup *s, uint32_t corner) {
    dvec3 n = d3_normalize(corner_vector(s->normals, corner));
    double length2 = d3_dot(n, n);
    return length2 > 0.5 && length2 < 2 ? n : (dvec3){0, 0, 0};
}

static dvec3 project(dvec3 v, dvec3 n) { return d3_sub(v, d3_scale(n, d3_dot(v, n))); }

/* Mean of the projected directions of the triangles of each group, weighted by their angle at the corner, which is
 * measured in the plane of the normal too. */
static void sum_groups(soup *s) {
    for (uint32_t c = 0; c < s->corner_count; c++) {
        if (!s->weights[c / 3]) continue;
        dvec3 n = unit_normal(s, c), p = corner_vector(s->positions, c);
        dvec3 before = project(d3_sub(corner_vector(s->positions, corner_previous(c)), p), n);
        dvec3 after = project(d3_sub(corner_vector(s->positions, corner_next(c)), p), n);
        dvec3 direction = d3_normalize(project(s->along_u[c / 3], n));
        dvec3 *sum = &s->sums[s->groups[c]];
        *sum = d3_add(*sum, d3_scale(direction, corner_angle(before, after)));
    }
}

static void write_tangent(const soup *s, uint32_t corner, float *tangent) {
    dvec3 t = d3_normalize(s->sums[s->groups[corner]]);
    double length2 = d3_dot(t, t);
    if (!(length2 > 0.5 && length2 < 2)) t = corner_perpendicular(unit_normal(s, corner));
    tangent[0] = (float)t.x, tangent[1] = (float)t.y, tangent[2] = (float)t.z;
    tangent[3] = s->kinds[corner / 3] == MIRRORED ? -1 : 1;
}

/* Triangles without extent copy from a corner of equal position, normal and uv. */
static bool write_degenerate(const soup *s, float *tangents) {
    uint32_t *sources = array_alloc(s->id_count, sizeof *sources);
    if (!sources) return false;
    for (uint32_t c = s->corner_count; c-- > 0;)
        if (!s->skip[c / 3]) sources[s->ids[c]] = c + 1;
    for (uint32_t c = 0; c < s->corner_count; c++) {
        uint32_t source = s->skip[c / 3] ? sources[s->ids[c]] : 0;
        for (size_t k = 0; source && k < 4; k++) tangents[4 * (size_t)c + k] = tangents[4 * (size_t)(source - 1) + k];
    }
    free(sources);
    return true;
}

static bool allocate(soup *s) {
    s->along_u = array_alloc(s->triangle_count, sizeof *s->along_u);
    s->kinds = array_alloc(s->triangle_count, 1);
    s->weights = array_alloc(s->triangle_count, 1);
    s->skip = array_alloc(s->triangle_count, 1);
    s->ids = array_alloc(s->corner_count, sizeof *s->ids);
    s->twins = array_alloc(s->corner_count, sizeof *s->twins);
    s->groups = topology_groups_create(s->corner_count);
    return s->along_u && s->kinds && s->weights && s->skip && s->ids && s->twins && s->groups;
}

static void release(soup *s) {
    free(s->along_u);
    free(s->kinds);
    free(s->weights);
    free(s->skip);
    free(s->ids);
    free(s->twins);
    free(s->groups);
    free(s->sums);
}

static bool generate(soup *s, float *tangents) {
    if (!allocate(s)) return false;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        s->kinds[t] = (uint8_t)measure(s, t, &s->along_u[t]);
        s->weights[t] = s->kinds[t] <= UPRIGHT;
        s->skip[t] = s->kinds[t] == DEGENERATE;
    }
    const corner_stream streams[] = {{s->positions, 3}, {s->normals, 3}, {s->uvs, 2}};
    if (!topology_weld(streams, 3, s->corner_count, s->ids, &s->id_count) ||
        !topology_twins(s->ids, s->triangle_count, s->skip, s->twins) || !spread_handedness(s))
        return false;
    join_across_edges(s);
    s->group_count = topology_groups_number(s->groups, s->corner_count);
    s->sums = array_alloc(s->group_count, sizeof *s->sums);
    if (!s->sums) return false;
    sum_groups(s);
    for (uint32_t c = 0; c < s->corner_count; c++) write_tangent(s, c, tangents + 4 * (size_t)c);
    return write_degenerate(s, tangents);
}

bool tangents_generate(const float *positions, const float *normals, const float *uvs, uint32_t triangle_count,
                       float *tangents, kiln_report *report) {
    if (triangle_count > TOPOLOGY_TRIANGLES_MAX)
        return report_error(report, KILN_CODE_LIMIT, NULL, "split the mesh",
                            "%u triangles in one mesh: tangents can be made for %u", triangle_count,
                            TOPOLOGY_TRIANGLES_MAX);
    soup s = {.positions = positions, .normals = normals, .uvs = uvs, .triangle_count = triangle_count,
              .corner_count = 3 * triangle_count};
    bool done = generate(&s, tangents);
    release(&s);
    return done || report_no_memory(report, "generating tangents");
}
