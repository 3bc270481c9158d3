/* job/camera.h: from where the picture is taken, and how large it is. */
#ifndef KILN_JOB_CAMERA_H
#define KILN_JOB_CAMERA_H

#include "job/options.h"
#include "kiln/job.h"

typedef struct job_view {
    kiln_camera camera;
    bool automatic;
    char *name; /* for output names and logs: the camera's, its number, or "auto"; free() */
    uint32_t width, height;
} job_view;

/* A camera of the scene or one that frames it, with what the options change about it. */
bool view_choose(const job_options *, const kiln_scene *, job_view *, kiln_report *);

/* Framed cameras again, after the scene has changed its shape. */
void view_reframe(const job_options *, const kiln_scene *, job_view *);

/* Where around the scene a camera stands: atan2(x, z) of the direction that it looks away from. */
double camera_azimuth(const kiln_camera *);

/* Radius of the lens for an f-stop, on a sensor 24 mm high: focal length / (2 N). */
double camera_lens_radius(double f_stop, double yfov_rad);

#endif
