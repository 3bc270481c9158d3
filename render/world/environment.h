/* render/world/environment.h: light from all around. */
#ifndef KILN_RENDER_WORLD_ENVIRONMENT_H
#define KILN_RENDER_WORLD_ENVIRONMENT_H

#include "render/world/world.h"

bool environment_build(world *, const kiln_scene *, const kiln_decoding *, kiln_report *);

#endif
