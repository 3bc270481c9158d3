/* render/film/difference.c: how far two pictures of one thing are apart, and the halves of one that tell it. */
#include <math.h>

#include "kiln/difference.h"
#include "render/film/film.h"

/* Mean radiance of a replicate. */
static double replicate_mean(const kiln_film *f, size_t pixel, uint32_t replicate, int channel) {
    uint32_t own = (f->counts[pixel] + KILN_REPLICATES - 1 - replicate) / KILN_REPLICATES;
    return fixed_to_double(f->pixels[pixel].sum[replicate][channel]) / own;
}

_Static_assert(KILN_REPLICATES == 2, "one difference for each factor of the square");

bool kiln_film_half(const kiln_film *f, uint32_t half, float *rgb) {
    if (half >= KILN_REPLICATES || kiln_film_spp(f) < KILN_REPLICATES) return false;
    for (size_t i = 0; i < (size_t)f->width * f->height; i++)
        for (int k = 0; k < 3; k++) rgb[3 * i + (size_t)k] = (float)replicate_mean(f, i, half, k);
    return true;
}

kiln_film_difference kiln_film_compare(const kiln_film *film, const kiln_film *reference, double scale) {
    kiln_film_difference d = {0};
    double squares = 0, sum = 0, whole = 0, count = 0;
    bool same = film->width == reference->width && film->height == reference->height;
    if (!same || kiln_film_spp(film) < KILN_REPLICATES || kiln_film_spp(reference) < KILN_REPLICATES) return d;
    for (size_t i = 0; i < (size_t)film->width * film->height; i++) {
        if (!film->hits[i] && !reference->hits[i]) continue;
        count++;
        for (int k = 0; k < 3; k++) {
            double a[2], b[2];
            for (uint32_t r = 0; r < 2; r++)
                a[r] = replicate_mean(film, i, r, k) * scale, b[r] = replicate_mean(reference, i, r, k) * scale;
            double ref = 0.5 * (b[0] + b[1]);
            squares += (a[0] - b[0]) * (a[1] - b[1]) / (ref * ref + 0.01);
            sum += 0.5 * (a[0] + a[1]) - ref;
            whole += ref;
        }
    }
    if (!(count > 0)) return d;
    d.known = true;
    d.root = sqrt(fmax(squares / (3 * count), 0));
    d.light = whole > 0 ? sum / whole : 0;
    return d;
}
