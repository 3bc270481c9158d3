#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support.h"
#include "tests/assets.h"

#include "png_maker.h"

static void check_samples(kiln_text *file, uint32_t channels, kiln_pixel_format format, const unsigned *want,
                          int count) {
    kiln_image image = decode_well(file->data, file->length);
    assert_int_equal(image.channels, channels);
    assert_int_equal(image.format, format);
    for (int i = 0; i < count; i++) assert_int_equal((unsigned)value_at(&image, (size_t)i), want[i]);
    image_free(&image);
    text_free(file);
}

static void round_trips_are_exact(void **state) {
    (void)state;
    const uint32_t sizes[][2] = {{1, 1}, {7, 5}, {300, 2}};
    for (uint32_t bits = 8; bits <= 16; bits += 8)
        for (uint32_t channels = 1; channels <= 4; channels++)
            for (int s = 0; s < COUNT(sizes); s++) {
                kiln_image want = pattern(sizes[s][0], sizes[s][1], channels, bits);
                kiln_bytes file = encode_display("a.png", &want, (kiln_image_write_options){.bits = bits});
                kiln_image got = decode_well(file.data, file.size);
                assert_int_equal(got.format, bits == 8 ? KILN_PIXELS_U8 : KILN_PIXELS_U16);
                same_picture(&got, &want, bits == 8 ? 255 : 65535, 0);
                image_free(&got);
                image_free(&want);
                file_free(&file);
            }
}

/* With this, the round trips above show that the writer's are too. */
static void sixteen_bits_are_big_endian_in_the_file(void **state) {
    (void)state;
    const unsigned char row[4] = {0x01, 0x02, 0xff, 0x00};
    kiln_text file = make_png(2, 1, (png_form){.type = PNG_COLOR_TYPE_GRAY, .bits = 16}, row, 4);
    check_samples(&file, 1, KILN_PIXELS_U16, (const unsigned[]){0x0102, 0xff00}, 2);
}

static void small_and_indexed_forms_become_eight_bits(void **state) {
    (void)state;
    const png_color palette[3] = {{10, 20, 30}, {40, 50, 60}, {70, 80, 90}};
    const png_byte alpha[2] = {0, 128};
    const unsigned char indices[1] = {0x18}; /* 0 1 2 0 in two bits each */
    kiln_text file =
        make_png(4, 1, (png_form){.type = PNG_COLOR_TYPE_PALETTE, .bits = 2, .palette = palette, .palette_count = 3},
                 indices, 1);
    check_samples(&file, 3, KILN_PIXELS_U8, (const unsigned[]){10, 20, 30, 40, 50, 60, 70, 80, 90, 10, 20, 30}, 12);
    file = make_png(4, 1,
                    (png_form){.type = PNG_COLOR_TYPE_PALETTE, .bits = 2, .palette = palette, .palette_count = 3,
                           .alpha = alpha, .alpha_count = 2},
                    indices, 1);
    check_samples(&file, 4, KILN_PIXELS_U8, (const unsigned[]){10, 20, 30, 0, 40, 50, 60, 128, 70, 80, 90, 255}, 12);

    const unsigned char bits1[1] = {0xa0}, bits4[2] = {0x0f, 0x80};
    file = make_png(4, 1, (png_form){.type = PNG_COLOR_TYPE_GRAY, .bits = 1}, bits1, 1);
    check_samples(&file, 1, KILN_PIXELS_U8, (const unsigned[]){255, 0, 255, 0}, 4);
    file = make_png(3, 1, (png_form){.type = PNG_COLOR_TYPE_GRAY, .bits = 4}, bits4, 2);
    check_samples(&file, 1, KILN_PIXELS_U8, (const unsigned[]){0, 255, 136}, 3);
}

static void transparent_colours_become_alpha(void **state) {
    (void)state;
    const unsigned char grey[2] = {7, 9}, rgb[6] = {1, 2, 3, 4, 5, 6}, wide[4] = {0x12, 0x34, 0x12, 0x35};
    kiln_text file = make_png(
        2, 1, (png_form){.type = PNG_COLOR_TYPE_GRAY, .bits = 8, .transparent = &(png_color_16){.gray = 9}}, grey, 2);
    check_samples(&file, 2, KILN_PIXELS_U8, (const unsigned[]){7, 255, 9, 0}, 4);
    file = make_png(2, 1,
                    (png_form){.type = PNG_COLOR_TYPE_RGB, .bits = 8,
                           .transparent = &(png_color_16){.red = 1, .green = 2, .blue = 3}},
                    rgb, 6);
    check_samples(&file, 4, KILN_PIXELS_U8, (const unsigned[]){1, 2, 3, 0, 4, 5, 6, 255}, 8);
    file = make_png(2, 1,
                    (png_form){.type = PNG_COLOR_TYPE_GRAY, .bits = 16, .transparent = &(png_color_16){.gray = 0x1234}},
                    wide, 4);
    check_samples(&file, 2, KILN_PIXELS_U16, (const unsigned[]){0x1234, 0, 0x1235, 65535}, 4);
}

