#include "render/path/medium.h"
#include "render/path/stages.h"

/* A camera in a dispersive medium: its paths have a wavelength from the start. */
static void disperse(const path_context *c, batch *b) {
    path_state *s = batch_state(b);
    const world_medium *m = &c->world->media[medium_top(c->media)];
    if (!(m->spread > 0.0f)) return;
    for (uint32_t i = 0; i < b->n; i++) {
        spectrum_line line = path_wavelength(c, (sample_point){s->index[i], s->seed[i]});
        float n = medium_ior(m, line.wavelength), alive = s->tr[i] > 0.0f ? 1.0f / (n * n) : 0.0f;
        s->tr[i] = alive * line.weight.x, s->tg[i] = alive * line.weight.y, s->tb[i] = alive * line.weight.z;
        s->squeeze[i] = n * n;
        s->slot[i] |= SLOT_DISPERSED;
    }
}

/* lens: a constant; where it is 0, no numbers are drawn for a place on it. */
KERNEL void start_rays(int lens, const path_context *c, batch *b) {
    path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    float across = 2.0f / (float)(int32_t)c->width, down = 2.0f / (float)(int32_t)c->height;
    int independent = c->independent;
    const camera *cam = &c->camera;
    const pixel_filter *filter = &c->filter;
    uint64_t media = c->media;
    float squeeze = c->squeeze;
    LANE_LOOP (uint32_t i = 0; i < b->n; i++) {
        sample_point p = {s->index[i], s->seed[i]};
        vec2 pixel = sample_pair(independent, p, SAMPLE_PIXEL, 0);
        float px = x->px[i] + 0.5f + pixel_filter_offset(filter, pixel.x);
        float py = x->py[i] + 0.5f + pixel_filter_offset(filter, pixel.y);
        float u = px * across - 1.0f, v = 1.0f - py * down;
        camera_ray r = lens ? camera_ray_at(cam, u, v, sample_pair(independent, p, SAMPLE_LENS, 0))
                            : camera_ray_of_pinhole(cam, u, v);
        s->ox[i] = r.origin.x, s->oy[i] = r.origin.y, s->oz[i] = r.origin.z;
        s->dx[i] = r.direction.x, s->dy[i] = r.direction.y, s->dz[i] = r.direction.z;
        x->tnear[i] = r.near;
        x->tfar[i] = r.far;
        float alive = s->slot[i] == SLOT_NOWHERE ? 0.0f : 1.0f / squeeze;
        s->tr[i] = s->tg[i] = s->tb[i] = alive;
        s->lr[i] = s->lg[i] = s->lb[i] = 0.0f;
        s->pdf[i] = 0.0f;
        s->squeeze[i] = squeeze;
        s->media[i] = media;
    }
}

void STAGE(camera)(const path_context *c, const path_sample *samples, uint32_t count, batch *b) {
    path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    b->n = lanes_round_up(count);
    b->depth = 0;
    if (c->parts) parts_begin(c->parts, b->parts, count);
    for (uint32_t i = 0; i < b->n; i++) {
        const path_sample *sample = &samples[i < count ? i : 0];
        sample_point p = sample_point_make(c->seed, sample->y << 16 | sample->x, sample->n);
        s->slot[i] = i < count && !sample->idle ? i : SLOT_NOWHERE;
        s->seed[i] = p.seed;
        s->index[i] = p.index;
        b->out.refused[s->slot[i]] = 0;
        b->out.beyond_r[s->slot[i]] = b->out.beyond_g[s->slot[i]] = b->out.beyond_b[s->slot[i]] = 0.0f;
        x->px[i] = (float)(int32_t)sample->x;
        x->py[i] = (float)(int32_t)sample->y;
    }
    if (HAS(c->effects, THIN_LENS)) start_rays(1, c, b);
    else start_rays(0, c, b);
    disperse(c, b);
    for (uint32_t i = 0; HAS(c->effects, SOLIDS) && i < b->n; i++) s->events[i] = 0;
}
