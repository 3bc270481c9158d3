#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support.h"
#include "tests/assets.h"

#include "jpeg_maker.h"

static void check_colour(kiln_bytes *file, uint32_t width, uint32_t height, uint32_t channels, const int *want) {
    kiln_image image = decode_well(file->data, file->size);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    assert_int_equal(image.channels, channels);
    for (size_t i = 0; i < (size_t)width * height * channels; i++)
        if (abs((int)value_at(&image, i) - want[i % channels]) > 3)
            fail_msg("sample %d is %d, not %d", (int)i, (int)value_at(&image, i), want[i % channels]);
    image_free(&image);
    file_free(file);
}

static void round_trips_are_close(void **state) {
    (void)state;
    for (uint32_t channels = 1; channels <= 3; channels += 2)
        for (uint32_t quality = 50; quality <= 100; quality += 50) {
            kiln_image want = smooth(65, 31, channels);
            kiln_bytes file = encode_display("a.jpg", &want, (kiln_image_write_options){.quality = quality});
            kiln_image got = decode_well(file.data, file.size);
            assert_int_equal(got.format, KILN_PIXELS_U8);
            same_picture(&got, &want, 255, quality == 100 ? 4 : 20);
            image_free(&got);
            image_free(&want);
            file_free(&file);
        }
}

static void forms_of_colour(void **state) {
    (void)state;
    const unsigned char grey[] = {77}, rgb[] = {200, 100, 50}, ink[] = {255, 51, 0, 204};
    const int as_grey[] = {77}, as_rgb[] = {200, 100, 50};
    kiln_bytes file = make_jpeg(
        20, 10, (jpeg_form){.input = JCS_GRAYSCALE, .file = JCS_GRAYSCALE, .components = 1, .progressive = true}, grey);
    check_colour(&file, 20, 10, 1, as_grey);
    file =
        make_jpeg(20, 10, (jpeg_form){.input = JCS_RGB, .file = JCS_YCbCr, .components = 3, .progressive = true}, rgb);
    check_colour(&file, 20, 10, 3, as_rgb);
    file = make_jpeg(20, 10, (jpeg_form){.input = JCS_RGB, .file = JCS_RGB, .components = 3}, rgb);
    check_colour(&file, 20, 10, 3, as_rgb);

    /* Adobe: 255 is no ink. 255 · 204/255, 51 · 204/255, 0. */
    const int inverted[] = {204, 41, 0};
    file = make_jpeg(20, 10, (jpeg_form){.input = JCS_CMYK, .file = JCS_CMYK, .components = 4}, ink);
    check_colour(&file, 20, 10, 3, inverted);
    file = make_jpeg(20, 10, (jpeg_form){.input = JCS_CMYK, .file = JCS_YCCK, .components = 4}, ink);
    check_colour(&file, 20, 10, 3, inverted);
    /* Without Adobe's marker 255 is full ink: 0, (255 − 51) (255 − 204)/255, 255 − 204. */
    const int plain[] = {0, 41, 51};
    file = make_jpeg(20, 10, (jpeg_form){.input = JCS_CMYK, .file = JCS_CMYK, .components = 4, .no_adobe_marker = true},
                     ink);
    check_colour(&file, 20, 10, 3, plain);
}

static void orientation_is_ignored(void **state) {
    (void)state;
    const unsigned char rgb[] = {200, 100, 50};
    const int want[] = {200, 100, 50};
    kiln_bytes file =
        make_jpeg(20, 10, (jpeg_form){.input = JCS_RGB, .file = JCS_YCbCr, .components = 3, .exif_turned = true}, rgb);
    check_colour(&file, 20, 10, 3, want);
}

