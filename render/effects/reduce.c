#include "render/effects/reduce.h"

#include <math.h>

#include "render/bsdf/lobes/ggx.h"
#include "render/effects/plan.h"
#include "render/world/media.h"

/* The texture's image as it was looked at; NULL: it was not. */
static const world_image *looked_at(const kiln_texture *t, const world_image *images) {
    return t->image && images && images[t->image - 1].looked_at ? &images[t->image - 1] : NULL;
}

static parameter_range channel_range(const kiln_texture *t, uint32_t channel, const world_image *images) {
    const world_image *image = looked_at(t, images);
    if (!t->image) return (parameter_range){1, 1};
    if (!image) return (parameter_range){0, 1};
    return (parameter_range){fminf(image->low[channel], 1.0f), fminf(image->high[channel], 1.0f)};
}

parameter_range param1_range(const kiln_param1 *p, const world_image *images) {
    parameter_range r = channel_range(&p->texture, p->texture.channel, images);
    return (parameter_range){p->value * r.low, p->value * r.high};
}

/* Is value × texture black everywhere? Every transfer takes 0 to 0. */
static bool is_black(const kiln_param3 *p, const world_image *images) {
    const world_image *image = looked_at(&p->texture, images);
    bool black = true;
    for (int k = 0; k < 3; k++) black = black && (!(p->value[k] > 0) || (image && !(image->high[k] > 0)));
    return black;
}

/* A map of no normal but the surface's own. A code of 8 or 16 bits has no middle: maps that are meant to be flat hold
 * one of the two about it (glTF 2.0, 3.9.3, maps 128 to a lean of 0.2 degrees, which nobody means). */
static bool is_flat(const kiln_texture *t, const world_image *images) {
    const world_image *image = looked_at(t, images);
    if (!image) return false;
    /* Half a code, and a little for rounding. */
    float off = image->format == KILN_PIXELS_U8 ? 0.51f / 255 : image->format == KILN_PIXELS_U16 ? 0.51f / 65535 : 0;
    for (int k = 0; k < 2; k++)
        if (image->low[k] < 0.5f - off || image->high[k] > 0.5f + off) return false;
    return image->low[2] > 0.5f;
}

static void drop_layers(kiln_material *m, uint32_t layers) { m->layers &= ~layers; }
static void drop1(kiln_param1 *p) { *p = (kiln_param1){0}; }

