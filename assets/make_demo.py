#!/usr/bin/env python3
"""Makes assets/still_life.glb: what came out of a kiln, by a window. Python's standard library alone.

    make_demo.py           writes still_life.glb beside this file
    make_demo.py --check   compares what it would write with the file that is there: pixels and geometry, not the bytes
                           that zlib makes of them
"""
import json
import math
import os
import random
import struct
import sys
import zlib

from workshop import (Gltf, Png, add, box, clamp, color_rows, fbm, grid, join, lathe, mix, noise, normals, smooth, srgb,
                      stamp, surface_rows, tube)


# What stands on the table. Lengths in metres.

def image_material(gltf, name, base, surface, bumps, normal_scale=1.0, **entry):
    return gltf.material(name, {'baseColorTexture': gltf.texture(name + ' colour', base),
                                'metallicRoughnessTexture': gltf.texture(name + ' surface', surface)},
                         normalTexture={**gltf.texture(name + ' relief', bumps), 'scale': normal_scale}, **entry)


def drips(width, seed, count, reach):
    """How far a glaze has run down, for every column: rounded runs of different width and length."""
    r = random.Random(seed)
    runs = [((k + r.random()) / count, r.uniform(0.014, 0.036), reach * r.random() ** 2) for k in range(count)]
    line = []
    for x in range(width):
        u = (x + 0.5) / width
        line.append(max(length * max(1 - (min(abs(u - at), 1 - abs(u - at)) / half) ** 2, 0) ** 0.5
                        for at, half, length in runs))
    return line


def vase(gltf):
    """Stoneware, thrown, its upper part dipped into a glaze that has run."""
    w, h = 512, 512
    wide, fine, run = fbm(w, h, 4, 4, 1), fbm(w, h, 48, 64, 11, 2), fbm(w, h, 24, 5, 21, 3)
    wave = noise(w, 1, 7, 1, 31)[0]
    edge = [0.665 + 0.035 * a + 0.10 * b for a, b in zip(wave, drips(w, 5, 14, 1.0))]
    r = random.Random(7)
    spots = [[0.0] * w for _ in range(h)]
    for _ in range(420):
        size = 0.8 + 2.2 * r.random() ** 3
        stamp(spots, r.random() * w, r.random() * h, size, size * 0.8, r.uniform(0.3, 0.9))
    lip, thin, thick, pool = (0.20, 0.085, 0.035), (0.13, 0.33, 0.30), (0.030, 0.145, 0.155), (0.012, 0.060, 0.078)
    clay, iron = (0.34, 0.215, 0.135), (0.045, 0.022, 0.012)
    coverage, depth, height = [], [], []
    for y in range(h):
        v = (y + 0.5) / h
        covers = [smooth(edge[x] + 0.006, edge[x] - 0.006, v) for x in range(w)]
        near = [math.exp(-max(edge[x] - v, 0) / 0.035) for x in range(w)]
        coverage.append(covers)
        depth.append([clamp(0.15 + 0.9 * (v - 0.1) + 0.75 * (wide[y][x] - 0.5) + 0.9 * (run[y][x] - 0.5) + 0.55 * near[x])
                      for x in range(w)])
        ring = math.sin(2 * math.pi * 46 * v + 3 * math.sin(23 * v))
        height.append([covers[x] * (2.2 + 1.6 * near[x] + 1.1 * run[y][x]) + 0.55 * ring * (1 - 0.55 * covers[x]) +
                       (1 - covers[x]) * 1.1 * fine[y][x] - 0.4 * spots[y][x] for x in range(w)])

    def colour(x, y):
        v, d = (y + 0.5) / h, depth[y][x]
        glaze = mix(mix(thin, thick, smooth(0.1, 0.75, d)), pool, smooth(0.7, 1.1, d))
        glaze = mix(glaze, lip, smooth(0.055, 0.02, v - 0.012 * wide[y][x]) * 0.9)
        body = mix(clay, (0.24, 0.13, 0.07), clamp(1.6 * (fine[y][x] - 0.35)) * 0.6)
        body = mix(body, (0.18, 0.075, 0.03), 0.8 * math.exp(-max(v - edge[x], 0) / 0.02))  # flashed along the glaze
        return mix(mix(body, glaze, coverage[y][x]), iron, clamp(0.9 * spots[y][x]) * 0.8)

    def surface(x, y):
        c = coverage[y][x]
        return 0.78 - c * (0.68 - 0.10 * clamp(run[y][x] - 0.35)), 0.0
    material = image_material(gltf, 'stoneware', color_rows(w, h, colour), surface_rows(w, h, surface),
                              normals(height, 0.16, 0.16))
    profile = [(0, 0.004), (0.030, 0.003), (0.040, 0.0), (0.0445, 0.004), (0.052, 0.022), (0.075, 0.07), (0.0855, 0.115),
               (0.082, 0.155), (0.062, 0.195), (0.036, 0.225), (0.0235, 0.25), (0.021, 0.272), (0.025, 0.292),
               (0.033, 0.304), (0.0345, 0.3085), (0.032, 0.311), (0.0275, 0.306), (0.020, 0.285), (0.017, 0.25)]
    # Of the curve's length the outside takes 86 %; the inside repeats the lip's colour.
    return lathe(profile, 2, lambda s: clamp(1 - s / 0.86, 0.004)), material


