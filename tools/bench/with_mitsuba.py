"""Renders a scene of scenes.py with Mitsuba 3 as often as it is told to: with_mitsuba.py SCENE SAMPLER THREADS, as
server.py says. Run by runners.py in a Python that has mitsuba and numpy."""
import pathlib
import sys
import tempfile
import time

started = time.perf_counter()
import drjit
import mitsuba as mi
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import server
from gltf_reader import Asset

mi.set_variant("llvm_ad_rgb")
drjit.set_thread_count(int(sys.argv[3]))


def rgb(color):
    return {"type": "rgb", "value": [float(c) for c in color[:3]]}


class Textures:
    """Pictures of the asset as arrays; decoded once."""

    def __init__(self, asset, folder):
        self.asset, self.folder, self.known = asset, folder, {}

    def array(self, texture):
        if texture not in self.known:
            data, suffix = self.asset.image(texture)
            path = self.folder / f"{texture}.{suffix}"
            path.write_bytes(data)
            self.known[texture] = np.array(mi.Bitmap(str(path)))
        return self.known[texture]

    def data(self, texture, channel=None, factor=1.0):
        values = self.array(texture).astype(np.float32) / 255
        values = values[..., :3] if channel is None else values[..., channel:channel + 1] * factor
        return {"type": "bitmap", "bitmap": mi.Bitmap(np.ascontiguousarray(values)), "raw": True}

    def color(self, info, factor):
        if info is None:
            return rgb(factor)
        if min(factor[:3]) < 0.999:
            raise ValueError("a texture with a factor: not in these scenes")
        picture = mi.Bitmap(np.ascontiguousarray(self.array(info["index"])[..., :3]))
        picture.set_srgb_gamma(True)
        return {"type": "bitmap", "bitmap": picture, "raw": False}


def surface(material, textures):
    """The nearest that Mitsuba has. Its 'principled' is another model than glTF's: kiln's and its references differ a
    little where it is used, which the table shows."""
    p, e = material.get("pbrMetallicRoughness", {}), material.get("extensions", {})
    base, rough = p.get("baseColorFactor", [1, 1, 1, 1]), p.get("roughnessFactor", 1.0)
    metallic = p.get("metallicFactor", 1.0)
    packed = p.get("metallicRoughnessTexture")
    if e.get("KHR_materials_transmission", {}).get("transmissionFactor", 0) > 0:
        return {"type": "dielectric", "int_ior": e.get("KHR_materials_ior", {}).get("ior", 1.5),
                "specular_transmittance": rgb(base)}
    color = textures.color(p.get("baseColorTexture"), base)
    if metallic == 1 and rough < 1e-3 and not packed:
        bsdf = {"type": "conductor", "material": "none", "specular_reflectance": rgb(base)}
    elif metallic == 0 and e.get("KHR_materials_specular", {}).get("specularFactor", 1) == 0:
        bsdf = {"type": "diffuse", "reflectance": color}
    else:
        bsdf = {"type": "principled", "base_color": color, "specular": 0.5,
                "roughness": textures.data(packed["index"], 1, rough) if packed else float(rough),
                "metallic": textures.data(packed["index"], 2, metallic) if packed else float(metallic)}
    if "normalTexture" in material:
        bsdf = {"type": "normalmap", "normalmap": textures.data(material["normalTexture"]["index"]), "bsdf": bsdf}
    return {"type": "twosided", "bsdf": bsdf}


def emission_of(material):
    strength = material.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
    return [strength * c for c in material.get("emissiveFactor", (0, 0, 0))]


def shape(asset, primitive, world, name):
    at = primitive["attributes"]
    position = asset.accessor(at["POSITION"]) @ world[:3, :3].T + world[:3, 3]
    normal = asset.accessor(at["NORMAL"]) @ np.linalg.inv(world[:3, :3])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-20)
    uv = asset.accessor(at["TEXCOORD_0"]) if "TEXCOORD_0" in at else np.zeros((len(position), 2))
    triangles = asset.accessor(primitive["indices"]).reshape(-1, 3)
    fields = "".join(f"property float {n}\n" for n in ("x", "y", "z", "nx", "ny", "nz", "u", "v"))
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(position)}\n{fields}"
            f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    faces = np.zeros(len(triangles), [("n", "u1"), ("i", "<i4", 3)])
    faces["n"], faces["i"] = 3, triangles
    name.write_bytes(head.encode() + np.hstack([position, normal, uv]).astype("<f4").tobytes() + faces.tobytes())
    return {"type": "ply", "filename": str(name)}


def sensor(camera, world, settings, sampler):
    lens = settings.get("lens")
    turned = world.copy()
    turned[:3, [0, 2]] *= -1  # Mitsuba looks along +Z, with x to the left
    view = {"type": "thinlens" if lens else "perspective", "fov": float(np.degrees(camera["perspective"]["yfov"])),
            "fov_axis": "y", "near_clip": 0.01, "far_clip": 1e4, "to_world": mi.ScalarTransform4f(turned.tolist()),
            "film": {"type": "hdrfilm", "width": settings["width"], "height": settings["height"],
                     "rfilter": {"type": "box"}, "pixel_format": "rgb", "component_format": "float32"},
            "sampler": {"type": sampler}}
    return {**view, **(lens or {})}


def scene(path, sampler, folder):
    asset = Asset(path)
    textures = Textures(asset, folder)
    settings = asset.json["scenes"][asset.json.get("scene", 0)]["extras"]["bench"]
    parts = {"type": "scene", "integrator": {"type": "path", "max_depth": settings["bounces"] + 2}}
    for index, material in enumerate(asset.json["materials"]):
        parts[f"material{index}"] = surface(material, textures)
    for node, world in asset.nodes():
        for primitive in asset.json["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            key = f"shape{len(parts)}"
            material = asset.json["materials"][primitive["material"]]
            parts[key] = {**shape(asset, primitive, world, folder / f"{key}.ply"),
                          "bsdf": {"type": "ref", "id": f"material{primitive['material']}"}}
            emission = emission_of(material)
            if max(emission) > 0:
                parts[key]["emitter"] = {"type": "area", "radiance": rgb(emission)}
        if "camera" in node:
            parts["sensor"] = sensor(asset.json["cameras"][node["camera"]], world, settings, sampler)
    if "env" in settings:
        parts["sky"] = {"type": "envmap", "filename": str(path.parent / settings["env"]["file"]),
                        "scale": settings["env"]["intensity"], "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], 90)}
    return mi.load_dict(parts)


def main():
    told = server.quiet()
    with tempfile.TemporaryDirectory() as folder:
        world = scene(pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(folder))
        server.serve(told, time.perf_counter() - started,
                     lambda spp, seed: np.array(mi.render(world, spp=spp, seed=seed))[..., :3])


main()
