/* render/path/path.h: the estimator: camera samples become radiance. */
#ifndef KILN_RENDER_PATH_PATH_H
#define KILN_RENDER_PATH_PATH_H

#include "kiln/render.h"
#include "render/path/batch.h"
#include "render/path/camera.h"
#include "render/path/parts.h"
#include "render/sample/filter.h"
#include "render/sample/sampler.h"
#include "render/world/spectrum.h"

/* What all paths of a render share. Immutable. */
typedef struct path_context {
    const world *world;
    camera camera;
    uint64_t effects;       /* bits: those that run, the camera's among them */
    uint64_t media;         /* stack of those around the camera */
    float squeeze;          /* n² there: the camera itself is filled with air, which takes radiance over as L/n² */
    pixel_filter filter;
    uint32_t width, height; /* of the whole picture */
    uint32_t seed;
    int independent;        /* sampler */
    kiln_estimator estimator;
    bool samples_lights;
    bool keeps_place; /* paths know where they were last lit */
    const struct light_tree *light_tree; /* NULL: lights are not chosen by where they are; else CHOOSE_FAR's … */
    const uint32_t *light_cdf, *light_guide; /* NULL: there is none, or one alone */
    uint32_t max_depth;
    kiln_roulette_kind roulette;
    float roulette_p;
    uint32_t roulette_min;
    kiln_background background;
    vec3 background_color;
    uint32_t aovs;    /* bits of KILN_AOV that the paths see */
    const path_parts_plan *parts; /* NULL: the film holds none */
    bool handles;     /* of the first surface's instance and material are wanted */
} path_context;

/* One sample of one pixel. */
typedef struct path_sample {
    uint32_t x, y, n;
    bool idle; /* it only completes a packet of camera rays: nothing comes of it */
} path_sample;

/* The wavelength that a path of a world with a spectrum takes on: of the sample, whenever that is. */
static inline spectrum_line path_wavelength(const path_context *c, sample_point p) {
    return spectrum_draw(c->world->spectrum, sample_pair(c->independent, p, SAMPLE_WAVELENGTH, 0).x);
}

/* Traces count ≤ BATCH_PATHS samples to their end; b->out then holds their results by position in samples. Each sixteen
 * in a row are a packet of camera rays: which they are must be a matter of pixels and samples alone
 * (ray_lanes.coherent). */
typedef void path_tracer(const path_context *, const path_sample *samples, uint32_t count, batch *);

/* The same code, compiled for x86-64-v2, v3 and v4: the wanted one, or for NULL the best that this machine has, with its
 * name; NULL when it has not the wanted one. */
path_tracer *path_choose_tracer(const char *wanted, const char **name);

/* One in so many paths that reach the depth limit goes on for PROBE_DEPTHS more, to measure what the limit cuts off. */
enum { PROBE_EVERY = 32, PROBE_DEPTHS = 64 };
static inline int path_is_probe(uint32_t seed, uint32_t index) { return hash_pair(seed, index) % PROBE_EVERY == 0; }

#endif
