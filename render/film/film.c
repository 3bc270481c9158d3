#include "render/film/film.h"

#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/report.h"

static const struct { uint32_t channels; } aov_rows[KILN_AOV_COUNT] = {
#define KILN_AOV_ROW(id, name, channels, text) [KILN_AOV_##id] = {channels},
    KILN_AOVS(KILN_AOV_ROW)
#undef KILN_AOV_ROW
};

/* ALPHA, SAMPLES and ERROR are known from counts and replicates, OBJECT and MATERIAL from ballots. */
static bool is_summed(int aov) { return FILM_SUMMED_AOVS >> aov & 1; }
/* Averaged over the samples that hit: what has no meaning where nothing is. */
#define AOVS_OF_HITS (1u << KILN_AOV_DEPTH | 1u << KILN_AOV_POSITION | 1u << KILN_AOV_UV)

static bool allocate(kiln_film *f) {
    size_t pixels = (size_t)f->width * f->height;
    f->pixels = aligned_array(pixels, sizeof *f->pixels);
    f->counts = aligned_array(pixels, sizeof *f->counts);
    f->hits = aligned_array(pixels, sizeof *f->hits);
    bool done = f->pixels && f->counts && f->hits && film_allocate_ballots(f) && film_allocate_parts(f);
    for (int a = 0; a < KILN_AOV_COUNT; a++)
        if (f->desc.aovs & 1u << a && is_summed(a))
            done = done && (f->aovs[a] = aligned_array(pixels * aov_rows[a].channels, sizeof(fixed)));
    return done;
}

static bool check(const kiln_film_desc *d, kiln_report *report) {
    kiln_where where = where_root("film");
    if (d->width < 1 || d->height < 1 || d->width > 65536 || d->height > 65536)
        return report_error(report, KILN_CODE_USAGE, &where, "give sides from 1 to 65536 pixels",
                            "a picture of %u x %u pixels", d->width, d->height);
    if (d->crop[0] >= d->crop[2] || d->crop[1] >= d->crop[3] || d->crop[2] > d->width || d->crop[3] > d->height)
        return report_error(report, KILN_CODE_USAGE, &where, "give X0,Y0,X1,Y1 within the picture, X0 < X1, Y0 < Y1",
                            "the crop %u,%u,%u,%u is not a part of %u x %u pixels", d->crop[0], d->crop[1], d->crop[2],
                            d->crop[3], d->width, d->height);
    if (d->aovs >> KILN_AOV_COUNT || d->mattes >> KILN_MATTE_COUNT)
        return report_error(report, KILN_CODE_USAGE, &where, NULL, "aovs 0x%x or mattes 0x%x are unknown", d->aovs,
                            d->mattes);
    return true;
}

static uint64_t bytes_per_pixel(const kiln_film_desc *d) {
    uint64_t each = sizeof(film_pixel) + 2 * sizeof(uint32_t) + film_ballot_bytes(d) + film_part_bytes(d);
    for (int a = 0; a < KILN_AOV_COUNT; a++)
        if (d->aovs & 1u << a && is_summed(a)) each += aov_rows[a].channels * sizeof(fixed);
    return each;
}

uint64_t kiln_film_size(const kiln_film_desc *d) {
    bool cropped = d->crop[2] > d->crop[0] && d->crop[3] > d->crop[1];
    uint64_t width = cropped ? d->crop[2] - d->crop[0] : d->width;
    uint64_t height = cropped ? d->crop[3] - d->crop[1] : d->height;
    return width * height * bytes_per_pixel(d);
}

bool kiln_film_create(const kiln_film_desc *desc, kiln_film **film, kiln_report *report) {
    *film = NULL;
    kiln_film_desc d = *desc;
    if (!d.crop[0] && !d.crop[1] && !d.crop[2] && !d.crop[3]) d.crop[2] = d.width, d.crop[3] = d.height;
    if (!check(&d, report)) return false;
    kiln_film *f = calloc(1, sizeof *f);
    if (!f) return report_no_memory(report, "making the film");
    f->desc = d;
    f->width = d.crop[2] - d.crop[0];
    f->height = d.crop[3] - d.crop[1];
    if (!film_make_parts(f, &d, report) || !(allocate(f) || report_no_memory(report, "making the film"))) {
        kiln_film_destroy(f);
        return false;
    }
    *film = f;
    return true;
}

void kiln_film_destroy(kiln_film *f) {
    if (!f) return;
    free(f->pixels);
    free(f->counts);
    free(f->hits);
    for (int a = 0; a < KILN_AOV_COUNT; a++) free(f->aovs[a]);
    film_free_ballots(f);
    film_free_parts(f);
    free(f);
}

kiln_film_desc kiln_film_describe(const kiln_film *f) { return f->desc; }

static void add_to(fixed *sums, size_t pixel, const float *values, uint32_t channels) {
    for (uint32_t k = 0; sums && k < channels; k++) sums[pixel * channels + k] += fixed_from_float(values[k]);
}

