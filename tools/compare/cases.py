"""The table of what is compared: each case is one material as glTF, as Mitsuba's dictionary and as Cycles' nodes.

A grid is {"id", "title", "about", "cases"}; a case {"id", "label", "gltf", "mitsuba", "cycles", "exact"}. "mitsuba" and
"cycles" are None where the renderer has no such material. "exact" names what exact.py makes of the case for each
renderer:
where two forms of a model differ, their ratio is what the pictures are expected to differ by."""
import math


def rgb(color):
    return {"type": "rgb", "value": [float(c) for c in color]}


def gltf(base=(1, 1, 1), metallic=0.0, roughness=0.0, **extensions):
    return {"pbrMetallicRoughness": {"baseColorFactor": [*base, 1], "metallicFactor": metallic,
        "roughnessFactor": roughness},
            "extensions": {f"KHR_materials_{name}": value for name, value in extensions.items()}}


def principled(base=(1, 1, 1), **inputs):
    return {"Surface": {"node": "ShaderNodeBsdfPrincipled", "set": {"distribution": "MULTI_GGX"},
                        "inputs": {"Base Color": list(base), **{k.replace("_", " "): v for k, v in inputs.items()}}}}


def glass(ior, roughness, color=(1, 1, 1)):
    return {"Surface": {"node": "ShaderNodeBsdfGlass", "set": {"distribution": "MULTI_GGX"},
                        "inputs": {"Color": list(color), "Roughness": roughness, "IOR": ior}}}


def metal():
    for name, base in (("white", (1, 1, 1)), ("copper", (0.9, 0.5, 0.3))):
        for roughness in (0.1, 0.3, 0.6, 1.0):
            yield {"id": f"metal-{name}-{roughness}", "label": f"{name} {roughness}",
                   "gltf": gltf(base, 1.0, roughness),
                   "mitsuba": {"bsdf": {"type": "principled", "base_color": rgb(base), "metallic": 1.0,
                                        "roughness": roughness}},
                   "cycles": principled(base, Metallic=1.0, Roughness=roughness),
                   "exact": {"model": "metal", "base": base, "alpha": roughness**2}}


def conductor():
    for name, base in (("white", (1, 1, 1)), ("copper", (0.9, 0.5, 0.3))):
        node = {"node": "ShaderNodeBsdfPrincipled", "inputs": {"Base Color": list(base), "Metallic": 1.0,
            "Roughness": 0.0}}
        yield {"id": f"mirror-{name}", "label": name, "gltf": gltf(base, 1.0, 0.0),
               "mitsuba": {"bsdf": {"type": "principled", "base_color": rgb(base), "metallic": 1.0, "roughness": 0.0}}
               if name != "white" else {"bsdf": {"type": "conductor", "material": "none"}},
               "cycles": {"Surface": node}, "exact": {"model": "metal", "base": base, "alpha": 1e-6}}


def dielectric():
    base = (0.8, 0.4, 0.1)
    for metallic, ior in ((0.0, 1.5), (0.0, 2.0), (0.5, 1.5)):
        for roughness in (0.1, 0.5, 1.0):
            yield {"id": f"dielectric-{metallic}-{ior}-{roughness}", "label": f"m {metallic} n {ior} r {roughness}",
                   "gltf": gltf(base, metallic, roughness, ior={"ior": ior}), "mitsuba": None,
                   "cycles": principled(base, Metallic=metallic, Roughness=roughness, IOR=ior),
                   "exact": {"model": "mixed", "base": base, "alpha": roughness**2, "metallic": metallic, "ior": ior,
                             "f0": ((ior - 1) / (ior + 1))**2}}


def solid(ior, roughness, **extensions):
    return gltf((1, 1, 1), 0.0, roughness, ior={"ior": ior}, transmission={"transmissionFactor": 1},
                volume={"thicknessFactor": 1, **extensions.pop("volume", {})}, **extensions)


def rough_glass():
    for ior in (1.33, 1.5, 2.0):
        for roughness in (0.0, 0.1, 0.3, 0.6, 1.0):
            smooth = roughness == 0
            yield {"id": f"glass-{ior}-{roughness}", "label": f"n {ior} r {roughness}", "gltf": solid(ior, roughness),
                   "mitsuba": {"bsdf": {"type": "dielectric", "int_ior": ior, "ext_ior": 1.0} if smooth else
                               {"type": "roughdielectric", "int_ior": ior, "ext_ior": 1.0, "alpha": roughness**2,
                                "distribution": "ggx"}},
                   "cycles": glass(ior, roughness), "exact": {"model": "solid", "ior": ior} if smooth else None}


