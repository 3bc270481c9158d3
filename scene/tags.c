#include "scene/mesh_build.h"

#include "scene/check.h"

/* Sdc::Crease::SHARPNESS_INFINITE. */
static const float SHARPNESS_INFINITE = 10;

/* Tags that name what does not exist are left out with a warning, as OpenSubdiv does: the surface stays whole. */
static void warn_dropped(mesh_builder *b, uint32_t dropped, const char *what) {
    if (dropped)
        report_warning(b->report, KILN_CODE_GEOMETRY, b->where, NULL,
                       "%u %s name what the mesh does not have: left out", dropped, what);
}

/* Creases (two vertices a tag) or corners (one). A sharpness of 0 or less is smooth: dropped without a word. */
static bool build_sharp(mesh_builder *b, const char *what, uint32_t per_tag, const uint32_t **vertices,
                        const float **sharpness, uint32_t *count) {
    if (*count && (!*vertices || !*sharpness))
        return report_error(b->report, KILN_CODE_USAGE, b->where, NULL, "the array of %u %s is missing", *count, what);
    uint32_t *v = ARENA_ARRAY(&b->mesh->arena, uint32_t, (size_t)*count * per_tag);
    float *s = ARENA_ARRAY(&b->mesh->arena, float, *count);
    if (!v || !s) return report_no_memory(b->report, "building a mesh");
    uint32_t kept = 0, dropped = 0;
    for (uint32_t i = 0; i < *count; i++) {
        bool known = !isnan((*sharpness)[i]);
        for (uint32_t k = 0; k < per_tag; k++) {
            v[kept * per_tag + k] = (*vertices)[i * per_tag + k];
            known &= v[kept * per_tag + k] < b->mesh->vertex_count;
        }
        s[kept] = (*sharpness)[i] > SHARPNESS_INFINITE ? SHARPNESS_INFINITE : (*sharpness)[i];
        dropped += !known;
        kept += known && s[kept] > 0;
    }
    warn_dropped(b, dropped, what);
    *vertices = v;
    *sharpness = s;
    *count = kept;
    return true;
}

static bool build_holes(mesh_builder *b, kiln_subdivision *s) {
    if (s->hole_count && !s->holes)
        return report_error(b->report, KILN_CODE_USAGE, b->where, NULL, "the array of %u holes is missing",
                            s->hole_count);
    uint32_t *holes = ARENA_ARRAY(&b->mesh->arena, uint32_t, s->hole_count);
    if (!holes) return report_no_memory(b->report, "building a mesh");
    uint32_t n = 0;
    for (uint32_t i = 0; i < s->hole_count; i++)
        if (s->holes[i] < b->mesh->face_count) holes[n++] = s->holes[i];
    warn_dropped(b, s->hole_count - n, "holes");
    s->holes = holes;
    s->hole_count = n;
    return true;
}

bool mesh_build_tags(mesh_builder *b) {
    kiln_subdivision s = b->desc->subdivision;
    if (!check_choice(s.scheme, KILN_SCHEME_AUTO + 1, "subdivision scheme", b->where, b->report) ||
        !check_choice(s.boundary, KILN_BOUNDARY_NONE + 1, "boundary rule", b->where, b->report) ||
        !check_choice(s.fvar_boundary, KILN_FVAR_ALL + 1, "face-varying boundary rule", b->where, b->report))
        return false;
    if (!build_sharp(b, "creases", 2, &s.crease_vertices, &s.crease_sharpness, &s.crease_count) ||
        !build_sharp(b, "corners", 1, &s.corner_vertices, &s.corner_sharpness, &s.corner_count) ||
        !build_holes(b, &s))
        return false;
    b->mesh->subdivision = s;
    return true;
}