def cracks(seed, w, h):
    """How close every texel is to a mended crack: 1 on it. Cracks start at the rim, v = 0, and branch."""
    r = random.Random(seed)
    field = [[0.0] * w for _ in range(h)]

    def draw(x, y, angle, length, width):
        while length > 0 and y < h:
            step = min(length, r.uniform(16, 46))
            angle += r.uniform(-0.35, 0.35)
            angle = clamp(angle, 0.2, math.pi - 0.2)
            for k in range(int(step * 2)):
                px, py = x + math.cos(angle) * k / 2, y + math.sin(angle) * k / 2
                for j in range(int(py) - 4, int(py) + 6):
                    if 0 <= j < h:
                        for i in range(int(px) - 4, int(px) + 6):
                            d = math.hypot(i - px, j - py) / width
                            if d < 1.6:
                                field[j][i % w] = max(field[j][i % w], clamp(1.6 - d) if d > 0.6 else 1.0)
            x, y, length = x + math.cos(angle) * step, y + math.sin(angle) * step, length - step
            if length > 60 and r.random() < 0.22:
                draw(x, y, angle + r.choice((-1, 1)) * r.uniform(0.6, 1.2), length * 0.7, width * 0.85)
    for at, angle, length in ((0.035, 1.9, 250), (0.20, 1.1, 330), (0.47, 1.8, 230), (0.71, 1.2, 280), (0.86, 1.9, 190)):
        draw(at * w, 0, angle, length, 2.0)
    return field


def bowl(gltf):
    """Porcelain, broken and mended with gold; a gold line on the rim. Inside and outside mirror each other."""
    w, h = 1536, 256
    gold = cracks(42, w, h)
    wave, wide = noise(w, 1, 24, 1, 3)[0], noise(w, h, 12, 4, 17)
    for x in range(w):
        for y in range(11):
            gold[y][x] = max(gold[y][x], smooth(7.0 + 2.0 * wave[x], 5.5 + 2.0 * wave[x], y))
    white, cool, leaf = (0.80, 0.77, 0.71), (0.60, 0.67, 0.66), (1.0, 0.71, 0.29)

    def colour(x, y):
        base = mix(white, cool, 0.75 * smooth(0.6, 1.0, y / h) + 0.2 * round(4 * wide[y][x]) / 4)
        return mix(base, leaf, gold[y][x])

    def surface(x, y):
        g = gold[y][x]
        return 0.09 + 0.13 * g, g
    material = image_material(gltf, 'porcelain', color_rows(w, h, colour), surface_rows(w, h, surface),
                              normals(gold, 0.45, 0.45))
    profile = [(0, 0.006), (0.028, 0.006), (0.031, 0.0), (0.035, 0.0005), (0.0365, 0.006), (0.060, 0.018), (0.090, 0.040),
               (0.1085, 0.064), (0.117, 0.0845), (0.1185, 0.0885), (0.1165, 0.0895), (0.1135, 0.0845), (0.105, 0.065),
               (0.087, 0.043), (0.058, 0.0225), (0.030, 0.0125), (0, 0.0105)]
    return lathe(profile, 2, lambda s: clamp(abs(s - 0.515) / 0.43, 0, 0.998)), material