/* Each scan passes over the whole image, so a tiny file could ask for hours. */
static void too_many_scans_are_refused(void **state) {
    (void)state;
    const unsigned char grey[] = {77};
    jpeg_scan_info scans[1 + 63 * 5] = {{1, {0}, 0, 0, 0, 0}};
    int count = 1;
    for (int low = 4; low >= 0; low--)
        for (int k = 1; k < 64; k++) scans[count++] = (jpeg_scan_info){1, {0}, k, k, low == 4 ? 0 : low + 1, low};
    kiln_bytes file = make_jpeg(
        16, 16,
        (jpeg_form){
            .input = JCS_GRAYSCALE, .file = JCS_GRAYSCALE, .components = 1, .scans = scans, .scan_count = count},
        grey);
    decode_fails(file.data, file.size, KILN_CODE_IMAGE);
    file_free(&file);
    file = make_jpeg(
        16, 16,
        (jpeg_form){
            .input = JCS_GRAYSCALE, .file = JCS_GRAYSCALE, .components = 1, .scans = scans, .scan_count = 1 + 63 * 2},
        grey);
    check_colour(&file, 16, 16, 1, (const int[]){77});
}

static void a_short_file_is_truncated(void **state) {
    (void)state;
    kiln_image image = smooth(65, 31, 3);
    kiln_bytes file = encode_display("a.jpg", &image, (kiln_image_write_options){0});
    decode_fails(file.data, file.size / 2, KILN_CODE_FILE_TRUNCATED);
    decode_fails(file.data, 30, KILN_CODE_FILE_TRUNCATED);
    file_free(&file);
    image_free(&image);
}

static void colour_at_full_resolution_and_a_profile(void **state) {
    (void)state;
    kiln_image image = smooth(8, 8, 3);
    kiln_bytes file = encode_display("a.jpg", &image, (kiln_image_write_options){.srgb = true});
    struct jpeg_error_mgr errors;
    struct jpeg_decompress_struct jpeg = {.err = jpeg_std_error(&errors)};
    JOCTET *profile = NULL;
    unsigned length = 0;
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, file.data, file.size);
    jpeg_save_markers(&jpeg, JPEG_APP0 + 2, 0xffff);
    jpeg_read_header(&jpeg, TRUE);
    assert_int_equal(jpeg.comp_info[0].h_samp_factor, 1);
    assert_true(jpeg_read_icc_profile(&jpeg, &profile, &length));
    assert_true(length > 128);
    assert_memory_equal(profile + 36, "acsp", 4);
    free(profile);
    jpeg_destroy_decompress(&jpeg);
    file_free(&file);
    image_free(&image);
}

static void alpha_is_refused(void **state) {
    (void)state;
    for (uint32_t channels = 2; channels <= 4; channels += 2) {
        folder f = folder_make("a.jpg");
        kiln_image image = smooth(8, 8, channels);
        kiln_report *report = kiln_report_create();
        assert_false(image_write_display(f.file, &image, NULL, report));
        assert_int_equal(kiln_report_count(report, KILN_ERROR), 1);
        assert_non_null(strstr(kiln_report_message(report, 0).what, "alpha"));
        assert_string_equal(kiln_report_message(report, 0).where, f.file);
        kiln_report_destroy(report);
        image_free(&image);
        folder_remove(&f);
    }
}

static void assets_are_green(void **state) {
    (void)state;
    const char *root = assets_or_skip();
    const struct {
        const char *name;
        uint32_t channels;
    } files[] = {{"jpeg_cmyk_8-bit", 3}, {"jpeg_grayscale_8-bit", 1}, {"jpeg_rgb_8-bit", 3}};
    for (int i = 0; i < COUNT(files); i++) {
        char path[4200];
        snprintf(path, sizeof path, "%s/usd/TextureFileFormatTests/%s.jpg", root, files[i].name);
        kiln_bytes file = read_whole(path);
        kiln_image image = decode_well(file.data, file.size);
        assert_int_equal(image.channels, files[i].channels);
        size_t middle = ((size_t)128 * 256 + 128) * image.channels;
        if (image.channels == 3) /* the middle of the hue circle's lower part */
            assert_true(value_at(&image, middle + 1) > 200 && value_at(&image, middle) < 100);
        image_free(&image);
        file_free(&file);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trips_are_close),
        cmocka_unit_test(forms_of_colour),
        cmocka_unit_test(orientation_is_ignored),
        cmocka_unit_test(too_many_scans_are_refused),
        cmocka_unit_test(a_short_file_is_truncated),
        cmocka_unit_test(colour_at_full_resolution_and_a_profile),
        cmocka_unit_test(alpha_is_refused),
        cmocka_unit_test(assets_are_green),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
