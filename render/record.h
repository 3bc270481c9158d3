/* render/record.h: for benchmarks: a render whose rays are kept, and traced again by Embree alone. */
#ifndef KILN_RENDER_RECORD_H
#define KILN_RENDER_RECORD_H

#include "kiln/render.h"
#include "render/accel/tape.h"

/* kiln_render, with a tape for each thread of the renderer: renderer_threads of them. NULL: none. */
bool render_recorded(const kiln_renderer *, const kiln_render_options *, kiln_film *, ray_tape *tapes,
                     kiln_render_stats *, kiln_report *);

/* Threads of a render. */
uint32_t renderer_threads(const kiln_renderer *);

/* tapes_replay, tapes_compare for a renderer's tapes. */
double renderer_replay(const kiln_renderer *, const ray_tape *);
uint64_t renderer_compare(const kiln_renderer *, const ray_tape *);

#endif
