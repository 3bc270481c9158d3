/* TIFF files made by libtiff directly. Include after support.h. */
#ifndef KILN_TESTS_TIFF_MAKER_H
#define KILN_TESTS_TIFF_MAKER_H

#include "image/tiff.h"

/* A file made by libtiff directly. rows holds the samples of all planes, one plane after the other when separate. */
typedef struct tiff_form {
    uint16_t bits, samples, format, photometric, planar, compression, orientation;
    uint16_t extra; /* EXTRASAMPLE_… of the last sample, with has_extra */
    bool has_extra;
    uint32_t tile; /* side; 0: strips */
    const uint16_t *palette; /* 3 × 2^bits */
} tiff_form;

static inline kiln_bytes make_tiff(uint32_t width, uint32_t height, tiff_form f, const void *rows) {
    image_tiff_stream stream = {.writable = true};
    TIFF *tiff = image_tiff_open(&stream, "w", 0);
    assert_non_null(tiff);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, f.bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, f.samples);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, f.format ? f.format : SAMPLEFORMAT_UINT);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, f.photometric);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, f.planar ? f.planar : PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, f.compression ? f.compression : COMPRESSION_NONE);
    if (f.orientation) TIFFSetField(tiff, TIFFTAG_ORIENTATION, f.orientation);
    if (f.has_extra) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &f.extra);
    if (f.palette) {
        size_t count = (size_t)1 << f.bits;
        TIFFSetField(tiff, TIFFTAG_COLORMAP, f.palette, f.palette + count, f.palette + 2 * count);
    }
    bool separate = f.planar == PLANARCONFIG_SEPARATE;
    const unsigned char *at = rows;
    if (f.tile) {
        size_t pixel = (size_t)f.bits / 8 * f.samples;
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, f.tile);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, f.tile);
        unsigned char *tile = calloc((size_t)f.tile * f.tile, pixel);
        for (uint32_t y = 0; y < height; y += f.tile)
            for (uint32_t x = 0; x < width; x += f.tile) {
                for (uint32_t j = 0; j < f.tile && y + j < height; j++)
                    for (uint32_t i = 0; i < f.tile && x + i < width; i++)
                        memcpy(tile + (j * f.tile + i) * pixel, at + ((size_t)(y + j) * width + x + i) * pixel, pixel);
                assert_true(TIFFWriteTile(tiff, tile, x, y, 0, 0) > 0);
            }
        free(tile);
    } else {
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 3);
        for (uint16_t plane = 0; plane < (separate ? f.samples : 1); plane++)
            for (uint32_t y = 0; y < height; y++) {
                assert_true(TIFFWriteScanline(tiff, (void *)(uintptr_t)at, y, plane) == 1);
                at += TIFFScanlineSize(tiff);
            }
    }
    TIFFClose(tiff);
    return (kiln_bytes){stream.bytes, stream.size};
}

#endif
