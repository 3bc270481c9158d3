/* render/world/lights.c: everything that emits, in render space, and the distributions to choose by. */
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "render/light/parallelogram.h"
#include "render/light/tree.h"
#include "render/world/environment.h"
#include "render/world/lookup.h"
#include "scene/transfer.h"

typedef struct build {
    world *world;
    const kiln_scene *scene;
    uint64_t removed;
    const kiln_decoding *decoding;
    float *power;    /* by light: what it gives off, up to a constant */
    uint32_t *group; /* by light: which belong together: the triangles of a material, a punctual light, the environment */
    uint32_t groups;
    uint32_t threads;
    kiln_report *report;
} build;

static bool triangle_emits(const world *w, uint32_t triangle) {
    const world_material *m = &w->materials[w->triangle_material[triangle]];
    bool lit = m->emission[0] > 0 || m->emission[1] > 0 || m->emission[2] > 0;
    return lit && !(m->flags & MATERIAL_UNLIT);
}

static void load_triangle(const world *w, const world_instance *copy, uint32_t triangle, vec3 p[3]) {
    const uint32_t *v = w->triangles + 3 * (size_t)triangle;
    for (int k = 0; k < 3; k++) p[k] = world_instance_point(copy, v3_load(w->vertices[v[k]].p));
}

/* Do a triangle and the next one make a parallelogram that shines evenly? Judged before it is placed: a copy of a
 * parallelogram is one. */
static bool makes_pair(const world *w, uint32_t triangle, int *apex, float *off) {
    bool alike = w->triangle_material[triangle] == w->triangle_material[triangle + 1];
    const world_material *m = &w->materials[w->triangle_material[triangle]];
    bool whole = m->opacity >= 1.0f && !m->texture[SLOT_OPACITY] && !w->colors;
    bool covers = whole || !(m->flags & (MATERIAL_MASK | MATERIAL_BLEND));
    vec3 a[3], b[3];
    if (!alike || !covers || m->texture[SLOT_EMISSION] || m->clearcoat > 0.0f) return false;
    load_triangle(w, &w->instances[0], triangle, a);
    load_triangle(w, &w->instances[0], triangle + 1, b);
    return parallelogram_make(a, b, apex, off);
}

/* Numbers the emitters of [first, first + count): triangles, of pairs both alike; returns how many there are. */
static uint32_t number_emitters(world *w, uint32_t first, uint32_t count, uint32_t number) {
    uint32_t before = number;
    int apex;
    float off;
    for (uint32_t t = first; t < first + count; t++) {
        w->triangle_light[t] = triangle_emits(w, t) ? number++ : LIGHT_NONE;
        bool pair = w->triangle_light[t] != LIGHT_NONE && t + 1 < first + count && makes_pair(w, t, &apex, &off);
        if (pair) w->triangle_light[t + 1] = w->triangle_light[t], t++;
    }
    return number - before;
}

/* All emitting triangles with all their copies. Without any, no array is kept. */
static bool count_triangles(build *b, uint64_t *total) {
    world *w = b->world;
    *total = 0;
    bool any = false;
    for (uint32_t t = 0; t < w->triangle_count && !any; t++) any = triangle_emits(w, t);
    if (!any) return true;
    w->triangle_light = ARENA_ARRAY(&w->arena, uint32_t, w->triangle_count);
    uint32_t *by_prototype = array_alloc((size_t)w->prototype_count + 1, sizeof *by_prototype);
    if (!w->triangle_light || !by_prototype) {
        free(by_prototype);
        return report_no_memory(b->report, "building lights");
    }
    *total = number_emitters(w, 0, w->baked.count[0] + w->baked.count[1], 0);
    for (uint32_t p = 0; p < w->prototype_count; p++) {
        const world_prototype *proto = &w->prototypes[p];
        by_prototype[p] = number_emitters(w, proto->first[0], proto->count[0] + proto->count[1], 0);
    }
    for (uint32_t i = 1; i < w->instance_count; i++) {
        w->instances[i].light_base = (uint32_t)*total;
        *total += by_prototype[w->instances[i].prototype];
    }
    free(by_prototype);
    return true;
}

