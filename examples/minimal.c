/* Renders a glTF file to a PNG, step by step: minimal car.glb car.png
 *
 * The same in two calls: kiln_job_set(job, "output", "car.png", report) and kiln_job_render(job, "car.glb", report). */
#include <kiln/kiln.h>

#include <stdio.h>

enum { SIDE = 320 };

/* Every step returns false when it added an error to the report. */
static bool draw(const char *asset, const char *picture, kiln_report *report) {
    kiln_scene *scene;
    if (!kiln_import(asset, NULL, &scene, report)) return false;
    kiln_renderer *renderer = NULL;
    kiln_film *film = NULL;
    kiln_color *color = NULL;
    kiln_view *view = NULL;
    kiln_framing framing = {.azimuth_rad = 0.5, .elevation_rad = 0.25};
    kiln_camera camera = kiln_camera_frame(scene, &framing);
    kiln_subdivide_options subdivide = {.camera = &camera, .width = SIDE, .height = SIDE};
    bool done = kiln_subdivide(scene, &subdivide, NULL, NULL, report) &&
                kiln_scene_set_studio(scene, framing.azimuth_rad, 1, report) && kiln_scene_commit(scene, report) &&
                kiln_renderer_create(scene, NULL, &renderer, report) &&
                kiln_film_create(&(kiln_film_desc){.width = SIDE, .height = SIDE}, &film, report) &&
                kiln_render(renderer, &(kiln_render_options){.camera = &camera, .spp = 32}, film, NULL, report) &&
                kiln_color_create(NULL, &color, report) && kiln_view_create(color, NULL, &view, report) &&
                kiln_film_write(film, color, view, picture, report);
    kiln_view_destroy(view);
    kiln_color_destroy(color);
    kiln_film_destroy(film);
    kiln_renderer_destroy(renderer);
    kiln_scene_destroy(scene);
    return done;
}

int main(int argc, char **argv) {
    if (argc != 3) return fprintf(stderr, "usage: %s car.glb car.png\n", argv[0]), 2;
    kiln_report *report = kiln_report_create();
    bool done = report && draw(argv[1], argv[2], report);
    for (size_t i = 0; report && i < kiln_report_size(report); i++) {
        kiln_message m = kiln_report_message(report, i);
        fprintf(stderr, "%s: %s; %s\n", m.where, m.what, m.remedy);
    }
    kiln_report_destroy(report);
    return done ? 0 : 1;
}
