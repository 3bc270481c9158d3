#include "tests/render/oracle.h"

#include "render/path/cone.h"
#include "render/path/flight.h"
#include "render/path/medium.h"
#include "render/path/roulette.h"
#include "render/path/shading.h"
#include "render/path/surface.h"
#include "render/path/touch.h"
#include "render/world/lookup.h"
#include "tests/render/oracle_choice.h"

/* One path, as it is between bounces. */
typedef struct path {
    sample_point point;
    vec3 origin, direction, throughput, radiance;
    float pdf, squeeze, near, far;
    bool dispersed; /* it has a wavelength */
    cone cone;
    vantage from; /* where it was last lit */
    uint64_t media;
    uint32_t depth, events; /* bounces; those of them that were in a medium, or no surface was there */
} path;

typedef struct hit {
    uint32_t triangle, instance;
    surface_point p;
    surface_triangle corners;
    float across; /* of the cone */
    int bumpy;    /* a normal map says something */
    surface_sides sides;
    const world_material *material;
    uint64_t beyond; /* media behind it */
    ray_crossing met;
} hit;

static vec2 draw(const path_context *c, const path *p, sample_purpose purpose) {
    return sample_pair(c->independent, p->point, purpose, p->depth);
}

static ray_coverage coverage_of(const path_context *c, const path *p, sample_purpose purpose) {
    return (ray_coverage){&p->point.seed, &p->point.index, sample_key(purpose, p->depth), c->independent};
}

static path start(const path_context *c, path_sample s) {
    path p = {.point = sample_point_make(c->seed, s.y << 16 | s.x, s.n), .squeeze = c->squeeze, .media = c->media};
    p.throughput = v3_splat(1.0f / c->squeeze);
    const world_medium *around = &c->world->media[medium_top(c->media)];
    if (around->spread > 0) {
        spectrum_line line = path_wavelength(c, p.point);
        float n = medium_ior(around, line.wavelength);
        p.throughput = v3_scale(line.weight, 1.0f / (n * n));
        p.squeeze = n * n;
        p.dispersed = true;
    }
    vec2 pixel = draw(c, &p, SAMPLE_PIXEL);
    float across = 2.0f / (float)c->width, down = 2.0f / (float)c->height;
    float x = (float)s.x + 0.5f + pixel_filter_offset(&c->filter, pixel.x);
    float y = (float)s.y + 0.5f + pixel_filter_offset(&c->filter, pixel.y);
    float u = x * across - 1.0f, v = 1.0f - y * down;
    camera_ray r = HAS(c->effects, THIN_LENS) ? camera_ray_at(&c->camera, u, v, draw(c, &p, SAMPLE_LENS))
                                              : camera_ray_of_pinhole(&c->camera, u, v);
    p.origin = r.origin, p.direction = r.direction, p.near = r.near, p.far = r.far;
    p.cone = cone_camera(&c->camera, 2.0f * c->camera.half_height / (float)c->height, p.direction);
    return p;
}

/* The triangle in render space, as the stages fetch it. */
static surface_triangle fetch(const world *w, const ray_crossing *c) {
    const uint32_t *i = w->triangles + 3 * (size_t)c->triangle;
    const world_vertex *a = &w->vertices[i[0]], *b = &w->vertices[i[1]], *d = &w->vertices[i[2]];
    const world_instance *copy = &w->instances[c->instance];
    surface_triangle tri = {.uv0 = {a->uv[0], a->uv[1]}, .uv1 = {b->uv[0], b->uv[1]}, .uv2 = {d->uv[0], d->uv[1]},
                            .side = copy->side, .magnitude = copy->magnitude, .embree = {c->u, c->v, c->t}};
    bool placed = c->instance != 0;
    tri.p0 = placed ? world_instance_point(copy, v3_load(a->p)) : v3_load(a->p);
    tri.p1 = placed ? world_instance_point(copy, v3_load(b->p)) : v3_load(b->p);
    tri.p2 = placed ? world_instance_point(copy, v3_load(d->p)) : v3_load(d->p);
    tri.n0 = placed ? world_instance_normal(copy, v3_load(a->n)) : v3_load(a->n);
    tri.n1 = placed ? world_instance_normal(copy, v3_load(b->n)) : v3_load(b->n);
    tri.n2 = placed ? world_instance_normal(copy, v3_load(d->n)) : v3_load(d->n);
    return tri;
}

