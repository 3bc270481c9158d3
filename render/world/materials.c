/* render/world/materials.c: the scene's materials as records that a kernel loads, and their textures. */
#include <stdlib.h>
#include <string.h>

#include "render/bsdf/fresnel.h"
#include "render/world/images.h"
#include "render/world/media.h"
#include "render/world/mips.h"
#include "render/world/world.h"
#include "scene/transfer.h"

/* A parameter and the slot its texture goes to. */
typedef struct slot_use {
    material_slot slot;
    const kiln_texture *texture;
    const float *factor; /* 3: a colour whose factor must be applied before the matrix into the working space */
} slot_use;

typedef struct builder {
    world *world;
    const kiln_scene *scene;
    const kiln_decoding *decoding;
    world_image *images;
    kiln_texture_filter filter;
    uint32_t uv_sets[WORLD_UV_SETS];
    uint32_t uv_set_count;
    kiln_report *report;
} builder;

static bool emits(const kiln_material *m) {
    return m->emission.value[0] > 0 || m->emission.value[1] > 0 || m->emission.value[2] > 0;
}

/* The same of its layers. */
static int list_layer_slots(const kiln_material *m, slot_use uses[SLOT_COUNT], int n) {
    const float *sheen = m->sheen_color.value;
    bool clearcoat = m->layers & KILN_LAYER_CLEARCOAT && m->clearcoat.value > 0;
    bool has_sheen = m->layers & KILN_LAYER_SHEEN && (sheen[0] > 0 || sheen[1] > 0 || sheen[2] > 0);
    bool film = m->layers & KILN_LAYER_IRIDESCENCE && m->iridescence.value > 0;
#define USE1(asked, slot, parameter) \
    if ((asked) && (parameter).texture.image && (parameter).value != 0) \
        uses[n++] = (slot_use){slot, &(parameter).texture, NULL};
#define USE3(asked, slot, parameter) \
    if ((asked) && (parameter).texture.image) uses[n++] = (slot_use){slot, &(parameter).texture, (parameter).value};
    USE1(clearcoat, SLOT_CLEARCOAT, m->clearcoat)
    USE1(clearcoat, SLOT_CLEARCOAT_ROUGHNESS, m->clearcoat_roughness)
    USE1(clearcoat, SLOT_CLEARCOAT_NORMAL, m->clearcoat_normal)
    USE3(has_sheen, SLOT_SHEEN_COLOR, m->sheen_color)
    USE1(has_sheen, SLOT_SHEEN_ROUGHNESS, m->sheen_roughness)
    USE1(m->layers & KILN_LAYER_ANISOTROPY, SLOT_ANISOTROPY, m->anisotropy)
    USE1(film, SLOT_FILM, m->iridescence)
    if (film && m->iridescence_thickness_texture.image)
        uses[n++] = (slot_use){SLOT_FILM_THICKNESS, &m->iridescence_thickness_texture, NULL};
    USE1(material_is_translucent(m), SLOT_DIFFUSE_TRANSMISSION, m->diffuse_transmission)
    USE3(material_is_translucent(m), SLOT_DIFFUSE_TRANSMISSION_COLOR, m->diffuse_transmission_color)
#undef USE1
#undef USE3
    return n;
}

/* The textures that this material will be asked for. A factor of 0 makes its texture irrelevant. */
static int list_slots(const kiln_material *m, slot_use uses[SLOT_COUNT]) {
    int n = 0;
    bool unlit = m->layers & KILN_LAYER_UNLIT;
#define USE(slot, texture, factor) uses[n++] = (slot_use){slot, texture, factor}
    if (m->alpha_mode != KILN_ALPHA_OPAQUE && m->opacity.texture.image) USE(SLOT_OPACITY, &m->opacity.texture, NULL);
    if (m->base_color.texture.image)
        USE(unlit ? SLOT_EMISSION : SLOT_BASE, &m->base_color.texture, m->base_color.value);
    if (unlit) return n;
    if (emits(m) && m->emission.texture.image) USE(SLOT_EMISSION, &m->emission.texture, m->emission.value);
    if (m->normal.texture.image && m->normal.value != 0) USE(SLOT_NORMAL, &m->normal.texture, NULL);
    if (m->metallic.texture.image && m->metallic.value > 0) USE(SLOT_METALLIC, &m->metallic.texture, NULL);
    if (m->roughness.texture.image && m->roughness.value > 0) USE(SLOT_ROUGHNESS, &m->roughness.texture, NULL);
    if (m->specular.texture.image && m->specular.value > 0) USE(SLOT_SPECULAR, &m->specular.texture, NULL);
    if (m->specular_color.texture.image && m->specular.value > 0)
        USE(SLOT_SPECULAR_COLOR, &m->specular_color.texture, m->specular_color.value);
    if (material_transmits(m) && m->transmission.texture.image) USE(SLOT_TRANSMISSION, &m->transmission.texture, NULL);
    n = list_layer_slots(m, uses, n);
#undef USE
    return n;
}

