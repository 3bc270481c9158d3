/* render/path/cone.h: how much of a surface a path stands for: a cone along its ray. Scalar kernels.
 *
 * After Akenine-Möller et al. 2019 (Texture Level of Detail Strategies for Real-Time Ray Tracing) and 2021 (Improved
 * Shader and Texture Level of Detail Using Ray Cones), with one change: where they take the mean of what a cone's axes
 * do, here it is the lower bound, so that filtering by the cone never blurs what brute force would resolve. Light that
 * converges, at a concave mirror, a lens, or a bump of a normal map, may come to a focus: its cone has no width from
 * there on. The samples of the pixel filter whatever the cone leaves. */
#ifndef KILN_RENDER_PATH_CONE_H
#define KILN_RENDER_PATH_CONE_H

#include "render/path/camera.h"
#include "render/path/surface.h"
#include "render/world/texture.h"

/* Both ≥ 0; after a distance t it is width + spread t across. */
typedef struct cone { float width, spread; } cone;

/* Of a pixel that is `pixel` across, on the image plane at distance 1 or (orthographic) in render space. Off the axis a
 * perspective pixel spans cos² of the angle at the centre, radially. A point of the lens sees it as the pinhole does. */
KERNEL cone cone_camera(const camera *c, float pixel, vec3 direction) {
    float cosine = v3_dot(direction, c->back);
    int flat = c->orthographic > 0.5f;
    return (cone){flat ? pixel : 0.0f, flat ? 0.0f : pixel * cosine * cosine};
}

/* The footprint of a cone that is `width` across on a triangle with edges e1 and e2, whose UV differ by d1 and d2: in
 * UV. The angle at which the surface is seen would stretch one axis; the least one counts, and that stays. */
KERNEL texture_footprint cone_footprint(float width, vec3 e1, vec3 e2, vec2 d1, vec2 d2) {
    float g11 = v3_dot(e1, e1), g12 = v3_dot(e1, e2), g22 = v3_dot(e2, e2);
    vec3 n = v3_cross(e1, e2);
    float scale = width * width / fm_max(v3_dot(n, n), 1e-37f);
    return (texture_footprint){scale * (d1.x * d1.x * g22 - 2.0f * d1.x * d2.x * g12 + d2.x * d2.x * g11),
                               scale * (d1.x * d1.y * g22 - (d1.x * d2.y + d2.x * d1.y) * g12 + d2.x * d2.y * g11),
                               scale * (d1.y * d1.y * g22 - 2.0f * d1.y * d2.y * g12 + d2.y * d2.y * g11)};
}

/* Principal curvatures of a surface whose normals are interpolated: > 0 where they part on the normals' side. */
typedef struct cone_curvature { float low, high; } cone_curvature;

/* The eigenvalues of the second against the first fundamental form of the triangle. side: a normal on the side that
 * counts. Corners without normals are flat. */
KERNEL cone_curvature cone_curvature_of(vec3 e1, vec3 e2, vec3 n0, vec3 n1, vec3 n2, vec3 side) {
    float l0 = v3_dot(n0, n0), l1 = v3_dot(n1, n1), l2 = v3_dot(n2, n2);
    int smooth = (l0 > 0.0f) & (l1 > 0.0f) & (l2 > 0.0f);
    n0 = v3_scale(n0, 1.0f / sqrtf(smooth ? l0 : 1.0f));
    n1 = v3_scale(n1, 1.0f / sqrtf(smooth ? l1 : 1.0f));
    n2 = v3_scale(n2, 1.0f / sqrtf(smooth ? l2 : 1.0f));
    vec3 f1 = v3_sub(n1, n0), f2 = v3_sub(n2, n0), n = v3_cross(e1, e2);
    float g11 = v3_dot(e1, e1), g12 = v3_dot(e1, e2), g22 = v3_dot(e2, e2), det = fm_max(v3_dot(n, n), 1e-37f);
    float h11 = v3_dot(f1, e1), h12 = 0.5f * (v3_dot(f1, e2) + v3_dot(f2, e1)), h22 = v3_dot(f2, e2);
    float mean = 0.5f * (h11 * g22 - 2.0f * h12 * g12 + h22 * g11) / det, gauss = (h11 * h22 - h12 * h12) / det;
    float root = sqrtf(fm_max(mean * mean - gauss, 0.0f));
    int turned = v3_dot(v3_add(v3_add(n0, n1), n2), side) < 0.0f;
    float low = turned ? -mean - root : mean - root, high = turned ? root - mean : mean + root;
    return (cone_curvature){smooth ? low : 0.0f, smooth ? high : 0.0f};
}

/* A bounce: the ray comes along d, meets a surface with the shading normal n on its side, and goes on along wi. */
typedef struct cone_bounce {
    vec3 d, n, wi;
    cone_curvature curvature;
    float pdf;  /* of wi; 0: a mirror's */
    float eta;  /* n of the far side over n of the near one */
    int bumpy;  /* n is a normal map's: its curvature is not known */
    int bends;  /* wi is refracted */
    int passes; /* wi goes straight on through a thin wall */
} cone_bounce;

/* Of the angle between what a lobe's directions have in common, so much is filtered. */
#define CONE_SHARE 0.125f

/* What a lobe adds to the spread: a direction stands for 1/pdf of solid angle, but no lobe is smoother than the distance
 * from its middle, which is where a mirror would have sent the ray. */
KERNEL float cone_lobe(const cone_bounce *b, float cosine) {
    float sine2 = fm_max(1.0f - cosine * cosine, 0.0f), inverse = 1.0f / b->eta;
    float along = b->bends ? cosine * inverse - sqrtf(fm_max(1.0f - sine2 * inverse * inverse, 0.0f)) : 2.0f * cosine;
    along = b->passes ? 0.0f : along;
    vec3 off = v3_sub(b->wi, v3_madd(v3_scale(b->d, b->bends ? inverse : 1.0f), along, b->n));
    float apart = sqrtf(v3_dot(off, off)), share = 1.0f / sqrtf(fm_max(b->pdf, 1e-12f));
    return b->pdf > 0.0f ? CONE_SHARE * fm_min(apart, share) : 0.0f;
}

/* at: the cone where it meets the surface. A mirror of curvature k turns rays that meet it w apart by 2 k w more, times
 * the cosine across the plane of incidence, and over it within (Coddington); a refracting one by
 * (η cos' − cos) k w / η, towards each other where that is positive, and within the plane by 1/(cos cos') of that. */
KERNEL cone cone_scatter(cone at, const cone_bounce *b) {
    float cosine = fm_clamp(-v3_dot(b->d, b->n), 1e-3f, 1.0f), far = fm_clamp(fabsf(v3_dot(b->wi, b->n)), 1e-3f, 1.0f);
    float reflected = 2.0f * b->curvature.low * at.width;
    reflected = at.spread + (reflected < 0.0f ? reflected / cosine : reflected * cosine);
    float power = (cosine - b->eta * far) / b->eta * at.width;
    float refracted = fm_min(power * b->curvature.low, power * b->curvature.high);
    refracted = at.spread * fm_min(1.0f, cosine / far) / b->eta +
                (refracted < 0.0f ? refracted / (cosine * far) : refracted);
    float spread = b->passes ? at.spread : b->bends ? refracted : reflected;
    float width = b->bends ? at.width * fm_min(1.0f, far / cosine) : at.width;
    int known = (spread >= 0.0f) & ((b->bumpy == 0) | b->passes);
    return (cone){known ? width : 0.0f, (known ? spread : 0.0f) + cone_lobe(b, cosine)};
}

#endif
