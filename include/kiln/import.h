/* kiln/import.h: a file becomes a Scene; a Scene's cages become limit surfaces. */
#ifndef KILN_IMPORT_H
#define KILN_IMPORT_H

#include "kiln/api.h"
#include "kiln/report.h"
#include "kiln/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct kiln_import_options {
    uint64_t memory_limit; /* bytes that a file may make kiln allocate; 0: three quarters of the machine's memory */
    bool allow_outside;    /* URIs may lead out of the asset's folder: "..", absolute paths, links. For files that are
                              trusted: one that is not could show what else the user may read */
} kiln_import_options;

/* Reads .gltf and .glb; path "-" is a glb on standard input. The scene is not yet committed. On failure *scene is
 * NULL and the report says where in the file and what to do. */
KILN_API bool kiln_import(const char *path, const kiln_import_options *, kiln_scene **scene, kiln_report *);

/* AUTO: the meshes that ask for it, and of those that say nothing (KILN_SCHEME_AUTO) the evidently smooth ones, which
 * are rounded off and keep their shape. */
typedef enum kiln_subdivide_mode { KILN_SUBDIVIDE_AUTO, KILN_SUBDIVIDE_OFF, KILN_SUBDIVIDE_LEVEL } kiln_subdivide_mode;

typedef struct kiln_subdivide_options {
    kiln_subdivide_mode mode;
    uint32_t level;         /* LEVEL: 1 … 6, every mesh, whatever it looks like */
    kiln_scheme scheme;     /* NONE or AUTO: as the mesh asks */
    double crease_angle_rad; /* edges that bend more than this become creases; 0: none */
    const kiln_camera *camera;  /* AUTO: edges are refined until they are about a pixel in this view; NULL: level 2 */
    uint32_t width, height; /* of that view, pixels */
    uint32_t threads;       /* 0: all */
    uint64_t triangle_limit; /* in all; 0: 50 million; at most 2^28 */
} kiln_subdivide_options;

/* What happened to a mesh: reasons and numbers for `kiln inspect`. */
typedef struct kiln_subdivision_result {
    kiln_id mesh;
    bool refined;
    kiln_scheme scheme;   /* used, or what the mesh looked like */
    uint32_t level;
    double quad_rate;     /* share of triangles that were paired into quads */
    char reason[160];     /* "smooth: authored normals agree with the limit within 3.1°", "flat-shaded" */
} kiln_subdivision_result;

/* Replaces the meshes of an uncommitted scene by their refined limit surfaces, where the options or the mesh call
 * for it. results: one per mesh, owned by the caller (free()); may be NULL. */
KILN_API bool kiln_subdivide(kiln_scene *, const kiln_subdivide_options *, kiln_subdivision_result **results,
                             uint32_t *result_count, kiln_report *);

#ifdef __cplusplus
}
#endif
#endif