static texel_domain domain_of(material_slot slot) {
    return slot == SLOT_EMISSION || slot == SLOT_SPECULAR_COLOR ? TEXELS_POSITIVE : TEXELS_UNIT;
}

/* What may be averaged: where coverage decides what is seen of a texel, its neighbours would bleed into it; emission
 * is sampled by lights too, without a footprint; the mean of normals, or of directions, is none of a rougher surface. */
static bool is_filtered(const kiln_material *m, const slot_use *use) {
    return m->alpha_mode == KILN_ALPHA_OPAQUE && use->texture->filter == KILN_FILTER_LINEAR &&
           use->slot != SLOT_EMISSION && use->slot != SLOT_OPACITY && use->slot != SLOT_NORMAL &&
           use->slot != SLOT_CLEARCOAT_NORMAL && use->slot != SLOT_ANISOTROPY;
}

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

static bool add_texture(builder *b, const kiln_material *m, const slot_use *use, uint32_t *handle) {
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
    t.texels = image_texels(image, from->transfer, domain_of(use->slot), &t.format);
    if (is_filtered(m, use)) t.levels = image_levels(image, from->transfer, domain_of(use->slot));
    t.level_count = mips_count(t.width, t.height);
    b->world->filters |= t.levels != NULL;
    if (!find_uv_set(b, from->uv_set, &t.uv_set)) return false;
    memcpy(t.transform, from->transform, sizeof t.transform);
    set_matrix(&t, b->decoding->matrix[from->transfer], use->factor);
    b->world->textures[b->world->texture_count++] = t;
    *handle = b->world->texture_count;
    return true;
}

