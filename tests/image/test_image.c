/* What holds for all formats: kinds, headers, limits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "seeds.h"

static void kinds_are_told_by_the_first_bytes(void **state) {
    (void)state;
    assert_int_equal(image_kind("\x89PNG\r\n\x1a\n", 8), KILN_IMAGE_PNG);
    assert_int_equal(image_kind("\xff\xd8\xff\xe0", 4), KILN_IMAGE_JPEG);
    assert_int_equal(image_kind("RIFF\4\0\0\0WEBP", 12), KILN_IMAGE_WEBP);
    assert_int_equal(image_kind("RIFF\4\0\0\0WAVE", 12), KILN_IMAGE_UNKNOWN);
    assert_int_equal(image_kind("II*\0", 4), KILN_IMAGE_TIFF);
    assert_int_equal(image_kind("MM\0*", 4), KILN_IMAGE_TIFF);
    assert_int_equal(image_kind("MM\0+", 4), KILN_IMAGE_TIFF);
    assert_int_equal(image_kind("\x76\x2f\x31\x01", 4), KILN_IMAGE_EXR);
    assert_int_equal(image_kind("#?RADIANCE\n", 11), KILN_IMAGE_HDR);
    assert_int_equal(image_kind("\xabKTX 20\xbb\r\n\x1a\n", 12), KILN_IMAGE_KTX2);
    assert_int_equal(image_kind("\x89PNG", 4), KILN_IMAGE_UNKNOWN);
    assert_int_equal(image_kind("hello", 5), KILN_IMAGE_UNKNOWN);
    assert_int_equal(image_kind(NULL, 0), KILN_IMAGE_UNKNOWN);
}

static void what_is_no_image_is_refused(void **state) {
    (void)state;
    decode_fails(NULL, 0, KILN_CODE_FILE_TRUNCATED);
    decode_fails("", 0, KILN_CODE_FILE_TRUNCATED);
    decode_fails("\x89", 1, KILN_CODE_FILE_FORMAT);
    decode_fails("This is a text file.\n", 21, KILN_CODE_FILE_FORMAT);
    decode_fails("<svg xmlns=\"http://www.w3.org/2000/svg\"/>", 41, KILN_CODE_FILE_FORMAT);
    decode_fails("\xabKTX 20\xbb\r\n\x1a\n", 12, KILN_CODE_IMAGE);
}

static void the_header_agrees_with_the_picture(void **state) {
    (void)state;
    for (int i = 0; i < SEED_COUNT; i++) {
        kiln_bytes file = seed_make(i);
        kiln_image image = decode_well(file.data, file.size);
        kiln_image_info info;
        kiln_report *report = kiln_report_create();
        assert_true(image_probe(file.data, file.size, &info, NULL, report));
        assert_int_equal(kiln_report_size(report), 0);
        assert_int_equal(info.kind, image_kind(file.data, file.size));
        assert_true(info.width == image.width && info.height == image.height);
        assert_true(info.channels == image.channels && info.format == image.format);
        assert_int_equal(image_bytes(&image), (size_t)image.width * image.height * image.channels *
                                                  (image.format == KILN_PIXELS_U8    ? 1
                                                   : image.format == KILN_PIXELS_U16 ? 2
                                                                                     : 4));
        kiln_report_destroy(report);
        image_free(&image);
        assert_null(image.pixels);
        file_free(&file);
    }
}

static void the_limit_is_exact(void **state) {
    (void)state;
    for (int i = 0; i < SEED_COUNT; i++) {
        kiln_bytes file = seed_make(i);
        kiln_image image = decode_well(file.data, file.size), again;
        size_t bytes = image_bytes(&image);
        kiln_code code;
        assert_false(decode(file.data, file.size, bytes - 1, &again, &code));
        assert_int_equal(code, KILN_CODE_LIMIT);
        image_free(&image);
        file_free(&file);
    }
}

/* Headers that promise 65,536 × 65,536 pixels in a few bytes. */
static void giants_are_refused_before_they_are_allocated(void **state) {
    (void)state;
    static const unsigned char png[] = "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\1\0\0\0\1\0\0\x10\6\0\0\0\x3c\x14\xec\xa0"
                                       "\0\0\0\0IDAT\x35\xaf\x06\x1e";
    static const char hdr[] = "#?RADIANCE\n\n-Y 65536 +X 65536\n\x80\x80\x80\x80";
    decode_fails(png, sizeof png - 1, KILN_CODE_LIMIT);
    decode_fails(hdr, sizeof hdr - 1, KILN_CODE_LIMIT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinds_are_told_by_the_first_bytes),
        cmocka_unit_test(what_is_no_image_is_refused),
        cmocka_unit_test(the_header_agrees_with_the_picture),
        cmocka_unit_test(the_limit_is_exact),
        cmocka_unit_test(giants_are_refused_before_they_are_allocated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
