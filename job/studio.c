/* The built-in light: a photographer's table set-up as a latitude-longitude picture. It turns with the camera, so that
 * what the camera sees behind the scene is always the plain backdrop, never a lamp. */
#include <math.h>
#include <stdlib.h>

#include "base/arena.h"
#include "base/mat.h"
#include "base/report.h"
#include "kiln/job.h"

/* 0.7° a texel: a third of the softest edge. */
enum { WIDTH = 512, HEIGHT = 256 };

/* A soft box: a rounded rectangle on the plane at distance 1 in its direction. Angles as in kiln_framing, in degrees,
 * for a camera at azimuth 0. */
typedef struct box {
    double azimuth, elevation;
    double half_width, half_height, edge; /* tangents */
    double radiance;
} box;

/* A grey card that faces the camera is as bright as under a uniform light of 1, so that base colours come out as
 * authored; turned to the key light it has 1.3 times that, turned away nearly 0.6 (tests/job/test_studio.c). */
static const box boxes[] = {
    {-45, 36, 0.50, 0.45, 0.10, 3.2},  /* key */
    {62, 15, 0.40, 0.70, 0.20, 1.0},   /* fill */
    {160, 55, 0.70, 0.16, 0.10, 2.8},  /* rim, from behind */
    {0, 88, 0.50, 0.50, 0.25, 0.5},    /* overhead */
};

static double smooth_step(double from, double to, double x) {
    double t = (x - from) / (to - from);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return t * t * (3 - 2 * t);
}

/* Paper behind the scene, as wide as a camera of 60° sees: more than a stop below white, so that white things
 * stand out, and far enough above black, with a glow at the horizon. */
static double paper(double height) {
    return height > 0 ? 0.45 - 0.15 * smooth_step(0, 0.9, height) : 0.45 - 0.10 * smooth_step(0, 0.6, -height);
}

/* White boards beside it, out of the picture, give back what it takes from the light, and edges their shine. */
static double boards(double height) {
    return height > 0 ? 1.3 - 1.0 * smooth_step(0, 0.9, height) : 1.3 - 0.72 * smooth_step(0, 0.9, -height);
}

/* Both behind the scene, a dim room behind the camera. */
static double room(dvec3 d) {
    double behind = smooth_step(-0.5, 0.6, -d.z), height = d.y, aside = smooth_step(0.6, 0.9, fabs(d.x));
    double wall = paper(height) + (boards(height) - paper(height)) * aside;
    double hall = height > 0 ? 0.24 : 0.24 + 0.40 * smooth_step(0, 0.7, -height);
    return hall + (wall - hall) * behind;
}

/* 1 within the box, 0 outside, over `edge` in between. */
static double cover(const box *b, dvec3 d) {
    double az = b->azimuth * M_PI / 180, el = b->elevation * M_PI / 180;
    dvec3 at = {sin(az) * cos(el), sin(el), cos(az) * cos(el)}, right = {cos(az), 0, -sin(az)},
          up = d3_cross(at, right);
    double along = d3_dot(d, at);
    if (!(along > 0)) return 0;
    double x = fabs(d3_dot(d, right) / along) - b->half_width, y = fabs(d3_dot(d, up) / along) - b->half_height;
    double outside = x > 0 && y > 0 ? sqrt(x * x + y * y) : x > y ? x : y;
    return smooth_step(b->edge, 0, outside);
}

static double radiance(dvec3 d) {
    double sum = room(d);
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; i++) sum += boxes[i].radiance * cover(&boxes[i], d);
    return sum;
}

bool kiln_scene_set_studio(kiln_scene *scene, double azimuth_rad, double intensity, kiln_report *report) {
    float *pixels = array_alloc((size_t)WIDTH * HEIGHT, 3 * sizeof *pixels);
    if (!pixels) return report_no_memory(report, "making the studio");
    for (size_t y = 0; y < HEIGHT; y++)
        for (size_t x = 0; x < WIDTH; x++) {
            double phi = ((double)x + 0.5) / WIDTH * 2 * M_PI - M_PI, theta = ((double)y + 0.5) / HEIGHT * M_PI;
            double value = radiance((dvec3){sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi)});
            for (size_t k = 0; k < 3; k++) pixels[(y * WIDTH + x) * 3 + k] = (float)value;
        }
    kiln_image_desc image = {.name = "studio", .pixels = pixels, .width = WIDTH, .height = HEIGHT, .channels = 3,
                             .format = KILN_PIXELS_F32, .release = free, .release_user = pixels};
    kiln_environment environment = {.transfer = KILN_TRANSFER_LINEAR, .rotation_rad = azimuth_rad};
    for (int k = 0; k < 3; k++) environment.color[k] = (float)intensity;
    return kiln_scene_add_image(scene, &image, &environment.image, report) &&
           kiln_scene_set_environment(scene, &environment, report);
}
