/* tests/render/bsdf_cases.h: every kind of material that the BSDF knows, one row each, and how it is asked. */
#ifndef KILN_TESTS_RENDER_BSDF_CASES_H
#define KILN_TESTS_RENDER_BSDF_CASES_H

#include <stdbool.h>
#include <stddef.h>

#include "render/bsdf/bsdf.h"

/* A material, and the side that it is seen from. */
typedef struct bsdf_case {
    const char *name;
    unsigned mask;
    float metallic, specular, ior /* 0: infinite */, transmission;
    bool thin, inside;
    bool white; /* nothing is absorbed: what comes in goes out */
    vec3 base, specular_color;
    /* Layers. */
    float clearcoat, clearcoat_roughness, clearcoat_tilt; /* tilt: of its normal, radians */
    vec3 sheen;
    float sheen_roughness;
    float anisotropy;
    float film, film_ior, film_thickness;
    float pass; /* diffuse transmission */
    vec3 pass_color;
    float off_white; /* what compensation may miss, beside what tables do */
    int samples; /* that test_bsdf.c draws, where a lobe hides among what is lost; 0: as many as of others */
    float most_moment; /* that E[m²]/E[m]² of a multiplier may have, where it is more than of others: test_bsdf.c */
} bsdf_case;

extern const bsdf_case bsdf_cases[];
extern const size_t bsdf_case_count;

/* A case for every lobe, by name: a lobe without one does not link. */
#define BSDF_CASE_OF_LOBE(id, text) extern const char *const bsdf_case_of_##id;
BSDF_LOBES(BSDF_CASE_OF_LOBE)
#undef BSDF_CASE_OF_LOBE

typedef struct subject {
    const bsdf_case *row;
    surface surface;
} subject;
void subject_make(subject *, const bsdf_case *);

/* A subject of some roughness, seen from wo (local frame, wo.z > 0). It is asked with a constant mask, as the renderer
 * does. */
typedef struct probe {
    unsigned mask;
    surface surface;
    bsdf bsdf;
} probe;

probe probe_make(const subject *, float roughness, vec3 wo);
/* The same surface seen from wi, in the local frame of wi's side; below the surface z is turned over. */
probe probe_reverse(const probe *, vec3 wi);
bsdf_value probe_evaluate(const probe *, vec3 wi);
bsdf_sampled probe_sample(const probe *, float lobe, vec2 direction);
vec3 probe_albedo(const probe *);

/* The narrowest lobe that has a density: its alpha; 1 where there is none. */
float probe_narrowest(const probe *);

/* Radiance that crosses into the far side is squeezed by this: η² for a solid, else 1. */
static inline double probe_squeeze(const probe *p) {
    return p->mask & BSDF_TRANSMISSIVE && p->surface.thin < 0.5f ? (double)p->surface.eta * (double)p->surface.eta : 1;
}
/* wo at cos θ and an azimuth in turns. */
vec3 direction_at(double cosine, double turns);

#endif