void film_add(kiln_film *f, uint32_t x, uint32_t y, const film_sample *s) {
    size_t pixel = (size_t)y * f->width + x;
    uint32_t replicate = f->counts[pixel]++ & (KILN_REPLICATES - 1);
    for (int k = 0; k < 3; k++) f->pixels[pixel].sum[replicate][k] += fixed_from_float(s->radiance[k]);
    for (uint32_t p = 0; s->parts && p < f->parts.count; p++)
        for (int k = 0; k < 3; k++) f->parts.items[p].sums[pixel][k] += s->parts[p][k];
    if (!(s->alpha > 0.0f)) return;
    f->hits[pixel]++;
    add_to(f->aovs[KILN_AOV_ALBEDO], pixel, s->albedo, 3);
    add_to(f->aovs[KILN_AOV_NORMAL], pixel, s->normal, 3);
    add_to(f->aovs[KILN_AOV_DEPTH], pixel, &s->depth, 1);
    add_to(f->aovs[KILN_AOV_POSITION], pixel, s->position, 3);
    add_to(f->aovs[KILN_AOV_UV], pixel, s->uv, 2);
    film_count(f, pixel, s);
}

void film_read_pixel(const kiln_film *f, size_t pixel, double mean[3], double variance[3]) {
    uint32_t n = f->counts[pixel];
    for (int k = 0; k < 3; k++) {
        fixed total = 0;
        double spread = 0;
        for (uint32_t r = 0; r < KILN_REPLICATES; r++) total += f->pixels[pixel].sum[r][k];
        mean[k] = n ? fixed_to_double(total) / n : 0;
        for (uint32_t r = 0; r < KILN_REPLICATES; r++) {
            uint32_t own = (n + KILN_REPLICATES - 1 - r) / KILN_REPLICATES;
            double m = own ? fixed_to_double(f->pixels[pixel].sum[r][k]) / own : 0;
            spread += (m - mean[k]) * (m - mean[k]);
        }
        variance[k] = n >= KILN_REPLICATES ? spread / (KILN_REPLICATES * (KILN_REPLICATES - 1)) : -1;
    }
}

void kiln_film_beauty(const kiln_film *f, float *rgb) {
    double mean[3], variance[3];
    for (size_t i = 0; i < (size_t)f->width * f->height; i++) {
        film_read_pixel(f, i, mean, variance);
        for (size_t k = 0; k < 3; k++) rgb[3 * i + k] = (float)mean[k];
    }
}

/* Of one pixel. */
static void read_aov(const kiln_film *f, kiln_aov aov, size_t pixel, float *values) {
    uint32_t n = f->counts[pixel], hits = f->hits[pixel], over = AOVS_OF_HITS >> aov & 1 ? hits : n;
    switch (aov) {
    case KILN_AOV_SAMPLES: values[0] = (float)n; return;
    case KILN_AOV_ALPHA: values[0] = n ? (float)((double)hits / n) : 0.0f; return;
    case KILN_AOV_OBJECT: values[0] = hits ? (float)film_most(f, FILM_OBJECT, pixel) : 0.0f; return;
    case KILN_AOV_MATERIAL: values[0] = hits ? (float)film_most(f, FILM_MATERIAL, pixel) + 1.0f : 0.0f; return;
    case KILN_AOV_ALBEDO:
    case KILN_AOV_NORMAL:
    case KILN_AOV_DEPTH:
    case KILN_AOV_POSITION:
    case KILN_AOV_UV:
    case KILN_AOV_ERROR:
    case KILN_AOV_COUNT: break;
    }
    for (size_t k = 0, channels = aov_rows[aov].channels; k < channels; k++)
        values[k] = over ? (float)(fixed_to_double(f->aovs[aov][pixel * channels + k]) / over) : 0.0f;
}

bool kiln_film_aov(const kiln_film *f, kiln_aov aov, float *values) {
    if (!(f->desc.aovs & 1u << aov)) return false;
    size_t pixels = (size_t)f->width * f->height, channels = aov_rows[aov].channels;
    if (aov == KILN_AOV_ERROR) film_error_map(f, values);
    else
        for (size_t i = 0; i < pixels; i++) read_aov(f, aov, i, values + i * channels);
    return true;
}

uint64_t kiln_film_samples(const kiln_film *f) {
    uint64_t sum = 0;
    for (size_t i = 0; i < (size_t)f->width * f->height; i++) sum += f->counts[i];
    return sum;
}

uint32_t kiln_film_spp(const kiln_film *f) {
    uint32_t least = UINT32_MAX;
    for (size_t i = 0; i < (size_t)f->width * f->height; i++) least = f->counts[i] < least ? f->counts[i] : least;
    return least;
}

size_t kiln_film_bytes(const kiln_film *f) { return (size_t)kiln_film_size(&f->desc); }