static bool is_culled(const world *w, const path *p, const ray_crossing *c) {
    const world_material *m = &w->materials[w->triangle_material[c->triangle]];
    bool one_sided = !(m->flags & MATERIAL_TWO_SIDED);
    return one_sided && v3_dot(lookup_facing(w, c->triangle, c->instance), p->direction) > 0.0f;
}

typedef struct touch_visit { const world *world; vec3 direction; touch *touch; } touch_visit;
static void add_touch(void *user, uint32_t ray, const ray_crossing *c) {
    (void)ray;
    const touch_visit *v = user;
    touch_add(v->touch, v->world, v->direction, c);
}

/* Surfaces of solids that coincide with it become one; returns the media behind. */
static uint64_t merge(const path_context *c, const path *p, ray_crossing *met) {
    const world *w = c->world;
    if (!HAS(c->effects, NESTED_MEDIA) || !w->materials[w->triangle_material[met->triangle]].medium) return p->media;
    touch t = {0};
    float about = touch_distance(w, p->direction, met->triangle, met->instance);
    float near = fm_max(met->t - about, 0x1p-126f), far = met->t + about;
    touch_add(&t, w, p->direction, met);
    trace_counts counts = {0};
    ray_lanes ray = {&p->origin.x, &p->origin.y, &p->origin.z, &p->direction.x, &p->direction.y, &p->direction.z,
                     &near, &far, coverage_of(c, p, SAMPLE_COVERAGE), NULL, 1, false};
    touch_visit visit = {w, p->direction, &t};
    accel_visit(w, &ray, add_touch, &visit, &counts);
    *met = t.shaded;
    return touch_beyond(&t, p->media);
}

/* Closest hit, with single-sided surfaces that the camera sees from behind looked through. */
static bool find(const path_context *c, path *p, hit *h) {
    const world *w = c->world;
    trace_counts counts = {0};
    float near = p->depth ? 0x1p-126f : p->near, far = p->depth ? INFINITY : p->far;
    ray_lanes ray = {&p->origin.x, &p->origin.y, &p->origin.z, &p->direction.x, &p->direction.y, &p->direction.z,
                     &near, &far, coverage_of(c, p, SAMPLE_COVERAGE), NULL, 1, false};
    ray_crossing met;
    do {
        accel_closest(w, &ray, &met.t, &met.u, &met.v, &met.triangle, &met.instance, &counts);
        if (met.triangle >= TRIANGLE_REFUSED) return false;
        near = fm_next_up(met.t);
    } while (p->depth == 0 && is_culled(w, p, &met));
    h->beyond = merge(c, p, &met);
    surface_triangle tri = fetch(w, &met);
    h->met = met;
    h->triangle = met.triangle, h->instance = met.instance;
    h->p = surface_at(p->origin, p->direction, &tri);
    h->corners = tri;
    h->across = p->cone.width + p->cone.spread * h->p.hit.t;
    h->sides = HAS(c->effects, SMOOTH_NORMALS) ? surface_smooth_sides(&h->p, &tri, v3_neg(p->direction)) : surface_flat_sides(&h->p);
    h->material = &w->materials[w->triangle_material[h->triangle]];
    if (!HAS(c->effects, NESTED_MEDIA)) h->beyond = medium_cross(p->media, h->material->medium, h->p.front > 0.5f);
    return true;
}

static void collect(path *p, vec3 radiance, float weight) {
    p->radiance = v3_add(p->radiance, v3_mul(p->throughput, v3_scale(radiance, weight)));
}

