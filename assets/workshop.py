"""What make_demo.py makes things from: noise, pictures, shapes of revolution, a glTF file."""
import json
import math
import random
import struct
import zlib

AROUND = 48  # columns of a lathe


# Fields: lists of rows of floats. Noise repeats at the edges, so that it closes around a vase.

def noise(width, height, nx, ny, seed):
    """Value noise on an nx by ny lattice, between 0 and 1."""
    r = random.Random(seed)
    lattice = [[r.random() for _ in range(nx)] for _ in range(ny)]

    def steps(size, cells):
        out = []
        for i in range(size):
            at = (i + 0.5) * cells / size
            cell, t = int(at), at - int(at)
            out.append((cell % cells, (cell + 1) % cells, t * t * (3 - 2 * t)))
        return out
    columns = steps(width, nx)
    rows = []
    for a, b, t in steps(height, ny):
        line = [p + (q - p) * t for p, q in zip(lattice[a], lattice[b])]
        rows.append([line[i] + (line[j] - line[i]) * s for i, j, s in columns])
    return rows


def add(*weighted):
    """Sum of (weight, field) pairs."""
    return [[sum(w * v for (w, _), v in zip(weighted, values)) for values in zip(*rows)]
            for rows in zip(*(f for _, f in weighted))]


def fbm(width, height, nx, ny, seed, octaves=4):
    total = sum(0.5 ** k for k in range(octaves))
    return add(*((0.5 ** k / total, noise(width, height, nx << k, ny << k, seed + k)) for k in range(octaves)))


def clamp(x, low=0.0, high=1.0):
    return min(max(x, low), high)


def smooth(low, high, x):
    t = clamp((x - low) / (high - low))
    return t * t * (3 - 2 * t)


def mix(a, b, t):
    return tuple(p + (q - p) * t for p, q in zip(a, b))


def normals(height_field, scale_x, scale_y):
    """Tangent-space normal map of heights, in units of a texel; repeats in x alone. Green points up, v down."""
    rows, h = [], len(height_field)
    for y, row in enumerate(height_field):
        above, below = height_field[max(y - 1, 0)], height_field[min(y + 1, h - 1)]
        line, w = bytearray(), len(row)
        for x in range(w):
            dx = (row[(x + 1) % w] - row[x - 1]) * scale_x
            dy = (below[x] - above[x]) * scale_y
            k = 127 / math.sqrt(dx * dx + dy * dy + 1)
            line += bytes((round(127.5 - dx * k), round(127.5 + dy * k), round(127.5 + k)))
        rows.append(line)
    return rows


def stamp(field, x, y, rx, ry, amount):
    """Adds a soft dot, around the seam too."""
    h, w = len(field), len(field[0])
    for j in range(max(int(y - ry), 0), min(int(y + ry) + 2, h)):
        for i in range(int(x - rx), int(x + rx) + 2):
            d = ((i - x) / rx) ** 2 + ((j - y) / ry) ** 2
            if d < 1:
                field[j][i % w] += amount * (1 - d) ** 2


# PNG

def encode_srgb(c):
    return round(255 * (12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055))


SRGB = [encode_srgb(i / 8191) for i in range(8192)]


def srgb(c):
    return SRGB[int(8191 * clamp(c) + 0.5)]


def color_rows(width, height, f):
    """Rows of sRGB bytes; f gives a linear colour at column x, row y."""
    return [bytes(srgb(c) for x in range(width) for c in f(x, y)) for y in range(height)]


def surface_rows(width, height, f):
    """Rows of a metallic-roughness map; f gives (roughness, metalness)."""
    rows = []
    for y in range(height):
        line = bytearray()
        for x in range(width):
            roughness, metal = f(x, y)
            line += bytes((255, round(255 * clamp(roughness)), round(255 * clamp(metal))))
        rows.append(line)
    return rows


class Png:
    """Rows of RGB bytes, each as its difference from the row above (PNG 1.2, filter 2)."""

    def __init__(self, rows):
        self.size = len(rows[0]) // 3, len(rows)
        previous, out = bytes(len(rows[0])), bytearray()
        for row in rows:
            out += b'\2' + bytes((a - b) & 255 for a, b in zip(row, previous))
            previous = row
        self.scanlines = bytes(out)

    def encode(self):
        def chunk(kind, data):
            body = kind + data
            return struct.pack('>I', len(data)) + body + struct.pack('>I', zlib.crc32(body))
        head = struct.pack('>IIBBBBB', *self.size, 8, 2, 0, 0, 0)
        return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', head) + chunk(b'IDAT', zlib.compress(self.scanlines, 9)) +
                chunk(b'IEND', b''))


