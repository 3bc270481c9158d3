/* importers/mesh/topology.h: which corners of a triangle soup are one point, which edges are shared.
 *
 * Corner c belongs to triangle c / 3; half-edge c runs from corner c to the next corner of its triangle. */
#ifndef KILN_IMPORTERS_MESH_TOPOLOGY_H
#define KILN_IMPORTERS_MESH_TOPOLOGY_H

#include <stdbool.h>
#include <stdint.h>

#include "base/mat.h"

/* Corners are counted in 32 bits. */
#define TOPOLOGY_TRIANGLES_MAX (UINT32_MAX / 3 - 1)

/* `width` floats for every corner. */
typedef struct corner_stream {
    const float *values;
    uint32_t width;
} corner_stream;

/* Gives corners equal ids exactly when all their floats are equal (0 and −0 are; NaN equals its own bits). Ids count
 * from 0 in order of first appearance. False: no memory. */
bool topology_weld(const corner_stream *streams, uint32_t stream_count, uint32_t corner_count, uint32_t *ids,
                   uint32_t *id_count);

#define TOPOLOGY_NO_TWIN UINT32_MAX

/* Pairs every half-edge with one that runs the other way between the same ids, each at most once, first come first
 * served where more than two meet. Triangles whose skip byte is set have none. False: no memory. */
bool topology_twins(const uint32_t *ids, uint32_t triangle_count, const uint8_t *skip, uint32_t *twins);

/* Corners joined in groups: a forest in which a parent is never behind its child. */
uint32_t *topology_groups_create(uint32_t corner_count); /* every corner alone; NULL: no memory; free() */
void topology_groups_join(uint32_t *groups, uint32_t a, uint32_t b);
/* Replaces the forest by the number of each corner's group, counted from 0; returns how many there are. */
uint32_t topology_groups_number(uint32_t *groups, uint32_t corner_count);

static inline uint32_t corner_next(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
static inline uint32_t corner_previous(uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

static inline dvec3 corner_vector(const float *values, uint32_t corner) {
    const float *v = values + 3 * (size_t)corner;
    return (dvec3){v[0], v[1], v[2]};
}

/* Between two vectors of any length; 0 when either is zero. */
static inline double corner_angle(dvec3 a, dvec3 b) {
    double sine = d3_length(d3_cross(a, b)), cosine = d3_dot(a, b);
    return sine == 0 && cosine == 0 ? 0 : atan2(sine, cosine);
}

/* A unit vector at a right angle to n, which is a unit vector or zero. */
dvec3 corner_perpendicular(dvec3 n);

#endif
