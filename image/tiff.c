#include "image/tiff.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "image/codec.h"
#include "image/half.h"

enum { TABLES_MIN = 1 << 20 }; /* what libtiff may always allocate, however small the picture must be */

/* libtiff reports through the handle, so that nothing global is touched and two files can be read at once. */
static int on_error(TIFF *tiff, void *user, const char *module, const char *format, va_list args) {
    image_tiff_stream *stream = user;
    (void)tiff;
    (void)module;
    if (!stream->message[0]) vsnprintf(stream->message, sizeof stream->message, format, args);
    return 1;
}
static int on_warning(TIFF *tiff, void *user, const char *module, const char *format, va_list args) {
    (void)tiff, (void)user, (void)module, (void)format, (void)args;
    return 1;
}

static tmsize_t stream_read(thandle_t handle, void *to, tmsize_t count) {
    image_tiff_stream *s = handle;
    uint64_t left = s->at < s->size ? s->size - s->at : 0, take = (uint64_t)count < left ? (uint64_t)count : left;
    if (take) memcpy(to, s->bytes + s->at, take);
    s->at += take;
    return (tmsize_t)take;
}

static bool grow(image_tiff_stream *s, uint64_t size) {
    if (size <= s->capacity) return true;
    uint64_t capacity = size + size / 2 + 65536;
    void *bytes = s->bytes;
    if (!array_resize(&bytes, capacity, 1)) return false;
    s->bytes = bytes;
    s->capacity = capacity;
    return true;
}

static tmsize_t stream_write(thandle_t handle, void *from, tmsize_t count) {
    image_tiff_stream *s = handle;
    uint64_t end;
    if (!s->writable || __builtin_add_overflow(s->at, (uint64_t)count, &end) || !grow(s, end)) return -1;
    if (s->at > s->size) memset(s->bytes + s->size, 0, s->at - s->size);
    memcpy(s->bytes + s->at, from, (size_t)count);
    s->at = end;
    if (end > s->size) s->size = end;
    return count;
}

static toff_t stream_seek(thandle_t handle, toff_t offset, int whence) {
    image_tiff_stream *s = handle;
    s->at = offset + (whence == SEEK_CUR ? s->at : whence == SEEK_END ? s->size : 0);
    return s->at;
}

static int stream_close(thandle_t handle) {
    (void)handle;
    return 0;
}
static toff_t stream_size(thandle_t handle) { return ((image_tiff_stream *)handle)->size; }
static int no_map(thandle_t handle, void **base, toff_t *size) {
    (void)handle, (void)base, (void)size;
    return 0;
}
static void no_unmap(thandle_t handle, void *base, toff_t size) { (void)handle, (void)base, (void)size; }

TIFF *image_tiff_open(image_tiff_stream *stream, const char *mode, uint64_t limit) {
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    if (!options) return NULL;
    TIFFOpenOptionsSetErrorHandlerExtR(options, on_error, stream);
    TIFFOpenOptionsSetWarningHandlerExtR(options, on_warning, stream);
    if (limit) TIFFOpenOptionsSetMaxSingleMemAlloc(options, (tmsize_t)(limit < TABLES_MIN ? TABLES_MIN : limit));
    TIFF *tiff = TIFFClientOpenExt("TIFF", mode, stream, stream_read, stream_write, stream_seek, stream_close,
                                   stream_size, no_map, no_unmap, options);
    TIFFOpenOptionsFree(options);
    return tiff;
}

typedef struct reader {
    const image_source *source;
    image_tiff_stream stream;
    TIFF *tiff;
    uint16_t bits, samples, photometric, sample_format, planar, orientation;
    uint16_t file_channels; /* in a row of the file, where it is interleaved */
    bool associated_alpha, simple;
    kiln_image *image;
} reader;

static bool damaged(reader *r, const char *otherwise) {
    return image_damaged(r->source, "TIFF", r->stream.message[0] ? r->stream.message : otherwise);
}

/* Grey and RGB of 8, 16 and 32 bits are read as they are; the rest (palettes, fewer bits, YCbCr, CMYK, Lab) libtiff
 * converts to 8-bit RGB. */
static bool is_simple(const reader *r) {
    if (r->photometric != PHOTOMETRIC_MINISBLACK && r->photometric != PHOTOMETRIC_RGB) return false;
    bool integers = r->sample_format == SAMPLEFORMAT_UINT && (r->bits == 8 || r->bits == 16);
    bool floats = r->sample_format == SAMPLEFORMAT_IEEEFP && (r->bits == 16 || r->bits == 32);
    return integers || floats;
}

