#include "tests/scene/support.h"

static void count_call(void *user) { ++*(int *)user; }

static void copies_unless_lent(void **state) {
    fixture *f = *state;
    uint16_t pixels[2] = {1, 2};
    uint8_t file[3] = {7, 8, 9};
    int calls = 0;
    kiln_image_desc image = {.name = "grey", .pixels = pixels, .width = 2, .height = 1, .channels = 1,
                             .format = KILN_PIXELS_U16};
    assert_true(kiln_scene_add_image(f->scene, &image, NULL, f->report));
    image = (kiln_image_desc){.encoded = file, .encoded_size = 3};
    assert_true(kiln_scene_add_image(f->scene, &image, NULL, f->report));
    image.release = count_call;
    image.release_user = &calls;
    assert_true(kiln_scene_add_image(f->scene, &image, NULL, f->report));
    pixels[1] = 5;
    file[2] = 0;
    assert_int_equal(((const uint16_t *)scene_image(f->scene, 1)->pixels)[1], 2);
    assert_int_equal(((const uint8_t *)scene_image(f->scene, 2)->encoded)[2], 9);
    assert_ptr_equal(scene_image(f->scene, 3)->encoded, file);
    assert_int_equal(calls, 0);
    kiln_scene_destroy(f->scene);
    assert_int_equal(calls, 1);
    f->scene = kiln_scene_create();
}

static void bad_images_are_refused_and_released(void **state) {
    fixture *f = *state;
    const uint8_t pixel = 0;
    int calls = 0;
    const kiln_image_desc bad[] = {
        {.width = 1, .height = 1, .channels = 1},
        {.pixels = &pixel, .encoded = &pixel, .encoded_size = 1, .width = 1, .height = 1, .channels = 1},
        {.encoded = &pixel},
        {.pixels = &pixel, .width = 0, .height = 1, .channels = 1},
        {.pixels = &pixel, .width = 1, .height = 65537, .channels = 1},
        {.pixels = &pixel, .width = 1, .height = 1, .channels = 0},
        {.pixels = &pixel, .width = 1, .height = 1, .channels = 5},
        {.pixels = &pixel, .width = 1, .height = 1, .channels = 1, .format = (kiln_pixel_format)3},
    };
    const int count = (int)(sizeof bad / sizeof *bad);
    for (int i = 0; i < count; i++) {
        kiln_image_desc image = bad[i];
        image.release = count_call;
        image.release_user = &calls;
        assert_false(kiln_scene_add_image(f->scene, &image, NULL, f->report));
        assert_int_equal(calls, i + 1);
        assert_int_equal(kiln_report_count(f->report, KILN_ERROR), i + 1);
    }
    assert_int_equal(f->scene->image_count, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {SCENE_TEST(copies_unless_lent), SCENE_TEST(bad_images_are_refused_and_released)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
