/* render/world/materials.c: the scene's materials as records that a kernel loads, and their textures. */
#include <stdlib.h>
#include <string.h>

#include "render/bsdf/fresnel.h"
#include "render/effects/reduce.h"
#include "render/world/media.h"
#include "render/world/mips.h"
#include "render/world/slots.h"
#include "scene/transfer.h"

typedef struct builder {
    world *world;
    const reduced_scene *scene;
    const kiln_decoding *decoding;
    world_image *images;
    uint32_t uv_sets[WORLD_UV_SETS];
    uint32_t uv_set_count;
    kiln_report *report;
} builder;

static bool is_identity(const float m[9]) {
    static const float identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    return memcmp(m, identity, sizeof identity) == 0;
}

/* The place of a UV set among those in use; the vertex itself holds the first. */
static bool find_uv_set(builder *b, uint32_t set, uint32_t *place) {
    for (*place = 0; *place < b->uv_set_count; ++*place)
        if (b->uv_sets[*place] == set) return true;
    if (b->uv_set_count == WORLD_UV_SETS)
        return report_error(b->report, KILN_CODE_LIMIT, NULL, "use fewer UV sets",
                            "the materials use more than %d different UV sets", WORLD_UV_SETS);
    b->uv_sets[b->uv_set_count++] = set;
    return true;
}

/* matrix · diag(factor): the factor belongs in front of the change of primaries. */
static void set_matrix(world_texture *t, const float matrix[9], const float *factor) {
    t->has_matrix = !is_identity(matrix);
    for (int i = 0; t->has_matrix && i < 9; i++) t->matrix[i] = matrix[i] * (factor ? factor[i % 3] : 1.0f);
}

static world_texture texture_of(const builder *b, const slot_use *use) {
    const kiln_texture *from = use->texture;
    const world_image *image = &b->images[from->image - 1];
    world_texture t = {
        .width = (int32_t)image->width,
        .height = (int32_t)image->height,
        .wrap_u = from->wrap_u,
        .wrap_v = from->wrap_v,
        .nearest = from->filter == KILN_FILTER_NEAREST,
        .channel = from->channel,
        .curve = b->world->curves[from->transfer],
    };
    t.texels = image_texels(image, from->transfer, slot_domain(use->slot), &t.format);
    memcpy(t.transform, from->transform, sizeof t.transform);
    set_matrix(&t, b->decoding->matrix[from->transfer], use->factor);
    return t;
}

static bool add_texture(builder *b, const kiln_material *m, const slot_use *use, uint32_t *handle) {
    const kiln_texture *from = use->texture;
    world_texture t = texture_of(b, use);
    if (slot_is_filtered(m, use))
        t.levels = image_levels(&b->images[from->image - 1], from->transfer, slot_domain(use->slot));
    t.level_count = mips_count(t.width, t.height);
    if (!find_uv_set(b, from->uv_set, &t.uv_set)) return false;
    b->world->textures[b->world->texture_count++] = t;
    *handle = b->world->texture_count;
    return true;
}

/* What lies on the surface, where there is any of it. */
static void set_layers(const builder *b, world_material *m, const kiln_material *from) {
    uint32_t layers = from->layers;
    if (layers & KILN_LAYER_CLEARCOAT) m->clearcoat = from->clearcoat.value;
    m->clearcoat_roughness = from->clearcoat_roughness.value;
    m->clearcoat_normal_scale = from->clearcoat_normal.value;
    if (layers & KILN_LAYER_SHEEN)
        v3_store(m->sheen, decoding_apply(b->decoding, KILN_TRANSFER_LINEAR, from->sheen_color.value));
    m->sheen_roughness = from->sheen_roughness.value;
    if (layers & KILN_LAYER_ANISOTROPY) m->anisotropy = from->anisotropy.value;
    m->anisotropy_x = cosf(from->anisotropy_rotation);
    m->anisotropy_y = sinf(from->anisotropy_rotation);
    if (layers & KILN_LAYER_IRIDESCENCE) m->film = from->iridescence.value;
    m->film_ior = from->iridescence_ior;
    memcpy(m->film_thickness, from->iridescence_thickness, sizeof m->film_thickness);
    if (layers & KILN_LAYER_DIFFUSE_TRANSMISSION) m->diffuse_transmission = from->diffuse_transmission.value;
    v3_store(m->diffuse_transmission_color,
             decoding_apply(b->decoding, KILN_TRANSFER_LINEAR, from->diffuse_transmission_color.value));
}

