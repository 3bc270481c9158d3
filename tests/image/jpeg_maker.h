/* JPEG files made by libjpeg directly. Include after support.h. */
#ifndef KILN_TESTS_JPEG_MAKER_H
#define KILN_TESTS_JPEG_MAKER_H

#include <jpeglib.h>

/* A file made by libjpeg directly, of one colour everywhere. */
typedef struct jpeg_form {
    J_COLOR_SPACE input, file;
    int components;
    bool progressive, no_adobe_marker, exif_turned;
    const jpeg_scan_info *scans;
    int scan_count;
} jpeg_form;

static inline kiln_bytes make_jpeg(uint32_t width, uint32_t height, jpeg_form f, const unsigned char *colour) {
    /* APP1 of Exif: big-endian TIFF with one entry, Orientation (0x0112, SHORT) = 6, a quarter turn. */
    static const unsigned char exif[] = "Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0";
    struct jpeg_error_mgr errors;
    struct jpeg_compress_struct jpeg = {.err = jpeg_std_error(&errors)};
    unsigned char *bytes = NULL;
    unsigned long size = 0;
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes, &size);
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = f.components;
    jpeg.in_color_space = f.input;
    jpeg_set_defaults(&jpeg);
    jpeg_set_colorspace(&jpeg, f.file);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (f.progressive) jpeg_simple_progression(&jpeg);
    if (f.scans) {
        jpeg.scan_info = f.scans;
        jpeg.num_scans = f.scan_count;
    }
    if (f.no_adobe_marker) jpeg.write_Adobe_marker = FALSE;
    jpeg_start_compress(&jpeg, TRUE);
    if (f.exif_turned) jpeg_write_marker(&jpeg, JPEG_APP0 + 1, exif, sizeof exif - 1);
    unsigned char *row = malloc((size_t)width * (size_t)f.components);
    for (uint32_t i = 0; i < width * (uint32_t)f.components; i++) row[i] = colour[i % (uint32_t)f.components];
    for (uint32_t y = 0; y < height; y++) jpeg_write_scanlines(&jpeg, &row, 1);
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    free(row);
    kiln_bytes result = {malloc(size), size};
    memcpy(result.data, bytes, size);
    free(bytes);
    return result;
}

#endif
