/* kiln/color.h: scene-linear to everything else, by OpenColorIO. */
#ifndef KILN_COLOR_H
#define KILN_COLOR_H

#include "kiln/api.h"
#include "kiln/render.h"
#include "kiln/report.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A colour configuration: $OCIO, a file, or the one that is embedded in kiln. Immutable, any thread may use it. */
typedef struct kiln_color kiln_color;

typedef struct kiln_color_options {
    const char *config;        /* a file; NULL: $OCIO if set and not empty, else the embedded config */
    const char *working_space; /* the scene-linear space that renders happen in: a name, alias or role of the config,
                                  or, where the config has the role aces_interchange, one of kiln's own; NULL:
                                  "lin_rec709" */
} kiln_color_options;

KILN_API bool kiln_color_create(const kiln_color_options *, kiln_color **, kiln_report *);
KILN_API void kiln_color_destroy(kiln_color *);

/* "embedded kiln config, working space lin_rec709": for logs and file metadata. */
KILN_API const char *kiln_color_describe(const kiln_color *);

/* Tables that take pictures and factors into the working space. */
KILN_API bool kiln_color_working_space(const kiln_color *, kiln_decoding *, kiln_report *);

/* Red, green, blue, white of the working space as CIE xy, for file metadata; false when the config cannot tell. */
KILN_API bool kiln_color_chromaticities(const kiln_color *, float xy[8]);

typedef struct kiln_view_options {
    const char *display; /* NULL: the config's default */
    const char *view;    /* NULL: the display's default */
    const char *look;    /* in OpenColorIO's notation, "a, -b"; NULL: the view's own; "": none */
    double exposure;     /* stops, applied in the working space before everything else; −64 … 64 */
} kiln_view_options;

/* Working space to display, one processor. */
typedef struct kiln_view kiln_view;
KILN_API bool kiln_view_create(const kiln_color *, const kiln_view_options *, kiln_view **, kiln_report *);
KILN_API void kiln_view_destroy(kiln_view *);
KILN_API const char *kiln_view_describe(const kiln_view *); /* "display sRGB, view Raw, exposure +0.5" */
KILN_API bool kiln_view_is_srgb(const kiln_view *);         /* the pixels may be tagged as sRGB */
/* The numbers of ITU-T H.273 for other displays of the embedded config, to tag files with; 0, 0: unknown. */
KILN_API void kiln_view_cicp(const kiln_view *, uint8_t *primaries, uint8_t *transfer);

/* In place; channels 3 or 4 (alpha is left alone), interleaved. Pixels are exposed, then scrubbed (NaN becomes 0, what
 * lies beyond ±65504, infinities included, becomes that), then viewed; the result is clamped to [0,1] and finite. Any
 * number of threads may call it; how the pixels are divided among calls changes no bit. */
KILN_API void kiln_view_apply(const kiln_view *, float *pixels, size_t pixel_count, uint32_t channels);

/* For `kiln info`, --help and messages: names are borrowed; NULL at the end of the list. */
KILN_API const char *kiln_color_display(const kiln_color *, size_t index);
KILN_API const char *kiln_color_view(const kiln_color *, const char *display, size_t index);
KILN_API const char *kiln_color_look(const kiln_color *, size_t index);
KILN_API const char *kiln_color_space(const kiln_color *, size_t index);

#ifdef __cplusplus
}
#endif
#endif
