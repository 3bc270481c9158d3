/* job/inspect.h: what an asset holds, and what kiln would make of it. */
#ifndef KILN_JOB_INSPECT_H
#define KILN_JOB_INSPECT_H

#include "job/json.h"
#include "job/run.h"

/* Imports, subdivides, lights and commits the run's source; nothing is rendered or written. */
bool inspect(job_run *, json_t **);

/* inspect_nodes.c: transforms are column-major; a node's is relative to its parent, an instance's to the world. */
json_t *inspect_nodes(const kiln_scene *);
json_t *inspect_instances(const kiln_scene *);

/* inspect_material.c */
json_t *inspect_materials(const kiln_scene *);
json_t *inspect_images(const kiln_scene *, uint32_t count, uint64_t *decoded_bytes); /* the first ones */

#endif
