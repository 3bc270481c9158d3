/* kiln/render.h: a committed Scene becomes a Film. */
#ifndef KILN_RENDER_H
#define KILN_RENDER_H

#include "kiln/api.h"
#include "kiln/effects.h"
#include "kiln/film.h"
#include "kiln/report.h"
#include "kiln/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is built once for a scene: acceleration structure, decoded textures, lights. Immutable: any number of threads
 * may render with it at the same time, each into a film of its own; every kiln_render starts its own threads. */
typedef struct kiln_renderer kiln_renderer;

/* How encoded pictures become working-space values: filled by kiln_color_working_space, or zero for
 * linear Rec.709. One row per kiln_transfer. */
typedef struct kiln_decoding {
    bool present;
    float curve[KILN_TRANSFER_COUNT][256]; /* 8-bit code to linear; 16-bit codes and floats use the piecewise curve
                                              of the transfer itself */
    float matrix[KILN_TRANSFER_COUNT][9];  /* row-major, after the curve: into the working space */
} kiln_decoding;

/* How textures that are seen small are looked up; docs/textures.md has what each costs and errs. */
typedef enum kiln_texture_filter {
    KILN_TEXTURES_BILINEAR, /* between four texels of the picture, at any distance: the pixel's samples filter */
    KILN_TEXTURES_MIP       /* from pyramids, by the footprint of the path: never more than half of it is averaged */
} kiln_texture_filter;

typedef struct kiln_renderer_options {
    uint32_t threads;          /* of building, and of each kiln_render; 0: every core that the process may use */
    const char *embree_config; /* rtcNewDevice's string, "isa=avx2"; NULL: none */
    const kiln_decoding *decoding; /* NULL: linear Rec.709 */
    kiln_texture_filter texture_filter;
    kiln_effects effects; /* beside what the scene calls for */
} kiln_renderer_options;

/* Reads scene, which must be committed, for as long as the renderer lives; the options during the call. On failure
 * *renderer is NULL. Warns of what the scene has and the renderer does not show: motion, maps without tangents. */
KILN_API bool kiln_renderer_create(const kiln_scene *scene, const kiln_renderer_options *, kiln_renderer **,
                                   kiln_report *);
KILN_API void kiln_renderer_destroy(kiln_renderer *); /* NULL: nothing happens */

/* What a renderer of a committed scene would run, and who calls for it. The pictures that it would use are decoded and
 * not kept: every one that would make kiln_renderer_create fail is an error. options NULL: the defaults; what is said of
 * decoding and Embree is not read. camera NULL: the scene's first, if it has one. The plan borrows names from the scene. */
KILN_API bool kiln_plan_effects(const kiln_scene *scene, const kiln_camera *camera, const kiln_renderer_options *options,
                                kiln_effect_plan *plan, kiln_report *);
/* The same of a renderer that exists. */
KILN_API kiln_effect_plan kiln_renderer_describe_effects(const kiln_renderer *, const kiln_camera *camera);

typedef struct kiln_renderer_memory {
    size_t acceleration; /* bytes of the BVH */
    size_t scene;        /* triangles, materials, lights, environment */
    size_t textures;     /* decoded */
} kiln_renderer_memory;
KILN_API kiln_renderer_memory kiln_renderer_describe_memory(const kiln_renderer *);

/* What renders run on here. */
typedef struct kiln_backend {
    char embree[32];  /* version of the library that is loaded */
    const char *isa;  /* instance of the stages: "v3" is x86-64-v3 */
} kiln_backend;
KILN_API kiln_backend kiln_render_backend(void);

typedef enum kiln_estimator {
    KILN_ESTIMATOR_MIS,  /* light and BSDF samples combined by the power heuristic (Veach 1997) */
    KILN_ESTIMATOR_NEE,  /* light samples at every bounce; emission that the BSDF finds counts only at the first hit,
                            after a perfectly specular bounce, or from emitters that no light sample can reach */
    KILN_ESTIMATOR_BSDF, /* emission only by hitting it; punctual lights, which nothing can hit, are still sampled */
    /* Wrong on purpose: what NEE is without its rule for specular bounces. For studies, never for pictures. */
    KILN_ESTIMATOR_NAIVE,  /* emission never counts where a bounce finds it */
    KILN_ESTIMATOR_DOUBLED /* it always counts, beside the light samples */
} kiln_estimator;

typedef enum kiln_roulette_kind {
    KILN_ROULETTE_AUTO,       /* the best policy that we know: docs/estimator.md */
    KILN_ROULETTE_OFF,        /* only the depth limit and black surfaces end a path */
    KILN_ROULETTE_FIXED,      /* survive every bounce with probability p */
    KILN_ROULETTE_THROUGHPUT  /* survive with the largest channel of the throughput, at most 0.99 */
} kiln_roulette_kind;

typedef struct kiln_roulette {
    kiln_roulette_kind kind;
    double p;           /* FIXED: 0 < p ≤ 1 */
    uint32_t min_depth; /* THROUGHPUT: the first bounces are guaranteed and do not enter the survival weights */
} kiln_roulette;

