#include "render/effects/scan.h"

#include <stdlib.h>
#include <string.h>

#include "render/effects/reduce.h"
#include "render/light/parallelogram.h"
#include "render/light/tree.h"
#include "render/world/media.h"
#include "render/world/slots.h"
#include "render/world/spectrum.h"

bool transform_shows(const mat4 *m) {
    dvec3 x = d3_load(m->m), y = d3_load(m->m + 4), z = d3_load(m->m + 8);
    double longest = fmax(d3_length(x), fmax(d3_length(y), d3_length(z)));
    double area = fmax(d3_length(d3_cross(y, z)), fmax(d3_length(d3_cross(z, x)), d3_length(d3_cross(x, y))));
    return area > 0x1p-50 * longest * longest; /* rounding leaves 2⁻⁵² of what was turned before it was flattened */
}

/* Which materials are on something that is shown. */
static void mark_used(reduced_scene *r) {
    const kiln_scene *s = r->scene;
    for (uint32_t i = 0; i < s->instance_count; i++)
        if (transform_shows(&s->instances[i].transforms[0])) r->shown[s->instances[i].mesh - 1]++;
    for (uint32_t i = 0; i < s->mesh_count; i++) {
        const kiln_mesh *m = &s->meshes[i];
        if (!r->shown[i]) continue;
        if (!m->face_materials) r->used[m->material] = true;
        for (uint32_t f = 0; m->face_materials && f < m->face_count; f++) r->used[m->face_materials[f]] = true;
    }
}

static const kiln_primvar *colors_of(const reduced_scene *r, uint32_t mesh) {
    bool wanted = r->shown[mesh] && !HAS(r->removed, VERTEX_COLORS);
    return wanted ? mesh_primvar(&r->scene->meshes[mesh], KILN_PRIMVAR_COLOR, 0) : NULL;
}

static void find_color_alpha(reduced_scene *r) {
    for (uint32_t i = 0; i < r->scene->mesh_count; i++) {
        const kiln_mesh *m = &r->scene->meshes[i];
        const kiln_primvar *p = colors_of(r, i);
        float least = 1;
        for (uint32_t k = 0; p && k < p->value_count; k++) least = fminf(least, p->values[4 * (size_t)k + 3]);
        for (uint32_t f = 0; least < 1 && f < m->face_count; f++) {
            float *alpha = &r->color_alpha[mesh_face_material(m, f)];
            *alpha = fminf(*alpha, least);
        }
    }
}

bool reduced_make(reduced_scene *r, const kiln_scene *scene, uint64_t removed, kiln_report *report) {
    size_t count = (size_t)scene->material_count + 1;
    *r = (reduced_scene){.scene = scene,
                         .removed = removed,
                         .materials = array_alloc(count, sizeof *r->materials),
                         .used = array_alloc(count, sizeof *r->used),
                         .color_alpha = array_alloc(count, sizeof *r->color_alpha),
                         .shown = array_alloc(scene->mesh_count, sizeof *r->shown)};
    if (!r->materials || !r->used || !r->color_alpha || !r->shown) return report_no_memory(report, "reading the scene");
    for (size_t i = 0; i < count; i++) r->color_alpha[i] = 1;
    mark_used(r);
    find_color_alpha(r);
    reduced_update(r, NULL);
    return true;
}

void reduced_free(reduced_scene *r) {
    free(r->materials);
    free(r->used);
    free(r->color_alpha);
    free(r->shown);
}

void reduced_update(reduced_scene *r, const world_image *images) {
    for (uint32_t i = 0; i <= r->scene->material_count; i++) {
        r->materials[i] = *scene_material(r->scene, i);
        const reduction by = {images, r->removed, r->color_alpha[i]};
        if (r->used[i]) material_reduce(&r->materials[i], &by);
    }
}

static void scan_materials(const reduced_scene *r, const world_image *images, kiln_texture_filter filter,
                           kiln_effect_plan *plan) {
    for (uint32_t i = 0; i <= r->scene->material_count; i++) {
        if (!r->used[i]) continue;
        const kiln_material *m = &r->materials[i];
        uint64_t effects = material_effects(m, images) | slots_effects(m, images, filter);
        plan_call(plan, effects & ~r->removed, (kiln_effect_caller){KILN_CALLED_BY_MATERIAL, i, m->name});
    }
}

static bool has_colors(const reduced_scene *r, uint32_t mesh) {
    const kiln_primvar *p = colors_of(r, mesh);
    for (size_t k = 0; p && k < 4 * (size_t)p->value_count; k++)
        if (p->values[k] != 1.0f) return true;
    return false;
}

static bool mesh_moves(const kiln_mesh *m) {
    size_t floats = 3 * (size_t)m->vertex_count;
    for (uint32_t t = 1; t < m->time_count; t++)
        if (memcmp(m->positions, m->positions + t * floats, floats * sizeof *m->positions) != 0) return true;
    return false;
}

