/* render/path/stage_clock.h: where the time of paths goes.
 *
 * A stopwatch that is read after every stage, in one batch of STAGE_CLOCK_EVERY: in the others a stage costs a branch
 * more. What is measured are shares; pass.c scales them to the time that the threads have worked. */
#ifndef KILN_RENDER_PATH_STAGE_CLOCK_H
#define KILN_RENDER_PATH_STAGE_CLOCK_H

#include "base/clock.h"
#include "kiln/render.h"

/* Has no factor in common with the number of batches of a tile, a power of two as a rule: all parts of tiles have their
 * turn. */
enum { STAGE_CLOCK_EVERY = 7 };

typedef struct stage_clock {
    uint32_t batch; /* number of the current one, modulo STAGE_CLOCK_EVERY */
    uint64_t last;  /* clock_ticks at the last reading */
    uint64_t ticks[KILN_STAGE_COUNT];
} stage_clock;

/* A batch begins. */
static inline void stage_clock_start(stage_clock *c) {
    c->batch = (c->batch + 1) % STAGE_CLOCK_EVERY;
    if (c->batch == 1) c->last = clock_ticks();
}

/* What has passed since the last reading belongs to the stage. */
static inline void stage_clock_read(stage_clock *c, kiln_stage stage) {
    if (c->batch != 1) return;
    uint64_t now = clock_ticks();
    c->ticks[stage] += now - c->last;
    c->last = now;
}

#endif
