/* tests/render/bsdf_chart.h: integrals of a BSDF over directions, cell by cell.
 *
 * Directions are told apart by their half vectors, which resolve a microfacet lobe of any width. With x = tan² of the
 * half vector's angle, GGX spreads evenly over x/(α² + x); a family of rings is spaced so, others for wide lobes and for
 * what grazes. A clear coat's lobe takes another family, and so does light that comes and leaves near the
 * horizon after many events. Anisotropic surfaces are charted in coordinates that are stretched until they are round, and
 * once more in round ones, where wide lobes are. Sheen crowds at the horizon, whatever its half vectors: where nothing
 * glossy is beside it, the rings are elevations. */
#ifndef KILN_TESTS_RENDER_BSDF_CHART_H
#define KILN_TESTS_RENDER_BSDF_CHART_H

#include "base/mat.h"
#include "tests/render/bsdf_cases.h"

enum {
    CHART_RINGS = 9, CHART_SECTORS = 8, CHART_FINE = 60, CHART_ROWS = CHART_RINGS * CHART_FINE,
    CHART_SIDE = CHART_RINGS * CHART_SECTORS,
    CHART_BEYOND = 2 * CHART_SIDE, /* below, and no half vector leads there */
    CHART_CELLS
};

typedef struct chart {
    const probe *probe;
    double a2;      /* α² along x */
    double stretch; /* α along y over that along x */
    double widths[5]; /* of the families of rings; their number: */
    int width_count;
    dvec3 wo;
    double sheen;  /* > 0: rings of elevation, over z/(z + sheen) */
    bool refracts; /* below, half vectors are those of refraction */
    bool mirrors;  /* below, what leaves is charted by the half vectors of its mirror image: a thin wall, diffuse light */
    double x[CHART_ROWS]; /* in the middle of every row, CHART_FINE to a ring */
} chart;

void chart_make(chart *, const probe *);
int chart_cell(const chart *, dvec3 wi);

/* By midpoints: pdf over each cell, and f cos over the directions above (0) and below (1). */
typedef struct chart_sums {
    double pdf[CHART_CELLS];
    dvec3 value[2];
} chart_sums;
chart_sums chart_integrate(const chart *);

#endif