static void escape(const path_context *c, path *p) {
    const light_table *t = &c->world->lights;
    if (p->depth == 0 && c->background == KILN_BACKGROUND_COLOR) collect(p, c->background_color, 1);
    if (p->depth == 0 && c->background != KILN_BACKGROUND_ENVIRONMENT) return;
    if (t->environment.present) {
        environment_value v = environment_look_up(&t->environment, environment_place(p->direction));
        float pdf = path_light_probability(c, t->environment.light, &p->from) * v.pdf;
        collect(p, v.radiance, estimate_hit_weight(estimate_hits_by(c->estimator, p->depth), p->pdf, pdf));
    }
    for (uint32_t k = 0; k < t->distant_count; k++) {
        const light *l = &t->lights[t->distant[k]];
        vec3 off = v3_add(p->direction, l->axis);
        if (0.5f * v3_dot(off, off) > l->one_minus_cos) continue;
        float pdf = path_light_probability(c, t->distant[k], &p->from) * light_distant_pdf(l->one_minus_cos);
        collect(p, l->radiance, estimate_hit_weight(estimate_hits_by(c->estimator, p->depth), p->pdf, pdf));
    }
}

static vec2 uv_of(const world *w, const hit *h, uint32_t set) {
    if (!set) return h->p.uv;
    const uint32_t *i = w->triangles + 3 * (size_t)h->triangle;
    const float *a = w->uvs[set] + 2 * (size_t)i[0], *b = w->uvs[set] + 2 * (size_t)i[1], *d = w->uvs[set] + 2 * (size_t)i[2];
    float b1 = h->p.hit.u, b2 = h->p.hit.v, b0 = 1.0f - b1 - b2;
    return (vec2){b0 * a[0] + b1 * b[0] + b2 * d[0], b0 * a[1] + b1 * b[1] + b2 * d[1]};
}

static texture_footprint footprint_of(const world *w, const hit *h, uint32_t set) {
    const surface_triangle *s = &h->corners;
    vec2 uv[3] = {s->uv0, s->uv1, s->uv2};
    for (size_t k = 0; set && k < 3; k++) {
        const float *at = w->uvs[set] + 2 * (size_t)w->triangles[3 * (size_t)h->triangle + k];
        uv[k] = (vec2){at[0], at[1]};
    }
    return cone_footprint(h->across, v3_sub(s->p1, s->p0), v3_sub(s->p2, s->p0),
                          (vec2){uv[1].x - uv[0].x, uv[1].y - uv[0].y}, (vec2){uv[2].x - uv[0].x, uv[2].y - uv[0].y});
}

static void mix4(const world *w, const hit *h, const float *values, float out[4]) {
    const uint32_t *i = w->triangles + 3 * (size_t)h->triangle;
    float b1 = h->p.hit.u, b2 = h->p.hit.v, b0 = 1.0f - b1 - b2;
    for (int k = 0; k < 4; k++)
        out[k] = b0 * values[4 * (size_t)i[0] + (size_t)k] + b1 * values[4 * (size_t)i[1] + (size_t)k] +
                 b2 * values[4 * (size_t)i[2] + (size_t)k];
}

/* The tangent in render space; w its handedness. 0: there is none. */
static vec3 tangent_of(const world *w, const hit *h, float *sign) {
    float tangent[4];
    *sign = 0;
    if (!w->tangents) return v3(0, 0, 0);
    mix4(w, h, w->tangents, tangent);
    const world_instance *copy = &w->instances[h->instance];
    *sign = w->tangents[4 * (size_t)w->triangles[3 * (size_t)h->triangle] + 3] * copy->side;
    return h->instance ? world_instance_vector(copy, v3_load(tangent)) : v3_load(tangent);
}

static vec3 map_of(texel x, float scale) {
    return v3((2.0f * x.r - 1.0f) * scale, (2.0f * x.g - 1.0f) * scale, 2.0f * x.b - 1.0f);
}

static void start_layers(surface *s, const world_material *m, const hit *h, vec2 *along) {
    bool both = m->thin > 0.5f, front = h->p.front > 0.5f;
    s->near = both || front ? 1.0f : 0.0f, s->far = both || !front ? 1.0f : 0.0f;
    s->anisotropy = m->anisotropy;
    *along = (vec2){m->anisotropy_x, m->anisotropy_y};
    s->film = m->film, s->film_ior = m->film_ior, s->film_thickness = m->film_thickness[1];
    s->clearcoat = m->clearcoat, s->clearcoat_roughness = m->clearcoat_roughness;
    s->sheen = v3_load(m->sheen), s->sheen_roughness = m->sheen_roughness;
    s->diffuse_transmission = m->diffuse_transmission;
    s->diffuse_transmission_color = v3_load(m->diffuse_transmission_color);
}

