#include <stdlib.h>

#include "base/file.h"
#include "image/codec.h"
#include "image/icc.h"
#include "image/tiff.h"

static void set_text(TIFF *tiff, const kiln_image_write_options *options) {
    kiln_text lines = {0};
    image_caption(options, &lines);
    if (lines.data) TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, lines.data);
    text_free(&lines);
}

static bool encode(TIFF *tiff, const image_samples *s) {
    static const uint16_t straight = EXTRASAMPLE_UNASSALPHA;
    unsigned char profile[IMAGE_ICC_MAX];
    uint32_t profile_size = s->channels >= 3 ? (uint32_t)image_icc(s->options, profile) : 0;
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, s->width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, s->height);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, s->bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, s->channels);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, s->channels < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0));
    if (s->channels == 2 || s->channels == 4) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &straight);
    if (profile_size) TIFFSetField(tiff, TIFFTAG_ICCPROFILE, profile_size, profile);
    set_text(tiff, s->options);
    for (uint32_t y = 0; y < s->height; y++) {
        void *row = (void *)(uintptr_t)(s->bytes + y * image_samples_row(s));
        if (TIFFWriteScanline(tiff, row, y, 0) < 0) return false;
    }
    return TIFFFlush(tiff);
}

bool image_write_tiff(const image_samples *s) {
    image_tiff_stream stream = {.writable = true};
    /* Little-endian everywhere; the offsets of a classic TIFF end at 4 GiB. */
    bool big = (uint64_t)image_samples_row(s) * s->height > 0xf0000000u;
    TIFF *tiff = image_tiff_open(&stream, big ? "w8l" : "wl", 0);
    bool done = tiff && encode(tiff, s);
    if (tiff) TIFFClose(tiff);
    done = done ? file_replace(s->path, stream.bytes, stream.size, s->report)
                : image_not_written(s->path, s->report, "%s", stream.message[0] ? stream.message : "libtiff failed");
    free(stream.bytes);
    return done;
}