/* What lies on the surface, where there is any of it. */
static void set_layers(const builder *b, world_material *m, const kiln_material *from) {
    uint32_t layers = from->layers & KILN_LAYER_UNLIT ? 0 : from->layers;
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
/* The kind whose kernel has all that the material calls for, and least besides. */
static material_kind kind_of(const world_material *m) {
    bool crosses = m->transmission > 0 || m->diffuse_transmission > 0, coated = m->clearcoat > 0 || m->anisotropy > 0;
    if (m->film > 0) return KIND_FILMED;
    if (v3_max(v3_load(m->sheen)) > 0 || m->diffuse_transmission > 0 || (coated && crosses)) return KIND_LAYERED;
    if (coated) return KIND_COATED;
    if (crosses) return KIND_TRANSMISSIVE;
    return m->metallic > 0 || m->specular > 0 ? KIND_GLOSSY : KIND_DIFFUSE;
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
    bool glossy = from->layers & KILN_LAYER_GLOSSINESS, textured = from->roughness.texture.image && from->roughness.value > 0;
    m->roughness = glossy && !textured ? 1.0f - from->roughness.value : from->roughness.value;
    m->normal_scale = from->normal.value;
    m->specular = unlit ? 0.0f : from->specular.value;
    m->transmission = material_transmits(from) && !unlit ? from->transmission.value : 0.0f;
    m->thin = material_is_solid(from) ? 0.0f : 1.0f;
    m->alpha_cutoff = from->alpha_cutoff;
    m->eta = from->ior > 0 ? fminf(from->ior, WORLD_IOR_MAX) : WORLD_IOR_MAX; /* 0 stands for infinity */
    m->f0 = from->ior > 0 ? fresnel_normal(m->eta) : 1.0f;
    set_layers(b, m, from);
    bool crosses = m->transmission > 0 || m->diffuse_transmission > 0;
    m->flags = (from->double_sided ? MATERIAL_DOUBLE_SIDED : 0u) | (unlit ? MATERIAL_UNLIT : 0u) |
               (crosses ? MATERIAL_TRANSMITS : 0u) | (from->layers & KILN_LAYER_GLOSSINESS ? MATERIAL_GLOSSINESS : 0u) |
               (from->alpha_mode == KILN_ALPHA_MASK ? MATERIAL_MASK : 0u) |
               (from->alpha_mode == KILN_ALPHA_BLEND ? MATERIAL_BLEND : 0u);
    if (unlit) m->metallic = 0.0f;
    m->kind = kind_of(m);
}

/* The colour that the texture of a slot multiplies. */
static float *color_of(world_material *m, material_slot slot) {
    if (slot == SLOT_BASE) return m->base;
    if (slot == SLOT_EMISSION) return m->emission;
    if (slot == SLOT_SHEEN_COLOR) return m->sheen;
    if (slot == SLOT_DIFFUSE_TRANSMISSION_COLOR) return m->diffuse_transmission_color;
    return m->specular_color;
}

static bool set_textures(builder *b, world_material *m, const kiln_material *from) {
    slot_use uses[SLOT_COUNT];
    int n = list_slots(from, uses);
    for (int i = 0; i < n; i++) {
        if (!add_texture(b, from, &uses[i], &m->texture[uses[i].slot])) return false;
        if (uses[i].slot != SLOT_OPACITY) b->world->slots |= 1u << uses[i].slot;
        if (uses[i].factor && b->world->textures[b->world->texture_count - 1].has_matrix)
            v3_store(color_of(m, uses[i].slot), v3_splat(1.0f)); /* the factor went into the texture's matrix */
    }
    return true;
}

/* Which materials are on something that is in the picture's world. */
static bool *mark_used(const kiln_scene *scene) {
    bool *used = array_alloc((size_t)scene->material_count + 1, sizeof *used);
    for (uint32_t i = 0; used && i < scene->instance_count; i++) {
        const kiln_mesh *mesh = scene_mesh(scene, scene->instances[i].mesh);
        if (!mesh->face_materials) used[mesh->material] = true;
        else
            for (uint32_t f = 0; f < mesh->face_count; f++) used[mesh->face_materials[f]] = true;
    }
    return used;
}

static uint32_t want_images(builder *b, const bool *used) {
    uint32_t textures = 0;
    for (uint32_t i = 0; i <= b->scene->material_count; i++) {
        slot_use uses[SLOT_COUNT];
        int n = used[i] ? list_slots(scene_material(b->scene, i), uses) : 0;
        for (int k = 0; k < n; k++) {
            world_image *image = &b->images[uses[k].texture->image - 1];
            uint32_t use = image_use(uses[k].texture->transfer, domain_of(uses[k].slot));
            image->wanted |= use;
            if (b->filter == KILN_TEXTURES_MIP && is_filtered(scene_material(b->scene, i), &uses[k])) image->filtered |= use;
        }
        textures += (uint32_t)n;
    }
    return textures;
}

static bool build(builder *b, const bool *used, uint32_t threads) {
    world *w = b->world;
    uint32_t textures = want_images(b, used);
    if (!images_decode(b->images, b->scene, w->curves, threads, b->report)) return false;
    w->material_count = b->scene->material_count + 1;
    w->materials = ARENA_ARRAY(&w->arena, world_material, w->material_count);
    w->textures = ARENA_ARRAY(&w->arena, world_texture, (size_t)textures + 1);
    if (!w->materials || !w->textures) return report_no_memory(b->report, "building materials");
    for (uint32_t i = 0; i < w->material_count; i++) {
        if (!used[i]) continue;
        world_material *m = &w->materials[i];
        const kiln_material *from = scene_material(b->scene, i);
        set_constants(b, m, from);
        if (!set_textures(b, m, from)) return false;
        w->kinds |= 1u << m->kind;
        w->flags |= m->flags;
        w->single_sided |= !(m->flags & MATERIAL_TWO_SIDED);
        w->wants_tangents |= material_uses_tangents(m);
    }
    memcpy(w->uv_sets, b->uv_sets, sizeof w->uv_sets);
    w->uv_set_count = b->uv_set_count;
    if (!world_build_media(w, b->scene, b->decoding, used, b->report)) return false;
    if (w->scatters) w->kinds |= 1u << KIND_MEDIUM;
    return true;
}

bool world_build_materials(world *w, const kiln_scene *scene, const kiln_decoding *decoding,
                           kiln_texture_filter filter, uint32_t threads, kiln_report *report) {
    bool *used = mark_used(scene);
    memcpy(w->curves, decoding->curve, sizeof w->curves);
    w->image_count = scene->image_count;
    w->images = array_alloc(scene->image_count, sizeof *w->images);
    builder b = {.world = w, .scene = scene, .decoding = decoding, .images = w->images, .filter = filter,
                 .report = report,
                 .uv_set_count = 1}; /* set 0, which vertices have room for, whether textures read it or not */
    bool done = used && w->images ? build(&b, used, threads) : report_no_memory(report, "building materials");
    free(used);
    return done;
}

bool world_check_images(const kiln_scene *scene, uint32_t threads, kiln_report *report) {
    bool *used = mark_used(scene);
    world_image *images = array_alloc(scene->image_count, sizeof *images);
    builder b = {.scene = scene, .images = images};
    bool done = (used && images) || report_no_memory(report, "checking pictures");
    if (done) {
        (void)want_images(&b, used);
        if (scene->has_environment && scene->environment.image) images[scene->environment.image - 1].wanted = 1;
        done = images_check(images, scene, threads, report);
    }
    free(used);
    free(images);
    return done;
}
