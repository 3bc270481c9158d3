#include "render/pass.h"

#include <stdlib.h>

#include "base/arena.h"
#include "base/clock.h"
#include "base/denormals.h"
#include "base/threads.h"

/* Small enough that its pixels stay coherent, large enough to fill a batch at one sample a pixel. */
enum { TILE = 32 };

bool pass_make_workers(pass *p) {
    p->workers = array_alloc(p->threads, sizeof *p->workers);
    for (uint32_t t = 0; p->workers && t < p->threads; t++) {
        pass_worker *w = &p->workers[t];
        w->batch = aligned_array(1, sizeof *w->batch);
        w->samples = array_alloc(BATCH_PATHS, sizeof *w->samples);
        if (w->batch && p->context->parts) {
            w->batch->parts = aligned_array(1, path_parts_bytes(p->context->parts));
            if (!w->batch->parts) return false;
        }
        for (int d = 0; d < KILN_DISCARD_COUNT; d++) w->discarded_first[d] = UINT64_MAX;
        if (!w->batch || !w->samples) return false;
    }
    return p->workers != NULL;
}

void pass_free_workers(pass *p) {
    for (uint32_t t = 0; p->workers && t < p->threads; t++) {
        if (p->workers[t].batch) free(p->workers[t].batch->parts);
        free(p->workers[t].batch);
        free(p->workers[t].samples);
    }
    free(p->workers);
    p->workers = NULL;
}

uint64_t pass_samples(const pass *p) {
    uint64_t sum = 0;
    for (uint32_t t = 0; t < p->threads; t++) sum += atomic_load_explicit(&p->workers[t].traced, memory_order_relaxed);
    return sum;
}

static void discard(const pass *p, pass_worker *w, kiln_discard cause, const path_sample *s) {
    uint64_t place = (uint64_t)s->y * p->context->width + s->x;
    w->discarded[cause]++;
    if (place < w->discarded_first[cause]) w->discarded_first[cause] = place;
}

/* A radiance that the film can hold; what is not one is counted and black, and so are its parts. */
static void check_radiance(const pass *p, pass_worker *w, const path_sample *at, film_sample *s) {
    bool fits = true, real = true;
    for (int k = 0; k < 3; k++) {
        real = real && s->radiance[k] >= 0.0f && s->radiance[k] < INFINITY;
        fits = fits && fixed_fits(s->radiance[k]);
    }
    if (real && fits) return;
    discard(p, w, real ? KILN_DISCARD_OVERFLOW : KILN_DISCARD_RADIANCE, at);
    s->radiance[0] = s->radiance[1] = s->radiance[2] = 0.0f;
    s->parts = NULL;
}

/* The same for what else it says of the first surface. */
static void check_aovs(const pass *p, pass_worker *w, const path_sample *at, film_sample *s) {
    const fixed *const *held = (const fixed *const *)p->film->aovs;
    bool fits = !held[KILN_AOV_DEPTH] || fixed_fits(s->depth);
    fits = fits && (!held[KILN_AOV_UV] || (fixed_fits(s->uv[0]) && fixed_fits(s->uv[1])));
    for (int k = 0; k < 3; k++)
        fits = fits && fixed_fits(s->albedo[k]) && fixed_fits(s->normal[k]) &&
               (!held[KILN_AOV_POSITION] || fixed_fits(s->position[k]));
    if (fits) return;
    discard(p, w, KILN_DISCARD_OVERFLOW, at);
    s->depth = 0.0f;
    s->uv[0] = s->uv[1] = 0.0f;
    for (int k = 0; k < 3; k++) s->albedo[k] = s->normal[k] = s->position[k] = 0.0f;
}

static void store(const pass *p, pass_worker *w, uint32_t count) {
    const path_output *o = &w->batch->out;
    const uint32_t *crop = p->film->desc.crop;
    for (uint32_t i = 0; i < count; i++) {
        const path_sample *at = &w->samples[i];
        film_sample s = {.radiance = {o->r[i], o->g[i], o->b[i]}, .alpha = o->alpha[i], .depth = o->depth[i],
                         .uv = {o->uv[0][i], o->uv[1][i]}, .object = o->object[i], .material = o->material[i]};
        for (int k = 0; k < 3; k++)
            s.albedo[k] = o->albedo[k][i], s.normal[k] = o->normal[k][i], s.position[k] = o->position[k][i];
        if (p->context->parts) s.parts = w->batch->parts->sums + (size_t)i * p->context->parts->count;
        if (o->refused[i]) discard(p, w, KILN_DISCARD_RAY, at);
        check_radiance(p, w, at, &s);
        if (s.alpha > 0.0f) check_aovs(p, w, at, &s);
        film_add(p->film, at->x - crop[0], at->y - crop[1], &s);
        const float beyond[3] = {o->beyond_r[i], o->beyond_g[i], o->beyond_b[i]};
        for (int k = 0; k < 3; k++)
            if (fixed_fits(beyond[k])) w->beyond[k] += fixed_from_float(beyond[k]);
    }
    atomic_fetch_add_explicit(&w->traced, count, memory_order_relaxed);
}