def cup(gltf):
    """A small tea bowl, white slip over dark iron clay, brushed on by hand."""
    w, h = 384, 192
    strokes, wide, fine = fbm(w, h, 5, 32, 51, 3), fbm(w, h, 6, 4, 61), fbm(w, h, 64, 48, 71, 1)
    dark, rust, slip = (0.040, 0.026, 0.020), (0.16, 0.062, 0.024), (0.58, 0.50, 0.40)
    cover = [[smooth(0.50, 0.60, 0.62 * strokes[y][x] + 0.48 * wide[y][x] - 0.06 + 0.10 * smooth(0.85, 0.3, y / h)) *
              smooth(0.90, 0.84, y / h) for x in range(w)] for y in range(h)]

    def colour(x, y):
        body = mix(dark, rust, smooth(0.40, 0.75, wide[y][x]))
        return mix(body, mix(slip, (0.40, 0.29, 0.19), 0.8 * clamp(2 * (fine[y][x] - 0.4))), cover[y][x])

    def surface(x, y):
        return 0.34 + 0.16 * cover[y][x] + 0.2 * fine[y][x], 0.0
    height = [[1.6 * c + 1.2 * s + 0.6 * f for c, s, f in zip(*rows)] for rows in zip(cover, strokes, fine)]
    material = image_material(gltf, 'slip ware', color_rows(w, h, colour), surface_rows(w, h, surface),
                              normals(height, 0.35, 0.35))
    profile = [(0, 0.004), (0.018, 0.004), (0.0205, 0.0), (0.0235, 0.0015), (0.025, 0.006), (0.034, 0.016), (0.041, 0.035),
               (0.0425, 0.055), (0.0415, 0.066), (0.0405, 0.0685), (0.0388, 0.067), (0.0392, 0.055), (0.0375, 0.036),
               (0.030, 0.019), (0.015, 0.011), (0, 0.010)]
    return lathe(profile, 2, lambda s: clamp(abs(s - 0.53) / 0.47, 0, 0.995)), material


def brass(gltf):
    """Spun and brushed: fine grooves run around it."""
    w, h = 64, 512
    grooves, wide = add((0.5, noise(w, h, 2, 256, 81)), (0.5, noise(w, h, 3, 128, 82))), fbm(w, h, 4, 6, 83, 3)
    base = color_rows(w, h, lambda x, y: mix((0.89, 0.62, 0.26), (0.72, 0.44, 0.17), 0.8 * clamp(wide[y][x] * 2 - 0.6)))
    surface = surface_rows(w, h, lambda x, y: (0.20 + 0.16 * grooves[y][x] + 0.16 * clamp(wide[y][x] * 2 - 0.7), 1.0))
    return image_material(gltf, 'brass', base, surface, normals(grooves, 0.05, 0.35))


