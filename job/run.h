/* job/run.h: one run of a job, as steps that share what they made. The steps are called in the order of this file; each
 * returns false exactly when it added an error. Other kinds of jobs make other sequences of them. */
#ifndef KILN_JOB_RUN_H
#define KILN_JOB_RUN_H

#include "job/camera.h"
#include "job/lighting.h"
#include "job/outputs.h"
#include "job/picture.h"
#include "kiln/difference.h"
#include "kiln/import.h"

typedef struct job_phase {
    const char *name;
    double seconds;
} job_phase;

enum { JOB_PHASES_MAX = 16 };

/* The picture without some effects against the picture with them. */
typedef struct job_ablation {
    uint64_t removed; /* of those that the scene calls for; 0: nothing was compared */
    kiln_film_difference difference;
    double time;      /* of a sample, over that of one with them */
} job_ablation;

typedef struct job_run {
    const job_options *options;
    const kiln_job_events *events;
    kiln_report *report;

    job_phase phases[JOB_PHASES_MAX];
    uint32_t phase_count;
    double started, phase_started;

    char *source, *asset_name; /* the path as given; {name} */
    job_rules rules;
    kiln_color *color;
    kiln_decoding decoding;
    kiln_scene *scene;
    bool owns_scene;
    job_view view;
    kiln_subdivision_result *subdivisions; /* one per mesh */
    uint32_t subdivision_count;
    uint64_t cage_triangles; /* before subdivision, each mesh once */
    uint32_t asset_images; /* without the environment that is added */
    job_lighting lighting;
    output_plan outputs;
    kiln_film_desc film_desc;
    kiln_renderer *renderer;
    kiln_effect_plan plan; /* of the renderer; of an inspection, of one that there might be */
    kiln_renderer_memory memory;
    kiln_view *display;
    double exposure;
    bool exposure_chosen;
    kiln_film *film;
    kiln_render_stats stats;
    bool rendered;
    kiln_film_error error;
    job_ablation ablation;
    uint32_t outputs_written;
    int exit_code; /* at the end */
} job_run;

bool run_start(job_run *, const job_options *, const kiln_job_events *, const char *source, kiln_report *);
void run_free(job_run *);

/* Ends the phase before and begins the next; NULL: begins none. False when the job was cancelled: reported. */
bool run_phase(job_run *, const char *name);

/* Tells people. */
void run_log(const job_run *, const char *format, ...) KILN_PRINTF(2, 3);

/* prepare.c: a file, or a scene that is lent, becomes a committed scene, framed and lit. */
bool run_color(job_run *);  /* the config, the decoding tables, and whether the view exists */
bool run_import(job_run *); /* source; not for a scene that is lent */
bool run_camera(job_run *);
bool run_outputs(job_run *); /* names, and whether they can be written */
bool run_subdivide(job_run *);
bool run_light(job_run *);   /* and commits the scene; where emitters are the only light, run_try_emitters */

/* line.c */
bool run_film(job_run *);
bool run_build(job_run *); /* unless run_try_emitters did */
bool run_plan(job_run *);  /* what that would run, and whether its pictures can be read */
/* Looks by a quick render whether the emitters of a committed scene light what is seen; if not, puts up the studio. */
bool run_try_emitters(job_run *);
bool run_expose(job_run *);
/* The run's options as a renderer wants them. */
kiln_render_options run_render_options(const job_run *);
bool run_render(job_run *);
/* ablation.c: what --effects -NAME has changed; nothing, where it was not given. */
bool run_compare(job_run *);
kiln_renderer_options run_renderer_options(const job_run *);
/* Writes every output, whatever happened to the others. */
bool run_write(job_run *);
/* What --strict asks, at any time: false when the report has warnings. */
bool run_check_strict(job_run *);

/* Whether an explicit --noise was not reached. */
bool run_missed_noise(const job_run *);
/* What a process should exit with: that of the first error, else 4 for a noise that was not reached, else 0. */
int run_exit_code(const job_run *);

#endif
