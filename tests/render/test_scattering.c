/* Media that scatter: the phase function, the energy that they keep, and what an independent random walk finds.
 * Statistical comparisons allow 4 standard errors; the seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "render/film/film.h"
#include "render/path/flight.h"
#include "render/world/world.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

static const float anisotropies[] = {-0.999f, -0.9f, -0.5f, -1e-4f, 0, 1e-3f, 0.3f, 0.8f, 0.95f, 0.999f};
enum { ANISOTROPIES = sizeof anisotropies / sizeof *anisotropies };

/* Probability that the turn has a cosine of at most mu (Henyey and Greenstein, integrated). */
static double phase_cdf(double g, double mu) {
    if (fabs(g) < 1e-2) return 0.5 * (mu + 1) + 0.75 * g * (mu * mu - 1);
    return (1 - g * g) / (2 * g) * (1 / sqrt(1 + g * g - 2 * g * mu) - 1 / (1 + g));
}

/* Over the cosine, by its density in cells that each hold as much: 2 π p dμ. */
static void the_phase_function_integrates_to_one(void **state) {
    (void)state;
    const vec3 wo = {0, 0, 1};
    for (int i = 0; i < ANISOTROPIES; i++) {
        double g = (double)anisotropies[i], sum = 0;
        enum { CELLS = 20000 };
        for (int k = 0; k < CELLS; k++) { /* in v³ of 1 ∓ μ, dense at the peak */
            double v0 = (double)k / CELLS, v1 = (k + 1.0) / CELLS, turn = 2 * pow(0.5 * (v0 + v1), 6);
            double width = 2 * (pow(v1, 6) - pow(v0, 6)), sine = sqrt(turn * (2 - turn));
            vec3 wi = {(float)sine, 0, (float)(g > 0 ? turn - 1 : 1 - turn)};
            sum += 2 * M_PI * width * (double)phase_value(wo, wi, anisotropies[i]);
        }
        if (fabs(sum - 1) > 2e-3) fail_msg("g = %g: the phase function integrates to %.5f", g, sum);
    }
}

static void phase_samples_follow_it(void **state) {
    (void)state;
    enum { BINS = 64, DRAWS = 100000 };
    for (int i = 0; i < ANISOTROPIES; i++) {
        double g = (double)anisotropies[i], turned[BINS] = {0}, around[BINS] = {0}, expected[BINS];
        vec3 wo = v3_normalize(v3(0.3f, -0.7f, 0.2f));
        stream s = {77, 0};
        frame f = frame_make(wo);
        for (int k = 0; k < BINS; k++) expected[k] = (double)DRAWS / BINS;
        for (int k = 0; k < DRAWS; k++) {
            vec3 wi = phase_sample(wo, anisotropies[i], stream_pair(&s));
            vec3 back = v3_add(wi, wo), forth = v3_sub(wi, wo);
            double mu = g > 0 ? 0.5 * (double)v3_dot(back, back) : 0.5 * (double)v3_dot(forth, forth);
            mu = g > 0 ? 1 - mu : mu - 1;
            int bin = (int)(phase_cdf(g, mu) * BINS);
            turned[bin < 0 ? 0 : bin < BINS ? bin : BINS - 1]++;
            vec3 local = frame_to_local(&f, wi);
            bin = (int)((atan2((double)local.y, (double)local.x) / (2 * M_PI) + 0.5) * BINS);
            around[bin < BINS ? bin : BINS - 1]++;
        }
        double level = sidak(0.001, 2 * ANISOTROPIES), p = chi_square_p(turned, expected, BINS);
        double q = chi_square_p(around, expected, BINS);
        if (p < level || q < level) fail_msg("g = %g: p = %g along, %g around", g, p, q);
    }
}

/* Of a white medium's flights the weights are 1 in the mean, for every channel, also those that nothing is in: clear ones
 * let all pass and scatter nothing. */