# glTF

class Gltf:
    def __init__(self):
        self.parts = []  # bytes or Png, one per buffer view
        self.json = {'asset': {'version': '2.0', 'generator': 'make_demo.py'}, 'scene': 0,
                     'extensionsUsed': ['KHR_materials_emissive_strength', 'KHR_materials_ior',
                                        'KHR_materials_transmission', 'KHR_materials_volume'],
                     'scenes': [{'nodes': []}], 'nodes': [], 'meshes': [], 'materials': [], 'accessors': [],
                     'bufferViews': [], 'textures': [], 'images': [], 'samplers': [{}]}

    def put(self, kind, entry):
        self.json[kind].append(entry)
        return len(self.json[kind]) - 1

    def view(self, part):
        self.parts.append(part)
        return self.put('bufferViews', {'buffer': 0})

    def accessor(self, values, width):
        if width == 1:
            data, kind, extra = struct.pack('<%dH' % len(values), *values), 'SCALAR', {'componentType': 5123}
        else:
            # Coordinates are rounded to 2^-20: an ulp of another libm must not show.
            values = [[round(c * 1048576) / 1048576 for c in v] for v in values]
            data = b''.join(struct.pack('<%df' % width, *v) for v in values)
            kind, extra = 'VEC%d' % width, {'componentType': 5126}
            extra['min'] = [min(v[k] for v in values) for k in range(width)]
            extra['max'] = [max(v[k] for v in values) for k in range(width)]
        return self.put('accessors', {'bufferView': self.view(data), 'count': len(values), 'type': kind, **extra})

    def mesh(self, name, shape, material):
        positions, shading, uvs, triangles = shape
        attributes = {'POSITION': self.accessor(positions, 3), 'NORMAL': self.accessor(shading, 3),
                      'TEXCOORD_0': self.accessor(uvs, 2)}
        indices = self.accessor([i for t in triangles for i in t], 1)
        return self.put('meshes', {'name': name, 'primitives': [
            {'attributes': attributes, 'indices': indices, 'material': material}]})

    def node(self, name, **entry):
        self.json['scenes'][0]['nodes'].append(self.put('nodes', {'name': name, **entry}))

    def place(self, name, shape, material, **entry):
        self.node(name, mesh=self.mesh(name, shape, material), **entry)

    def texture(self, name, rows):
        image = self.put('images', {'name': name, 'mimeType': 'image/png', 'bufferView': self.view(Png(rows))})
        return {'index': self.put('textures', {'sampler': 0, 'source': image})}

    def material(self, name, pbr, **entry):
        return self.put('materials', {'name': name, 'pbrMetallicRoughness': pbr, **entry})

    def encode(self):
        binary = bytearray()
        for view, part in zip(self.json['bufferViews'], self.parts):
            data = part.encode() if isinstance(part, Png) else part
            binary += bytes(-len(binary) % 4)
            view['byteOffset'], view['byteLength'] = len(binary), len(data)
            binary += data
        binary += bytes(-len(binary) % 4)
        self.json['buffers'] = [{'byteLength': len(binary)}]
        text = json.dumps(self.json, separators=(',', ':')).encode()
        text += b' ' * (-len(text) % 4)
        return (struct.pack('<III', 0x46546C67, 2, 28 + len(text) + len(binary)) +
                struct.pack('<II', len(text), 0x4E4F534A) + text +
                struct.pack('<II', len(binary), 0x004E4942) + bytes(binary))


# Shapes: positions, normals, texture coordinates, triangles (pairs of them are quads)

def spline(points, steps):
    """Catmull and Rom's curve through points, `steps` pieces between each two; (r, y) and its derivative."""
    ends = [tuple(2 * a - b for a, b in zip(points[0], points[1]))] + list(points) + \
           [tuple(2 * a - b for a, b in zip(points[-1], points[-2]))]
    out = []
    for i in range(len(points) - 1):
        a, b, c, d = ends[i:i + 4]
        for k in range(steps + (i == len(points) - 2)):
            t = k / steps
            at = tuple(0.5 * (2 * q + (r - p) * t + (2 * p - 5 * q + 4 * r - s) * t * t +
                              (3 * q - p - 3 * r + s) * t ** 3) for p, q, r, s in zip(a, b, c, d))
            slope = tuple(0.5 * ((r - p) + 2 * (2 * p - 5 * q + 4 * r - s) * t + 3 * (3 * q - p - 3 * r + s) * t * t)
                          for p, q, r, s in zip(a, b, c, d))
            out.append((at, slope))
    return out


