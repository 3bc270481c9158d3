#!/usr/bin/env python3
"""Writes twins/EFFECT.HOW.gltf: scenes that name an effect of which nothing can be seen.

Each has a twin without any of it, plain.gltf or EFFECT.HOW.plain.gltf, that must not be told from it: neither by the
plan of effects nor by any bit of the picture.
"""
import os

from pair_scene import UBYTE, base, picture

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "twins")
BLACK = picture(lambda x, y: (0, 0, 0, 0), 4)
WHITE = picture(lambda x, y: (255, 255, 255, 255), 4)
FLAT = picture(lambda x, y: (127 + (x + y) % 2, 128, 255), 3)
SOLID_COLORS = picture(lambda x, y: (60 + 60 * x, 60 + 60 * y, 90 + 30 * ((x + y) % 3), 255), 4)
TWINS = {}


def twin(name, both=None):
    def register(function):
        assert name not in TWINS, name
        TWINS[name] = (both, function)
        return function
    return register


def layer(name, extension, **values):
    """An extension of the material; values that are pictures become textures."""
    @twin(name)
    def _(s):
        s.extend("KHR_materials_" + extension,
                 {k: s.image(v) if k.endswith("Texture") else v for k, v in values.items()})


layer("clearcoat.factor_0", "clearcoat", clearcoatFactor=0, clearcoatRoughnessFactor=0.3, clearcoatNormalTexture=FLAT)
layer("clearcoat.texture_0", "clearcoat", clearcoatFactor=1, clearcoatTexture=BLACK)
layer("sheen.black", "sheen", sheenColorFactor=[0, 0, 0], sheenRoughnessFactor=0.5)
layer("sheen.texture_0", "sheen", sheenColorFactor=[1, 1, 1], sheenColorTexture=BLACK)
layer("anisotropy.strength_0", "anisotropy", anisotropyStrength=0, anisotropyRotation=1)
layer("anisotropy.texture_0", "anisotropy", anisotropyStrength=1, anisotropyTexture=BLACK)
layer("iridescence.factor_0", "iridescence", iridescenceFactor=0)
layer("iridescence.texture_0", "iridescence", iridescenceFactor=1, iridescenceTexture=BLACK)
layer("iridescence.thickness_0", "iridescence", iridescenceFactor=1, iridescenceThicknessMaximum=0,
      iridescenceThicknessMinimum=0)
layer("transmission.factor_0", "transmission", transmissionFactor=0)
layer("transmission.texture_0", "transmission", transmissionFactor=1, transmissionTexture=BLACK)
layer("diffuse-transmission.factor_0", "diffuse_transmission", diffuseTransmissionFactor=0)
layer("diffuse-transmission.texture_0", "diffuse_transmission", diffuseTransmissionFactor=1,
      diffuseTransmissionTexture=BLACK)
layer("solids.not_entered", "volume", thicknessFactor=1, attenuationDistance=0.1, attenuationColor=[0.5, 0.1, 0.1])


def metal(s):
    s.pbr["metallicFactor"] = 1


@twin("transmission.all_metal", metal)
def _(s):
    s.extend("KHR_materials_transmission", {"transmissionFactor": 1})


def glass(s):
    s.extend("KHR_materials_transmission", {"transmissionFactor": 1})
    s.extend("KHR_materials_volume", {"thicknessFactor": 1})


@twin("absorption.white", glass)
def _(s):
    s.material["extensions"]["KHR_materials_volume"].update(attenuationDistance=0.1, attenuationColor=[1, 1, 1])


@twin("dispersion.factor_0", glass)
def _(s):
    s.extend("KHR_materials_dispersion", {"dispersion": 0})


@twin("diffuse-transmission.all_clear", glass)
def _(s):
    s.extend("KHR_materials_diffuse_transmission", {"diffuseTransmissionFactor": 1})


@twin("alpha.texture_255")
def _(s):
    s.material["alphaMode"] = "BLEND"
    s.pbr["baseColorTexture"] = s.image(SOLID_COLORS)


@twin("alpha.above_cutoff")
def _(s):
    s.material.update(alphaMode="MASK", alphaCutoff=0.4)
    s.pbr["baseColorFactor"] = [1, 1, 1, 0.5]


@twin("normal-maps.scale_0")
def _(s):
    s.material["normalTexture"] = dict(s.image(SOLID_COLORS), scale=0)


@twin("normal-maps.flat")
def _(s):
    s.material["normalTexture"] = s.image(FLAT)


def untextured(s):
    del s.pbr["baseColorTexture"]


@twin("textures.constant", untextured)
def _(s):
    s.pbr["baseColorTexture"] = s.image(WHITE)
    s.pbr["metallicRoughnessTexture"] = s.image(WHITE)
    s.material["emissiveTexture"] = s.image(WHITE)


@twin("vertex-colors.white")
def _(s):
    s.attributes["COLOR_0"] = s.accessor([(255, 255, 255, 255)] * 9, "VEC4", UBYTE, normalized=True)


@twin("area-lights.factor_0")
def _(s):
    s.material["emissiveTexture"] = s.image(WHITE)


@twin("area-lights.texture_0")
def _(s):
    s.material.update(emissiveFactor=[1, 1, 1], emissiveTexture=s.image(BLACK))


@twin("many-lights.one_is_black")
def _(s):
    s.json["extensions"]["KHR_lights_punctual"]["lights"].append({"name": "off", "type": "point", "intensity": 0})
    s.json["nodes"].append({"name": "off", "extensions": {"KHR_lights_punctual": {"light": 1}}})
    s.json["scenes"][0]["nodes"].append(3)


def main():
    os.makedirs(FOLDER, exist_ok=True)
    base().write(os.path.join(FOLDER, "plain.gltf"))
    for name, (both, change) in TWINS.items():
        for suffix in ["", ".plain"] if both else [""]:
            scene = base()
            if both:
                both(scene)
            if not suffix:
                change(scene)
            scene.write(os.path.join(FOLDER, name + suffix + ".gltf"))
    print("%d twins" % len(TWINS))


if __name__ == "__main__":
    main()
