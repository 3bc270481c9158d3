/* Solids in one another, beside one another, and around the camera, against what their real interfaces do. Statistical
 * comparisons allow 4 standard errors: less than 1 in 15,000 each, and the seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "render/film/film.h"
#include "tests/render/scenes.h"

static kiln_material solid(float ior) {
    kiln_material m = kiln_material_default();
    m.layers = KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME;
    m.metallic.value = 0, m.roughness.value = 0, m.transmission.value = 1, m.thickness.value = 1;
    m.ior = ior;
    return m;
}

static kiln_id add_solid(scene_builder *b, float ior, int32_t priority) {
    kiln_material m = solid(ior);
    m.priority = priority;
    return add_material(b, &m);
}

/* Light comes from below alone. */
static void light_from_below(scene_builder *b) {
    const float rows[4 * 3] = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1};
    set_environment(b, add_image(b, rows, 1, 4), 1, 1, 1);
}

/* A slab from y0 to y1. Slabs that touch have their walls cut into different triangles. */
static void add_slab(scene_builder *b, kiln_id material, float y0, float y1, float half) {
    add_box(b, material, (float[]){-half, y0, -half}, (float[]){half, y1, half * 1.25f});
}

static double normal_reflectance(double a, double b) { return (a - b) * (a - b) / ((a + b) * (a + b)); }

/* Of interfaces in a row, without absorption and interference: (1 − T)/T = Σ R/(1 − R). */
static double transmittance(const double *n, int media) {
    double sum = 0;
    for (int i = 0; i + 1 < media; i++) {
        double r = normal_reflectance(n[i], n[i + 1]);
        sum += r / (1 - r);
    }
    return 1 / (1 + sum);
}

typedef void builder(scene_builder *);

static picture look_down(builder *build) {
    scene_builder b = builder_make();
    build(&b);
    light_from_below(&b);
    kiln_camera view = camera_at((float[]){0.013f, 5, 0.017f}, (float[]){0.013f, 0, 0.017f}, 0.5);
    picture p = render(&b, &view, &(kiln_render_options){.spp = 1024, .seed = 3, .background = KILN_BACKGROUND_ENVIRONMENT},
                       8, 8);
    builder_free(&b);
    return p;
}

static void passes(const char *name, builder *build, const double *n, int media) {
    picture p = look_down(build);
    double expected = transmittance(n, media);
    if (fabs(p.mean - expected) > 4 * p.mean_error + 1e-4)
        fail_msg("%s: %.5f ± %.5f passes, not %.5f", name, p.mean, p.mean_error, expected);
    picture_free(&p);
}

/* A liquid between two panes of glass. */
static void touching(scene_builder *b) {
    kiln_id glass = add_solid(b, 1.5f, 0), liquid = add_solid(b, 1.33f, 0);
    add_slab(b, glass, 1, 1.2f, 2);
    add_slab(b, liquid, 0.1f, 1, 1.7f);
    add_slab(b, glass, 0, 0.1f, 2);
}
static void touching_the_other_way(scene_builder *b) {
    kiln_id liquid = add_solid(b, 1.33f, 1), glass = add_solid(b, 1.5f, 0);
    add_slab(b, glass, 0, 0.1f, 1.6f);
    add_slab(b, liquid, 0.1f, 1, 2);
    add_slab(b, glass, 1, 1.2f, 1.9f);
}
static void overlapping(scene_builder *b) {
    kiln_id glass = add_solid(b, 1.5f, 0), liquid = add_solid(b, 1.33f, 0);
    add_slab(b, glass, 1, 1.2f, 2);
    add_slab(b, liquid, 0.05f, 1.1f, 1.7f);
    add_slab(b, glass, 0, 0.1f, 2);
}
static void overlapping_with_priority(scene_builder *b) {
    kiln_id glass = add_solid(b, 1.5f, 7), liquid = add_solid(b, 1.33f, -7);
    add_slab(b, liquid, 0.05f, 1.1f, 2);
    add_slab(b, glass, 0, 0.1f, 1.7f);
    add_slab(b, glass, 1, 1.2f, 1.7f);
}
/* A block of glass, and the liquid as a hole in it. */
static void enclosed(scene_builder *b) {
    kiln_id liquid = add_solid(b, 1.33f, 0), glass = add_solid(b, 1.5f, 0);
    add_slab(b, glass, 0, 1.2f, 2);
    add_slab(b, liquid, 0.1f, 1, 1.5f);
}

static void liquid_in_glass(void **state) {
    (void)state;
    const double n[] = {1, 1.5, 1.33, 1.5, 1};
    passes("touching", touching, n, 5);
    passes("touching, the other way", touching_the_other_way, n, 5);
    passes("overlapping", overlapping, n, 5);
    passes("overlapping, with a priority", overlapping_with_priority, n, 5);
    passes("enclosed", enclosed, n, 5);
}

