/* image/image.h: pictures in memory, and their files. */
#ifndef KILN_IMAGE_IMAGE_H
#define KILN_IMAGE_IMAGE_H

#include "base/report.h"
#include "kiln/image.h"

/* Interleaved pixels, rows from the top; alpha straight. Owned: image_free. */
typedef struct kiln_image {
    uint32_t width, height, channels; /* 1 … 4 */
    kiln_pixel_format format;
    void *pixels;
} kiln_image;

typedef enum kiln_image_kind {
    KILN_IMAGE_UNKNOWN, KILN_IMAGE_PNG, KILN_IMAGE_JPEG, KILN_IMAGE_WEBP, KILN_IMAGE_TIFF, KILN_IMAGE_EXR,
    KILN_IMAGE_HDR, KILN_IMAGE_KTX2 /* recognised, to name it in a message; not decoded */
} kiln_image_kind;

typedef struct kiln_image_info {
    kiln_image_kind kind;
    uint32_t width, height, channels;
    kiln_pixel_format format;
} kiln_image_info;

/* What the first bytes say the file is. */
kiln_image_kind image_kind(const void *bytes, size_t size);

/* Reads the header alone. Refuses zero sizes, more than 65,536 pixels a side, and truncated or unknown files, with
 * where as the place. */
bool image_probe(const void *bytes, size_t size, kiln_image_info *, const kiln_where *where, kiln_report *);

/* Decodes a whole file. The result needs at most limit bytes (0: 8 GiB), checked before allocating. PNG and TIFF of
 * 16 bits stay 16 bits; palettes and 1, 2, 4 bits become 8; EXR, HDR and TIFF of floats become F32; JPEG in CMYK
 * becomes RGB. An EXR file gives its display window, zero where it has no data. Colour profiles and gamma, and the
 * orientation in a JPEG, are ignored, as glTF asks. A damaged JPEG that still gives a picture is a warning. */
bool image_decode(const void *bytes, size_t size, uint64_t limit, kiln_image *, const kiln_where *where, kiln_report *);

bool image_alloc(kiln_image *, uint32_t width, uint32_t height, uint32_t channels, kiln_pixel_format, kiln_report *);
void image_free(kiln_image *);
size_t image_bytes(const kiln_image *);

/* How a display-referred file is tagged and compressed. */
typedef struct kiln_image_write_options {
    bool srgb; /* an ICC profile; PNG: sRGB and cICP chunks instead */
    uint8_t cicp_primaries, cicp_transfer; /* unless srgb, the same by the numbers of ITU-T H.273 (Display P3: 12, 13;
                                              Rec.1886: 1, 1): an ICC profile, PNG: cICP beside it; 0: no tag */
    uint32_t bits;       /* PNG, TIFF: 8 or 16; 0: 8 */
    uint32_t quality;    /* JPEG, WebP: 1 … 100; 0: 95; a WebP of 100 is lossless */
    const char *const *text; /* pairs keyword, value: PNG tEXt or iTXt, TIFF ImageDescription, JPEG and WebP
                                XMP; may be NULL */
    uint32_t text_count; /* pairs */
} kiln_image_write_options;

/* Names and versions of the libraries behind these calls, as they are loaded. The texts are borrowed for the call. */
void image_versions(void (*each)(void *user, const char *name, const char *version), void *user);

/* Writes 8-bit (or, where the format and options say so, 16-bit) pictures from F32 pixels in [0,1], rounded to
 * nearest. Format by suffix: .png .jpg .jpeg .webp .tif .tiff; path "-" is a PNG on standard output. The same input
 * gives the same bytes. Whole or not at all. JPEG of 4 channels is an error that says so. */
bool image_write_display(const char *path, const kiln_image *, const kiln_image_write_options *, kiln_report *);

/* Radiance RGBE, run-length coded, from 3-channel F32. text: pairs keyword, value for the header, "Software" among them
 * as its SOFTWARE; text_count: pairs. The same input gives the same bytes. */
bool image_write_hdr(const char *path, const kiln_image *, const char *const *text, uint32_t text_count, kiln_report *);

/* One layer of an EXR file. Channel names are "R", or "layer.R". */
typedef struct kiln_exr_channel {
    const char *name;
    const float *values; /* of the first pixel of the data window, whose rows follow one another */
    size_t stride;       /* floats from a pixel to the next */
    bool full;           /* 32 bits; else half, out-of-range values clamped to ±65504 */
} kiln_exr_channel;

typedef enum kiln_exr_attribute_kind {
    KILN_EXR_STRING, KILN_EXR_INT, KILN_EXR_FLOAT, KILN_EXR_DOUBLE
} kiln_exr_attribute_kind;
typedef struct kiln_exr_attribute {
    const char *name;
    kiln_exr_attribute_kind kind;
    const char *string;
    double number;
} kiln_exr_attribute;

typedef struct kiln_exr_file {
    uint32_t width, height;        /* of the whole picture: displayWindow */
    uint32_t crop[4];              /* x0 y0 x1 y1: dataWindow; all zero: the whole */
    const kiln_exr_channel *channels;
    uint32_t channel_count;
    const kiln_exr_attribute *attributes;
    uint32_t attribute_count;
    const float *chromaticities;   /* red, green, blue, white xy; NULL: none written */
    uint32_t threads;              /* that compress; 0: all available; the file is the same for any */
} kiln_exr_file;

/* Scanline EXR, ZIP-compressed. Whole or not at all. The same input gives the same bytes. */
bool image_write_exr(const char *path, const kiln_exr_file *, kiln_report *);

#endif
