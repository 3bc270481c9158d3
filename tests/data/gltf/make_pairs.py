#!/usr/bin/env python3
"""Writes pairs/NAME_a.gltf and pairs/NAME_b.gltf: two files that differ in one feature alone.

Everything starts from the scene of pair_scene.py. Each feature below is a function that changes the document of the b
file; where the base does not show the feature, `both` prepares the two.
"""
import base64
import copy
import os
import struct

from pair_scene import (ALPHA, BYTE, COLORS, COLORS_16, GRID, MASK, NORMALS, PACK, SHORT, SURFACE, TRIANGLES, UBYTE,
                        UINT, USHORT, WEBP, base, bend, png, uri)

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "pairs")
PAIRS = {}


def pair(name, both=None):
    def register(function):
        assert name not in PAIRS, name
        PAIRS[name] = (both, function)
        return function
    return register


def simple(name, change, both=None):
    pair(name, both)(change)


# Accessors.

@pair("accessor_sparse")
def _(s):
    indices = s.view(struct.pack("<2H", 4, 8))
    values = s.view(struct.pack("<6f", 0, 0, 0.8, 1.3, 1.3, 0))
    s.json["accessors"][s.attributes["POSITION"]]["sparse"] = {
        "count": 2, "indices": {"bufferView": indices, "componentType": USHORT}, "values": {"bufferView": values}}


def strided(s):
    packed = b"".join(struct.pack("<6f", x, y, bend(x, y), 0.8 * x, 0.8 * y, 0) for x, y in GRID + GRID)
    s.json["accessors"][s.attributes["POSITION"]]["bufferView"] = s.view(packed, byteStride=24)


simple("accessor_stride", lambda s: s.json["bufferViews"][-1].update(byteStride=28), strided)
simple("accessor_offset", lambda s: s.json["accessors"][s.attributes["POSITION"]].update(byteOffset=12), strided)