/* Texels of a texture that a triangle covers. */
static float covered_texels(const world *w, uint32_t triangle, material_slot slot) {
    uint32_t handle = w->materials[w->triangle_material[triangle]].texture[slot];
    if (!handle) return 0.0f;
    const world_texture *t = &w->textures[handle - 1];
    vec2 a = lookup_uv(w, triangle, t->uv_set, (vec2){0, 0}), b = lookup_uv(w, triangle, t->uv_set, (vec2){1, 0});
    vec2 c = lookup_uv(w, triangle, t->uv_set, (vec2){0, 1});
    return fabsf((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) * (float)t->width * (float)t->height;
}

/* The cosine at which a clear coat lets through what it lets through in the mean: Schlick's mean is 1/21. */
#define MEAN_COSINE 0.456f

/* Mean of what emission is multiplied with over a triangle, on a regular grid about as fine as the texels. */
static float mean_emission(const world *w, const light *l) {
    if (!l->varies) return 1.0f;
    uint32_t triangle = l->varies - 1;
    float texels = fmaxf(covered_texels(w, triangle, SLOT_EMISSION), covered_texels(w, triangle, SLOT_OPACITY));
    int n = texels < 4.0f ? 2 : texels > 4096.0f ? 64 : (int)ceilf(sqrtf(texels));
    float sum = 0, points = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n - i; j++) {
            vec2 at = {((float)i + 0.3333f) / (float)n, ((float)j + 0.3333f) / (float)n};
            sum += v3_dot(lookup_emission(w, triangle, at, MEAN_COSINE), l->radiance);
            points += l->radiance.x + l->radiance.y + l->radiance.z;
        }
    return points > 0 ? sum / points : 0.0f;
}

static light triangle_light(const world *w, const world_instance *copy, uint32_t triangle, bool pair) {
    const world_material *m = &w->materials[w->triangle_material[triangle]];
    vec3 p[3];
    int apex = 0;
    float reach = copy->magnitude, off;
    light l = {.kind = LIGHT_TRIANGLE, .radiance = v3_load(m->emission),
               .owner = w->triangle_material[triangle], .varies = !pair && lookup_emission_varies(w, triangle) ? triangle + 1 : 0,
               .medium = m->medium,
               .two_sided = m->flags & MATERIAL_TWO_SIDED ? 1.0f : 0.0f};
    load_triangle(w, copy, triangle, p);
    for (int k = 0; k < 3; k++) reach = fmaxf(reach, v3_max(v3_abs(p[k])));
    if (pair) (void)makes_pair(w, triangle, &apex, &off);
    l.quad = pair ? 1.0f : 0.0f;
    l.position = p[apex];
    l.e1 = v3_sub(p[(apex + 1) % 3], l.position);
    l.e2 = v3_sub(p[(apex + 2) % 3], l.position);
    vec3 n = v3_scale(v3_cross(l.e1, l.e2), copy->side);
    float twice = v3_length(n);
    l.area = pair ? twice : 0.5f * twice;
    if (twice > 0) l.axis = v3_scale(n, 1.0f / twice);
    l.error = reach * 0x1p-20f; /* a dozen roundings of 2⁻²⁴ */
    if (pair) l.error += 0x1p-18f * (v3_length(l.e1) + v3_length(l.e2)); /* parallelogram_make's */
    return l;
}

static void add_triangles(build *b) {
    world *w = b->world;
    for (uint32_t i = 0; i < w->instance_count; i++) {
        const world_instance *copy = &w->instances[i];
        const world_prototype *p = i ? &w->prototypes[copy->prototype] : &w->baked;
        uint32_t end = p->first[0] + p->count[0] + p->count[1];
        for (uint32_t t = p->first[0]; t < end; t++) {
            uint32_t number = w->triangle_light[t];
            if (number == LIGHT_NONE) continue;
            bool pair = t + 1 < end && w->triangle_light[t + 1] == number;
            w->lights.lights[copy->light_base + number] = triangle_light(w, copy, t, pair);
            b->group[copy->light_base + number] = w->triangle_material[t];
            t += pair;
        }
    }
}

