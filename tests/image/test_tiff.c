#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "image/half.h"
#include "support.h"

#include "tiff_maker.h"

static void check(kiln_bytes file, uint32_t channels, kiln_pixel_format format, const float *want, int count) {
    kiln_image image = decode_well(file.data, file.size);
    assert_int_equal(image.channels, channels);
    assert_int_equal(image.format, format);
    for (int i = 0; i < count; i++)
        if (value_at(&image, (size_t)i) != want[i])
            fail_msg("sample %d is %g, not %g", i, (double)value_at(&image, (size_t)i), (double)want[i]);
    image_free(&image);
    file_free(&file);
}

static void round_trips_are_exact(void **state) {
    (void)state;
    for (uint32_t bits = 8; bits <= 16; bits += 8)
        for (uint32_t channels = 1; channels <= 4; channels++) {
            kiln_image want = pattern(37, 11, channels, bits);
            kiln_bytes file = encode_display("a.tif", &want, (kiln_image_write_options){.bits = bits});
            kiln_image got = decode_well(file.data, file.size);
            assert_int_equal(got.format, bits == 8 ? KILN_PIXELS_U8 : KILN_PIXELS_U16);
            same_picture(&got, &want, bits == 8 ? 255 : 65535, 0);
            image_free(&got);
            image_free(&want);
            file_free(&file);
        }
}

static void text_and_profile_are_written(void **state) {
    (void)state;
    const char *text[] = {"Software", "kiln", "Samples", "64"};
    kiln_image image = pattern(4, 4, 3, 8);
    kiln_bytes file =
        encode_display("a.tiff", &image, (kiln_image_write_options){.srgb = true, .text = text, .text_count = 2});
    image_tiff_stream stream = {.bytes = file.data, .size = file.size};
    TIFF *tiff = image_tiff_open(&stream, "r", 1 << 20);
    char *description = NULL;
    void *profile = NULL;
    uint32_t length = 0;
    assert_true(TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &description));
    assert_string_equal(description, "Software: kiln\nSamples: 64");
    assert_true(TIFFGetField(tiff, TIFFTAG_ICCPROFILE, &length, &profile));
    assert_memory_equal((char *)profile + 36, "acsp", 4);
    TIFFClose(tiff);
    file_free(&file);
    image_free(&image);
}

static void floats_stay_floats(void **state) {
    (void)state;
    const float wide[6] = {0.1f, -2, 1e30f, 0, 3.5f, 7};
    uint16_t halves[6];
    float rounded[6];
    for (int i = 0; i < 6; i++) {
        halves[i] = float_to_half(wide[i]);
        rounded[i] = half_to_float(halves[i]);
    }
    tiff_form f = {.bits = 32, .samples = 3, .format = SAMPLEFORMAT_IEEEFP, .photometric = PHOTOMETRIC_RGB};
    check(make_tiff(2, 1, f, wide), 3, KILN_PIXELS_F32, wide, 6);
    f.bits = 16;
    check(make_tiff(2, 1, f, halves), 3, KILN_PIXELS_F32, rounded, 6);
}

/* The same samples in strips, tiles and planes, compressed or not. */
static void layouts(void **state) {
    (void)state;
    enum { WIDTH = 21, HEIGHT = 18 };
    unsigned char rows[HEIGHT * WIDTH * 3], planes[HEIGHT * WIDTH * 3];
    float want[HEIGHT * WIDTH * 3];
    for (int i = 0; i < HEIGHT * WIDTH * 3; i++) {
        rows[i] = (unsigned char)hash32((uint32_t)i);
        planes[i % 3 * HEIGHT * WIDTH + i / 3] = rows[i];
        want[i] = rows[i];
    }
    tiff_form f = {.bits = 8, .samples = 3, .photometric = PHOTOMETRIC_RGB};
    const uint16_t compressions[] = {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_PACKBITS,
                                     COMPRESSION_ADOBE_DEFLATE};
    for (int i = 0; i < COUNT(compressions); i++) {
        f.compression = compressions[i];
        check(make_tiff(WIDTH, HEIGHT, f, rows), 3, KILN_PIXELS_U8, want, HEIGHT * WIDTH * 3);
        f.tile = 16;
        check(make_tiff(WIDTH, HEIGHT, f, rows), 3, KILN_PIXELS_U8, want, HEIGHT * WIDTH * 3);
        f.tile = 0;
        f.planar = PLANARCONFIG_SEPARATE;
        check(make_tiff(WIDTH, HEIGHT, f, planes), 3, KILN_PIXELS_U8, want, HEIGHT * WIDTH * 3);
        f.planar = 0;
    }
}

static void alpha_becomes_straight(void **state) {
    (void)state;
    const unsigned char rgba[8] = {50, 25, 0, 100, 9, 8, 7, 0};
    tiff_form f = {
        .bits = 8, .samples = 4, .photometric = PHOTOMETRIC_RGB, .has_extra = true, .extra = EXTRASAMPLE_UNASSALPHA};
    check(make_tiff(2, 1, f, rgba), 4, KILN_PIXELS_U8, (const float[]){50, 25, 0, 100, 9, 8, 7, 0}, 8);
    f.extra = EXTRASAMPLE_ASSOCALPHA; /* 50 · 255/100 = 127.5 → 128; 25 → 64; under alpha 0 nothing changes */
    check(make_tiff(2, 1, f, rgba), 4, KILN_PIXELS_U8, (const float[]){128, 64, 0, 100, 9, 8, 7, 0}, 8);
    f.extra = EXTRASAMPLE_UNSPECIFIED; /* who knows what the fourth is: not alpha */
    check(make_tiff(2, 1, f, rgba), 3, KILN_PIXELS_U8, (const float[]){50, 25, 0, 9, 8, 7}, 6);
    const uint16_t wide[2] = {100, 1000};
    f = (tiff_form){.bits = 16,
                    .samples = 2,
                    .photometric = PHOTOMETRIC_MINISBLACK,
                    .has_extra = true,
                    .extra = EXTRASAMPLE_ASSOCALPHA};
    check(make_tiff(1, 1, f, wide), 2, KILN_PIXELS_U16, (const float[]){6554, 1000}, 2); /* 6553.5 rounds up */
    const float floats[4] = {0.5f, 1, 0, 0.25f};
    f = (tiff_form){.bits = 32,
                    .samples = 4,
                    .photometric = PHOTOMETRIC_RGB,
                    .has_extra = true,
                    .extra = EXTRASAMPLE_ASSOCALPHA,
                    .format = SAMPLEFORMAT_IEEEFP};
    check(make_tiff(1, 1, f, floats), 4, KILN_PIXELS_F32, (const float[]){2, 4, 0, 0.25f}, 4);
}

