#include "image/image.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/text.h"
#include "image/codec.h"

static const uint64_t DEFAULT_LIMIT = (uint64_t)8 << 30;
enum { SIDE_MAX = 65536 };

static bool starts_with(const unsigned char *bytes, size_t size, const char *magic, size_t length) {
    return size >= length && memcmp(bytes, magic, length) == 0;
}

kiln_image_kind image_kind(const void *data, size_t size) {
    static const struct {
        kiln_image_kind kind;
        const char *magic;
        size_t length;
    } magics[] = {
        {KILN_IMAGE_PNG, "\x89PNG\r\n\x1a\n", 8},
        {KILN_IMAGE_JPEG, "\xff\xd8\xff", 3},
        {KILN_IMAGE_TIFF, "II*\0", 4},
        {KILN_IMAGE_TIFF, "MM\0*", 4},
        {KILN_IMAGE_TIFF, "II+\0", 4}, /* BigTIFF */
        {KILN_IMAGE_TIFF, "MM\0+", 4},
        {KILN_IMAGE_EXR, "\x76\x2f\x31\x01", 4},
        {KILN_IMAGE_HDR, "#?", 2},
        {KILN_IMAGE_KTX2, "\xabKTX 20\xbb\r\n\x1a\n", 12},
    };
    const unsigned char *bytes = data;
    for (size_t i = 0; i < sizeof magics / sizeof magics[0]; i++)
        if (starts_with(bytes, size, magics[i].magic, magics[i].length)) return magics[i].kind;
    if (starts_with(bytes, size, "RIFF", 4) && size >= 12 && memcmp(bytes + 8, "WEBP", 4) == 0) return KILN_IMAGE_WEBP;
    return KILN_IMAGE_UNKNOWN;
}

bool image_refuse(const image_source *source, kiln_code code, const char *remedy, const char *format, ...) {
    kiln_text what = {0};
    va_list args;
    va_start(args, format);
    text_format_list(&what, format, args);
    va_end(args);
    report_error(source->report, code, source->where, remedy, "%s", what.data ? what.data : "the image cannot be read");
    text_free(&what);
    return false;
}

bool image_damaged(const image_source *source, const char *kind, const char *detail) {
    return image_refuse(source, KILN_CODE_IMAGE, "export the image again", "the %s data is damaged: %s", kind, detail);
}

bool image_truncated(const image_source *source, const char *kind) {
    return image_refuse(source, KILN_CODE_FILE_TRUNCATED, "copy or export the image again",
                        "the %s data ends too early", kind);
}

static size_t format_bytes(kiln_pixel_format format) {
    switch (format) {
    case KILN_PIXELS_U8: return 1;
    case KILN_PIXELS_U16: return 2;
    case KILN_PIXELS_F32: return 4;
    }
    return 4;
}

/* False when the count does not fit. */
static bool pixel_bytes(uint32_t width, uint32_t height, uint32_t channels, kiln_pixel_format format, size_t *bytes) {
    return size_mul(width, height, bytes) && size_mul(*bytes, channels, bytes) &&
           size_mul(*bytes, format_bytes(format), bytes);
}

bool image_check_size(const image_source *source, const kiln_image_info *info) {
    if (!info->width || !info->height)
        return image_refuse(source, KILN_CODE_IMAGE, "export the image again",
                            "the image has no pixels: %" PRIu32 " x %" PRIu32, info->width, info->height);
    if (info->width > SIDE_MAX || info->height > SIDE_MAX)
        return image_refuse(source, KILN_CODE_LIMIT, "scale the image down",
                            "the image of %" PRIu32 " x %" PRIu32 " is larger than %d pixels a side", info->width,
                            info->height, SIDE_MAX);
    return true;
}

bool image_prepare(const image_source *source, const kiln_image_info *info, kiln_image *image) {
    size_t bytes;
    if (!image_check_size(source, info)) return false;
    if (!pixel_bytes(info->width, info->height, info->channels, info->format, &bytes) || bytes > source->limit)
        return image_refuse(source, KILN_CODE_LIMIT, "scale the image down or raise the memory limit",
                            "the image of %" PRIu32 " x %" PRIu32 " needs more than %" PRIu64 " bytes", info->width,
                            info->height, source->limit);
    return image_alloc(image, info->width, info->height, info->channels, info->format, source->report);
}

