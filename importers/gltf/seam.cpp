#include "importers/gltf/seam.h"

#include <cstring>
#include <exception>
#include <limits>
#include <new>
#include <string>
#include <vector>

#include <tiny_gltf.h>

namespace {

/* Arrays in the import's arena; std::bad_alloc when memory ends, so that seam_parse reports it in one place. */
struct store {
    kiln_arena *arena;

    template <class T> T *array(size_t count) {
        T *items = static_cast<T *>(arena_array(arena, count, sizeof(T)));
        if (!items) throw std::bad_alloc();
        return items;
    }
    template <class T> const T *copy(const T *from, size_t count) {
        return static_cast<const T *>(std::memcpy(array<T>(count), from, count * sizeof(T)));
    }
    const char *string(const std::string &s) {
        return s.empty() ? "" : copy(s.c_str(), s.size() + 1);
    }
    gltf_numbers numbers(const std::vector<double> &v) {
        if (v.empty()) return {nullptr, 0};
        return {copy(v.data(), v.size()), v.size()};
    }
    gltf_indices indices(const std::vector<int> &v) {
        if (v.empty()) return {nullptr, 0};
        return {copy(v.data(), v.size()), v.size()};
    }
    /* One element of out for each of v, by the function for its type below. */
    template <class Out, class In> const Out *list(const std::vector<In> &v) {
        Out *items = array<Out>(v.size());
        for (size_t i = 0; i < v.size(); i++) items[i] = read(*this, v[i]);
        return items;
    }
    template <class Map> gltf_value object(const Map &);
    gltf_value value(const tinygltf::Value &);
};

/* JSON_DEPTH_MAX bounds the recursion. */
template <class Map> gltf_value store::object(const Map &map) {
    gltf_value v = {};
    v.kind = GLTF_OBJECT;
    v.count = map.size();
    if (map.empty()) return v;
    const char **keys = array<const char *>(map.size());
    gltf_value *items = array<gltf_value>(map.size());
    size_t i = 0;
    for (const auto &member : map) {
        keys[i] = string(member.first);
        items[i++] = value(member.second);
    }
    v.keys = keys;
    v.items = items;
    return v;
}

gltf_value store::value(const tinygltf::Value &from) {
    gltf_value v = {};
    if (from.IsObject()) return object(from.Get<tinygltf::Value::Object>());
    if (from.IsBool()) {
        v.kind = GLTF_BOOL;
        v.boolean = from.Get<bool>();
    } else if (from.IsNumber()) {
        v.kind = GLTF_NUMBER;
        v.number = from.GetNumberAsDouble();
    } else if (from.IsString()) {
        v.kind = GLTF_STRING;
        v.string = string(from.Get<std::string>());
    } else if (from.IsArray()) {
        const tinygltf::Value::Array &array_value = from.Get<tinygltf::Value::Array>();
        gltf_value *items = array<gltf_value>(array_value.size());
        for (size_t i = 0; i < array_value.size(); i++) items[i] = value(array_value[i]);
        v.kind = GLTF_ARRAY;
        v.count = array_value.size();
        v.items = items;
    }
    return v;
}

gltf_view read(store &, const tinygltf::BufferView &v) { return {v.buffer, v.byteOffset, v.byteLength, v.byteStride}; }

gltf_accessor read(store &, const tinygltf::Accessor &a) {
    gltf_accessor out = {};
    out.view = a.bufferView;
    out.offset = a.byteOffset;
    out.count = a.count;
    out.component_type = a.componentType;
    out.normalized = a.normalized;
    switch (a.type) {
    case TINYGLTF_TYPE_MAT2: out.rows = out.columns = 2; break;
    case TINYGLTF_TYPE_MAT3: out.rows = out.columns = 3; break;
    case TINYGLTF_TYPE_MAT4: out.rows = out.columns = 4; break;
    default:
        out.rows = static_cast<uint32_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(a.type)));
        out.columns = 1;
    }
    if (!a.sparse.isSparse) return out;
    const auto &s = a.sparse; /* its integers are int in 2.7 and size_t in 2.9 */
    out.sparse.count = static_cast<size_t>(s.count);
    out.sparse.indices_view = s.indices.bufferView;
    out.sparse.indices_type = s.indices.componentType;
    out.sparse.indices_offset = static_cast<size_t>(s.indices.byteOffset);
    out.sparse.values_view = s.values.bufferView;
    out.sparse.values_offset = static_cast<size_t>(s.values.byteOffset);
    return out;
}

