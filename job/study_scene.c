/* job/study_scene.c: rooms in which estimators and roulette show what they are worth. Metres; light in cd/m². */
#include <math.h>
#include <string.h>

#include "base/report.h"
#include "job/study.h"

typedef struct room {
    kiln_scene *scene;
    kiln_report *report;
    bool failed;
} room;

static kiln_id add_material(room *r, const kiln_material *m) {
    kiln_id id = 0;
    r->failed = r->failed || !kiln_scene_add_material(r->scene, m, &id, r->report);
    return id;
}

static kiln_id add_paint(room *r, float red, float green, float blue) {
    kiln_material m = kiln_material_default();
    const float color[3] = {red, green, blue};
    memcpy(m.base_color.value, color, sizeof color);
    m.metallic.value = 0;
    m.specular.value = 0; /* Lambert and nothing else */
    m.double_sided = true;
    return add_material(r, &m);
}

static kiln_id add_lamp(room *r, float radiance) {
    kiln_material m = kiln_material_default();
    m.metallic.value = 0;
    for (int k = 0; k < 3; k++) m.base_color.value[k] = 0, m.emission.value[k] = radiance;
    m.emission.value[2] *= 0.7f;
    return add_material(r, &m);
}

static void add_mesh(room *r, kiln_id material, const char *name, const float *positions, uint32_t vertices,
                     const uint32_t *faces, const uint32_t *sizes, uint32_t count, const float *normals) {
    const kiln_primvar smooth = {.kind = KILN_PRIMVAR_NORMAL, .interpolation = KILN_VERTEX, .values = normals,
                                 .value_count = vertices};
    const kiln_mesh_desc desc = {.name = name, .vertex_count = vertices, .positions = positions, .face_count = count,
                                 .face_sizes = sizes, .face_vertices = faces, .primvars = normals ? &smooth : NULL,
                                 .primvar_count = normals ? 1 : 0, .material = material};
    kiln_id mesh;
    r->failed = r->failed || !kiln_scene_add_mesh(r->scene, &desc, &mesh, r->report) ||
                !kiln_scene_add_instance(r->scene, &(kiln_instance_desc){.name = name, .mesh = mesh}, NULL, r->report);
}

/* A box from one corner to the other; inward: its faces look inside. */
static void add_box(room *r, kiln_id material, const char *name, const float low[3], const float high[3], bool inward) {
    static const uint32_t quads[24] = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
    static const uint32_t sizes[6] = {4, 4, 4, 4, 4, 4};
    float corners[24];
    uint32_t faces[24];
    for (int c = 0; c < 8; c++)
        for (int k = 0; k < 3; k++) corners[3 * c + k] = c >> k & 1 ? high[k] : low[k];
    for (int i = 0; i < 24; i++) faces[i] = quads[inward ? 23 - i : i];
    add_mesh(r, material, name, corners, 8, faces, sizes, 6, NULL);
}

static void add_quad(room *r, kiln_id material, const char *name, const float corners[12]) {
    static const uint32_t face[4] = {0, 1, 2, 3}, size = 4;
    add_mesh(r, material, name, corners, 4, face, &size, 1, NULL);
}

static void add_ball(room *r, kiln_id material, const char *name, const float center[3], float radius) {
    enum { ROWS = 16, COLUMNS = 32, VERTICES = (ROWS + 1) * COLUMNS };
    float positions[3 * VERTICES], normals[3 * VERTICES];
    uint32_t faces[4 * ROWS * COLUMNS], sizes[ROWS * COLUMNS], count = 0, at = 0;
    for (uint32_t i = 0; i < VERTICES; i++) {
        double polar = M_PI * (i / COLUMNS) / ROWS, around = 2 * M_PI * (i % COLUMNS) / COLUMNS;
        const double n[3] = {sin(polar) * cos(around), cos(polar), -sin(polar) * sin(around)};
        for (uint32_t k = 0; k < 3; k++) {
            normals[3 * i + k] = (float)n[k];
            positions[3 * i + k] = center[k] + radius * (float)n[k];
        }
    }
    for (uint32_t i = 0; i < ROWS * COLUMNS; i++) {
        uint32_t row = i / COLUMNS, left = i % COLUMNS, right = (left + 1) % COLUMNS, up = row * COLUMNS;
        /* Around the poles a side of the quad has no length: triangles. */
        if (row > 0) faces[at++] = up + left;
        faces[at++] = up + COLUMNS + left;
        if (row + 1 < ROWS) faces[at++] = up + COLUMNS + right;
        if (row > 0 || row + 1 == ROWS) faces[at++] = up + right;
        else faces[at++] = up + left;
        sizes[count++] = row > 0 && row + 1 < ROWS ? 4 : 3;
    }
    add_mesh(r, material, name, positions, VERTICES, faces, sizes, count, normals);
}

static void add_camera(room *r, const double eye[3], double yfov_rad, double turn_rad) {
    kiln_camera c = kiln_camera_default();
    double cosine = cos(turn_rad), sine = sin(turn_rad);
    const double transform[16] = {cosine, 0, -sine, 0, 0, 1, 0, 0, sine, 0, cosine, 0, eye[0], eye[1], eye[2], 1};
    c.name = "eye";
    c.yfov_rad = yfov_rad;
    memcpy(c.transform, transform, sizeof transform);
    r->failed = r->failed || !kiln_scene_add_camera(r->scene, &c, NULL, r->report);
}

