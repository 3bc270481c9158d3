#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "support.h"

#include "exr_maker.h"

/* A small integer, so that it is exact in every pixel type; smooth, so that lossy compressions are close. */
static float ramp(int x, int y, int channel) { return (float)(100 + 3 * x + y + 40 * channel); }

/* Decodes, and compares the picture with the ramp inside the data window, and with 0 outside of it. order[c]: which
 * of the file's channels the image's channel c is. */
static void check(const exr_form *parts, int count, int part, uint32_t channels, const int *order, float tolerance) {
    kiln_text file = make_exr(parts, count, ramp);
    kiln_image image = decode_well(file.data, file.length);
    const exr_form *f = &parts[part];
    assert_int_equal(image.width, f->display[2] - f->display[0] + 1);
    assert_int_equal(image.height, f->display[3] - f->display[1] + 1);
    assert_int_equal(image.channels, channels);
    assert_int_equal(image.format, KILN_PIXELS_F32);
    size_t i = 0;
    for (int y = f->display[1]; y <= f->display[3]; y++)
        for (int x = f->display[0]; x <= f->display[2]; x++)
            for (uint32_t c = 0; c < channels; c++, i++) {
                bool inside = x >= f->data[0] && x <= f->data[2] && y >= f->data[1] && y <= f->data[3];
                float want = inside ? ramp(x, y, order[c]) : 0;
                if (fabsf(value_at(&image, i) - want) > tolerance * want)
                    fail_msg("compression %d, tile %d: channel %d at %d, %d is %g, not %g", f->compression, f->tile,
                             (int)c, x, y, (double)value_at(&image, i), (double)want);
            }
    image_free(&image);
    text_free(&file);
}

static const int rgb_order[] = {2, 1, 0}, grey_order[] = {0};

static exr_form rgb_form(void) {
    return (exr_form){
        .channels = {"B", "G", "R"}, .type = EXR_PIXEL_HALF, .data = {0, 0, 69, 44}, .display = {0, 0, 69, 44}};
}

static void every_type_layout_and_compression(void **state) {
    (void)state;
    for (int compression = EXR_COMPRESSION_NONE; compression <= EXR_COMPRESSION_B44A; compression++)
        for (int type = EXR_PIXEL_UINT; type < EXR_PIXEL_LAST_TYPE; type++)
            for (int tile = 0; tile <= 32; tile += 32) {
                bool lossy = compression >= EXR_COMPRESSION_PXR24;
                exr_form f = rgb_form();
                f.compression = (exr_compression_t)compression;
                f.type = (exr_pixel_type_t)type;
                f.tile = tile;
                check(&f, 1, 0, 3, rgb_order, lossy && type != EXR_PIXEL_UINT ? 0.03f : 0);
            }
}

static void windows(void **state) {
    (void)state;
    const int cases[][8] = {
        {10, 20, 40, 50, 0, 0, 69, 69},      /* a crop */
        {-7, -9, 30, 25, -7, -9, 30, 25},    /* away from the origin */
        {-16, -20, 90, 80, 0, 0, 59, 49},    /* overscan */
        {50, 40, 100, 100, 0, 0, 69, 69},    /* half outside */
        {200, 200, 230, 230, 0, 0, 9, 9},    /* wholly outside: black */
    };
    for (int i = 0; i < COUNT(cases); i++)
        for (int tile = 0; tile <= 16; tile += 16) {
            exr_form f = rgb_form();
            memcpy(f.data, cases[i], sizeof f.data);
            memcpy(f.display, cases[i] + 4, sizeof f.display);
            f.compression = EXR_COMPRESSION_ZIP;
            f.tile = tile;
            check(&f, 1, 0, 3, rgb_order, 0);
        }
}

static void channels_are_chosen(void **state) {
    (void)state;
    const exr_form base = rgb_form();
    exr_form f = base;
    memcpy(f.channels, (const char *[8]){"Y"}, sizeof f.channels);
    check(&f, 1, 0, 1, grey_order, 0);
    memcpy(f.channels, (const char *[8]){"R"}, sizeof f.channels);
    check(&f, 1, 0, 1, grey_order, 0);
    memcpy(f.channels, (const char *[8]){"B", "G", "R", "Z", "albedo.R", "depth"}, sizeof f.channels);
    check(&f, 1, 0, 3, rgb_order, 0);
    /* The first part has nothing to show, the second is the picture. */
    exr_form parts[2] = {base, base};
    memcpy(parts[0].channels, (const char *[8]){"Z"}, sizeof f.channels);
    parts[0].display[2] = parts[0].data[2] = 9;
    check(parts, 2, 1, 3, rgb_order, 0);
}

