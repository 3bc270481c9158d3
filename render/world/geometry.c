/* render/world/geometry.c: meshes and instances as flat arrays in render space.
 *
 * Triangles lie in this order: baked opaque, baked with coverage, then for each prototype the same two. Sizes are
 * summed first, so that instances can be written in parallel and the result does not depend on threads. */
#include <float.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "base/threads.h"
#include "render/world/shape.h"

/* A shared mesh is placed by Embree, at 15 to 30 % of the speed of rays, only when writing it out would take more than
 * this. */
enum { BAKE_TRIANGLES = 1 << 20 };

/* Where an instance (baked) or a prototype is written. */
typedef struct placement {
    const shape *shape;
    uint32_t instance; /* baked: its handle */
    bool baked;
    mat4 to_target; /* object to render space, or to the prototype's own */
    mat4 normals;   /* normal_matrix of it */
    double tangents; /* what tangents are multiplied by */
    uint32_t vertex_first, opaque_first, coverage_first;
    bool mirrored;
} placement;

/* How an instance comes into the world. */
typedef enum presence {
    ABSENT, /* it has no area: a node that is hidden by a scale of 0 */
    ALONE,  /* flat, or nearly: it is baked whatever becomes of the others, for Embree inverts transforms, in float */
    LIKE_THE_OTHERS /* baked or placed, as its shape is */
} presence;

typedef struct build {
    world *world;
    const kiln_scene *scene;
    shape *shapes; /* one per mesh */
    uint8_t *presences; /* one per instance */
    placement *placements;
    uint32_t placement_count, prototype_count;
    dvec3 *prototype_centers; /* by prototype: what its coordinates are relative to */
    atomic_bool failed;
} build;

void world_choose_space(world *w, const kiln_scene *scene) {
    kiln_bounds b = scene->bounds;
    w->scale = 1;
    if (!(b.min[0] <= b.max[0])) return;
    dvec3 low = d3_load(b.min), high = d3_load(b.max);
    w->center = d3_scale(d3_add(low, high), 0.5);
    double radius = 0.5 * d3_length(d3_sub(high, low));
    int exponent = 0;
    if (radius > 0) (void)frexp(radius, &exponent);
    w->scale = ldexp(1, -exponent);
    w->radius = (float)(radius * w->scale);
}

static mat4 to_render_space(const world *w, const mat4 *m) {
    mat4 r = *m;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 3; i++) r.m[4 * c + i] *= w->scale;
    dvec3 t = world_point(w, d3_load(m->m + 12));
    r.m[12] = t.x, r.m[13] = t.y, r.m[14] = t.z;
    return r;
}

static void make_shape(void *context, size_t index, uint32_t thread) {
    (void)thread;
    build *b = context;
    if (b->shapes[index].mesh && !shape_make(&b->shapes[index], b->world)) atomic_store(&b->failed, true);
}

/* In float, rounding leaves 2⁻²³ of what was turned or stretched before it was flattened. */
static presence presence_of(const mat4 *m) {
    dvec3 x = d3_load(m->m), y = d3_load(m->m + 4), z = d3_load(m->m + 8);
    double a = d3_length(x), b = d3_length(y), c = d3_length(z);
    if (!transform_shows(m)) return ABSENT;
    double volume = fabs(mat4_determinant(m));
    bool invertible = volume > 0x1p-20 * a * b * c && volume > (double)FLT_MIN && volume < 1 / (double)FLT_MIN;
    return invertible ? LIKE_THE_OTHERS : ALONE;
}

/* A shape is shared or not for the sake of the instances that can be placed. */
static void choose_baking(build *b) {
    for (uint32_t i = 0; i < b->scene->instance_count; i++) {
        const kiln_instance *instance = &b->scene->instances[i];
        shape *s = &b->shapes[instance->mesh - 1];
        mat4 m = to_render_space(b->world, &instance->transforms[0]);
        b->presences[i] = (uint8_t)presence_of(&m);
        if (b->presences[i] != ABSENT) s->mesh = scene_mesh(b->scene, instance->mesh);
        s->uses += b->presences[i] == LIKE_THE_OTHERS;
    }
    for (uint32_t i = 0; i < b->scene->mesh_count; i++) {
        shape *s = &b->shapes[i];
        if (!s->mesh) continue;
        s->baked = s->uses <= 1 || (uint64_t)s->uses * s->mesh->triangle_count <= BAKE_TRIANGLES;
        if (!s->baked) s->prototype = b->prototype_count++;
    }
}

