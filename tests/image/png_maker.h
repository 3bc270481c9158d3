/* PNG files made by libpng directly. Include after support.h. */
#ifndef KILN_TESTS_PNG_MAKER_H
#define KILN_TESTS_PNG_MAKER_H

#include <png.h>

static inline void png_maker_append(png_structp png, png_bytep data, size_t size) {
    text_append_bytes(png_get_io_ptr(png), (const char *)data, size);
}
static inline void png_maker_flush(png_structp png) { (void)png; }

typedef struct png_form {
    int type, bits, interlace;
    const png_color *palette;
    int palette_count;
    const png_byte *alpha; /* of the palette */
    int alpha_count;
    png_color_16 *transparent;
    double gamma;
} png_form;

/* Rows as PNG stores them, 16 bits big-endian. */
static inline kiln_text make_png(uint32_t width, uint32_t height, png_form f, const unsigned char *rows,
                                 size_t stride) {
    kiln_text out = {0};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &out, png_maker_append, png_maker_flush);
    png_set_IHDR(png, info, width, height, f.bits, f.type, f.interlace, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (f.palette) png_set_PLTE(png, info, f.palette, f.palette_count);
    if (f.alpha || f.transparent) png_set_tRNS(png, info, f.alpha, f.alpha_count, f.transparent);
    if (f.gamma > 0) png_set_gAMA(png, info, f.gamma);
    png_write_info(png, info);
    png_bytep *pointers = calloc(height, sizeof *pointers);
    for (uint32_t y = 0; y < height; y++) pointers[y] = (png_bytep)(uintptr_t)(rows + y * stride);
    png_write_image(png, pointers);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    free(pointers);
    return out;
}

#endif
