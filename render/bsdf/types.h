/* render/bsdf/types.h: what a BSDF is made of, and what is kept of it for a point and its wo. Local frame: z is the
 * shading normal on wo's side, x the direction of greater roughness; directions point away from the surface. */
#ifndef KILN_RENDER_BSDF_TYPES_H
#define KILN_RENDER_BSDF_TYPES_H

#include "render/bsdf/anisotropy.h"
#include "render/bsdf/frame.h"
#include "render/bsdf/lobes/ggx.h"
#include "render/bsdf/lobes/grazing.h"

/* The lobes that sampling chooses among (bsdf.h). */
#define BSDF_LOBES(X)                                                                                                  \
    X(DIFFUSE, "cosine on wo's side")                                                                                  \
    X(BELOW, "cosine on the far side")                                                                                 \
    X(REFLECTION, "GGX reflection")                                                                                    \
    X(TRANSMISSION, "GGX refraction")                                                                                  \
    X(CLEARCOAT, "GGX reflection of a clear coat")                                                                     \
    X(SHEEN, "Charlie")                                                                                                \
    X(GRAZING, "what microfacets reflect more than once, either side")

/* What can occur: a constant at every call, so that what it excludes costs nothing. */
enum {
    BSDF_GLOSSY = 1 << 0,       /* REFLECTION */
    BSDF_TRANSMISSIVE = 1 << 1, /* TRANSMISSION and BELOW too; implies GLOSSY */
    BSDF_CLEARCOAT = 1 << 2,    /* CLEARCOAT */
    BSDF_ANISOTROPIC = 1 << 3,  /* two alphas */
    BSDF_SHEEN = 1 << 4,        /* SHEEN */
    BSDF_TRANSLUCENT = 1 << 5,  /* diffuse transmission; implies TRANSMISSIVE */
    BSDF_FILM = 1 << 6,         /* thin films */
    BSDF_COVERED = BSDF_CLEARCOAT | BSDF_SHEEN | BSDF_FILM, /* light passes something on its way to the base */
    BSDF_LAYERED = BSDF_COVERED | BSDF_ANISOTROPIC | BSDF_TRANSLUCENT /* any of them implies GLOSSY */
};

/* Under a mean that is a divisor: 0 only where what it divides is 0 too. The least mean loss of a surface that is no
 * mirror is some 10⁻⁷. */
#define BSDF_LEAST_MEAN 1e-20f

/* What the material says at a point. */
typedef struct surface {
    vec3 base;
    float metallic, roughness;
    float specular; /* the coat's F90 */
    vec3 specular_color;
    float f0;             /* ((n − 1)/(n + 1))² */
    float transmission;
    vec3 through;         /* what the interface lets through is tinted by it: base, or that of one wavelength */
    float eta;            /* n of the far side over n of wo's side; thin wall: of the wall over the air */
    float thin;           /* 1: an infinitely thin wall, 0: the boundary of a solid */
    /* LAYERED, each as its bit says */
    float near, far;      /* 1: clearcoat, sheen and film lie on wo's side, on the far side; else 0 */
    float anisotropy;     /* strength */
    vec3 along;           /* direction of greater roughness, of unit length, at a right angle to the normal; render space */
    float film, film_ior, film_thickness; /* share; index; nanometres */
    float clearcoat, clearcoat_roughness;
    vec3 clearcoat_normal; /* unit length, on wo's side; in render space until shading_make */
    vec3 sheen;
    float sheen_roughness;
    float diffuse_transmission;
    vec3 diffuse_transmission_color;
} surface;

/* A clear coat as wo sees it. */
typedef struct bsdf_clearcoat {
    float near, far; /* its share on wo's side and on the far side: what it takes from what it covers */
    float gloss;     /* its share in what it reflects: near, but where parts of the picture leave it out */
    float alpha;
    albedo_node roughness;
    frame frame;     /* around its own normal */
    vec3 wo;         /* in it */
    float through;   /* what it lets through on wo's side */
} bsdf_clearcoat;

typedef struct bsdf_sheen {
    vec3 color;      /* on wo's side */
    float near, far; /* its largest channel there and on the far side */
    float roughness;
    albedo_node node; /* of albedo_sheen */
    float through;
} bsdf_sheen;

typedef struct bsdf_film {
    float share, ior, thickness;
    float outside_eta; /* wo's side lies within the solid: n outside over n there; else 0 */
    vec3 metal_f0;
    float metal, dielectric; /* how much of each it lies on */
} bsdf_film;

/* Everything about a point and its wo that sampling and evaluation share. */
typedef struct bsdf {
    vec3 wo;
    vec2 alphas;                    /* along x and y; x is the larger */
    float alpha;                    /* that tables are asked for */
    albedo_node roughness;
    anisotropy_node brushed;        /* read under BSDF_ANISOTROPIC */
    float from_inside;              /* what anisotropy leaves of the loss of an interface whose far side is the thinner one */
    vec3 diffuse;                   /* base · what its coat lets in at wo / the mean of that */
    vec3 metal_again;               /* multiple scattering of the metal, but for its factor at wi */
    vec3 f0;                        /* the dielectric's, at normal incidence */
    float f90;
    vec3 reflect0, reflect1;        /* REFLECTION's F: reflect0 + reflect1 (1 − c)^5 + interface · exact */
    float interface;                /* (1 − m) t */
    vec3 tint;                      /* interface · through: TRANSMISSION's F is tint (1 − exact) */
    float eta, thin;
    float again_near, again_far;    /* multiple scattering of the interface, but for its factors at wi */
    albedo_node near_ior, far_ior;  /* of albedo_interface, seen from wo's side and from the far side */
    vec3 wide;                      /* albedo of DIFFUSE and BELOW together */
    float p_diffuse, p_below, p_glossy; /* selection probabilities, glossy: REFLECTION and TRANSMISSION; sum 1, or all 0 */
    float p_straight;               /* of glossy, what passes straight on where that is a delta */
    float p_grazing, p_grazing_below; /* how much of p_diffuse and of p_below goes by GRAZING's density instead */
    grazing_lobe grazing;
    /* LAYERED */
    vec3 passes;                    /* diffuse transmission, but for its factor at wi */
    bsdf_film film;
    bsdf_clearcoat clearcoat;
    bsdf_sheen sheen;
    float p_clearcoat, p_sheen;
} bsdf;

KERNEL int bsdf_is_mirror(float alpha) { return alpha < GGX_ALPHA_MIN; }
/* Refraction spreads less than reflection, and its half vector resolves less: by |η − 1| over the larger index. The same
 * from either side. */
KERNEL float bsdf_transmission_alpha(const bsdf *b) {
    float spread = fabsf(b->eta - 1.0f) / fm_max(b->eta, 1.0f);
    return b->alphas.x * (b->thin > 0.5f ? 1.0f : spread);
}
KERNEL int bsdf_is_straight(const bsdf *b) { return bsdf_transmission_alpha(b) < GGX_ALPHA_MIN; }

KERNEL float average(vec3 v) { return (v.x + v.y + v.z) * (1.0f / 3.0f); }
KERNEL vec3 complement(vec3 v) { return v3_sub(v3_splat(1.0f), v); }

#endif
