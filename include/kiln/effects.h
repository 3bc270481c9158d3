/* kiln/effects.h: what a scene can call for, what it does call for, and who does.
 *
 * A renderer runs the stages and holds the data of effects that its scene calls for, and no others. What the file says
 * is not asked but what can be seen of it: a clear coat whose factor, or whose texture, is 0 everywhere is none. */
#ifndef KILN_EFFECTS_H
#define KILN_EFFECTS_H

#include "kiln/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Every effect, in the order in which a path meets them:
 *     identifier, name,
 *     terms of the BSDF that its materials need (render/bsdf/types.h),
 *     FREE: --effects all runs its stages and terms; HELD: they would need data or a structure that only scenes which
 *         call for the effect have,
 *     GOES: a scene can be shown without it; STAYS: it cannot,
 *     what calls for it,
 *     what is done for it: stages (render/path), "" for none but those that any scene has,
 *     what of Embree, and which numbers of a sample, it needs; "" for nothing. */
#define KILN_EFFECTS(X)                                                                                                \
    X(THIN_LENS, "thin-lens", 0, FREE, GOES, "a camera whose lens has a radius", "camera: a place on the lens", "",    \
      "LENS")                                                                                                          \
    X(MOTION, "motion", 0, HELD, STAYS, "an instance or a mesh that moves while the shutter is open",                  \
      "none: what moves is shown at its first time sample, with a warning", "", "")                                    \
    X(ALPHA, "alpha", 0, HELD, GOES,                                                                                   \
      "a material that lets a part of its surface be absent: BLEND below 1, MASK below its cutoff somewhere",          \
      "trace, connect: a choice at each triangle that may be absent", "filter functions on those triangles",           \
      "COVERAGE")                                                                                                      \
    X(CULLING, "culling", 0, FREE, GOES, "a single-sided surface", "trace: camera rays go on behind backs", "", "")    \
    X(SMOOTH_NORMALS, "smooth-normals", 0, FREE, GOES, "a mesh with normals of its own",                               \
      "surface: rays leave from the smooth surface that facets stand for", "", "")                                     \
    X(VERTEX_COLORS, "vertex-colors", 0, HELD, GOES, "a mesh with a vertex colour that is not white",                  \
      "material: corners are gathered and interpolated", "", "")                                                       \
    X(TEXTURES, "textures", 0, FREE, GOES, "a parameter multiplied by a picture whose texels differ",                  \
      "material: a look-up for each slot in use", "", "")                                                              \
    X(TEXTURE_FILTERING, "texture-filtering", 0, FREE, GOES,                                                           \
      "--texture-filter mip, and a texture that may be averaged", "cone: what a path covers of a surface", "", "")     \
    X(NORMAL_MAPS, "normal-maps", 0, FREE, GOES, "a normal map of a scale other than 0 that is not flat everywhere",   \
      "material, normal: tangents are gathered, normals bent", "", "")                                                 \
    X(REFLECTION, "reflection", BSDF_GLOSSY, FREE, GOES, "a material with metal, or with a coat of specular above 0",  \
      "scatter, connect: microfacets", "", "")                                                                         \
    X(MIRRORS, "mirrors", 0, HELD, STAYS, "a roughness too small for a density: light samples do not reach it",        \
      "none: a choice within the terms of reflection and transmission", "", "")                                        \
    X(TRANSMISSION, "transmission", BSDF_TRANSMISSIVE, FREE, GOES,                                                     \
      "a material that lets light through, and is not all metal", "scatter, connect: refraction; paths change sides",  \
      "", "")                                                                                                          \
    X(ROUGH_TRANSMISSION, "rough-transmission", 0, HELD, GOES, "one of them with a roughness above that of mirrors",   \
      "none: a choice within the terms of transmission", "", "")                                                       \
    X(DIFFUSE_TRANSMISSION, "diffuse-transmission", BSDF_TRANSLUCENT, FREE, GOES,                                      \
      "a factor above 0 somewhere, on what is neither all metal nor all clear", "scatter, connect", "", "")            \
    X(ANISOTROPY, "anisotropy", BSDF_ANISOTROPIC, FREE, GOES, "a strength above 0 somewhere",                          \
      "material, normal: directions; scatter, connect", "", "")                                                        \
    X(IRIDESCENCE, "iridescence", BSDF_FILM, FREE, GOES, "a factor and a thickness above 0 somewhere",                 \
      "scatter, connect: interference in every Fresnel term", "", "")                                                  \
    X(SHEEN, "sheen", BSDF_SHEEN, FREE, GOES, "a colour that is not black everywhere", "scatter, connect: a lobe",     \
      "", "")                                                                                                          \
    X(CLEARCOAT, "clearcoat", BSDF_CLEARCOAT, FREE, GOES, "a factor above 0 somewhere",                                \
      "normal: a normal of its own; scatter, connect: a lobe", "", "")                                                 \
    X(SOLIDS, "solids", 0, FREE, GOES, "a volume with a thickness that light can enter",                               \
      "boundary: what lies behind surfaces; paths carry a stack of media", "filters given with queries", "")           \
    X(NESTED_MEDIA, "nested-media", 0, FREE, GOES, "solids that touch, overlap or lie in one another",                 \
      "touch: a second query about each hit on a solid", "filters given with queries", "")                             \
    X(ABSORPTION, "absorption", 0, FREE, GOES, "a solid that takes a part of some colour and does not scatter",        \
      "absorb; connect: towards the light", "", "")                                                                    \
    X(SCATTERING, "scattering", 0, FREE, GOES, "a solid that scatters what it takes",                                  \
      "flight, scattering; scatter, connect: the phase function; connect: towards the light", "", "FLIGHT")            \
    X(DISPERSION, "dispersion", 0, HELD, GOES, "a solid of an index above 1 that differs between colours",             \
      "boundary, camera: paths take on a wavelength", "", "WAVELENGTH")                                                \
    X(AREA_LIGHTS, "area-lights", 0, FREE, GOES, "a surface that emits somewhere", "emission; light: triangles", "",   \
      "LIGHT")                                                                                                         \
    X(TEXTURED_LIGHTS, "textured-lights", 0, FREE, STAYS, "one of them that varies over its area or is coated",        \
      "light: look-ups at the place that was sampled", "", "")                                                         \
    X(UNLIT, "unlit", 0, FREE, GOES, "a surface that shows its base colour, which is not black everywhere",            \
      "emission", "", "")                                                                                              \
    X(PUNCTUAL_LIGHTS, "punctual-lights", 0, FREE, GOES, "a point, spot or parallel light that is not black",          \
      "light: points and beams", "", "LIGHT")                                                                          \
    X(SUNS, "suns", 0, HELD, GOES, "a distant light of a visible size that is not black",                              \
      "light: cones; escape: the disk is seen", "", "LIGHT")                                                           \
    X(ENVIRONMENT, "environment", 0, FREE, GOES, "surroundings that are not black everywhere",                         \
      "escape; light: directions", "", "LIGHT")                                                                        \
    X(MANY_LIGHTS, "many-lights", 0, HELD, GOES, "more than one triangle or light to choose from",                     \
      "light: the choice, by a tree; emission, escape: the choice that a ray's finds would have been", "",             \
      "LIGHT, LIGHT_FINE")

