#include "render/pass.h"

#include <stdlib.h>

#include "base/arena.h"
#include "base/clock.h"
#include "base/denormals.h"
#include "base/threads.h"

/* Small enough that its pixels stay coherent, large enough to fill a batch at one sample a pixel. */
enum { TILE = 32, BLOCK = 4 };

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

/* What the sample says of the first surface. */
static void read_surface(const path_output *o, uint32_t i, film_sample *s) {
    s->depth = o->depth[i];
    s->object = o->object[i], s->material = o->material[i];
    for (int k = 0; k < 2; k++) s->uv[k] = o->uv[k][i];
    for (int k = 0; k < 3; k++)
        s->albedo[k] = o->albedo[k][i], s->normal[k] = o->normal[k][i], s->position[k] = o->position[k][i];
}

static void add_beyond(pass_worker *w, uint32_t i) {
    const path_output *o = &w->batch->out;
    const float beyond[3] = {o->beyond_r[i], o->beyond_g[i], o->beyond_b[i]};
    if (beyond[0] == 0.0f && beyond[1] == 0.0f && beyond[2] == 0.0f) return; /* as most are */
    for (int k = 0; k < 3; k++)
        if (fixed_fits(beyond[k])) w->beyond[k] += fixed_from_float(beyond[k]);
}

/* Into the film; returns how many samples that were. */
static uint32_t store(const pass *p, pass_worker *w, uint32_t count) {
    const path_output *o = &w->batch->out;
    const path_context *c = p->context;
    const uint32_t *crop = p->film->desc.crop;
    uint32_t stored = 0;
    for (uint32_t i = 0; i < count; i++) {
        const path_sample *at = &w->samples[i];
        if (at->idle) continue;
        stored++;
        film_sample s = {.radiance = {o->r[i], o->g[i], o->b[i]}, .alpha = o->alpha[i]};
        if (c->aovs || c->handles) read_surface(o, i, &s);
        if (c->parts) s.parts = w->batch->parts->sums + (size_t)i * c->parts->count;
        if (o->refused[i]) discard(p, w, KILN_DISCARD_RAY, at);
        check_radiance(p, w, at, &s);
        if ((c->aovs || c->handles) && s.alpha > 0.0f) check_aovs(p, w, at, &s);
        film_add(p->film, at->x - crop[0], at->y - crop[1], &s);
        add_beyond(w, i);
    }
    atomic_fetch_add_explicit(&w->traced, stored, memory_order_relaxed);
    return stored;
}

static bool must_stop(pass *p, uint32_t thread) {
    if (thread == 0 && p->tick) p->tick(p->tick_user);
    bool cancelled = p->cancel && __atomic_load_n(p->cancel, __ATOMIC_RELAXED);
    if (cancelled || (p->deadline > 0 && clock_seconds() >= p->deadline)) atomic_store(&p->stopped, true);
    return atomic_load(&p->stopped);
}

/* Tiles are aligned with the picture, not with the crop, in whole blocks of pixels. */
static uint32_t tiles_origin(const kiln_film *f, int axis) { return f->desc.crop[axis] / BLOCK * BLOCK; }
static uint32_t tiles_across(const kiln_film *f) { return (f->desc.crop[2] - tiles_origin(f, 0) + TILE - 1) / TILE; }
static uint32_t tiles_down(const kiln_film *f) { return (f->desc.crop[3] - tiles_origin(f, 1) + TILE - 1) / TILE; }

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

/* A tile under way. */
typedef struct tile {
    pass *pass;
    uint32_t thread, x, y;
    uint32_t count; /* samples that wait for a batch to be full */
} tile;

/* The samples that wait, unless it is time to stop: then false. */
static bool trace(tile *t) {
    pass *p = t->pass;
    pass_worker *w = &p->workers[t->thread];
    batch *b = w->batch;
    if (must_stop(p, t->thread)) return false;
    ray_tape *tape = p->tapes ? tape_begin(&p->tapes[t->thread]) : NULL;
    b->camera_rays.tape = b->bounce_rays.tape = b->shadow_rays.tape = tape;
    stage_clock_start(&b->clock);
    p->tracer(p->context, w->samples, t->count, b);
    uint32_t stored = store(p, w, t->count);
    if (tape) tape_end(tape, stored);
    stage_clock_read(&b->clock, KILN_STAGE_FILM);
    t->count = 0;
    return true;
}

