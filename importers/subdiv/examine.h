/* importers/subdiv/examine.h: whether, how, and how often a mesh is refined. */
#ifndef KILN_IMPORTERS_SUBDIV_EXAMINE_H
#define KILN_IMPORTERS_SUBDIV_EXAMINE_H

#include "importers/subdiv/level.h"
#include "kiln/import.h"

typedef struct mesh_plan {
    kiln_cage cage;
    kiln_arena arena; /* of the cage; empty when the mesh is left alone */
    kiln_subdivision_result *result;
} mesh_plan;

typedef struct examination {
    const kiln_scene *scene;
    const kiln_subdivide_options *options;
    uint64_t triangle_limit;
    view_scale view;
    const mat4 *placements; /* level_largest_instances; NULL without a view */
    kiln_report *report;
} examination;

/* Fills plan->result for mesh id, and plan->cage where result->refined is set. False: an error was added. */
bool examine_mesh(const examination *, kiln_id, mesh_plan *);

#endif
