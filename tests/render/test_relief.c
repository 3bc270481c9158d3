/* Surfaces whose shading normals are not their own: normal maps and smooth low-poly meshes keep all light, leak none, and
 * give the three estimators one answer. Seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/hash.h"
#include "tests/render/scenes.h"

static const kiln_estimator estimators[] = {KILN_ESTIMATOR_BSDF, KILN_ESTIMATOR_NEE, KILN_ESTIMATOR_MIS};

/* A large quad under a normal map that leans up to 50° every way. */
static void add_relief(scene_builder *b, kiln_material m) {
    enum { SIDE = 8 };
    float rgb[3 * SIDE * SIDE];
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        float x = 1.6f * unit_float(hash_pair(i, 1)) - 0.8f, y = 1.6f * unit_float(hash_pair(i, 2)) - 0.8f;
        rgb[3 * i] = 0.5f + 0.5f * x, rgb[3 * i + 1] = 0.5f + 0.5f * y, rgb[3 * i + 2] = 0.95f;
    }
    m.normal.texture = (kiln_texture){.image = add_image(b, rgb, SIDE, SIDE), .transfer = KILN_TRANSFER_DATA};
    const float p[12] = {-9, 0, 9, 9, 0, 9, 9, 0, -9, -9, 0, -9}, uv[8] = {0, 0, 40, 0, 40, 40, 0, 40};
    const float t[16] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    const kiln_primvar primvars[] = {{.kind = KILN_PRIMVAR_UV, .values = uv, .value_count = 4},
                                     {.kind = KILN_PRIMVAR_TANGENT, .values = t, .value_count = 4}};
    kiln_id mesh = add_mesh(b, &(kiln_mesh_desc){.name = "relief", .vertex_count = 4, .positions = p, .face_count = 2,
                                                 .face_vertices = faces, .primvars = primvars, .primvar_count = 2,
                                                 .material = add_material(b, &m)});
    add_instance(b, mesh, NULL);
}

static kiln_material white_metal(void) {
    kiln_material m = kiln_material_default();
    m.roughness.value = 0.5f;
    return m;
}
static kiln_material white_glass(void) { /* a thin wall */
    kiln_material m = kiln_material_default();
    m.layers = KILN_LAYER_TRANSMISSION;
    m.metallic.value = 0, m.roughness.value = 0.4f, m.transmission.value = 1;
    return m;
}

static kiln_material coated_white(float roughness) { /* the coat's own normals stay where they are */
    kiln_material m = diffuse_material(1, 1, 1);
    m.layers = KILN_LAYER_CLEARCOAT;
    m.clearcoat.value = 1, m.clearcoat_roughness.value = roughness;
    return m;
}

/* In an environment of radiance 1 what is white cannot be seen. slack: what tables leave of a compensated lobe. */
static void check_furnace(const char *name, scene_builder *b, const kiln_camera *view, double slack) {
    set_environment(b, 0, 1, 1, 1);
    for (int e = 0; e < 3; e++) {
        kiln_render_options o = {.spp = 256, .estimator = estimators[e], .seed = 30 + (uint64_t)e, .max_depth = 64,
                                 .roulette = {.kind = KILN_ROULETTE_OFF}};
        picture p = render(b, view, &o, 32, 16);
        if (fabs(p.mean - 1) > 3.9 * p.mean_error + slack) /* 1 in 10,000 */
            fail_msg("%s, estimator %d: %.5f ± %.5f instead of 1", name, e, p.mean, p.mean_error);
        picture_free(&p);
    }
    builder_free(b);
}

static void check_relief(const char *name, kiln_material m, double slack) {
    scene_builder b = builder_make();
    kiln_camera grazing = camera_at((float[]){0, 0.5f, 6}, (float[]){0, 0, 1}, 6); /* 6° above the surface */
    add_relief(&b, m);
    check_furnace(name, &b, &grazing, slack);
}

