"""The scenes of the benchmark, as .glb files that every renderer reads.

What a scene is rendered with stands in scenes[0].extras.bench: width, height; bounces, of indirect light (kiln's
--max-depth is one more, Mitsuba's max_depth two more, Cycles' max_bounces the same); env {file, intensity}; lens
{aperture_radius, focus_distance} in metres. Pixels are filtered by a box of one pixel. Emission is emissiveFactor times
emissiveStrength, as radiance.

S7 and S8 read files of KILN_ASSETS (env/royal_esplanade_1k.hdr, gltf/FlightHelmet), the others nothing."""
import json
import math
import pathlib
import random
import shutil

from gltf_writer import Writer, box, join, octahedron, quad, sphere

SKY = "royal_esplanade_1k.hdr"
BOUNCES = 8


def save(writer, path, side, **settings):
    writer.json["scenes"][0]["extras"] = {"bench": {"width": side, "height": side, "bounces": BOUNCES, **settings}}
    writer.save(path)


def room(w):
    """A Cornell box; gives the material of its walls."""
    white = w.material("white", (0.73, 0.73, 0.73), diffuse=True)
    red = w.material("red", (0.63, 0.065, 0.05), diffuse=True)
    green = w.material("green", (0.14, 0.45, 0.091), diffuse=True)
    lamp = w.material("lamp", (0, 0, 0), emission=(17, 12, 4))
    h, top = 0.25, 2.0  # the lamp fills a hole in the ceiling, so that its back never shows
    ceiling = lambda x0, x1, z0, z1: quad((x0, top, z0), (x1, top, z0), (x1, top, z1), (x0, top, z1))
    w.mesh("floor", quad((-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)), white)
    w.mesh("back", quad((-1, 0, -1), (1, 0, -1), (1, 2, -1), (-1, 2, -1)), white)
    w.mesh("ceiling", join([ceiling(-1, 1, -1, -h), ceiling(-1, 1, h, 1), ceiling(-1, -h, -h, h),
                            ceiling(h, 1, -h, h)]), white)
    w.mesh("left", quad((-1, 0, 1), (-1, 0, -1), (-1, 2, -1), (-1, 2, 1)), red)
    w.mesh("right", quad((1, 0, -1), (1, 0, 1), (1, 2, 1), (1, 2, -1)), green)
    w.mesh("lamp", ceiling(-h, h, -h, h), lamp)
    w.camera((0, 1, 3.9), (0, 1, 0), 39.3)
    return white


def cornell(path, assets, side):
    w = Writer()
    white = room(w)
    w.mesh("short", box((0.05, 0, 0.05), (0.65, 0.6, 0.65), -0.3), white)
    w.mesh("tall", box((-0.65, 0, -0.6), (-0.05, 1.2, 0), 0.3), white)
    save(w, path, side)


def balls(path, assets, side):
    w = Writer()
    room(w)
    w.mesh("mirror", sphere((-0.42, 0.4, -0.35), 0.4, 96, 48), w.material("mirror", (1, 1, 1), 1, 0))
    w.mesh("glass", sphere((0.42, 0.4, 0.25), 0.4, 96, 48), w.material("glass", (1, 1, 1), 0, 0, glass=1.5))
    save(w, path, side)


