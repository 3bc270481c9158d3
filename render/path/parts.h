/* render/path/parts.h: which part of the beauty a path's light belongs to, for films that hold parts.
 *
 * After every stage that adds to a path's radiance, what has come to it is handed to parts_record. What is recorded is
 * not the addend but by how much the fixed-point value of the radiance has risen: that telescopes, so that the records
 * of a sample sum to the very integer that the film adds to the beauty, and the beauty does not depend on whether parts
 * are held. Paths that have passed the depth limit are not in the beauty, and record nothing. */
#ifndef KILN_RENDER_PATH_PARTS_H
#define KILN_RENDER_PATH_PARTS_H

#include "render/bsdf/shares.h"
#include "render/film/film.h"
#include "render/path/batch.h"

enum { PART_NONE = 255 };

/* Which part of the film light is added to; PART_NONE: it is in a rest. */
typedef struct path_parts_plan {
    uint32_t count; /* of parts */
    uint8_t lobe[KILN_LOBE_COUNT], bounce[PATH_BOUNCES];
    uint8_t *of_light, *of_material; /* by light.owner */
    uint8_t of_environment;
} path_parts_plan;

/* Of a batch, by slot. */
typedef struct path_parts {
    fixed last[BATCH_PATHS][3];      /* radiance at the last record */
    bsdf_parts shares[BATCH_PATHS]; /* of the direction that the path took at its first surface */
    fixed sums[][3];                 /* plan.count for each slot */
} path_parts;

static inline size_t path_parts_bytes(const path_parts_plan *p) {
    return sizeof(path_parts) + (size_t)BATCH_PATHS * p->count * sizeof(fixed[3]);
}

void parts_begin(const path_parts_plan *, path_parts *, uint32_t slots);

/* radiance: of the path in slot, now. group: a part by the plan, that of the light. shares: not read for
 * BOUNCE_EMISSION. */
void parts_record(const path_parts_plan *, path_parts *, uint32_t slot, vec3 radiance, path_bounce, uint8_t group,
                  const bsdf_parts *shares);

#endif
