/* importers/subdiv/osd.h: the seam over OpenSubdiv: a cage goes in, the limit surface comes out. No C++ type crosses,
 * no exception does. */
#ifndef KILN_IMPORTERS_SUBDIV_OSD_H
#define KILN_IMPORTERS_SUBDIV_OSD_H

#include "importers/subdiv/cage.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { OSD_LEVEL_MAX = 10 }; /* Far keeps levels in 4 bits; a cube has 6 million faces at level 10 */

typedef struct osd_values {
    const float *values;
    uint32_t value_count;
    const uint32_t *indices; /* one per corner; NULL: value i belongs to vertex i */
} osd_values;

/* Points of the limit surface, joined to faces of one size. Holes are left out. */
typedef struct osd_surface {
    uint32_t vertex_count, face_count, face_size; /* corners of every face: 4, or 3 for Loop's scheme */
    const float *positions;        /* time_count × vertex_count × 3, on the limit */
    const uint32_t *face_vertices;
    const uint32_t *face_parents;  /* the face of the cage that each comes from */
    osd_values normals;            /* unit normals of the limit, one on each side of a sharp edge; zero where there is
                                      none; no values for the bilinear scheme */
    osd_values *channels;          /* as many as the cage has */
    const uint32_t *cage_corners;  /* for each corner of the cage the corner of the surface in the same place;
                                      UINT32_MAX in holes */
} osd_surface;

/* level: 1 … OSD_LEVEL_MAX. All arrays lie in arena. */
bool osd_refine(const kiln_cage *, uint32_t level, kiln_arena *, osd_surface *, const kiln_where *, kiln_report *);

/* Moves the cage's points until its limit surface passes where they were, nearly: vertices of a finished model lie on
 * the surface that it means, and a limit surface of its own vertices would shrink it. (Halstead, Kass, DeRose 1993
 * solve for such a cage; a few relaxations do, and leave the highest frequencies, which only ripple, alone.) */
bool osd_fit(kiln_cage *, kiln_arena *, const kiln_where *, kiln_report *);

#ifdef __cplusplus
}
#endif
#endif