def lamps(path, assets, side):
    """A thousand lamps of eight colours in a furnished room."""
    w, draw = Writer(), random.Random(7)
    wall = w.material("wall", (0.7, 0.68, 0.65), diffuse=True)
    wood = w.material("floor", (0.35, 0.25, 0.2), 0, 0.35)
    paints = [w.material(f"box{k}", c, 0, 0.5) for k, c in
              enumerate(((0.6, 0.3, 0.2), (0.2, 0.5, 0.6), (0.6, 0.6, 0.3)))]
    w.mesh("floor", quad((-5, 0, 5), (5, 0, 5), (5, 0, -5), (-5, 0, -5)), wood)
    w.mesh("ceiling", quad((-5, 3, -5), (5, 3, -5), (5, 3, 5), (-5, 3, 5)), wall)
    w.mesh("walls", join([quad((-5, 0, -5), (5, 0, -5), (5, 3, -5), (-5, 3, -5)),
                          quad((-5, 0, 5), (-5, 0, -5), (-5, 3, -5), (-5, 3, 5)),
                          quad((5, 0, -5), (5, 0, 5), (5, 3, 5), (5, 3, -5)),
                          quad((5, 0, 5), (-5, 0, 5), (-5, 3, 5), (5, 3, 5))]), wall)
    for k in range(14):
        x, z, h, s = (draw.uniform(*r) for r in ((-4, 4), (-4, 3), (0.4, 1.6), (0.25, 0.5)))
        w.mesh(f"box{k}", box((x - s, 0, z - s), (x + s, h, z + s), draw.uniform(0, 3)), paints[k % 3])
    colors = ((1, 0.3, 0.2), (1, 0.7, 0.3), (1, 1, 0.5), (0.4, 1, 0.4), (0.3, 0.9, 1), (0.4, 0.5, 1), (0.9, 0.4, 1),
              (1, 0.9, 0.8))
    for k, color in enumerate(colors):
        places = [[draw.uniform(*r) for r in ((-4.8, 4.8), (0.1, 2.9), (-4.8, 4.0))] for _ in range(125)]
        emission = [60 * (1 + k % 4) * c for c in color]
        w.mesh(f"lamps{k}", join([octahedron(p, 0.012) for p in places]),
               w.material(f"lamps{k}", (0, 0, 0), emission=emission))
    w.camera((0, 1.6, 4.9), (0, 1.2, 0), 60)
    save(w, path, side)


def plates(path, assets, side):
    """Plates of four roughnesses under lamps of four sizes (Veach 1997, figure 9.2; his numbers)."""
    w = Writer()
    grey = w.material("grey", (0.4, 0.4, 0.4), diffuse=True)
    edges = (((-2.70651, 0.25609), (-2.08375, -0.526323)), ((-3.28825, 1.36972), (-2.83856, 0.476536)),
             ((-3.73096, 2.70046), (-3.43378, 1.74564)), ((-3.99615, 4.0667), (-3.82069, 3.08221)))
    for k, (((y0, z0), (y1, z1)), alpha) in enumerate(zip(edges, (0.005, 0.02, 0.05, 0.1))):
        metal = w.material(f"plate{k}", (0.75, 0.78, 0.82), 1, math.sqrt(alpha))
        w.mesh(f"plate{k}", quad((-4, y0, z0), (4, y0, z0), (4, y1, z1), (-4, y1, z1)), metal)
    for x, radius, radiance in ((-3.75, 0.03333, 901.803), (-1.25, 0.1, 100), (1.25, 0.3, 11.1111),
                                (3.75, 0.9, 1.23457)):
        lamp = w.material(f"lamp{radius}", (0, 0, 0), emission=(radiance,) * 3)
        w.mesh(f"lamp{radius}", sphere((x, 0, 0), radius, 48, 24), lamp)
    w.mesh("fill", sphere((10, 10, 4), 0.5, 48, 24), w.material("fill", (0, 0, 0), emission=(800, 800, 800)))
    w.mesh("floor", quad((-10, -4.14615, 10), (10, -4.14615, 10), (10, -4.14615, -10), (-10, -4.14615, -10)), grey)
    w.mesh("wall", quad((-10, -10, -2), (10, -10, -2), (10, 10, -2), (-10, 10, -2)), grey)
    w.camera((0, 2, 15), (0, -1.6, 2.5), 36)
    save(w, path, side)