static bool is_placed(const build *b, uint32_t instance) {
    return b->presences[instance] == LIKE_THE_OTHERS && !b->shapes[b->scene->instances[instance].mesh - 1].baked;
}

/* For normals: the cofactors, turned right side out again under a mirror, divided by the longest. One divisor for all,
 * so that interpolation stays linear: normals are interpolated before a copy is placed, or after. */
static mat4 normal_matrix(const mat4 *m) {
    dvec3 columns[3];
    double longest = 0, side = mat4_determinant(m) < 0 ? -1 : 1;
    for (int c = 0; c < 3; c++) {
        columns[c] = mat4_normal(m, (dvec3){c == 0, c == 1, c == 2});
        longest = fmax(longest, d3_length(columns[c]));
    }
    mat4 result = mat4_identity();
    for (int c = 0; c < 3; c++) {
        dvec3 column = d3_scale(columns[c], side / longest); /* not 0: what has no area is absent */
        result.m[4 * c] = column.x, result.m[4 * c + 1] = column.y, result.m[4 * c + 2] = column.z;
    }
    return result;
}

static dvec3 mesh_center(const kiln_mesh *m) {
    return (dvec3){0.5 * ((double)m->min[0] + (double)m->max[0]), 0.5 * ((double)m->min[1] + (double)m->max[1]),
                   0.5 * ((double)m->min[2] + (double)m->max[2])};
}

static void add_placement(build *b, const shape *s, uint32_t instance, mat4 m) {
    double longest = 0;
    for (int c = 0; c < 3; c++) longest = fmax(longest, d3_length(d3_load(m.m + 4 * c)));
    b->placements[b->placement_count++] = (placement){.shape = s,
                                                      .instance = instance,
                                                      .baked = instance != 0,
                                                      .to_target = m,
                                                      .normals = normal_matrix(&m),
                                                      .tangents = 1 / longest,
                                                      .mirrored = mat4_determinant(&m) < 0};
}

/* Placements: first every baked instance, then every prototype. */
static void list_placements(build *b) {
    for (uint32_t i = 0; i < b->scene->instance_count; i++) {
        const kiln_instance *instance = &b->scene->instances[i];
        if (b->presences[i] != ABSENT && !is_placed(b, i))
            add_placement(b, &b->shapes[instance->mesh - 1], i + 1, to_render_space(b->world, &instance->transforms[0]));
    }
    for (uint32_t i = 0; i < b->scene->mesh_count; i++) {
        const shape *s = &b->shapes[i];
        if (!s->mesh || s->baked) continue;
        mat4 m = mat4_identity();
        dvec3 c = mesh_center(s->mesh);
        m.m[12] = -c.x, m.m[13] = -c.y, m.m[14] = -c.z;
        b->prototype_centers[s->prototype] = c;
        add_placement(b, s, 0, m);
    }
}

/* Offsets by running sums; false: more than 32 bits can count. Baked placements come first in the list. */
static bool assign_ranges(build *b, uint64_t *vertices, uint64_t *triangles) {
    uint64_t opaque = 0, coverage = 0, vertex = 0;
    for (uint32_t i = 0; i < b->placement_count; i++) {
        const shape *s = b->placements[i].shape;
        if (b->placements[i].baked) coverage += s->triangle_count - s->coverage_count; /* it lies behind baked opaque */
    }
    for (uint32_t i = 0; i < b->placement_count; i++) {
        placement *p = &b->placements[i];
        const shape *s = p->shape;
        if (!p->baked) { /* a prototype lies behind everything so far, in one piece */
            opaque = opaque > coverage ? opaque : coverage;
            coverage = opaque + s->triangle_count - s->coverage_count;
        }
        p->vertex_first = (uint32_t)vertex;
        p->opaque_first = (uint32_t)opaque;
        p->coverage_first = (uint32_t)coverage;
        vertex += s->vertex_count;
        opaque += s->triangle_count - s->coverage_count;
        coverage += s->coverage_count;
        if (vertex >= UINT32_MAX || coverage >= UINT32_MAX) return false;
    }
    *vertices = vertex;
    *triangles = coverage;
    return true;
}