/* Even bits of a Morton number: neighbours in it are neighbours in the tile. */
static uint32_t even_bits(uint32_t m) {
    m &= 0x55555555u;
    m = (m | m >> 1) & 0x33333333u;
    m = (m | m >> 2) & 0x0f0f0f0fu;
    return (m | m >> 4) & 0x00ff00ffu;
}

/* The pixel of that Morton number in the tile; does the film hold it, and where? */
static bool find_pixel(const tile *t, uint32_t morton, path_sample *s, size_t *at) {
    const kiln_film *f = t->pass->film;
    s->x = t->x + even_bits(morton), s->y = t->y + even_bits(morton >> 1);
    uint32_t x = s->x - f->desc.crop[0], y = s->y - f->desc.crop[1]; /* huge to the left and above */
    *at = (size_t)y * f->width + x;
    return x < f->width && y < f->height;
}

static uint32_t target_of(const pass *p, size_t at) { return p->targets ? p->targets[at] : p->target; }

/* Of some pixels in a row: the fewest samples that one has, and the most that one is to have; of none, nothing. */
typedef struct demand { uint32_t fewest, most; } demand;

static demand demand_of(const tile *t, uint32_t morton, uint32_t pixels) {
    demand d = {UINT32_MAX, 0};
    for (uint32_t m = morton; m < morton + pixels; m++) {
        path_sample s;
        size_t at;
        if (!find_pixel(t, m, &s, &at)) continue;
        uint32_t count = t->pass->film->counts[at], target = target_of(t->pass, at);
        d.fewest = count < d.fewest ? count : d.fewest;
        d.most = target > d.most ? target : d.most;
    }
    return d;
}

/* LANE_GROUP samples, from the n-th on, of so many pixels. Those that are not to be had, off the film or there already,
 * are idle. false: it is time to stop. */
static bool add_packet(tile *t, uint32_t morton, uint32_t pixels, uint32_t n) {
    const pass *p = t->pass;
    uint32_t each = LANE_GROUP / pixels;
    for (uint32_t m = morton; m < morton + pixels; m++) {
        path_sample s;
        size_t at;
        bool held = find_pixel(t, m, &s, &at);
        for (uint32_t k = n; k < n + each; k++) {
            s.n = k;
            s.idle = !held || k >= target_of(p, at) || k < p->film->counts[at];
            p->workers[t->thread].samples[t->count++] = s;
        }
    }
    return t->count < p->batch_size || trace(t);
}

/* Camera rays run in packets of which Embree makes one beam, so what a packet holds must not depend on how a picture is
 * shared out: the first FIRST samples stand side by side with those of a block of pixels, so that no lane is idle in a
 * picture of one sample; later ones in FOURs, with those of a quarter of it, which makes for a narrower beam. */
static void trace_tile(pass *p, size_t item, uint32_t thread) {
    enum { FIRST = 4, PIXELS = BLOCK * BLOCK, QUARTER = PIXELS / 4, EACH = LANE_GROUP / QUARTER };
    size_t number = shuffled(p, item), across = tiles_across(p->film);
    tile t = {.pass = p, .thread = thread,
              .x = tiles_origin(p->film, 0) + (uint32_t)(number % across) * TILE,
              .y = tiles_origin(p->film, 1) + (uint32_t)(number / across) * TILE};
    for (uint32_t m = 0; m < TILE * TILE; m += PIXELS) {
        demand d = demand_of(&t, m, PIXELS);
        for (uint32_t n = d.fewest; n < d.most && n < FIRST; n++)
            if (!add_packet(&t, m, PIXELS, n)) return;
        for (uint32_t q = m; q < m + PIXELS; q += QUARTER) {
            d = demand_of(&t, q, QUARTER);
            for (uint32_t n = d.fewest < FIRST ? FIRST : d.fewest / EACH * EACH; n < d.most; n += EACH)
                if (!add_packet(&t, q, QUARTER, n)) return;
        }
    }
    if (t.count) (void)trace(&t);
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
