#include "render/world/media.h"

#include <stdlib.h>
#include <string.h>

#include "render/world/spectrum.h"
#include "scene/transfer.h"

bool material_transmits(const kiln_material *m) {
    return m->layers & KILN_LAYER_TRANSMISSION && m->transmission.value > 0;
}
bool material_is_translucent(const kiln_material *m) {
    return m->layers & KILN_LAYER_DIFFUSE_TRANSMISSION && m->diffuse_transmission.value > 0;
}
bool material_is_solid(const kiln_material *m) {
    bool crossed = material_transmits(m) || material_is_translucent(m);
    return crossed && !(m->layers & KILN_LAYER_UNLIT) && m->layers & KILN_LAYER_VOLUME && m->thickness.value > 0;
}

/* A solid material, and how it ranks. */
typedef struct candidate {
    kiln_id material;
    int32_t priority;
    double size; /* of the largest copy that has it: the volume of its bounding box, m³ */
} candidate;

/* The lowest rank first. Where volumes overlap the one of higher priority is there, of equal ones the smaller: so a
 * marble is in the water and not the water in the marble. The last key only makes the order whole. */
static int by_rank(const void *left, const void *right) {
    const candidate *a = left, *b = right;
    if (a->priority != b->priority) return a->priority < b->priority ? -1 : 1;
    if (a->size != b->size) return a->size > b->size ? -1 : 1;
    return a->material < b->material ? -1 : 1;
}

typedef struct box { float low[3], high[3]; } box;

static const box empty = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static double box_volume(const box *b) {
    double volume = 1;
    for (int k = 0; k < 3; k++) volume *= fmax((double)b->high[k] - (double)b->low[k], 0);
    return volume;
}

/* The part of a mesh that has a material. */
static box material_box(const kiln_mesh *m, kiln_id material) {
    box b = empty;
    for (uint32_t f = 0; f < m->face_count; f++) {
        if (mesh_face_material(m, f) != material) continue;
        for (uint32_t c = 0; c < mesh_face_size(m, f); c++) {
            const float *p = m->positions + 3 * (size_t)m->face_vertices[mesh_face_first(m, f) + c];
            for (int k = 0; k < 3; k++) b.low[k] = fminf(b.low[k], p[k]), b.high[k] = fmaxf(b.high[k], p[k]);
        }
    }
    return b;
}

/* The solid materials of a mesh, each once, into list; their number. stamps: of all materials, marked with the mesh's
 * number, which starts at 1. */
static uint32_t mesh_solids(const reduced_scene *scene, uint32_t mesh, uint32_t *stamps, kiln_id *list) {
    const kiln_mesh *m = scene_mesh(scene->scene, mesh);
    uint32_t count = 0, faces = m->face_materials ? m->face_count : 1;
    for (uint32_t f = 0; f < faces; f++) {
        kiln_id id = m->face_materials ? m->face_materials[f] : m->material;
        if (stamps[id] == mesh) continue;
        stamps[id] = mesh;
        if (material_is_solid(reduced_material(scene, id))) list[count++] = id;
    }
    return count;
}

/* By how much the largest copy of each mesh is larger than the mesh, in volume. */
static void find_scales(const kiln_scene *scene, double *scales) {
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const kiln_instance *copy = &scene->instances[i];
        double *scale = &scales[copy->mesh - 1];
        *scale = fmax(*scale, fabs(mat4_determinant(&copy->transforms[0])));
    }
}

/* Absorption after Beer: attenuation_color is what is left after attenuation_distance. */
static vec3 extinction_of(const world *w, const kiln_decoding *decoding, const kiln_material *m) {
    if (!(m->attenuation_distance > 0)) return v3_splat(0);
    vec3 left = decoding_apply(decoding, KILN_TRANSFER_LINEAR, m->attenuation_color);
    /* A distance next to nothing is black: finite, or a clear channel would be 0 · ∞. */
    float per_unit = fminf(1.0f / (m->attenuation_distance * (float)w->scale), 1e30f);
    const float least = 1e-9f; /* a colour of 0 absorbs all but a billionth over the distance */
    return v3(-logf(fminf(fmaxf(left.x, least), 1.0f)) * per_unit, -logf(fminf(fmaxf(left.y, least), 1.0f)) * per_unit,
              -logf(fminf(fmaxf(left.z, least), 1.0f)) * per_unit);
}