static bool allocate(world *w, uint64_t vertices, uint64_t triangles) {
    w->vertex_count = (uint32_t)vertices;
    w->triangle_count = (uint32_t)triangles;
    w->vertices = ARENA_ARRAY(&w->arena, world_vertex, vertices + 1);
    w->triangles = ARENA_ARRAY(&w->arena, uint32_t, 3 * triangles + 4);
    w->triangle_material = ARENA_ARRAY(&w->arena, uint32_t, triangles + 1);
    bool done = w->vertices && w->triangles && w->triangle_material;
    if (world_wants_tangents(w)) done = done && (w->tangents = ARENA_ARRAY(&w->arena, float, 4 * vertices + 4));
    if (HOLDS(w, VERTEX_COLORS)) done = done && (w->colors = ARENA_ARRAY(&w->arena, float, 4 * vertices + 4));
    for (uint32_t k = 1; k < w->uv_set_count; k++)
        done = done && (w->uvs[k] = ARENA_ARRAY(&w->arena, float, 2 * vertices + 2));
    return done;
}

/* Normals and tangents may come in any length; what weighs in interpolation is their direction. */
static dvec3 unit(const float *v) { return d3_normalize((dvec3){(double)v[0], (double)v[1], (double)v[2]}); }

static vec3 place_normal(const placement *p, const float *n) { return to_float(mat4_vector(&p->normals, unit(n))); }

static void place_tangent(const placement *p, const float *t, float out[4]) {
    v3_store(out, to_float(d3_scale(mat4_vector(&p->to_target, unit(t)), p->tangents)));
    out[3] = p->mirrored ? -t[3] : t[3];
}

static void place_vertex(const world *w, const placement *p, const shape_primvars *primvars, uint32_t vertex) {
    uint32_t face, corner, from, at = p->vertex_first + vertex;
    shape_source(p->shape, vertex, &face, &corner, &from);
    const float *position = p->shape->mesh->positions + 3 * (size_t)from;
    dvec3 d = mat4_point(&p->to_target, (dvec3){(double)position[0], (double)position[1], (double)position[2]});
    world_vertex *v = &w->vertices[at];
    v3_store(v->p, to_float(d));
    if (primvars->normal) v3_store(v->n, place_normal(p, primvar_at(primvars->normal, face, corner, from)));
    if (primvars->uv[0]) memcpy(v->uv, primvar_at(primvars->uv[0], face, corner, from), sizeof v->uv);
    if (primvars->tangent)
        place_tangent(p, primvar_at(primvars->tangent, face, corner, from), w->tangents + 4 * (size_t)at);
    static const float white[4] = {1, 1, 1, 1};
    if (w->colors)
        memcpy(w->colors + 4 * (size_t)at, primvars->color ? primvar_at(primvars->color, face, corner, from) : white,
               sizeof white);
    for (uint32_t k = 1; k < w->uv_set_count; k++)
        if (primvars->uv[k])
            memcpy(w->uvs[k] + 2 * (size_t)at, primvar_at(primvars->uv[k], face, corner, from), 2 * sizeof(float));
}

static void place(void *context, size_t index, uint32_t thread) {
    (void)thread;
    const build *b = context;
    const placement *p = &b->placements[index];
    const shape *s = p->shape;
    world *w = b->world;
    shape_primvars primvars = shape_read_primvars(s, w);
    for (uint32_t v = 0; v < s->vertex_count; v++) place_vertex(w, p, &primvars, v);
    uint32_t opaque = p->opaque_first, coverage = p->coverage_first;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        size_t at = shape_has_coverage(w, s, t) ? coverage++ : opaque++;
        w->triangle_material[at] = mesh_face_material(s->mesh, shape_face(s, t));
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t turned = p->mirrored && k ? 3 - k : k; /* fronts stay fronts */
            w->triangles[3 * at + k] = p->vertex_first + shape_vertex(s, t, turned);
        }
    }
}

