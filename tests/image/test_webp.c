#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support.h"

static void lossless_round_trips_are_exact(void **state) {
    (void)state;
    for (uint32_t channels = 3; channels <= 4; channels++) {
        kiln_image want = pattern(33, 7, channels, 8);
        kiln_bytes file = encode_display("a.webp", &want, (kiln_image_write_options){.quality = 100});
        kiln_image got = decode_well(file.data, file.size);
        same_picture(&got, &want, 255, 0);
        image_free(&got);
        image_free(&want);
        file_free(&file);
    }
}

static void lossy_round_trips_are_close(void **state) {
    (void)state;
    kiln_image want = smooth(64, 48, 3);
    kiln_bytes file = encode_display("a.webp", &want, (kiln_image_write_options){0});
    kiln_image got = decode_well(file.data, file.size);
    same_picture(&got, &want, 255, 16);
    image_free(&got);
    image_free(&want);
    file_free(&file);
}

/* WebP has no grey: it comes back as three equal channels. */
static void grey_is_widened(void **state) {
    (void)state;
    for (uint32_t channels = 1; channels <= 2; channels++) {
        kiln_image want = pattern(5, 3, channels, 8);
        kiln_bytes file = encode_display("a.webp", &want, (kiln_image_write_options){.quality = 100});
        kiln_image got = decode_well(file.data, file.size);
        assert_int_equal(got.channels, channels + 2);
        for (size_t i = 0; i < 15; i++) {
            for (size_t c = 0; c < 3; c++)
                assert_float_equal(value_at(&got, i * got.channels + c), value_at(&want, i * channels) * 255, 0.01);
            if (channels == 2) assert_float_equal(value_at(&got, i * 4 + 3), value_at(&want, i * 2 + 1) * 255, 0.01);
        }
        image_free(&got);
        image_free(&want);
        file_free(&file);
    }
}

static void animations_are_refused(void **state) {
    (void)state;
    /* RIFF, WEBP, VP8X of 10 bytes with the animation flag, canvas of 2 × 2. */
    static const unsigned char file[] = "RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\x02\0\0\0\x01\0\0\x01\0\0";
    decode_fails(file, sizeof file - 1, KILN_CODE_IMAGE);
}

static void giants_are_refused(void **state) {
    (void)state;
    folder f = folder_make("a.webp");
    kiln_image image = pattern(16384, 1, 3, 8);
    kiln_report *report = kiln_report_create();
    assert_false(image_write_display(f.file, &image, NULL, report));
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 1);
    kiln_report_destroy(report);
    image_free(&image);
    folder_remove(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lossless_round_trips_are_exact), cmocka_unit_test(lossy_round_trips_are_close),
        cmocka_unit_test(grey_is_widened),                cmocka_unit_test(animations_are_refused),
        cmocka_unit_test(giants_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