/* Single-scattering from multiple-scattering albedo: Kulla and Conty 2017, as KHR_materials_volume_scatter has it. */
static float single_albedo(float multiple) {
    double m = fmin(fmax((double)multiple, 0), 1);
    double root = 4.09712 + 4.20863 * m - sqrt(9.59217 + 41.6808 * m + 17.7126 * m * m);
    return (float)fmin(fmax(1 - root * root, 0), 1);
}
static vec3 albedo_of(const kiln_decoding *decoding, const kiln_material *m) {
    vec3 c = decoding_apply(decoding, KILN_TRANSFER_LINEAR, m->multiscatter_color);
    return v3(single_albedo(c.x), single_albedo(c.y), single_albedo(c.z));
}

static void set_medium(world *w, const kiln_decoding *decoding, const kiln_material *from, uint32_t number) {
    world_medium *m = &w->media[number];
    vec3 sigma = extinction_of(w, decoding, from);
    *m = (world_medium){.ior = from->ior > 0 ? fminf(from->ior, WORLD_IOR_MAX) : WORLD_IOR_MAX};
    if (from->layers & KILN_LAYER_DISPERSION) m->spread = fminf((m->ior - 1.0f) * from->dispersion / 20.0f, WORLD_IOR_MAX);
    v3_store(w->extinction + 3 * (size_t)number, sigma);
    vec3 albedo = from->layers & KILN_LAYER_VOLUME_SCATTER ? albedo_of(decoding, from) : v3_splat(0);
    m->scatters = v3_max(albedo) > 0 && v3_max(sigma) > 0;
    m->g = from->scatter_anisotropy;
    v3_store(w->albedo + 3 * (size_t)number, albedo);
    v3_store(w->absorption + 3 * (size_t)number, m->scatters ? v3_splat(0) : sigma);
}

/* A box of a copy with a solid material, in the scene's space. */
static box placed_box(const kiln_mesh *m, const mat4 *to) {
    box b = empty;
    for (int corner = 0; corner < 8; corner++) {
        double at_corner[3];
        for (int k = 0; k < 3; k++) at_corner[k] = (double)(corner >> k & 1 ? m->max : m->min)[k];
        dvec3 p = mat4_point(to, d3_load(at_corner));
        const double at[3] = {p.x, p.y, p.z};
        for (int k = 0; k < 3; k++) {
            b.low[k] = fminf(b.low[k], (float)at[k]), b.high[k] = fmaxf(b.high[k], (float)at[k]);
        }
    }
    return b;
}

/* Boxes that touch overlap, whatever rounding says. */
static bool boxes_meet(const box *a, const box *b) {
    for (int k = 0; k < 3; k++) {
        float slack = 1e-5f * (fmaxf(fabsf(a->low[k]), fabsf(a->high[k])) + fmaxf(fabsf(b->low[k]), fabsf(b->high[k])));
        if (a->low[k] > b->high[k] + slack || b->low[k] > a->high[k] + slack) return false;
    }
    return true;
}

/* Copies that are compared one with another; where there are more, some are taken to touch. */
enum { COMPARED = 512 };

static kiln_id find_touching(const kiln_scene *scene, const uint32_t *solids) {
    box boxes[COMPARED];
    int count = 0;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const kiln_instance *copy = &scene->instances[i];
        uint32_t own = solids[copy->mesh - 1];
        if (own > 1 || (own && count == COMPARED)) return i + 1;
        if (!own) continue;
        boxes[count] = placed_box(scene_mesh(scene, copy->mesh), &copy->transforms[0]);
        for (int k = 0; k < count; k++)
            if (boxes_meet(&boxes[k], &boxes[count])) return i + 1;
        count++;
    }
    return 0;
}

bool media_find_touching(const reduced_scene *scene, kiln_id *instance, kiln_report *report) {
    uint32_t *solids = array_alloc(scene->scene->mesh_count, sizeof *solids);
    uint32_t *stamps = array_alloc((size_t)scene->scene->material_count + 1, sizeof *stamps);
    kiln_id *found = array_alloc((size_t)scene->scene->material_count + 1, sizeof *found);
    bool room = solids && stamps && found;
    for (uint32_t i = 0; room && i < scene->scene->mesh_count; i++)
        if (scene->shown[i]) solids[i] = mesh_solids(scene, i + 1, stamps, found);
    *instance = room ? find_touching(scene->scene, solids) : 0;
    free(solids);
    free(stamps);
    free(found);
    return room || report_no_memory(report, "comparing solids");
}

