/* What the tests of image/ share: pictures made of formulas, decoding with the promises of image.h checked, folders
 * that vanish. Include after cmocka.h. */
#ifndef KILN_TESTS_IMAGE_SUPPORT_H
#define KILN_TESTS_IMAGE_SUPPORT_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/hash.h"
#include "base/text.h"
#include "image/image.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof(array)[0]))

/* Multiples of 1/255 or 1/65535, noise with 0 and 1 in it: files of that many bits hold them exactly. */
static inline kiln_image pattern(uint32_t width, uint32_t height, uint32_t channels, uint32_t bits) {
    kiln_report *report = kiln_report_create();
    kiln_image image;
    uint32_t largest = (1u << bits) - 1;
    assert_true(image_alloc(&image, width, height, channels, KILN_PIXELS_F32, report));
    for (size_t i = 0; i < (size_t)width * height * channels; i++) {
        uint32_t value = i == 0 ? 0 : i == 1 ? largest : hash_pair((uint32_t)i, channels) & largest;
        ((float *)image.pixels)[i] = (float)value / (float)largest;
    }
    kiln_report_destroy(report);
    return image;
}

/* A smooth picture, for lossy formats. */
static inline kiln_image smooth(uint32_t width, uint32_t height, uint32_t channels) {
    kiln_image image = pattern(width, height, channels, 8);
    float *at = image.pixels;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < channels; c++)
                *at++ = (float)(c % 2 ? x : y) / (float)(width + height) + 0.2f * (float)c;
    return image;
}

static inline float value_at(const kiln_image *image, size_t index) {
    if (image->format == KILN_PIXELS_U8) return (float)((uint8_t *)image->pixels)[index];
    if (image->format == KILN_PIXELS_U16) return (float)((uint16_t *)image->pixels)[index];
    return ((float *)image->pixels)[index];
}

static inline void print_report(const kiln_report *report) {
    for (size_t i = 0; i < kiln_report_size(report); i++) {
        kiln_message m = kiln_report_message(report, i);
        print_message("%s: %s (%s)\n", m.where, m.what, m.remedy);
    }
}

/* image_decode under its promises: an error is one, is located, and leaves no image. The code, when it fails, in *code.
 */
static inline bool decode(const void *bytes, size_t size, uint64_t limit, kiln_image *image, kiln_code *code) {
    kiln_report *report = kiln_report_create();
    kiln_where root = where_root("file"), where = where_key(&root, "images");
    bool done = image_decode(bytes, size, limit, image, &where, report);
    uint64_t errors = kiln_report_count(report, KILN_ERROR);
    if (errors != !done) {
        print_report(report);
        fail_msg("%s with %d errors", done ? "success" : "failure", (int)errors);
    }
    if (done) assert_non_null(image->pixels);
    for (size_t i = 0; !done && i < kiln_report_size(report); i++) {
        kiln_message m = kiln_report_message(report, i);
        if (m.severity != KILN_ERROR) continue;
        if (m.code != KILN_CODE_MEMORY) assert_string_equal(m.where, "file: images");
        assert_true(m.what[0] && m.remedy[0]);
        if (code) *code = m.code;
    }
    if (!done) assert_true(!image->pixels && !image->width && !image->height);
    kiln_report_destroy(report);
    return done;
}

static inline kiln_image decode_well(const void *bytes, size_t size) {
    kiln_image image;
    kiln_code code = KILN_CODE_INTERNAL;
    if (!decode(bytes, size, 0, &image, &code)) fail_msg("does not decode: %s", kiln_code_name(code));
    return image;
}

static inline void decode_fails(const void *bytes, size_t size, kiln_code want) {
    kiln_image image;
    kiln_code code = KILN_CODE_COUNT; /* decode sets it, but gcc 14 cannot tell */
    if (decode(bytes, size, 0, &image, &code)) fail_msg("decodes, though it should not");
    assert_string_equal(kiln_code_name(code), kiln_code_name(want));
}

typedef struct folder {
    char path[64], file[128];
} folder;

static inline folder folder_make(const char *name) {
    folder f = {.path = "/tmp/kiln-test-image.XXXXXX"};
    assert_non_null(mkdtemp(f.path));
    snprintf(f.file, sizeof f.file, "%s/%s", f.path, name);
    return f;
}

/* Nothing but the one file may be in it: no temporary is left behind. */
static inline void folder_remove(folder *f) {
    (void)unlink(f->file);
    if (rmdir(f->path)) fail_msg("something is left in %s", f->path);
}

static inline kiln_bytes read_whole(const char *path) {
    kiln_report *report = kiln_report_create();
    kiln_bytes bytes;
    assert_true(file_read(path, 1u << 30, &bytes, NULL, report));
    kiln_report_destroy(report);
    return bytes;
}

/* The bytes of a display-referred file, written and read back. */
static inline kiln_bytes encode_display(const char *name, const kiln_image *image, kiln_image_write_options options) {
    folder f = folder_make(name);
    kiln_report *report = kiln_report_create();
    if (!image_write_display(f.file, image, &options, report)) {
        print_report(report);
        fail();
    }
    assert_int_equal(kiln_report_size(report), 0);
    kiln_bytes bytes = read_whole(f.file);
    kiln_report_destroy(report);
    folder_remove(&f);
    return bytes;
}

/* Every sample is the original times largest, exactly or within tolerance. */
static inline void same_picture(const kiln_image *got, const kiln_image *want, float largest, float tolerance) {
    assert_int_equal(got->width, want->width);
    assert_int_equal(got->height, want->height);
    assert_int_equal(got->channels, want->channels);
    for (size_t i = 0; i < (size_t)got->width * got->height * got->channels; i++) {
        float difference = value_at(got, i) - value_at(want, i) * largest;
        if (!(difference >= -tolerance - 1e-3f && difference <= tolerance + 1e-3f))
            fail_msg("sample %d is %g, not %g", (int)i, (double)value_at(got, i),
                     (double)(value_at(want, i) * largest));
    }
}

#endif
