/* job/bench.h: what a scene costs: time by phase and by stage, samples a second, memory.
 *
 * Every further measurement is a file of its own that adds a member to the JSON (bench_growth.c), called by bench. */
#ifndef KILN_JOB_BENCH_H
#define KILN_JOB_BENCH_H

#include "job/json.h"
#include "job/run.h"
#include "render/record.h"

/* Measures the run's source, or for a NULL scene_file a scene of its own making; nothing is written. The run has been
 * started; *json is filled in where that fails too, as far as it went. */
bool bench(job_run *, const char *scene_file, json_t **json);

/* bench_scene.c: a bumpy ring of about this many triangles, so often, on a table, under so many lamps, which together
 * are as bright as one; 0: none. The caller destroys the scene. */
bool bench_make_scene(uint64_t triangles, uint32_t copies, uint32_t lamps, kiln_scene **, kiln_report *);
enum { BENCH_TRIANGLES = 100000 }; /* of the one ring that stands for a scene */

/* The steps of a render up to the first ray. The run takes scene over; NULL: its source is a file. */
bool bench_prepare(job_run *, kiln_scene *scene);
/* Renders into a film of its own. tapes as in render_recorded. */
bool bench_draw(job_run *, uint32_t spp, ray_tape *tapes, kiln_render_stats *);

/* bench_embree.c: the rays of a render, and the least time in which Embree alone has traced them. */
typedef struct bench_replay {
    ray_tape *tapes; /* NULL: nothing was recorded */
    uint32_t count;
    tape_totals totals;
    uint64_t differing; /* rays that met something else than in the render */
    double seconds;     /* the least so far; 0: none */
} bench_replay;
/* plain: what the render took without being recorded. */
bool bench_record(job_run *, uint32_t spp, const kiln_render_stats *plain, bench_replay *);
void bench_replay_once(const job_run *, bench_replay *); /* where something was recorded */
void bench_replay_free(bench_replay *);
json_t *bench_replay_facts(const bench_replay *, const kiln_render_stats *plain, uint64_t samples);

/* bench_growth.c: how time and memory grow with what --growth lists. */
bool bench_check_growth(const job_options *, kiln_report *);
bool bench_growth(const job_run *, const char *scene_file, json_t **rows);

#endif