/* Copies of one material that touch or overlap are one piece; a bubble is a closed mesh of air. */
static void one_piece(scene_builder *b) {
    kiln_id glass = add_solid(b, 1.5f, 0);
    for (int i = 0; i < 5; i++) add_slab(b, glass, 0.2f * (float)i, 0.2f * (float)(i + 1), 2 - 0.1f * (float)i);
    add_slab(b, glass, 0.7f, 1.3f, 1.2f);
}
static void bubble(scene_builder *b) {
    kiln_id air = add_solid(b, 1, 0), glass = add_solid(b, 1.5f, 0);
    add_slab(b, glass, 0, 1, 2);
    add_slab(b, air, 0.3f, 0.6f, 1);
}
static void pieces_and_bubbles(void **state) {
    (void)state;
    passes("one piece", one_piece, (const double[]){1, 1.5, 1}, 3);
    passes("a bubble", bubble, (const double[]){1, 1.5, 1, 1.5, 1}, 5);
}

/* What is under water is dimmer where it is glossy: its coat has the index of the neighbours. */
static void coats_are_relative(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material plastic = diffuse_material(0, 0, 0);
    plastic.specular.value = 1, plastic.roughness.value = 0;
    add_slab(&b, add_solid(&b, 1.33f, 0), 0, 1, 4);
    add_slab(&b, add_material(&b, &plastic), 0.2f, 0.4f, 2);
    set_environment(&b, 0, 1, 1, 1);
    kiln_camera view = camera_at((float[]){0.013f, 5, 0.017f}, (float[]){0.013f, 0, 0.017f}, 0.5);
    picture p = render(&b, &view, &(kiln_render_options){.spp = 4096, .seed = 5}, 4, 4);
    double r = normal_reflectance(1, 1.33), s = normal_reflectance(1.33, 1.5);
    double expected = r + (1 - r) * (1 - r) * s / (1 - r * s);
    if (fabs(p.mean - expected) > 4 * p.mean_error + 1e-4)
        fail_msg("%.5f ± %.5f comes back, not %.5f", p.mean, p.mean_error, expected);
    picture_free(&p);
    builder_free(&b);
}

/* A ball in a ball of the same glass cannot be seen, whatever it is made of. */
static picture ball(bool nested, float roughness) {
    scene_builder b = builder_make();
    kiln_material outer = solid(1.5f), inner = solid(1.5f);
    outer.roughness.value = roughness;
    outer.attenuation_distance = inner.attenuation_distance = 0.4f;
    outer.attenuation_color[0] = inner.attenuation_color[0] = 0.3f;
    add_sphere(&b, add_material(&b, &outer), (float[]){0, 0, 0}, 1, 48, 0);
    if (nested) add_sphere(&b, add_material(&b, &inner), (float[]){.2f, 0, .1f}, .6f, 32, 0);
    const float rows[4 * 3] = {1, 1, 1, 0.2f, 0.3f, 0.4f, 0.7f, 0.6f, 0.5f, 0, 0, 0};
    set_environment(&b, add_image(&b, rows, 1, 4), 1, 1, 1);
    kiln_camera view = camera_at((float[]){0, 1, 4}, (float[]){0, 0, 0}, 35);
    picture p = render(&b, &view, &(kiln_render_options){.spp = 256, .seed = nested ? 3 : 4}, 24, 24);
    builder_free(&b);
    return p;
}
static void equal_glass_is_invisible(void **state) {
    (void)state;
    for (int rough = 0; rough < 2; rough++) {
        picture one = ball(false, rough ? 0.3f : 0), two = ball(true, rough ? 0.3f : 0);
        double error = hypot(one.mean_error, two.mean_error);
        if (fabs(one.mean - two.mean) > 4 * error)
            fail_msg("%.5f with a ball inside, %.5f without, ± %.5f", two.mean, one.mean, error);
        picture_free(&one);
        picture_free(&two);
    }
}

/* From inside of glass, towards a face at 30°: Snell, and Fresnel's share; what lies outside is as bright as it is from
 * the air. What is reflected sees the dark half. */
static void camera_in_glass(void **state) {
    (void)state;
    scene_builder b = builder_make();
    add_slab(&b, add_solid(&b, 1.5f, 0), 0, 1, 40);
    float rows[64 * 3];
    for (int i = 0; i < 64; i++) /* by elevation: the cosine of the polar angle at the texel, below the horizon */
        for (int k = 0; k < 3; k++) rows[3 * i + k] = i < 32 ? 0 : (float)-cos(M_PI * (i + 0.5) / 64);
    set_environment(&b, add_image(&b, rows, 1, 64), 1, 1, 1);
    double in = M_PI / 6, out = asin(1.5 * sin(in));
    kiln_camera view = camera_at((float[]){0.013f, 0.5f, 0.017f},
                                 (float[]){0.013f + (float)sin(in), 0.5f - (float)cos(in), 0.017f}, 0.2);
    picture p = render(&b, &view, &(kiln_render_options){.spp = 1024, .seed = 5, .max_depth = 1}, 4, 4);
    double rs = (1.5 * cos(in) - cos(out)) / (1.5 * cos(in) + cos(out));
    double rp = (1.5 * cos(out) - cos(in)) / (1.5 * cos(out) + cos(in));
    double expected = cos(out) * (1 - 0.5 * (rs * rs + rp * rp));
    if (fabs(p.mean - expected) > 4 * p.mean_error + 1e-3 * expected)
        fail_msg("%.5f ± %.5f is seen from inside, not %.5f", p.mean, p.mean_error, expected);
    picture_free(&p);
    builder_free(&b);
}