def thin_wall():
    for ior in (1.1, 1.33, 1.5, 2.0, 2.5):
        yield {"id": f"thin-{ior}", "label": f"n {ior}",
               "gltf": gltf((1, 1, 1), 0.0, 0.0, ior={"ior": ior}, transmission={"transmissionFactor": 1}),
               "mitsuba": {"bsdf": {"type": "thindielectric", "int_ior": ior, "ext_ior": 1.0}}, "cycles": None,
               "exact": {"model": "shell", "ior": ior}}


def absorption():
    color = (0.9, 0.5, 0.2)
    for ior in (1.0, 1.5):
        for distance in (0.5, 2.0):
            sigma = [-math.log(c) / distance for c in color]
            most = max(sigma)
            yield {"id": f"absorption-{ior}-{distance}", "label": f"n {ior} d {distance}",
                   "gltf": solid(ior, 0.0, volume={"attenuationColor": color, "attenuationDistance": distance}),
                   "mitsuba": {"bsdf": {"type": "null"} if ior == 1 else {"type": "dielectric", "int_ior": ior,
                       "ext_ior": 1.0},
                               "interior": {"type": "homogeneous", "albedo": 0.0, "scale": most,
                                            "sigma_t": rgb([s / most for s in sigma])}},
                   "cycles": {**glass(ior, 0.0), "Volume": {"node": "ShaderNodeVolumeAbsorption", "inputs": {
                       "Color": [1 - s / most for s in sigma], "Density": most}}},
                   "exact": {"model": "solid", "ior": ior, "sigma": sigma}}


def multiple_albedo(single):
    """The multiscatterColor of a single-scattering albedo: Kulla and Conty 2017, as KHR_materials_volume_scatter has
    it,
    single = 1 - (4.09712 + 4.20863 c - sqrt(9.59217 + 41.6808 c + 17.7126 c²))², solved for c by halving."""
    low, high = 0.0, 1.0
    for _ in range(60):
        c = (low + high) / 2
        root = 4.09712 + 4.20863 * c - math.sqrt(9.59217 + 41.6808 * c + 17.7126 * c * c)
        low, high = (c, high) if 1 - root * root < single else (low, c)
    return (low + high) / 2


def scattering():
    sigma = 2.0
    for ior in (1.0, 1.5):
        for g, albedo in ((-0.5, 0.8), (0.0, 0.5), (0.0, 0.99), (0.5, 0.8), (0.9, 0.99)):
            colors = [multiple_albedo(albedo)] * 3
            volume = {"node": "ShaderNodeAddShader", "inputs": {
                "0": {"node": "ShaderNodeVolumeScatter",
                      "inputs": {"Color": [1, 1, 1], "Density": sigma * albedo, "Anisotropy": g}},
                "1": {"node": "ShaderNodeVolumeAbsorption",
                      "inputs": {"Color": [0, 0, 0], "Density": sigma * (1 - albedo)}}}}
            yield {"id": f"scatter-{ior}-{g}-{albedo}", "label": f"n {ior} g {g} a {albedo}",
                   "gltf": solid(ior, 0.0, volume={"attenuationColor": [math.exp(-1)] * 3,
                       "attenuationDistance": 1 / sigma},
                                 volume_scatter={"multiscatterColorFactor": colors, "multiscatterColor": colors,
                                                 "scatterAnisotropy": g}),
                   "mitsuba": {"bsdf": {"type": "null"} if ior == 1 else {"type": "dielectric", "int_ior": ior,
                       "ext_ior": 1.0},
                               "interior": {"type": "homogeneous", "albedo": albedo, "sigma_t": sigma,
                                            "phase": {"type": "hg", "g": g}}},
                   "cycles": {**({} if ior == 1 else glass(ior, 0.0)), "Volume": volume}, "exact": None}


