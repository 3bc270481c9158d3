/* Dispersion: white stays white, and what a prism does with it. Statistical comparisons
 * allow 4 standard errors; the seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "render/film/film.h"
#include "render/world/spectrum.h"
#include "tests/render/scenes.h"

static const float identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static kiln_material glass(float ior, float dispersion, float roughness) {
    kiln_material m = kiln_material_default();
    m.layers = KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME | KILN_LAYER_DISPERSION;
    m.metallic.value = 0, m.roughness.value = roughness, m.transmission.value = 1, m.thickness.value = 1;
    m.ior = ior;
    m.dispersion = dispersion;
    return m;
}

static void channel_means(const picture *p, double mean[3], double error[3]) {
    size_t pixels = (size_t)p->width * p->height;
    memset(mean, 0, 3 * sizeof *mean), memset(error, 0, 3 * sizeof *error);
    for (size_t i = 0; i < pixels; i++) {
        double m[3], v[3];
        film_read_pixel(p->film, i, m, v);
        for (int k = 0; k < 3; k++) mean[k] += m[k] / (double)pixels, error[k] += v[k];
    }
    for (int k = 0; k < 3; k++) error[k] = sqrt(error[k]) / (double)pixels;
}

/* Clear glass under an even white sky is as white as the sky, from outside and from inside, smooth and rough. */
static void white_stays_white(void **state) {
    (void)state;
    for (int inside = 0; inside < 2; inside++)
        for (int rough = 0; rough < 2; rough++) {
            scene_builder b = builder_make();
            kiln_material m = glass(1.8f, 1, rough ? 0.4f : 0);
            add_sphere(&b, add_material(&b, &m), (float[]){0, 0, 0}, 1, 32, 0);
            set_environment(&b, 0, 1, 1, 1);
            kiln_camera view = camera_at((float[]){0, 0.2f, inside ? 0.4f : 4}, (float[]){0.1f, 0, 0}, 28);
            picture p = render(&b, &view, &(kiln_render_options){.spp = 256, .seed = 3, .max_depth = 256}, 24, 24);
            double mean[3], error[3];
            channel_means(&p, mean, error);
            for (int k = 0; k < 3; k++) /* a reflection at the outside is not coloured: one per mille; rough walls: tables */
                if (fabs(mean[k] - 1) > 4 * error[k] + (rough ? 5e-3 : 1e-3))
                    fail_msg("inside %d, rough %d, channel %d: %.5f ± %.5f", inside, rough, k, mean[k], error[k]);
            picture_free(&p);
            builder_free(&b);
        }
}

/* Light that crosses diffusely takes on a wavelength as well: of single paths each has its colour, and all are white. */
static void diffuse_crossings_take_on_a_wavelength(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material m = glass(1.5f, 1, 0.5f);
    m.layers = KILN_LAYER_DIFFUSE_TRANSMISSION | KILN_LAYER_VOLUME | KILN_LAYER_DISPERSION;
    m.transmission.value = 0, m.diffuse_transmission.value = 1;
    add_sphere(&b, add_material(&b, &m), (float[]){0, 0, 0}, 1, 32, 0);
    set_environment(&b, 0, 1, 1, 1);
    kiln_camera view = camera_at((float[]){0, 0.2f, 4}, (float[]){0.1f, 0, 0}, 24);
    picture one = render(&b, &view, &(kiln_render_options){.spp = 1, .seed = 3, .max_depth = 256}, 24, 24);
    picture many = render(&b, &view, &(kiln_render_options){.spp = 64, .seed = 3, .max_depth = 256}, 24, 24);
    int coloured = 0;
    for (int i = 0; i < 24 * 24; i++) coloured += fabsf(one.rgb[3 * i] - one.rgb[3 * i + 2]) > 0.5f;
    assert_true(coloured > 24 * 24 / 2);
    double mean[3], error[3];
    channel_means(&many, mean, error);
    for (int k = 0; k < 3; k++) /* the reflection is not coloured, but what is left by it is */
        if (fabs(mean[k] - 1) > 4 * error[k] + 1e-2) fail_msg("channel %d: %.5f ± %.5f", k, mean[k], error[k]);
    picture_free(&one);
    picture_free(&many);
    builder_free(&b);
}

