#include "importers/gltf/texture.h"

#include <math.h>
#include <string.h>

#include "importers/gltf/value.h"

enum { UV_SETS_MAX = 32 };

static bool read_wrap(gltf_reader *r, int wrap, kiln_wrap *out, const kiln_where *sampler, const char *key) {
    kiln_where where = where_key(sampler, key);
    switch (wrap) {
    case 10497: *out = KILN_WRAP_REPEAT; return true;
    case 33648: *out = KILN_WRAP_MIRROR; return true;
    case 33071: *out = KILN_WRAP_CLAMP; return true;
    default:
        return report_error(r->report, KILN_CODE_RANGE, &where, "use 10497, 33648 or 33071", "%d is no wrap mode", wrap);
    }
}

/* A renderer without mipmaps magnifies wherever a sample lies: magFilter decides, and minFilter's mode inside a level
 * where there is none. NEAREST, NEAREST_MIPMAP_NEAREST, NEAREST_MIPMAP_LINEAR. */
static kiln_filter filter_of(const gltf_sampler *s) {
    int filter = s->mag_filter >= 0 ? s->mag_filter : s->min_filter;
    return filter == 9728 || filter == 9984 || filter == 9986 ? KILN_FILTER_NEAREST : KILN_FILTER_LINEAR;
}

static bool read_sampler(gltf_reader *r, int sampler, kiln_texture *out) {
    if (sampler < 0) return true; /* repeat, and filters as the renderer likes */
    const gltf_sampler *s = &r->document.samplers[sampler];
    kiln_where where = where_item(&r->file, "samplers", (size_t)sampler);
    out->filter = filter_of(s);
    return read_wrap(r, s->wrap_s, &out->wrap_u, &where, "wrapS") &&
           read_wrap(r, s->wrap_t, &out->wrap_v, &where, "wrapT");
}

/* KHR_texture_transform: offset · rotation · scale. "Rotate the UVs counter-clockwise", where v runs down: u turns
 * towards −v. The extension's example (the lower left quadrant, turned clockwise) and its test model hold for this
 * sign; its GLSL fragment has the other one. */
static bool read_transform(gltf_reader *r, const gltf_value *extensions, kiln_texture *out, const kiln_where *info) {
    const gltf_value *transform = value_member(extensions, "KHR_texture_transform");
    if (!transform) return true;
    kiln_where list = where_key(info, "extensions"), where = where_key(&list, "KHR_texture_transform");
    float offset[2] = {0, 0}, scale[2] = {1, 1};
    double rotation = 0;
    int uv_set = (int)out->uv_set;
    if (!value_floats(transform, "offset", 2, offset, &where, r->report) ||
        !value_number(transform, "rotation", &rotation, &where, r->report) ||
        !value_floats(transform, "scale", 2, scale, &where, r->report) ||
        !value_index(transform, "texCoord", &uv_set, &where, r->report))
        return false;
    float c = (float)cos(rotation), s = (float)sin(rotation);
    const float matrix[6] = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
    memcpy(out->transform, matrix, sizeof matrix);
    out->uv_set = (uint32_t)uv_set;
    return true;
}

/* EXT_texture_webp brings another source. */
static bool find_source(gltf_reader *r, const gltf_texture *t, int *source, const kiln_where *texture) {
    kiln_where list = where_key(texture, "extensions"), where = where_key(&list, "EXT_texture_webp");
    const gltf_value *webp = value_member(&t->extensions, "EXT_texture_webp");
    *source = t->source;
    if (webp && !value_index(webp, "source", source, &where, r->report)) return false;
    if (*source >= 0) return gltf_check_key(r, *source, r->envelope.images.count, "image", &where, "source");
    report_warning(r->report, KILN_CODE_IMAGE, texture, "export the texture as PNG, JPEG or WebP",
                   "the texture has no image that kiln reads: it is left out");
    return true;
}

bool gltf_read_texture(gltf_reader *r, const gltf_texture_info *info, kiln_transfer transfer, uint32_t channel,
                       kiln_texture *out, const kiln_where *where) {
    *out = (kiln_texture){0};
    if (info->texture == -1) return true;
    if (!gltf_check_key(r, info->texture, r->document.texture_count, "texture", where, "index")) return false;
    const gltf_texture *t = &r->document.textures[info->texture];
    kiln_where texture = where_item(&r->file, "textures", (size_t)info->texture);
    int source;
    if (!find_source(r, t, &source, &texture)) return false;
    if (source < 0) return true;
    out->uv_set = (uint32_t)info->uv_set;
    out->transfer = transfer;
    out->channel = channel;
    if (!read_sampler(r, t->sampler, out) || !read_transform(r, &info->extensions, out, where)) return false;
    if (out->uv_set >= UV_SETS_MAX)
        return report_error(r->report, KILN_CODE_LIMIT, where, "use a lower UV set", "TEXCOORD_%u (kiln reads %d sets)",
                            out->uv_set, UV_SETS_MAX);
    return gltf_add_image(r, source, &out->image);
}

bool gltf_read_texture_member(gltf_reader *r, const gltf_value *object, const char *key, kiln_transfer transfer,
                              uint32_t channel, kiln_texture *out, const kiln_where *where) {
    const gltf_value *value = value_member(object, key);
    *out = (kiln_texture){0};
    if (!value) return true;
    kiln_where here = where_key(where, key);
    gltf_texture_info info = {.texture = -1};
    if (!value_index(value, "index", &info.texture, &here, r->report) ||
        !value_index(value, "texCoord", &info.uv_set, &here, r->report))
        return false;
    const gltf_value *extensions = value_member(value, "extensions");
    if (extensions) info.extensions = *extensions;
    return gltf_read_texture(r, &info, transfer, channel, out, &here);
}