/* KHR_lights_punctual, 'Inner and outer cone angles': clamp(cos scale + offset)², 1 inside the inner cone. */
static void set_spot(light *l, const kiln_light *from) {
    float inner = cosf(from->inner_cone_rad), outer = cosf(from->outer_cone_rad);
    l->spot_scale = 1.0f / fmaxf(0.001f, inner - outer);
    l->spot_offset = -outer * l->spot_scale;
}

static light punctual_light(const build *b, const kiln_light *from) {
    mat4 m = mat4_load(from->transform);
    dvec3 axis = d3_normalize(mat4_vector(&m, (dvec3){0, 0, -1}));
    light l = {.kind = from->kind == KILN_LIGHT_POINT  ? LIGHT_POINT
                       : from->kind == KILN_LIGHT_SPOT ? LIGHT_SPOT
                                                       : LIGHT_DISTANT,
               .position = to_float(world_point(b->world, d3_load(from->transform + 12))),
               .axis = to_float(axis),
               .radiance = v3_scale(decoding_apply(b->decoding, KILN_TRANSFER_LINEAR, from->color), from->intensity)};
    if (l.kind == LIGHT_SPOT) set_spot(&l, from);
    if (l.kind != LIGHT_DISTANT) {
        /* I/d² in metres is I s²/(s d)² in render space. */
        l.radiance = v3_scale(l.radiance, (float)(b->world->scale * b->world->scale));
    } else if (from->angle_rad > 0) {
        double half = 0.5 * (double)from->angle_rad, s = sin(half), q = sin(0.5 * half);
        l.one_minus_cos = (float)(2 * q * q);
        l.radiance = v3_scale(l.radiance, (float)(1 / (M_PI * s * s))); /* E = π sin² L */
    }
    return l;
}

static float light_power(const build *b, const light *l) {
    const float pi = 3.14159265f;
    const world *w = b->world;
    float mean = (l->radiance.x + l->radiance.y + l->radiance.z) / 3.0f, disk = pi * w->radius * w->radius;
    switch (l->kind) {
    case LIGHT_TRIANGLE: return pi * l->area * mean * mean_emission(w, l) * (1.0f + l->two_sided);
    case LIGHT_POINT: return 4.0f * pi * mean;
    case LIGHT_SPOT: return 2.0f * pi * (1.0f + l->spot_offset / l->spot_scale) * mean; /* 1 − cos of the outer cone */
    case LIGHT_DISTANT: {
        float h = l->one_minus_cos;
        return disk * mean * (h > 0 ? pi * h * (2.0f - h) : 1.0f);
    }
    case LIGHT_ENVIRONMENT: return disk * w->lights.environment.total;
    case LIGHT_KINDS: break;
    }
    return 0;
}

enum { CHUNK = 256 };

static void measure_power(void *context, size_t chunk, uint32_t thread) {
    (void)thread;
    build *b = context;
    size_t end = (chunk + 1) * CHUNK;
    for (size_t i = chunk * CHUNK; i < end && i < b->world->lights.count; i++) {
        float power = light_power(b, &b->world->lights.lights[i]);
        b->power[i] = power > 0 && power < INFINITY ? power : 0.0f;
    }
}

/* A way of choosing among so many lights, unless nothing has a chance, or there is one alone. */
static bool add_choice(build *b, light_choice choice, const float *weights, uint32_t count) {
    light_table *t = &b->world->lights;
    for (uint32_t i = 0; i < count; i++) t->any[choice] |= weights[i] > 0;
    if (!t->any[choice] || (t->count == 1 && !HOLDS(b->world, MANY_LIGHTS))) return true;
    t->cdf[choice] = ARENA_ARRAY(&b->world->arena, uint32_t, (size_t)count + 1);
    t->guide[choice] = ARENA_ARRAY(&b->world->arena, uint32_t, count);
    if (!t->cdf[choice] || !t->guide[choice]) return false;
    distribution_build(weights, count, t->cdf[choice], t->guide[choice]);
    return true;
}