def wood(gltf):
    """Oiled walnut boards, 1.5 m by 0.9 m of them."""
    w, h, boards = 1024, 512, 6
    grain = add((0.6, noise(w, h, 10, 170, 91)), (0.4, noise(w, h, 24, 256, 92)))
    figure, warp, pores = fbm(w, h, 3, 12, 93, 3), fbm(w, h, 4, 18, 95, 3), noise(w, h, 64, 512, 96)
    r = random.Random(9)
    tone = [(r.uniform(0.55, 1.0), r.random()) for _ in range(boards)]
    dark, light = (0.050, 0.022, 0.011), (0.235, 0.118, 0.056)
    value, groove = [], []
    for y in range(h):
        at = y * boards / h
        board, across = int(at), at - int(at)
        bright, shift = tone[board]
        seam = smooth(0.012, 0.0, min(across, 1 - across))
        turn = int(shift * w)
        line = []
        for x in range(w):
            i = (x + turn) % w
            rings = 0.5 + 0.5 * math.sin(2 * math.pi * (5 * across + 7 * warp[y][i] + 3 * shift))
            t = bright * (0.15 + 0.40 * figure[y][i] + 0.28 * rings + 0.35 * (grain[y][i] - 0.3))
            line.append(clamp(t - 0.30 * smooth(0.80, 0.95, pores[y][i])) * (1 - 0.85 * seam))
        value.append([round(31 * t) / 31 for t in line])
        groove.append(seam)
    ramp = {k: tuple(srgb(c) for c in mix(dark, light, k / 31)) for k in range(32)}
    base = [bytes(c for t in line for c in ramp[round(31 * t)]) for line in value]
    surface = [bytes(c for t in line[::2] for c in (255, round(255 * (0.52 - 0.16 * round(8 * t) / 8)), 0))
               for line in value[::2]]
    return gltf.material('walnut', {'baseColorTexture': gltf.texture('walnut colour', base),
                                    'metallicRoughnessTexture': gltf.texture('walnut surface', surface)})


def canvas(gltf):
    """A painted backdrop, lighter in the middle."""
    w, h = 256, 256
    wide, fine = fbm(w, h, 7, 7, 101), fbm(w, h, 24, 24, 111, 3)

    def colour(x, y):
        middle = math.exp(-((x / w - 0.45) / 0.22) ** 2 - ((y / h - 0.62) / 0.30) ** 2)
        t = clamp(0.05 + 0.75 * middle + 0.7 * (wide[y][x] - 0.5) + 0.35 * (fine[y][x] - 0.5))
        return mix((0.035, 0.036, 0.037), (0.26, 0.225, 0.175), round(63 * t) / 63)
    return gltf.material('canvas', {'baseColorTexture': gltf.texture('canvas colour', color_rows(w, h, colour)),
                                    'metallicFactor': 0, 'roughnessFactor': 0.95})


def plain(gltf, name, color, roughness, metallic=0.0):
    return gltf.material(name, {'baseColorFactor': [*color, 1], 'metallicFactor': metallic, 'roughnessFactor': roughness})


def glass(gltf, name, color, distance, ior=1.5):
    return gltf.material(name, {'metallicFactor': 0, 'roughnessFactor': 0},
                         extensions={'KHR_materials_transmission': {'transmissionFactor': 1},
                                     'KHR_materials_ior': {'ior': ior},
                                     'KHR_materials_volume': {'thicknessFactor': 0.01, 'attenuationDistance': distance,
                                                              'attenuationColor': list(color)}})


def lamp(gltf, name, color, strength, texture=None):
    entry = {'emissiveFactor': list(color),
             'extensions': {'KHR_materials_emissive_strength': {'emissiveStrength': strength}}}
    if texture:
        entry['emissiveTexture'] = gltf.texture(name, texture)
    return gltf.material(name, {'baseColorFactor': [0, 0, 0, 1], 'metallicFactor': 0, 'roughnessFactor': 1}, **entry)


def sphere(radius):
    half = [math.pi * k / 16 for k in range(17)]
    return lathe([(radius * math.sin(a), radius * (1 - math.cos(a))) for a in half], 2)