def byte_colors(component, top):
    def both(s):
        values = [(top, top // 2, top // (2 + i), top) for i in range(9)]
        s.attributes["COLOR_0"] = s.accessor(values, "VEC4", component, normalized=True)
    return both


def drop_color(s):
    del s.attributes["COLOR_0"]


simple("color_u8", drop_color, byte_colors(UBYTE, 255))
simple("color_u16", drop_color, byte_colors(USHORT, 65535))


@pair("color_float_rgb")
def _(s):
    s.attributes["COLOR_0"] = s.accessor([(1, 0.1 * i, 0.5) for i in range(9)], "VEC3")


def color_alpha(s):
    s.material["alphaMode"] = "BLEND"
    s.attributes["COLOR_0"] = s.accessor([(1, 1, 1, 1)] * 9, "VEC4")


@pair("color_alpha", color_alpha)
def _(s):
    s.attributes["COLOR_0"] = s.accessor([(1, 1, 1, 0.1 * i) for i in range(9)], "VEC4")


def texcoord(component, top):
    def change(s):
        values = [(int(top * (0.5 + 0.5 * x)), int(top * (0.5 - 0.5 * y))) for x, y in GRID]
        s.attributes["TEXCOORD_0"] = s.accessor(values, "VEC2", component, normalized=True)
    return change


simple("texcoord_u8", texcoord(UBYTE, 255))
simple("texcoord_u16", texcoord(USHORT, 65535))


def two_sets(s):
    s.attributes["TEXCOORD_1"] = s.accessor([(0.1 * x, 0.3 * y) for x, y in GRID], "VEC2")


simple("texcoord_set", lambda s: s.pbr["baseColorTexture"].update(texCoord=1), two_sets)


def indices_as(component):
    def both(s):
        s.primitive["indices"] = s.accessor(TRIANGLES, "SCALAR", component)
    return both


def fewer(s):
    s.json["accessors"][s.primitive["indices"]]["count"] = 12


simple("indices_u8", fewer, indices_as(UBYTE))
simple("indices_u16", fewer, indices_as(USHORT))
simple("indices_u32", fewer, indices_as(UINT))


def strip(s):
    s.primitive["indices"] = s.accessor([0, 1, 3, 4, 6, 7], "SCALAR", USHORT)


@pair("indices_absent", strip)
def _(s):
    del s.primitive["indices"]


simple("mode_strip", lambda s: s.primitive.update(mode=5), strip)
simple("mode_fan", lambda s: s.primitive.update(mode=6), strip)
simple("mode_points", lambda s: s.primitive.update(mode=0))
simple("mode_lines", lambda s: s.primitive.update(mode=1))


def quantized(normalized, component, scale):
    def both(s):
        s.use("KHR_mesh_quantization")
        s.json["extensionsRequired"] = ["KHR_mesh_quantization"]
        values = [(int(scale * x), int(scale * y), int(scale * bend(x, y)), 0) for x, y in GRID]
        data = struct.pack("<36" + PACK[component], *[v for row in values for v in row])
        view = s.view(data, byteStride=8 if component == SHORT else 4)
        s.json["accessors"].append({"bufferView": view, "componentType": component, "count": 9, "type": "VEC3",
                                    "normalized": normalized})
        s.attributes["POSITION"] = len(s.json["accessors"]) - 1
        if not normalized:
            s.node["scale"] = [1 / scale] * 3
    return both


def smaller(s):
    s.node["scale"] = [0.7 * v for v in s.node.get("scale", [1, 1, 1])]


simple("quantized_i8_normalized", smaller, quantized(True, BYTE, 127))
simple("quantized_i16_normalized", smaller, quantized(True, SHORT, 32767))
simple("quantized_i16", smaller, quantized(False, SHORT, 1000))


# Attributes.

simple("normals_absent", lambda s: s.attributes.pop("NORMAL"))


def mapped(s):
    s.material["normalTexture"] = s.image(NORMALS)


@pair("tangents_given", mapped)
def _(s):
    s.attributes["TANGENT"] = s.accessor([(0, 1, 0, -1)] * 9, "VEC4")


def tangents(s):
    mapped(s)
    s.attributes["TANGENT"] = s.accessor([(1, 0, 0, 1)] * 9, "VEC4")


@pair("tangents_handedness", tangents)
def _(s):
    s.attributes["TANGENT"] = s.accessor([(1, 0, 0, -1)] * 9, "VEC4")


# Nodes.

simple("node_matrix", lambda s: s.node.update(matrix=[0.8, 0.2, 0, 0, -0.2, 0.6, 0, 0, 0, 0, 1, 0, 0.1, 0, 0, 1]))
simple("node_translation", lambda s: s.node.update(translation=[0.3, 0.1, -0.5]))
simple("node_rotation", lambda s: s.node.update(rotation=[0, 0, 0.3826834, 0.9238795]))
simple("node_scale", lambda s: s.node.update(scale=[0.5, 0.8, 1]))


def double_sided(s):
    s.material["doubleSided"] = True


simple("node_mirrored", lambda s: s.node.update(scale=[-1, 1, 1]), double_sided)


@pair("node_hierarchy")
def _(s):
    s.json["nodes"].append({"name": "parent", "translation": [0.2, 0.3, 0], "rotation": [0, 0, 0.3826834, 0.9238795],
                            "children": [0]})
    s.json["scenes"][0]["nodes"][0] = 3


@pair("node_shared_mesh")
def _(s):
    s.json["nodes"].append({"name": "copy", "mesh": 0, "translation": [0.4, 0.4, 0.5], "scale": [0.3, 0.3, 0.3]})
    s.json["scenes"][0]["nodes"].append(3)


@pair("node_visibility")
def _(s):
    s.use("KHR_node_visibility")
    s.node["extensions"] = {"KHR_node_visibility": {"visible": False}}


@pair("node_instancing")
def _(s):
    s.use("EXT_mesh_gpu_instancing")
    s.node["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {
        "TRANSLATION": s.accessor([(-0.5, 0, 0), (0.5, 0.2, 0.3)], "VEC3"),
        "ROTATION": s.accessor([(0, 0, 0, 127), (0, 0, 90, 90)], "VEC4", BYTE, normalized=True),
        "SCALE": s.accessor([(0.4, 0.4, 0.4), (0.3, 0.5, 0.3)], "VEC3")}}}


def two_scenes(s):
    s.json["nodes"].append({"name": "other", "mesh": 0, "scale": [0.4, 0.4, 0.4]})
    s.json["scenes"].append({"nodes": [3, 1, 2]})


simple("scene_default", lambda s: s.json.update(scene=1), two_scenes)


# Cameras.

simple("camera_yfov", lambda s: s.camera["perspective"].update(yfov=0.5))
simple("camera_znear", lambda s: s.camera["perspective"].update(znear=2.8))
simple("camera_zfar", lambda s: s.camera["perspective"].update(zfar=2.9))
simple("camera_zfar_infinite", lambda s: s.camera["perspective"].pop("zfar"),
       lambda s: s.camera["perspective"].update(zfar=2.9))


def orthographic(s):
    s.json["cameras"] = [{"name": "eye", "type": "orthographic",
                          "orthographic": {"xmag": 1.5, "ymag": 1.5, "znear": 0.1, "zfar": 100}}]


