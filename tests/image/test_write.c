#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "support.h"

static const char *const suffixes[] = {".png", ".jpg", ".jpeg", ".webp", ".tif", ".tiff", ".PNG"};

static void the_suffix_names_the_format(void **state) {
    (void)state;
    const kiln_image_kind kinds[] = {KILN_IMAGE_PNG, KILN_IMAGE_JPEG, KILN_IMAGE_JPEG, KILN_IMAGE_WEBP,
                                     KILN_IMAGE_TIFF, KILN_IMAGE_TIFF, KILN_IMAGE_PNG};
    kiln_image image = smooth(9, 4, 3);
    for (int i = 0; i < COUNT(suffixes); i++) {
        char name[16];
        snprintf(name, sizeof name, "a%s", suffixes[i]);
        kiln_bytes file = encode_display(name, &image, (kiln_image_write_options){0});
        assert_int_equal(image_kind(file.data, file.size), kinds[i]);
        file_free(&file);
    }
    image_free(&image);
}

static void the_same_input_gives_the_same_bytes(void **state) {
    (void)state;
    const char *text[] = {"Software", "kiln"};
    kiln_image image = smooth(40, 30, 3);
    for (int i = 0; i < COUNT(suffixes); i++) {
        char name[16];
        snprintf(name, sizeof name, "a%s", suffixes[i]);
        const kiln_image_write_options options = {.srgb = true, .text = text, .text_count = 1};
        kiln_bytes first = encode_display(name, &image, options), second = encode_display(name, &image, options);
        assert_int_equal(first.size, second.size);
        assert_memory_equal(first.data, second.data, first.size);
        file_free(&first);
        file_free(&second);
    }
    image_free(&image);
}

/* Nearest, halves up; what is outside is clamped, NaN is black. */
static void values_are_rounded_and_clamped(void **state) {
    (void)state;
    const float values[8] = {-1, 1e9f, NAN, INFINITY, 0.5f / 255, 0.49f / 255, 254.5f / 255, 127.4f / 255};
    const float want8[8] = {0, 255, 0, 255, 1, 0, 255, 127};
    kiln_image image = pattern(8, 1, 1, 8);
    memcpy(image.pixels, values, sizeof values);
    kiln_bytes file = encode_display("a.png", &image, (kiln_image_write_options){0});
    kiln_image got = decode_well(file.data, file.size);
    for (size_t i = 0; i < 8; i++) assert_true(value_at(&got, i) == want8[i]);
    image_free(&got);
    image_free(&image);
    file_free(&file);
}

static void fails(const char *path, const kiln_image *image, kiln_image_write_options options, kiln_code code) {
    kiln_report *report = kiln_report_create();
    assert_false(image_write_display(path, image, &options, report));
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 1);
    kiln_message m = kiln_report_message(report, 0);
    assert_string_equal(kiln_code_name(m.code), kiln_code_name(code));
    assert_string_equal(m.where, path);
    kiln_report_destroy(report);
}

static void failures_are_located_and_leave_nothing_behind(void **state) {
    (void)state;
    kiln_image image = smooth(9, 4, 3), bytes = image;
    bytes.format = KILN_PIXELS_U8;
    folder f = folder_make("a.png");
    for (int i = 0; i < COUNT(suffixes); i++) {
        char path[128];
        snprintf(path, sizeof path, "/nonexistent/folder/a%s", suffixes[i]);
        fails(path, &image, (kiln_image_write_options){0}, KILN_CODE_OUTPUT);
        snprintf(path, sizeof path, "%s/a%s", f.path, suffixes[i]);
        assert_int_equal(mkdir(path, 0700), 0);
        fails(path, &image, (kiln_image_write_options){0}, KILN_CODE_OUTPUT);
        assert_int_equal(rmdir(path), 0);
    }
    fails("a", &image, (kiln_image_write_options){0}, KILN_CODE_USAGE);
    fails("a.xyz", &image, (kiln_image_write_options){0}, KILN_CODE_USAGE);
    fails("a.exr", &image, (kiln_image_write_options){0}, KILN_CODE_USAGE);
    fails("a.jpg", &image, (kiln_image_write_options){.bits = 16}, KILN_CODE_USAGE);
    fails("a.png", &image, (kiln_image_write_options){.bits = 12}, KILN_CODE_USAGE);
    fails("a.jpg", &image, (kiln_image_write_options){.quality = 101}, KILN_CODE_USAGE);
    fails("a.png", &bytes, (kiln_image_write_options){0}, KILN_CODE_INTERNAL);
    folder_remove(&f);
    image_free(&image);
}