static bool unusual(reader *r) {
    return image_refuse(r->source, KILN_CODE_IMAGE, "save it as grey or RGB of 8 or 16 bits, or of 32-bit floats",
                        "TIFF samples of this kind cannot be read (%u bits, sample format %u, photometric %u)", r->bits,
                        r->sample_format, r->photometric);
}

static bool read_header(reader *r, kiln_image_info *info) {
    uint16_t extra_count = 0, *extra = NULL;
    if (!TIFFGetField(r->tiff, TIFFTAG_IMAGEWIDTH, &info->width) ||
        !TIFFGetField(r->tiff, TIFFTAG_IMAGELENGTH, &info->height))
        return damaged(r, "it has no size");
    TIFFGetFieldDefaulted(r->tiff, TIFFTAG_BITSPERSAMPLE, &r->bits);
    TIFFGetFieldDefaulted(r->tiff, TIFFTAG_SAMPLESPERPIXEL, &r->samples);
    TIFFGetFieldDefaulted(r->tiff, TIFFTAG_SAMPLEFORMAT, &r->sample_format);
    TIFFGetFieldDefaulted(r->tiff, TIFFTAG_PLANARCONFIG, &r->planar);
    TIFFGetFieldDefaulted(r->tiff, TIFFTAG_ORIENTATION, &r->orientation);
    TIFFGetFieldDefaulted(r->tiff, TIFFTAG_EXTRASAMPLES, &extra_count, &extra);
    if (!TIFFGetField(r->tiff, TIFFTAG_PHOTOMETRIC, &r->photometric))
        r->photometric = r->samples >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK;
    if (r->sample_format == SAMPLEFORMAT_VOID) r->sample_format = SAMPLEFORMAT_UINT;
    r->simple = is_simple(r);
    if (!r->simple && (r->sample_format != SAMPLEFORMAT_UINT || r->bits > 16)) return unusual(r);
    if (r->orientation > ORIENTATION_BOTLEFT)
        return image_refuse(r->source, KILN_CODE_IMAGE, "save the image upright",
                            "the TIFF image is turned on its side (orientation %u)", r->orientation);
    uint32_t colours = r->photometric == PHOTOMETRIC_RGB ? 3 : 1;
    if (r->simple && r->samples < colours) return damaged(r, "an RGB image has fewer than three samples");
    bool alpha = extra_count > 0 && extra && extra[0] != EXTRASAMPLE_UNSPECIFIED && r->samples > colours;
    r->associated_alpha = alpha && extra[0] == EXTRASAMPLE_ASSOCALPHA;
    r->file_channels = r->planar == PLANARCONFIG_CONTIG ? r->samples : 1;
    info->channels = r->simple ? colours + alpha : 3;
    info->format = !r->simple ? KILN_PIXELS_U8 : r->sample_format == SAMPLEFORMAT_IEEEFP ? KILN_PIXELS_F32
                   : r->bits == 8 ? KILN_PIXELS_U8 : KILN_PIXELS_U16;
    return true;
}

/* Orientations 1 to 4 name the corner where the file's first row and column are. */
static bool from_right(const reader *r) {
    return r->orientation == ORIENTATION_TOPRIGHT || r->orientation == ORIENTATION_BOTRIGHT;
}
static bool from_bottom(const reader *r) {
    return r->orientation == ORIENTATION_BOTLEFT || r->orientation == ORIENTATION_BOTRIGHT;
}

/* A run of one row of the file to its place: all channels when they are interleaved, else the given one. */
static void put_run(reader *r, const unsigned char *from, uint32_t x, uint32_t y, uint32_t count, uint32_t plane) {
    kiln_image *image = r->image;
    size_t sample = r->bits / 8, step = r->file_channels;
    uint32_t first = r->planar == PLANARCONFIG_CONTIG ? 0 : plane;
    uint32_t last = r->planar == PLANARCONFIG_CONTIG ? image->channels : plane + 1;
    size_t row = (size_t)(from_bottom(r) ? image->height - 1 - y : y) * image->width;
    for (uint32_t i = 0; i < count; i++) {
        size_t pixel = row + (from_right(r) ? image->width - 1 - (x + i) : x + i);
        for (uint32_t c = first; c < last; c++) {
            const unsigned char *at = from + (i * step + (c - first)) * sample;
            size_t to = pixel * image->channels + c;
            uint16_t half;
            if (image->format != KILN_PIXELS_F32 || sample == 4)
                memcpy((unsigned char *)image->pixels + to * sample, at, sample);
            else {
                memcpy(&half, at, 2);
                ((float *)image->pixels)[to] = half_to_float(half);
            }
        }
    }
}

static uint32_t planes(const reader *r) { return r->planar == PLANARCONFIG_CONTIG ? 1 : r->image->channels; }