/* Baked placements come first in the list, and their triangles in the same order. */
static bool list_objects(build *b) {
    world *w = b->world;
    world_objects *o = &w->objects;
    while (o->baked_count < b->placement_count && b->placements[o->baked_count].baked) o->baked_count++;
    o->baked = ARENA_ARRAY(&w->arena, uint32_t, (size_t)o->baked_count + 1);
    for (int g = 0; g < 2; g++) o->first[g] = ARENA_ARRAY(&w->arena, uint32_t, (size_t)o->baked_count + 1);
    o->copies = ARENA_ARRAY(&w->arena, uint32_t, w->instance_count);
    if (!o->baked || !o->first[0] || !o->first[1] || !o->copies) return false;
    for (uint32_t i = 0; i < o->baked_count; i++) {
        const placement *p = &b->placements[i];
        o->baked[i] = p->instance;
        o->first[0][i] = p->opaque_first;
        o->first[1][i] = p->coverage_first;
    }
    for (int g = 0; g < 2; g++) o->first[g][o->baked_count] = w->baked.first[g] + w->baked.count[g];
    for (uint32_t i = 0, copy = 1; i < b->scene->instance_count; i++)
        if (is_placed(b, i)) o->copies[copy++] = i + 1;
    return true;
}

/* The copies that Embree places, behind copy 0. */
static bool list_instances(build *b) {
    world *w = b->world;
    uint32_t count = 1;
    for (uint32_t i = 0; i < b->scene->instance_count; i++) count += is_placed(b, i);
    w->instances = ARENA_ARRAY(&w->arena, world_instance, count);
    w->prototypes = ARENA_ARRAY(&w->arena, world_prototype, (size_t)b->prototype_count + 1);
    if (!w->instances || !w->prototypes) return false;
    uint64_t baked_opaque = 0, baked_coverage = 0;
    for (uint32_t i = 0; i < b->placement_count; i++) {
        const placement *p = &b->placements[i];
        uint32_t opaque = p->shape->triangle_count - p->shape->coverage_count;
        if (p->baked) baked_opaque += opaque, baked_coverage += p->shape->coverage_count;
        else w->prototypes[p->shape->prototype] =
                 (world_prototype){{p->opaque_first, p->coverage_first}, {opaque, p->shape->coverage_count}};
    }
    w->prototype_count = b->prototype_count;
    w->baked = (world_prototype){{0, (uint32_t)baked_opaque}, {(uint32_t)baked_opaque, (uint32_t)baked_coverage}};
    w->instances[0] = (world_instance){.m = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, .normal = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                                       .triangle_base = {0, (uint32_t)baked_opaque}, .side = 1};
    w->instance_count = 1;
    for (uint32_t i = 0; i < b->scene->instance_count; i++) {
        const kiln_instance *from = &b->scene->instances[i];
        const shape *s = &b->shapes[from->mesh - 1];
        if (is_placed(b, i)) world_place_instance(w, from, s->mesh, s->prototype, b->prototype_centers[s->prototype]);
    }
    return true;
}

void world_place_instance(world *w, const kiln_instance *from, const kiln_mesh *mesh, uint32_t prototype,
                          dvec3 center) {
    mat4 m = to_render_space(w, &from->transforms[0]), normals = normal_matrix(&m);
    dvec3 origin = mat4_point(&m, center);
    double largest = 0, t[3] = {origin.x, origin.y, origin.z};
    world_instance *to = &w->instances[w->instance_count++];
    *to = (world_instance){.prototype = prototype, .side = mat4_determinant(&m) < 0 ? -1.0f : 1.0f};
    for (int i = 0; i < 3; i++) {
        double reach = fabs(t[i]);
        for (int c = 0; c < 3; c++) {
            to->m[4 * i + c] = (float)m.m[4 * c + i];
            to->normal[3 * i + c] = (float)normals.m[4 * c + i];
            reach += fabs(m.m[4 * c + i]) * 0.5 * ((double)mesh->max[c] - (double)mesh->min[c]);
        }
        to->m[4 * i + 3] = (float)t[i];
        largest = fmax(largest, reach);
    }
    to->magnitude = (float)largest;
    for (int g = 0; g < 2; g++) to->triangle_base[g] = w->prototypes[prototype].first[g];
}