/* A disk that fills up half way, by a limit on the size of files: the picture that was there survives. */
static void a_full_disk_keeps_the_old_file(void **state) {
    (void)state;
    struct rlimit before, little = {.rlim_cur = 1000};
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    little.rlim_max = before.rlim_max;
    (void)signal(SIGXFSZ, SIG_IGN);
    kiln_image image = pattern(64, 64, 3, 8);
    const kiln_exr_channel channel = {"Y", image.pixels, 3, true};
    const kiln_exr_file exr = {.width = 64, .height = 64, .channels = &channel, .channel_count = 1};
    const char *const names[] = {"a.png", "a.jpg", "a.webp", "a.tif", "a.hdr", "a.exr"};
    for (int i = 0; i < COUNT(names); i++) {
        folder f = folder_make(names[i]);
        kiln_report *report = kiln_report_create();
        assert_true(file_replace(f.file, "old", 3, report));
        setrlimit(RLIMIT_FSIZE, &little);
        bool done = i == 5   ? image_write_exr(f.file, &exr, report)
                    : i == 4 ? image_write_hdr(f.file, &image, NULL, 0, report)
                             : image_write_display(f.file, &image, NULL, report);
        setrlimit(RLIMIT_FSIZE, &before);
        assert_false(done);
        assert_int_equal(kiln_report_count(report, KILN_ERROR), 1);
        assert_int_equal(kiln_report_message(report, 0).code, KILN_CODE_OUTPUT);
        assert_string_equal(kiln_report_message(report, 0).where, f.file);
        kiln_bytes old = read_whole(f.file);
        assert_true(old.size == 3 && memcmp(old.data, "old", 3) == 0);
        file_free(&old);
        kiln_report_destroy(report);
        folder_remove(&f);
    }
    image_free(&image);
}

static void a_dash_is_a_png_on_standard_output(void **state) {
    (void)state;
    folder f = folder_make("out");
    int out = dup(STDOUT_FILENO), file = open(f.file, O_RDWR | O_CREAT, 0600);
    fflush(stdout);
    dup2(file, STDOUT_FILENO);
    kiln_image image = pattern(5, 4, 4, 8);
    kiln_report *report = kiln_report_create();
    bool done = image_write_display("-", &image, NULL, report);
    dup2(out, STDOUT_FILENO);
    close(out);
    close(file);
    assert_true(done);
    kiln_bytes bytes = read_whole(f.file);
    kiln_image got = decode_well(bytes.data, bytes.size);
    same_picture(&got, &image, 255, 0);
    image_free(&got);
    file_free(&bytes);
    folder_remove(&f);
    kiln_report_destroy(report);
    image_free(&image);
}

static void an_older_file_is_replaced(void **state) {
    (void)state;
    folder f = folder_make("a.png");
    kiln_report *report = kiln_report_create();
    kiln_image first = pattern(64, 64, 3, 8), second = pattern(2, 2, 1, 8);
    assert_true(image_write_display(f.file, &first, NULL, report));
    assert_true(image_write_display(f.file, &second, NULL, report));
    kiln_bytes bytes = read_whole(f.file);
    kiln_image got = decode_well(bytes.data, bytes.size);
    same_picture(&got, &second, 255, 0);
    image_free(&got);
    image_free(&first);
    image_free(&second);
    file_free(&bytes);
    kiln_report_destroy(report);
    folder_remove(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_suffix_names_the_format),
        cmocka_unit_test(the_same_input_gives_the_same_bytes),
        cmocka_unit_test(values_are_rounded_and_clamped),
        cmocka_unit_test(failures_are_located_and_leave_nothing_behind),
        cmocka_unit_test(a_full_disk_keeps_the_old_file),
        cmocka_unit_test(a_dash_is_a_png_on_standard_output),
        cmocka_unit_test(an_older_file_is_replaced),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