static void flights_are_fair_to_clear_channels(void **state) {
    (void)state;
    static const vec3 sigmas[] = {{0, 1, 3}, {0, 0, 0.5f}, {0, 1e30f, 1}, {2, 2, 2}};
    static const vec3 throughputs[] = {{1, 1, 1}, {1, 0, 0}, {0, 0, 0}, {0, 0.5f, 2}, {1e-30f, 1, 1}};
    enum { DISTANCES = 2048, CHANNELS = 60 }; /* of which the shares are whole */
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 5; k++) {
            dvec3 mean = {0, 0, 0};
            const double n = DISTANCES * CHANNELS;
            for (int u = 0; u < DISTANCES * CHANNELS; u++) { /* 0 is drawn too */
                float at = (float)(u / CHANNELS) / DISTANCES, channel = ((float)(u % CHANNELS) + 0.5f) / CHANNELS;
                flight f = flight_sample(sigmas[i], v3_splat(1), throughputs[k], 1.5f, at, channel);
                assert_true(isfinite(f.distance) && f.distance >= 0 && f.distance <= 1.5f);
                assert_true(isfinite(f.weight.x) && isfinite(f.weight.y) && isfinite(f.weight.z));
                mean = d3_add(mean, (dvec3){(double)f.weight.x / n, (double)f.weight.y / n, (double)f.weight.z / n});
            }
            const vec3 t = throughputs[k];
            if ((t.x > 0 && fabs(mean.x - 1) > 2e-2) || (t.y > 0 && fabs(mean.y - 1) > 2e-2) ||
                (t.z > 0 && fabs(mean.z - 1) > 2e-2))
                fail_msg("extinction %d, throughput %d: %.4f %.4f %.4f", i, k, mean.x, mean.y, mean.z);
        }
}

static kiln_material medium(float ior, float r, float g, float b, float distance, float white, float mean_cosine) {
    kiln_material m = kiln_material_default();
    m.layers = KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME | KILN_LAYER_VOLUME_SCATTER;
    m.metallic.value = 0, m.roughness.value = 0, m.transmission.value = 1, m.thickness.value = 1;
    m.ior = ior;
    m.attenuation_color[0] = r, m.attenuation_color[1] = g, m.attenuation_color[2] = b;
    m.attenuation_distance = distance;
    for (int k = 0; k < 3; k++) m.multiscatter_color[k] = white;
    m.scatter_anisotropy = mean_cosine;
    return m;
}

/* What absorbs nothing gives everything back: under an even sky it is as bright as the sky. */
static void white_media_are_white(void **state) {
    (void)state;
    const float rows[][4] = {{1, 0, 0, 0.3f}, {1, 0.8f, 0.6f, 0.1f}, {1.5f, -0.5f, 0, 0.3f}, {1.33f, 0.8f, 0.4f, 0.3f}};
    for (int i = 0; i < 4; i++)
        for (int e = 0; e < 3; e++) {
            scene_builder b = builder_make();
            kiln_material m = medium(rows[i][0], 0.1f, 0.3f, 0.2f, rows[i][3], 1, rows[i][1]);
            m.roughness.value = rows[i][2];
            add_sphere(&b, add_material(&b, &m), (float[]){0, 0, 0}, 1, 32, 0);
            set_environment(&b, 0, 1, 1, 1);
            kiln_camera view = camera_at((float[]){0, 0, 4}, (float[]){0, 0, 0}, 26);
            kiln_render_options o = {.spp = 32, .seed = 2, .estimator = (kiln_estimator)e, .max_depth = 512};
            picture p = render(&b, &view, &o, 16, 16);
            /* Rough walls: the tables of their albedo are good for 2 per mille a crossing. */
            double slack = rows[i][2] > 0 ? 2e-2 : 1e-4;
            if (fabs(p.mean - 1) > 4 * p.mean_error + slack)
                fail_msg("row %d, estimator %d: %.5f ± %.5f comes back", i, e, p.mean, p.mean_error);
            picture_free(&p);
            builder_free(&b);
        }
}

/* An analog walk in a ball of radius 1, in double: how much of the light that leaves it along a diameter has met
 * albedo^n. */
