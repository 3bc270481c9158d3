/* tests/render/scenes.h: small scenes with known answers. */
#ifndef KILN_TESTS_RENDER_SCENES_H
#define KILN_TESTS_RENDER_SCENES_H

#include "kiln/render.h"

struct world;

/* A scene under construction; every call must succeed, or the test fails. */
typedef struct scene_builder {
    kiln_scene *scene;
    kiln_report *report;
} scene_builder;

scene_builder builder_make(void);
void builder_free(scene_builder *);

/* Lambert: no metal, no coat. */
kiln_material diffuse_material(float r, float g, float b);
kiln_id add_material(scene_builder *, const kiln_material *);

/* A mesh that is in the picture only where instances place it (NULL: where it is). */
kiln_id add_mesh(scene_builder *, const kiln_mesh_desc *);
void add_instance(scene_builder *, kiln_id mesh, const double transform[16]);
/* a, b, c, d counter-clockwise seen from the front; UV (0,1) (1,1) (1,0) (0,0). */
void add_quad(scene_builder *, kiln_id material, const float corners[12]);
/* Latitude-longitude sphere. INWARD: it faces its centre. FLAT: no normals. */
enum { SPHERE_INWARD = 1, SPHERE_FLAT = 2 };
void add_sphere(scene_builder *, kiln_id material, const float center[3], float radius, int segments, int flags);
void add_box(scene_builder *, kiln_id material, const float low[3], const float high[3]);
void add_light(scene_builder *, const kiln_light *);
/* A light at position that shines towards at. */
kiln_light light_at(kiln_light_kind, const float position[3], const float at[3], float intensity);
void set_environment(scene_builder *, kiln_id image, float r, float g, float b);
kiln_id add_image(scene_builder *, const float *rgb, uint32_t width, uint32_t height);
kiln_camera camera_at(const float eye[3], const float at[3], double yfov_degrees);

/* A room that uses everything the estimator has: every kind of light and of material, textures in every slot, every
 * layer and stacks of them, vertex colours, partial coverage, nested glass that absorbs, mirrored and shared instances,
 * a sun of visible size. */
void add_everything(scene_builder *);
kiln_camera everything_camera(void);

/* What a render gives in all. */
typedef struct picture {
    uint32_t width, height;
    float *rgb;
    double mean;          /* over pixels and channels */
    double mean_error;    /* standard error of mean, from the replicates */
    kiln_film_error error;
    kiln_render_stats stats;
    kiln_film *film;
} picture;

/* Commits the scene and reads it as a renderer does, in linear Rec.709; the caller destroys the world. */
struct world *build_world(scene_builder *);

/* Commits the scene if that is still due. Never fails: the test does. */
picture render(scene_builder *, const kiln_camera *, const kiln_render_options *, uint32_t width, uint32_t height);
picture render_with(const kiln_renderer *, const kiln_render_options *, const kiln_film_desc *, kiln_report *);
void picture_free(picture *);

/* Fails the test, with every message of the report, unless ok. */
void must(bool ok, const kiln_report *, const char *what);

#endif