def bottle(gltf):
    """Thick amber glass: outside and inside are one closed surface."""
    material = glass(gltf, 'amber glass', (0.93, 0.52, 0.12), 0.018, 1.52)
    profile = [(0, 0.002), (0.028, 0.0015), (0.0345, 0.001), (0.038, 0.005), (0.039, 0.012), (0.0395, 0.06), (0.039, 0.105),
               (0.035, 0.122), (0.024, 0.139), (0.0155, 0.150), (0.0130, 0.162), (0.0126, 0.187), (0.0135, 0.1905),
               (0.0160, 0.1925), (0.0165, 0.1975), (0.0150, 0.2010), (0.0115, 0.2010), (0.0098, 0.197), (0.0094, 0.162),
               (0.0115, 0.149), (0.0200, 0.137), (0.0310, 0.120), (0.0352, 0.104), (0.0356, 0.06), (0.0345, 0.016),
               (0.030, 0.0085), (0.018, 0.0065), (0, 0.006)]
    return lathe(profile, 2), material


def window(gltf):
    """Six panes of sky, brighter above, and the wooden bars between them."""
    sky = color_rows(4, 64, lambda x, y: mix((1.0, 0.98, 0.95), (0.42, 0.47, 0.52), (y / 63) ** 1.3))
    panes, bars = [], []
    width, height, bar = 0.46, 0.46, 0.05
    for j in range(3):
        for i in range(2):
            z, y = 0.5 * bar + i * (width + bar) - width - bar, j * (height + bar)
            p, n, t, k = grid((0, y, z + width), (0, 0, -width), (0, height, 0))
            panes.append((p, n, [(u, (2 - j + v) / 3) for u, v in t], k))
    top = 3 * (height + bar)
    for z in (-width - 1.5 * bar, -0.5 * bar, width + 0.5 * bar):
        bars.append(box((-0.02, -bar, z), (0.03, top, z + bar)))
    for j in range(4):
        bars.append(box((-0.02, j * (height + bar) - bar, -width - bar), (0.028, j * (height + bar), width + bar)))
    return join(*panes), lamp(gltf, 'sky', (1, 1, 1), 21.0, sky), join(*bars)


def turn_y(degrees):
    half = math.radians(degrees) / 2
    return [0, round(math.sin(half), 9), 0, round(math.cos(half), 9)]


def look(eye, at):
    """A camera's rotation as a quaternion: −Z towards a point, +Y up."""
    d = [a - e for a, e in zip(at, eye)]
    yaw, pitch = math.atan2(-d[0], -d[2]), math.atan2(d[1], math.hypot(d[0], d[2]))
    cy, sy, cp, sp = math.cos(yaw / 2), math.sin(yaw / 2), math.cos(pitch / 2), math.sin(pitch / 2)
    return [round(q, 9) for q in (cy * sp, sy * cp, -sy * sp, cy * cp)]


def room(gltf):
    board, cloth = wood(gltf), canvas(gltf)
    gltf.place('table', grid((-0.75, 0, 0.45), (1.5, 0, 0), (0, 0, -0.9)), board)

    def curve(p):
        """A sheet that hangs and leaves the wall in a wide bend towards its sides."""
        x, y, z = p
        n = (-0.5 * x, 0, 1.0)
        length = math.hypot(*n)
        return (x, y, z + 0.25 * x * x), tuple(c / length for c in n)
    gltf.place('backdrop', grid((-1.3, -0.3, -0.72), (2.6, 0, 0), (0, 1.7, 0), pieces=(32, 1), bend=curve), cloth)
    gltf.place('walls', box((-1.75, -0.8, -1.4), (1.75, 2.1, 2.2), inside=True), plain(gltf, 'wall', (0.30, 0.28, 0.26), 0.9))
    panes, sky, bars = window(gltf)
    place = {'translation': [-1.20, 0.10, 0.25], 'rotation': turn_y(-8)}
    gltf.place('window', panes, sky, **place)
    gltf.place('bars', bars, plain(gltf, 'painted wood', (0.32, 0.28, 0.23), 0.5), **place)
    fire = lamp(gltf, 'fire', (1.0, 0.36, 0.09), 7.5)
    gltf.place('kiln door', grid((0, 0, -0.25), (0, 0, 0.5), (0, 0.56, 0)), fire, translation=[0.98, 0.03, -0.22],
               rotation=turn_y(12))


