/* color/gamut.h: RGB spaces by the chromaticities of their primaries and white. */
#ifndef KILN_COLOR_GAMUT_H
#define KILN_COLOR_GAMUT_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct color_gamut {
    const char *space; /* its name in the embedded config */
    double xy[8];      /* red, green, blue, white: CIE 1931 x, y */
} color_gamut;

/* The spaces that kiln can name the chromaticities of. */
extern const color_gamut color_gamuts[];
extern const size_t color_gamut_count;
const color_gamut *gamut_find(const char *space); /* NULL: none */

/* 3 × 3 matrices, row-major. */
bool matrix3_invert(const double m[9], double inverse[9]); /* false: singular */
void matrix3_multiply(const double a[9], const double b[9], double product[9]);

/* RGB to CIE XYZ, where white has Y = 1 (SMPTE RP 177-1993). */
void gamut_to_xyz(const color_gamut *, double matrix[9]);

#ifdef __cplusplus
}
#endif
#endif