static void set_constants(const builder *b, world_material *m, const kiln_material *from) {
    bool unlit = from->layers & KILN_LAYER_UNLIT;
    vec3 base = decoding_apply(b->decoding, KILN_TRANSFER_LINEAR, from->base_color.value);
    vec3 emission = decoding_apply(b->decoding, KILN_TRANSFER_LINEAR, from->emission.value);
    v3_store(m->base, unlit ? v3_splat(0) : base);
    v3_store(m->emission, unlit ? base : emission);
    v3_store(m->specular_color, decoding_apply(b->decoding, KILN_TRANSFER_LINEAR, from->specular_color.value));
    m->opacity = from->opacity.value;
    m->metallic = from->metallic.value;
    bool glossy = from->layers & KILN_LAYER_GLOSSINESS, textured = from->roughness.texture.image != 0;
    m->roughness = glossy && !textured ? 1.0f - from->roughness.value : from->roughness.value;
    m->normal_scale = from->normal.value;
    m->specular = from->specular.value;
    m->transmission = material_transmits(from) ? from->transmission.value : 0.0f;
    m->thin = material_is_solid(from) ? 0.0f : 1.0f;
    m->alpha_cutoff = from->alpha_cutoff;
    m->eta = from->ior > 0 ? fminf(from->ior, WORLD_IOR_MAX) : WORLD_IOR_MAX; /* 0 stands for infinity */
    m->f0 = from->ior > 0 ? fresnel_normal(m->eta) : 1.0f;
    set_layers(b, m, from);
    bool forced = HAS(b->world->plan.asked.forced, ALPHA) && from->alpha_mode == KILN_ALPHA_OPAQUE;
    bool blends = from->alpha_mode == KILN_ALPHA_BLEND || forced;
    bool crosses = m->transmission > 0 || m->diffuse_transmission > 0;
    m->flags = (from->double_sided ? MATERIAL_DOUBLE_SIDED : 0u) | (unlit ? MATERIAL_UNLIT : 0u) |
               (crosses ? MATERIAL_TRANSMITS : 0u) | (from->layers & KILN_LAYER_GLOSSINESS ? MATERIAL_GLOSSINESS : 0u) |
               (from->alpha_mode == KILN_ALPHA_MASK ? MATERIAL_MASK : 0u) |
               (blends ? MATERIAL_BLEND : 0u);
    m->kind = kernel_for(effects_terms(material_effects(from, b->images) | effects_imposed(&b->world->plan.asked)));
}

/* The colour that the texture of a slot multiplies. */
static float *color_of(world_material *m, material_slot slot) {
    if (slot == SLOT_BASE) return m->base;
    if (slot == SLOT_EMISSION) return m->emission;
    if (slot == SLOT_SHEEN_COLOR) return m->sheen;
    if (slot == SLOT_DIFFUSE_TRANSMISSION_COLOR) return m->diffuse_transmission_color;
    return m->specular_color;
}

