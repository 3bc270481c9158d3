/* kiln/film.h: the Film: what a render has summed so far.
 *
 * Sums are 128-bit fixed point, so that no order or grouping of samples can change a bit. They are kept in
 * KILN_REPLICATES independently scrambled replicates, from which the error is estimated. A film can be rendered
 * into again: samples that it already holds are not repeated. */
#ifndef KILN_FILM_H
#define KILN_FILM_H

#include "kiln/api.h"
#include "kiln/report.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One kiln_render at a time writes a film, and nobody may read it meanwhile; else any number of threads may read. */
typedef struct kiln_film kiln_film;

/* What a film can hold beside the beauty: bit, name (option, EXR layer), channels, what it is. */
#define KILN_AOVS(X)                                                                                                   \
    X(ALPHA, "alpha", 1, "coverage: 0 where the camera sees nothing but the background")                               \
    X(ALBEDO, "albedo", 3, "directional albedo of the first surface, in the working space")                            \
    X(NORMAL, "normal", 3, "shading normal of the first surface, world space")                                         \
    X(DEPTH, "depth", 1, "metres along the camera's axis to the first surface, averaged over the samples that hit")    \
    X(POSITION, "position", 3, "of the first surface in the scene, metres, averaged over the samples that hit")        \
    X(UV, "uv", 2, "first UV set at the first surface, averaged over the samples that hit")                            \
    X(OBJECT, "object", 1, "the instance that fills most of the pixel, by its handle: 1, 2, ...; 0: none")             \
    X(MATERIAL, "material", 1, "the material that fills most of the pixel, 1 + its handle: 1 is the default; 0: none") \
    X(SAMPLES, "samples", 1, "samples taken in the pixel")                                                             \
    X(ERROR, "error", 1, "estimated standard error of the pixel, root of the mean over the channels")

typedef enum kiln_aov {
#define KILN_AOV_INDEX(id, name, channels, text) KILN_AOV_##id,
    KILN_AOVS(KILN_AOV_INDEX)
#undef KILN_AOV_INDEX
        KILN_AOV_COUNT
} kiln_aov;

/* Coverage by name, after the Cryptomatte specification 1.2 (Psyop): identifier, option, EXR layer, what has a name.
 * Equal names are one matte, so that names tell what belongs together, and no matte changes when something is added to
 * the scene. What has no name is "object 7" or "material 7", by its handle. */
#define KILN_MATTES(X)                                                                                                 \
    X(OBJECT, "object", "cryptoObject", "the instance")                                                                \
    X(MATERIAL, "material", "cryptoMaterial", "the material")                                                          \
    X(ASSET, "asset", "cryptoAsset", "what the instance is a part of: in glTF, the node at the root above it")

typedef enum kiln_matte {
#define KILN_MATTE_INDEX(id, name, layer, text) KILN_MATTE_##id,
    KILN_MATTES(KILN_MATTE_INDEX)
#undef KILN_MATTE_INDEX
        KILN_MATTE_COUNT
} kiln_matte;

/* That a pixel tells apart. Where more meet, those that fill more than an eighth of it are there; of the others some
 * stand for the rest. */
enum { KILN_MATTE_RANKS = 8 };

/* Parts of the beauty. Three divisions share it out, each completely: what is asked for of one and what that leaves,
 * its rest, sum to the beauty, as integers in the film and as floats in any order (kiln_film_part). Names of parts:
 *
 *     emission direct indirect   what the camera sees shine; light that reached the first surface straight from where
 *                                it was sent out; light that was scattered more than once
 *     lobe:NAME                  what the first surface did with the light: NAME of KILN_LOBES
 *     lightgroup:NAME            where the light comes from: NAME of kiln_scene_light_groups
 *
 * emission and lobe:emission are one and the same part. */
#define KILN_LOBES(X)                                                                                                  \
    X(EMISSION, "emission", "light that reaches the camera without being scattered: emitters and the background")      \
    X(DIFFUSE, "diffuse", "the base under its coats")                                                                  \
    X(CLEARCOAT, "clearcoat", "reflection of a clear coat")                                                            \
    X(SHEEN, "sheen", "the sheen of cloth")                                                                            \
    X(TRANSLUCENCY, "translucency", "diffuse transmission")                                                            \
    X(SPECULAR, "specular", "reflection of metal and dielectric, multiple scattering between microfacets included")    \
    X(TRANSMISSION, "transmission", "refraction, and what passes through a thin wall")

typedef enum kiln_lobe {
#define KILN_LOBE_INDEX(id, name, text) KILN_LOBE_##id,
    KILN_LOBES(KILN_LOBE_INDEX)
#undef KILN_LOBE_INDEX
        KILN_LOBE_COUNT
} kiln_lobe;

/* KILN_LOBE_COUNT names, as they stand behind "lobe:". */
KILN_API const char *const *kiln_lobe_names(void);

typedef enum kiln_division {
    KILN_DIVISION_BOUNCE,
    KILN_DIVISION_LOBE,
    KILN_DIVISION_LIGHT,
    KILN_DIVISION_COUNT
} kiln_division;

