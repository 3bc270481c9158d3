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
                            .aovs = 1u << KILN_AOV_ALPHA | 1u << KILN_AOV_ALBEDO};
}

/* What a quick render shows. */
typedef struct glance {
    size_t count;               /* pixels */
    float *rgb, *alpha, *albedo; /* albedo is RGB too */
} glance;

static void glance_free(glance *g) {
    free(g->rgb);
    free(g->alpha);
    free(g->albedo);
}

static bool glance_take(glance *g, const kiln_renderer *renderer, const kiln_render_options *options, uint32_t width,
                        uint32_t height, kiln_report *report) {
    kiln_render_options quick = *options;
    kiln_film_desc desc = small_film(width, height);
    kiln_film *film;
    *g = (glance){.count = (size_t)desc.width * desc.height};
    quick.spp = SPP;
    quick.noise = quick.budget_seconds = 0;
    quick.progress = NULL;
    if (!kiln_film_create(&desc, &film, report)) return false;
    bool done = kiln_render(renderer, &quick, film, NULL, report);
    g->rgb = array_alloc(g->count, 3 * sizeof *g->rgb);
    g->alpha = array_alloc(g->count, sizeof *g->alpha);
    g->albedo = array_alloc(g->count, 3 * sizeof *g->albedo);
    if (done && g->rgb && g->alpha && g->albedo) {
        kiln_film_beauty(film, g->rgb);
        kiln_film_aov(film, KILN_AOV_ALPHA, g->alpha);
        kiln_film_aov(film, KILN_AOV_ALBEDO, g->albedo);
    } else if (done) done = report_no_memory(report, "looking at the light");
    kiln_film_destroy(film);
    return done;
}

/* Rec.709's weights: other working spaces are near enough. */
static float luminance_of(const float rgb[3]) { return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]; }

static bool covered(const glance *g, size_t pixel) { return g->alpha[pixel] > 0.5f; }

bool exposure_choose(const kiln_renderer *renderer, const kiln_render_options *options, uint32_t width, uint32_t height,
                     double *stops, kiln_report *report) {
    glance g;
    size_t n = 0;
    *stops = 0;
    bool done = glance_take(&g, renderer, options, width, height, report);
    float *luminance = done ? array_alloc(g.count, sizeof *luminance) : NULL;
    if (done && !luminance) done = report_no_memory(report, "choosing an exposure");
    for (int all = 0; done && all < 2 && !n; all++) /* what surfaces fill; everything, where there is no surface */
        for (size_t i = 0; i < g.count; i++)
            if (all || covered(&g, i)) luminance[n++] = luminance_of(g.rgb + 3 * i);
    if (done) *stops = exposure_of(luminance, n);
    free(luminance);
    glance_free(&g);
    return done;
}

/* A surface counts as lit when it shows at least a twentieth of its albedo, 4.3 stops below what the studio makes of
 * it; a picture, when half of its surfaces are. */
bool exposure_is_lit(const kiln_renderer *renderer, const kiln_render_options *options, uint32_t width, uint32_t height,
                     bool *lit, kiln_report *report) {
    const float least = 0.05f;
    glance g;
    size_t surfaces = 0, bright = 0;
    bool done = glance_take(&g, renderer, options, width, height, report);
    for (size_t i = 0; done && i < g.count; i++) {
        if (!covered(&g, i)) continue;
        surfaces++;
        bright += luminance_of(g.rgb + 3 * i) > least * luminance_of(g.albedo + 3 * i);
    }
    *lit = surfaces && 2 * bright >= surfaces;
    glance_free(&g);
    return done;
}
