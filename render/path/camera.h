/* render/path/camera.h: where camera rays start and go. */
#ifndef KILN_RENDER_PATH_CAMERA_H
#define KILN_RENDER_PATH_CAMERA_H

#include "render/sample/warp.h"
#include "render/world/world.h"

/* Render space. Image-plane coordinates x, y run in [−1, 1] across the picture, y up. */
typedef struct camera {
    vec3 origin, right, up, back; /* unit axes; it looks along −back */
    float half_width, half_height; /* of the picture at distance 1 (perspective), or in all (orthographic) */
    float orthographic;            /* 1 or 0 */
    float lens_radius, focus;      /* focus: distance along the axis */
    float blades, blade_rotation_turns; /* blades 0: round */
    float near, far;               /* distances along the axis */
} camera;

typedef struct camera_ray { vec3 origin, direction; float near, far; } camera_ray;

/* A point of the aperture: a disk, or one of a polygon's triangles, each as likely as the next. */
KERNEL vec2 camera_lens(const camera *c, vec2 u) {
    vec2 disk = warp_disk(u);
    float scaled = u.y * c->blades, sector = fm_floor(scaled);
    vec2 w = warp_triangle((vec2){u.x, scaled - sector});
    float turns = 1.0f / (c->blades > 0.0f ? c->blades : 1.0f);
    fm_pair a = fm_sincos_2pi(sector * turns + c->blade_rotation_turns);
    fm_pair b = fm_sincos_2pi((sector + 1.0f) * turns + c->blade_rotation_turns);
    int polygon = c->blades > 0.0f;
    return (vec2){polygon ? w.x * a.cos + w.y * b.cos : disk.x, polygon ? w.x * a.sin + w.y * b.sin : disk.y};
}

/* Thin lens: what the pinhole sees at the focal distance is where all rays of the pixel meet. lens: a point of the
 * aperture. */
KERNEL camera_ray camera_ray_through(const camera *c, float x, float y, vec2 lens) {
    float px = x * c->half_width, py = y * c->half_height;
    int flat = c->orthographic > 0.5f;
    vec3 at = v3(flat ? px : 0.0f, flat ? py : 0.0f, 0.0f);
    vec3 focal = v3(flat ? px : px * c->focus, flat ? py : py * c->focus, -c->focus);
    at.x += lens.x * c->lens_radius;
    at.y += lens.y * c->lens_radius;
    vec3 d = v3_normalize(v3_sub(focal, at)); /* focus > 0 */
    vec3 origin = v3_madd(v3_madd(c->origin, at.x, c->right), at.y, c->up);
    vec3 direction = v3_madd(v3_madd(v3_scale(c->right, d.x), d.y, c->up), d.z, c->back);
    float along = -1.0f / d.z; /* d.z < 0 */
    return (camera_ray){origin, v3_normalize(direction), c->near * along, c->far * along};
}
KERNEL camera_ray camera_ray_at(const camera *c, float x, float y, vec2 lens_u) {
    return camera_ray_through(c, x, y, camera_lens(c, lens_u));
}
KERNEL camera_ray camera_ray_of_pinhole(const camera *c, float x, float y) { return camera_ray_through(c, x, y, (vec2){0, 0}); }

/* false: reported. picture: width and height in pixels. */
bool camera_make(const world *, const kiln_camera *, uint32_t width, uint32_t height, camera *, kiln_report *);

/* The stack of media (medium.h) around the camera's origin. */
uint64_t camera_media(const world *, const camera *);

#endif