enum { KILN_LIGHT_GROUPS_MAX = 64 }; /* parts of KILN_DIVISION_LIGHT that a film can hold */

typedef struct kiln_film_desc {
    uint32_t width, height;     /* of the whole picture, 1 … 65,536 */
    uint32_t crop[4];           /* x0, y0, x1, y1, right and bottom exclusive; all zero: the whole picture */
    uint32_t aovs;              /* bits 1 << kiln_aov */
    uint32_t mattes;            /* bits 1 << kiln_matte */
    const char *const *parts;   /* names of parts; copied. The same name twice is one part */
    uint32_t part_count;
    uint32_t threads;           /* that may estimate the error; 0: every core that the process may use */
} kiln_film_desc;

/* Memory that such a film takes. */
KILN_API uint64_t kiln_film_size(const kiln_film_desc *);

/* An empty film. On failure *film is NULL: sizes or crop out of range, an AOV or part that does not exist, no memory.
 * Whether a scene has a group of light shows when it is rendered. */
KILN_API bool kiln_film_create(const kiln_film_desc *, kiln_film **film, kiln_report *);
KILN_API void kiln_film_destroy(kiln_film *); /* NULL: nothing happens */
/* crop always filled in; parts are borrowed from the film */
KILN_API kiln_film_desc kiln_film_describe(const kiln_film *);

/* The means so far, as floats: (x1 − x0) × (y1 − y0) × channels, rows from the top, into the caller's array. Beauty is
 * radiance in cd/m² per channel, in the working space of the renderer's decoding; 0 where there are no samples yet. */
KILN_API void kiln_film_beauty(const kiln_film *, float *rgb);
KILN_API bool kiln_film_aov(const kiln_film *, kiln_aov, float *values); /* false: the film does not hold it */
/* The same picture from one half of the samples, the even or the odd ones (0, 1), which know nothing of each other: what
 * both say is no noise. False before every pixel has one of them. */
KILN_API bool kiln_film_half(const kiln_film *, uint32_t half, float *rgb);

/* The parts that the film holds, then the rests of divisions that are not there completely. */
typedef struct kiln_film_part_info {
    const char *name;  /* "lobe:diffuse"; of a rest "lobe:*" and the like. Borrowed from the film */
    uint32_t divisions; /* bits 1 << kiln_division that it belongs to */
    bool rest;
} kiln_film_part_info;
KILN_API uint32_t kiln_film_part_count(const kiln_film *); /* whether all groups of light are here shows in a render */
KILN_API kiln_film_part_info kiln_film_describe_part(const kiln_film *, uint32_t index);

/* Three floats a pixel. Each is a whole multiple of the last digit of the beauty's float, to which means are rounded so
 * that the parts of a division sum to kiln_film_beauty exactly, in floats, in any order: no partial sum has to be
 * rounded. A part is off by at most that one digit, 2^-24 of the beauty. */
KILN_API void kiln_film_part(const kiln_film *, uint32_t index, float *rgb);

/* Pairs of an id and the share of the pixel's samples that met it, by falling share: KILN_MATTE_RANKS × 2 floats a
 * pixel, 0 and 0 where nothing is left. The shares of a pixel sum to its alpha. false: the film does not hold it. */
KILN_API bool kiln_film_matte(const kiln_film *, kiln_matte, float *values);

typedef struct kiln_matte_name {
    const char *name; /* borrowed until the film is rendered into again or destroyed */
    uint32_t id;      /* the bits of the float that stands for it in the pixels */
} kiln_matte_name;
/* The names that occur in the pixels, by rising id; free(). NULL: the film does not hold it, or no memory is left. */
KILN_API kiln_matte_name *kiln_film_matte_names(const kiln_film *, kiln_matte, uint32_t *count);
/* The id of a name. */
KILN_API uint32_t kiln_matte_id(const char *name);

/* What the film knows of its own accuracy (docs/estimator.md). Pixels count where the camera sees a surface, so that an
 * empty background does not make a picture look better; all of them when it sees none. */
typedef struct kiln_film_error {
    bool known;            /* false before every replicate of every pixel has a sample, or when memory is exhausted */
    double relmse;         /* mean over pixels and channels of variance / (ref² + 0.01) */
    double relmse_trimmed; /* without the share of the worst 1 % of the pixels */
    double relmse_low, relmse_high; /* 95 % interval of the true relMSE at this number of samples */
    bool heavy_tail;       /* the worst 1 % hold most of the error: more of it is likely to be unseen as yet */
} kiln_film_error;
/* scale multiplies the picture first (2^exposure): the 0.01 is a matter of what is seen. */
KILN_API kiln_film_error kiln_film_estimate_error(const kiln_film *, double scale);

KILN_API uint64_t kiln_film_samples(const kiln_film *);      /* in all pixels together */
KILN_API uint32_t kiln_film_spp(const kiln_film *);          /* samples in every pixel, finished passes alone */
KILN_API size_t kiln_film_bytes(const kiln_film *);          /* memory of the sums */

#ifdef __cplusplus
}
#endif
#endif
