/* render/path/path.c: the estimator: a batch of paths, stage by stage.
 *
 *     L = E + ∫ f L cos     (Kajiya 1986), by paths from the camera
 *
 * Each pass of the loop is one term of the sum: light that the surface gives off (emission), light that reaches it
 * straight from a light (light, connect), and one direction in which the rest is looked for (scatter). A stage that the
 * scene does not call for is not run. */
#include "render/path/stages.h"

/* Everything that a point must know before it is lit. */
static void look_at_surfaces(const path_context *c, batch *b) {
    STAGE(fetch)(c, b);
    STAGE(surface)(c, b);
    if (c->world->filters) STAGE(cone_hit)(c, b);
    STAGE(material)(c, b);
    if (c->world->media_count > 1) STAGE(boundary)(c, b);
    STAGE(normal)(c, b);
    if (c->world->scatters) STAGE(scattering)(c, b);
}

void STAGE(trace_samples)(const path_context *c, const path_sample *samples, uint32_t count, batch *b) {
    const world *w = c->world;
    STAGE(camera)(c, samples, count, b);
    if (w->filters) STAGE(cone_start)(c, b);
    while (b->n > 0) {
        STAGE(trace)(c, b);
        if (w->touches) STAGE(touch)(c, b);
        if (w->scatters) STAGE(flight)(c, b);
        STAGE(escape)(c, b);
        STAGE(sort)(c, b);
        look_at_surfaces(c, b);
        if (w->absorbs) STAGE(absorb)(c, b);
        if ((c->aovs || c->handles) && b->depth == 0) STAGE(aovs)(c, b);
        if (w->emits) STAGE(emission)(c, b);
        if (w->emits && c->parts) STAGE(part_emission)(c, b);
        if (b->depth >= c->max_depth && STAGE(limit)(c, b)) {
            STAGE(sort)(c, b);
            look_at_surfaces(c, b);
        }
        STAGE(random)(c, b);
        if (c->light_cdf) {
            STAGE(light)(c, b);
            STAGE(connect)(c, b);
            if (c->parts) STAGE(part_light)(c, b);
        }
        if (c->parts && b->depth == 0) STAGE(part_scatter)(c, b);
        STAGE(scatter)(c, b);
        if (w->filters) STAGE(cone_scatter)(c, b);
        STAGE(close)(c, b);
        b->depth++;
    }
}
