#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "job/exposure.h"
#include "tests/job/support.h"

enum { COUNT = 1000 };

static double expose(double (*luminance)(int i)) {
    float values[COUNT];
    for (int i = 0; i < COUNT; i++) values[(i * 7) % COUNT] = (float)luminance(i);
    return exposure_of(values, COUNT);
}

static double uniform(int i) { return i >= 0 ? 1800 : 0; }
static double black(int i) { return i * 0.0; }
static double half_black(int i) { return i % 2 ? 0 : 1800; }
static double half_shadow(int i) { return i % 2 ? 1e-3 : 1800; }
/* Nine tenths at 1, one tenth at 64: the middle alone would ask for log2(0.18) − 0.6, the bright part for −6. */
static double bright_part(int i) { return i < COUNT / 10 ? 64 : 1; }
static double few_highlights(int i) { return i < COUNT / 50 ? 1e6 : 1; }

/* An even surface becomes middle grey: log2(0.18/1800) = −13.29, in tenths. */
static void the_middle_becomes_grey(void **state) {
    (void)state;
    assert_near(expose(uniform), -13.3, 1e-9);
    assert_near(expose(half_black), -13.3, 1e-9);
    assert_near(expose(half_shadow), -13.3, 1e-9);
}

static void bright_parts_do_not_burn_out(void **state) {
    (void)state;
    assert_near(expose(bright_part), -6, 1e-9);
    /* 2 % are highlights, which move the mean of the logarithms by 0.02 · 19.9. */
    assert_near(expose(few_highlights), -2.9, 1e-9);
}

static void black_is_left_alone(void **state) {
    (void)state;
    assert_true(expose(black) == 0);
    assert_true(exposure_of(NULL, 0) == 0);
}

/* A white Lambertian floor of albedo 0.5 under 10,000 lux shows 10,000 · 0.5/π = 1592 cd/m², so −13.1 stops. */
static void sunlight_in_lux_is_brought_down(void **state) {
    fixture *f = *state;
    kiln_light sun = kiln_light_default();
    const mat4 down = {{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1}}; /* −Z becomes −Y */
    sun.kind = KILN_LIGHT_DISTANT;
    sun.intensity = 10000;
    memcpy(sun.transform, down.m, sizeof down.m);
    add_box(f, (float[]){-1, -0.1f, -1}, (float[]){1, 0, 1}, add_material(f, 0.5f, 0));
    assert_done(f, kiln_scene_add_light(f->scene, &sun, NULL, f->report));
    assert_done(f, kiln_scene_commit(f->scene, f->report));
    kiln_camera above = kiln_camera_default();
    memcpy(above.transform, down.m, sizeof down.m);
    above.transform[13] = 2;
    kiln_renderer *renderer;
    double stops;
    assert_done(f, kiln_renderer_create(f->scene, NULL, &renderer, f->report));
    assert_done(f, exposure_choose(renderer, &(kiln_render_options){.camera = &above, .spp = 1, .noise = 1}, 4000, 2000,
                                   &stops, f->report));
    assert_near(stops, -13.1, 1e-9);
    kiln_renderer_destroy(renderer);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_middle_becomes_grey), cmocka_unit_test(bright_parts_do_not_burn_out),
        cmocka_unit_test(black_is_left_alone), JOB_TEST(sunlight_in_lux_is_brought_down)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