static bool read_tiles(reader *r, unsigned char *buffer) {
    uint32_t tile_width = 0, tile_height = 0, width = r->image->width, height = r->image->height;
    TIFFGetField(r->tiff, TIFFTAG_TILEWIDTH, &tile_width);
    TIFFGetField(r->tiff, TIFFTAG_TILELENGTH, &tile_height);
    tmsize_t stride = TIFFTileRowSize(r->tiff);
    for (uint32_t plane = 0; plane < planes(r); plane++)
        for (uint32_t y = 0; y < height; y += tile_height)
            for (uint32_t x = 0; x < width; x += tile_width) {
                if (TIFFReadTile(r->tiff, buffer, x, y, 0, (uint16_t)plane) < 0)
                    return damaged(r, "a tile cannot be read");
                uint32_t columns = width - x < tile_width ? width - x : tile_width;
                uint32_t rows = height - y < tile_height ? height - y : tile_height;
                for (uint32_t i = 0; i < rows; i++) put_run(r, buffer + (tmsize_t)i * stride, x, y + i, columns, plane);
            }
    return true;
}

static bool read_lines(reader *r, unsigned char *buffer) {
    for (uint32_t plane = 0; plane < planes(r); plane++)
        for (uint32_t y = 0; y < r->image->height; y++) {
            if (TIFFReadScanline(r->tiff, buffer, y, (uint16_t)plane) < 0) return damaged(r, "a row cannot be read");
            put_run(r, buffer, 0, y, r->image->width, plane);
        }
    return true;
}

/* The smallest buffer that a tile or row of these sizes can fill, whatever libtiff says of it. */
static bool buffer_size(reader *r, bool tiled, size_t *size) {
    uint32_t width = r->image->width, height = 1;
    if (tiled && (!TIFFGetField(r->tiff, TIFFTAG_TILEWIDTH, &width) ||
                  !TIFFGetField(r->tiff, TIFFTAG_TILELENGTH, &height) || !width || !height))
        return false;
    tmsize_t stated = tiled ? TIFFTileSize(r->tiff) : TIFFScanlineSize(r->tiff);
    if (!size_mul(width, height, size) || !size_mul(*size, (size_t)r->file_channels * (r->bits / 8), size))
        return false;
    if (stated > 0 && (size_t)stated > *size) *size = (size_t)stated;
    return stated > 0 && *size <= r->source->limit;
}

static bool read_simple(reader *r) {
    bool tiled = TIFFIsTiled(r->tiff);
    size_t size;
    if (!buffer_size(r, tiled, &size)) return damaged(r, "its tiles or rows have no valid size");
    unsigned char *buffer = array_alloc(size, 1);
    if (!buffer) return report_no_memory(r->source->report, "reading a TIFF image");
    bool done = tiled ? read_tiles(r, buffer) : read_lines(r, buffer);
    free(buffer);
    if (done && r->associated_alpha) image_unpremultiply(r->image);
    return done;
}

static bool read_converted(reader *r) {
    char why[1024] = "";
    kiln_image *image = r->image;
    size_t pixels = (size_t)image->width * image->height;
    if (!TIFFRGBAImageOK(r->tiff, why)) return damaged(r, why);
    if (pixels > r->source->limit / sizeof(uint32_t))
        return image_refuse(r->source, KILN_CODE_LIMIT, "save it as grey or RGB of 8 bits",
                            "converting the TIFF image to RGB needs more than %llu bytes",
                            (unsigned long long)r->source->limit);
    uint32_t *rgba = array_alloc(pixels, sizeof *rgba);
    if (!rgba) return report_no_memory(r->source->report, "reading a TIFF image");
    bool done = TIFFReadRGBAImageOriented(r->tiff, image->width, image->height, rgba, ORIENTATION_TOPLEFT, 1);
    unsigned char *to = image->pixels;
    for (size_t i = 0; done && i < pixels; i++, to += 3) {
        to[0] = (unsigned char)TIFFGetR(rgba[i]);
        to[1] = (unsigned char)TIFFGetG(rgba[i]);
        to[2] = (unsigned char)TIFFGetB(rgba[i]);
    }
    free(rgba);
    return done || damaged(r, "it cannot be converted to RGB");
}

bool image_read_tiff(const image_source *source, kiln_image_info *info, kiln_image *image) {
    reader r = {.source = source, .image = image};
    r.stream.bytes = (unsigned char *)(uintptr_t)source->bytes;
    r.stream.size = source->size;
    r.tiff = image_tiff_open(&r.stream, "rm", source->limit);
    if (!r.tiff) return damaged(&r, "it has no directory");
    bool done = read_header(&r, info);
    if (done && image)
        done = image_prepare(source, info, image) && (r.simple ? read_simple(&r) : read_converted(&r));
    TIFFClose(r.tiff);
    return done;
}
