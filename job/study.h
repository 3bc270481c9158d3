/* job/study.h: what accuracy costs in time, on one scene: the same picture by many settings, several seeds each.
 *
 * A configuration is the user's options with a few settings changed, at some numbers of samples (levels). A row is one
 * render of one of them, with one seed. Rows are measured turn by turn, all configurations in each, so that whatever
 * else happens on the machine meets all alike, and go to DIR/rows.csv one by one: that is the journal from which an
 * interrupted study goes on. */
#ifndef KILN_JOB_STUDY_H
#define KILN_JOB_STUDY_H

#include "job/json.h"
#include "job/run.h"
#include "job/study_math.h"

enum { STUDY_LEVELS = 4 }; /* of a configuration, at most */

typedef struct study_config {
    char *name;         /* "base", "roulette=off+max-depth=8"; free() */
    const char *option; /* that varies; "" for the base */
    bool other_picture; /* it simulates something else, so it is no alternative */
    bool wrong;         /* known to be biased */
    uint32_t levels[STUDY_LEVELS], level_count; /* samples per pixel, rising */
    job_options options; /* texts, unless set for this configuration, are the base's */
} study_config;

/* What is kept of a render: identifier, column of rows.csv. Errors are of the picture as exposed, against the
 * reference, with the reference's own variance taken off. */
#define STUDY_COLUMNS(X)                                                                                               \
    X(SECONDS, "seconds")                                                                                              \
    X(CPU, "cpu_seconds")               /* of all threads */                                                           \
    X(RELMSE, "relmse")                                                                                                \
    X(TRIMMED, "relmse_trimmed")        /* without the worst thousandth of the pixels */                               \
    X(MSE, "mse")                                                                                                      \
    X(MAE, "mae")                                                                                                      \
    X(FLIP, "flip")                     /* of the pictures as displayed */                                             \
    X(FIREFLIES, "fireflies")           /* pixels brighter than the reference by five times √(r² + 0.01) */            \
    X(PREDICTED, "relmse_predicted")    /* by the film itself */                                                       \
    X(LIGHT, "light")                   /* all light over the reference's, less 1 */                                   \
    X(BIAS, "bias_squared")             /* product of two halves' relative differences: 0 in the mean without bias */  \
    X(LOST, "lost_energy")              /* by the depth limit */                                                       \
    X(CAMERA_RAYS, "camera_rays")                                                                                      \
    X(BOUNCE_RAYS, "bounce_rays")                                                                                      \
    X(SHADOW_RAYS, "shadow_rays")

typedef enum study_column {
#define STUDY_COLUMN_ENUM(id, name) STUDY_##id,
    STUDY_COLUMNS(STUDY_COLUMN_ENUM)
#undef STUDY_COLUMN_ENUM
        STUDY_STAGES, /* the first of KILN_STAGE_COUNT: seconds of threads */
    STUDY_VALUES = STUDY_STAGES + KILN_STAGE_COUNT
} study_column;

const char *study_column_name(uint32_t column); /* static; "camera rays" of a stage is "stage_camera_rays" */

typedef struct study_row {
    uint32_t config, level, seed; /* level: index; seed: number of the turn */
    double values[STUDY_VALUES]; /* NAN: unknown */
} study_row;

typedef struct study_reference {
    float *rgb;          /* in the scene's units */
    float *variance;     /* of rgb; all 0 for a file */
    float *display;      /* as the view shows it */
    double relative_variance; /* mean of variance/(r² + 0.01), as exposed */
    double seconds;      /* that making it took; 0: it was there */
    uint32_t spp, passes; /* samples of each of the passes, which are independent; 0: a file */
    char made_by[32];    /* the estimator; "" for a file */
} study_reference;

/* study_plan.c: what a preset measures. */
typedef struct study_preset study_preset;
typedef struct study_plan {
    const char *preset;
    study_config *configs; /* the first is the base */
    uint32_t config_count, seeds;
    uint32_t side;         /* the longer one, when no size was given */
    bool (*make_scene)(kiln_scene **, kiln_report *); /* when no scene is given; NULL: one must be */
} study_plan;
const study_preset *study_find_preset(const job_options *, kiln_report *); /* NULL: reported */
/* Preset and size; then, when the scene is known, the configurations. */
void study_plan_start(study_plan *, const study_preset *);
bool study_plan_fill(study_plan *, const study_preset *, const job_run *base, kiln_report *);
void study_plan_free(study_plan *);

typedef struct study {
    job_options options; /* of the base: the user's, with the size that the study has; texts are the user's */
    job_run run;         /* of the base, ready to render */
    const char *source, *folder;
    study_plan plan;
    study_reference reference;
    study_row *rows;
    uint32_t row_count, row_total;
    uint64_t cost_done, cost_total; /* in samples per pixel, for the progress */
    double started;                 /* when measuring began */
    double map_end;                 /* relative error from which on maps are brightest */
    bool resumed;
} study;

/* study_scene.c: scenes that presets bring along. */
bool study_make_interior(kiln_scene **, kiln_report *); /* indirect light nearly alone */
bool study_make_mirrors(kiln_scene **, kiln_report *);  /* mirror, glass, a lamp */

/* study_rows.c: the journal. */
char *study_path(const study *, const char *name); /* in the study's folder; free(); NULL: no memory */
bool study_read_rows(study *);  /* what a journal has of this plan; a torn last line is cut off. False: reported */
bool study_append_row(study *, const study_row *);
bool study_has_row(const study *, uint32_t config, uint32_t level, uint32_t seed);
bool study_forget_rows(study *); /* begins the journal anew */

/* study_reference.c */
bool study_make_reference(study *);
void study_free_reference(study_reference *);

/* study_measure.c: one row; pictures of it where it is the first of the highest level. */
bool study_measure(study *, uint32_t config, uint32_t level, uint32_t seed, study_row *);
/* Renders by the options of a configuration, into a film of its own that the caller destroys. */
bool study_render(study *, const job_options *, kiln_render_options *, kiln_film **, kiln_render_stats *, double *cpu);
/* Tells how far the study has come; inside: samples per pixel of the render that is under way. */
void study_tell(const study *, uint64_t inside, uint32_t spp);

/* study_json.c: everything that follows from the rows. */
json_t *study_describe(const study *);
/* The key of what was measured: options, scene, machine, version; free(). */
char *study_key(const study *);

/* study_advice.c: plain sentences that recommend settings, from the described study. */
void study_advise(const study *, json_t *description);

/* study_report.c: report.html from the description and the pictures. */
bool study_write_report(const study *, const json_t *description);

/* study.c: the whole. The run is started; *json is filled in where anything was measured. */
bool study_run(job_run *, const char *scene_file, json_t **json);

#endif
