#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/job/support.h"
#include "kiln/job.h"

static const kiln_image_desc *studio_of(fixture *f, double azimuth) {
    assert_done(f, kiln_scene_set_studio(f->scene, azimuth, 1, f->report));
    assert_true(f->scene->has_environment);
    return scene_image(f->scene, f->scene->environment.image);
}

static const float *texel(const kiln_image_desc *i, uint32_t x, uint32_t y) {
    return (const float *)i->pixels + 3 * ((size_t)y * i->width + x);
}

/* kiln/scene.h: u = 0.5 + atan2(z, x)/2π, v = acos(y)/π. */
static dvec3 direction(const kiln_image_desc *i, uint32_t x, uint32_t y) {
    double phi = ((x + 0.5) / i->width - 0.5) * 2 * M_PI, theta = (y + 0.5) / i->height * M_PI;
    return (dvec3){sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi)};
}

/* Irradiance / π: what a white card of this normal shows. Camera at +Z; angles as in kiln_framing. */
static double card(const kiln_image_desc *i, double azimuth_deg, double elevation_deg) {
    double a = azimuth_deg * M_PI / 180, e = elevation_deg * M_PI / 180, sum = 0;
    dvec3 n = {sin(a) * cos(e), sin(e), cos(a) * cos(e)};
    for (uint32_t y = 0; y < i->height; y++)
        for (uint32_t x = 0; x < i->width; x++) {
            dvec3 d = direction(i, x, y);
            double angle = 2 * M_PI / i->width * M_PI / i->height * sqrt(1 - d.y * d.y);
            sum += fmax(d3_dot(d, n), 0) * angle * (double)texel(i, x, y)[0] / M_PI;
        }
    return sum;
}

static void grey_cards_come_out_as_authored(void **state) {
    const kiln_image_desc *i = studio_of(*state, 0);
    assert_in_range(1000 * card(i, 0, 0), 850, 1150);    /* facing the camera */
    assert_in_range(1000 * card(i, -45, 36), 1250, 1450); /* the key light */
    assert_in_range(1000 * card(i, 0, 90), 1200, 1500);  /* the top */
    assert_in_range(1000 * card(i, 135, -36), 550, 750); /* away from the key light */
    assert_in_range(1000 * card(i, 0, -90), 400, 700);   /* from below: not black */
}

static void it_is_neutral_and_nowhere_black(void **state) {
    const kiln_image_desc *i = studio_of(*state, 0);
    for (uint32_t y = 0; y < i->height; y++)
        for (uint32_t x = 0; x < i->width; x++) {
            const float *t = texel(i, x, y);
            assert_true(t[0] == t[1] && t[1] == t[2] && t[0] > 0.1f && t[0] < 10.0f);
        }
}

/* Behind the scene, from any height that a product is seen from, no lamp is in the picture, and neighbours differ by
 * less than a step of 8 bits: nothing but a soft gradient. */
static void the_backdrop_is_plain(void **state) {
    const kiln_image_desc *i = studio_of(*state, 0);
    for (uint32_t y = 0; y < i->height; y++)
        for (uint32_t x = 1; x < i->width; x++) {
            dvec3 d = direction(i, x, y);
            if (d.z > -0.8 || d.y > 0.35) continue;
            float here = texel(i, x, y)[0];
            assert_true(here > 0.25f && here < 0.46f); /* white things stand out, and black ones */
            assert_true(fabsf(here - texel(i, x - 1, y)[0]) < 0.004f);
        }
}

/* The scene keeps one picture; where the camera stands is how far it is turned. */
static void it_turns_with_the_camera(void **state) {
    fixture *f = *state;
    studio_of(f, 0.6);
    assert_true(f->scene->environment.rotation_rad == 0.6);
    assert_true(f->scene->environment.color[0] == 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {JOB_TEST(grey_cards_come_out_as_authored),
                                       JOB_TEST(it_is_neutral_and_nowhere_black), JOB_TEST(the_backdrop_is_plain),
                                       JOB_TEST(it_turns_with_the_camera)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
