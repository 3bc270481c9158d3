/* tests/importers/subdiv/reference.h: what OpenSubdiv says when it is asked directly, without kiln in between. */
#ifndef KILN_TESTS_SUBDIV_REFERENCE_H
#define KILN_TESTS_SUBDIV_REFERENCE_H

#include "kiln/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Uniform refinement of a mesh as it is described; all arrays are malloced and per corner of the faces that are no
 * holes: limit positions (3 floats), limit normals (3; zero where OpenSubdiv has none that it could be asked for
 * safely), UVs of set 0 (2; NULL without). */
typedef struct reference {
    uint32_t corner_count;
    float *positions, *normals, *uvs;
} reference;

bool reference_refine(const kiln_mesh_desc *, int level, reference *);
void reference_free(reference *);

#ifdef __cplusplus
}
#endif
#endif