/* Mirrored and shared copies, and a camera in two media at once: the inner one counts, and both are left. */
static void camera_in_nested_media(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material water = solid(1.33f);
    water.attenuation_distance = 1, water.attenuation_color[0] = water.attenuation_color[1] = 0.25f;
    water.attenuation_color[2] = 0.25f;
    add_sphere(&b, add_material(&b, &water), (float[]){0, 0, 0}, 1, 128, SPHERE_FLAT);
    add_sphere(&b, add_solid(&b, 1.33f, 0), (float[]){0, 0, 0}, .5f, 128, SPHERE_FLAT);
    set_environment(&b, 0, 1, 1, 1);
    kiln_camera view = camera_at((float[]){0, 0, 0}, (float[]){0.1f, 0.2f, -1}, 20);
    picture p = render(&b, &view, &(kiln_render_options){.spp = 256, .seed = 5, .max_depth = 2}, 8, 8);
    double r = normal_reflectance(1, 1.33), expected = (1 - r) * 0.5; /* half a metre of water, once */
    if (fabs(p.mean - expected) > 4 * p.mean_error + 2e-3 * expected)
        fail_msg("%.5f ± %.5f, not %.5f", p.mean, p.mean_error, expected);
    picture_free(&p);
    builder_free(&b);
}

/* Boundaries inside of glass that outranks them are no bounces: with as many as the slab needs, all light is seen that
 * passes without a reflection. */
static void hidden_boundaries_are_no_bounces(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_id glass = add_solid(&b, 1.5f, 1), hidden = add_solid(&b, 1.33f, 0);
    add_slab(&b, glass, 0, 1, 2);
    for (int i = 0; i < 3; i++) add_slab(&b, hidden, 0.1f + 0.3f * (float)i, 0.2f + 0.3f * (float)i, 1.5f);
    light_from_below(&b);
    kiln_camera view = camera_at((float[]){0.013f, 5, 0.017f}, (float[]){0.013f, 0, 0.017f}, 0.5);
    kiln_render_options o = {.spp = 1024, .seed = 3, .background = KILN_BACKGROUND_ENVIRONMENT, .max_depth = 2};
    picture p = render(&b, &view, &o, 8, 8);
    double expected = pow(1 - normal_reflectance(1, 1.5), 2);
    if (fabs(p.mean - expected) > 4 * p.mean_error + 1e-4)
        fail_msg("%.5f ± %.5f passes, not %.5f", p.mean, p.mean_error, expected);
    picture_free(&p);
    builder_free(&b);
}

/* A lamp within clear glass, and a wall beside it: where the glass outranks the lamp's, the lamp is not there, neither
 * to what meets it nor to light samples. */
static void hidden_boundaries_are_dark(void **state) {
    (void)state;
    for (int priority = 0; priority < 2; priority++)
        for (int e = 0; e < 3; e++) {
            scene_builder b = builder_make();
            kiln_material lamp = solid(1.33f), wall = diffuse_material(0.8f, 0.8f, 0.8f);
            for (int k = 0; k < 3; k++) lamp.emission.value[k] = 5;
            add_sphere(&b, add_solid(&b, 1.5f, priority), (float[]){0, 0, 0}, 1, 32, 0);
            add_sphere(&b, add_material(&b, &lamp), (float[]){.3f, 0, 0}, .2f, 16, 0);
            add_box(&b, add_material(&b, &wall), (float[]){-.5f, -.4f, -.4f}, (float[]){-.3f, .4f, .4f});
            kiln_camera view = camera_at((float[]){0, 0, 4}, (float[]){0, 0, 0}, 35);
            picture p = render(&b, &view, &(kiln_render_options){.spp = 16, .estimator = (kiln_estimator)e}, 16, 16);
            if ((p.mean == 0) != (priority == 1)) fail_msg("priority %d, estimator %d: %g", priority, e, p.mean);
            picture_free(&p);
            builder_free(&b);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(liquid_in_glass),    cmocka_unit_test(pieces_and_bubbles),
        cmocka_unit_test(coats_are_relative), cmocka_unit_test(equal_glass_is_invisible),
        cmocka_unit_test(camera_in_glass),    cmocka_unit_test(camera_in_nested_media),
        cmocka_unit_test(hidden_boundaries_are_no_bounces), cmocka_unit_test(hidden_boundaries_are_dark),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
