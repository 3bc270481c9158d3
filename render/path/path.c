/* render/path/path.c: the estimator: a batch of paths, stage by stage.
 *
 *     L = E + ∫ f L cos     (Kajiya 1986), by paths from the camera
 *
 * Each pass of the loop is one term of the sum: light that the surface gives off (emission), light that reaches it
 * straight from a light (light, connect), and one direction in which the rest is looked for (scatter). A stage that the
 * scene does not call for is not run. */
#include "render/path/stages.h"

/* A stage, and whose time it takes. */
#define RUN(stage, row) (STAGE(stage)(c, b), stage_clock_read(&b->clock, KILN_STAGE_##row))

/* Everything that a point must know before it is lit. */
static void look_at_surfaces(const path_context *c, batch *b) {
    RUN(fetch, FETCH);
    RUN(surface, SURFACE);
    if (HAS(c->effects, TEXTURE_FILTERING)) RUN(cone_hit, CONE);
    RUN(material, MATERIAL);
    if (HAS(c->effects, SOLIDS)) RUN(boundary, BOUNDARY);
    RUN(normal, NORMAL);
    if (HAS(c->effects, SCATTERING)) RUN(scattering, FLIGHT);
}

void STAGE(trace_samples)(const path_context *c, const path_sample *samples, uint32_t count, batch *b) {
    const uint64_t effects = c->effects;
    const bool emits = HAS(effects, AREA_LIGHTS) || HAS(effects, UNLIT);
    STAGE(camera)(c, samples, count, b);
    stage_clock_read(&b->clock, KILN_STAGE_CAMERA);
    if (HAS(effects, TEXTURE_FILTERING)) RUN(cone_start, CONE);
    while (b->n > 0) {
        if (b->depth == 0) RUN(trace, CAMERA_RAYS);
        else RUN(trace, BOUNCE_RAYS);
        if (HAS(effects, NESTED_MEDIA)) RUN(touch, TOUCH);
        if (HAS(effects, SCATTERING)) RUN(flight, FLIGHT);
        RUN(escape, ESCAPE);
        RUN(sort, SORT);
        look_at_surfaces(c, b);
        if (HAS(effects, ABSORPTION)) RUN(absorb, ABSORB);
        if ((c->aovs || c->handles) && b->depth == 0) RUN(aovs, AOVS);
        if (emits) RUN(emission, EMISSION);
        if (emits && c->parts) RUN(part_emission, PARTS);
        if (b->depth >= c->max_depth) {
            bool ended = STAGE(limit)(c, b);
            stage_clock_read(&b->clock, KILN_STAGE_LIMIT);
            if (ended) {
                RUN(sort, SORT);
                look_at_surfaces(c, b);
            }
        }
        RUN(random, RANDOM);
        if (c->samples_lights) {
            RUN(light, LIGHT);
            RUN(connect, CONNECT);
            if (c->parts) RUN(part_light, PARTS);
        }
        if (c->parts && b->depth == 0) RUN(part_scatter, PARTS);
        RUN(scatter, SCATTER);
        if (HAS(effects, TEXTURE_FILTERING)) RUN(cone_scatter, CONE);
        RUN(close, SORT);
        b->depth++;
    }
}
