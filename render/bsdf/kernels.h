/* render/bsdf/kernels.h: the instances of the shading kernels.
 *
 * Each is compiled with its terms as a constant mask, so that what it lacks costs nothing; a material goes to the first
 * that has all it needs. Once a row is transmissive all that follow are. What each of them saves and costs:
 * docs/estimator.md and docs/effects.md. */
#ifndef KILN_RENDER_BSDF_KERNELS_H
#define KILN_RENDER_BSDF_KERNELS_H

#include "render/bsdf/types.h"

#define BSDF_KERNELS(X)                                                                                                \
    X(DIFFUSE, 0)                                                                                                      \
    X(GLOSSY, BSDF_GLOSSY)                                                                                             \
    X(COATED, BSDF_GLOSSY | BSDF_CLEARCOAT | BSDF_ANISOTROPIC)                                                         \
    X(TRANSMISSIVE, BSDF_GLOSSY | BSDF_TRANSMISSIVE)                                                                   \
    X(LAYERED, BSDF_GLOSSY | BSDF_TRANSMISSIVE | (BSDF_LAYERED & ~BSDF_FILM))                                          \
    X(FILMED, BSDF_GLOSSY | BSDF_TRANSMISSIVE | BSDF_LAYERED)

/* Which of them shades a point; KIND_MEDIUM: none, it lies in a medium that scatters. */
typedef enum material_kind {
#define KERNEL_KIND(name, terms) KIND_##name,
    BSDF_KERNELS(KERNEL_KIND)
#undef KERNEL_KIND
        KIND_MEDIUM,
    KIND_COUNT
} material_kind;

enum {
#define KERNEL_MASK(name, terms) SHADING_MASK_##name = (terms),
    BSDF_KERNELS(KERNEL_MASK)
#undef KERNEL_MASK
};

static inline unsigned kernel_mask(material_kind kind) {
    static const unsigned masks[KIND_COUNT] = {
#define KERNEL_ENTRY(name, terms) (terms),
        BSDF_KERNELS(KERNEL_ENTRY)
#undef KERNEL_ENTRY
    };
    return masks[kind];
}

/* The first kernel that has these terms. */
static inline material_kind kernel_for(unsigned terms) {
    int kind = 0;
    while (kind < KIND_MEDIUM - 1 && terms & ~kernel_mask((material_kind)kind)) kind++;
    return (material_kind)kind;
}

#endif