/* What a texture does to the layers. */
static void apply_layer(surface *s, const world_material *m, int slot, texel x, float one, vec2 *along, vec3 *coat) {
    vec3 rgb = {x.r, x.g, x.b};
    float u = 2.0f * x.r - 1.0f, v = 2.0f * x.g - 1.0f;
    if (slot == SLOT_CLEARCOAT) s->clearcoat *= one;
    if (slot == SLOT_CLEARCOAT_ROUGHNESS) s->clearcoat_roughness *= one;
    if (slot == SLOT_CLEARCOAT_NORMAL) *coat = map_of(x, m->clearcoat_normal_scale);
    if (slot == SLOT_SHEEN_COLOR) s->sheen = v3_mul(s->sheen, rgb);
    if (slot == SLOT_SHEEN_ROUGHNESS) s->sheen_roughness *= one;
    if (slot == SLOT_ANISOTROPY) {
        s->anisotropy *= x.b;
        *along = (vec2){u * m->anisotropy_x - v * m->anisotropy_y, u * m->anisotropy_y + v * m->anisotropy_x};
    }
    if (slot == SLOT_FILM) s->film *= one;
    if (slot == SLOT_FILM_THICKNESS) s->film_thickness = fm_lerp(m->film_thickness[0], m->film_thickness[1], one);
    if (slot == SLOT_DIFFUSE_TRANSMISSION) s->diffuse_transmission *= one;
    if (slot == SLOT_DIFFUSE_TRANSMISSION_COLOR)
        s->diffuse_transmission_color = v3_mul(s->diffuse_transmission_color, rgb);
}

/* Material constants times textures; the mapped normal, facing wo. */
static surface look_up(const path_context *c, hit *h, vec3 wo, vec3 *emission, vec3 *normal) {
    const world *w = c->world;
    const world_material *m = h->material;
    surface s = {.base = v3_load(m->base), .metallic = m->metallic, .roughness = m->roughness, .specular = m->specular,
                 .specular_color = v3_load(m->specular_color), .f0 = m->f0, .transmission = m->transmission,
                 .through = v3_splat(1), .eta = m->eta, .thin = m->thin};
    vec2 along;
    vec3 map = {0, 0, 0}, coat = {0, 0, 0};
    start_layers(&s, m, h, &along);
    *emission = v3_load(m->emission);
    if (w->colors) {
        float tint[4];
        mix4(w, h, w->colors, tint);
        vec3 *target = m->flags & MATERIAL_UNLIT ? emission : &s.base;
        *target = v3_mul(*target, v3_load(tint));
    }
    for (int slot = 0; slot < SLOT_COUNT; slot++) {
        if (!m->texture[slot]) continue;
        const world_texture *t = &w->textures[m->texture[slot] - 1];
        vec2 uv = uv_of(w, h, t->uv_set);
        int32_t level = texture_level(t, footprint_of(w, h, t->uv_set));
        texel x = texture_sample_level(t, uv.x, uv.y, level);
        float one = texture_channel_level(t, uv.x, uv.y, level);
        vec3 rgb = {x.r, x.g, x.b};
        if (slot == SLOT_BASE) s.base = v3_mul(s.base, rgb);
        if (slot == SLOT_EMISSION) *emission = v3_mul(*emission, rgb);
        if (slot == SLOT_SPECULAR_COLOR) s.specular_color = v3_mul(s.specular_color, rgb);
        if (slot == SLOT_METALLIC) s.metallic *= one;
        if (slot == SLOT_ROUGHNESS) s.roughness = m->flags & MATERIAL_GLOSSINESS ? 1.0f - s.roughness * one : s.roughness * one;
        if (slot == SLOT_SPECULAR) s.specular *= one;
        if (slot == SLOT_TRANSMISSION) s.transmission *= one;
        if (slot == SLOT_NORMAL) map = map_of(x, m->normal_scale);
        apply_layer(&s, m, slot, x, one, &along, &coat);
    }
    bool coated = s.clearcoat > 0 && w->slots & 1u << SLOT_CLEARCOAT_NORMAL;
    h->bumpy = map.x != 0.0f || map.y != 0.0f || coated;
    float sign;
    vec3 tangent = tangent_of(w, h, &sign);
    s.clearcoat_normal = surface_face(surface_map(*normal, tangent, sign, coat, h->p.front), wo);
    *normal = surface_face(surface_map(*normal, tangent, sign, map, h->p.front), wo);
    s.along = surface_along(*normal, tangent, sign, along.x, along.y, h->p.front);
    return s;
}