/* Of a light that has a place: along its normals, times distance², what a surface that faces it receives; of others that
 * irradiance itself, of surroundings a mean over the ways that a surface may face. */
static float light_intensity(const build *b, uint32_t i) {
    const light *l = &b->world->lights.lights[i];
    const float pi = 3.14159265f, disk = pi * b->world->radius * b->world->radius;
    switch (l->kind) {
    case LIGHT_TRIANGLE: return b->power[i] / (pi * (1.0f + l->two_sided));
    case LIGHT_POINT:
    case LIGHT_SPOT: return b->power[i] > 0 ? (l->radiance.x + l->radiance.y + l->radiance.z) / 3.0f : 0.0f;
    case LIGHT_DISTANT: return disk > 0 ? b->power[i] / disk : 0.0f;
    case LIGHT_ENVIRONMENT: return 0.25f * b->world->lights.environment.total;
    case LIGHT_KINDS: break;
    }
    return 0;
}

/* Do places tell lights apart? Not a single one from those that have none, whose share power judges as well for less;
 * nor two triangles of one material, which are the halves of a lamp. A tree that is forced on a scene is built for
 * whatever there is. */
static bool wants_tree(const build *b) {
    const light_table *t = &b->world->lights;
    bool forced = !HAS(b->world->plan.called, MANY_LIGHTS);
    bool alone = t->near_count < 2 || (t->near_count == 2 && b->group[0] == b->group[1]);
    return HOLDS(b->world, MANY_LIGHTS) && (forced || !alone);
}

/* Over the lights that have a place, where a place tells them apart. */
static bool add_tree(build *b, float *intensity) {
    world *w = b->world;
    light_table *t = &w->lights;
    double near = 0, far = 0;
    if (!wants_tree(b)) return true;
    for (uint32_t i = 0; i < t->count; i++) {
        intensity[i] = light_intensity(b, i);
        *(i < t->near_count ? &near : &far) += (double)intensity[i];
    }
    if (!(near > 0)) return true;
    t->far = far > 0 ? fmaxf((float)(far / near), 0x1p-100f) : 0;
    t->tree = light_tree_build(&w->arena, t->lights, intensity, t->near_count);
    return t->tree != NULL;
}

/* Half by power; half alike among groups, by power within each. Power alone would starve a small lamp beside what it
 * lights when a strong one shines from afar (Veach's plates: 4 times the error). */
static void blend_by_group(const build *b, uint32_t first, float *weights) {
    uint32_t count = b->world->lights.count, lit = 0;
    double *sums = array_alloc(b->groups, sizeof *sums), total = 0;
    if (!sums) { /* power alone will do */
        memcpy(weights, b->power + first, (count - first) * sizeof *weights);
        return;
    }
    for (uint32_t i = first; i < count; i++) sums[b->group[i]] += (double)b->power[i];
    for (uint32_t g = 0; g < b->groups; g++) total += sums[g], lit += sums[g] > 0;
    for (uint32_t i = first; i < count; i++) {
        double power = (double)b->power[i], group = sums[b->group[i]];
        weights[i - first] = power > 0 ? (float)(power / total + power / (group * lit)) : 0.0f;
    }
    free(sums);
}

static bool add_choices(build *b, float *weights) {
    light_table *t = &b->world->lights;
    blend_by_group(b, 0, weights);
    if (!add_choice(b, CHOOSE_BY_POWER, weights, t->count)) return false;
    blend_by_group(b, t->near_count, weights);
    if (!add_choice(b, CHOOSE_FAR, weights, t->count - t->near_count) || !add_tree(b, weights)) return false;
    for (uint32_t i = 0; i < t->count; i++) weights[i] = b->power[i] > 0 ? 1.0f : 0.0f;
    if (!add_choice(b, CHOOSE_UNIFORMLY, weights, t->count)) return false;
    for (uint32_t i = 0; i < t->count; i++) {
        const light *l = &t->lights[i];
        bool hittable = l->kind == LIGHT_TRIANGLE || l->kind == LIGHT_ENVIRONMENT ||
                        (l->kind == LIGHT_DISTANT && l->one_minus_cos > 0);
        if (hittable) weights[i] = 0;
    }
    return add_choice(b, CHOOSE_POINTS, weights, t->count);
}

