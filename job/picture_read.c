/* job/picture_read.c: a file becomes plain numbers. */
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/file.h"
#include "job/picture.h"

static double value_at(const kiln_image *image, size_t i) {
    switch (image->format) {
    case KILN_PIXELS_U8: return ((const uint8_t *)image->pixels)[i] / 255.0;
    case KILN_PIXELS_U16: return ((const uint16_t *)image->pixels)[i] / 65535.0;
    case KILN_PIXELS_F32: break;
    }
    return (double)((const float *)image->pixels)[i];
}

static bool unpack(const kiln_image *image, picture_pixels *p, kiln_report *report) {
    size_t count = (size_t)image->width * image->height, channels = image->channels;
    bool grey = channels < 3;
    *p = (picture_pixels){.width = image->width, .height = image->height, .channels = image->channels,
                          .linear = image->format == KILN_PIXELS_F32};
    p->rgb = array_alloc(count, 3 * sizeof *p->rgb);
    if (!p->rgb) return report_no_memory(report, "reading a picture");
    for (size_t i = 0; i < count; i++) {
        double alpha = channels % 2 ? 1 : value_at(image, i * channels + channels - 1);
        for (size_t k = 0; k < 3; k++)
            p->rgb[3 * i + k] = (float)(alpha * value_at(image, i * channels + (grey ? 0 : k)));
    }
    return true;
}

bool picture_read(const char *path, picture_pixels *p, kiln_report *report) {
    kiln_bytes bytes;
    kiln_image image;
    kiln_where where = where_root(path);
    *p = (picture_pixels){0};
    if (!file_read(path, (uint64_t)4 << 30, &bytes, NULL, report)) return false;
    bool done = image_decode(bytes.data, bytes.size, 0, &image, &where, report);
    file_free(&bytes);
    if (!done) return false;
    done = unpack(&image, p, report);
    image_free(&image);
    return done;
}

void picture_pixels_free(picture_pixels *p) {
    free(p->rgb);
    *p = (picture_pixels){0};
}
