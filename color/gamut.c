#include "color/gamut.h"

#include <math.h>
#include <string.h>

const color_gamut color_gamuts[] = {
    {"lin_rec709", {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290}},         /* ITU-R BT.709-6 */
    {"ACEScg", {0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767}},     /* AP1: ACES S-2014-004 */
    {"ACES2065-1", {0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767}}, /* AP0: SMPTE ST 2065-1 */
    {"lin_p3d65", {0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290}},    /* SMPTE EG 432-1 */
    {"lin_rec2020", {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290}},  /* ITU-R BT.2020-2 */
};
const size_t color_gamut_count = sizeof color_gamuts / sizeof *color_gamuts;

const color_gamut *gamut_find(const char *space) {
    for (size_t i = 0; i < color_gamut_count; i++)
        if (strcmp(color_gamuts[i].space, space) == 0) return &color_gamuts[i];
    return NULL;
}

bool matrix3_invert(const double m[9], double inverse[9]) {
    double cofactors[9];
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
            cofactors[3 * row + column] = m[3 * r1 + c1] * m[3 * r2 + c2] - m[3 * r1 + c2] * m[3 * r2 + c1];
        }
    double determinant = m[0] * cofactors[0] + m[1] * cofactors[1] + m[2] * cofactors[2];
    if (!(fabs(determinant) > 0) || !isfinite(1 / determinant)) return false;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            inverse[3 * row + column] = cofactors[3 * column + row] / determinant;
    return true;
}

void matrix3_multiply(const double a[9], const double b[9], double product[9]) {
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            product[3 * row + column] =
                a[3 * row] * b[column] + a[3 * row + 1] * b[3 + column] + a[3 * row + 2] * b[6 + column];
}

/* The columns are the XYZ of the primaries, scaled so that their sum is the white. */
void gamut_to_xyz(const color_gamut *gamut, double matrix[9]) {
    double directions[9], inverse[9], white[3];
    for (int k = 0; k < 4; k++) {
        double x = gamut->xy[2 * k], y = gamut->xy[2 * k + 1];
        const double xyz[3] = {x / y, 1, (1 - x - y) / y};
        for (int row = 0; row < 3; row++) *(k < 3 ? &directions[3 * row + k] : &white[row]) = xyz[row];
    }
    matrix3_invert(directions, inverse); /* the primaries of a gamut are not on one line */
    for (int k = 0; k < 3; k++) {
        double scale = inverse[3 * k] * white[0] + inverse[3 * k + 1] * white[1] + inverse[3 * k + 2] * white[2];
        for (int row = 0; row < 3; row++) matrix[3 * row + k] = scale * directions[3 * row + k];
    }
}