def still_life():
    gltf = Gltf()
    room(gltf)
    gltf.place('vase', *vase(gltf), translation=[-0.165, 0, -0.06], rotation=turn_y(40))
    gltf.place('bowl', *bowl(gltf), translation=[0.125, 0, 0.03], rotation=turn_y(96))
    gltf.place('bottle', *bottle(gltf), translation=[0.005, 0, -0.16])
    gltf.place('cup', *cup(gltf), translation=[-0.005, 0, 0.155], rotation=turn_y(200))
    metal = brass(gltf)
    pear = [(0, 0.004), (0.012, 0.0005), (0.022, 0.002), (0.033, 0.014), (0.0365, 0.030), (0.032, 0.048), (0.0225, 0.065),
            (0.0170, 0.079), (0.0135, 0.090), (0.0085, 0.0965), (0.0035, 0.0965), (0, 0.0945)]
    stem = tube([(0.0, 0.092), (0.0005, 0.101), (0.003, 0.110), (0.0075, 0.1175), (0.0085, 0.1185)],
                [0.0022, 0.0018, 0.0017, 0.0023, 0.0001])
    dark = plain(gltf, 'bronze', (0.23, 0.13, 0.07), 0.38, 1.0)
    gltf.place('pear', lathe(pear, 3), metal, translation=[0.305, 0, -0.055], rotation=turn_y(20))
    gltf.place('stem', stem, dark, translation=[0.305, 0, -0.055], rotation=turn_y(200))
    gltf.place('blue marble', sphere(0.0165), glass(gltf, 'blue glass', (0.10, 0.33, 0.78), 0.012), translation=[0.10, 0, 0.215])
    gltf.place('clear marble', sphere(0.012), glass(gltf, 'clear glass', (0.86, 0.95, 0.90), 0.05), translation=[0.153, 0, 0.232])
    gltf.json['cameras'] = [{'name': 'still life', 'type': 'perspective',
                             'perspective': {'yfov': round(math.radians(20.5), 6), 'znear': 0.01, 'aspectRatio': 1.5}}]
    eye = (0.10, 0.43, 1.36)
    gltf.node('camera', camera=0, translation=list(eye), rotation=look(eye, (0.045, 0.112, 0)))
    return gltf


def read(path):
    """A file's document, as chunks() gives it, and its parts with pictures inflated."""
    with open(path, 'rb') as f:
        data = f.read()
    size = struct.unpack_from('<I', data, 12)[0]
    document, binary = json.loads(data[20:20 + size]), data[28 + size:]
    parts = []
    for view in document['bufferViews']:
        part = binary[view.pop('byteOffset'):][:view.pop('byteLength')]
        if part[:4] == b'\x89PNG':
            part = zlib.decompress(part[part.index(b'IDAT') + 4:-16])
        parts.append(part)
    del document['buffers']
    return document, parts


def main():
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'still_life.glb')
    gltf = still_life()
    if sys.argv[1:] == ['--check']:
        parts = [p.scanlines if isinstance(p, Png) else p for p in gltf.parts]
        if read(path) != (json.loads(json.dumps(gltf.json)), parts):
            sys.exit('make_demo.py: still_life.glb is not what this would write; run it without --check')
        return
    with open(path, 'wb') as f:
        f.write(gltf.encode())
    print('wrote', path, os.path.getsize(path), 'bytes')


if __name__ == '__main__':
    main()