def lathe(profile, steps, v_of=None):
    """A profile of (radius, height) from the axis below to the axis above, or inside, turned about +Y; v follows its
    length, from 1 at the start to 0 at the end, or is v_of(share of the length)."""
    curve = spline(profile, steps)
    lengths = [0.0]
    for (p, _), (q, _) in zip(curve, curve[1:]):
        lengths.append(lengths[-1] + math.dist(p, q))
    positions, shading, uvs, triangles = [], [], [], []
    n = AROUND
    for ((r, y), (dr, dy)), length in zip(curve, lengths):
        share = length / lengths[-1]
        r = max(r, 0.0)
        k = 1 / math.hypot(dr, dy)
        for i in range(n + 1):
            angle = 2 * math.pi * i / n
            s, c = (math.sin(angle), math.cos(angle)) if i < n else (0.0, 1.0)
            positions.append((r * s, y, r * c))
            radial = dy * k if r > 1e-6 else 0.0
            shading.append((radial * s, -dr * k if r > 1e-6 else math.copysign(1, -dr), radial * c))
            uvs.append((i / n, v_of(share) if v_of else 1 - share))
    for j in range(len(curve) - 1):
        for i in range(n):
            a, b = j * (n + 1) + i, (j + 1) * (n + 1) + i
            if curve[j][0][0] > 1e-6:
                triangles.append((a, a + 1, b + 1))
            if curve[j + 1][0][0] > 1e-6:
                triangles.append((a, b + 1, b))
    return positions, shading, uvs, triangles


def grid(corner, u, v, repeat=(1.0, 1.0), pieces=(1, 1), bend=None):
    """A rectangle from a corner along u and v, facing u × v; bend moves its points and gives normals."""
    nx, ny = pieces
    cross = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.hypot(*cross)
    facing = tuple(c / length for c in cross)
    positions, shading, uvs, triangles = [], [], [], []
    for j in range(ny + 1):
        for i in range(nx + 1):
            s, t = i / nx, j / ny
            p = tuple(c + s * a + t * b for c, a, b in zip(corner, u, v))
            p, n = bend(p) if bend else (p, facing)
            positions.append(p)
            shading.append(n)
            uvs.append((s * repeat[0], (1 - t) * repeat[1]))
    for j in range(ny):
        for i in range(nx):
            a, b = j * (nx + 1) + i, (j + 1) * (nx + 1) + i
            triangles += [(a, a + 1, b + 1), (a, b + 1, b)]
    return positions, shading, uvs, triangles


def join(*shapes):
    positions, shading, uvs, triangles = [], [], [], []
    for p, n, t, i in shapes:
        triangles += [tuple(k + len(positions) for k in triangle) for triangle in i]
        positions += p
        shading += n
        uvs += t
    return positions, shading, uvs, triangles


def box(low, high, inside=False):
    (x0, y0, z0), (x1, y1, z1) = low, high
    x, y, z = (x1 - x0, 0, 0), (0, y1 - y0, 0), (0, 0, z1 - z0)
    faces = [((x0, y0, z1), x, y), ((x0, y0, z0), y, x), ((x0, y0, z0), z, y), ((x1, y0, z0), y, z),
             ((x0, y1, z0), z, x), ((x0, y0, z0), x, z)]
    return join(*(grid(c, v, u) if inside else grid(c, u, v) for c, u, v in faces))


def tube(path, radii, n=16):
    """Rings about a path in the xy plane, closed by its last point."""
    positions, shading, uvs, triangles = [], [], [], []
    for k, ((x, y), r) in enumerate(zip(path, radii)):
        (ax, ay), (bx, by) = path[max(k - 1, 0)], path[min(k + 1, len(path) - 1)]
        length = math.hypot(bx - ax, by - ay)
        sx, sy = (by - ay) / length, -(bx - ax) / length
        for i in range(n + 1):
            c, s = math.cos(2 * math.pi * (i % n) / n), math.sin(2 * math.pi * (i % n) / n)
            positions.append((x + r * c * sx, y + r * c * sy, r * s))
            shading.append((c * sx, c * sy, s))
            uvs.append((i / n, k / (len(path) - 1)))
    for k in range(len(path) - 1):
        for i in range(n):
            a, b = k * (n + 1) + i, (k + 1) * (n + 1) + i
            triangles += [(a, a + 1, b + 1), (a, b + 1, b)]
    return positions, shading, uvs, triangles
