/* render/effects/scan.h: what a committed scene calls for.
 *
 * The scan reads the scene as it will be rendered: materials reduced, and only what some instance shows. They are reduced
 * twice: before pictures are decoded, to know which of them are wanted, and when those were looked at. */
#ifndef KILN_RENDER_EFFECTS_SCAN_H
#define KILN_RENDER_EFFECTS_SCAN_H

#include "base/report.h"
#include "render/effects/plan.h"
#include "render/world/images.h"

typedef struct reduced_scene {
    const kiln_scene *scene;
    kiln_material *materials; /* by id, reduced; those that are not used are the scene's */
    bool *used;               /* by id: on something that is shown */
    uint32_t *shown;          /* of meshes, by id − 1: how many instances show it */
    float *color_alpha;       /* by id: the least alpha of vertex colours on it */
    uint64_t removed;
} reduced_scene;

/* The caller frees it in either case; false: out of memory, reported. */
bool reduced_make(reduced_scene *, const kiln_scene *, uint64_t removed, kiln_report *);
void reduced_free(reduced_scene *);

/* Reduces the materials by what was seen of the images; NULL: nothing yet. */
void reduced_update(reduced_scene *, const world_image *images);

static inline const kiln_material *reduced_material(const reduced_scene *r, kiln_id id) { return &r->materials[id]; }

/* Does a transform leave anything of what it places? A node that is hidden by a scale of 0 shows nothing. */
bool transform_shows(const mat4 *);

/* What a light calls for; nothing: it is black. */
uint64_t light_effects(const kiln_light *);

/* Fills in who calls for what, and settles the plan, of which the caller has set asked. false: reported. */
bool scan_scene(const reduced_scene *, const world_image *images, kiln_texture_filter, kiln_effect_plan *, kiln_report *);

/* What depends on the camera that is rendered with. */
void scan_camera(const kiln_scene *, const kiln_camera *, kiln_effect_plan *);

#endif
