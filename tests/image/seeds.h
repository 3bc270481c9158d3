/* One small valid file of every format and form, for the tests that hold for all of them. Include after cmocka.h. */
#ifndef KILN_TESTS_IMAGE_SEEDS_H
#define KILN_TESTS_IMAGE_SEEDS_H

#include "support.h"

#include "exr_maker.h"
#include "jpeg_maker.h"
#include "png_maker.h"
#include "tiff_maker.h"

static inline kiln_bytes seed_display(const char *name, uint32_t channels, uint32_t bits, uint32_t quality) {
    kiln_image image = pattern(19, 13, channels, 8);
    const char *text[] = {"Software", "kiln"};
    kiln_bytes file = encode_display(
        name, &image,
        (kiln_image_write_options){.srgb = true, .bits = bits, .quality = quality, .text = text, .text_count = 1});
    image_free(&image);
    return file;
}

static inline kiln_bytes seed_text(kiln_text text) { return (kiln_bytes){(unsigned char *)text.data, text.length}; }

static inline kiln_bytes seed_png(int form) {
    static const png_color palette[4] = {{10, 20, 30}, {40, 50, 60}, {70, 80, 90}, {1, 2, 3}};
    static const png_byte alpha[2] = {0, 128};
    unsigned char rows[13 * 19];
    for (uint32_t i = 0; i < sizeof rows; i++) rows[i] = (unsigned char)hash32(i);
    if (form == 0) return seed_display("a.png", 3, 8, 0);
    if (form == 1) return seed_display("a.png", 4, 16, 0);
    return seed_text(make_png(19, 13,
                              (png_form){.type = PNG_COLOR_TYPE_PALETTE,
                                         .bits = 2,
                                         .palette = palette,
                                         .palette_count = 4,
                                         .alpha = alpha,
                                         .alpha_count = 2,
                                         .interlace = PNG_INTERLACE_ADAM7,
                                         .gamma = 0.5},
                              rows, 5));
}

static inline kiln_bytes seed_jpeg(int form) {
    const unsigned char colour[4] = {200, 100, 50, 25};
    jpeg_form ink = {.input = JCS_CMYK, .file = JCS_YCCK, .components = 4, .progressive = true};
    return form ? make_jpeg(19, 13, ink, colour) : seed_display("a.jpg", 3, 8, 0);
}

static inline kiln_bytes seed_tiff(int form) {
    unsigned char rows[13 * 19 * 4];
    for (uint32_t i = 0; i < sizeof rows; i++) rows[i] = (unsigned char)(i / 7);
    tiff_form tiled = {
        .bits = 8, .samples = 3, .photometric = PHOTOMETRIC_RGB, .tile = 16, .compression = COMPRESSION_LZW};
    tiff_form planar = {.bits = 8, .samples = 4, .photometric = PHOTOMETRIC_RGB, .planar = PLANARCONFIG_SEPARATE,
                        .has_extra = true, .extra = EXTRASAMPLE_ASSOCALPHA, .compression = COMPRESSION_PACKBITS};
    tiff_form ink = {
        .bits = 8, .samples = 4, .photometric = PHOTOMETRIC_SEPARATED, .compression = COMPRESSION_ADOBE_DEFLATE};
    tiff_form fax = {
        .bits = 1, .samples = 1, .photometric = PHOTOMETRIC_MINISWHITE, .compression = COMPRESSION_CCITTFAX4};
    switch (form) {
    case 0: return seed_display("a.tif", 4, 16, 0);
    case 1: return make_tiff(19, 13, tiled, rows);
    case 2: return make_tiff(19, 13, planar, rows);
    case 3: return make_tiff(19, 13, ink, rows);
    default: return make_tiff(19, 13, fax, rows);
    }
}

static inline float seed_value(int x, int y, int channel) {
    return (float)(hash_triple((uint32_t)x, (uint32_t)y, (uint32_t)channel) & 15);
}

static inline kiln_bytes seed_exr(int form) {
    static const exr_compression_t compressions[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE, EXR_COMPRESSION_ZIP,
                                                     EXR_COMPRESSION_PIZ, EXR_COMPRESSION_PXR24, EXR_COMPRESSION_B44A};
    exr_form f = {.channels = {"A", "B", "G", "R"}, .type = form % 2 ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
                  .compression = compressions[form % 6], .tile = form >= 6 ? 8 : 0, .data = {-2, 1, 18, 13},
                  .display = {0, 0, 18, 12}};
    return seed_text(make_exr(&f, 1, seed_value));
}

static inline kiln_bytes seed_hdr(int form) {
    if (form) {
        kiln_text text = {0};
        static const char pixels[] = "\x80\x40\x20\x81\1\1\1\3\x10\x20\x30\x80\1\1\1\2\x11\x20\x30\x80";
        text_append(&text, "#?RGBE\nEXPOSURE=2\nCOLORCORR=1 1 2\nFORMAT=32-bit_rle_rgbe\n\n-X 2 +Y 4\n");
        text_append_bytes(&text, pixels, sizeof pixels - 1);
        return seed_text(text);
    }
    kiln_image image = pattern(19, 13, 3, 8);
    folder f = folder_make("a.hdr");
    kiln_report *report = kiln_report_create();
    assert_true(image_write_hdr(f.file, &image, NULL, 0, report));
    kiln_bytes file = read_whole(f.file);
    folder_remove(&f);
    kiln_report_destroy(report);
    image_free(&image);
    return file;
}

typedef struct seed_row {
    const char *name;
    kiln_bytes (*make)(int form);
    int form;
} seed_row;

static const seed_row seeds[] = {
    {"png rgb", seed_png, 0},          {"png rgba 16", seed_png, 1},   {"png palette", seed_png, 2},
    {"jpeg", seed_jpeg, 0},            {"jpeg ycck", seed_jpeg, 1},    {"tiff rgba 16", seed_tiff, 0},
    {"tiff tiles lzw", seed_tiff, 1},  {"tiff planes", seed_tiff, 2},  {"tiff cmyk", seed_tiff, 3},
    {"tiff fax", seed_tiff, 4},        {"exr none", seed_exr, 0},      {"exr rle", seed_exr, 1},
    {"exr zip", seed_exr, 2},          {"exr piz", seed_exr, 3},       {"exr pxr24", seed_exr, 4},
    {"exr b44a", seed_exr, 5},         {"exr tiles zip", seed_exr, 8}, {"exr tiles piz", seed_exr, 9},
    {"hdr", seed_hdr, 0},              {"hdr older", seed_hdr, 1},
};

#define SEED_COUNT (COUNT(seeds) + 3)

static inline const char *seed_name(int i) {
    static const char *const webp[] = {"webp", "webp alpha", "webp lossless"};
    return i < COUNT(seeds) ? seeds[i].name : webp[i - COUNT(seeds)];
}

static inline kiln_bytes seed_make(int i) {
    if (i < COUNT(seeds)) return seeds[i].make(seeds[i].form);
    i -= COUNT(seeds);
    return seed_display("a.webp", i ? 4 : 3, 8, i == 2 ? 100 : 0);
}

#endif
