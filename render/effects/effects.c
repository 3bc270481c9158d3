/* render/effects/effects.c: the table of effects as data, and plans. */
#include "render/effects/plan.h"

#include <string.h>

#include "render/bsdf/types.h"

enum { FREE, HELD, GOES = 0, STAYS };

static const kiln_effect_facts rows[KILN_EFFECT_COUNT] = {
#define ROW(id, name, terms, held, stays, called, stages, embree, samples)                                             \
    {name, called, stages, #terms, embree, samples, held == HELD, stays == GOES},
    KILN_EFFECTS(ROW)
#undef ROW
};

static const unsigned terms[KILN_EFFECT_COUNT] = {
#define TERMS(id, name, terms, held, stays, called, stages, embree, samples) terms,
    KILN_EFFECTS(TERMS)
#undef TERMS
};

_Static_assert(KILN_EFFECT_COUNT <= 64, "a bit for each effect");

kiln_effect_facts kiln_effect_describe(kiln_effect effect) {
    kiln_effect_facts facts = rows[effect];
    if (!terms[effect]) facts.terms = "";
    return facts;
}

bool kiln_effect_find(const char *name, kiln_effect *effect) {
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) {
        *effect = (kiln_effect)e;
        if (strcmp(name, rows[e].name) == 0) return true;
    }
    return false;
}

unsigned effects_terms(uint64_t effects) {
    unsigned sum = 0;
    for (int e = 0; e < KILN_EFFECT_COUNT; e++)
        if (effects >> e & 1) sum |= terms[e];
    return sum;
}

void plan_call(kiln_effect_plan *p, uint64_t effects, kiln_effect_caller by) {
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) {
        if (!(effects >> e & 1)) continue;
        kiln_effect_use *use = &p->uses[e];
        if (use->caller_count < KILN_EFFECT_CALLERS) use->callers[use->caller_count] = by;
        use->caller_count++;
        use->called = true;
    }
}

void plan_dismiss(kiln_effect_plan *p, kiln_effect effect) {
    p->uses[effect] = (kiln_effect_use){0};
    plan_settle(p);
}

/* What happens within solids needs to know of them. */
static uint64_t with_solids(uint64_t effects) {
    uint64_t within = EFFECT(NESTED_MEDIA) | EFFECT(ABSORPTION) | EFFECT(SCATTERING) | EFFECT(DISPERSION);
    return effects & within ? effects | EFFECT(SOLIDS) : effects;
}

void plan_settle(kiln_effect_plan *p) {
    p->called = 0;
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) p->called |= (uint64_t)p->uses[e].called << e;
    p->held = with_solids(p->called | p->asked.forced);
    p->runs = with_solids(p->held | effects_imposed(&p->asked));
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) p->uses[e].runs = p->runs >> e & 1;
}

uint64_t effects_imposed(const kiln_effects *asked) {
    uint64_t imposed = asked->forced;
    for (int e = 0; e < KILN_EFFECT_COUNT; e++)
        if (asked->all && !rows[e].held) imposed |= KILN_EFFECT_BIT(e);
    return imposed;
}

uint64_t effects_removed(const kiln_effects *asked) {
    uint64_t removed = asked->removed;
    for (int e = 0; e < KILN_EFFECT_COUNT; e++)
        if (!rows[e].removable) removed &= ~KILN_EFFECT_BIT(e);
    return removed;
}
