/* scene/check.h: what the adders share: places, factors, transforms, growing arrays. */
#ifndef KILN_SCENE_CHECK_H
#define KILN_SCENE_CHECK_H

#include "scene/scene.h"

/* "mesh 'Helmet'", or "mesh 3" for one without a name; the place in the file where an importer has located the object.
 * Do not copy: where may point into label. */
typedef struct scene_place {
    char label[112];
    kiln_where where;
} scene_place;

void place_set(scene_place *, const kiln_scene *, const char *noun, const char *name, size_t number);

/* The scene still takes objects; otherwise an error. */
bool check_open(const kiln_scene *, const kiln_where *, kiln_report *);

/* value where it lies in [low, high]; else the nearer end, or fallback for what is not a finite number, with a
 * warning that calls it name. */
float check_factor(float value, float low, float high, float fallback, const char *name, const kiln_where *,
                   kiln_report *);

/* So many time samples of a motion can be kept. */
bool check_time_count(uint32_t count, const kiln_where *, kiln_report *);

/* Finite, else an error. A last row that is not 0 0 0 1 is made so, with a warning. */
bool check_transform(double m[16], const kiln_where *, kiln_report *);

/* id is 0, if none is allowed, or one of count objects; else an error: "image 9 does not exist (the scene has 2)". */
bool check_reference(kiln_id id, uint32_t count, bool none_allowed, const char *noun, const kiln_where *,
                     kiln_report *);

/* value < count, for an enumeration that a caller may have filled with anything. */
bool check_choice(unsigned value, unsigned count, const char *name, const kiln_where *, kiln_report *);

/* Room for one more behind count elements; an error when memory or handles end. */
bool array_room(void **array, uint32_t count, size_t size, kiln_report *);

#endif
