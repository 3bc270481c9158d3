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

/* naming.c: what mattes of the film call things. false: reported. */
bool context_name_mattes(const kiln_renderer *, kiln_film *, kiln_report *);

/* parts.c: where the scene's light belongs in the film, which learns whether it holds all of it. false: reported. The
 * caller frees the plan in either case. */
bool context_plan_parts(const kiln_renderer *, kiln_film *, path_parts_plan *, kiln_report *);
void context_free_parts(path_parts_plan *);

#endif
