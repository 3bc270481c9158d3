/* Textures that are seen small: what filtering by cones errs against brute force, and what it saves of noise. Both
 * pictures have the same seed, so that their difference is that of the filters. Prints what docs/textures.md quotes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "kiln/import.h"
#include "tests/assets.h"
#include "tests/render/scenes.h"

enum { SIDE = 64, CHECKS = 512, MANY = 512 };

static kiln_material checkered(scene_builder *b) {
    static float rgb[3 * CHECKS * CHECKS];
    for (int i = 0; i < CHECKS * CHECKS; i++) {
        bool white = (i / CHECKS / 2 + i % CHECKS / 2) % 2; /* of two texels, 256 a side */
        for (int k = 0; k < 3; k++) rgb[3 * i + k] = white ? 0.9f : k == 0 ? 0.4f : 0.05f;
    }
    kiln_material m = diffuse_material(1, 1, 1);
    m.base_color.texture = (kiln_texture){.image = add_image(b, rgb, CHECKS, CHECKS), .transfer = KILN_TRANSFER_LINEAR};
    return m;
}

static kiln_material mirror(void) {
    kiln_material m = kiln_material_default();
    m.roughness.value = 0;
    return m;
}

static kiln_material glass(void) {
    kiln_material m = kiln_material_default();
    m.layers = KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME;
    m.metallic.value = m.roughness.value = 0, m.transmission.value = m.thickness.value = 1;
    return m;
}

/* A floor of 40 m with 51,200 squares, from 1.5 m above it to the horizon. */
static void add_floor(scene_builder *b) {
    kiln_material floor = checkered(b);
    add_quad(b, add_material(b, &floor), (float[]){-20, 0, 20, 20, 0, 20, 20, 0, -20, -20, 0, -20});
    set_environment(b, 0, 1, 1, 1);
}
static void floor_alone(scene_builder *b) { add_floor(b); }
static void in_a_flat_mirror(scene_builder *b) {
    kiln_material m = mirror();
    add_floor(b);
    add_quad(b, add_material(b, &m), (float[]){-3, 0.1f, -2, 3, 0.1f, -2, 3, 4, -2, -3, 4, -2});
}
static void in_a_ball(scene_builder *b) {
    kiln_material m = mirror();
    add_floor(b);
    add_sphere(b, add_material(b, &m), (float[]){0, 1.3f, 0}, 1.2f, 64, 0);
}
/* A paraboloid in front of the middle of the view, z = (x² + y²)/6 − 2: it collects light 1.5 m before it. */
static void in_a_hollow_mirror(scene_builder *b) {
    enum { N = 24, VERTICES = (N + 1) * (N + 1) };
    static float p[3 * VERTICES], n[3 * VERTICES];
    static uint32_t sizes[N * N], faces[4 * N * N];
    for (int i = 0; i < VERTICES; i++) {
        float x = 4.0f * (float)(i % (N + 1)) / N - 2, y = 4.0f * (float)(i / (N + 1)) / N - 2;
        const float point[3] = {x, y + 2.2f, (x * x + y * y) / 6 - 2}, normal[3] = {-x / 3, -y / 3, 1};
        memcpy(p + 3 * i, point, sizeof point), memcpy(n + 3 * i, normal, sizeof normal);
    }
    for (uint32_t i = 0; i < N * N; i++) {
        uint32_t a = i / N * (N + 1) + i % N;
        const uint32_t face[4] = {a, a + 1, a + N + 2, a + N + 1};
        memcpy(faces + 4 * i, face, sizeof face);
        sizes[i] = 4;
    }
    const kiln_primvar normals = {.kind = KILN_PRIMVAR_NORMAL, .values = n, .value_count = VERTICES};
    kiln_material m = mirror();
    add_floor(b);
    kiln_id dish = add_mesh(b, &(kiln_mesh_desc){.name = "dish", .vertex_count = VERTICES, .positions = p, .face_count = N * N,
                                  .face_sizes = sizes, .face_vertices = faces, .primvars = &normals, .primvar_count = 1,
                                  .material = add_material(b, &m)});
    add_instance(b, dish, NULL);
}
static void through_a_lens(scene_builder *b) {
    kiln_material m = glass();
    add_floor(b);
    add_sphere(b, add_material(b, &m), (float[]){0, 1.3f, 2}, 1.1f, 64, 0);
}
static void in_a_rough_mirror(scene_builder *b) {
    kiln_material m = mirror();
    m.roughness.value = 0.25f;
    add_floor(b);
    add_quad(b, add_material(b, &m), (float[]){-3, 0.1f, -2, 3, 0.1f, -2, 3, 4, -2, -3, 4, -2});
}
static void on_a_wall(scene_builder *b) {
    kiln_material m = diffuse_material(0.8f, 0.8f, 0.8f);
    add_floor(b);
    add_quad(b, add_material(b, &m), (float[]){-3, 0.0f, -2, 3, 0.0f, -2, 3, 4, -2, -3, 4, -2});
}