typedef enum kiln_sampler { KILN_SAMPLER_SOBOL, KILN_SAMPLER_INDEPENDENT } kiln_sampler;

/* Which light is sampled at a bounce: a triangle that emits, a punctual light, or the environment. */
typedef enum kiln_light_sampling {
    KILN_LIGHTS_TREE,   /* by what each may do for the point that is lit: where it is, how bright, which way it faces; in
                           scenes of several */
    KILN_LIGHTS_POWER,  /* half of the choices by power; half alike among groups (the triangles of a material, a punctual
                           light, the environment) and by power within one: a small lamp is not starved by a sun */
    KILN_LIGHTS_UNIFORM /* all that emit alike: each triangle is one light */
} kiln_light_sampling;

/* Where samples go: to every pixel alike, or to where they lower the error most. */
typedef enum kiln_adaptive {
    KILN_ADAPTIVE_AUTO, /* ON where noise or budget_seconds is a rule, OFF where spp alone is */
    KILN_ADAPTIVE_OFF,
    KILN_ADAPTIVE_ON    /* after 16 samples in each pixel; spp is the mean over the pixels, none gets more than 16 times
                           the mean. The picture depends on the whole crop, but not on threads */
} kiln_adaptive;

typedef enum kiln_pixel_filter { KILN_PIXEL_BLACKMAN_HARRIS, KILN_PIXEL_GAUSSIAN, KILN_PIXEL_BOX } kiln_pixel_filter;

/* What the camera sees where it meets no surface; alpha is 0 there in any case. Reflections and refractions always see
 * the environment. */
typedef enum kiln_background {
    KILN_BACKGROUND_ENVIRONMENT, /* and suns of a visible size */
    KILN_BACKGROUND_TRANSPARENT, /* black */
    KILN_BACKGROUND_COLOR        /* background_color */
} kiln_background;

typedef struct kiln_progress {
    uint32_t spp_done;   /* samples that every pixel of the film has, or the mean of them where they are adaptive, those
                            included that it came with */
    uint64_t samples;    /* taken since the call began, in all pixels together, unfinished passes included */
    double fraction;     /* of the work that the stop rules leave, 0 … 1; an estimate for noise */
    double seconds, seconds_left; /* since the call began; left < 0: unknown */
    double error;        /* square root of the relMSE, as estimated at the last power of two of samples; < 0: unknown */
} kiln_progress;

/* What the first samples let expect. */
typedef struct kiln_prediction {
    uint32_t spp;         /* of the samples that it is made from */
    double seconds;       /* of the call, until the first of its rules ends it */
    double error;         /* √relMSE that it will have then */
    double noise_seconds; /* until the goal for the noise would be reached, whatever the other rules; < 0: there is none */
} kiln_prediction;

typedef enum kiln_stop { KILN_STOP_SPP, KILN_STOP_NOISE, KILN_STOP_BUDGET, KILN_STOP_CANCELLED } kiln_stop;

/* Zero-initialised options mean the defaults in brackets. */
typedef struct kiln_render_options {
    const kiln_camera *camera;   /* [the scene's first camera] */
    uint32_t spp;                /* [64 when no rule at all is given, else no limit] */
    double noise;                /* target for the square root of the estimated relMSE, 0.01 for 1 % [no target] */
    double error_scale;          /* the picture is multiplied by this before its error is judged: 2^exposure [1] */
    double budget_seconds;       /* [no limit] */
    kiln_adaptive adaptive;      /* [AUTO] */
    uint64_t seed;               /* another seed, another realisation of the noise [0] */
    uint32_t max_depth;          /* scattering events of a path [64]; KILN_DEPTH_ZERO for none */
    kiln_estimator estimator;
    kiln_roulette roulette;
    kiln_sampler sampler;
    kiln_light_sampling light_sampling;
    kiln_pixel_filter filter;
    double filter_width;         /* diameter in pixels, at most 64 [blackman-harris 3, gaussian 3, box 1] */
    kiln_background background;
    float background_color[3];   /* COLOR: radiance in cd/m² per channel, in the working space of the decoding */
    const volatile int *cancel;  /* not 0: stop soon; what was reached stays in the film. Set it from a signal handler,
                                    or from any thread by an atomic store [never] */
    void (*progress)(const kiln_progress *, void *user); /* from the calling thread, about ten times a second */
    void *progress_user;
    void (*predict)(const kiln_prediction *, void *user); /* once, as soon as the error can be told: after 16 samples in
                                    each pixel, with a budget from 4 on. The same thread */
    void *predict_user;
    uint32_t batch_size;         /* for tests: paths that advance together, rounded up to 16s [1024] */
    uint64_t tile_shuffle;       /* for tests: another order of tiles, same bits [none] */
    const char *isa;             /* for tests: "v2", "v3", "v4": which instance of the stages runs, same bits [the best] */
} kiln_render_options;

#define KILN_DEPTH_ZERO UINT32_MAX