typedef enum kiln_effect {
#define KILN_EFFECT_ENUM(id, name, terms, held, stays, called, stages, embree, samples) KILN_EFFECT_##id,
    KILN_EFFECTS(KILN_EFFECT_ENUM)
#undef KILN_EFFECT_ENUM
        KILN_EFFECT_COUNT
} kiln_effect;

#define KILN_EFFECT_BIT(effect) ((uint64_t)1 << (effect))

/* A row of the table, as text; terms: "BSDF_CLEARCOAT", "" for none. Static. */
typedef struct kiln_effect_facts {
    const char *name, *called_for_by, *stages, *terms, *embree, *samples;
    bool held;      /* HELD */
    bool removable; /* kiln_effects.removed may name it */
} kiln_effect_facts;
KILN_API kiln_effect_facts kiln_effect_describe(kiln_effect);
/* False: no effect has this name. */
KILN_API bool kiln_effect_find(const char *name, kiln_effect *);

/* What is to be done about effects beside what the scene calls for; zero-initialised: nothing. Bits of kiln_effect. */
typedef struct kiln_effects {
    uint64_t forced;  /* their machinery runs, data and structures included, though there is nothing for it to do */
    uint64_t removed; /* the scene is taken to be without them; those that are not removable are ignored */
    bool all;         /* the stages and terms of all that is FREE run: the picture has the same bits */
} kiln_effects;

typedef enum kiln_effect_caller_kind {
    KILN_CALLED_BY_MATERIAL,
    KILN_CALLED_BY_MESH,
    KILN_CALLED_BY_INSTANCE,
    KILN_CALLED_BY_LIGHT,
    KILN_CALLED_BY_CAMERA,
    KILN_CALLED_BY_ENVIRONMENT
} kiln_effect_caller_kind;

typedef struct kiln_effect_caller {
    kiln_effect_caller_kind kind;
    kiln_id id;       /* of that kind; 0: the default material, or a camera that is not the scene's */
    const char *name; /* the scene's, or the camera's: borrowed */
} kiln_effect_caller;

enum { KILN_EFFECT_CALLERS = 3 };

typedef struct kiln_effect_use {
    bool called;           /* by the scene, without what was to be removed */
    bool runs;             /* its stages and terms do */
    uint32_t caller_count; /* all of them … */
    kiln_effect_caller callers[KILN_EFFECT_CALLERS]; /* … and the first few, by handle */
    uint64_t bytes;        /* that are held for it, about */
} kiln_effect_use;

typedef struct kiln_effect_plan {
    kiln_effects asked;
    uint64_t called, held, runs; /* bits: by the scene; whose data and structures are built; whose stages run */
    kiln_effect_use uses[KILN_EFFECT_COUNT];
} kiln_effect_plan;

#ifdef __cplusplus
}
#endif
#endif
