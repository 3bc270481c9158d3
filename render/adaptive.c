#include "render/adaptive.h"

#include <math.h>
#include <stdlib.h>

#include "base/arena.h"

/* Targets are multiples of STEP: replicates take turns, and their sequences are best at even counts. No pixel gets more
 * than MOST times the mean: what pooled estimates promise beyond that they do not keep. A neighbourhood of 5 × 5 would gain
 * more, with a bias near a tenth of the error; of 7 × 7 it is less. */
enum { STEP = 2 * KILN_REPLICATES, MOST = 16, REACH = 3, QUARTER = 2 };

/* What the film is to have of a pixel, before it is rounded. */
static double wanted(const kiln_film *f, const float *weights, size_t i, double scale, double most) {
    double n = scale * (double)weights[i];
    n = n < most ? n : most;
    return n > (double)f->counts[i] ? n : (double)f->counts[i];
}

static double wanted_in_all(const kiln_film *f, const float *weights, double scale, double most) {
    double sum = 0;
    for (size_t i = 0; i < (size_t)f->width * f->height; i++) sum += wanted(f, weights, i, scale, most);
    return sum;
}

/* Means over 2 REACH + 1 neighbours along a line of n values, `stride` apart; those outside do not count. */
static void blur_line(const float *from, float *to, uint32_t n, size_t stride) {
    double sum = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < REACH && i < n; i++) sum += (double)from[i * stride], count++;
    for (uint32_t i = 0; i < n; i++) {
        if (i + REACH < n) sum += (double)from[(i + REACH) * stride], count++;
        if (i > REACH) sum -= (double)from[(i - REACH - 1) * stride], count--;
        to[i * stride] = (float)(sum > 0 ? sum / count : 0);
    }
}

static void blur(const kiln_film *f, float *values, float *scratch) {
    for (uint32_t y = 0; y < f->height; y++)
        blur_line(values + (size_t)y * f->width, scratch + (size_t)y * f->width, f->width, 1);
    for (uint32_t x = 0; x < f->width; x++) blur_line(scratch + x, values + x, f->height, f->width);
}

/* √e of every pixel, from its neighbourhood; free(). NULL: out of memory. */
static float *weigh(const kiln_film *f, double scale) {
    size_t pixels = (size_t)f->width * f->height;
    float *weights = array_alloc(pixels, sizeof *weights), *scratch = array_alloc(pixels, sizeof *scratch);
    if (weights && scratch) {
        film_relative_errors(f, scale, weights);
        for (size_t i = 0; i < pixels; i++) weights[i] *= (float)f->counts[i];
        blur(f, weights, scratch);
        for (size_t i = 0; i < pixels; i++) weights[i] = sqrtf(weights[i]);
    } else {
        free(weights);
        weights = NULL;
    }
    free(scratch);
    return weights;
}

/* Of the pixels of a block, QUARTER a side and aligned with the picture, which packets of rays hold together. */
typedef struct block { size_t pixels[QUARTER * QUARTER]; uint32_t count, least; double wanted; } block;

static block look(const kiln_film *f, const float *weights, uint32_t x0, uint32_t y0, double scale, double most) {
    block b = {.least = UINT32_MAX};
    for (uint32_t y = y0; y < y0 + QUARTER; y++)
        for (uint32_t x = x0; x < x0 + QUARTER; x++) {
            uint32_t i = x - f->desc.crop[0], j = y - f->desc.crop[1]; /* huge to the left and above */
            if (i >= f->width || j >= f->height) continue;
            size_t at = (size_t)j * f->width + i;
            b.pixels[b.count++] = at;
            b.least = f->counts[at] < b.least ? f->counts[at] : b.least;
            b.wanted += wanted(f, weights, at, scale, most);
        }
    return b;
}

/* Rounds to steps, of blocks: lanes of a packet would be idle where its pixels differ. What one block is denied the next
 * one gets. */
static void share_out(const kiln_film *f, const float *weights, double scale, double most, uint32_t *targets) {
    double owed = 0;
    const uint32_t *crop = f->desc.crop;
    for (uint32_t y = crop[1] / QUARTER * QUARTER; y < crop[3]; y += QUARTER)
        for (uint32_t x = crop[0] / QUARTER * QUARTER; x < crop[2]; x += QUARTER) {
            block b = look(f, weights, x, y, scale, most);
            double more = (b.wanted + owed) / b.count - b.least, given = 0;
            uint32_t target = b.least + (more > 0 ? (uint32_t)(more / STEP + 0.5) : 0) * STEP;
            for (uint32_t k = 0; k < b.count; k++) {
                uint32_t have = f->counts[b.pixels[k]];
                targets[b.pixels[k]] = target > have ? target : have;
                given += (double)targets[b.pixels[k]];
            }
            owed += b.wanted - given;
        }
}

double adaptive_gain(const kiln_film *f, double scale) {
    size_t pixels = (size_t)f->width * f->height;
    float *weights = weigh(f, scale);
    double roots = 0, sum = 0;
    for (size_t i = 0; weights && i < pixels; i++) {
        roots += (double)weights[i];
        sum += (double)weights[i] * (double)weights[i];
    }
    free(weights);
    return sum > 0 ? roots * roots / ((double)pixels * sum) : 1;
}

/* What weights are multiplied by for the film to have so many samples; by bisection. Where nothing is known to err, or
 * hardly anything, all weights become alike. */
static double find_scale(const kiln_film *f, float *weights, double samples, double most) {
    double low = 0, high = 1;
    while (high < 1e30 && wanted_in_all(f, weights, high, most) < samples) high *= 2;
    if (!(high < 1e30)) {
        for (size_t i = 0; i < (size_t)f->width * f->height; i++) weights[i] = 1;
        high = most;
    }
    for (int k = 0; k < 50; k++) {
        double middle = 0.5 * (low + high);
        *(wanted_in_all(f, weights, middle, most) < samples ? &low : &high) = middle;
    }
    return high;
}

bool adaptive_plan(const kiln_film *f, double scale, uint64_t samples, uint32_t *targets) {
    double most = MOST * ((double)samples / ((double)f->width * f->height));
    float *weights = weigh(f, scale);
    if (!weights) return false;
    share_out(f, weights, find_scale(f, weights, (double)samples, most), most, targets);
    free(weights);
    return true;
}
