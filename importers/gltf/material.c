#include "importers/gltf/material.h"

#include <math.h>
#include <string.h>

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

void gltf_use_alpha(kiln_material *out, double factor) {
    out->opacity = (kiln_param1){.value = 1}; /* OPAQUE ignores it, section 3.9.4 */
    if (out->alpha_mode == KILN_ALPHA_OPAQUE) return;
    out->opacity = (kiln_param1){(float)factor, out->base_color.texture};
    out->opacity.texture.transfer = KILN_TRANSFER_DATA;
    out->opacity.texture.channel = 3;
}

/* Section 3.9.2 (metallic-roughness): metalness in B, roughness in G; alpha is the base colour's. */
static bool read_metallic_roughness(gltf_reader *r, const gltf_material *m, kiln_material *out,
                                    const kiln_where *material) {
    kiln_where pbr = where_key(material, "pbrMetallicRoughness"), color = where_key(&pbr, "baseColorTexture"),
               surface = where_key(&pbr, "metallicRoughnessTexture");
    copy_color(out->base_color.value, m->base_color);
    out->metallic.value = (float)m->metallic;
    out->roughness.value = (float)m->roughness;
    if (!gltf_read_texture(r, &m->base_color_texture, KILN_TRANSFER_SRGB, 0, &out->base_color.texture, &color) ||
        !gltf_read_texture(r, &m->metallic_roughness_texture, KILN_TRANSFER_DATA, 2, &out->metallic.texture, &surface))
        return false;
    out->roughness.texture = out->metallic.texture;
    out->roughness.texture.channel = 1;
    gltf_use_alpha(out, m->base_color[3]);
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

/* "extras": {"priority": 2}: which of overlapping volumes is there. */
static void read_priority(gltf_reader *r, const gltf_material *m, kiln_material *out, const kiln_where *material) {
    const gltf_value *v = value_member(&m->extras, "priority");
    if (!v) return;
    if (v->kind == GLTF_NUMBER && fabs(v->number) <= INT32_MAX && v->number == (double)(int32_t)v->number) {
        out->priority = (int32_t)v->number;
        return;
    }
    kiln_where list = where_key(material, "extras"), where = where_key(&list, "priority");
    report_warning(r->report, KILN_CODE_IGNORED, &where, "give a whole number",
                   "the priority is not understood: it is left out");
}

static bool add_material(gltf_reader *r, size_t index) {
    const gltf_material *m = &r->document.materials[index];
    kiln_where where = where_item(&r->file, "materials", index);
    kiln_material material = kiln_material_default();
    material.name = m->name;
    material.double_sided = m->double_sided;
    if (!read_alpha(r, m, &material, &where) ||
        (!gltf_is_specular_glossy(m) && !read_metallic_roughness(r, m, &material, &where)) ||
        !read_maps(r, m, &material, &where) || !gltf_read_layers(r, m, &material, &where))
        return false;
    read_priority(r, m, &material, &where);
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