static void reliefs_keep_all_light(void **state) {
    (void)state;
    check_relief("white Lambert", diffuse_material(1, 1, 1), 1e-5);
    check_relief("white metal", white_metal(), 5e-3);
    check_relief("white glass", white_glass(), 5e-3);
}

/* A coat's horizon is not the base's; and where their normals differ, what it takes from the base is not what it keeps. */
static void coats_keep_most_light(void **state) {
    (void)state;
    check_relief("smooth coat on a bent base", coated_white(0), 2e-2);
    check_relief("rough coat on a bent base", coated_white(0.4f), 2e-2);
}

/* Sixteen segments and the normals of a ball, filling the picture to its silhouette. */
static void coarse_balls_keep_all_light(void **state) {
    (void)state;
    kiln_camera view = camera_at((float[]){0, 0, 4}, (float[]){0.7f, 0, 0}, 20);
    for (int metal = 0; metal < 2; metal++) {
        scene_builder b = builder_make();
        kiln_material m = metal ? white_metal() : diffuse_material(1, 1, 1);
        add_sphere(&b, add_material(&b, &m), (float[]){0, 0, 0}, 1, 16, 0);
        check_furnace(metal ? "metal ball" : "white ball", &b, &view, metal ? 5e-3 : 1e-5);
    }
}

/* Whatever shines outside, the inside of a closed ball is black to the last bit. */
static void closed_balls_stay_dark(void **state) {
    (void)state;
    for (int e = 0; e < 3; e++) {
        scene_builder b = builder_make();
        kiln_material m = diffuse_material(0.9f, 0.9f, 0.9f);
        m.double_sided = true;
        add_sphere(&b, add_material(&b, &m), (float[]){0, 0, 0}, 1, 16, 0);
        set_environment(&b, 0, 1, 1, 1);
        kiln_light sun = light_at(KILN_LIGHT_DISTANT, (float[]){3, 2, 1}, (float[]){0, 0, 0}, 10);
        add_light(&b, &sun);
        kiln_camera view = camera_at((float[]){0.2f, 0.1f, 0.3f}, (float[]){1, 0.3f, -1}, 100);
        kiln_render_options o = {.spp = 64, .estimator = estimators[e], .max_depth = 16};
        picture p = render(&b, &view, &o, 32, 32);
        if (p.mean != 0) fail_msg("estimator %d: %g leaks in", e, p.mean);
        picture_free(&p);
        builder_free(&b);
    }
}

/* The lit half of a coarse ball is lit as the fine ball's: the illuminance of a sun is a cosine, also beside the
 * terminator, on a facet that faces away where the smooth surface does not. */
static double crescent(int segments) {
    scene_builder b = builder_make();
    kiln_material m = diffuse_material(1, 1, 1);
    add_sphere(&b, add_material(&b, &m), (float[]){0, 0, 0}, 1, segments, 0);
    kiln_light sun = light_at(KILN_LIGHT_DISTANT, (float[]){4, 0.3f, 0.4f}, (float[]){0, 0, 0}, 1);
    add_light(&b, &sun);
    kiln_camera view = camera_at((float[]){0, 0.2f, 30}, (float[]){-0.03f, 0, 0}, 0.1); /* a facet that faces away */
    kiln_render_options o = {.spp = 64, .max_depth = 1};
    picture p = render(&b, &view, &o, 64, 32);
    double mean = p.mean;
    picture_free(&p);
    builder_free(&b);
    return mean;
}

static void terminators_are_smooth(void **state) {
    (void)state;
    double fine = crescent(512), coarse = crescent(16);
    if (fabs(coarse - fine) > 0.05 * fine) fail_msg("beside the terminator: %.5f, a fine ball %.5f", coarse, fine);
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reliefs_keep_all_light), cmocka_unit_test(coats_keep_most_light),
        cmocka_unit_test(coarse_balls_keep_all_light),
        cmocka_unit_test(closed_balls_stay_dark), cmocka_unit_test(terminators_are_smooth),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]); /* of mutants: the case that must see them */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
