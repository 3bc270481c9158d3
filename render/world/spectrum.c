#include "render/world/spectrum.h"

#include <math.h>

/* CIE 1931 by lobes of Gaussians: Wyman, Sloan and Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color
 * Matching Functions", JCGT 2(2), eq. 4 with the constants of listing 1. */
static double lobe(double nm, double peak, double below, double above) {
    double t = (nm - peak) * (nm < peak ? below : above);
    return exp(-0.5 * t * t);
}
static void matching_functions(double nm, double xyz[3]) {
    xyz[0] = 0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
             0.065 * lobe(nm, 501.1, 0.0490, 0.0382);
    xyz[1] = 0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322);
    xyz[2] = 1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725);
}

/* The fit has no digits left beyond, where the eye hardly sees. */
enum { FIRST_NM = 400, LAST_NM = 680, PER_NM = 4, LINES = (LAST_NM - FIRST_NM) * PER_NM + 1 };

/* The colours of the lines between FIRST_NM and LAST_NM. What lies outside of the working space's gamut is cut: the film
 * takes no negative light. Each channel then sums to 1, so that all lines together are white. */
static void make_lines(const float to_working[9], double lines[LINES][3]) {
    /* IEC 61966-2-1: XYZ to linear Rec.709 */
    static const double to_rec709[9] = {3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108,
                                        0.0415560, 0.0556434,  -0.2040259, 1.0572252};
    double sums[3] = {0, 0, 0};
    for (int i = 0; i < LINES; i++) {
        double xyz[3], rgb[3];
        matching_functions(FIRST_NM + (double)i / PER_NM, xyz);
        for (int k = 0; k < 3; k++)
            rgb[k] = to_rec709[3 * k] * xyz[0] + to_rec709[3 * k + 1] * xyz[1] + to_rec709[3 * k + 2] * xyz[2];
        for (int k = 0; k < 3; k++) {
            double c = (double)to_working[3 * k] * rgb[0] + (double)to_working[3 * k + 1] * rgb[1] +
                       (double)to_working[3 * k + 2] * rgb[2];
            lines[i][k] = fmax(c, 0);
            sums[k] += lines[i][k];
        }
    }
    for (int i = 0; i < LINES; i++)
        for (int k = 0; k < 3; k++) lines[i][k] /= sums[k];
}

void spectrum_make(const float to_working[9], float table[SPECTRUM_FLOATS]) {
    double lines[LINES][3], rows[SPECTRUM_STEPS + 1][4], means[3] = {0, 0, 0}, before = 0;
    make_lines(to_working, lines);
    for (int row = 0, i = 0; row <= SPECTRUM_STEPS; row++) { /* the inverse of the density's running sum */
        double wanted = (double)row / SPECTRUM_STEPS, density = 0;
        for (;; i++) {
            density = (lines[i][0] + lines[i][1] + lines[i][2]) / 3;
            if (before + density >= wanted || i + 2 >= LINES) break;
            before += density;
        }
        double t = density > 0 ? fmin((wanted - before) / density, 1) : 0, sum = 0, weight[3];
        for (int k = 0; k < 3; k++) sum += weight[k] = lines[i][k] + t * (lines[i + 1][k] - lines[i][k]);
        rows[row][0] = FIRST_NM + (i + t) / PER_NM;
        for (int k = 0; k < 3; k++) {
            rows[row][k + 1] = sum > 0 ? 3 * weight[k] / sum : 1;
            means[k] += rows[row][k + 1] * (row % SPECTRUM_STEPS ? 1.0 : 0.5) / SPECTRUM_STEPS;
        }
    }
    for (int row = 0; row <= SPECTRUM_STEPS; row++) {
        table[4 * row] = (float)rows[row][0];
        for (int k = 0; k < 3; k++) table[4 * row + k + 1] = (float)(rows[row][k + 1] / means[k]);
    }
}
