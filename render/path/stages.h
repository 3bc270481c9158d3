/* render/path/stages.h: the stages, in the order in which path.c calls them.
 *
 * Every file that defines one is compiled once per instruction set, with KILN_ISA as the suffix of its names; no stage
 * calls libm, and gcc neither contracts nor reassociates, so all of them give the same bits. */
#ifndef KILN_RENDER_PATH_STAGES_H
#define KILN_RENDER_PATH_STAGES_H

#include "render/effects/plan.h"
#include "render/path/path.h"

#ifndef KILN_ISA
#define KILN_ISA base
#endif
#define STAGE_PASTE(name, isa) path_##name##_##isa
#define STAGE_EXPAND(name, isa) STAGE_PASTE(name, isa)
#define STAGE(name) STAGE_EXPAND(name, KILN_ISA)

void STAGE(trace_samples)(const path_context *, const path_sample *samples, uint32_t count, batch *);

/* Samples become paths with a ray from the lens. */
void STAGE(camera)(const path_context *, const path_sample *samples, uint32_t count, batch *);
/* Where each ray meets a surface first; single-sided surfaces seen from behind by the camera are not there. */
void STAGE(trace)(const path_context *, batch *);
/* Surfaces of solids that coincide become one. */
void STAGE(touch)(const path_context *, batch *);
/* Media that scatter do so somewhere along the ray, or let it reach the surface. */
void STAGE(flight)(const path_context *, batch *);
/* The points at which they do. */
void STAGE(scattering)(const path_context *, batch *);
/* Paths that left the scene collect what shines from all around, and end. */
void STAGE(escape)(const path_context *, batch *);
/* The paths that hit something close up, in ranges of one material kind each. */
void STAGE(sort)(const path_context *, batch *);
/* The triangles that were hit, in render space. */
void STAGE(fetch)(const path_context *, batch *);
/* The hit point, its normals, and how far from the surface rays must start. */
void STAGE(surface)(const path_context *, batch *);
/* Where textures are filtered: the cones of the pixels; what they cover at the hit points; how bounces change them. */
void STAGE(cone_start)(const path_context *, batch *);
void STAGE(cone_hit)(const path_context *, batch *);
void STAGE(cone_scatter)(const path_context *, batch *);
/* The medium around the ray takes its share. */
void STAGE(absorb)(const path_context *, batch *);
/* What the materials say: constants, then textures. */
void STAGE(material)(const path_context *, batch *);
/* What lies behind boundaries of solids, and how they refract. */
void STAGE(boundary)(const path_context *, batch *);
/* The shading normal: mapped, and facing wo. */
void STAGE(normal)(const path_context *, batch *);
/* What the first surface is, and where. */
void STAGE(aovs)(const path_context *, batch *);
/* Light that the surface itself gives off, weighted as the estimator says. */
void STAGE(emission)(const path_context *, batch *);
/* At the depth limit paths end; a few go on to measure what is cut. Did some end? */
bool STAGE(limit)(const path_context *, batch *);
/* The bounce's random numbers. */
void STAGE(random)(const path_context *, batch *);
/* A light for each path, and a point on it. */
void STAGE(light)(const path_context *, batch *);
void STAGE(choose)(const path_context *, batch *);
void STAGE(surroundings)(const path_context *, batch *);
/* What the light sample contributes, if nothing lies between. */
void STAGE(connect)(const path_context *, batch *);
/* The BSDF's direction, and roulette. */
void STAGE(scatter)(const path_context *, batch *);
/* The paths that go on close up. */
void STAGE(close)(const path_context *, batch *);

/* For films that hold parts. What lane i's path has collected by meeting light, which belongs to this part of the
 * plan's; the same after the whole stage `emission`, after the whole of `connect`; before the first `scatter`. */
void STAGE(part_found)(const path_context *, batch *, uint32_t i, uint8_t group);
void STAGE(part_emission)(const path_context *, batch *);
void STAGE(part_light)(const path_context *, batch *);
void STAGE(part_scatter)(const path_context *, batch *);

/* Radiance of a path that ends goes to its slot. */
#define SLOT_BEYOND (1u << 31)    /* the path has passed the depth limit: its radiance is counted apart */
#define SLOT_DISPERSED (1u << 30) /* it has taken on a wavelength: its throughput has the hue */
static inline uint32_t slot_index(uint32_t slot) { return slot & ~(SLOT_BEYOND | SLOT_DISPERSED); }
static inline void batch_flush(batch *b, uint32_t lane) {
    const path_state *s = batch_state(b);
    uint32_t slot = slot_index(s->slot[lane]);
    int beyond = (s->slot[lane] & SLOT_BEYOND) != 0;
    (beyond ? b->out.beyond_r : b->out.r)[slot] = s->lr[lane];
    (beyond ? b->out.beyond_g : b->out.g)[slot] = s->lg[lane];
    (beyond ? b->out.beyond_b : b->out.b)[slot] = s->lb[lane];
}

#endif