static bool instance_moves(const kiln_scene *s, const kiln_instance *i) {
    if (scene_mesh(s, i->mesh)->time_count > 1 && mesh_moves(scene_mesh(s, i->mesh))) return true;
    for (uint32_t t = 1; t < i->time_count; t++)
        if (memcmp(&i->transforms[0], &i->transforms[t], sizeof i->transforms[t]) != 0) return true;
    return false;
}

static void scan_meshes(const reduced_scene *r, kiln_effect_plan *plan) {
    for (uint32_t i = 0; i < r->scene->mesh_count; i++) {
        const kiln_mesh *m = &r->scene->meshes[i];
        if (!r->shown[i]) continue;
        uint64_t effects = mesh_primvar(m, KILN_PRIMVAR_NORMAL, 0) ? EFFECT(SMOOTH_NORMALS) : 0;
        if (has_colors(r, i)) effects |= EFFECT(VERTEX_COLORS);
        plan_call(plan, effects & ~r->removed, (kiln_effect_caller){KILN_CALLED_BY_MESH, i + 1, m->name});
    }
    for (uint32_t i = 0; i < r->scene->instance_count; i++) {
        const kiln_instance *copy = &r->scene->instances[i];
        if (instance_moves(r->scene, copy))
            plan_call(plan, EFFECT(MOTION), (kiln_effect_caller){KILN_CALLED_BY_INSTANCE, i + 1, copy->name});
    }
}

uint64_t light_effects(const kiln_light *l) {
    bool shines = l->intensity > 0 && (l->color[0] > 0 || l->color[1] > 0 || l->color[2] > 0);
    if (!shines) return 0;
    return l->kind == KILN_LIGHT_DISTANT && l->angle_rad > 0 ? EFFECT(SUNS) : EFFECT(PUNCTUAL_LIGHTS);
}

static bool environment_shines(const kiln_scene *s, const world_image *images) {
    const kiln_environment *e = &s->environment;
    const world_image *image = e->image && images && images[e->image - 1].looked_at ? &images[e->image - 1] : NULL;
    bool shines = false;
    for (int k = 0; s->has_environment && k < 3; k++) shines |= e->color[k] > 0 && (!image || image->high[k] > 0);
    return shines;
}

static uint64_t scan_lights(const reduced_scene *r, const world_image *images, kiln_effect_plan *plan) {
    uint64_t count = 0;
    for (uint32_t i = 0; i < r->scene->light_count; i++) {
        const kiln_light *l = &r->scene->lights[i];
        uint64_t effects = light_effects(l) & ~r->removed;
        plan_call(plan, effects, (kiln_effect_caller){KILN_CALLED_BY_LIGHT, i + 1, l->name});
        count += effects != 0;
    }
    if (HAS(r->removed, ENVIRONMENT) || !environment_shines(r->scene, images)) return count;
    plan_call(plan, EFFECT(ENVIRONMENT), (kiln_effect_caller){KILN_CALLED_BY_ENVIRONMENT, 0, "environment"});
    return count + 1;
}

/* Triangles of a mesh that are lights. */
static uint64_t lamps_of(const reduced_scene *r, const kiln_mesh *m) {
    uint64_t count = 0;
    if (!m->face_materials) return material_emits(&r->materials[m->material]) ? m->triangle_count : 0;
    for (uint32_t f = 0; f < m->face_count; f++)
        if (material_emits(&r->materials[m->face_materials[f]])) count += mesh_face_size(m, f) - 2;
    return count;
}

static void load_corners(const kiln_mesh *m, uint32_t first, int turn, vec3 p[3]) {
    for (int k = 0; k < 3; k++) p[k] = v3_load(m->positions + 3 * (size_t)m->face_vertices[first + (uint32_t)(turn + k) % 4]);
}

/* Are a mesh's first two triangles that shine halves of one lamp, as render/world/lights.c will find? */
static bool is_one_lamp(const reduced_scene *r, const world_image *images, kiln_texture_filter filter, const kiln_mesh *m) {
    uint32_t face = 0;
    while (!material_emits(&r->materials[mesh_face_material(m, face)])) face++;
    const kiln_material *lamp = &r->materials[mesh_face_material(m, face)];
    bool quad = m->face_offsets && mesh_face_size(m, face) == 4;
    uint32_t first = m->face_offsets ? m->face_offsets[face] : 3 * face;
    int apex;
    float off;
    vec3 a[3], b[3];
    if (HAS(material_effects(lamp, images) | slots_effects(lamp, images, filter), TEXTURED_LIGHTS)) return false;
    if (!quad && (m->face_offsets || mesh_face_material(m, face + 1) != mesh_face_material(m, face))) return false;
    load_corners(m, first, 0, a);
    if (quad) load_corners(m, first, 2, b);
    else load_corners(m, first + 3, 0, b);
    return parallelogram_make(a, b, &apex, &off);
}