/* The parameter that the texture of a slot multiplies, as stage_material.c does at a point; NULL: it is more than that. */
static float *scalar_of(world_material *m, material_slot slot) {
    switch (slot) {
    case SLOT_OPACITY: return &m->opacity;
    case SLOT_METALLIC: return &m->metallic;
    case SLOT_ROUGHNESS: return &m->roughness;
    case SLOT_SPECULAR: return &m->specular;
    case SLOT_TRANSMISSION: return &m->transmission;
    case SLOT_CLEARCOAT: return &m->clearcoat;
    case SLOT_CLEARCOAT_ROUGHNESS: return &m->clearcoat_roughness;
    case SLOT_SHEEN_ROUGHNESS: return &m->sheen_roughness;
    case SLOT_FILM: return &m->film;
    case SLOT_DIFFUSE_TRANSMISSION: return &m->diffuse_transmission;
    case SLOT_BASE: case SLOT_NORMAL: case SLOT_EMISSION: case SLOT_SPECULAR_COLOR: case SLOT_CLEARCOAT_NORMAL:
    case SLOT_SHEEN_COLOR: case SLOT_ANISOTROPY: case SLOT_FILM_THICKNESS: case SLOT_DIFFUSE_TRANSMISSION_COLOR:
    case SLOT_COUNT: break;
    }
    return NULL;
}

/* A texture of one value becomes a part of the constants. */
static void fold(const builder *b, world_material *m, const slot_use *use) {
    world_texture t = texture_of(b, use);
    float *scalar = scalar_of(m, use->slot);
    if (use->factor) {
        float *color = color_of(m, use->slot);
        texel c = texture_sample(&t, 0, 0);
        if (t.has_matrix) v3_store(color, v3_splat(1.0f));
        color[0] *= c.r, color[1] *= c.g, color[2] *= c.b;
    }
    if (scalar) *scalar *= texture_channel(&t, 0, 0);
    if (use->slot == SLOT_ROUGHNESS && m->flags & MATERIAL_GLOSSINESS) m->roughness = 1.0f - m->roughness;
    if (use->slot == SLOT_FILM_THICKNESS)
        m->film_thickness[1] = fm_lerp(m->film_thickness[0], m->film_thickness[1], texture_channel(&t, 0, 0));
}

static bool set_textures(builder *b, world_material *m, const kiln_material *from) {
    slot_use uses[SLOT_COUNT];
    int n = slots_list(from, uses);
    for (int i = 0; i < n; i++) {
        if (slot_is_constant(&uses[i], b->images)) {
            fold(b, m, &uses[i]);
            continue;
        }
        if (!add_texture(b, from, &uses[i], &m->texture[uses[i].slot])) return false;
        if (uses[i].slot != SLOT_OPACITY) b->world->slots |= 1u << uses[i].slot;
        if (uses[i].factor && b->world->textures[b->world->texture_count - 1].has_matrix)
            v3_store(color_of(m, uses[i].slot), v3_splat(1.0f)); /* the factor went into the texture's matrix */
    }
    return true;
}

/* Which images the materials use, in which forms; returns the number of uses. constants: those count that have one value,
 * which becomes a part of the material. */
static uint32_t want_images(const reduced_scene *scene, kiln_texture_filter filter, bool constants, world_image *images) {
    uint32_t textures = 0;
    for (uint32_t i = 0; i < scene->scene->image_count; i++) images[i].wanted = images[i].filtered = 0;
    for (uint32_t i = 0; i <= scene->scene->material_count; i++) {
        slot_use uses[SLOT_COUNT];
        const kiln_material *m = reduced_material(scene, i);
        int n = scene->used[i] ? slots_list(m, uses) : 0;
        for (int k = 0; k < n; k++) {
            world_image *image = &images[uses[k].texture->image - 1];
            uint32_t use = image_use(uses[k].texture->transfer, slot_domain(uses[k].slot));
            bool constant = slot_is_constant(&uses[k], images);
            if (constants || !constant) image->wanted |= use;
            if (!constant && filter == KILN_TEXTURES_MIP && slot_is_filtered(m, &uses[k])) image->filtered |= use;
        }
        textures += (uint32_t)n;
    }
    return textures;
}

static kiln_texture_filter filter_of(const world_build_options *o) {
    bool mips = o->filter == KILN_TEXTURES_MIP && !HAS(o->effects.removed, TEXTURE_FILTERING);
    return mips ? KILN_TEXTURES_MIP : KILN_TEXTURES_BILINEAR;
}

