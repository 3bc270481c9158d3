#include "scene/mesh_build.h"

#include <stdio.h>
#include <string.h>

#include "scene/check.h"

static void name_of(const kiln_primvar *p, char name[32]) {
    static const char *const names[] = {[KILN_PRIMVAR_NORMAL] = "normals",
                                        [KILN_PRIMVAR_TANGENT] = "tangents",
                                        [KILN_PRIMVAR_UV] = "UV set",
                                        [KILN_PRIMVAR_COLOR] = "colours"};
    if (p->kind == KILN_PRIMVAR_UV) snprintf(name, 32, "%s %u", names[p->kind], p->set);
    else snprintf(name, 32, "%s", names[p->kind]);
}

static uint32_t element_count(const kiln_mesh *m, kiln_interpolation interpolation) {
    switch (interpolation) {
    case KILN_VERTEX: return m->vertex_count;
    case KILN_FACE_VARYING: return m->corner_count;
    case KILN_UNIFORM: return m->face_count;
    case KILN_CONSTANT: break;
    }
    return 1;
}

static bool check_counts(mesh_builder *b, const kiln_primvar *p, const kiln_where *where) {
    static const char *const elements[] = {[KILN_VERTEX] = "vertices", [KILN_FACE_VARYING] = "corners",
                                           [KILN_UNIFORM] = "faces", [KILN_CONSTANT] = "mesh"};
    uint32_t count = element_count(b->mesh, p->interpolation);
    if (!p->indices && p->value_count != count)
        return report_error(b->report, KILN_CODE_GEOMETRY, where, NULL, "%u values for %u %s", p->value_count, count,
                            elements[p->interpolation]);
    for (uint32_t i = 0; p->indices && i < count; i++)
        if (p->indices[i] >= p->value_count)
            return report_error(b->report, KILN_CODE_RANGE, where, NULL, "index %u of %u values, element %u",
                                p->indices[i], p->value_count, i);
    return true;
}

/* What stands for a value that is not a number: a zero normal or tangent tells the renderer to use its own. */
static const float *fallback_of(kiln_primvar_kind kind) {
    static const float rows[][4] = {[KILN_PRIMVAR_NORMAL] = {0, 0, 0, 0},
                                    [KILN_PRIMVAR_TANGENT] = {0, 0, 0, 1},
                                    [KILN_PRIMVAR_UV] = {0, 0, 0, 0},
                                    [KILN_PRIMVAR_COLOR] = {1, 1, 1, 1}};
    return rows[kind];
}

/* Colours multiply an albedo: outside [0,1] they would create energy. The handedness of a tangent is a sign. */
static bool into_domain(kiln_primvar_kind kind, float *value) {
    if (kind == KILN_PRIMVAR_TANGENT) {
        float sign = value[3] < 0 ? -1.0f : 1.0f;
        bool ok = value[3] == sign;
        value[3] = sign;
        return ok;
    }
    bool ok = true;
    for (int k = 0; kind == KILN_PRIMVAR_COLOR && k < 4; k++) {
        float clamped = value[k] < 0 ? 0 : value[k] > 1 ? 1 : value[k];
        ok &= clamped == value[k];
        value[k] = clamped;
    }
    return ok;
}

static void mend_values(mesh_builder *b, const kiln_primvar *p, float *values, const kiln_where *where) {
    uint32_t width = primvar_width(p->kind), lost = 0, clamped = 0;
    for (uint32_t i = 0; i < p->value_count; i++) {
        float *value = values + (size_t)width * i;
        bool finite = true;
        for (uint32_t k = 0; k < width; k++) finite &= (bool)isfinite(value[k]);
        if (!finite) {
            memcpy(value, fallback_of(p->kind), width * sizeof *value);
            lost++;
        } else {
            clamped += !into_domain(p->kind, value);
        }
    }
    if (lost)
        report_warning(b->report, KILN_CODE_GEOMETRY, where, NULL, "%u of %u values are not finite: %s", lost,
                       p->value_count, p->kind == KILN_PRIMVAR_COLOR ? "white is used" : "zero is used");
    if (clamped)
        report_warning(b->report, KILN_CODE_GEOMETRY, where, NULL, "%u of %u values lie outside their domain: %s",
                       clamped,
                       p->value_count,
                       p->kind == KILN_PRIMVAR_COLOR ? "clamped to [0, 1]" : "the handedness is taken by its sign");
}

static bool build_primvar(mesh_builder *b, kiln_primvar *p) {
    if (!check_choice(p->kind, KILN_PRIMVAR_COLOR + 1, "primvar kind", b->where, b->report) ||
        !check_choice(p->interpolation, KILN_CONSTANT + 1, "interpolation", b->where, b->report))
        return false;
    char name[32];
    name_of(p, name);
    kiln_where where = where_key(b->where, name);
    if (!check_counts(b, p, &where)) return false;
    size_t elements = element_count(b->mesh, p->interpolation);
    float *values = mesh_keep(b, p->values, p->value_count, primvar_width(p->kind) * sizeof(float));
    if (!values) return false;
    if (p->indices && !(p->indices = mesh_keep(b, p->indices, elements, sizeof(uint32_t)))) return false;
    mend_values(b, p, values, &where);
    p->values = values;
    return true;
}

bool mesh_build_primvars(mesh_builder *b) {
    kiln_mesh *m = b->mesh;
    kiln_primvar *kept = ARENA_ARRAY(&m->arena, kiln_primvar, b->desc->primvar_count);
    if (!kept) return report_no_memory(b->report, "building a mesh");
    m->primvars = kept;
    for (uint32_t i = 0; i < b->desc->primvar_count; i++) {
        kiln_primvar p = b->desc->primvars[i];
        if (mesh_primvar(m, p.kind, p.set)) {
            report_warning(b->report, KILN_CODE_GEOMETRY, b->where, NULL,
                           "primvar %u repeats an earlier one: it is left out", i);
            continue;
        }
        if (!build_primvar(b, &p)) return false;
        kept[m->primvar_count++] = p;
    }
    return true;
}