static float normal_reflectance(const world_material *m, float eta) { return m->f0 < 1.0f ? fresnel_normal(eta) : 1.0f; }

/* What the media on both sides make of it. */
static void bound(const path_context *c, path *p, const hit *h, surface *s, vec3 *emission) {
    const world *w = c->world;
    const world_material *m = h->material;
    if (m->medium) {
        spectrum_line line = {.wavelength = WAVELENGTH_D};
        if (w->spectrum) line = path_wavelength(c, p->point);
        medium_boundary at =
            medium_boundary_at(w->media, m->medium, p->media, h->beyond, h->p.front > 0.5f, line.wavelength);
        bool takes = !at.hidden && w->media[medium_top(h->beyond)].spread > 0 && !p->dispersed;
        s->through = takes ? v3_mul(s->base, line.weight) : s->base;
        if (takes) s->diffuse_transmission_color = v3_mul(s->diffuse_transmission_color, line.weight);
        s->eta = at.eta;
        s->f0 = normal_reflectance(m, at.eta);
        if (!at.hidden) return;
        p->events++;
        *emission = v3_splat(0);
        s->base = s->through = v3_splat(1);
        s->metallic = s->roughness = s->f0 = 0;
        s->transmission = 1;
        s->near = s->far = s->anisotropy = s->film = s->diffuse_transmission = 0;
        return;
    }
    s->through = s->base;
    if (p->media) {
        s->eta = m->eta / w->media[medium_top(p->media)].ior;
        s->f0 = normal_reflectance(m, s->eta);
    }
}

static void emit(const path_context *c, path *p, const hit *h, const surface *s, vec3 emission) {
    const world *w = c->world;
    const world_material *m = h->material;
    bool shines = h->p.front > 0.5f || m->flags & MATERIAL_TWO_SIDED;
    if (!shines) return;
    float cosine = fabsf(v3_dot(h->p.geometric, p->direction));
    if (m->clearcoat > 0) emission = v3_scale(emission, clearcoat_dims(s->clearcoat * s->near, cosine));
    uint32_t number = w->triangle_light ? w->triangle_light[h->triangle] : LIGHT_NONE;
    uint32_t which = w->instances[h->instance].light_base + number;
    float pdf = 0;
    if (number != LIGHT_NONE && p->pdf > 0) {
        float towards = v3_dot(h->p.geometric, p->direction);
        pdf = path_light_probability(c, which, &p->from) *
              light_triangle_pdf(&w->lights.lights[which], p->from.p, h->p.hit.t, towards);
    }
    float weight = estimate_hit_weight(estimate_hits_by(c->estimator, p->depth), p->pdf, pdf);
    p->radiance.x += p->throughput.x * emission.x * weight;
    p->radiance.y += p->throughput.y * emission.y * weight;
    p->radiance.z += p->throughput.z * emission.z * weight;
}

/* A light, a point on it, and the density of both. plane: what parts the media of the path and those beyond. */
static light_sampled draw_light(const path_context *c, path *p, vec3 position, vec3 plane, uint64_t beyond,
                                float *density) {
    const light_table *t = &c->world->lights;
    vec2 place = draw(c, p, SAMPLE_LIGHT);
    float fine = draw(c, p, SAMPLE_LIGHT_FINE).x, probability;
    uint32_t k = choose_light(c, &p->from, &place.x, &fine, &probability);
    light l = t->lights[k];
    if (l.kind == LIGHT_ENVIRONMENT) environment_pick(&t->environment, place, fine, &l);
    light_sampled r = light_sample(KIND(LIGHT_KINDS) - 1, &l, position, place);
    float cosine = -v3_dot(r.wi, l.axis);
    if (l.varies)
        r.radiance = v3_mul(r.radiance, lookup_emission(c->world, l.varies - 1, light_triangle_place(&l, r.target), cosine));
    uint64_t media = v3_dot(r.wi, plane) < 0.0f ? beyond : p->media;
    if (medium_hides(c->world->media, l.medium, media, v3_dot(r.wi, l.axis) < 0.0f)) r.radiance = v3_splat(0);
    *density = r.pdf * probability;
    return r;
}