static bool must_stop(pass *p, uint32_t thread) {
    if (thread == 0 && p->tick) p->tick(p->tick_user);
    bool cancelled = p->cancel && __atomic_load_n(p->cancel, __ATOMIC_RELAXED);
    if (cancelled || (p->deadline > 0 && clock_seconds() >= p->deadline)) atomic_store(&p->stopped, true);
    return atomic_load(&p->stopped);
}

static void trace(pass *p, uint32_t thread, uint32_t count) {
    pass_worker *w = &p->workers[thread];
    batch *b = w->batch;
    ray_tape *tape = p->tapes ? tape_begin(&p->tapes[thread]) : NULL;
    b->camera_rays.tape = b->bounce_rays.tape = b->shadow_rays.tape = tape;
    stage_clock_start(&b->clock);
    p->tracer(p->context, w->samples, count, b);
    if (tape) tape_end(tape, count);
    store(p, w, count);
    stage_clock_read(&b->clock, KILN_STAGE_FILM);
}

/* Even bits of a Morton number: neighbours in it are neighbours in the tile. */
static uint32_t even_bits(uint32_t m) {
    m &= 0x55555555u;
    m = (m | m >> 1) & 0x33333333u;
    m = (m | m >> 2) & 0x0f0f0f0fu;
    return (m | m >> 4) & 0x00ff00ffu;
}

static uint32_t tiles_across(const kiln_film *f) { return (f->width + TILE - 1) / TILE; }
static uint32_t tiles_down(const kiln_film *f) { return (f->height + TILE - 1) / TILE; }

/* A permutation of the tiles: step through them by a number that has no factor in common with their count. */
static size_t shuffled(const pass *p, size_t tile) {
    size_t count = (size_t)tiles_across(p->film) * tiles_down(p->film);
    if (!p->shuffle) return tile;
    size_t step = (size_t)(p->shuffle % count) | 1, a = step, b = count;
    while (b) { /* Euclid */
        size_t rest = a % b;
        a = b;
        b = rest;
    }
    return a == 1 ? (tile * step + (size_t)(p->shuffle >> 32) % count) % count : count - 1 - tile;
}

static void trace_tile(pass *p, size_t item, uint32_t thread) {
    const kiln_film *f = p->film;
    size_t tile = shuffled(p, item);
    uint32_t x0 = (uint32_t)(tile % tiles_across(f)) * TILE, y0 = (uint32_t)(tile / tiles_across(f)) * TILE, count = 0;
    path_sample *samples = p->workers[thread].samples;
    for (uint32_t m = 0; m < TILE * TILE; m++) {
        uint32_t x = x0 + even_bits(m), y = y0 + even_bits(m >> 1);
        if (x >= f->width || y >= f->height) continue;
        uint32_t n = f->counts[(size_t)y * f->width + x];
        for (; n < p->target; n++) {
            samples[count++] = (path_sample){x + f->desc.crop[0], y + f->desc.crop[1], n};
            if (count < p->batch_size) continue;
            if (must_stop(p, thread)) return;
            trace(p, thread, count);
            count = 0;
        }
    }
    if (count && !must_stop(p, thread)) trace(p, thread, count);
}

static void run_tile(void *context, size_t item, uint32_t thread) {
    pass *p = context;
    uint64_t began = clock_ticks();
    (void)denormals_flush(); /* this worker's */
    trace_tile(p, item, thread);
    p->workers[thread].busy += clock_ticks() - began;
}

void pass_run(pass *p) {
    unsigned before = denormals_flush();
    uint64_t ticks = clock_ticks();
    double seconds = clock_seconds();
    threads_for(p->threads, (size_t)tiles_across(p->film) * tiles_down(p->film), run_tile, p);
    p->ticks += clock_ticks() - ticks;
    p->seconds += clock_seconds() - seconds;
    denormals_restore(before); /* the calling thread's */
}

void pass_stage_seconds(const pass *p, double seconds[KILN_STAGE_COUNT]) {
    double sampled = 0, busy = 0;
    for (int s = 0; s < KILN_STAGE_COUNT; s++) {
        seconds[s] = 0;
        for (uint32_t t = 0; t < p->threads; t++) seconds[s] += (double)p->workers[t].batch->clock.ticks[s];
        sampled += seconds[s];
    }
    for (uint32_t t = 0; t < p->threads; t++) busy += (double)p->workers[t].busy;
    double scale = sampled > 0 ? busy / sampled * p->seconds / (double)p->ticks : 0;
    for (int s = 0; s < KILN_STAGE_COUNT; s++) seconds[s] *= scale;
}
