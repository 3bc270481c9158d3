#include <string.h>

#include "importers/gltf/reader.h"
#include "importers/gltf/texture.h"
#include "importers/gltf/value.h"

static void copy_color(float out[3], const double in[3]) {
    for (int k = 0; k < 3; k++) out[k] = (float)in[k];
}

static bool read_alpha(gltf_reader *r, const gltf_material *m, kiln_material *out, const kiln_where *where) {
    static const struct { const char *name; kiln_alpha_mode mode; } rows[] = {
        {"OPAQUE", KILN_ALPHA_OPAQUE}, {"MASK", KILN_ALPHA_MASK}, {"BLEND", KILN_ALPHA_BLEND}};
    out->alpha_cutoff = (float)m->alpha_cutoff;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (strcmp(m->alpha_mode, rows[i].name) == 0) {
            out->alpha_mode = rows[i].mode;
            return true;
        }
    kiln_where here = where_key(where, "alphaMode");
    return report_error(r->report, KILN_CODE_RANGE, &here, "use OPAQUE, MASK or BLEND", "\"%.40s\" is no alpha mode",
                        m->alpha_mode);
}

/* Section 3.9.2 (metallic-roughness): metalness in B, roughness in G; alpha is the base colour's. */
static bool read_metallic_roughness(gltf_reader *r, const gltf_material *m, kiln_material *out,
                                    const kiln_where *material) {
    kiln_where pbr = where_key(material, "pbrMetallicRoughness"), color = where_key(&pbr, "baseColorTexture"),
               surface = where_key(&pbr, "metallicRoughnessTexture");
    copy_color(out->base_color.value, m->base_color);
    out->opacity.value = (float)m->base_color[3];
    out->metallic.value = (float)m->metallic;
    out->roughness.value = (float)m->roughness;
    if (!gltf_read_texture(r, &m->base_color_texture, KILN_TRANSFER_SRGB, 0, &out->base_color.texture, &color) ||
        !gltf_read_texture(r, &m->metallic_roughness_texture, KILN_TRANSFER_DATA, 2, &out->metallic.texture, &surface))
        return false;
    out->roughness.texture = out->metallic.texture;
    out->roughness.texture.channel = 1;
    out->opacity.texture = out->base_color.texture;
    out->opacity.texture.transfer = KILN_TRANSFER_DATA;
    out->opacity.texture.channel = 3;
    if (out->alpha_mode == KILN_ALPHA_OPAQUE) out->opacity = (kiln_param1){.value = 1}; /* section 3.9.4 */
    return true;
}

/* The occlusion map is checked and left out: it stands for light that a path tracer computes. */
static bool read_maps(gltf_reader *r, const gltf_material *m, kiln_material *out, const kiln_where *material) {
    kiln_where normal = where_key(material, "normalTexture"), emissive = where_key(material, "emissiveTexture"),
               occlusion = where_key(material, "occlusionTexture");
    out->normal.value = (float)m->normal_texture.factor;
    copy_color(out->emission.value, m->emissive);
    return gltf_read_texture(r, &m->normal_texture, KILN_TRANSFER_DATA, 0, &out->normal.texture, &normal) &&
           gltf_read_texture(r, &m->emissive_texture, KILN_TRANSFER_SRGB, 0, &out->emission.texture, &emissive) &&
           gltf_check_key(r, m->occlusion_texture.texture, r->document.texture_count, "texture", &occlusion, "index");
}

/* Readers of one extension each; object is its value. */

static bool read_emissive_strength(gltf_reader *r, const gltf_value *object, kiln_material *out,
                                   const kiln_where *where) {
    float strength = 1;
    if (!value_float(object, "emissiveStrength", &strength, where, r->report)) return false;
    for (int k = 0; k < 3; k++) out->emission.value[k] *= strength;
    return true;
}

static bool read_ior(gltf_reader *r, const gltf_value *object, kiln_material *out, const kiln_where *where) {
    return value_float(object, "ior", &out->ior, where, r->report);
}

