/* job/lighting.h: what lights the scene: its own lights, a picture, or kiln's studio. */
#ifndef KILN_JOB_LIGHTING_H
#define KILN_JOB_LIGHTING_H

#include "job/options.h"
#include "kiln/job.h"

typedef enum job_light { JOB_LIGHT_SCENE, JOB_LIGHT_FILE, JOB_LIGHT_STUDIO, JOB_LIGHT_NONE } job_light;

typedef struct job_lighting {
    job_light kind;      /* of the surroundings; SCENE: as the scene has them, or none beside its lights */
    bool punctual;       /* the scene has lights in candela or lux */
    bool emissive;       /* some visible material shines brighter than white paper: it may be a light */
    bool doubtful;       /* SCENE, with nothing but such a material: whether it lights what is seen must be tried */
    bool dim;            /* it was tried, and does not */
} job_lighting;

/* "studio", "royal.hdr", "the scene's own": for logs. */
const char *lighting_describe(const job_lighting *, const job_options *);

/* Looks at an uncommitted scene. Tail lights do not light a car: where the outcome is doubtful, run_light tries it. */
job_lighting lighting_choose(const job_options *, const kiln_scene *);

/* Does what was chosen to the scene. The studio turns with the camera. */
bool lighting_apply(const job_lighting *, const job_options *, const kiln_camera *, kiln_scene *, kiln_report *);

#endif