static double walk(stream *s, double sigma, double albedo, double g) {
    double p[3] = {0, 0, 1}, d[3] = {0, 0, -1}, weight = 1;
    for (;;) {
        double t = -log(1 - (double)stream_next(s)) / sigma, r2 = 0;
        for (int k = 0; k < 3; k++) p[k] += t * d[k], r2 += p[k] * p[k];
        if (r2 >= 1) return weight;
        weight *= albedo;
        double u = (double)stream_next(s), q = (1 - g * g) / (1 - g + 2 * g * u);
        double mu = g == 0 ? 1 - 2 * u : (1 + g * g - q * q) / (2 * g), sine = sqrt(fmax(1 - mu * mu, 0));
        double phi = 2 * M_PI * (double)stream_next(s), x[3], y[3];
        int axis = fabs(d[0]) < 0.5 ? 0 : 1; /* any frame about d */
        double e[3] = {axis == 0, axis == 1, 0}, along = d[axis], length = sqrt(1 - along * along);
        for (int k = 0; k < 3; k++) x[k] = (e[k] - along * d[k]) / length;
        for (int k = 0; k < 3; k++) y[k] = d[(k + 1) % 3] * x[(k + 2) % 3] - d[(k + 2) % 3] * x[(k + 1) % 3];
        for (int k = 0; k < 3; k++) d[k] = mu * d[k] + sine * (cos(phi) * x[k] + sin(phi) * y[k]);
    }
}

static void coloured_media_walk_as_they_should(void **state) {
    (void)state;
    const float gs[] = {-0.5f, 0, 0.8f};
    for (int i = 0; i < 3; i++) {
        scene_builder b = builder_make();
        kiln_material m = medium(1, 0.05f, 0.4f, 0.9f, 0.5f, 0.8f, gs[i]);
        m.multiscatter_color[0] = 0.95f, m.multiscatter_color[2] = 0.3f;
        add_sphere(&b, add_material(&b, &m), (float[]){0, 0, 0}, 1, 256, SPHERE_FLAT);
        set_environment(&b, 0, 1, 1, 1);
        world *w = build_world(&b);
        kiln_camera view = camera_at((float[]){0, 0, 3}, (float[]){0, 0, 0}, 0.5);
        picture p = render(&b, &view, &(kiln_render_options){.spp = 4096, .seed = 4, .max_depth = 512}, 4, 4);
        for (int k = 0; k < 3; k++) {
            tally walks = {0}, pixels = {0};
            stream s = {5, 0};
            double sigma = (double)w->extinction[3 + k] * w->scale, albedo = (double)w->albedo[3 + k];
            for (int n = 0; n < 200000; n++) tally_add(&walks, walk(&s, sigma, albedo, (double)gs[i]));
            double variance = 0;
            for (size_t n = 0; n < 16; n++) {
                double mean[3], v[3];
                film_read_pixel(p.film, n, mean, v);
                tally_add(&pixels, mean[k]);
                variance += v[k] / 256;
            }
            double error = hypot(sqrt(variance), tally_error(&walks));
            if (fabs(pixels.mean - walks.mean) > 4 * error + 5e-4)
                fail_msg("g = %g, channel %d: %.5f, a walk says %.5f, ± %.5f", (double)gs[i], k, pixels.mean, walks.mean, error);
        }
        picture_free(&p);
        world_destroy(w);
        builder_free(&b);
    }
}

/* A point light in thin fog: along the ray, ∫ σs p(θ) I/r² exp(−σ(t + r)) dt; twice scattered light is a thousandth. */
static void thin_fog_shows_a_lamp(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material m = medium(1, 0.98f, 0.98f, 0.98f, 1, 0.01f, 0.6f);
    add_box(&b, add_material(&b, &m), (float[]){-2, -2, -2}, (float[]){2, 2, 2});
    kiln_light lamp = light_at(KILN_LIGHT_POINT, (float[]){0.5f, 0, 0}, (float[]){0, 0, 0}, 10);
    add_light(&b, &lamp);
    world *w = build_world(&b);
    kiln_camera view = camera_at((float[]){0, 0, 5}, (float[]){0, 0, 0}, 0.02);
    picture p = render(&b, &view, &(kiln_render_options){.spp = 4096, .seed = 4}, 4, 4);
    double sigma = (double)w->extinction[3] * w->scale, albedo = (double)w->albedo[3], g = 0.6, sum = 0;
    enum { STEPS = 100000 };
    for (int i = 0; i < STEPS; i++) {
        double t = 4 * (i + 0.5) / STEPS, z = 2 - t, r = hypot(0.5, z), mu = z / r; /* light goes on by (−.5, 0, z)/r, to +z */
        double phase = (1 - g * g) / (4 * M_PI * pow(1 + g * g - 2 * g * mu, 1.5));
        sum += 4.0 / STEPS * sigma * albedo * phase * 10 / (r * r) * exp(-sigma * (t + r));
    }
    if (fabs(p.mean - sum) > 4 * p.mean_error + 3e-3 * sum) fail_msg("%.6f ± %.6f, not %.6f", p.mean, p.mean_error, sum);
    picture_free(&p);
    world_destroy(w);
    builder_free(&b);
}