/* Samples that lost something, by cause: identifier, machine-readable name. Each of them counts as a sample of its
 * pixel all the same, with the light that is left. */
#define KILN_DISCARDS(X)                                                                                               \
    X(RAY, "invalid-ray") /* a ray that is not finite or has no direction is not traced: what it would have found is   \
                             missing; from the camera, the sample is black, transparent and without AOVs */            \
    X(RADIANCE, "nonfinite-radiance") /* a radiance that is NaN, infinite or negative: the sample is black */          \
    X(OVERFLOW, "film-overflow") /* too large for the film's fixed point: a radiance, and the sample is black, or an   \
                                    AOV, and the sample's AOVs are 0 */

typedef enum kiln_discard {
#define KILN_DISCARD_ENUM(id, name) KILN_DISCARD_##id,
    KILN_DISCARDS(KILN_DISCARD_ENUM)
#undef KILN_DISCARD_ENUM
        KILN_DISCARD_COUNT
} kiln_discard;

/* What threads do while they render: identifier, machine-readable name. In the order of the work. */
#define KILN_STAGES(X)                                                                                                 \
    X(CAMERA, "camera")           /* samples become paths: pixel filter, lens */                                       \
    X(CAMERA_RAYS, "camera rays") /* where they meet a surface; Embree, as the next two */                             \
    X(BOUNCE_RAYS, "bounce rays")                                                                                      \
    X(SHADOW_RAYS, "shadow rays") /* is there anything before the light? */                                            \
    X(TOUCH, "touch")             /* surfaces of solids that coincide */                                               \
    X(FLIGHT, "flight")           /* media that scatter */                                                             \
    X(ESCAPE, "escape")           /* what paths collect that leave the scene */                                        \
    X(SORT, "sort")               /* paths that ended go; the rest close up, by kinds of material */                   \
    X(FETCH, "fetch")             /* triangles are gathered */                                                         \
    X(SURFACE, "surface")         /* hit point, normals, where rays leave from */                                      \
    X(CONE, "cone")               /* footprints for filtered textures */                                               \
    X(MATERIAL, "material")       /* constants, textures */                                                            \
    X(BOUNDARY, "boundary")       /* what lies behind surfaces of solids */                                            \
    X(NORMAL, "normal")           /* mapped normals */                                                                 \
    X(ABSORB, "absorb")           /* media that absorb */                                                              \
    X(AOVS, "aovs")               /* what the first surface is */                                                      \
    X(EMISSION, "emission")       /* light that paths meet */                                                          \
    X(LIMIT, "limit")             /* of depth */                                                                       \
    X(RANDOM, "random")           /* numbers of a bounce */                                                            \
    X(LIGHT, "light")             /* which light, where on it */                                                       \
    X(CONNECT, "connect")         /* what it adds: the BSDF towards it */                                              \
    X(SCATTER, "scatter")         /* the BSDF's direction, roulette */                                                 \
    X(PARTS, "parts")             /* whose light it was, for films that hold parts */                                  \
    X(FILM, "film")               /* samples are added up */

typedef enum kiln_stage {
#define KILN_STAGE_ENUM(id, name) KILN_STAGE_##id,
    KILN_STAGES(KILN_STAGE_ENUM)
#undef KILN_STAGE_ENUM
        KILN_STAGE_COUNT
} kiln_stage;

typedef struct kiln_render_stats {
    kiln_stop stop;
    uint32_t spp;        /* that every pixel has; the mean, rounded down, where samples were adaptive */
    bool adaptive;
    uint32_t spp_least, spp_most;
    double seconds;
    double stage_seconds[KILN_STAGE_COUNT]; /* of all threads together; shares estimated from one batch in seven */
    double waiting_seconds; /* of all threads together: for one another between passes, and estimates of the error */
    uint64_t camera_rays, bounce_rays, shadow_rays;
    uint64_t discarded[KILN_DISCARD_COUNT];
    uint32_t discarded_pixel[KILN_DISCARD_COUNT][2]; /* the first in reading order, where discarded > 0 */
    uint64_t unsampled; /* pixels of the film without a single sample, black: the render ended within its first pass */
    double lost_energy; /* estimated share of the picture's energy that the depth limit cut; < 0: unknown */
    kiln_prediction prediction; /* spp 0: none was made */
} kiln_render_stats;

/* Adds samples to film until a stop rule holds. On failure or cancellation the film keeps what it has. options NULL:
 * the defaults. stats may be NULL.
 *
 * A film that has samples is gone on with: spp counts those too, and pixels get the samples that come next. With the
 * same seed and the same options, but for stop rules, the film ends with the bits that one call would have given. With
 * another seed the mean is as right, but the new samples are not stratified with the old ones. Options that change the
 * picture (camera, depth, filter, background, another scene) are not noticed: the film then holds the mean of both. */
KILN_API bool kiln_render(const kiln_renderer *, const kiln_render_options *, kiln_film *film, kiln_render_stats *stats,
                          kiln_report *);

#ifdef __cplusplus
}
#endif
#endif
