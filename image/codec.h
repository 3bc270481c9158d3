/* image/codec.h: what image.c and write.c ask of each file format. */
#ifndef KILN_IMAGE_CODEC_H
#define KILN_IMAGE_CODEC_H

#include "base/text.h"
#include "image/image.h"

/* A file in memory, and where messages about it go. */
typedef struct image_source {
    const unsigned char *bytes;
    size_t size;
    uint64_t limit; /* bytes that the pixels, or any one table of a decoder, may take */
    const kiln_where *where;
    kiln_report *report;
} image_source;

/* Each reads the header into info; when image is given, it then calls image_prepare and fills the pixels. False exactly
 * when one error was added; the caller frees what image holds. */
bool image_read_png(const image_source *, kiln_image_info *info, kiln_image *image);
bool image_read_jpeg(const image_source *, kiln_image_info *info, kiln_image *image);
bool image_read_webp(const image_source *, kiln_image_info *info, kiln_image *image);
bool image_read_tiff(const image_source *, kiln_image_info *info, kiln_image *image);
bool image_read_exr(const image_source *, kiln_image_info *info, kiln_image *image);
bool image_read_hdr(const image_source *, kiln_image_info *info, kiln_image *image);

/* Refuses an empty image and one of too many pixels a side. */
bool image_check_size(const image_source *, const kiln_image_info *info);
/* Checks size and limit, then allocates. Memory is committed as it is written, so that a short file with a giant
 * header costs little. */
bool image_prepare(const image_source *, const kiln_image_info *info, kiln_image *image);

/* Adds an error at the source's place and returns false. */
bool image_refuse(const image_source *, kiln_code, const char *remedy, const char *format, ...) KILN_PRINTF(4, 5);
/* "the PNG data is damaged: …", with the decoder's own words. */
bool image_damaged(const image_source *, const char *kind, const char *detail);
bool image_truncated(const image_source *, const char *kind);

/* Straight from associated (premultiplied) alpha; colour under alpha 0 is kept. */
void image_unpremultiply(kiln_image *);

/* A display-referred picture ready for a file: samples of 8 bits, or of 16 in the machine's byte order. */
typedef struct image_samples {
    const char *path;
    uint32_t width, height, channels, bits;
    const unsigned char *bytes;
    const kiln_image_write_options *options;
    kiln_report *report;
} image_samples;

bool image_write_png(const image_samples *);
bool image_write_jpeg(const image_samples *);
bool image_write_webp(const image_samples *);
bool image_write_tiff(const image_samples *);

/* Primaries and transfer by the numbers of ITU-T H.273; 0, 0: nothing is known. */
static inline void image_code_points(const kiln_image_write_options *o, uint8_t points[2]) {
    points[0] = o->srgb ? 1 : o->cicp_primaries;
    points[1] = o->srgb ? 13 : o->cicp_transfer;
}

/* caption.c: the text of the options where a format has no pairs: lines "Keyword: value", without an end of line. */
void image_caption(const kiln_image_write_options *, kiln_text *out);
/* The same as an XMP packet, with "Software" as the tool that made the file too; empty where there is no text. */
void image_xmp(const kiln_image_write_options *, kiln_text *out);

static inline size_t image_samples_row(const image_samples *s) {
    return (size_t)s->width * s->channels * (s->bits / 8);
}

/* Adds an OUTPUT error at path and returns false. */
bool image_not_written(const char *path, kiln_report *, const char *format, ...) KILN_PRINTF(3, 4);

#endif