static bool build_choices(build *b) {
    light_table *t = &b->world->lights;
    float *weights = array_alloc(t->count, sizeof *weights);
    b->power = array_alloc(t->count, sizeof *b->power);
    bool added = weights && b->power;
    if (added) {
        threads_for(b->threads, (t->count + CHUNK - 1) / CHUNK, measure_power, b);
        added = add_choices(b, weights);
    }
    free(weights);
    return added;
}

/* Kinds of lights that kernels are to be ready for though the scene has none. */
static uint32_t imposed_kinds(uint64_t effects) {
    uint32_t kinds = HAS(effects, AREA_LIGHTS) ? 1u << LIGHT_TRIANGLE : 0;
    if (HAS(effects, PUNCTUAL_LIGHTS)) kinds |= 1u << LIGHT_POINT | 1u << LIGHT_SPOT | 1u << LIGHT_DISTANT;
    if (HAS(effects, SUNS)) kinds |= 1u << LIGHT_DISTANT;
    if (HAS(effects, ENVIRONMENT)) kinds |= 1u << LIGHT_ENVIRONMENT;
    return kinds;
}

static void add_punctual(build *b, bool distant) {
    light_table *t = &b->world->lights;
    for (uint32_t i = 0; i < b->scene->light_count; i++) {
        const kiln_light *from = &b->scene->lights[i];
        if ((from->kind == KILN_LIGHT_DISTANT) != distant || !(light_effects(from) & ~b->removed)) continue;
        light l = punctual_light(b, from);
        l.owner = i + 1;
        if (distant && l.one_minus_cos > 0) t->distant[t->distant_count++] = t->count;
        b->group[t->count] = b->groups++;
        t->lights[t->count++] = l;
    }
}

static bool add_all(build *b, uint64_t triangles) {
    world *w = b->world;
    light_table *t = &w->lights;
    uint64_t total = triangles + b->scene->light_count + 1;
    if (total >= DISTRIBUTION_QUANTA / 2)
        return report_error(b->report, KILN_CODE_LIMIT, NULL, "let fewer triangles emit",
                            "%llu triangles emit light; kiln samples at most 8 million",
                            (unsigned long long)triangles);
    t->lights = ARENA_ARRAY(&w->arena, light, total);
    t->distant = ARENA_ARRAY(&w->arena, uint32_t, (size_t)b->scene->light_count + 1);
    b->group = array_alloc(total, sizeof *b->group);
    b->groups = w->material_count;
    if (!t->lights || !t->distant || !b->group) return report_no_memory(b->report, "building lights");
    if (triangles) add_triangles(b);
    t->count = (uint32_t)triangles;
    add_punctual(b, false);
    t->near_count = t->count;
    add_punctual(b, true);
    if (HAS(w->plan.called, ENVIRONMENT) && !environment_build(w, b->scene, b->decoding, b->report)) return false;
    if (t->environment.present) {
        t->environment.light = t->count;
        b->group[t->count] = b->groups++;
        t->lights[t->count++] = (light){.kind = LIGHT_ENVIRONMENT};
    }
    for (uint32_t i = 0; i < t->count; i++) {
        t->kinds |= 1u << t->lights[i].kind;
        t->bounds |= t->lights[i].medium != 0;
    }
    t->kinds |= imposed_kinds(effects_imposed(&w->plan.asked));
    return build_choices(b) || report_no_memory(b->report, "building lights");
}

bool world_build_lights(world *w, const reduced_scene *scene, const kiln_decoding *decoding, uint32_t threads,
                        kiln_report *report) {
    build b = {.world = w, .scene = scene->scene, .removed = scene->removed, .decoding = decoding, .threads = threads,
               .report = report};
    uint64_t triangles;
    bool done = count_triangles(&b, &triangles) && add_all(&b, triangles);
    free(b.power);
    free(b.group);
    return done;
}
