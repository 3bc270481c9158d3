/* job/options.h: what a user can ask of a job. options_table.c has one row for each field; zero-initialised options are
 * not the defaults: call job_options_init. */
#ifndef KILN_JOB_OPTIONS_H
#define KILN_JOB_OPTIONS_H

#include "job/layers.h"
#include "job/option.h"
#include "kiln/compare.h"
#include "kiln/import.h"
#include "kiln/render.h"

typedef struct job_filter {
    kiln_pixel_filter kind;
    double width; /* diameter in pixels */
} job_filter;

typedef struct job_background {
    kiln_background kind;
    uint8_t rgb[3]; /* COLOR: as the display shows it */
} job_background;

typedef struct job_subdivision {
    kiln_subdivide_mode mode;
    uint32_t level;
} job_subdivision;

typedef struct job_orbit { double azimuth_deg, elevation_deg; } job_orbit;

typedef struct job_options {
    kiln_arena arena; /* of all texts */
    uint64_t given;   /* rows of job_option_table that were set */

    option_list outputs;
    uint32_t size[2]; /* 0: not given */
    uint32_t crop[4]; /* all 0: the whole picture */
    uint32_t spp;     /* 0: no such rule; job_rules makes the defaults of these three */
    double noise_percent;  /* 0: off */
    double budget_seconds; /* 0: none */
    uint64_t seed;
    uint32_t threads; /* 0: all */
    uint32_t max_depth;
    job_filter filter;
    kiln_estimator estimator;
    kiln_roulette roulette;
    kiln_sampler sampler;
    kiln_adaptive adaptive;
    kiln_light_sampling light_sampling;
    kiln_texture_filter texture_filter;
    const char *camera;
    job_orbit orbit;
    double fov_deg, frame_fit;
    double aperture; /* f-stop; 0: pinhole */
    double focus;    /* metres; 0: what the middle of the picture sees */
    uint32_t blades;
    const char *env;
    double env_rotate_deg, env_intensity;
    job_background background;
    job_subdivision subdivide;
    kiln_scheme scheme;
    double crease_angle_deg;
    job_layers layers;
    double exposure;
    const char *display, *view, *look, *ocio, *working_space;
    kiln_effects effects;
    bool allow_outside;
    const char *embree_config, *stats;
    bool strict;
    bool embree;        /* of kiln bench: replay the rays by Embree alone */
    const char *growth; /* of kiln bench: what varies; NULL: nothing */
    kiln_metric metric; /* of kiln color */
    double threshold;
    const char *preset, *reference; /* of kiln study; reference NULL: it makes its own */
} job_options;

/* What option_row.also and .except mean here. */
enum { JOB_INSPECT = 1, JOB_INFO = 2, JOB_BENCH = 4, JOB_RENDER = 8, JOB_COLOR = 16, JOB_STUDY = 32 };

extern const option_table job_option_table;

bool job_options_init(job_options *, kiln_report *);
void job_options_free(job_options *);

/* where: NULL stands for the option itself, "--size". */
bool job_options_set(job_options *, const char *name, const char *text, const kiln_where *, kiln_report *);

#define job_given(options, field) option_given(&job_option_table, (options)->given, offsetof(job_options, field))

/* The rules that end a render. */
typedef struct job_rules {
    uint32_t spp;
    double noise; /* a share, 0.03 */
    double budget_seconds;
} job_rules;

/* Giving any rule replaces the defaults of all. False: no rule is left that would end the render. */
bool job_rules_choose(const job_options *, job_rules *, kiln_report *);

/* Kinds of single options; option_values.c. */
extern const option_kind option_size, option_crop, option_percent, option_duration, option_filter, option_roulette,
    option_orbit, option_focus, option_background, option_subdivide, option_embree,
    option_effects;

/* What is wrong with a text that option_effects refused. */
void option_explain_effects(const char *text, kiln_text *remedy);

#endif
