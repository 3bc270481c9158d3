/* kiln/job.h: the whole line, from a file to pictures: import, subdivide, frame, light, render, view, write. */
#ifndef KILN_JOB_H
#define KILN_JOB_H

#include "kiln/api.h"
#include "kiln/color.h"
#include "kiln/film.h"
#include "kiln/render.h"
#include "kiln/report.h"
#include "kiln/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A set of options, and what came of them. One thread at a time may use a job; jobs are independent of each other. */
typedef struct kiln_job kiln_job;

/* What a job says while it works; every function may be NULL. All calls come from the thread that runs the job. */
typedef struct kiln_job_events {
    void (*phase)(const char *name, void *user); /* "import", "build", "render", "write", … begins */
    void (*log)(const char *line, void *user); /* what was found and decided, for people */
    void (*progress)(const kiln_progress *, void *user);
    const volatile int *cancel; /* not 0: stop soon; what was reached is written. NULL: never */
    void *user;
} kiln_job_events;

/* Returns NULL only when memory is exhausted. */
KILN_API kiln_job *kiln_job_create(void);
KILN_API void kiln_job_destroy(kiln_job *);

/* Options have the names, values and defaults of `kiln render --help`: kiln_job_set(job, "size", "640x480", report). An
 * option that may repeat ("output") adds a value with every call. */
KILN_API bool kiln_job_set(kiln_job *, const char *option, const char *value, kiln_report *);
KILN_API void kiln_job_listen(kiln_job *, const kiln_job_events *); /* copied; NULL: to nothing */

/* Renders a file and writes all outputs. Nothing is rendered when an output could not be written afterwards. When one
 * fails all the same, the others are still written, and the answer is false. */
KILN_API bool kiln_job_render(kiln_job *, const char *path, kiln_report *);

/* The same for a scene that is not yet committed: the job refines, lights and commits it, and borrows it for the call.
 * name stands for the file's, in outputs and messages. */
KILN_API bool kiln_job_render_scene(kiln_job *, kiln_scene *, const char *name, kiln_report *);

/* What is known of the last render, whether or not it succeeded. */
typedef struct kiln_job_result {
    const kiln_film *film; /* borrowed until the job's next render; NULL: it did not come to that */
    kiln_render_stats stats;
    kiln_film_error error; /* of the picture as exposed */
    double exposure;       /* stops, chosen or given */
    int exit_code;         /* of the first error; 4: none, and noise_missed; 0 */
    bool noise_missed;     /* a noise goal was set explicitly, and another rule ended the render first */
    uint32_t outputs_written;
} kiln_job_result;
KILN_API kiln_job_result kiln_job_last(const kiln_job *);

/* The same and everything else, as JSON; free(). exit_code is what a process should exit with. NULL: out of memory. */
KILN_API char *kiln_job_stats(const kiln_job *);

/* What an asset holds and what kiln would make of it, as JSON; free(). The job's options choose camera, size and
 * subdivision. Where an error was added it has no more than source, warnings, errors and exit_code. NULL: out of memory.
 */
KILN_API char *kiln_job_inspect(kiln_job *, const char *path, kiln_report *);

/* What an asset costs, as JSON; free(): times of the phases up to the first sample, samples a second, time by stage,
 * memory; with the option "embree" the replay of its rays by Embree alone, with "growth" how time and memory grow. path
 * NULL: a generated scene. Nothing is written. Where an error was added it may lack what was not measured any more. NULL:
 * out of memory. */
KILN_API char *kiln_job_bench(kiln_job *, const char *path, kiln_report *);

/* What accuracy costs in time on a scene (docs/study.md): many settings, several seeds each, into the folder that the
 * option "output" names; a study that was interrupted there goes on. JSON, as in study.json; free(). path NULL: a scene
 * that the option "preset" brings along. Where an error was added it may lack what was not measured. NULL: out of
 * memory. */
KILN_API char *kiln_job_study(kiln_job *, const char *path, kiln_report *);

/* Compares two pictures, files of any format that kiln reads, by the option "metric" or by all metrics: JSON; free().
 * What is transparent lies on black. Integers are display-referred, 0 … 1; floats are scene-linear, and taken for
 * Rec.709 by FLIP; one of each is an error. With the option "output" a map of the errors is written, as numbers or in
 * false colours. An error above "threshold" is one: KILN_CODE_DIFFERENT. NULL: out of memory. */
KILN_API char *kiln_job_compare(kiln_job *, const char *path, const char *reference, kiln_report *);

/* Writes a scene-linear picture as the view shows it: the options "output", "exposure", "view" and so on. */
KILN_API bool kiln_job_convert(kiln_job *, const char *path, kiln_report *);

/* What the machine and the libraries offer, as JSON; free(). The job's options choose the colour config. */
KILN_API char *kiln_job_info(kiln_job *, kiln_report *);

/* The steps that a program may want without the rest. */

/* Writes a film: .exr and .hdr hold the working space, .png, .jpg, .webp and .tif what view makes of it; "-" is a PNG
 * on standard output. With the AOV alpha a file has transparency: straight in PNG, WebP and TIFF, premultiplied in EXR.
 * The other AOVs become layers of an EXR file. */
KILN_API bool kiln_film_write(const kiln_film *, const kiln_color *, const kiln_view *, const char *path,
                              kiln_report *);

typedef struct kiln_framing {
    double azimuth_rad, elevation_rad; /* of the eye, around the scene: 0 looks at its front, from +Z */
    double yfov_rad;                   /* 0: 30° */
    double aspect;                     /* width / height of the picture; 0: square */
    double fit;                        /* share of the picture that the scene fills; 0: 0.85 */
} kiln_framing;

/* The nearest camera that sees all of a scene, committed or not, and has it in the middle. */
KILN_API kiln_camera kiln_camera_frame(const kiln_scene *, const kiln_framing *);

/* Lights a scene by kiln's studio: a grey backdrop, a key light from the upper left of the camera, a fill light from
 * its right, a rim light from above behind the scene. azimuth_rad: where the camera stands, as in kiln_framing. */
KILN_API bool kiln_scene_set_studio(kiln_scene *, double azimuth_rad, double intensity, kiln_report *);

#ifdef __cplusplus
}
#endif
#endif