static bool read_specular(gltf_reader *r, const gltf_value *object, kiln_material *out, const kiln_where *where) {
    return value_float(object, "specularFactor", &out->specular.value, where, r->report) &&
           value_floats(object, "specularColorFactor", 3, out->specular_color.value, where, r->report) &&
           gltf_read_texture_member(r, object, "specularTexture", KILN_TRANSFER_DATA, 3, &out->specular.texture, where) &&
           gltf_read_texture_member(r, object, "specularColorTexture", KILN_TRANSFER_SRGB, 0, &out->specular_color.texture,
                                    where);
}

static bool read_transmission(gltf_reader *r, const gltf_value *object, kiln_material *out, const kiln_where *where) {
    out->layers |= KILN_LAYER_TRANSMISSION;
    return value_float(object, "transmissionFactor", &out->transmission.value, where, r->report) &&
           gltf_read_texture_member(r, object, "transmissionTexture", KILN_TRANSFER_DATA, 0, &out->transmission.texture,
                                    where);
}

static bool read_volume(gltf_reader *r, const gltf_value *object, kiln_material *out, const kiln_where *where) {
    out->layers |= KILN_LAYER_VOLUME;
    float distance = HUGE_VALF;
    if (!value_float(object, "thicknessFactor", &out->thickness.value, where, r->report) ||
        !gltf_read_texture_member(r, object, "thicknessTexture", KILN_TRANSFER_DATA, 1, &out->thickness.texture, where) ||
        !value_float(object, "attenuationDistance", &distance, where, r->report) ||
        !value_floats(object, "attenuationColor", 3, out->attenuation_color, where, r->report))
        return false;
    if (!(distance > 0))
        report_warning(r->report, KILN_CODE_RANGE, where, NULL,
                       "attenuationDistance must be positive: the volume is taken for clear");
    out->attenuation_distance = distance > 0 && isfinite(distance) ? distance : 0;
    return true;
}

static bool read_unlit(gltf_reader *r, const gltf_value *object, kiln_material *out, const kiln_where *where) {
    (void)r, (void)object, (void)where;
    out->layers |= KILN_LAYER_UNLIT;
    return true;
}

static bool read_extensions(gltf_reader *r, const gltf_material *m, kiln_material *out, const kiln_where *material) {
    static const struct {
        const char *name;
        bool (*read)(gltf_reader *, const gltf_value *, kiln_material *, const kiln_where *);
    } rows[] = {{"KHR_materials_emissive_strength", read_emissive_strength},
                {"KHR_materials_ior", read_ior},
                {"KHR_materials_specular", read_specular},
                {"KHR_materials_transmission", read_transmission},
                {"KHR_materials_volume", read_volume},
                {"KHR_materials_unlit", read_unlit}};
    kiln_where list = where_key(material, "extensions");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const gltf_value *object = value_member(&m->extensions, rows[i].name);
        kiln_where where = where_key(&list, rows[i].name);
        if (object && !rows[i].read(r, object, out, &where)) return false;
    }
    return true;
}

static bool add_material(gltf_reader *r, size_t index) {
    const gltf_material *m = &r->document.materials[index];
    kiln_where where = where_item(&r->file, "materials", index);
    kiln_material material = kiln_material_default();
    material.name = m->name;
    material.double_sided = m->double_sided;
    if (!read_alpha(r, m, &material, &where) || !read_metallic_roughness(r, m, &material, &where) ||
        !read_maps(r, m, &material, &where) || !read_extensions(r, m, &material, &where))
        return false;
    scene_locate(r->scene, &where);
    bool added = kiln_scene_add_material(r->scene, &material, &r->materials[index], r->report);
    scene_locate(r->scene, &r->file);
    return added;
}

bool gltf_add_materials(gltf_reader *r) {
    for (size_t i = 0; i < r->document.material_count; i++)
        if (!add_material(r, i)) return false;
    return true;
}
