#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "support.h"
#include "tests/assets.h"

static kiln_text make(const char *header, const char *pixels, size_t size) {
    kiln_text file = {0};
    text_append(&file, header);
    text_append_bytes(&file, pixels, size);
    return file;
}

#define MAKE(header, pixels) make(header, pixels, sizeof(pixels) - 1)
#define PLAIN "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"

static void check(kiln_text file, uint32_t width, uint32_t height, const float *want) {
    kiln_image image = decode_well(file.data, file.length);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    assert_int_equal(image.channels, 3);
    assert_int_equal(image.format, KILN_PIXELS_F32);
    for (size_t i = 0; i < (size_t)width * height * 3; i++)
        if (value_at(&image, i) != want[i])
            fail_msg("sample %d is %g, not %g", (int)i, (double)value_at(&image, i), (double)want[i]);
    image_free(&image);
    text_free(&file);
}

/* mantissa · 2^(exponent − 136) */
static void flat_pixels(void **state) {
    (void)state;
    check(MAKE(PLAIN "-Y 1 +X 3\n", "\x80\x40\x20\x81" "\x01\x02\x03\x88" "\x05\x05\x05\x00"), 3, 1,
          (const float[]){1, 0.5f, 0.25f, 1, 2, 3, 0, 0, 0});
}

static void older_runs(void **state) {
    (void)state;
    /* A pixel, then itself twice more. */
    check(MAKE(PLAIN "-Y 1 +X 4\n", "\x01\x02\x03\x88" "\x01\x01\x01\x02" "\x07\x08\x09\x88"), 4, 1,
          (const float[]){1, 2, 3, 1, 2, 3, 1, 2, 3, 7, 8, 9});
    /* Two counts in a row are one of 2 + 256 · 1. */
    kiln_text file = MAKE(PLAIN "-Y 1 +X 259\n", "\x01\x02\x03\x88" "\x01\x01\x01\x02" "\x01\x01\x01\x01");
    kiln_image image = decode_well(file.data, file.length);
    assert_true(value_at(&image, 258 * 3 + 2) == 3);
    image_free(&image);
    text_free(&file);
}

static void newer_runs(void **state) {
    (void)state;
    /* Eight pixels: red a run of 8 ones, green 1 … 8, blue two runs, exponent a run. */
    check(MAKE(PLAIN "-Y 1 +X 8\n", "\x02\x02\x00\x08" "\x88\x01" "\x08\x01\x02\x03\x04\x05\x06\x07\x08"
                                    "\x84\x07\x84\x09" "\x88\x88"),
          8, 1, (const float[]){1, 1, 7, 1, 2, 7, 1, 3, 7, 1, 4, 7, 1, 5, 9, 1, 6, 9, 1, 7, 9, 1, 8, 9});
}

/* Two rows of two pixels, a b / c d in the file's order, and where they end up. */
static void orientations(void **state) {
    (void)state;
    static const struct {
        const char *size;
        uint32_t width, height;
        float want[6];
    } cases[] = {
        {"-Y 2 +X 3\n", 3, 2, {1, 2, 3, 4, 5, 6}}, {"-Y 2 -X 3\n", 3, 2, {3, 2, 1, 6, 5, 4}},
        {"+Y 2 +X 3\n", 3, 2, {4, 5, 6, 1, 2, 3}}, {"+Y 2 -X 3\n", 3, 2, {6, 5, 4, 3, 2, 1}},
        {"+X 2 -Y 3\n", 2, 3, {1, 4, 2, 5, 3, 6}}, {"-X 2 -Y 3\n", 2, 3, {4, 1, 5, 2, 6, 3}},
        {"+X 2 +Y 3\n", 2, 3, {3, 6, 2, 5, 1, 4}}, {"-X 2 +Y 3\n", 2, 3, {6, 3, 5, 2, 4, 1}},
    };
    for (int i = 0; i < COUNT(cases); i++) {
        kiln_text file = {0};
        text_format(&file, "%s%s", PLAIN, cases[i].size);
        float want[18];
        for (int k = 0; k < 6; k++) {
            text_append_bytes(&file, (char[]){(char)(k + 1), 0, 0, (char)0x88}, 4);
            want[3 * k] = cases[i].want[k];
            want[3 * k + 1] = want[3 * k + 2] = 0;
        }
        check(file, cases[i].width, cases[i].height, want);
    }
}

