#include "render/world/slots.h"

#include "render/effects/plan.h"
#include "render/effects/reduce.h"

int slots_list(const kiln_material *m, slot_use uses[SLOT_COUNT]) {
    int n = 0;
#define USE(asked, slot, from, factor) \
    if ((asked) && (from)->image) uses[n++] = (slot_use){slot, from, factor};
#define USE1(asked, slot, parameter) USE(asked, slot, &(parameter).texture, NULL)
#define USE3(asked, slot, parameter) USE(asked, slot, &(parameter).texture, (parameter).value)
    USE1(m->alpha_mode != KILN_ALPHA_OPAQUE, SLOT_OPACITY, m->opacity)
    USE3(true, m->layers & KILN_LAYER_UNLIT ? SLOT_EMISSION : SLOT_BASE, m->base_color)
    USE3(true, SLOT_EMISSION, m->emission)
    USE1(true, SLOT_NORMAL, m->normal)
    USE1(true, SLOT_METALLIC, m->metallic)
    USE1(true, SLOT_ROUGHNESS, m->roughness)
    USE1(true, SLOT_SPECULAR, m->specular)
    USE3(true, SLOT_SPECULAR_COLOR, m->specular_color)
    USE1(m->layers & KILN_LAYER_TRANSMISSION, SLOT_TRANSMISSION, m->transmission)
    USE1(m->layers & KILN_LAYER_CLEARCOAT, SLOT_CLEARCOAT, m->clearcoat)
    USE1(m->layers & KILN_LAYER_CLEARCOAT, SLOT_CLEARCOAT_ROUGHNESS, m->clearcoat_roughness)
    USE1(m->layers & KILN_LAYER_CLEARCOAT, SLOT_CLEARCOAT_NORMAL, m->clearcoat_normal)
    USE3(m->layers & KILN_LAYER_SHEEN, SLOT_SHEEN_COLOR, m->sheen_color)
    USE1(m->layers & KILN_LAYER_SHEEN, SLOT_SHEEN_ROUGHNESS, m->sheen_roughness)
    USE1(m->layers & KILN_LAYER_ANISOTROPY, SLOT_ANISOTROPY, m->anisotropy)
    USE1(m->layers & KILN_LAYER_IRIDESCENCE, SLOT_FILM, m->iridescence)
    USE(m->layers & KILN_LAYER_IRIDESCENCE, SLOT_FILM_THICKNESS, &m->iridescence_thickness_texture, NULL)
    USE1(m->layers & KILN_LAYER_DIFFUSE_TRANSMISSION, SLOT_DIFFUSE_TRANSMISSION, m->diffuse_transmission)
    USE3(m->layers & KILN_LAYER_DIFFUSE_TRANSMISSION, SLOT_DIFFUSE_TRANSMISSION_COLOR, m->diffuse_transmission_color)
#undef USE3
#undef USE1
#undef USE
    return n;
}

texel_domain slot_domain(material_slot slot) {
    return slot == SLOT_EMISSION || slot == SLOT_SPECULAR_COLOR ? TEXELS_POSITIVE : TEXELS_UNIT;
}

static bool is_direction(material_slot slot) {
    return slot == SLOT_NORMAL || slot == SLOT_CLEARCOAT_NORMAL || slot == SLOT_ANISOTROPY;
}

bool slot_is_constant(const slot_use *use, const world_image *images) {
    const world_image *image = images ? &images[use->texture->image - 1] : NULL;
    if (!image || !image->looked_at || is_direction(use->slot)) return false;
    uint32_t first = use->factor ? 0 : use->texture->channel, end = use->factor ? 3 : first + 1;
    for (uint32_t k = first; k < end; k++)
        if (image->low[k] < image->high[k]) return false;
    return true;
}

/* Where coverage decides what is seen of a texel, its neighbours would bleed into it; emission is sampled by lights too,
 * without a footprint, and so is the coat above it; the mean of normals, or of directions, is none of a rougher surface. */
bool slot_is_filtered(const kiln_material *m, const slot_use *use) {
    return m->alpha_mode == KILN_ALPHA_OPAQUE && use->texture->filter == KILN_FILTER_LINEAR &&
           use->slot != SLOT_EMISSION && use->slot != SLOT_OPACITY && !is_direction(use->slot) &&
           !(use->slot == SLOT_CLEARCOAT && material_emits(m));
}

uint64_t slots_effects(const kiln_material *m, const world_image *images, kiln_texture_filter filter) {
    slot_use uses[SLOT_COUNT];
    uint64_t effects = 0;
    for (int k = slots_list(m, uses); k-- > 0;) {
        if (slot_is_constant(&uses[k], images)) continue;
        effects |= EFFECT(TEXTURES);
        if (uses[k].slot == SLOT_NORMAL || uses[k].slot == SLOT_CLEARCOAT_NORMAL) effects |= EFFECT(NORMAL_MAPS);
        if (filter == KILN_TEXTURES_MIP && slot_is_filtered(m, &uses[k])) effects |= EFFECT(TEXTURE_FILTERING);
        if (uses[k].slot == SLOT_EMISSION && !(m->layers & KILN_LAYER_UNLIT)) effects |= EFFECT(TEXTURED_LIGHTS);
    }
    return effects;
}
