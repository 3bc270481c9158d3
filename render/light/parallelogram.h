/* render/light/parallelogram.h: two triangles that make one: most lamps are, and are sampled as one light. */
#ifndef KILN_RENDER_LIGHT_PARALLELOGRAM_H
#define KILN_RENDER_LIGHT_PARALLELOGRAM_H

#include <stdbool.h>

#include "base/vec.h"

/* Triangles a and b, of the same winding, with a common edge: *apex is the corner of a that lies opposite to it, and
 * *off how far b's is from where it would complete the parallelogram: no further than rounding of their corners. */
static inline bool parallelogram_make(const vec3 a[3], const vec3 b[3], int *apex, float *off) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            vec3 p = a[i], q = a[(i + 1) % 3], top = a[(i + 2) % 3], r = b[j], s = b[(j + 1) % 3];
            if (p.x != s.x || p.y != s.y || p.z != s.z || q.x != r.x || q.y != r.y || q.z != r.z) continue;
            vec3 e1 = v3_sub(p, top), e2 = v3_sub(q, top), e3 = v3_sub(b[(j + 2) % 3], top);
            *apex = (i + 2) % 3;
            *off = v3_length(v3_sub(e3, v3_add(e1, e2)));
            return *off <= 0x1p-18f * (v3_length(e1) + v3_length(e2));
        }
    return false;
}

#endif