gltf_attributes read(store &s, const std::map<std::string, int> &from) {
    gltf_attribute *items = s.array<gltf_attribute>(from.size());
    size_t i = 0;
    for (const auto &member : from) items[i++] = {s.string(member.first), member.second};
    return {items, from.size()};
}

gltf_primitive read(store &s, const tinygltf::Primitive &p) {
    return {read(s, p.attributes), s.list<gltf_attributes>(p.targets), p.targets.size(), p.indices, p.material, p.mode,
            s.object(p.extensions)};
}

gltf_mesh read(store &s, const tinygltf::Mesh &m) {
    return {s.string(m.name), s.list<gltf_primitive>(m.primitives), m.primitives.size(), s.value(m.extras)};
}

gltf_node read(store &s, const tinygltf::Node &n) {
    return {s.string(n.name),         n.mesh,                n.skin,
            n.camera,                 s.indices(n.children), s.numbers(n.matrix),
            s.numbers(n.translation), s.numbers(n.rotation), s.numbers(n.scale),
            s.object(n.extensions),   s.value(n.extras)};
}

gltf_indices read(store &s, const tinygltf::Scene &scene) { return s.indices(scene.nodes); }

gltf_texture_info read(store &s, const tinygltf::TextureInfo &t) {
    return {t.index, t.texCoord, 1, s.object(t.extensions)};
}
gltf_texture_info read(store &s, const tinygltf::NormalTextureInfo &t) {
    return {t.index, t.texCoord, t.scale, s.object(t.extensions)};
}
gltf_texture_info read(store &s, const tinygltf::OcclusionTextureInfo &t) {
    return {t.index, t.texCoord, t.strength, s.object(t.extensions)};
}

gltf_material read(store &s, const tinygltf::Material &m) {
    const tinygltf::PbrMetallicRoughness &pbr = m.pbrMetallicRoughness;
    gltf_material out = {};
    out.name = s.string(m.name);
    out.alpha_mode = s.string(m.alphaMode);
    for (size_t i = 0; i < 4; i++) out.base_color[i] = pbr.baseColorFactor.at(i);
    for (size_t i = 0; i < 3; i++) out.emissive[i] = m.emissiveFactor.at(i);
    out.metallic = pbr.metallicFactor;
    out.roughness = pbr.roughnessFactor;
    out.alpha_cutoff = m.alphaCutoff;
    out.double_sided = m.doubleSided;
    out.base_color_texture = read(s, pbr.baseColorTexture);
    out.metallic_roughness_texture = read(s, pbr.metallicRoughnessTexture);
    out.normal_texture = read(s, m.normalTexture);
    out.occlusion_texture = read(s, m.occlusionTexture);
    out.emissive_texture = read(s, m.emissiveTexture);
    out.extensions = s.object(m.extensions);
    out.extras = s.value(m.extras);
    return out;
}

gltf_texture read(store &s, const tinygltf::Texture &t) { return {t.sampler, t.source, s.object(t.extensions)}; }
gltf_sampler read(store &, const tinygltf::Sampler &t) { return {t.magFilter, t.minFilter, t.wrapS, t.wrapT}; }

gltf_camera read(store &s, const tinygltf::Camera &c) {
    const auto &p = c.perspective;
    const auto &o = c.orthographic;
    bool ortho = c.type == "orthographic";
    return {s.string(c.name), ortho, p.aspectRatio, p.yfov, o.xmag, o.ymag, ortho ? o.znear : p.znear,
            ortho ? o.zfar : p.zfar};
}

gltf_light read(store &s, const tinygltf::Light &l) {
    return {s.string(l.name), s.string(l.type), s.numbers(l.color), l.intensity, l.spot.innerConeAngle,
            l.spot.outerConeAngle};
}

gltf_skin read(store &s, const tinygltf::Skin &skin) {
    return {s.indices(skin.joints), skin.inverseBindMatrices, skin.skeleton};
}
gltf_channel read(store &, const tinygltf::AnimationChannel &c) { return {c.sampler, c.target_node}; }
gltf_animation_sampler read(store &, const tinygltf::AnimationSampler &a) { return {a.input, a.output}; }
gltf_animation read(store &s, const tinygltf::Animation &a) {
    return {s.list<gltf_channel>(a.channels), s.list<gltf_animation_sampler>(a.samplers), a.channels.size(),
            a.samplers.size()};
}

