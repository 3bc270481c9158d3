/* color/color.h: what a kiln_color holds. */
#ifndef KILN_COLOR_COLOR_H
#define KILN_COLOR_COLOR_H

#include "base/arena.h"
#include "color/ocio.h"
#include "kiln/color.h"

/* A scene-linear space that a config can convert from: a matrix (row-major) into a space of the config. */
typedef struct linear_space {
    const char *space;
    bool direct; /* the matrix is the identity */
    double matrix[9];
} linear_space;

typedef struct name_list {
    const char **names;
    size_t count;
} name_list;

struct kiln_color {
    kiln_arena arena;
    ocio_config *embedded; /* always there: it knows what sRGB and linear Rec.709 are */
    ocio_config *config;   /* the one in use; may be `embedded` */
    kiln_where where;      /* the config, for messages */
    const char *description;
    linear_space working;
    double from_rec709[9]; /* linear Rec.709 to the working space */
    name_list displays, looks, spaces;
    name_list *views; /* one list per display */
};

static inline bool color_is_embedded(const kiln_color *color) { return color->config == color->embedded; }

/* "display \"sRBG\" does not exist; there are: …", with the nearest in the remedy. Returns false. */
bool color_unknown_name(const kiln_color *, const char *what, const char *given, const name_list *known, kiln_report *);

/* Finds the working space and linear Rec.709 in the config (color/working.c). */
bool color_find_working(kiln_color *, const char *name, kiln_report *);

#endif
