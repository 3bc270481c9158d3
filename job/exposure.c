#include "job/exposure.h"

#include <math.h>
#include <stdlib.h>

#include "base/arena.h"
#include "base/report.h"

/* 9,216 pixels at most: a quick look; 16 samples: percentiles do not need more. */
enum { SIDE = 96, SPP = 16 };

static int compare(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* The middle of what is lit becomes a middle grey, unless that would burn out the bright part: its 95th percentile
 * stays below white. What is a thousandth of that lies in shadow, and does not
 * count. Whole tenths of a stop: the number that the log tells gives the same picture. */
double exposure_of(float *luminance, size_t count) {
    const double middle = 0.18, brightest = 1, shadow = 1e-3;
    if (!count) return 0;
    qsort(luminance, count, sizeof *luminance, compare);
    size_t first = 0;
    while (first < count && !(luminance[first] > 0)) first++;
    if (first == count) return 0;
    double high = (double)luminance[first + (count - first - 1) * 95 / 100], logs = 0, n = 0;
    for (size_t i = first; i < count; i++) {
        if ((double)luminance[i] < shadow * high) continue;
        logs += log2((double)luminance[i]);
        n++;
    }
    double stops = fmin(log2(middle) - logs / n, log2(brightest) - log2(high));
    return fmax(fmin(round(stops * 10) / 10, 64), -64);
}

static kiln_film_desc small_film(uint32_t width, uint32_t height) {
    uint32_t longer = width > height ? width : height;
    double scale = longer > SIDE ? (double)SIDE / longer : 1;
    return (kiln_film_desc){.width = (uint32_t)fmax(round(width * scale), 1),
                            .height = (uint32_t)fmax(round(height * scale), 1),
                            .aovs = 1u << KILN_AOV_ALPHA};
}

/* Luminances (Rec.709's weights: other working spaces are near enough) of what surfaces fill; of everything, where
 * there is no surface. */
static bool measure(const kiln_film *film, double *stops, kiln_report *report) {
    kiln_film_desc d = kiln_film_describe(film);
    size_t count = (size_t)d.width * d.height, covered = 0;
    float *rgb = array_alloc(count, 3 * sizeof *rgb), *alpha = array_alloc(count, sizeof *alpha),
          *luminance = array_alloc(count, sizeof *luminance);
    bool done = rgb && alpha && luminance;
    if (done) {
        kiln_film_beauty(film, rgb);
        kiln_film_aov(film, KILN_AOV_ALPHA, alpha);
        for (int all = 0; all < 2 && !covered; all++)
            for (size_t i = 0; i < count; i++)
                if (all || alpha[i] > 0.5f)
                    luminance[covered++] = 0.2126f * rgb[3 * i] + 0.7152f * rgb[3 * i + 1] + 0.0722f * rgb[3 * i + 2];
        *stops = exposure_of(luminance, covered);
    }
    free(rgb);
    free(alpha);
    free(luminance);
    return done || report_no_memory(report, "choosing an exposure");
}

bool exposure_choose(const kiln_renderer *renderer, const kiln_render_options *options, uint32_t width, uint32_t height,
                     double *stops, kiln_report *report) {
    kiln_render_options quick = *options;
    kiln_film_desc desc = small_film(width, height);
    kiln_film *film;
    *stops = 0;
    quick.spp = SPP;
    quick.noise = quick.budget_seconds = 0;
    quick.progress = NULL;
    if (!kiln_film_create(&desc, &film, report)) return false;
    bool done = kiln_render(renderer, &quick, film, NULL, report) && measure(film, stops, report);
    kiln_film_destroy(film);
    return done;
}