static void orientations(void **state) {
    (void)state;
    const unsigned char rows[6] = {1, 2, 3, 4, 5, 6};
    const float wants[4][6] = {{1, 2, 3, 4, 5, 6}, {3, 2, 1, 6, 5, 4}, {6, 5, 4, 3, 2, 1}, {4, 5, 6, 1, 2, 3}};
    tiff_form f = {.bits = 8, .samples = 1, .photometric = PHOTOMETRIC_MINISBLACK};
    for (f.orientation = 1; f.orientation <= 4; f.orientation++)
        check(make_tiff(3, 2, f, rows), 1, KILN_PIXELS_U8, wants[f.orientation - 1], 6);
    f.orientation = ORIENTATION_RIGHTTOP;
    kiln_bytes file = make_tiff(3, 2, f, rows);
    decode_fails(file.data, file.size, KILN_CODE_IMAGE);
    file_free(&file);
}

/* Everything else of up to 16 bits becomes 8-bit RGB. */
static void converted_forms(void **state) {
    (void)state;
    const uint16_t palette[3 * 4] = {0, 0xffff, 0x8000, 0, 0, 0, 0x4000, 0, 0xffff, 0, 0, 0};
    const unsigned char indices[1] = {0x18}; /* 0 1 2 0 */
    tiff_form f = {.bits = 2, .samples = 1, .photometric = PHOTOMETRIC_PALETTE, .palette = palette};
    check(make_tiff(4, 1, f, indices), 3, KILN_PIXELS_U8, (const float[]){0, 0, 255, 255, 0, 0, 128, 64, 0, 0, 0, 255},
          12);
    const unsigned char bits[1] = {0x80}, grey[1] = {255}, ink[4] = {255, 0, 0, 0};
    f = (tiff_form){.bits = 1, .samples = 1, .photometric = PHOTOMETRIC_MINISBLACK};
    check(make_tiff(2, 1, f, bits), 3, KILN_PIXELS_U8, (const float[]){255, 255, 255, 0, 0, 0}, 6);
    f = (tiff_form){.bits = 8, .samples = 1, .photometric = PHOTOMETRIC_MINISWHITE};
    check(make_tiff(1, 1, f, grey), 3, KILN_PIXELS_U8, (const float[]){0, 0, 0}, 3);
    f = (tiff_form){.bits = 8, .samples = 4, .photometric = PHOTOMETRIC_SEPARATED};
    check(make_tiff(1, 1, f, ink), 3, KILN_PIXELS_U8, (const float[]){0, 255, 255}, 3);
}

static void unusual_samples_are_refused(void **state) {
    (void)state;
    const uint32_t integers[3] = {1, 2, 3};
    const double doubles[1] = {1};
    kiln_bytes file = make_tiff(1, 1, (tiff_form){.bits = 32, .samples = 3, .photometric = PHOTOMETRIC_RGB}, integers);
    decode_fails(file.data, file.size, KILN_CODE_IMAGE);
    file_free(&file);
    file = make_tiff(
        1, 1,
        (tiff_form){.bits = 64, .samples = 1, .format = SAMPLEFORMAT_IEEEFP, .photometric = PHOTOMETRIC_MINISBLACK},
        doubles);
    decode_fails(file.data, file.size, KILN_CODE_IMAGE);
    file_free(&file);
}

static void a_giant_tile_is_refused_before_it_is_allocated(void **state) {
    (void)state;
    const unsigned char row[1] = {7};
    kiln_bytes file =
        make_tiff(1, 1, (tiff_form){.bits = 8, .samples = 1, .photometric = PHOTOMETRIC_MINISBLACK, .tile = 16}, row);
    /* The tile's sides, entries 322 and 323 of the directory, SHORT or LONG: 65520 each. */
    int patched = 0;
    for (size_t i = 0; i + 12 <= file.size; i++)
        if ((file.data[i] == 0x42 || file.data[i] == 0x43) && file.data[i + 1] == 1 && file.data[i + 4] == 1 &&
            file.data[i + 8] == 16) {
            file.data[i + 8] = 0xf0;
            file.data[i + 9] = 0xff;
            patched++;
        }
    assert_int_equal(patched, 2);
    kiln_image image;
    kiln_code code;
    assert_false(decode(file.data, file.size, 1 << 20, &image, &code));
    file_free(&file);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trips_are_exact),
        cmocka_unit_test(text_and_profile_are_written),
        cmocka_unit_test(floats_stay_floats),
        cmocka_unit_test(layouts),
        cmocka_unit_test(alpha_becomes_straight),
        cmocka_unit_test(orientations),
        cmocka_unit_test(converted_forms),
        cmocka_unit_test(unusual_samples_are_refused),
        cmocka_unit_test(a_giant_tile_is_refused_before_it_is_allocated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