/* A prism of 40°, its edge along x, and what lies behind it: radiance −cos of the polar angle, below the horizon. */
static void add_prism(scene_builder *b, kiln_id material) {
    const float h = (float)(2 * tan(20 * M_PI / 180)), p[18] = {-3, h, 1, -3, -h, 1, -3, 0, -1, 3, h, 1, 3, -h, 1, 3, 0, -1};
    const uint32_t sizes[5] = {3, 3, 4, 4, 4}, faces[18] = {0, 2, 1, 3, 4, 5, 0, 1, 4, 3, 1, 2, 5, 4, 2, 0, 3, 5};
    kiln_id mesh = add_mesh(b, &(kiln_mesh_desc){.name = "prism", .vertex_count = 6, .positions = p, .face_count = 5,
                                                 .face_sizes = sizes, .face_vertices = faces, .material = material});
    add_instance(b, mesh, NULL);
}

/* Refracts a ray in the (y, z) plane at a normal that it comes against; returns the part that passes. */
static double refract(double d[2], const double normal[2], double eta) {
    double c = -(d[0] * normal[0] + d[1] * normal[1]), t = sqrt(1 - (1 - c * c) / (eta * eta));
    for (int k = 0; k < 2; k++) d[k] = d[k] / eta + normal[k] * (c / eta - t);
    double rs = (c - eta * t) / (c + eta * t), rp = (eta * c - t) / (eta * c + t);
    return 1 - 0.5 * (rs * rs + rp * rp);
}

static double radiance_from(double y) { return y < 0 ? -y : 0; }

/* Seen through two faces: each channel is the sum over wavelengths of what lies where that wavelength goes. */
static void a_prism_spreads_wavelengths(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material m = glass(1.6f, 3, 0);
    add_prism(&b, add_material(&b, &m));
    enum { ROWS = 256 };
    float rows[ROWS * 3];
    for (int i = 0; i < ROWS; i++)
        for (int k = 0; k < 3; k++) rows[3 * i + k] = (float)radiance_from(cos(M_PI * (i + 0.5) / ROWS));
    set_environment(&b, add_image(&b, rows, 1, ROWS), 1, 1, 1);
    kiln_camera view = camera_at((float[]){0.02f, 3, 0.6f}, (float[]){0.02f, 0.3f, 0}, 0.05);
    picture p = render(&b, &view, &(kiln_render_options){.spp = 4096, .seed = 9, .max_depth = 2}, 4, 4);
    double mean[3], error[3], expected[3] = {0, 0, 0};
    channel_means(&p, mean, error);
    float table[SPECTRUM_FLOATS];
    spectrum_make(identity, table);
    const double upper[2] = {cos(20 * M_PI / 180), -sin(20 * M_PI / 180)}; /* faces of the prism, outward */
    const double lower[2] = {upper[0], -upper[1]};                         /* and inward */
    enum { LINES = 4096 };
    for (int i = 0; i < LINES; i++) {
        spectrum_line l = spectrum_draw(table, ((float)i + 0.5f) / LINES);
        double n = 1.6 + 0.6 * 3 / 20 * (523655 / pow((double)l.wavelength, 2) - 1.5168);
        double d[2] = {-2.7 / hypot(2.7, 0.6), -0.6 / hypot(2.7, 0.6)};
        double passes = refract(d, upper, n) * refract(d, lower, 1 / n), seen = passes * radiance_from(d[0]);
        expected[0] += (double)l.weight.x * seen / LINES, expected[1] += (double)l.weight.y * seen / LINES;
        expected[2] += (double)l.weight.z * seen / LINES;
    }
    for (int k = 0; k < 3; k++)
        if (!(fabs(mean[k] - expected[k]) < 4 * error[k] + 2e-3 * expected[k]))
            fail_msg("channel %d: %.5f ± %.5f, not %.5f", k, mean[k], error[k], expected[k]);
    assert_true(fabs(expected[0] - expected[2]) > 0.01 * expected[1]); /* or the test would see no dispersion */
    picture_free(&p);
    builder_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_stays_white),
        cmocka_unit_test(diffuse_crossings_take_on_a_wavelength),
        cmocka_unit_test(a_prism_spreads_wavelengths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