/* Adds what comes through the medium, if nothing is in the way. */
static void reach(const path_context *c, path *p, const shading_connection *n, uint32_t medium, float distance) {
    const world *w = c->world;
    vec3 sum = n->contribution;
    if (HAS(c->effects, ABSORPTION) || HAS(c->effects, SCATTERING)) sum = v3_mul(sum, medium_transmittance(w->extinction, medium, distance));
    if (!(v3_max(sum) > 0.0f)) return;
    uint32_t visible = RAY_STOPPED;
    trace_counts counts = {0};
    ray_lanes ray = {&n->origin.x, &n->origin.y, &n->origin.z, &n->direction.x, &n->direction.y, &n->direction.z,
                     NULL, &n->far, coverage_of(c, p, SAMPLE_LIGHT_FINE), NULL, 1, false};
    accel_visible(w, &ray, &visible, &counts);
    if (visible == RAY_REACHES) p->radiance = v3_add(p->radiance, sum);
}

/* Next-event estimation. */
static void connect(const path_context *c, path *p, const hit *h, const shading *s, unsigned mask) {
    float density;
    p->from = (vantage){s->sides.above, h->material->flags & MATERIAL_TRANSMITS ? v3_splat(0) : s->frame.z, 0};
    light_sampled r = draw_light(c, p, s->sides.above, s->sides.normal, h->beyond, &density);
    shading_connection n = shading_connect(mask, s, c->estimator, p->throughput, &r, density);
    reach(c, p, &n, medium_top(v3_dot(r.wi, s->sides.normal) < 0.0f ? h->beyond : p->media), r.distance);
}

/* Does the medium scatter before the surface? Then at *distance. */
static bool fly(const path_context *c, path *p, const hit *h, float *distance) {
    const world *w = c->world;
    uint32_t medium = medium_top(p->media);
    if (!w->media[medium].scatters) return false;
    vec2 u = draw(c, p, SAMPLE_FLIGHT);
    float limit = flight_limit(w, p->origin, p->direction, &h->met);
    flight f = flight_sample(v3_load(w->extinction + 3 * medium), v3_load(w->albedo + 3 * medium), p->throughput, limit,
                             u.x, u.y);
    p->throughput = v3_mul(p->throughput, f.weight);
    *distance = f.distance;
    return f.scatters;
}

/* An event in a medium; false: the path ends. */
static bool scatter_in_medium(const path_context *c, path *p, float distance) {
    vec3 wo = v3_neg(p->direction), position = v3_madd(p->origin, distance, p->direction);
    uint32_t medium = medium_top(p->media);
    float g = c->world->media[medium].g, density;
    if (c->samples_lights) {
        p->from = (vantage){position, v3_splat(0), 0};
        light_sampled r = draw_light(c, p, position, v3_splat(0), p->media, &density);
        vec3 to = v3_sub(r.target, position);
        bool placed = r.distance < INFINITY;
        float length = v3_length(to);
        shading_connection n = {flight_connect(wo, g, c->estimator, p->throughput, &r, density), position,
                                placed ? v3_scale(to, 1.0f / fm_max(length, 1e-30f)) : r.wi, placed ? length : INFINITY};
        reach(c, p, &n, medium, r.distance);
    }
    vec2 direction = draw(c, p, SAMPLE_BSDF), lobe = draw(c, p, SAMPLE_LOBE);
    vec3 wi = phase_sample(wo, g, direction);
    roulette policy = roulette_in_medium(c, p->depth);
    p->throughput = v3_scale(p->throughput, roulette_weight(&policy, p->throughput, p->squeeze, lobe.y));
    p->origin = position, p->direction = wi, p->pdf = phase_value(wo, wi, g);
    p->cone = (cone){0};
    p->events++;
    return v3_max(p->throughput) > 0.0f;
}

