/* render/pass.h: one sweep over the film: every pixel is brought to a number of samples, all to the same or each to its
 * own. */
#ifndef KILN_RENDER_PASS_H
#define KILN_RENDER_PASS_H

#include <stdatomic.h>

#include "render/film/film.h"
#include "render/path/path.h"

/* What a thread owns. */
typedef struct pass_worker {
    batch *batch;
    path_sample *samples;
    _Atomic uint64_t traced; /* samples; the one count that others read while the worker works */
    uint64_t busy; /* clock_ticks */
    uint64_t discarded[KILN_DISCARD_COUNT];
    uint64_t discarded_first[KILN_DISCARD_COUNT]; /* reading-order number of the first pixel */
    fixed beyond[3];
} pass_worker;

typedef struct pass {
    const path_context *context;
    path_tracer *tracer;
    kiln_film *film;
    uint32_t batch_size;
    uint64_t shuffle;  /* not 0: another order of tiles */
    uint32_t threads;
    pass_worker *workers;
    ray_tape *tapes;   /* one a thread, that keep rays; NULL: nobody wants them */

    uint64_t ticks;    /* of passes so far, in clock_ticks and in seconds */
    double seconds;

    uint32_t target;   /* samples per pixel when the pass is done */
    const uint32_t *targets; /* the same by pixel of the film; NULL: target for all */
    double deadline;   /* clock_seconds; 0: none */
    const volatile int *cancel;
    atomic_bool stopped; /* by the deadline or the cancel flag */
    void (*tick)(void *user); /* now and then, on the calling thread */
    void *tick_user;
} pass;

bool pass_make_workers(pass *); /* false: out of memory */
void pass_free_workers(pass *);

/* Brings every pixel to its target, unless stopped: then some are left where they were. */
void pass_run(pass *);

/* What the workers have done so far, in seconds of all together. Between passes. */
void pass_stage_seconds(const pass *, double seconds[KILN_STAGE_COUNT]);

uint64_t pass_samples(const pass *); /* traced so far, by all workers; exact between passes, but never torn */

#endif
