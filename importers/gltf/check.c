#include "importers/gltf/reader.h"

#include "importers/gltf/accessor.h"

static const char repair[] = "repair the file in the tool that wrote it";

bool gltf_check_index(const gltf_reader *r, int index, size_t count, bool none_allowed, const char *noun,
                      const kiln_where *where) {
    if (index < 0 ? none_allowed && index == -1 : (size_t)index < count) return true;
    return report_error(r->report, KILN_CODE_REFERENCE, where, repair, "%s %d does not exist (the file has %zu)", noun,
                        index, count);
}

bool gltf_check_key(const gltf_reader *r, int index, size_t count, const char *noun, const kiln_where *object,
                    const char *key) {
    kiln_where where = where_key(object, key);
    return gltf_check_index(r, index, count, true, noun, &where);
}

static bool check_list(const gltf_reader *r, gltf_indices list, size_t count, const char *noun, const kiln_where *object,
                       const char *key) {
    for (size_t i = 0; i < list.count; i++) {
        kiln_where where = where_item(object, key, i);
        if (!gltf_check_index(r, list.items[i], count, false, noun, &where)) return false;
    }
    return true;
}

static bool check_views(const gltf_reader *r) {
    for (size_t i = 0; i < r->document.view_count; i++) {
        const gltf_view *v = &r->document.views[i];
        kiln_where where = where_item(&r->file, "bufferViews", i);
        kiln_where buffer = where_key(&where, "buffer");
        if (!gltf_check_index(r, v->buffer, r->envelope.buffers.count, false, "buffer", &buffer)) return false;
        size_t size = (size_t)r->envelope.buffers.items[v->buffer].byte_length;
        if (v->offset > size || v->length > size - v->offset)
            return report_error(r->report, KILN_CODE_RANGE, &where, repair,
                                "%zu bytes from %zu on reach beyond the %zu of buffer %d", v->length, v->offset, size,
                                v->buffer);
    }
    return true;
}

static bool check_attributes(const gltf_reader *r, gltf_attributes list, const kiln_where *where) {
    for (size_t i = 0; i < list.count; i++)
        if (!gltf_check_key(r, list.items[i].accessor, r->document.accessor_count, "accessor", where, list.items[i].name))
            return false;
    return true;
}

static bool check_primitive(const gltf_reader *r, const gltf_primitive *p, const kiln_where *where) {
    const gltf_document *d = &r->document;
    kiln_where attributes = where_key(where, "attributes");
    if (p->mode < 0 || p->mode > 6) {
        kiln_where mode = where_key(where, "mode");
        return report_error(r->report, KILN_CODE_RANGE, &mode, repair, "%d is no primitive mode (0 to 6)", p->mode);
    }
    if (!check_attributes(r, p->attributes, &attributes) ||
        !gltf_check_key(r, p->indices, d->accessor_count, "accessor", where, "indices") ||
        !gltf_check_key(r, p->material, d->material_count, "material", where, "material"))
        return false;
    for (size_t t = 0; t < p->target_count; t++) {
        kiln_where target = where_item(where, "targets", t);
        if (!check_attributes(r, p->targets[t], &target)) return false;
    }
    return true;
}

static bool check_meshes(const gltf_reader *r) {
    for (size_t m = 0; m < r->document.mesh_count; m++) {
        kiln_where mesh = where_item(&r->file, "meshes", m);
        for (size_t p = 0; p < r->document.meshes[m].primitive_count; p++) {
            kiln_where where = where_item(&mesh, "primitives", p);
            if (!check_primitive(r, &r->document.meshes[m].primitives[p], &where)) return false;
        }
    }
    return true;
}

static bool check_textures(const gltf_reader *r) {
    const gltf_document *d = &r->document;
    for (size_t i = 0; i < d->texture_count; i++) {
        kiln_where where = where_item(&r->file, "textures", i);
        if (!gltf_check_key(r, d->textures[i].sampler, d->sampler_count, "sampler", &where, "sampler") ||
            !gltf_check_key(r, d->textures[i].source, r->envelope.images.count, "image", &where, "source"))
            return false;
    }
    for (size_t i = 0; i < r->envelope.images.count; i++) {
        const gltf_source *image = &r->envelope.images.items[i];
        kiln_where where = where_item(&r->file, "images", i);
        if (!gltf_check_key(r, image->buffer_view, d->view_count, "buffer view", &where, "bufferView")) return false;
        if (image->uri.at && image->buffer_view >= 0)
            return report_error(r->report, KILN_CODE_SYNTAX, &where, repair, "an image with both uri and bufferView");
    }
    return true;
}

static bool check_skins(const gltf_reader *r) {
    const gltf_document *d = &r->document;
    for (size_t i = 0; i < d->skin_count; i++) {
        const gltf_skin *s = &d->skins[i];
        kiln_where where = where_item(&r->file, "skins", i);
        if (!check_list(r, s->joints, d->node_count, "node", &where, "joints") ||
            !gltf_check_key(r, s->skeleton, d->node_count, "node", &where, "skeleton") ||
            !gltf_check_key(r, s->inverse_bind_matrices, d->accessor_count, "accessor", &where, "inverseBindMatrices"))
            return false;
    }
    return true;
}

static bool check_animation(const gltf_reader *r, const gltf_animation *a, const kiln_where *where) {
    const gltf_document *d = &r->document;
    for (size_t i = 0; i < a->channel_count; i++) {
        kiln_where channel = where_item(where, "channels", i), target = where_key(&channel, "target");
        if (!gltf_check_key(r, a->channels[i].sampler, a->sampler_count, "sampler", &channel, "sampler") ||
            !gltf_check_key(r, a->channels[i].node, d->node_count, "node", &target, "node"))
            return false;
    }
    for (size_t i = 0; i < a->sampler_count; i++) {
        kiln_where sampler = where_item(where, "samplers", i);
        if (!gltf_check_key(r, a->samplers[i].input, d->accessor_count, "accessor", &sampler, "input") ||
            !gltf_check_key(r, a->samplers[i].output, d->accessor_count, "accessor", &sampler, "output"))
            return false;
    }
    return true;
}

static bool check_animations(const gltf_reader *r) {
    for (size_t i = 0; i < r->document.animation_count; i++) {
        kiln_where where = where_item(&r->file, "animations", i);
        if (!check_animation(r, &r->document.animations[i], &where)) return false;
    }
    return true;
}

bool gltf_check_document(gltf_reader *r) {
    return check_views(r) && accessors_check(r) && check_meshes(r) && check_textures(r) && gltf_check_nodes(r) &&
           check_skins(r) && check_animations(r);
}