static bool begin(room *r, kiln_report *report) {
    *r = (room){.scene = kiln_scene_create(), .report = report};
    return r->scene || report_no_memory(report, "making a scene");
}

static bool end(room *r, kiln_scene **scene) {
    if (r->failed) {
        kiln_scene_destroy(r->scene);
        r->scene = NULL;
    }
    *scene = r->scene;
    return !r->failed;
}

/* White walls; the lamp hangs behind a wall that leaves a passage, and shines at the ceiling: what the camera sees has
 * bounced at least twice, and much of it ten times and more. */
bool study_make_interior(kiln_scene **scene, kiln_report *report) {
    room r;
    if (!begin(&r, report)) return false;
    kiln_id white = add_paint(&r, 0.85f, 0.85f, 0.82f), red = add_paint(&r, 0.75f, 0.25f, 0.2f);
    kiln_id wood = add_paint(&r, 0.5f, 0.36f, 0.22f), lamp = add_lamp(&r, 120);
    add_box(&r, white, "room", (float[]){-2, 0, -3}, (float[]){2, 2.5f, 3}, true);
    add_box(&r, white, "wall", (float[]){-2, 0, -1.1f}, (float[]){0.7f, 2.5f, -1}, false);
    add_box(&r, red, "sofa", (float[]){-1.7f, 0, -0.6f}, (float[]){-0.3f, 0.55f, 0.2f}, false);
    add_box(&r, wood, "table", (float[]){0.1f, 0.38f, 0.1f}, (float[]){0.9f, 0.44f, 0.8f}, false);
    add_box(&r, wood, "shade", (float[]){-0.9f, 1.5f, -2.4f}, (float[]){-0.3f, 1.52f, -1.8f}, false);
    add_quad(&r, lamp, "lamp",
             (float[]){-.8f, 1.55f, -2.3f, -.8f, 1.55f, -1.9f, -.4f, 1.55f, -1.9f, -.4f, 1.55f, -2.3f});
    add_camera(&r, (double[]){0.6, 1.3, 2.8}, 1.0, 0.12);
    return end(&r, scene);
}

/* A Cornell box, closed behind the camera, with a mirror on the wall, a mirror ball and a glass ball: lamps in mirrors,
 * and caustics. */
bool study_make_mirrors(kiln_scene **scene, kiln_report *report) {
    room r;
    if (!begin(&r, report)) return false;
    kiln_id white = add_paint(&r, 0.7f, 0.7f, 0.7f), red = add_paint(&r, 0.65f, 0.1f, 0.1f);
    kiln_id green = add_paint(&r, 0.1f, 0.5f, 0.15f), lamp = add_lamp(&r, 12);
    kiln_material mirror = kiln_material_default(), glass = kiln_material_default(), satin = kiln_material_default();
    mirror.roughness.value = 0, mirror.double_sided = true;
    for (int k = 0; k < 3; k++) mirror.base_color.value[k] = 0.9f;
    satin.roughness.value = 0.25f;
    satin.base_color.value[1] = 0.8f, satin.base_color.value[2] = 0.5f;
    glass.metallic.value = 0, glass.roughness.value = 0, glass.layers = KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME;
    glass.transmission.value = 1, glass.thickness.value = 1;
    kiln_id silver = add_material(&r, &mirror);
    add_quad(&r, white, "floor", (float[]){-1, 0, 4, 1, 0, 4, 1, 0, -1, -1, 0, -1});
    add_quad(&r, white, "ceiling", (float[]){-1, 2, -1, 1, 2, -1, 1, 2, 4, -1, 2, 4});
    add_quad(&r, white, "front", (float[]){1, 0, 4, -1, 0, 4, -1, 2, 4, 1, 2, 4});
    add_quad(&r, white, "back", (float[]){-1, 0, -1, 1, 0, -1, 1, 2, -1, -1, 2, -1});
    add_quad(&r, red, "left", (float[]){-1, 0, 4, -1, 0, -1, -1, 2, -1, -1, 2, 4});
    add_quad(&r, green, "right", (float[]){1, 0, -1, 1, 0, 4, 1, 2, 4, 1, 2, -1});
    add_quad(&r, silver, "mirror",
             (float[]){-.6f, .8f, -.98f, .6f, .8f, -.98f, .6f, 1.9f, -.98f, -.6f, 1.9f, -.98f});
    add_quad(&r, lamp, "lamp", (float[]){-.3f, 1.95f, -.3f, .3f, 1.95f, -.3f, .3f, 1.95f, .3f, -.3f, 1.95f, .3f});
    add_ball(&r, silver, "mirror ball", (float[]){-0.5f, 0.36f, -0.35f}, 0.36f);
    add_ball(&r, add_material(&r, &glass), "glass ball", (float[]){0.45f, 0.33f, 0.25f}, 0.33f);
    add_ball(&r, add_material(&r, &satin), "gold ball", (float[]){-0.05f, 0.18f, 0.5f}, 0.18f);
    add_camera(&r, (double[]){0, 1, 3.6}, 0.68, 0);
    return end(&r, scene);
}
