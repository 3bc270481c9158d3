/* render/bsdf/frame.h: an orthonormal frame around a normal. */
#ifndef KILN_RENDER_BSDF_FRAME_H
#define KILN_RENDER_BSDF_FRAME_H

#include "base/kernel.h"
#include "base/vec.h"

typedef struct frame { vec3 x, y, z; } frame;

/* Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1). z is of unit length. */
KERNEL frame frame_make(vec3 z) {
    float sign = copysignf(1.0f, z.z), a = -1.0f / (sign + z.z), b = z.x * z.y * a;
    return (frame){v3(1.0f + sign * z.x * z.x * a, sign * b, -sign * z.x), v3(b, sign + z.y * z.y * a, -z.y), z};
}
/* x is of unit length and at a right angle to z. */
KERNEL frame frame_along(vec3 z, vec3 x) { return (frame){x, v3_cross(z, x), z}; }
KERNEL frame frame_select(int c, frame a, frame b) {
    return (frame){v3_select(c, a.x, b.x), v3_select(c, a.y, b.y), v3_select(c, a.z, b.z)};
}
KERNEL vec3 frame_to_local(const frame *f, vec3 v) { return v3(v3_dot(f->x, v), v3_dot(f->y, v), v3_dot(f->z, v)); }
KERNEL vec3 frame_to_world(const frame *f, vec3 v) {
    return v3(f->x.x * v.x + f->y.x * v.y + f->z.x * v.z, f->x.y * v.x + f->y.y * v.y + f->z.y * v.z,
              f->x.z * v.x + f->y.z * v.y + f->z.z * v.z);
}

#endif
