#include "render/path/parts.h"

#include <string.h>

void parts_begin(const path_parts_plan *plan, path_parts *p, uint32_t slots) {
    memset(p->last, 0, slots * sizeof *p->last);
    memset(p->sums, 0, (size_t)slots * plan->count * sizeof *p->sums);
}

/* What the film will refuse as a whole is nothing here. */
static fixed value_of(float radiance) { return fixed_fits(radiance) ? fixed_from_float(radiance) : 0; }

/* share in [0, 1], of a value that fits. */
static fixed scaled(fixed value, float share) {
    return fixed_from_float((float)(fixed_to_double(value) * (double)share));
}

static float channel(vec3 v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

static void add(fixed (*sums)[3], uint8_t part, int k, fixed value) {
    if (part != PART_NONE) sums[part][k] += value;
}

/* The largest share takes what rounding leaves of the others. */
static void share_out(const path_parts_plan *plan, fixed (*sums)[3], int k, fixed value, const bsdf_parts *shares) {
    int largest = KILN_LOBE_EMISSION;
    fixed left = value;
    for (int l = 0; l < KILN_LOBE_COUNT; l++)
        if (channel(shares->of[l], k) > channel(shares->of[largest], k)) largest = l;
    for (int l = 0; l < KILN_LOBE_COUNT; l++) {
        float share = channel(shares->of[l], k);
        if (l == largest || !(share > 0.0f)) continue;
        fixed own = scaled(value, share);
        add(sums, plan->lobe[l], k, own);
        left -= own;
    }
    add(sums, plan->lobe[largest], k, left);
}

void parts_record(const path_parts_plan *plan, path_parts *p, uint32_t slot, vec3 radiance, path_bounce bounce,
                  uint8_t group, const bsdf_parts *shares) {
    fixed(*sums)[3] = p->sums + (size_t)slot * plan->count;
    for (int k = 0; k < 3; k++) {
        fixed now = value_of(channel(radiance, k)), value = now - p->last[slot][k];
        if (!value) continue;
        p->last[slot][k] = now;
        add(sums, group, k, value);
        add(sums, plan->bounce[bounce], k, value);
        if (bounce != BOUNCE_EMISSION) share_out(plan, sums, k, value, shares); /* emission: one part for both */
    }
}