static bool uses_tangents(const world *w, const kiln_mesh *m) {
    if (!m->face_materials) return material_uses_tangents(&w->materials[m->material]);
    for (uint32_t f = 0; f < m->face_count; f++)
        if (material_uses_tangents(&w->materials[m->face_materials[f]])) return true;
    return false;
}

/* Importers generate tangents; a program that builds its own scene may have forgotten them. */
static void warn_of_missing_tangents(const build *b, kiln_report *report) {
    for (uint32_t i = 0; i < b->scene->mesh_count; i++) {
        const kiln_mesh *m = b->shapes[i].mesh;
        if (!m || mesh_primvar(m, KILN_PRIMVAR_TANGENT, 0) || !uses_tangents(b->world, m)) continue;
        kiln_where where = where_root(m->name);
        report_warning(report, KILN_CODE_GEOMETRY, &where, "give the mesh a KILN_PRIMVAR_TANGENT",
                       "a mesh without tangents has a material with a normal map or anisotropy: maps are left out, and "
                       "highlights stretch along no direction of the mesh's own");
    }
}

/* A scene keeps motion that the renderer does not show. */
static void warn_of_motion(const build *b, kiln_report *report) {
    const kiln_effect_use *motion = &b->world->plan.uses[KILN_EFFECT_MOTION];
    if (motion->called)
        report_warning(report, KILN_CODE_IGNORED, NULL, "give them one time sample, the one to be seen",
                       "%u of %u instances move while the shutter is open: they are shown at their first time sample",
                       motion->caller_count, b->scene->instance_count);
}

static bool run(build *b, uint32_t threads, kiln_report *report) {
    world *w = b->world;
    b->presences = array_alloc(b->scene->instance_count, sizeof *b->presences);
    if (!b->presences) return report_no_memory(report, "building geometry");
    choose_baking(b);
    warn_of_motion(b, report);
    if (world_wants_tangents(w)) warn_of_missing_tangents(b, report);
    threads_for(threads, b->scene->mesh_count, make_shape, b);
    b->placements = array_alloc((size_t)b->scene->instance_count + b->prototype_count, sizeof *b->placements);
    b->prototype_centers = array_alloc(b->prototype_count, sizeof *b->prototype_centers);
    if (b->failed || !b->placements || !b->prototype_centers) return report_no_memory(report, "building geometry");
    list_placements(b);
    uint64_t vertices, triangles;
    if (!assign_ranges(b, &vertices, &triangles))
        return report_error(report, KILN_CODE_LIMIT, NULL, "use fewer or coarser meshes",
                            "the scene has more than 4 billion vertices or triangles");
    if (!allocate(w, vertices, triangles)) return report_no_memory(report, "building geometry");
    threads_for(threads, b->placement_count, place, b);
    return (list_instances(b) && list_objects(b)) || report_no_memory(report, "building geometry");
}

bool world_build_geometry(world *w, const reduced_scene *reduced, uint32_t threads, kiln_report *report) {
    const kiln_scene *scene = reduced->scene;
    build b = {.world = w, .scene = scene, .shapes = array_alloc(scene->mesh_count, sizeof *b.shapes)};
    bool done = b.shapes ? run(&b, threads, report) : report_no_memory(report, "building geometry");
    for (uint32_t i = 0; b.shapes && i < scene->mesh_count; i++) shape_free(&b.shapes[i]);
    free(b.shapes);
    free(b.presences);
    free(b.placements);
    free(b.prototype_centers);
    return done;
}
