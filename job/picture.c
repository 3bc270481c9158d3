#include "job/picture.h"

#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "job/outputs.h"

static uint32_t width_of(const kiln_film_desc *d) { return d->crop[2] - d->crop[0]; }
static uint32_t height_of(const kiln_film_desc *d) { return d->crop[3] - d->crop[1]; }

void picture_beauty(const picture *p, const float *alpha, float *rgb) {
    kiln_film_desc d = kiln_film_describe(p->film);
    size_t count = (size_t)width_of(&d) * height_of(&d);
    kiln_film_beauty(p->film, rgb);
    for (size_t i = 0; p->background && i < count; i++)
        for (size_t k = 0; k < 3; k++) rgb[3 * i + k] += (1 - alpha[i]) * p->background_linear[k];
}

/* Rows of the picture that a thread works on at a time. */
typedef struct develop {
    const picture *picture;
    const float *alpha; /* NULL: opaque */
    float *pixels;
    uint32_t width, channels;
} develop;

/* The film's RGB is light times coverage: divided out, because a view is not linear; what is put behind comes after the
 * view, so that it is the colour that was asked for. */
static void develop_row(void *context, size_t row, uint32_t thread) {
    (void)thread;
    const develop *d = context;
    const picture *p = d->picture;
    float *pixels = d->pixels + row * d->width * d->channels;
    const float *alpha = d->alpha ? d->alpha + row * d->width : NULL;
    for (size_t i = 0; alpha && i < d->width; i++)
        for (size_t k = 0; k < 3; k++)
            pixels[i * d->channels + k] = alpha[i] > 0 ? pixels[i * d->channels + k] / alpha[i] : 0;
    kiln_view_apply(p->view, pixels, d->width, d->channels);
    for (size_t i = 0; p->background && i < d->width; i++)
        for (size_t k = 0; k < 3; k++)
            pixels[i * d->channels + k] =
                alpha[i] * pixels[i * d->channels + k] + (1 - alpha[i]) * (float)p->background[k] / 255;
}

/* From three channels to four in place, last pixel first. */
static void interleave(float *pixels, const float *alpha, size_t count) {
    for (size_t i = count; i-- > 0;) {
        memmove(pixels + 4 * i, pixels + 3 * i, 3 * sizeof *pixels);
        pixels[4 * i + 3] = alpha[i];
    }
}

bool picture_display(const picture *p, kiln_image *image, kiln_report *report) {
    kiln_film_desc film = kiln_film_describe(p->film);
    uint32_t width = width_of(&film), height = height_of(&film);
    bool uses_alpha = p->transparent || p->background, straight = p->transparent && !p->background;
    size_t count = (size_t)width * height;
    *image = (kiln_image){0};
    float *alpha = uses_alpha ? array_alloc(count, sizeof *alpha) : NULL;
    if (uses_alpha && !alpha) return report_no_memory(report, "viewing the picture");
    if (!image_alloc(image, width, height, straight ? 4 : 3, KILN_PIXELS_F32, report)) {
        free(alpha);
        return false;
    }
    if (alpha) kiln_film_aov(p->film, KILN_AOV_ALPHA, alpha);
    kiln_film_beauty(p->film, image->pixels);
    if (straight) interleave(image->pixels, alpha, count);
    develop d = {p, alpha, image->pixels, width, image->channels};
    threads_for(p->threads, height, develop_row, &d);
    free(alpha);
    return true;
}

static bool write_display(const picture *p, const char *path, kiln_report *report) {
    kiln_image image;
    kiln_image_write_options options = {
        .srgb = kiln_view_is_srgb(p->view), .text = p->text, .text_count = p->text_count};
    kiln_view_cicp(p->view, &options.cicp_primaries, &options.cicp_transfer);
    if (!picture_display(p, &image, report)) return false;
    bool done = image_write_display(path, &image, &options, report);
    image_free(&image);
    return done;
}

static bool write_hdr(const picture *p, const char *path, kiln_report *report) {
    kiln_film_desc d = kiln_film_describe(p->film);
    kiln_image image;
    float *alpha = p->background ? array_alloc((size_t)width_of(&d) * height_of(&d), sizeof *alpha) : NULL;
    if (p->background && !alpha) return report_no_memory(report, "writing a picture");
    if (alpha) kiln_film_aov(p->film, KILN_AOV_ALPHA, alpha);
    bool done = image_alloc(&image, width_of(&d), height_of(&d), 3, KILN_PIXELS_F32, report);
    if (done) {
        picture_beauty(p, alpha, image.pixels);
        done = image_write_hdr(path, &image, p->text, p->text_count, report);
        image_free(&image);
    }
    free(alpha);
    return done;
}

bool picture_write(const picture *p, const char *path, kiln_report *report) {
    switch (output_kind_of(path)) {
    case OUTPUT_EXR: return picture_write_exr(p, path, report);
    case OUTPUT_HDR: return write_hdr(p, path, report);
    case OUTPUT_DISPLAY: return write_display(p, path, report);
    case OUTPUT_UNKNOWN: break;
    }
    kiln_where where = where_root(path);
    return report_error(report, KILN_CODE_USAGE, &where, "use .exr, .hdr, .png, .jpg, .webp or .tif",
                        "the suffix names no format that kiln writes");
}

bool kiln_film_write(const kiln_film *film, const kiln_color *color, const kiln_view *view, const char *path,
                     kiln_report *report) {
    uint32_t aovs = kiln_film_describe(film).aovs;
    picture p = {.film = film, .color = color, .view = view, .layers = aovs, .transparent = aovs >> KILN_AOV_ALPHA & 1};
    return picture_write(&p, path, report);
}