/* A lamp of some size in fog: hit, or sampled, or both. */
static void estimators_agree_in_fog(void **state) {
    (void)state;
    picture p[3];
    for (int e = 0; e < 3; e++) {
        scene_builder b = builder_make();
        kiln_material fog = medium(1, 0.3f, 0.5f, 0.7f, 1, 0.7f, 0.5f), lamp = diffuse_material(0.4f, 0.4f, 0.4f);
        for (int k = 0; k < 3; k++) lamp.emission.value[k] = 5;
        add_box(&b, add_material(&b, &fog), (float[]){-2, -2, -2}, (float[]){2, 2, 2});
        add_sphere(&b, add_material(&b, &lamp), (float[]){0.6f, 0.2f, 0}, 0.4f, 16, SPHERE_FLAT);
        kiln_camera view = camera_at((float[]){0, 0, 1.9f}, (float[]){0, 0, 0}, 50); /* inside */
        kiln_render_options o = {.spp = e == 2 ? 1024 : 256, .seed = 7 + (uint64_t)e, .estimator = (kiln_estimator)e};
        p[e] = render(&b, &view, &o, 16, 16);
        builder_free(&b);
    }
    for (int e = 1; e < 3; e++)
        if (fabs(p[e].mean - p[0].mean) > 4 * hypot(p[e].mean_error, p[0].mean_error))
            fail_msg("estimator %d: %.5f ± %.5f, MIS says %.5f ± %.5f", e, p[e].mean, p[e].mean_error, p[0].mean,
                     p[0].mean_error);
    for (int e = 0; e < 3; e++) picture_free(&p[e]);
}

/* A box without a lid holds fog as well as it can: every sample is a number, and the user is told. */
static void open_meshes_end(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material m = medium(1.3f, 0.1f, 0.5f, 0.9f, 0.2f, 1, 0.5f), clear = m;
    m.name = "mist", clear.name = "still";
    clear.layers &= ~(uint32_t)KILN_LAYER_VOLUME_SCATTER;
    add_quad(&b, add_material(&b, &m), (float[]){-1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1});
    add_quad(&b, add_material(&b, &clear), (float[]){-1, -1, 1, 1, -1, 1, 1, -1, -1, -1, -1, -1});
    add_box(&b, add_material(&b, &clear), (float[]){-.3f, -.3f, -.3f}, (float[]){.3f, .3f, .3f});
    set_environment(&b, 0, 1, 1, 1);
    kiln_camera view = camera_at((float[]){0, 2, 3}, (float[]){0, 0, 0}, 50);
    picture p = render(&b, &view, &(kiln_render_options){.spp = 64}, 16, 16);
    for (int d = 0; d < KILN_DISCARD_COUNT; d++) assert_true(p.stats.discarded[d] == 0);
    assert_true(p.mean > 0.1 && isfinite(p.mean));
    picture_free(&p);
    size_t told = 0;
    for (size_t i = 0; i < kiln_report_size(b.report); i++) {
        kiln_message text = kiln_report_message(b.report, i);
        told += text.severity == KILN_WARNING && strstr(text.what, "is open") != NULL;
        if (!strstr(text.what, "is open")) continue;
        assert_true(strstr(text.where, "quad") && (strstr(text.what, "mist") || strstr(text.what, "still")));
    }
    assert_int_equal(told, 2);
    builder_free(&b);
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_phase_function_integrates_to_one),
        cmocka_unit_test(phase_samples_follow_it),
        cmocka_unit_test(flights_are_fair_to_clear_channels),
        cmocka_unit_test(white_media_are_white),
        cmocka_unit_test(coloured_media_walk_as_they_should),
        cmocka_unit_test(thin_fog_shows_a_lamp),
        cmocka_unit_test(estimators_agree_in_fog),
        cmocka_unit_test(open_meshes_end),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]); /* of mutants: the case that must see them */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
