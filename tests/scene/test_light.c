#include "tests/scene/support.h"

#include <math.h>

/* KHR_lights_punctual: the defaults of its properties. */
static void defaults_are_gltfs(void **state) {
    fixture *f = *state;
    kiln_light light = kiln_light_default();
    assert_true(light.color[2] == 1 && light.intensity == 1 && light.inner_cone_rad == 0);
    assert_true(fabsf(light.outer_cone_rad - (float)(M_PI / 4)) < 1e-7f);
    assert_true(kiln_scene_add_light(f->scene, &light, NULL, f->report));
    assert_int_equal(kiln_report_size(f->report), 0);
}

static void values_are_brought_into_their_domain(void **state) {
    fixture *f = *state;
    kiln_light light = kiln_light_default();
    light.name = "lamp";
    light.kind = KILN_LIGHT_SPOT;
    light.intensity = -3;
    light.color[0] = NAN;
    light.outer_cone_rad = 3;
    light.inner_cone_rad = 2;
    assert_true(kiln_scene_add_light(f->scene, &light, NULL, f->report));
    const kiln_light *kept = scene_light(f->scene, 1);
    assert_true(kept->intensity == 0 && kept->color[0] == 1);
    assert_true(kept->outer_cone_rad < 1.5708f && kept->inner_cone_rad == kept->outer_cone_rad);
    assert_true(says(f->report, KILN_WARNING, "light 'lamp'", "intensity is -3: 0 is used"));
    assert_true(says(f->report, KILN_WARNING, "light 'lamp'", "color is not a number: 1 is used"));
}

static void a_light_without_direction_is_dark(void **state) {
    fixture *f = *state;
    kiln_light light = kiln_light_default();
    memset(light.transform, 0, 11 * sizeof(double));
    light.transform[12] = 4;
    assert_true(kiln_scene_add_light(f->scene, &light, NULL, f->report)); /* a point light needs none */
    assert_int_equal(kiln_report_size(f->report), 0);
    assert_true(scene_light(f->scene, 1)->intensity == 1);
    light.kind = KILN_LIGHT_DISTANT;
    assert_true(kiln_scene_add_light(f->scene, &light, NULL, f->report));
    assert_true(says(f->report, KILN_WARNING, "light 2", "the transform leaves no direction"));
    const kiln_light *kept = scene_light(f->scene, 2);
    assert_true(kept->intensity == 0 && kept->transform[10] == 1 && kept->transform[12] == 4);
}

static void what_cannot_be_is_refused(void **state) {
    fixture *f = *state;
    kiln_light light = kiln_light_default();
    light.transform[13] = INFINITY;
    assert_false(kiln_scene_add_light(f->scene, &light, NULL, f->report));
    light = kiln_light_default();
    light.kind = (kiln_light_kind)3;
    assert_false(kiln_scene_add_light(f->scene, &light, NULL, f->report));
    assert_true(says(f->report, KILN_ERROR, "light 1", "light kind 3"));
    assert_int_equal(f->scene->light_count, 0);
}

static void the_environment_is_checked(void **state) {
    fixture *f = *state;
    assert_false(kiln_scene_set_environment(f->scene, &(kiln_environment){.image = 1}, f->report));
    assert_true(says(f->report, KILN_ERROR, "environment", "image 1 does not exist"));
    assert_false(kiln_scene_set_environment(f->scene, &(kiln_environment){.transfer = KILN_TRANSFER_COUNT}, f->report));
    assert_false(f->scene->has_environment);
    kiln_environment sky = {.color = {-1, 2, NAN}, .rotation_rad = INFINITY};
    assert_true(kiln_scene_set_environment(f->scene, &sky, f->report));
    assert_true(f->scene->has_environment && f->scene->environment.rotation_rad == 0);
    assert_memory_equal(f->scene->environment.color, ((float[3]){0, 2, 1}), sizeof(float[3]));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        SCENE_TEST(defaults_are_gltfs),
        SCENE_TEST(values_are_brought_into_their_domain),
        SCENE_TEST(a_light_without_direction_is_dark),
        SCENE_TEST(what_cannot_be_is_refused),
        SCENE_TEST(the_environment_is_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
