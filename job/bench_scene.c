/* Scenes for benchmarks without a file: of any number of triangles and copies, the same on every machine. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/report.h"
#include "job/bench.h"

/* A ring (torus) with waves, so that surfaces see each other and normals vary at all scales: no poles, whose triangles
 * would have no area. */
static void ring_point(double u, double v, float position[3]) {
    double around = 2 * M_PI * u, across = 2 * M_PI * v;
    double thick = 0.4 + 0.03 * sin(11 * around) * cos(7 * across) + 0.006 * sin(61 * around + 43 * across);
    double out = 1 + thick * cos(across);
    position[0] = (float)(out * cos(around));
    position[1] = (float)(thick * sin(across));
    position[2] = (float)(-out * sin(around));
}

static bool add_ring(kiln_scene *scene, uint64_t triangles, kiln_id material, kiln_id *mesh, kiln_report *report) {
    uint32_t rows = (uint32_t)fmax(round(sqrt((double)triangles / 4)), 3), columns = 2 * rows;
    size_t count = (size_t)rows * columns;
    float *positions = array_alloc(count, 3 * sizeof *positions);
    uint32_t *corners = array_alloc(count, 6 * sizeof *corners);
    for (size_t i = 0; positions && corners && i < count; i++) {
        uint32_t u = (uint32_t)(i / rows), v = (uint32_t)(i % rows), next = (u + 1) % columns, up = (v + 1) % rows;
        ring_point((double)u / columns, (double)v / rows, positions + 3 * i);
        const uint32_t quad[6] = {u * rows + v,      next * rows + v,  next * rows + up,
                                  u * rows + v,      next * rows + up, u * rows + up};
        memcpy(corners + 6 * i, quad, sizeof quad);
    }
    kiln_mesh_desc desc = {.name = "ring", .vertex_count = (uint32_t)count, .positions = positions,
                           .face_count = (uint32_t)(2 * count), .face_vertices = corners, .material = material};
    bool done = positions && corners ? kiln_scene_add_mesh(scene, &desc, mesh, report)
                                     : report_no_memory(report, "making a scene");
    free(positions);
    free(corners);
    return done;
}

static bool add_table(kiln_scene *scene, double half, kiln_report *report) {
    kiln_material grey = kiln_material_default();
    kiln_id material, mesh;
    float h = (float)half, corners[12] = {-h, -0.45f, h, h, -0.45f, h, h, -0.45f, -h, -h, -0.45f, -h};
    const uint32_t vertices[4] = {0, 1, 2, 3}, size = 4;
    for (int k = 0; k < 3; k++) grey.base_color.value[k] = 0.5f;
    grey.metallic.value = 0;
    kiln_mesh_desc desc = {.name = "table", .vertex_count = 4, .positions = corners, .face_count = 1,
                           .face_sizes = &size, .face_vertices = vertices};
    if (!kiln_scene_add_material(scene, &grey, &material, report)) return false;
    desc.material = material;
    return kiln_scene_add_mesh(scene, &desc, &mesh, report) &&
           kiln_scene_add_instance(scene, &(kiln_instance_desc){.name = "table", .mesh = mesh}, NULL, report);
}

/* Copies stand in rows, each turned a little more than the one before. */
static bool add_copies(kiln_scene *scene, kiln_id mesh, uint32_t copies, uint32_t side, kiln_report *report) {
    const double pitch = 3;
    for (uint32_t i = 0; i < copies; i++) {
        double x = (i % side - 0.5 * (side - 1)) * pitch, z = (i / side - 0.5 * (side - 1)) * pitch, angle = 0.7 * i;
        double c = cos(angle), s = sin(angle);
        const double transform[16] = {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, x, 0, z, 1};
        kiln_instance_desc copy = {.name = "ring", .mesh = mesh, .transforms = transform};
        if (!kiln_scene_add_instance(scene, &copy, NULL, report)) return false;
    }
    return true;
}

/* From above, so near that next to no pixel sees past the table: light goes to and fro before it leaves. */
static bool add_camera(kiln_scene *scene, kiln_report *report) {
    kiln_framing framing = {.azimuth_rad = M_PI / 6, .elevation_rad = M_PI / 4, .fit = 1.6};
    kiln_camera camera = kiln_camera_frame(scene, &framing);
    camera.name = "above";
    return kiln_scene_add_camera(scene, &camera, NULL, report);
}

/* Squares over a disk as wide as the table (a spiral of golden angles), that shine down and a little outwards. */
static bool add_lamps(kiln_scene *scene, uint32_t lamps, double half, kiln_report *report) {
    const double height = 1.5, size = 0.5 * half / sqrt((double)lamps), radiance = 10 / (0.25 * half * half);
    float *positions = array_alloc(lamps, 12 * sizeof *positions);
    uint32_t *corners = array_alloc(lamps, 6 * sizeof *corners);
    for (size_t i = 0; positions && corners && i < lamps; i++) {
        double r = half * sqrt(((double)i + 0.5) / lamps), angle = 2.39996322972865332 * (double)i;
        double c = cos(angle), s = sin(angle);
        for (uint32_t k = 0; k < 4; k++) {
            double x = (k == 0 || k == 3 ? -0.5 : 0.5) * size, z = (k < 2 ? -0.5 : 0.5) * size;
            float *p = positions + 12 * i + (size_t)3 * k;
            p[0] = (float)(c * (r + x) - s * z), p[1] = (float)(height + 0.3 * x), p[2] = (float)(s * (r + x) + c * z);
        }
        const uint32_t first = (uint32_t)(4 * i), two[6] = {first, first + 1, first + 2, first, first + 2, first + 3};
        memcpy(corners + 6 * i, two, sizeof two);
    }
    kiln_material lamp = kiln_material_default();
    kiln_id mesh, material;
    for (int k = 0; k < 3; k++) lamp.emission.value[k] = (float)radiance;
    bool done = (positions && corners) || report_no_memory(report, "making a scene");
    done = done && kiln_scene_add_material(scene, &lamp, &material, report);
    kiln_mesh_desc desc = {.name = "lamps", .vertex_count = 4 * lamps, .positions = positions, .face_count = 2 * lamps,
                           .face_vertices = corners, .material = done ? material : 0};
    done = done && kiln_scene_add_mesh(scene, &desc, &mesh, report) &&
           kiln_scene_add_instance(scene, &(kiln_instance_desc){.name = "lamps", .mesh = mesh}, NULL, report);
    free(positions);
    free(corners);
    return done;
}

bool bench_make_scene(uint64_t triangles, uint32_t copies, uint32_t lamps, kiln_scene **scene, kiln_report *report) {
    kiln_material paint = kiln_material_default();
    const float color[3] = {0.8f, 0.45f, 0.25f};
    kiln_id material, mesh;
    uint32_t side = (uint32_t)ceil(sqrt((double)copies));
    memcpy(paint.base_color.value, color, sizeof color);
    paint.metallic.value = 0;
    paint.roughness.value = 0.4f;
    *scene = kiln_scene_create();
    if (!*scene) return report_no_memory(report, "making a scene");
    if (kiln_scene_add_material(*scene, &paint, &material, report) &&
        add_ring(*scene, triangles, material, &mesh, report) && add_table(*scene, 1.5 * side + 0.5, report) &&
        add_copies(*scene, mesh, copies, side, report) && add_camera(*scene, report) &&
        (!lamps || add_lamps(*scene, lamps, 1.5 * side + 0.5, report)))
        return true;
    kiln_scene_destroy(*scene);
    *scene = NULL;
    return false;
}