static void exposure_and_colour_correction_are_undone(void **state) {
    (void)state;
    check(MAKE("#?RGBE\n# a comment\nEXPOSURE=2\nEXPOSURE= 4.0\nCOLORCORR=1 2 0.5\n\n-Y 1 +X 1\n", "\x08\x08\x08\x88"),
          1, 1, (const float[]){1, 0.5f, 2});
}

static void other_headers(void **state) {
    (void)state;
    check(MAKE("#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 1 +X 1\r\n", "\x08\x08\x08\x88"), 1, 1,
          (const float[]){8, 8, 8});
    kiln_text file = MAKE("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n", "\x08\x08\x08\x88");
    decode_fails(file.data, file.length, KILN_CODE_IMAGE);
    text_free(&file);
}

static void broken_files(void **state) {
    (void)state;
    static const struct {
        const char *text;
        size_t size;
        kiln_code code;
    } files[] = {
#define CASE(text, code) {text, sizeof(text) - 1, code}
        CASE("#?RADIANCE\n", KILN_CODE_FILE_TRUNCATED),
        CASE(PLAIN, KILN_CODE_FILE_TRUNCATED),
        CASE(PLAIN "-Y 1 +X 1\n\1\2\3", KILN_CODE_FILE_TRUNCATED),
        CASE(PLAIN "-Y 1 -Y 1\n\1\2\3\4", KILN_CODE_IMAGE),
        CASE(PLAIN "Y 1 X 1\n\1\2\3\4", KILN_CODE_IMAGE),
        CASE(PLAIN "-Y 1 +X 1 +Z 1\n\1\2\3\4", KILN_CODE_IMAGE),
        CASE(PLAIN "-Y 1 +X -1\n\1\2\3\4", KILN_CODE_IMAGE),
        CASE(PLAIN "-Y 0 +X 1\n\1\2\3\4", KILN_CODE_IMAGE),
        CASE(PLAIN "-Y 1 +X 65537\n\1\2\3\4", KILN_CODE_LIMIT),
        CASE(PLAIN "-Y 99999999999999999999 +X 1\n\1\2\3\4", KILN_CODE_LIMIT),
        CASE("#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n\1\2\3\4", KILN_CODE_IMAGE),
        CASE("#?RADIANCE\nEXPOSURE=x\n\n-Y 1 +X 1\n\1\2\3\4", KILN_CODE_IMAGE),
        CASE("#?RADIANCE\nCOLORCORR=1 1\n\n-Y 1 +X 1\n\1\2\3\4", KILN_CODE_IMAGE),
        CASE(PLAIN "-Y 1 +X 2\n\1\1\1\2", KILN_CODE_IMAGE),               /* repeats nothing */
        CASE(PLAIN "-Y 1 +X 2\n\1\2\3\4\1\1\1\7", KILN_CODE_IMAGE),       /* leaves its row */
        CASE(PLAIN "-Y 1 +X 8\n\2\2\0\x08\x89\1", KILN_CODE_IMAGE),       /* a run of 9 in a row of 8 */
        CASE(PLAIN "-Y 1 +X 8\n\2\2\0\x08\0\0", KILN_CODE_IMAGE),         /* an empty run */
        CASE(PLAIN "-Y 1 +X 8\n\2\2\0\x08\x08\1\2", KILN_CODE_FILE_TRUNCATED),
#undef CASE
    };
    for (int i = 0; i < COUNT(files); i++) decode_fails(files[i].text, files[i].size, files[i].code);
}

static kiln_bytes write_hdr(const kiln_image *image) {
    folder f = folder_make("a.hdr");
    kiln_report *report = kiln_report_create();
    assert_true(image_write_hdr(f.file, image, NULL, 0, report));
    kiln_report_destroy(report);
    kiln_bytes file = read_whole(f.file);
    folder_remove(&f);
    return file;
}