/* What the scene is to be without. */
static void remove_effects(kiln_material *m, uint64_t removed) {
    static const struct { kiln_effect effect; uint32_t layers; } rows[] = {
        {KILN_EFFECT_TRANSMISSION, KILN_LAYER_TRANSMISSION},
        {KILN_EFFECT_DIFFUSE_TRANSMISSION, KILN_LAYER_DIFFUSE_TRANSMISSION},
        {KILN_EFFECT_ANISOTROPY, KILN_LAYER_ANISOTROPY},
        {KILN_EFFECT_IRIDESCENCE, KILN_LAYER_IRIDESCENCE},
        {KILN_EFFECT_SHEEN, KILN_LAYER_SHEEN},
        {KILN_EFFECT_CLEARCOAT, KILN_LAYER_CLEARCOAT},
        {KILN_EFFECT_SOLIDS, KILN_LAYER_VOLUME},
        {KILN_EFFECT_SCATTERING, KILN_LAYER_VOLUME_SCATTER},
        {KILN_EFFECT_DISPERSION, KILN_LAYER_DISPERSION},
        {KILN_EFFECT_UNLIT, KILN_LAYER_UNLIT}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (removed >> rows[i].effect & 1) drop_layers(m, rows[i].layers);
    if (HAS(removed, ALPHA)) m->alpha_mode = KILN_ALPHA_OPAQUE;
    if (HAS(removed, NORMAL_MAPS)) drop1(&m->normal), drop1(&m->clearcoat_normal);
    if (HAS(removed, REFLECTION)) drop1(&m->metallic), drop1(&m->specular);
    if (HAS(removed, ROUGH_TRANSMISSION) && material_transmits(m))
        drop1(&m->roughness), drop_layers(m, KILN_LAYER_GLOSSINESS);
    if (HAS(removed, AREA_LIGHTS)) m->emission = (kiln_param3){0};
    if (HAS(removed, ABSORPTION) && !(m->layers & KILN_LAYER_VOLUME_SCATTER)) m->attenuation_distance = 0;
}

/* What shines of its own is nothing else. */
static void reduce_unlit(kiln_material *m, const world_image *images) {
    kiln_material bare = {.name = m->name, .layers = KILN_LAYER_UNLIT, .alpha_mode = m->alpha_mode,
                          .alpha_cutoff = m->alpha_cutoff, .double_sided = m->double_sided,
                          .base_color = m->base_color, .opacity = m->opacity, .ior = m->ior,
                          .iridescence_ior = m->iridescence_ior};
    if (is_black(&m->base_color, images)) bare.base_color = (kiln_param3){0};
    *m = bare;
}

/* What a base of opaque metal hides, or a clear interface. */
static void reduce_crossings(kiln_material *m, const world_image *images) {
    bool metal = param1_range(&m->metallic, images).low >= 1;
    if (!(m->layers & KILN_LAYER_TRANSMISSION) || metal || !(param1_range(&m->transmission, images).high > 0))
        drop_layers(m, KILN_LAYER_TRANSMISSION);
    bool clear = material_transmits(m) && param1_range(&m->transmission, images).low >= 1;
    if (metal || clear || !(param1_range(&m->diffuse_transmission, images).high > 0))
        drop_layers(m, KILN_LAYER_DIFFUSE_TRANSMISSION);
}

static void reduce_volume(kiln_material *m) {
    const uint32_t inside = KILN_LAYER_VOLUME_SCATTER | KILN_LAYER_DISPERSION;
    const float *left = m->attenuation_color, *albedo = m->multiscatter_color;
    if (!material_is_solid(m)) drop_layers(m, KILN_LAYER_VOLUME | inside);
    if (left[0] >= 1 && left[1] >= 1 && left[2] >= 1) m->attenuation_distance = 0;
    bool scatters = m->attenuation_distance > 0 && (albedo[0] > 0 || albedo[1] > 0 || albedo[2] > 0);
    if (!scatters) drop_layers(m, KILN_LAYER_VOLUME_SCATTER);
    if (!(m->dispersion > 0 && m->ior > 1)) drop_layers(m, KILN_LAYER_DISPERSION);
}

static void reduce_layers(kiln_material *m, const world_image *images) {
    float strength = channel_range(&m->anisotropy.texture, 2, images).high;
    const float *nm = m->iridescence_thickness;
    parameter_range between = channel_range(&m->iridescence_thickness_texture,
                                            m->iridescence_thickness_texture.channel, images);
    float low = nm[0] + (nm[1] - nm[0]) * between.low, high = nm[0] + (nm[1] - nm[0]) * between.high;
    if (!(param1_range(&m->clearcoat, images).high > 0)) drop_layers(m, KILN_LAYER_CLEARCOAT);
    if (is_black(&m->sheen_color, images)) drop_layers(m, KILN_LAYER_SHEEN);
    if (!(m->anisotropy.value * strength > 0)) drop_layers(m, KILN_LAYER_ANISOTROPY);
    bool film = param1_range(&m->iridescence, images).high > 0 && fmaxf(low, high) > 0;
    if (!film) drop_layers(m, KILN_LAYER_IRIDESCENCE);
}

static void reduce_coverage(kiln_material *m, const reduction *r) {
    float least = param1_range(&m->opacity, r->images).low * r->color_alpha;
    bool whole = m->alpha_mode == KILN_ALPHA_MASK ? least >= m->alpha_cutoff : least >= 1;
    if (whole) m->alpha_mode = KILN_ALPHA_OPAQUE;
    if (m->alpha_mode == KILN_ALPHA_OPAQUE) m->opacity = (kiln_param1){.value = 1};
}

/* Factors of 0 make textures irrelevant, and so do maps that say nothing. */
static void reduce_textures(kiln_material *m, const world_image *images) {
    if (m->normal.value == 0 || is_flat(&m->normal.texture, images)) m->normal.texture.image = 0;
    if (m->clearcoat_normal.value == 0 || is_flat(&m->clearcoat_normal.texture, images))
        m->clearcoat_normal.texture.image = 0;
    kiln_param1 *const scalars[] = {&m->metallic, &m->roughness, &m->specular, &m->clearcoat_roughness,
                                    &m->sheen_roughness};
    for (size_t i = 0; i < sizeof scalars / sizeof *scalars; i++)
        if (scalars[i]->value == 0) scalars[i]->texture.image = 0;
    if (!(param1_range(&m->metallic, images).high > 0)) drop1(&m->metallic);
    if (!(param1_range(&m->specular, images).high > 0)) drop1(&m->specular);
    if (!(m->specular.value > 0)) m->specular_color.texture.image = 0;
    if (is_black(&m->emission, images)) m->emission = (kiln_param3){0};
    m->thickness.texture.image = 0; /* solids are traced as they are: the texture is for rasterisers */
}

/* What every parameter is multiplied by. */
static void drop_textures(kiln_material *m) {
    kiln_param1 *const scalars[] = {&m->opacity, &m->metallic, &m->roughness, &m->normal, &m->specular,
                                    &m->transmission, &m->clearcoat, &m->clearcoat_roughness, &m->clearcoat_normal,
                                    &m->sheen_roughness, &m->anisotropy, &m->iridescence, &m->diffuse_transmission};
    kiln_param3 *const colors[] = {&m->base_color, &m->emission, &m->specular_color, &m->sheen_color,
                                   &m->diffuse_transmission_color};
    for (size_t i = 0; i < sizeof scalars / sizeof *scalars; i++) scalars[i]->texture.image = 0;
    for (size_t i = 0; i < sizeof colors / sizeof *colors; i++) colors[i]->texture.image = 0;
    m->iridescence_thickness_texture.image = 0;
}

void material_reduce(kiln_material *m, const reduction *r) {
    if (HAS(r->removed, TEXTURES)) drop_textures(m);
    remove_effects(m, r->removed);
    reduce_coverage(m, r);
    if (m->layers & KILN_LAYER_UNLIT) reduce_unlit(m, r->images);
    else {
        reduce_textures(m, r->images);
        reduce_crossings(m, r->images);
        reduce_volume(m);
        reduce_layers(m, r->images);
    }
}

/* Inside of solids. */
static uint64_t volume_effects(const kiln_material *m) {
    uint64_t effects = EFFECT(SOLIDS);
    if (m->layers & KILN_LAYER_VOLUME_SCATTER) effects |= EFFECT(SCATTERING);
    else if (m->attenuation_distance > 0) effects |= EFFECT(ABSORPTION);
    if (m->layers & KILN_LAYER_DISPERSION) effects |= EFFECT(DISPERSION);
    return effects;
}

static uint64_t roughness_effects(const kiln_material *m, const world_image *images) {
    parameter_range r = param1_range(&m->roughness, images);
    if (m->layers & KILN_LAYER_GLOSSINESS) r = (parameter_range){1 - r.high, 1 - r.low};
    uint64_t effects = r.low * r.low < GGX_ALPHA_MIN ? EFFECT(MIRRORS) : 0;
    if (material_transmits(m) && r.high * r.high >= GGX_ALPHA_MIN) effects |= EFFECT(ROUGH_TRANSMISSION);
    return effects;
}

bool material_emits(const kiln_material *m) {
    const float *e = m->emission.value;
    return !(m->layers & KILN_LAYER_UNLIT) && (e[0] > 0 || e[1] > 0 || e[2] > 0);
}

uint64_t material_effects(const kiln_material *m, const world_image *images) {
    const float *base = m->base_color.value;
    bool transmits = material_transmits(m), crosses = transmits || material_is_translucent(m);
    uint64_t effects = m->alpha_mode != KILN_ALPHA_OPAQUE ? EFFECT(ALPHA) : 0;
    if (!m->double_sided && !crosses) effects |= EFFECT(CULLING);
    if (m->layers & KILN_LAYER_UNLIT)
        return effects | (base[0] > 0 || base[1] > 0 || base[2] > 0 ? EFFECT(UNLIT) : 0);
    if (m->metallic.value > 0 || m->specular.value > 0) effects |= EFFECT(REFLECTION);
    if (transmits) effects |= EFFECT(TRANSMISSION);
    if (transmits || effects & EFFECT(REFLECTION)) effects |= roughness_effects(m, images);
    if (material_is_translucent(m)) effects |= EFFECT(DIFFUSE_TRANSMISSION);
    if (m->layers & KILN_LAYER_ANISOTROPY) effects |= EFFECT(ANISOTROPY);
    if (m->layers & KILN_LAYER_IRIDESCENCE) effects |= EFFECT(IRIDESCENCE);
    if (m->layers & KILN_LAYER_SHEEN) effects |= EFFECT(SHEEN);
    if (m->layers & KILN_LAYER_CLEARCOAT) effects |= EFFECT(CLEARCOAT);
    if (m->layers & KILN_LAYER_VOLUME) effects |= volume_effects(m);
    if (material_emits(m)) effects |= EFFECT(AREA_LIGHTS);
    if (material_emits(m) && (m->alpha_mode != KILN_ALPHA_OPAQUE || m->layers & KILN_LAYER_CLEARCOAT)) effects |= EFFECT(TEXTURED_LIGHTS);
    return effects;
}