static picture shoot(const kiln_scene *scene, const kiln_camera *view, kiln_texture_filter filter, uint32_t spp, uint64_t seed,
                     uint32_t side, kiln_report *report) {
    kiln_renderer *renderer;
    must(kiln_renderer_create(scene, &(kiln_renderer_options){.texture_filter = filter}, &renderer, report), report, "a renderer");
    picture p = render_with(renderer, &(kiln_render_options){.camera = view, .spp = spp, .seed = seed},
                            &(kiln_film_desc){.width = side, .height = side}, report);
    kiln_renderer_destroy(renderer);
    return p;
}

/* Mean relative square difference, as the film's error is measured, and the mean's relative difference. */
typedef struct deviation { double rms, mean; } deviation;
static deviation deviate(const picture *a, const picture *b) {
    double sum = 0, level = 1e-4 * b->mean * b->mean + 1e-12;
    size_t n = 3 * (size_t)a->width * a->height;
    for (size_t i = 0; i < n; i++) {
        double d = (double)a->rgb[i] - (double)b->rgb[i];
        sum += d * d / ((double)b->rgb[i] * (double)b->rgb[i] + level);
    }
    return (deviation){sqrt(sum / (double)n), a->mean / b->mean - 1};
}

/* bias: difference of the filters at many samples; noise: of few against many, for each filter. */
typedef struct figures { deviation bias; double rest, noise[2]; } figures;
static figures measure(const char *name, const kiln_scene *scene, const kiln_camera *view, uint32_t many, uint32_t few,
                       uint32_t side, kiln_report *report) {
    figures f;
    picture truth = shoot(scene, view, KILN_TEXTURES_BILINEAR, many, 1, side, report);
    picture mip = shoot(scene, view, KILN_TEXTURES_MIP, many, 1, side, report);
    picture again = shoot(scene, view, KILN_TEXTURES_BILINEAR, many, 2, side, report);
    f.bias = deviate(&mip, &truth);
    f.rest = deviate(&again, &truth).rms;
    for (int k = 0; k < 2; k++) {
        picture p = shoot(scene, view, k ? KILN_TEXTURES_MIP : KILN_TEXTURES_BILINEAR, few, 3, side, report);
        f.noise[k] = deviate(&p, k ? &mip : &truth).rms;
        picture_free(&p);
    }
    print_message("%-18s difference %.4f %% of a pixel (two seeds %.4f %%), %+.4f %% of the mean; noise at %u spp: %.2f %% bilinear, "
                  "%.2f %% mip\n", name, 100 * f.bias.rms, 100 * f.rest, 100 * f.bias.mean, few, 100 * f.noise[0], 100 * f.noise[1]);
    picture_free(&truth), picture_free(&mip), picture_free(&again);
    return f;
}

/* No picture differs by more than its noise at MANY samples, nor its mean by more than a thousandth. */
static void pictures_stay_sharp(void **state) {
    (void)state;
    static const struct { const char *name; void (*add)(scene_builder *); } rows[] = {
        {"floor", floor_alone},           {"flat mirror", in_a_flat_mirror}, {"ball", in_a_ball},
        {"hollow mirror", in_a_hollow_mirror}, {"lens", through_a_lens},     {"rough mirror", in_a_rough_mirror},
        {"wall", on_a_wall}};
    const kiln_camera view = camera_at((float[]){0, 1.5f, 8}, (float[]){0, 1.2f, 0}, 40);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        scene_builder b = builder_make();
        rows[i].add(&b);
        must(kiln_scene_commit(b.scene, b.report), b.report, "committing");
        figures f = measure(rows[i].name, b.scene, &view, MANY, 16, SIDE, b.report);
        if (f.bias.rms > f.rest) fail_msg("%s: the filter changes pixels by %g", rows[i].name, f.bias.rms);
        if (fabs(f.bias.mean) > 1e-3) fail_msg("%s: the filter changes the mean by %g", rows[i].name, f.bias.mean);
        builder_free(&b);
    }
}

/* Large textures seen small, with data maps beside the colour. */
static void assets_stay_as_they_are(void **state) {
    (void)state;
    char path[5000];
    snprintf(path, sizeof path, "%s/gltf/FlightHelmet/FlightHelmet.gltf", assets_or_skip());
    scene_builder b = {NULL, kiln_report_create()};
    must(kiln_import(path, NULL, &b.scene, b.report), b.report, "importing");
    set_environment(&b, 0, 1, 1, 1);
    must(kiln_scene_commit(b.scene, b.report), b.report, "committing");
    const kiln_camera view = camera_at((float[]){0.5f, 0.45f, 1.2f}, (float[]){0, 0.32f, 0}, 32);
    figures f = measure("FlightHelmet", b.scene, &view, MANY, 16, 128, b.report);
    assert_true(f.bias.rms < f.rest);
    builder_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_stay_sharp),
        cmocka_unit_test(assets_stay_as_they_are),
    };
    return cmocka_run_group_tests_name("filtering", tests, NULL, NULL);
}
