/* kiln/mesh.h: polygon meshes with primvars. */
#ifndef KILN_MESH_H
#define KILN_MESH_H

#include "kiln/api.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum kiln_primvar_kind {
    KILN_PRIMVAR_NORMAL,  /* 3 floats, object space, need not be normalised; zero: the face's own */
    KILN_PRIMVAR_TANGENT, /* 4 floats, w = ±1: bitangent = w · cross(normal, tangent) (glTF). Normal maps need
                             them: importers make them where a file has none, a program must bring them */
    KILN_PRIMVAR_UV,      /* 2 floats */
    KILN_PRIMVAR_COLOR    /* 4 floats in [0,1], linear Rec.709 and alpha; multiplies base colour and opacity */
} kiln_primvar_kind;

typedef enum kiln_interpolation {
    KILN_VERTEX,      /* a value per vertex */
    KILN_FACE_VARYING, /* a value per corner of a face, in the order of face_vertices */
    KILN_UNIFORM,     /* a value per face */
    KILN_CONSTANT     /* one value */
} kiln_interpolation;

typedef struct kiln_primvar {
    kiln_primvar_kind kind;
    uint32_t set; /* UV: 0, 1, …, the rest 0 */
    kiln_interpolation interpolation;
    const float *values;
    uint32_t value_count;
    const uint32_t *indices; /* one per element of the interpolation, into values; NULL: element i reads value i */
} kiln_primvar;

typedef enum kiln_scheme {
    KILN_SCHEME_NONE, /* polygons as they are */
    KILN_SCHEME_CATMULL_CLARK,
    KILN_SCHEME_LOOP,
    KILN_SCHEME_BILINEAR,
    KILN_SCHEME_AUTO /* the subdivision step looks at the mesh and decides, whether and how */
} kiln_scheme;

/* OpenSubdiv's Sdc options of the same names. */
typedef enum kiln_boundary { KILN_BOUNDARY_EDGE_AND_CORNER, KILN_BOUNDARY_EDGE_ONLY, KILN_BOUNDARY_NONE } kiln_boundary;
typedef enum kiln_fvar_boundary {
    KILN_FVAR_CORNERS_PLUS1,
    KILN_FVAR_CORNERS_ONLY,
    KILN_FVAR_CORNERS_PLUS2,
    KILN_FVAR_NONE,
    KILN_FVAR_BOUNDARIES,
    KILN_FVAR_ALL
} kiln_fvar_boundary;

/* What a subdivision surface is beside its cage. Zero-initialised: not a subdivision surface. */
typedef struct kiln_subdivision {
    kiln_scheme scheme;
    int32_t level; /* asked for by the file (glTF extras); 0: the size in the picture decides */
    kiln_boundary boundary;
    kiln_fvar_boundary fvar_boundary;
    bool chaikin_creases;
    bool smooth_triangles; /* Catmull-Clark: OpenSubdiv's TRI_SUB_SMOOTH */
    const uint32_t *crease_vertices; /* pairs: edge_count × 2 vertices */
    const float *crease_sharpness;   /* one per edge; ≥ 10 is infinitely sharp */
    uint32_t crease_count;
    const uint32_t *corner_vertices;
    const float *corner_sharpness;
    uint32_t corner_count;
    const uint32_t *holes; /* faces */
    uint32_t hole_count;
    bool triangulated; /* by a format that knows triangles alone (glTF): vertices are split where primvars are, polygons
                          are cut; refinement puts them together again. AUTO implies it */
    bool fan_encoded;  /* and consecutive triangles with the same first vertex are one polygon (FB_ngon_encoding) */
} kiln_subdivision;

/* All arrays are borrowed for the call and copied. Faces wind counter-clockwise seen from the front. */
typedef struct kiln_mesh_desc {
    const char *name;
    uint32_t vertex_count;
    uint32_t time_count;    /* positions at time_count equidistant times of the shutter, at most 129; 0 or 1: rigid. The
                               renderer shows the first, and warns */
    const float *positions; /* time_count × vertex_count × 3, metres, object space */
    uint32_t face_count;
    const uint32_t *face_sizes; /* corners of each face, ≥ 3; NULL: triangles */
    const uint32_t *face_vertices;
    const kiln_primvar *primvars;
    uint32_t primvar_count;
    kiln_id material;               /* 0: the default material */
    const kiln_id *face_materials;  /* one per face, overrides material; may be NULL */
    kiln_subdivision subdivision;
} kiln_mesh_desc;

#ifdef __cplusplus
}
#endif
#endif