/* The cone of the ray that p has become; it came along `came`. */
static cone widen(const path *p, const hit *h, const shading *s, vec3 came, int crosses) {
    const surface_triangle *t = &h->corners;
    bool transmits = kernel_mask(h->material->kind) & BSDF_TRANSMISSIVE, thin = transmits && s->bsdf.thin > 0.5f;
    cone_bounce b = {.d = came, .n = s->frame.z, .wi = p->direction, .pdf = p->pdf, .eta = 1, .bumpy = h->bumpy,
                     .bends = crosses & !thin, .passes = crosses & thin};
    if (transmits) b.eta = s->bsdf.eta;
    b.curvature = cone_curvature_of(v3_sub(t->p1, t->p0), v3_sub(t->p2, t->p0), t->n0, t->n1, t->n2, h->p.geometric);
    return cone_scatter((cone){h->across, p->cone.spread}, &b);
}

/* The BSDF's direction and roulette; false: the path ends. */
static bool scatter(const path_context *c, path *p, const hit *h, const shading *s, unsigned mask) {
    vec2 direction = draw(c, p, SAMPLE_BSDF), lobe = draw(c, p, SAMPLE_LOBE);
    shading_scattering r = shading_scatter(mask, s, p->throughput, lobe.x, direction);
    if (mask & BSDF_TRANSMISSIVE && r.crosses) {
        if (s->bsdf.thin < 0.5f) p->squeeze *= s->bsdf.eta * s->bsdf.eta;
        p->media = h->beyond;
        p->dispersed |= c->world->media[medium_top(h->beyond)].spread > 0;
    }
    roulette policy = roulette_make(c, p->depth);
    p->throughput = v3_scale(r.throughput, roulette_weight(&policy, r.throughput, p->squeeze, lobe.y));
    vec3 came = p->direction;
    p->origin = r.origin, p->direction = r.direction, p->pdf = r.pdf;
    p->cone = widen(p, h, s, came, mask & BSDF_TRANSMISSIVE && r.crosses);
    return v3_max(p->throughput) > 0.0f;
}

/* Bounces past the limit, or events in media past theirs. */
static int past_limit(const path_context *c, const path *p, bool scattered) {
    int bounces = scattered ? -1 : (int)(p->depth - p->events) - (int)c->max_depth;
    int events = (int)p->events - MEDIUM_EVENTS_MAX;
    return bounces > events ? bounces : events;
}

/* What the path collects at the surface that it met, before it is lit. */
static shading arrive(const path_context *c, path *p, hit *h) {
    if (HAS(c->effects, ABSORPTION))
        p->throughput = v3_mul(p->throughput, medium_transmittance(c->world->absorption, medium_top(p->media), h->p.hit.t));
    vec3 wo = v3_neg(p->direction), normal = h->p.shading, emission;
    surface s = look_up(c, h, wo, &emission, &normal);
    bound(c, p, h, &s, &emission);
    if (HAS(c->effects, AREA_LIGHTS) || HAS(c->effects, UNLIT)) emit(c, p, h, &s, emission);
    return shading_make(kernel_mask(h->material->kind), &s, h->sides, h->p.geometric, normal, wo);
}

oracle_result oracle_trace(const path_context *c, path_sample sample) {
    path p = start(c, sample);
    oracle_result out = {.alpha = 1};
    bool beyond = false, goes_on = true;
    for (; goes_on; p.depth++) {
        hit h;
        shading point;
        float distance;
        if (!find(c, &p, &h)) {
            if (p.depth == 0) out.alpha = 0;
            escape(c, &p);
            break;
        }
        bool scattered = HAS(c->effects, SCATTERING) && fly(c, &p, &h, &distance);
        if (!scattered) point = arrive(c, &p, &h);
        int past = past_limit(c, &p, scattered);
        if (past >= 0) {
            if (!path_is_probe(p.point.seed, p.point.index) || past >= PROBE_DEPTHS) break;
            if (!beyond) out.radiance = p.radiance, p.radiance = v3_splat(0);
            beyond = true;
        }
        if (scattered) {
            goes_on = scatter_in_medium(c, &p, distance);
            continue;
        }
        unsigned mask = kernel_mask(h.material->kind);
        if (c->samples_lights) connect(c, &p, &h, &point, mask);
        goes_on = scatter(c, &p, &h, &point, mask);
    }
    *(beyond ? &out.beyond : &out.radiance) = p.radiance;
    return out;
}