def focus(path, assets, side):
    """Balls on a table behind a wide lens, under a sky and a soft box."""
    w, draw = Writer(), random.Random(3)
    table = w.material("table", (0.45, 0.4, 0.38), diffuse=True)
    w.mesh("table", quad((-30, 0, 30), (30, 0, 30), (30, 0, -30), (-30, 0, -30)), table)
    paints = [w.material(f"paint{k}", c, 0, 0.25) for k, c in enumerate(
        ((0.8, 0.2, 0.15), (0.2, 0.5, 0.8), (0.9, 0.7, 0.2), (0.3, 0.7, 0.3), (0.8, 0.8, 0.8)))]
    paints += [w.material("gold", (1, 0.77, 0.34), 1, 0.2), w.material("chrome", (1, 1, 1), 1, 0)]
    count = 0
    for row in range(-1, 9):
        for column in range(-3, 4):
            if (column + row) % 2:
                continue
            center = (column * 0.75 + 0.1 * draw.gauss(0, 1), 0.3, 1.2 - row * 1.1)
            w.mesh(f"ball{count}", sphere(center, 0.3, 64, 32), paints[(count * 3 + count // 7) % 7])
            count += 1
    w.mesh("ball", sphere((-0.6, 0.95, 1.0), 0.25, 64, 32), paints[0])
    soft = w.material("soft box", (0, 0, 0), emission=(6, 5.5, 5))
    w.mesh("soft box", quad((-2, 5, -1), (2, 5, -1), (2, 5, 3), (-2, 5, 3)), soft)
    w.camera((0, 1.4, 4.2), (0, 0.35, 0), 42)
    save(w, path, side, env=sky(path, assets, 0.25), lens={"aperture_radius": 0.07, "focus_distance": 3.1})


def helmet(path, assets, side):
    """FlightHelmet, its lenses made opaque and its surfaces two-sided, so that every renderer's importer agrees."""
    folder = assets / "gltf" / "FlightHelmet"
    w = Writer()
    w.json = json.loads((folder / "FlightHelmet.gltf").read_text())
    w.data = bytearray((folder / w.json["buffers"][0]["uri"]).read_bytes())
    for image in w.json["images"]:
        data = (folder / image.pop("uri")).read_bytes()
        image["bufferView"] = w.view(data)
        image["mimeType"] = "image/png" if data[:4] == b"\x89PNG" else "image/jpeg"
    for material in w.json["materials"]:
        material.pop("alphaMode", None)
        material["doubleSided"] = True
    w.camera((0.55, 0.42, 0.75), (0, 0.33, 0), 38)
    save(w, path, side, env=sky(path, assets, 1.0))


def sky(path, assets, intensity):
    shutil.copyfile(assets / "env" / SKY, path.parent / SKY)
    return {"file": SKY, "intensity": intensity}


# Name, what it is, its maker, whether it wants KILN_ASSETS. Numbers are those of the field's usual list; S4 and S5 (a
# volume, motion) are not rendered alike by the peers.
SCENES = {"S1": ("Cornell box", cornell, False), "S2": ("mirror and glass balls", balls, False),
          "S3": ("a thousand lamps", lamps, False), "S6": ("Veach's plates", plates, False),
          "S7": ("depth of field under a sky", focus, True), "S8": ("FlightHelmet under a sky", helmet, True)}


def settings_of(path):
    """extras.bench of a .glb, and the vertical angle of its camera."""
    data = path.read_bytes()
    document = json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])
    return {**document["scenes"][0]["extras"]["bench"], "yfov": document["cameras"][0]["perspective"]["yfov"]}


def make(folder, names, assets, side=256):
    """Writes the scenes that can be made, for pictures of so many pixels a side; gives {name: path} and the names of
    the others."""
    folder.mkdir(parents=True, exist_ok=True)
    made, missing = {}, []
    for name in names:
        _, maker, wants = SCENES[name]
        if wants and not (assets and (pathlib.Path(assets) / "env" / SKY).exists()):
            missing.append(name)
            continue
        made[name] = folder / f"{name}.glb"
        maker(made[name], pathlib.Path(assets) if assets else None, side)
    return made, missing