static bool read_kind(const image_source *source, kiln_image_info *info, kiln_image *image) {
    switch (info->kind) {
    case KILN_IMAGE_PNG: return image_read_png(source, info, image);
    case KILN_IMAGE_JPEG: return image_read_jpeg(source, info, image);
    case KILN_IMAGE_WEBP: return image_read_webp(source, info, image);
    case KILN_IMAGE_TIFF: return image_read_tiff(source, info, image);
    case KILN_IMAGE_EXR: return image_read_exr(source, info, image);
    case KILN_IMAGE_HDR: return image_read_hdr(source, info, image);
    case KILN_IMAGE_KTX2:
        return image_refuse(source, KILN_CODE_IMAGE, "convert the texture to PNG, for example with `ktx extract`",
                            "KTX2 textures cannot be read");
    case KILN_IMAGE_UNKNOWN: break;
    }
    if (source->size == 0)
        return image_refuse(source, KILN_CODE_FILE_TRUNCATED, "export the image again", "the image is empty");
    return image_refuse(source, KILN_CODE_FILE_FORMAT, "convert the image to one of these",
                        "this is not a PNG, JPEG, WebP, TIFF, OpenEXR or Radiance HDR image");
}

static image_source open_source(const void *bytes, size_t size, uint64_t limit, const kiln_where *where,
                                kiln_report *report) {
    if (!limit) limit = DEFAULT_LIMIT;
    if (limit > INT64_MAX) limit = INT64_MAX; /* the libraries' limits are signed */
    return (image_source){bytes, size, limit, where, report};
}

bool image_probe(const void *bytes, size_t size, kiln_image_info *info, const kiln_where *where, kiln_report *report) {
    image_source source = open_source(bytes, size, 0, where, report);
    *info = (kiln_image_info){.kind = image_kind(bytes, size)};
    return read_kind(&source, info, NULL) && image_check_size(&source, info);
}

bool image_decode(const void *bytes, size_t size, uint64_t limit, kiln_image *image, const kiln_where *where,
                  kiln_report *report) {
    image_source source = open_source(bytes, size, limit, where, report);
    kiln_image_info info = {.kind = image_kind(bytes, size)};
    *image = (kiln_image){0};
    if (read_kind(&source, &info, image)) return true;
    image_free(image);
    return false;
}

bool image_alloc(kiln_image *image, uint32_t width, uint32_t height, uint32_t channels, kiln_pixel_format format,
                 kiln_report *report) {
    size_t bytes;
    *image = (kiln_image){width, height, channels, format, NULL};
    if (pixel_bytes(width, height, channels, format, &bytes)) image->pixels = array_alloc(bytes, 1);
    return image->pixels ? true : report_no_memory(report, "holding an image");
}

void image_free(kiln_image *image) {
    free(image->pixels);
    *image = (kiln_image){0};
}

size_t image_bytes(const kiln_image *image) {
    size_t bytes;
    return pixel_bytes(image->width, image->height, image->channels, image->format, &bytes) ? bytes : 0;
}

static uint32_t get_integer(const kiln_image *image, size_t at) {
    return image->format == KILN_PIXELS_U8 ? ((uint8_t *)image->pixels)[at] : ((uint16_t *)image->pixels)[at];
}

static void set_integer(kiln_image *image, size_t at, uint32_t value) {
    if (image->format == KILN_PIXELS_U8) ((uint8_t *)image->pixels)[at] = (uint8_t)value;
    else ((uint16_t *)image->pixels)[at] = (uint16_t)value;
}

static void unpremultiply_integers(kiln_image *image, size_t first, uint32_t colours) {
    uint64_t largest = image->format == KILN_PIXELS_U8 ? 255 : 65535, alpha = get_integer(image, first + colours);
    for (size_t i = first; i < first + colours && alpha; i++) {
        uint64_t straight = (get_integer(image, i) * largest + alpha / 2) / alpha;
        set_integer(image, i, (uint32_t)(straight < largest ? straight : largest));
    }
}

static void unpremultiply_floats(float *pixel, uint32_t colours) {
    float alpha = pixel[colours];
    for (uint32_t c = 0; c < colours && alpha > 0; c++) pixel[c] /= alpha;
}

void image_unpremultiply(kiln_image *image) {
    if (image->channels != 2 && image->channels != 4) return;
    size_t samples = (size_t)image->width * image->height * image->channels;
    for (size_t i = 0; i < samples; i += image->channels) {
        if (image->format == KILN_PIXELS_F32) unpremultiply_floats((float *)image->pixels + i, image->channels - 1);
        else unpremultiply_integers(image, i, image->channels - 1);
    }
}
