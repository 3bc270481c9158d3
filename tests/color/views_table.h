/* tests/color/views_table.h: golden values of display views. */
#ifndef KILN_TESTS_COLOR_VIEWS_TABLE_H
#define KILN_TESTS_COLOR_VIEWS_TABLE_H

#include <stddef.h>

enum { VIEWS_COLORS_MAX = 64 };

typedef struct views_row {
    const char *display, *view;
    float expected[VIEWS_COLORS_MAX][3];
} views_row;

extern const float views_colors[][3]; /* linear Rec.709 */
extern const size_t views_color_count;
extern const views_row views_rows[];
extern const size_t views_row_count;

#endif
