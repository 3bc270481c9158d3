/* render/effects/plan.h: which effects a scene is rendered with. The scan (scan.h) says who calls for what; settling
 * decides what is held in memory and what runs, and nobody else decides. */
#ifndef KILN_RENDER_EFFECTS_PLAN_H
#define KILN_RENDER_EFFECTS_PLAN_H

#include "kiln/effects.h"

/* Sets of effects: EFFECT(ALPHA) | EFFECT(SHEEN); HAS(set, ALPHA). */
#define EFFECT(id) KILN_EFFECT_BIT(KILN_EFFECT_##id)
#define HAS(effects, id) (((effects) >> KILN_EFFECT_##id & 1) != 0)

/* Those that are imposed on a scene, whether it calls for them or not. */
uint64_t effects_imposed(const kiln_effects *);

/* Terms of the BSDF that a set of effects needs. */
unsigned effects_terms(uint64_t effects);

/* Those to be removed that can be. */
uint64_t effects_removed(const kiln_effects *);

/* Somebody calls for these; nobody does any more. */
void plan_call(kiln_effect_plan *, uint64_t effects, kiln_effect_caller);
void plan_dismiss(kiln_effect_plan *, kiln_effect);

/* From who called and what was asked to what is held and what runs. */
void plan_settle(kiln_effect_plan *);

#endif
