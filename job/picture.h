/* job/picture.h: a film becomes files. */
#ifndef KILN_JOB_PICTURE_H
#define KILN_JOB_PICTURE_H

#include "image/image.h"
#include "kiln/job.h"

typedef struct picture {
    const kiln_film *film;
    const kiln_color *color;
    const kiln_view *view;
    bool transparent;          /* the film's alpha is the picture's */
    uint32_t layers;           /* of EXR files: bits 1 << kiln_aov of what the film holds */
    const uint8_t *background; /* RGB that the display shows where alpha is not 1; NULL: none */
    float background_linear[3]; /* the same in the working space */
    uint32_t threads;          /* 0: all */
    const char *const *text;   /* of display-referred files, pairs keyword, value */
    uint32_t text_count;
    const kiln_exr_attribute *attributes;
    uint32_t attribute_count;
} picture;

bool picture_write(const picture *, const char *path, kiln_report *);

/* What a display shows: RGB, or RGBA with straight alpha where the picture is transparent. F32; image_free. */
bool picture_display(const picture *, kiln_image *, kiln_report *);

/* picture_exr.c */
bool picture_write_exr(const picture *, const char *path, kiln_report *);

/* Scene-linear RGB with the background colour behind it; width × height × 3 floats of the crop. */
void picture_beauty(const picture *, const float *alpha, float *rgb);

/* picture_read.c: a picture from a file, as numbers; grey is three equal channels, what is transparent lies on black. */
typedef struct picture_pixels {
    uint32_t width, height, channels; /* of the file: 2 and 4 have alpha */
    bool linear;                      /* floats, scene-linear; else integers as 0 … 1, display-referred */
    float *rgb;
} picture_pixels;
bool picture_read(const char *path, picture_pixels *, kiln_report *);
void picture_pixels_free(picture_pixels *);

#endif