simple("camera_orthographic", orthographic)
simple("camera_ymag", lambda s: s.camera["orthographic"].update(xmag=1.2, ymag=1.2), orthographic)


# Lights.

simple("light_color", lambda s: s.light.update(color=[1, 0.5, 0.2]))
simple("light_intensity", lambda s: s.light.update(intensity=5))
simple("light_point", lambda s: s.light.update(type="point", intensity=30), lambda s: s.light.update(intensity=30))


def spot(s):
    s.light.update(type="spot", intensity=40, spot={"innerConeAngle": 0.1, "outerConeAngle": 0.3})


simple("light_spot", spot, lambda s: s.light.update(type="point", intensity=40))
simple("light_spot_inner", lambda s: s.light["spot"].update(innerConeAngle=0.25), spot)
simple("light_spot_outer", lambda s: s.light["spot"].update(outerConeAngle=0.2), spot)
simple("light_rotation", lambda s: s.json["nodes"][2].pop("rotation"))


# Metallic-roughness materials.

simple("material_default", lambda s: s.primitive.pop("material"))
simple("base_color_factor", lambda s: s.pbr.update(baseColorFactor=[0.2, 0.9, 0.4, 1]))
simple("base_color_texture", lambda s: s.pbr.pop("baseColorTexture"))
simple("metallic_factor", lambda s: s.pbr.update(metallicFactor=1))
simple("roughness_factor", lambda s: s.pbr.update(roughnessFactor=0.2))
simple("metallic_roughness_texture", lambda s: s.pbr.update(metallicRoughnessTexture=s.image(SURFACE)),
       lambda s: s.pbr.update(metallicFactor=1))
simple("normal_texture", mapped)
simple("normal_scale", lambda s: s.material["normalTexture"].update(scale=0.3), mapped)
simple("emissive_factor", lambda s: s.material.update(emissiveFactor=[0.3, 0.1, 0]))


def emissive(s):
    s.material["emissiveFactor"] = [0.8, 0.8, 0.8]


simple("emissive_texture", lambda s: s.material.update(emissiveTexture=s.image(COLORS)), emissive)


def alpha(s):
    s.json["images"][0]["uri"] = ALPHA


def masked(s):
    alpha(s)
    s.material["alphaMode"] = "MASK"


simple("alpha_mask", lambda s: s.material.update(alphaMode="MASK"), alpha)
simple("alpha_blend", lambda s: s.material.update(alphaMode="BLEND"), alpha)
simple("alpha_cutoff", lambda s: s.material.update(alphaCutoff=0.1), masked)
simple("alpha_factor", lambda s: s.pbr.update(baseColorFactor=[1, 1, 1, 0.5]),
       lambda s: s.material.update(alphaMode="BLEND"))


def turned(s):
    s.node["rotation"] = [0, 1, 0, 0]


simple("double_sided", double_sided, turned)


# Samplers and images.

def sampler(**more):
    def both(s):
        s.json["samplers"] = [dict(more)]
        s.json["textures"][0]["sampler"] = 0
    return both


simple("wrap_s_clamp", sampler(wrapS=33071))
simple("wrap_s_mirror", sampler(wrapS=33648))
simple("wrap_t_clamp", sampler(wrapT=33071))
simple("wrap_t_mirror", sampler(wrapT=33648))
simple("filter_nearest", sampler(magFilter=9728), sampler(magFilter=9729))
simple("filter_min_nearest", sampler(minFilter=9984), sampler(minFilter=9987))
simple("image_16_bits", lambda s: s.json["images"][0].update(uri=COLORS_16))


@pair("image_webp")
def _(s):
    s.use("EXT_texture_webp")
    s.json["images"].append({"uri": WEBP, "mimeType": "image/webp"})
    s.json["textures"][0]["extensions"] = {"EXT_texture_webp": {"source": 1}}


@pair("image_buffer_view")
def _(s):
    data = base64.b64decode(SURFACE.split(",")[1])
    s.json["images"][0] = {"bufferView": s.view(data), "mimeType": "image/png"}


def transform(**more):
    def change(s):
        s.use("KHR_texture_transform")
        s.pbr["baseColorTexture"]["extensions"] = {"KHR_texture_transform": dict(more)}
    return change


simple("transform_offset", transform(offset=[0.3, 0.1]))
simple("transform_scale", transform(scale=[0.5, 2]))
simple("transform_rotation", transform(rotation=0.5))
simple("transform_rotation_sign", transform(rotation=-0.5), transform(rotation=0.5))
simple("transform_order", transform(rotation=0.5, scale=[2, 1], offset=[0.2, 0]), transform(rotation=0.5, scale=[1, 2], offset=[0.2, 0]))
simple("transform_texcoord", transform(texCoord=1), two_sets)