void read_document(store &s, const tinygltf::Model &m, gltf_document *d) {
    d->views = s.list<gltf_view>(m.bufferViews), d->view_count = m.bufferViews.size();
    d->accessors = s.list<gltf_accessor>(m.accessors), d->accessor_count = m.accessors.size();
    d->meshes = s.list<gltf_mesh>(m.meshes), d->mesh_count = m.meshes.size();
    d->nodes = s.list<gltf_node>(m.nodes), d->node_count = m.nodes.size();
    d->scenes = s.list<gltf_indices>(m.scenes), d->scene_count = m.scenes.size();
    d->materials = s.list<gltf_material>(m.materials), d->material_count = m.materials.size();
    d->textures = s.list<gltf_texture>(m.textures), d->texture_count = m.textures.size();
    d->samplers = s.list<gltf_sampler>(m.samplers), d->sampler_count = m.samplers.size();
    d->cameras = s.list<gltf_camera>(m.cameras), d->camera_count = m.cameras.size();
    d->lights = s.list<gltf_light>(m.lights), d->light_count = m.lights.size();
    d->skins = s.list<gltf_skin>(m.skins), d->skin_count = m.skins.size();
    d->animations = s.list<gltf_animation>(m.animations), d->animation_count = m.animations.size();
    d->scene = m.defaultScene;
}

/* Nothing is ever opened: there are no URIs left in the JSON. Should two parsers disagree about that, these refuse. */
template <class Callbacks> auto refuse_sizes(Callbacks &c, int) -> decltype(void(c.GetFileSizeInBytes)) {
    c.GetFileSizeInBytes = [](size_t *, std::string *, const std::string &, void *) { return false; }; /* since 2.9 */
}
template <class Callbacks> void refuse_sizes(Callbacks &, long) {}

void refuse_files(tinygltf::TinyGLTF &parser) {
    tinygltf::FsCallbacks callbacks = {};
    callbacks.FileExists = [](const std::string &, void *) { return false; };
    callbacks.ExpandFilePath = [](const std::string &path, void *) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char> *, std::string *, const std::string &, void *) { return false; };
    callbacks.WriteWholeFile = [](std::string *, const std::string &, const std::vector<unsigned char> &, void *) {
        return false;
    };
    refuse_sizes(callbacks, 0);
    parser.SetFsCallbacks(callbacks);
}

/* tinygltf's messages end in newlines; the first line says most. */
bool refuse(const std::string &messages, const kiln_where *file, kiln_report *report) {
    std::string line = messages.substr(0, messages.find('\n'));
    return report_error(report, KILN_CODE_SYNTAX, file, "export the file again, or repair it", "%.300s",
                        line.empty() ? "the file is not valid glTF" : line.c_str());
}

bool parse(const char *json, size_t size, gltf_document *document, kiln_arena *arena, const kiln_where *file,
           kiln_report *report) {
    if (size > std::numeric_limits<int>::max())
        return report_error(report, KILN_CODE_LIMIT, file, "move the data into binary buffers",
                            "more than 2 GiB of JSON");
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    std::string errors, warnings;
    refuse_files(parser);
    bool parsed = parser.LoadASCIIFromString(&model, &errors, &warnings, json, static_cast<unsigned>(size), "");
    /* What it complains about and then reads is optional in the specification (a skin's matrices, a channel's node);
     * schema_check has found the rest. */
    if (!parsed) return refuse(errors, file, report);
    store s = {arena};
    read_document(s, model, document);
    return true;
}

} // namespace

bool seam_parse(const char *json, size_t size, gltf_document *document, kiln_arena *arena, const kiln_where *file,
                kiln_report *report) {
    *document = {};
    try {
        return parse(json, size, document, arena, file, report);
    } catch (const std::bad_alloc &) {
        return report_no_memory(report, "parsing glTF");
    } catch (const std::exception &e) {
        return refuse(e.what(), file, report);
    } catch (...) {
        return report_error(report, KILN_CODE_INTERNAL, file, nullptr, "tinygltf failed");
    }
}
