/* scene/groups.h: where light comes from, by name. */
#ifndef KILN_SCENE_GROUPS_H
#define KILN_SCENE_GROUPS_H

#include "scene/scene.h"

typedef struct light_groups {
    const char **names; /* in one piece with the texts; free() */
    uint32_t count;
    uint32_t *of_light, *of_material; /* by handle, into names; free() */
    uint32_t of_environment;
} light_groups;

/* A material that does not shine belongs to group 0, as nothing asks for it. False: out of memory, reported. */
bool light_groups_make(const kiln_scene *, light_groups *, kiln_report *);
void light_groups_free(light_groups *);

/* As a layer of a file can be called: '.', ',', ':' and control characters become '_', and what is longer than 200
 * bytes, of the 255 that a channel's name may have, is cut between two characters. In place. */
void light_group_clean(char *name);

#endif