static float half_alpha(int x, int y, int channel) {
    (void)y;
    return channel == 0 ? (x == 0 ? 0.0f : 0.5f) : 0.25f; /* A, B, G, R */
}

static void colour_becomes_straight(void **state) {
    (void)state;
    exr_form f = {
        .channels = {"A", "B", "G", "R"}, .type = EXR_PIXEL_FLOAT, .data = {0, 0, 1, 0}, .display = {0, 0, 1, 0}};
    kiln_text file = make_exr(&f, 1, half_alpha);
    kiln_image image = decode_well(file.data, file.length);
    const float want[8] = {0.25f, 0.25f, 0.25f, 0, 0.5f, 0.5f, 0.5f, 0.5f};
    assert_int_equal(image.channels, 4);
    assert_memory_equal(image.pixels, want, sizeof want);
    image_free(&image);
    text_free(&file);
}

static float specials(int x, int y, int channel) {
    const float values[4] = {INFINITY, -INFINITY, NAN, 0x1p-24f};
    (void)y, (void)channel;
    return values[x];
}

static void special_values_pass(void **state) {
    (void)state;
    for (int type = EXR_PIXEL_HALF; type <= EXR_PIXEL_FLOAT; type++) {
        exr_form f = {.channels = {"Y"}, .type = (exr_pixel_type_t)type, .data = {0, 0, 3, 0}, .display = {0, 0, 3, 0}};
        kiln_text file = make_exr(&f, 1, specials);
        kiln_image image = decode_well(file.data, file.length);
        assert_true(value_at(&image, 0) == INFINITY && value_at(&image, 1) == -INFINITY);
        assert_true(value_at(&image, 2) != value_at(&image, 2) && value_at(&image, 3) == 0x1p-24f);
        image_free(&image);
        text_free(&file);
    }
}

static void refused_forms(void **state) {
    (void)state;
    exr_form f = rgb_form();
    memcpy(f.channels, (const char *[8]){"Z", "normal.X"}, sizeof f.channels);
    kiln_text file = make_exr(&f, 1, ramp);
    decode_fails(file.data, file.length, KILN_CODE_IMAGE);
    text_free(&file);
    /* Luminance and chroma, at full resolution and at half. */
    memcpy(f.channels, (const char *[8]){"BY", "RY", "Y"}, sizeof f.channels);
    file = make_exr(&f, 1, ramp);
    decode_fails(file.data, file.length, KILN_CODE_IMAGE);
    text_free(&file);
    f.sampling = 2;
    f.data[2] = f.display[2] = f.data[3] = f.display[3] = 63;
    file = make_exr(&f, 1, ramp);
    decode_fails(file.data, file.length, KILN_CODE_IMAGE);
    text_free(&file);
}

static void a_giant_window_is_refused(void **state) {
    (void)state;
    exr_form f = rgb_form();
    f.display[2] = 65536;
    kiln_text file = make_exr(&f, 1, ramp);
    decode_fails(file.data, file.length, KILN_CODE_LIMIT);
    text_free(&file);
    f.display[2] = f.display[3] = 65535; /* 48 GiB */
    file = make_exr(&f, 1, ramp);
    decode_fails(file.data, file.length, KILN_CODE_LIMIT);
    text_free(&file);
}

/* OpenEXRCore 3.1 knows DWAA and DWAB, but has no code for them. */
static void a_compression_without_a_decoder_is_named(void **state) {
    (void)state;
    exr_form f = rgb_form();
    f.compression = EXR_COMPRESSION_ZIPS;
    kiln_text file = make_exr(&f, 1, ramp);
    static const char attribute[] = "compression\0compression\0\1\0\0\0\2";
    char *found = memmem(file.data, file.length, attribute, sizeof attribute - 1);
    assert_non_null(found);
    found[sizeof attribute - 2] = EXR_COMPRESSION_DWAA;
    decode_fails(file.data, file.length, KILN_CODE_IMAGE);
    text_free(&file);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_layout_and_compression),
        cmocka_unit_test(windows),
        cmocka_unit_test(channels_are_chosen),
        cmocka_unit_test(colour_becomes_straight),
        cmocka_unit_test(special_values_pass),
        cmocka_unit_test(refused_forms),
        cmocka_unit_test(a_giant_window_is_refused),
        cmocka_unit_test(a_compression_without_a_decoder_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
