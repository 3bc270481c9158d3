/* render/context.h: the options of a render as the estimator wants them. */
#ifndef KILN_RENDER_CONTEXT_H
#define KILN_RENDER_CONTEXT_H

#include "render/film/film.h"
#include "render/path/path.h"

struct kiln_renderer {
    world *world;
    const kiln_scene *scene;
    uint32_t threads;
};

/* Checks the options; false: reported. The context borrows from the renderer. */
bool context_make(const kiln_renderer *, const kiln_render_options *, const kiln_film *, path_context *, kiln_report *);

#endif
