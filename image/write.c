#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/file.h"
#include "base/text.h"
#include "image/codec.h"

bool image_not_written(const char *path, kiln_report *report, const char *format, ...) {
    kiln_text what = {0};
    kiln_where here = where_root(path);
    va_list args;
    va_start(args, format);
    text_format_list(&what, format, args);
    va_end(args);
    report_error(report, KILN_CODE_OUTPUT, &here, NULL, "the picture cannot be written: %s",
                 what.data ? what.data : "");
    text_free(&what);
    return false;
}

/* To the nearest of 0 … largest; NaN becomes 0. */
static uint32_t quantize(float value, uint32_t largest) {
    if (!(value > 0.0f)) return 0;
    return value >= 1.0f ? largest : (uint32_t)(value * (float)largest + 0.5f);
}

static void quantize_all(const float *from, size_t count, uint32_t bits, unsigned char *to) {
    for (size_t i = 0; i < count; i++) {
        uint32_t value = quantize(from[i], (1u << bits) - 1);
        uint16_t wide = (uint16_t)value;
        if (bits == 8) to[i] = (unsigned char)value;
        else memcpy(to + 2 * i, &wide, 2);
    }
}

typedef struct file_kind {
    const char *suffix;
    bool (*write)(const image_samples *);
    uint32_t bits_max;
} file_kind;

static const file_kind kinds[] = {
    {".png", image_write_png, 16},  {".jpg", image_write_jpeg, 8},  {".jpeg", image_write_jpeg, 8},
    {".webp", image_write_webp, 8}, {".tif", image_write_tiff, 16}, {".tiff", image_write_tiff, 16},
};

static const file_kind *find_kind(const char *path) {
    char suffix[16];
    path_suffix(path, suffix);
    if (strcmp(path, "-") == 0) return &kinds[0];
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (strcmp(suffix, kinds[i].suffix) == 0) return &kinds[i];
    return NULL;
}

static bool check(const char *path, const kiln_image *image, const kiln_image_write_options *options,
                  const file_kind *kind, kiln_report *report) {
    kiln_where here = where_root(path);
    if (!kind)
        return report_error(report, KILN_CODE_USAGE, &here, "use .png, .jpg, .webp or .tif",
                            "the suffix names no display-referred format");
    if (options->bits != 0 && options->bits != 8 && options->bits != kind->bits_max)
        return report_error(report, KILN_CODE_USAGE, &here, "write 8 bits, or 16 as PNG or TIFF",
                            "%s files cannot have %u bits", kind->suffix, options->bits);
    if (options->quality > 100)
        return report_error(report, KILN_CODE_USAGE, &here, "1 is the smallest file, 100 the best picture",
                            "a quality of %u is above 100", options->quality);
    if (image->format != KILN_PIXELS_F32 || !image->channels || image->channels > 4 || !image->width || !image->height)
        return report_error(report, KILN_CODE_INTERNAL, &here, NULL,
                            "the picture has no pixels, or none of 32-bit floats");
    return true;
}

bool image_write_display(const char *path, const kiln_image *image, const kiln_image_write_options *options,
                         kiln_report *report) {
    static const kiln_image_write_options defaults;
    if (!options) options = &defaults;
    const file_kind *kind = find_kind(path);
    if (!check(path, image, options, kind, report)) return false;
    image_samples samples = {.path = path,
                             .width = image->width,
                             .height = image->height,
                             .channels = image->channels,
                             .bits = options->bits ? options->bits : 8,
                             .options = options,
                             .report = report};
    size_t count = image_bytes(image) / sizeof(float);
    unsigned char *bytes = array_alloc(count, samples.bits / 8);
    if (!bytes) return report_no_memory(report, "writing a picture");
    quantize_all(image->pixels, count, samples.bits, bytes);
    samples.bytes = bytes;
    bool done = kind->write(&samples);
    free(bytes);
    return done;
}
