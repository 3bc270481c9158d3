/* kiln/scene.h: the Scene: what an importer or a program fills and a renderer reads.
 *
 * Frames and units: right-handed, +Y up, metres, seconds. Colours are linear Rec.709. Radiance is in cd/m² (nit)
 * per channel, point and spot intensity in candela, directional illuminance in lux (KHR_lights_punctual,
 * KHR_materials_emissive_strength). Transforms are double, column-major, column vectors: p' = M p, as in glTF.
 * A camera looks along −Z of its own frame with +Y up.
 * Environment: direction d of the environment's frame is found at u = 0.5 + atan2(d.z, d.x)/2π,
 * v = acos(d.y)/π, v down from the top; rotation turns the picture about +Y.
 *
 * A scene is filled by one thread, then committed; from then on it never changes and may be read by any number of
 * threads. Adders copy what they are given and return false with a located error in the report, never half-added. */
#ifndef KILN_SCENE_H
#define KILN_SCENE_H

#include "kiln/api.h"
#include "kiln/image.h"
#include "kiln/material.h"
#include "kiln/mesh.h"
#include "kiln/report.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct kiln_scene kiln_scene;

/* A mesh placed in the world. */
typedef struct kiln_instance_desc {
    const char *name;
    const char *asset; /* the name of what it is a part of, for mattes; NULL or "": its own */
    kiln_id mesh;
    uint32_t time_count;      /* transforms at equidistant times of the shutter; 0 or 1: at rest. The renderer shows the
                                 first, and warns */
    const double *transforms; /* time_count × 16; NULL: the identity */
} kiln_instance_desc;

typedef enum kiln_light_kind {
    KILN_LIGHT_POINT,  /* isotropic: intensity in cd */
    KILN_LIGHT_SPOT,   /* along −Z: intensity in cd on the axis, glTF's smooth cone */
    KILN_LIGHT_DISTANT /* shines along −Z: illuminance in lux on a surface that faces it */
} kiln_light_kind;

typedef struct kiln_light {
    const char *name;
    kiln_light_kind kind;
    double transform[16];
    float color[3];
    float intensity;
    float inner_cone_rad, outer_cone_rad; /* half angles of a spot, 0 ≤ inner ≤ outer ≤ π/2 */
    float angle_rad;                      /* DISTANT: apparent diameter (the sun: 0.0093); 0: a parallel beam */
} kiln_light;

/* KHR_lights_punctual's defaults: white, intensity 1, cone 0 … π/4, at the origin. */
KILN_API kiln_light kiln_light_default(void);

typedef struct kiln_environment {
    kiln_id image;         /* latitude-longitude; 0: the constant colour alone */
    kiln_transfer transfer;
    float color[3];        /* linear Rec.709, multiplies the image; radiance in cd/m² where there is none */
    double rotation_rad;   /* turns the surroundings counter-clockwise seen from above; any number of turns */
} kiln_environment;

typedef enum kiln_projection { KILN_PERSPECTIVE, KILN_ORTHOGRAPHIC } kiln_projection;

typedef struct kiln_camera {
    const char *name;
    kiln_projection projection;
    double transform[16];
    double yfov_rad;         /* PERSPECTIVE: full vertical angle */
    double xmag, ymag;       /* ORTHOGRAPHIC: half width and half height, metres, > 0 */
    double aspect;           /* width / height that the camera was made for, to choose the size of a picture by; 0: any.
                                A render looks at neither aspect nor xmag: its height shows the vertical angle or ymag,
                                its width what its own shape adds (glTF: never stretched) */
    double znear, zfar;      /* metres along the axis; what lies outside is not seen by camera rays, but lights and is
                                reflected; zfar 0: infinity */
    double lens_radius;      /* metres; 0: pinhole */
    double focus_distance;   /* metres along the axis; 0: focus on what the middle of the picture sees */
    uint32_t blades;         /* 0: a round aperture, else a regular polygon of ≥ 3 sides */
    double blade_rotation_rad;
    double shutter_open, shutter_close; /* seconds, open ≤ close; kept, but the renderer does not blur motion yet */
} kiln_camera;

/* Perspective, 40° vertical, at the origin, pinhole. */
KILN_API kiln_camera kiln_camera_default(void);

/* Returns NULL only when memory is exhausted. */
KILN_API kiln_scene *kiln_scene_create(void);
/* NULL: nothing happens. Every renderer of the scene must be gone. */
KILN_API void kiln_scene_destroy(kiln_scene *scene);

/* Each writes the new handle to *id (may be NULL). Names are copied, and may be NULL. What is added refers to what was
 * added before. Numbers outside their domain are brought into it with a warning, where that is no guess. Adding to a
 * committed scene is an error. The environment may be set again. */
KILN_API bool kiln_scene_add_image(kiln_scene *, const kiln_image_desc *, kiln_id *id, kiln_report *);
KILN_API bool kiln_scene_add_material(kiln_scene *, const kiln_material *, kiln_id *id, kiln_report *);
KILN_API bool kiln_scene_add_mesh(kiln_scene *, const kiln_mesh_desc *, kiln_id *id, kiln_report *);
KILN_API bool kiln_scene_add_instance(kiln_scene *, const kiln_instance_desc *, kiln_id *id, kiln_report *);
KILN_API bool kiln_scene_add_light(kiln_scene *, const kiln_light *, kiln_id *id, kiln_report *);
KILN_API bool kiln_scene_add_camera(kiln_scene *, const kiln_camera *, kiln_id *id, kiln_report *);
KILN_API bool kiln_scene_set_environment(kiln_scene *, const kiln_environment *, kiln_report *);

/* Where the light of a scene comes from, by name: punctual lights, materials that shine (unlit ones too) and
 * "environment", which is everything around the scene. Equal names are one group; '.', ',' and ':', which mean
 * something in names of layers and in lists, and control characters are taken for '_', and no more than 200 bytes
 * count; what has no name is "light_7" or "material_7", by its
 * handle. In that order, each name once. Borrowed: the names live in *groups, to be freed by free(). */
KILN_API bool kiln_scene_light_groups(const kiln_scene *, const char *const **groups, uint32_t *count, kiln_report *);

typedef struct kiln_bounds { double min[3], max[3]; } kiln_bounds; /* empty: min > max */

typedef struct kiln_scene_counts {
    uint32_t images, materials, meshes, instances, lights, cameras;
    bool has_environment;
    uint64_t triangles;           /* after triangulation, every instance counted */
    uint64_t triangles_unique;    /* each mesh once */
} kiln_scene_counts;

/* Checks what only the whole scene can tell, computes bounds, freezes the scene. It may be empty. Committing twice is an
 * error. */
KILN_API bool kiln_scene_commit(kiln_scene *, kiln_report *);
KILN_API kiln_scene_counts kiln_scene_count(const kiln_scene *);
KILN_API kiln_bounds kiln_scene_bounds(const kiln_scene *); /* world; after commit */
KILN_API const kiln_camera *kiln_scene_camera(const kiln_scene *, kiln_id); /* borrowed; NULL: no such camera */

#ifdef __cplusplus
}
#endif
#endif