/* Decodes what may be needed, looks at it, and drops what is not. textures: the uses that are left. */
static bool decode(world *w, reduced_scene *scene, const world_build_options *o, uint32_t *textures, kiln_report *report) {
    (void)want_images(scene, filter_of(o), true, w->images);
    if (!images_decode(w->images, scene->scene, w->curves, o->threads, report)) return false;
    reduced_update(scene, w->images);
    *textures = want_images(scene, filter_of(o), true, w->images);
    images_drop(w->images, w->image_count);
    return scan_scene(scene, w->images, filter_of(o), &w->plan, report);
}

static bool build(builder *b, uint32_t textures) {
    world *w = b->world;
    w->material_count = b->scene->scene->material_count + 1;
    w->materials = ARENA_ARRAY(&w->arena, world_material, w->material_count);
    w->textures = ARENA_ARRAY(&w->arena, world_texture, (size_t)textures + 1);
    if (!w->materials || !w->textures) return report_no_memory(b->report, "building materials");
    for (uint32_t i = 0; i < w->material_count; i++) {
        if (!b->scene->used[i]) continue;
        world_material *m = &w->materials[i];
        const kiln_material *from = reduced_material(b->scene, i);
        set_constants(b, m, from);
        if (!set_textures(b, m, from)) return false;
        w->kinds |= 1u << m->kind;
    }
    if (HAS(w->plan.runs, TEXTURES)) w->slots |= HAS(w->plan.called, TEXTURES) ? 0 : (1u << SLOT_COUNT) - 1;
    memcpy(w->uv_sets, b->uv_sets, sizeof w->uv_sets);
    w->uv_set_count = b->uv_set_count;
    if (!world_build_media(w, b->scene, b->decoding, b->report)) return false;
    if (HAS(w->plan.runs, SCATTERING)) w->kinds |= 1u << KIND_MEDIUM;
    return true;
}

bool world_build_materials(world *w, reduced_scene *scene, const world_build_options *o, kiln_report *report) {
    uint32_t textures;
    memcpy(w->curves, o->decoding->curve, sizeof w->curves);
    w->image_count = scene->scene->image_count;
    w->images = array_alloc(w->image_count, sizeof *w->images);
    if (!w->images) return report_no_memory(report, "building materials");
    if (!decode(w, scene, o, &textures, report)) return false;
    builder b = {.world = w, .scene = scene, .decoding = o->decoding, .images = w->images, .report = report,
                 .uv_set_count = 1}; /* set 0, which vertices have room for, whether textures read it or not */
    if (!build(&b, textures)) return false;
    (void)want_images(scene, filter_of(o), false, w->images);
    images_drop(w->images, w->image_count);
    return true;
}

static bool plan(reduced_scene *scene, const world_build_options *o, world_image *images, kiln_effect_plan *plan,
                 kiln_report *report) {
    const kiln_scene *s = scene->scene;
    (void)want_images(scene, filter_of(o), true, images);
    if (s->has_environment && s->environment.image) images[s->environment.image - 1].wanted = 1;
    if (!images_look(images, s, o->threads, report)) return false;
    reduced_update(scene, images);
    (void)want_images(scene, filter_of(o), true, images);
    return scan_scene(scene, images, filter_of(o), plan, report);
}

bool world_plan(const kiln_scene *scene, const world_build_options *o, kiln_effect_plan *result, kiln_report *report) {
    reduced_scene reduced;
    world_image *images = array_alloc(scene->image_count, sizeof *images);
    *result = (kiln_effect_plan){.asked = o->effects};
    bool done = reduced_make(&reduced, scene, effects_removed(&o->effects), report) &&
                (images || report_no_memory(report, "looking at pictures")) &&
                plan(&reduced, o, images, result, report);
    reduced_free(&reduced);
    free(images);
    return done;
}