static void interlacing_and_gamma_change_nothing(void **state) {
    (void)state;
    unsigned char rows[13][33];
    for (int i = 0; i < 13 * 33; i++) (&rows[0][0])[i] = (unsigned char)hash32((uint32_t)i);
    kiln_text plain = make_png(11, 13, (png_form){.type = PNG_COLOR_TYPE_RGB, .bits = 8}, &rows[0][0], 33);
    kiln_text other = make_png(
        11, 13, (png_form){.type = PNG_COLOR_TYPE_RGB, .bits = 8, .interlace = PNG_INTERLACE_ADAM7, .gamma = 1.0},
        &rows[0][0], 33);
    kiln_image a = decode_well(plain.data, plain.length), b = decode_well(other.data, other.length);
    assert_memory_equal(a.pixels, rows, sizeof rows);
    assert_memory_equal(b.pixels, rows, sizeof rows);
    image_free(&a);
    image_free(&b);
    text_free(&plain);
    text_free(&other);
}

/* The data of the first chunk of that name; its length, or -1. */
static int find_chunk(const kiln_bytes *file, const char *name, const unsigned char **data, size_t *at) {
    for (size_t i = 8; i + 12 <= file->size;) {
        const unsigned char *p = file->data + i;
        uint32_t length = (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
        if (memcmp(p + 4, name, 4) == 0) {
            *data = p + 8;
            *at = i;
            return (int)length;
        }
        i += 12 + length;
    }
    return -1;
}

static void colour_and_text_chunks_are_written(void **state) {
    (void)state;
    const char *text[] = {"Software", "kiln", "Comment", "gr\xc3\xbc\xc3\x9f dich"};
    const unsigned char *data, srgb_points[4] = {1, 13, 0, 1}, p3_points[4] = {12, 13, 0, 1};
    size_t at, pixels_at;
    kiln_image image = pattern(4, 4, 3, 8);
    kiln_bytes file =
        encode_display("a.png", &image, (kiln_image_write_options){.srgb = true, .text = text, .text_count = 2});
    assert_true(find_chunk(&file, "IDAT", &data, &pixels_at) > 0);
    assert_int_equal(find_chunk(&file, "sRGB", &data, &at), 1);
    assert_true(at < pixels_at);
    assert_int_equal(find_chunk(&file, "cICP", &data, &at), 4);
    assert_true(at < pixels_at);
    assert_memory_equal(data, srgb_points, 4);
    assert_int_equal(find_chunk(&file, "tEXt", &data, &at), 13);
    assert_memory_equal(data, "Software\0kiln", 13);
    assert_true(find_chunk(&file, "iTXt", &data, &at) > 0);
    assert_memory_equal(data, "Comment\0\0\0\0\0gr\xc3\xbc\xc3\x9f dich", 23);
    file_free(&file);

    file = encode_display("a.png", &image, (kiln_image_write_options){.cicp_primaries = 12, .cicp_transfer = 13});
    assert_int_equal(find_chunk(&file, "cICP", &data, &at), 4);
    assert_memory_equal(data, p3_points, 4);
    assert_int_equal(find_chunk(&file, "sRGB", &data, &at), -1);
    file_free(&file);

    file = encode_display("a.png", &image, (kiln_image_write_options){0});
    assert_int_equal(find_chunk(&file, "cICP", &data, &at), -1);
    file_free(&file);
    image_free(&image);
}

static void a_bad_keyword_is_one_error_and_no_file(void **state) {
    (void)state;
    const char *text[] = {"", "value"};
    folder f = folder_make("a.png");
    kiln_image image = pattern(4, 4, 3, 8);
    kiln_report *report = kiln_report_create();
    bool done = image_write_display(f.file, &image, &(kiln_image_write_options){.text = text, .text_count = 1}, report);
    assert_int_equal(kiln_report_count(report, KILN_ERROR), !done);
    assert_int_equal(access(f.file, F_OK) == 0, done);
    folder_remove(&f);
    kiln_report_destroy(report);
    image_free(&image);
}

static void assets_keep_their_depth(void **state) {
    (void)state;
    const char *root = assets_or_skip();
    const struct {
        const char *name;
        uint32_t channels;
        kiln_pixel_format format;
    } files[] = {{"png_grayscale_8-bit", 2, KILN_PIXELS_U8}, {"png_grayscale_16-bit", 2, KILN_PIXELS_U16},
                 {"png_rgb_8-bit", 4, KILN_PIXELS_U8}, {"png_rgb_16-bit", 4, KILN_PIXELS_U16}};
    for (int i = 0; i < COUNT(files); i++) {
        char path[4200];
        snprintf(path, sizeof path, "%s/usd/TextureFileFormatTests/%s.png", root, files[i].name);
        kiln_bytes file = read_whole(path);
        kiln_image image = decode_well(file.data, file.size);
        assert_int_equal(image.width, 256);
        assert_int_equal(image.channels, files[i].channels);
        assert_int_equal(image.format, files[i].format);
        image_free(&image);
        file_free(&file);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trips_are_exact),
        cmocka_unit_test(sixteen_bits_are_big_endian_in_the_file),
        cmocka_unit_test(small_and_indexed_forms_become_eight_bits),
        cmocka_unit_test(transparent_colours_become_alpha),
        cmocka_unit_test(interlacing_and_gamma_change_nothing),
        cmocka_unit_test(colour_and_text_chunks_are_written),
        cmocka_unit_test(a_bad_keyword_is_one_error_and_no_file),
        cmocka_unit_test(assets_keep_their_depth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