# Material extensions.

def extension(name, **more):
    return lambda s: s.extend(name, dict(more))


def texture_of(name, key, where):
    return lambda s: s.material["extensions"][name].update({key: s.image(where)})


simple("emissive_strength", extension("KHR_materials_emissive_strength", emissiveStrength=3), emissive)
simple("ior", extension("KHR_materials_ior", ior=2.2))
simple("ior_zero", extension("KHR_materials_ior", ior=0))
simple("specular_factor", extension("KHR_materials_specular", specularFactor=0))
simple("specular_color", extension("KHR_materials_specular", specularColorFactor=[0.1, 1, 3]))
SPECULAR = extension("KHR_materials_specular", specularFactor=1)
simple("specular_texture", texture_of("KHR_materials_specular", "specularTexture", MASK), SPECULAR)
simple("specular_color_texture", texture_of("KHR_materials_specular", "specularColorTexture", MASK), SPECULAR)


def glass(s):
    s.pbr.update(roughnessFactor=0)
    s.extend("KHR_materials_transmission", {"transmissionFactor": 1})
    s.json["meshes"].append(copy.deepcopy(s.json["meshes"][0]))
    s.json["meshes"][1]["name"] = "wall"
    s.json["materials"].append({"name": "wall", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})
    s.json["meshes"][1]["primitives"][0]["material"] = 1
    s.json["nodes"].append({"name": "wall", "mesh": 1, "translation": [0.2, 0, -1]})
    s.json["scenes"][0]["nodes"].append(3)


def solid(s):
    glass(s)
    double_sided(s)
    s.extend("KHR_materials_volume", {"thicknessFactor": 1, "attenuationDistance": 0.5})


simple("transmission_factor", lambda s: s.material["extensions"]["KHR_materials_transmission"].update(transmissionFactor=0), glass)
simple("transmission_rough", lambda s: s.pbr.update(roughnessFactor=0.5), glass)
simple("transmission_texture", texture_of("KHR_materials_transmission", "transmissionTexture", MASK), glass)
VOLUME = "KHR_materials_volume"
simple("volume_thickness", lambda s: s.material["extensions"][VOLUME].update(thicknessFactor=0), solid)
simple("volume_attenuation_color", lambda s: s.material["extensions"][VOLUME].update(attenuationColor=[0.9, 0.3, 0.1]), solid)


def colored(s):
    solid(s)
    s.material["extensions"][VOLUME].update(attenuationColor=[0.9, 0.3, 0.1])


simple("volume_attenuation_distance", lambda s: s.material["extensions"][VOLUME].update(attenuationDistance=5), colored)
simple("volume_distance_infinite", lambda s: s.material["extensions"][VOLUME].pop("attenuationDistance"), colored)
simple("unlit", extension("KHR_materials_unlit"))


# Subdivision.

simple("subdivision_scheme", lambda s: s.json["meshes"][0].update(extras={"subdivision": {"scheme": "loop", "level": 2}}))
simple("subdivision_node", lambda s: s.node.update(extras={"subdivision": "catmull-clark"}))
simple("subdivision_crease", lambda s: s.json["meshes"][0]["extras"]["subdivision"].update(creases=[[3, 4, 10], [4, 5, 2.5]], corners=[[4, 10]]),
       lambda s: s.json["meshes"][0].update(extras={"subdivision": {"scheme": "catmull-clark", "level": 2}}))


def octagon(s):
    """The sheet's rim as one polygon: the fan from its first corner has triangles that also pair up as quads."""
    rim = [0, 1, 2, 5, 8, 7, 6, 3]
    s.json["meshes"][0]["extras"] = {"subdivision": 2}
    s.primitive["indices"] = s.accessor([v for k in range(1, 7) for v in (rim[0], rim[k], rim[k + 1])], "SCALAR", USHORT)


@pair("subdivision_ngons", octagon)
def _(s):
    s.use("FB_ngon_encoding")
    s.primitive["extensions"] = {"FB_ngon_encoding": {}}


def main():
    os.makedirs(FOLDER, exist_ok=True)
    for name, (both, change) in PAIRS.items():
        for side in "ab":
            scene = base()
            if both:
                both(scene)
            if side == "b":
                change(scene)
            scene.write(os.path.join(FOLDER, "%s_%s.gltf" % (name, side)))
    print("%d pairs" % len(PAIRS))


if __name__ == "__main__":
    main()