/* One light of any sort needs no choice; others: lights that are no triangles. */
static void scan_choice(const reduced_scene *r, const world_image *images, kiln_texture_filter filter, uint64_t others,
                        kiln_effect_plan *plan) {
    uint64_t count = others;
    bool lamps = plan->uses[KILN_EFFECT_AREA_LIGHTS].called;
    for (uint32_t i = 0; lamps && count < 2 && i < r->scene->mesh_count; i++)
        if (r->shown[i]) {
            const kiln_mesh *m = &r->scene->meshes[i];
            uint64_t triangles = lamps_of(r, m);
            count += r->shown[i] * (triangles == 2 && is_one_lamp(r, images, filter, m) ? 1 : triangles);
        }
    if (count < 2 || HAS(r->removed, MANY_LIGHTS)) return;
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) {
        const uint64_t shining = EFFECT(AREA_LIGHTS) | EFFECT(PUNCTUAL_LIGHTS) | EFFECT(SUNS) | EFFECT(ENVIRONMENT);
        const kiln_effect_use *use = &plan->uses[e];
        for (uint32_t k = 0; shining >> e & 1 && k < use->caller_count && k < KILN_EFFECT_CALLERS; k++)
            plan_call(plan, EFFECT(MANY_LIGHTS), use->callers[k]);
    }
}

static bool scan_solids(const reduced_scene *r, kiln_effect_plan *plan, kiln_report *report) {
    kiln_id touching = 0;
    if (!plan->uses[KILN_EFFECT_SOLIDS].called || HAS(r->removed, NESTED_MEDIA)) return true;
    if (!media_find_touching(r, &touching, report)) return false;
    const kiln_instance *copy = touching ? scene_instance(r->scene, touching) : NULL;
    if (copy) plan_call(plan, EFFECT(NESTED_MEDIA), (kiln_effect_caller){KILN_CALLED_BY_INSTANCE, touching, copy->name});
    return true;
}

/* Memory that is held for effects: of images as they will be kept, of each mesh once. */
static void measure(const reduced_scene *r, const world_image *images, kiln_effect_plan *plan) {
    enum { PYRAMID_SHARE = 3, TANGENT_BYTES = 16, COLOR_BYTES = 16, NODE_LIGHTS = 3 }; /* as trees are on the average */
    uint64_t vertices = 0, lamps = 0, bytes[KILN_EFFECT_COUNT] = {0};
    for (uint32_t i = 0; i < r->scene->mesh_count; i++) {
        if (!r->shown[i]) continue;
        vertices += r->scene->meshes[i].vertex_count;
        lamps += r->shown[i] * lamps_of(r, &r->scene->meshes[i]);
    }
    for (uint32_t i = 0; images && i < r->scene->image_count; i++) {
        const world_image *image = &images[i];
        uint64_t texels = (uint64_t)image->width * image->height, size = texel_bytes(image->format);
        uint64_t above = image->format == KILN_PIXELS_U8 ? texel_bytes(KILN_PIXELS_U16) : size;
        if (image->wanted) bytes[KILN_EFFECT_TEXTURES] += texels * size;
        if (image->filtered) bytes[KILN_EFFECT_TEXTURE_FILTERING] += texels * above / PYRAMID_SHARE;
    }
    bytes[plan->uses[KILN_EFFECT_NORMAL_MAPS].called ? KILN_EFFECT_NORMAL_MAPS : KILN_EFFECT_ANISOTROPY] =
        TANGENT_BYTES * vertices;
    bytes[KILN_EFFECT_VERTEX_COLORS] = COLOR_BYTES * vertices;
    bytes[KILN_EFFECT_AREA_LIGHTS] = lamps * sizeof(light);
    bytes[KILN_EFFECT_MANY_LIGHTS] = lamps * (sizeof(light_node) / NODE_LIGHTS + sizeof(uint64_t));
    bytes[KILN_EFFECT_DISPERSION] = SPECTRUM_FLOATS * sizeof(float);
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) plan->uses[e].bytes = plan->uses[e].called ? bytes[e] : 0;
}

bool scan_scene(const reduced_scene *r, const world_image *images, kiln_texture_filter filter, kiln_effect_plan *plan,
                kiln_report *report) {
    memset(plan->uses, 0, sizeof plan->uses);
    scan_materials(r, images, filter, plan);
    scan_meshes(r, plan);
    scan_choice(r, images, filter, scan_lights(r, images, plan), plan);
    bool done = scan_solids(r, plan, report);
    measure(r, images, plan);
    plan_settle(plan);
    return done;
}

void scan_camera(const kiln_scene *s, const kiln_camera *c, kiln_effect_plan *plan) {
    kiln_id id = 0;
    for (uint32_t i = 0; i < s->camera_count; i++)
        if (c == &s->cameras[i]) id = i + 1;
    plan_dismiss(plan, KILN_EFFECT_THIN_LENS);
    if (!c || !(c->lens_radius > 0) || HAS(plan->asked.removed, THIN_LENS)) return;
    plan_call(plan, EFFECT(THIN_LENS), (kiln_effect_caller){KILN_CALLED_BY_CAMERA, id, c->name ? c->name : ""});
    plan_settle(plan);
}