def clearcoat():
    base = (0.2, 0.05, 0.05)
    for strength in (0.5, 1.0):
        for roughness in (0.0, 0.2, 0.5, 1.0):
            yield {"id": f"clearcoat-{strength}-{roughness}", "label": f"s {strength} r {roughness}",
                   "gltf": gltf(base, 0.0, 1.0, specular={"specularFactor": 0},
                                clearcoat={"clearcoatFactor": strength, "clearcoatRoughnessFactor": roughness}),
                   "mitsuba": None,
                   "cycles": principled(base, Roughness=1.0, Specular_IOR_Level=0.0, Coat_Weight=strength,
                                        Coat_Roughness=roughness, Coat_IOR=1.5),
                   "exact": {"model": "clearcoat", "base": base, "alpha": max(roughness**2, 1e-6),
                       "strength": strength}}


def sheen():
    base, color = (0.2, 0.05, 0.05), (1.0, 1.0, 1.0)
    for strength in (0.5, 1.0):
        for roughness in (0.1, 0.3, 0.6, 1.0):
            yield {"id": f"sheen-{strength}-{roughness}", "label": f"s {strength} r {roughness}",
                   "gltf": gltf(base, 0.0, 1.0, specular={"specularFactor": 0},
                                sheen={"sheenColorFactor": [strength * c for c in color],
                                    "sheenRoughnessFactor": roughness}),
                   "mitsuba": None,
                   "cycles": principled(base, Roughness=1.0, Specular_IOR_Level=0.0, Sheen_Weight=strength,
                                        Sheen_Roughness=roughness),
                   "exact": {"model": "sheen", "base": base, "roughness": roughness, "strength": strength}}


def anisotropy():
    for roughness in (0.1, 0.3, 0.6):
        for strength in (0.3, 0.6, 1.0):
            along, across = roughness**2 + (1 - roughness**2) * strength**2, roughness**2
            yield {"id": f"anisotropy-{roughness}-{strength}", "label": f"r {roughness} s {strength}",
                   "gltf": gltf((1, 1, 1), 1.0, roughness, anisotropy={"anisotropyStrength": strength}),
                   "mitsuba": {"bsdf": {"type": "roughconductor", "material": "none", "distribution": "ggx",
                                        "alpha_u": along, "alpha_v": across}},
                   "cycles": None, "exact": {"model": "anisotropic", "alphas": (along, across)}}


def diffuse_transmission():
    white = (0.8, 0.6, 0.3)
    for share in (0.0, 0.25, 0.5, 1.0):
        yield {"id": f"diffuse-transmission-{share}", "label": f"share {share}",
               "gltf": gltf(white, 0.0, 1.0, specular={"specularFactor": 0}, diffuse_transmission={
                   "diffuseTransmissionFactor": share, "diffuseTransmissionColorFactor": white}),
               "mitsuba": None,
               "cycles": {"Surface": {"node": "ShaderNodeMixShader", "inputs": {
                   "0": share, "1": {"node": "ShaderNodeBsdfDiffuse", "inputs": {"Color": list(white)}},
                   "2": {"node": "ShaderNodeBsdfTranslucent", "inputs": {"Color": list(white)}}}}},
               "exact": None}


def iridescence():
    for metallic in (0.0, 1.0):
        for thickness in (200, 400, 600):
            base = (0.05,) * 3 if metallic == 0 else (0.9, 0.5, 0.3)
            yield {"id": f"film-{metallic}-{thickness}", "label": f"m {metallic} {thickness} nm",
                   "gltf": gltf(base, metallic, 0.1, iridescence={
                       "iridescenceFactor": 1, "iridescenceIor": 1.33, "iridescenceThicknessMaximum": thickness}),
                   "mitsuba": None,
                   "cycles": principled(base, Metallic=metallic, Roughness=0.1, Thin_Film_Thickness=float(thickness),
                                        Thin_Film_IOR=1.33),
                   "exact": None}


GRIDS = [
    ("conductor", "Mirrors", conductor), ("metal", "Rough metal", metal),
    ("dielectric", "Coated base: metalness, ior and roughness", dielectric),
    ("glass", "Solid glass: ior and roughness", rough_glass), ("thin", "Thin walls", thin_wall),
    ("absorption", "Absorption in glass", absorption), ("scattering", "Scattering media", scattering),
    ("clearcoat", "Clear coat on a diffuse base", clearcoat), ("sheen", "Sheen on a diffuse base", sheen),
    ("anisotropy", "Anisotropic white metal", anisotropy),
    ("translucency", "Diffuse transmission through a thin wall", diffuse_transmission),
    ("iridescence", "Thin films", iridescence)]


def grids():
    return [{"id": name, "title": title, "cases": list(make())} for name, title, make in GRIDS]