/* A mantissa of the largest channel has 8 bits, 128 … 255, rounded to nearest: 1/256 of the largest channel. */
static void round_trips_are_within_half_a_mantissa(void **state) {
    (void)state;
    const uint32_t widths[] = {1, 7, 8, 300, 40000};
    for (int w = 0; w < COUNT(widths); w++) {
        kiln_image image = pattern(widths[w], 3, 3, 16);
        float *at = image.pixels;
        for (size_t i = 0; i < (size_t)widths[w] * 9; i++) /* some long runs, some noise, many magnitudes */
            at[i] = (i / 90) % 2 ? 0.75f : ldexpf(at[i], (int)(hash32((uint32_t)i / 3) % 60) - 30);
        kiln_bytes file = write_hdr(&image);
        kiln_image got = decode_well(file.data, file.size);
        assert_int_equal(got.width, widths[w]);
        for (size_t i = 0; i < (size_t)widths[w] * 9; i++) {
            const float *pixel = at + i / 3 * 3;
            float largest = fmaxf(pixel[0], fmaxf(pixel[1], pixel[2]));
            if (fabsf(value_at(&got, i) - at[i]) > largest / 255.0f)
                fail_msg("sample %d is %g, not %g", (int)i, (double)value_at(&got, i), (double)at[i]);
        }
        /* Written again, it is the same file: nothing drifts. */
        kiln_bytes again = write_hdr(&got);
        assert_int_equal(file.size, again.size);
        assert_memory_equal(file.data, again.data, file.size);
        if (widths[w] == 300) assert_true(file.size < 300 * 3 * 4);
        file_free(&again);
        file_free(&file);
        image_free(&got);
        image_free(&image);
    }
}

static void extreme_values(void **state) {
    (void)state;
    kiln_image image = pattern(5, 1, 3, 8);
    const float values[15] = {INFINITY, 1, 0, NAN, -1, 2, 0, 0, 0, 1e-40f, 0, 0, 0.998f, 3e38f, 0};
    memcpy(image.pixels, values, sizeof values);
    kiln_bytes file = write_hdr(&image);
    kiln_image got = decode_well(file.data, file.size);
    for (size_t i = 0; i < 15; i++) assert_true(isfinite(value_at(&got, i)));
    assert_true(value_at(&got, 0) > 1e38f && value_at(&got, 13) > 1e38f);
    assert_true(value_at(&got, 3) == 0 && value_at(&got, 4) == 0 && value_at(&got, 5) == 2);
    assert_true(value_at(&got, 9) == 0);
    image_free(&got);
    image_free(&image);
    file_free(&file);
}

static void assets_decode(void **state) {
    (void)state;
    const char *root = assets_or_skip();
    const struct {
        const char *name;
        uint32_t width, height;
    } files[] = {{"royal_esplanade_1k", 1024, 512}, {"chinese_garden_1k", 1024, 512}, {"std_env", 1500, 750}};
    for (int i = 0; i < COUNT(files); i++) {
        char path[4200];
        snprintf(path, sizeof path, "%s/env/%s.hdr", root, files[i].name);
        kiln_bytes file = read_whole(path);
        kiln_image image = decode_well(file.data, file.size);
        assert_int_equal(image.width, files[i].width);
        assert_int_equal(image.height, files[i].height);
        double sum = 0;
        for (size_t k = 0; k < (size_t)image.width * image.height * 3; k++) {
            assert_true(isfinite(value_at(&image, k)) && value_at(&image, k) >= 0);
            sum += (double)value_at(&image, k);
        }
        assert_true(sum > 0);
        image_free(&image);
        file_free(&file);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_pixels),
        cmocka_unit_test(older_runs),
        cmocka_unit_test(newer_runs),
        cmocka_unit_test(orientations),
        cmocka_unit_test(exposure_and_colour_correction_are_undone),
        cmocka_unit_test(other_headers),
        cmocka_unit_test(broken_files),
        cmocka_unit_test(round_trips_are_within_half_a_mantissa),
        cmocka_unit_test(extreme_values),
        cmocka_unit_test(assets_decode),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
