/* importers/subdiv/refine.h: a limit surface takes its cage's place in the scene. */
#ifndef KILN_IMPORTERS_SUBDIV_REFINE_H
#define KILN_IMPORTERS_SUBDIV_REFINE_H

#include "importers/subdiv/osd.h"
#include "scene/scene.h"

/* Refines and replaces mesh id. Threads may refine different meshes at once. */
bool refine_mesh(kiln_scene *, kiln_id, const kiln_cage *, uint32_t level, const kiln_where *, kiln_report *);

#endif
