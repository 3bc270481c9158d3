/* base/mat.h: affine transforms in double, column-major, column vectors: p' = M p, as in glTF. */
#ifndef KILN_BASE_MAT_H
#define KILN_BASE_MAT_H

#include <math.h>
#include <stdbool.h>
#include <string.h>

typedef struct dvec3 { double x, y, z; } dvec3;
typedef struct mat4 { double m[16]; } mat4; /* element (row, column) is m[4 column + row] */

static inline dvec3 d3_load(const double *p) { return (dvec3){p[0], p[1], p[2]}; }
static inline dvec3 d3_add(dvec3 a, dvec3 b) { return (dvec3){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline dvec3 d3_sub(dvec3 a, dvec3 b) { return (dvec3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline dvec3 d3_scale(dvec3 a, double s) { return (dvec3){a.x * s, a.y * s, a.z * s}; }
static inline double d3_dot(dvec3 a, dvec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline dvec3 d3_cross(dvec3 a, dvec3 b) {
    return (dvec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double d3_length(dvec3 a) { return sqrt(d3_dot(a, a)); }
/* The zero vector stays zero. */
static inline dvec3 d3_normalize(dvec3 a) {
    double length = d3_length(a);
    return length > 0 ? d3_scale(a, 1 / length) : a;
}

static inline mat4 mat4_identity(void) {
    return (mat4){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
}
static inline mat4 mat4_load(const double *m) {
    mat4 result;
    memcpy(result.m, m, sizeof result.m);
    return result;
}
static inline mat4 mat4_mul(mat4 a, mat4 b) {
    mat4 r;
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < 4; i++) {
            double sum = 0;
            for (int k = 0; k < 4; k++) sum += a.m[4 * k + i] * b.m[4 * c + k];
            r.m[4 * c + i] = sum;
        }
    return r;
}
static inline dvec3 mat4_point(const mat4 *m, dvec3 p) {
    const double *e = m->m;
    return (dvec3){e[0] * p.x + e[4] * p.y + e[8] * p.z + e[12], e[1] * p.x + e[5] * p.y + e[9] * p.z + e[13],
                   e[2] * p.x + e[6] * p.y + e[10] * p.z + e[14]};
}
static inline dvec3 mat4_vector(const mat4 *m, dvec3 v) {
    const double *e = m->m;
    return (dvec3){e[0] * v.x + e[4] * v.y + e[8] * v.z, e[1] * v.x + e[5] * v.y + e[9] * v.z,
                   e[2] * v.x + e[6] * v.y + e[10] * v.z};
}
/* Determinant of the linear part: negative when the transform mirrors, 0 when it flattens. */
static inline double mat4_determinant(const mat4 *m) {
    const double *e = m->m;
    return d3_dot(d3_load(e), d3_cross(d3_load(e + 4), d3_load(e + 8)));
}
/* Normals go through the cofactor matrix (the inverse transpose times the determinant): finite for flattening
 * transforms too; it turns a normal over when the transform mirrors, as the surface's winding does. Not normalised. */
static inline dvec3 mat4_normal(const mat4 *m, dvec3 n) {
    dvec3 x = d3_load(m->m), y = d3_load(m->m + 4), z = d3_load(m->m + 8);
    dvec3 cx = d3_cross(y, z), cy = d3_cross(z, x), cz = d3_cross(x, y);
    return d3_add(d3_add(d3_scale(cx, n.x), d3_scale(cy, n.y)), d3_scale(cz, n.z));
}
/* Inverse of an affine matrix; false when it is singular. */
static inline bool mat4_invert(const mat4 *m, mat4 *inverse) {
    dvec3 x = d3_load(m->m), y = d3_load(m->m + 4), z = d3_load(m->m + 8), t = d3_load(m->m + 12);
    double det = mat4_determinant(m);
    if (!(fabs(det) > 0) || !isfinite(1 / det)) return false;
    dvec3 r0 = d3_scale(d3_cross(y, z), 1 / det), r1 = d3_scale(d3_cross(z, x), 1 / det),
          r2 = d3_scale(d3_cross(x, y), 1 / det);
    *inverse = (mat4){{r0.x, r1.x, r2.x, 0, r0.y, r1.y, r2.y, 0, r0.z, r1.z, r2.z, 0, -d3_dot(r0, t), -d3_dot(r1, t),
                       -d3_dot(r2, t), 1}};
    return true;
}
/* translation × rotation (a quaternion x, y, z, w of any length; of length 0: none) × scale */
static inline mat4 mat4_trs(const double t[3], const double q[4], const double s[3]) {
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    bool turns = length > 0;
    double x = turns ? q[0] / length : 0, y = turns ? q[1] / length : 0, z = turns ? q[2] / length : 0,
           w = turns ? q[3] / length : 1;
    return (mat4){{(1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y + z * w) * s[0], 2 * (x * z - y * w) * s[0], 0,
                   2 * (x * y - z * w) * s[1], (1 - 2 * (x * x + z * z)) * s[1], 2 * (y * z + x * w) * s[1], 0,
                   2 * (x * z + y * w) * s[2], 2 * (y * z - x * w) * s[2], (1 - 2 * (x * x + y * y)) * s[2], 0,
                   t[0], t[1], t[2], 1}};
}

#endif
