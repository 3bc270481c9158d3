/* Every real glTF file that the importer takes renders without another warning, a discarded sample or a value that is not
 * finite: at 64 x 64, from a camera of its own or one that frames it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/mat.h"
#include "kiln/import.h"
#include "kiln/render.h"
#include "tests/assets.h"
#include "tests/golden/golden.h"

enum { SIDE = 64 };

/* From the side and above, far enough to see all of the bounds. */
static kiln_camera frame(kiln_bounds b) {
    kiln_camera c = kiln_camera_default();
    if (!(b.min[0] <= b.max[0])) return c; /* a file without triangles */
    dvec3 low = d3_load(b.min), high = d3_load(b.max), middle = d3_scale(d3_add(low, high), 0.5);
    double radius = fmax(0.5 * d3_length(d3_sub(high, low)), 1e-3);
    dvec3 z = d3_normalize((dvec3){0.6, 0.35, 1}), x = d3_normalize(d3_cross((dvec3){0, 1, 0}, z)), y = d3_cross(z, x);
    dvec3 eye = d3_add(middle, d3_scale(z, 3.2 * radius));
    const double m[16] = {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, eye.x, eye.y, eye.z, 1};
    memcpy(c.transform, m, sizeof m);
    return c;
}

static bool draw(kiln_scene *scene, kiln_film *film, kiln_render_stats *stats, kiln_report *report) {
    kiln_environment sky = {.color = {0.5f, 0.5f, 0.5f}};
    kiln_renderer *renderer = NULL;
    bool done = kiln_scene_set_environment(scene, &sky, report) &&
                kiln_subdivide(scene, &(kiln_subdivide_options){.width = SIDE, .height = SIDE}, NULL, NULL, report) &&
                kiln_scene_commit(scene, report) && kiln_renderer_create(scene, NULL, &renderer, report);
    if (!done) return false;
    kiln_camera framed = frame(kiln_scene_bounds(scene));
    const kiln_camera *own = kiln_scene_camera(scene, 1);
    done = kiln_render(renderer, &(kiln_render_options){.camera = own ? own : &framed, .spp = 4}, film, stats, report);
    kiln_renderer_destroy(renderer);
    return done;
}

static void describe_picture(const kiln_film *film, const kiln_render_stats *stats, kiln_text *out) {
    float *rgb = malloc(sizeof(float[3]) * SIDE * SIDE), *alpha = malloc(sizeof(float) * SIDE * SIDE);
    double covered = 0;
    bool finite = true;
    kiln_film_beauty(film, rgb);
    kiln_film_aov(film, KILN_AOV_ALPHA, alpha);
    for (int i = 0; i < 3 * SIDE * SIDE; i++) finite = finite && isfinite(rgb[i]) && rgb[i] >= 0;
    for (int i = 0; i < SIDE * SIDE; i++) covered += (double)alpha[i];
    text_format(out, "  rendered, about %.0f0 %% of the picture covered%s\n", floor(covered / (SIDE * SIDE) * 10 + 0.5),
                finite ? "" : ", NOT FINITE");
    for (int d = 0; d < KILN_DISCARD_COUNT; d++)
        if (stats->discarded[d]) text_format(out, "  DISCARDED %d\n", d);
    free(rgb);
    free(alpha);
}

static void describe(const char *path, kiln_text *out) {
    kiln_report *report = kiln_report_create();
    kiln_scene *scene;
    kiln_film *film;
    kiln_render_stats stats;
    if (!kiln_import(path, NULL, &scene, report)) {
        text_append(out, "  refused\n");
        kiln_report_destroy(report);
        return;
    }
    kiln_report_clear(report); /* what the importer says stands in assets.summary */
    kiln_film_create(&(kiln_film_desc){.width = SIDE, .height = SIDE, .aovs = 1u << KILN_AOV_ALPHA}, &film, report);
    if (draw(scene, film, &stats, report)) describe_picture(film, &stats, out);
    for (size_t i = 0; i < kiln_report_size(report); i++)
        text_format(out, "  SAYS %s\n", kiln_report_message(report, i).what);
    kiln_film_destroy(film);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
}

static void assets_render(void **state) {
    (void)state;
    const char *root = assets_or_skip();
    static const char *const suffixes[] = {".gltf", ".glb", NULL};
    kiln_text folder = {0};
    text_format(&folder, "%s/gltf", root);
    assert_true(golden_matches_files("gltf/assets.renders", folder.data, suffixes, describe));
    text_free(&folder);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(assets_render)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