static bool set_spectrum(world *w, const kiln_decoding *decoding) {
    if (!HOLDS(w, DISPERSION)) return true;
    w->spectrum = ARENA_ARRAY(&w->arena, float, SPECTRUM_FLOATS);
    if (w->spectrum) spectrum_make(decoding->matrix[KILN_TRANSFER_LINEAR], w->spectrum);
    return w->spectrum != NULL;
}

static void warn_if_open(const kiln_scene *scene, const kiln_mesh *m, kiln_id material, kiln_report *report) {
    size_t edges;
    if (!mesh_is_open(m, material, &edges)) return;
    kiln_where where = where_root(m->name);
    report_warning(report, KILN_CODE_GEOMETRY, &where,
                   "close the mesh and turn its faces outward, or give the material a thickness of 0",
                   "the material '%s' bounds a volume, but the mesh is open at %zu edges: where light goes in and never "
                   "out, or out and never in, the volume is guessed",
                   scene_material(scene, material)->name, edges);
}

/* What building needs for a while. */
typedef struct scratch {
    candidate *list;
    double *scales, *sizes; /* of meshes; of materials: of the largest copy */
    uint32_t *stamps;       /* of materials */
    kiln_id *found;
} scratch;

/* Every solid of every mesh: how large it is, and whether it is closed, as it must be. */
static void look_at_meshes(const reduced_scene *scene, scratch *s, kiln_report *report) {
    find_scales(scene->scene, s->scales);
    for (uint32_t i = 0; i < scene->scene->mesh_count; i++) {
        const kiln_mesh *m = &scene->scene->meshes[i];
        if (!(s->scales[i] > 0)) continue;
        uint32_t solids = mesh_solids(scene, i + 1, s->stamps, s->found);
        for (uint32_t k = 0; k < solids; k++) {
            kiln_id id = s->found[k];
            box part = material_box(m, id);
            s->sizes[id] = fmax(s->sizes[id], box_volume(&part) * s->scales[i]);
            warn_if_open(scene->scene, m, id, report);
        }
    }
}

static bool build(world *w, const reduced_scene *scene, const kiln_decoding *decoding, scratch *s, kiln_report *report) {
    candidate *list = s->list;
    int n = 0;
    for (uint32_t i = 0; i < w->material_count; i++) {
        const kiln_material *m = reduced_material(scene, i);
        if (scene->used[i] && material_is_solid(m)) list[n++] = (candidate){.material = i, .priority = m->priority};
    }
    if (n) look_at_meshes(scene, s, report);
    for (int i = 0; i < n; i++) list[i].size = s->sizes[list[i].material];
    if (n > 0xffff)
        return report_error(report, KILN_CODE_LIMIT, NULL, "merge materials that are equal",
                            "more than 65,535 materials bound a volume");
    qsort(list, (size_t)n, sizeof *list, by_rank);
    w->media = ARENA_ARRAY(&w->arena, world_medium, (size_t)n + 1);
    w->extinction = ARENA_ARRAY(&w->arena, float, 3 * ((size_t)n + 1));
    w->absorption = ARENA_ARRAY(&w->arena, float, 3 * ((size_t)n + 1));
    w->albedo = ARENA_ARRAY(&w->arena, float, 3 * ((size_t)n + 1));
    if (!w->media || !w->extinction || !w->absorption || !w->albedo) return report_no_memory(report, "building media");
    w->media[0].ior = 1;
    w->media_count = (uint32_t)n + 1;
    for (int i = 0; i < n; i++) {
        w->materials[list[i].material].medium = (uint32_t)i + 1;
        set_medium(w, decoding, reduced_material(scene, list[i].material), (uint32_t)i + 1);
    }
    return set_spectrum(w, decoding) || report_no_memory(report, "building media");
}

bool world_build_media(world *w, const reduced_scene *scene, const kiln_decoding *decoding, kiln_report *report) {
    scratch s = {.list = array_alloc(w->material_count, sizeof *s.list),
                 .scales = array_alloc(scene->scene->mesh_count, sizeof *s.scales),
                 .sizes = array_alloc(w->material_count, sizeof *s.sizes),
                 .stamps = array_alloc(w->material_count, sizeof *s.stamps),
                 .found = array_alloc(w->material_count, sizeof *s.found)};
    bool room = s.list && s.scales && s.sizes && s.stamps && s.found;
    bool done = room ? build(w, scene, decoding, &s, report) : report_no_memory(report, "building media");
    free(s.list);
    free(s.scales);
    free(s.sizes);
    free(s.stamps);
    free(s.found);
    return done;
}
