/* render/film/film.h: the film's sums, for the one renderer that writes them. The reading side is public. */
#ifndef KILN_RENDER_FILM_FILM_H
#define KILN_RENDER_FILM_FILM_H

#include "base/arena.h"
#include "kiln/film.h"
#include "render/film/bounce.h"
#include "render/film/fixed.h"
#include "render/film/ballot.h"
#include "render/sample/sampler.h"

typedef struct film_pixel { fixed sum[KILN_REPLICATES][3]; } film_pixel;

/* What is counted by pixel and key: handles, and ids of names. */
typedef enum film_ballot {
    FILM_OBJECT,
    FILM_MATERIAL,
    FILM_MATTES, /* the first of KILN_MATTE_COUNT */
    FILM_BALLOTS = FILM_MATTES + KILN_MATTE_COUNT
} film_ballot;

/* The names of a matte, as the last render's scene had them. */
typedef struct film_names {
    kiln_arena arena;
    kiln_matte_name *items; /* by handle */
    uint32_t count;
} film_names;

/* A part of the beauty, in the order in which they add up: emission first, for it is in two divisions. */
typedef struct film_part {
    const char *name;      /* as the film was asked for it, but for emission under its shorter name */
    uint32_t divisions;    /* bits of kiln_division */
    uint32_t lobe, bounce; /* KILN_LOBE_COUNT, PATH_BOUNCES: neither */
    const char *light;     /* group of light; NULL: none */
    fixed (*sums)[3];
} film_part;

typedef struct film_parts {
    kiln_arena arena; /* of the names */
    film_part *items;
    uint32_t count;
    bool every_light; /* all groups of light of the last render's scene are here */
} film_parts;

struct kiln_film {
    kiln_film_desc desc;      /* crop filled in */
    uint32_t width, height;   /* of the crop */
    film_pixel *pixels;       /* row by row, as everything below */
    uint32_t *counts;         /* samples so far: sample n of a pixel belongs to replicate n mod KILN_REPLICATES */
    uint32_t *hits;           /* those whose camera ray met a surface */
    fixed *aovs[KILN_AOV_COUNT]; /* sums, channels interleaved; NULL: not held, or not a sum */
    ballot *ballots[FILM_BALLOTS]; /* NULL: not held */
    film_names names[KILN_MATTE_COUNT];
    film_parts parts;
    fixed beyond[3];          /* radiance that probes found beyond the depth limit, all pixels */
};

/* What samples bring values of, beside radiance. */
#define FILM_SUMMED_AOVS                                                                                               \
    (1u << KILN_AOV_ALBEDO | 1u << KILN_AOV_NORMAL | 1u << KILN_AOV_DEPTH | 1u << KILN_AOV_POSITION | 1u << KILN_AOV_UV)

/* What one sample brings. */
typedef struct film_sample {
    float radiance[3];
    float alpha, depth, albedo[3], normal[3], position[3], uv[2];
    uint32_t object, material; /* handles */
    const fixed (*parts)[3];   /* shares of the radiance, by part; NULL: none */
} film_sample;

/* Adds the next sample of a pixel (coordinates within the crop). Values fit. Threads may add to different pixels at the
 * same time. */
void film_add(kiln_film *, uint32_t x, uint32_t y, const film_sample *);

/* mattes.c. Before a film that holds a matte is rendered into: the names of all handles from 0 on, copied. */
bool film_set_names(kiln_film *, kiln_matte, const char *const *names, uint32_t count, kiln_report *);
bool film_allocate_ballots(kiln_film *);
void film_free_ballots(kiln_film *);
uint64_t film_ballot_bytes(const kiln_film_desc *); /* of a pixel */
void film_count(kiln_film *, size_t pixel, const film_sample *);
/* The handle that most samples met. */
uint32_t film_most(const kiln_film *, film_ballot, size_t pixel);

/* parts.c: names become parts; false: reported. */
bool film_make_parts(kiln_film *, const kiln_film_desc *, kiln_report *);
bool film_allocate_parts(kiln_film *);
void film_free_parts(kiln_film *);
/* An upper bound where a name is given twice. */
uint64_t film_part_bytes(const kiln_film_desc *);

/* Mean radiance, and the variance of that mean as the replicates show it; variance < 0: unknown. */
void film_read_pixel(const kiln_film *, size_t pixel, double mean[3], double variance[3]);

/* Relative variance of every pixel's mean, as the estimate of the error pools it, pixels without a surface included; 0 of
 * pixels that say nothing yet. */
void film_relative_errors(const kiln_film *, double scale, float *values);

/* Standard error by pixel, from its neighbourhood's replicates. */
void film_error_map(const kiln_film *, float *values);

#endif
