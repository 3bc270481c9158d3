"""Writes small glTF 2.0 scenes (.glb) from lists of numbers, with nothing but Python's own library."""
import json
import math
import struct

FLOATS, INDICES = 5126, 5125
EXTENSIONS = "extensions"


class Writer:
    """Meshes of one primitive each, materials without textures, one camera. Positions are (x, y, z), metres, +Y up."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0", "generator": "kiln tools/bench"}, "scene": 0,
                     "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [], "accessors": [],
                     "bufferViews": []}
        self.data = bytearray()

    def view(self, data):
        self.data += b"\0" * (-len(self.data) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, rows, kind, component):
        width = {"SCALAR": 1, "VEC3": 3}[kind]
        flat = list(rows) if width == 1 else [x for row in rows for x in row]
        data = struct.pack(f"<{len(flat)}{'f' if component == FLOATS else 'I'}", *flat)
        entry = {"bufferView": self.view(data), "componentType": component, "count": len(flat) // width, "type": kind}
        if kind == "VEC3":
            entry["min"] = [min(r[k] for r in rows) for k in range(3)]
            entry["max"] = [max(r[k] for r in rows) for k in range(3)]
        self.json["accessors"].append(entry)
        return len(self.json["accessors"]) - 1

    def material(self, name, base=(1, 1, 1), metallic=0, roughness=1, emission=None, diffuse=False, glass=None):
        """emission: radiance. diffuse: Lambert, without the dielectric's coat. glass: the ior of a clear solid."""
        material = {"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": [*map(float, base), 1.0], "metallicFactor": metallic, "roughnessFactor": roughness}}
        extensions = {}
        if emission:
            most = max(emission)
            material["emissiveFactor"] = [c / most for c in emission]
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": most}
        if diffuse or emission:
            extensions["KHR_materials_specular"] = {"specularFactor": 0.0}
        if glass:
            extensions |= {"KHR_materials_transmission": {"transmissionFactor": 1.0},
                           "KHR_materials_ior": {"ior": glass}, "KHR_materials_volume": {"thicknessFactor": 1.0}}
        if extensions:
            material[EXTENSIONS] = extensions
        self.json["materials"].append(material)
        return len(self.json["materials"]) - 1

    def mesh(self, name, shape, material):
        """shape: (positions, normals, indices of triangles)."""
        positions, normals, indices = shape
        primitive = {"attributes": {"POSITION": self.accessor(positions, "VEC3", FLOATS),
                                    "NORMAL": self.accessor(normals, "VEC3", FLOATS)},
                     "indices": self.accessor(indices, "SCALAR", INDICES), "material": material}
        self.json["meshes"].append({"name": name, "primitives": [primitive]})
        self.node({"name": name, "mesh": len(self.json["meshes"]) - 1})

    def node(self, node):
        self.json["nodes"].append(node)
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)

    def camera(self, eye, at, yfov_degrees):
        self.json["cameras"] = [{"type": "perspective", "perspective": {
            "yfov": math.radians(yfov_degrees), "aspectRatio": 1.0, "znear": 0.01, "zfar": 1000.0}}]
        self.node({"name": "camera", "camera": 0, "matrix": look_at(eye, at)})

    def save(self, path):
        extensions = {name for m in self.json["materials"] for name in m.get(EXTENSIONS, {})}
        if extensions:
            self.json["extensionsUsed"] = sorted(extensions | set(self.json.get("extensionsUsed", ())))
        self.json["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        data = bytes(self.data) + b"\0" * (-len(self.data) % 4)
        head = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(data))
        path.write_bytes(head + struct.pack("<I4s", len(text), b"JSON") + text
                         + struct.pack("<I4s", len(data), b"BIN\0") + data)


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def look_at(eye, at):
    """Column-major; the camera looks along -Z with +Y up."""
    back = unit(subtract(eye, at))
    right = unit(cross((0, 1, 0), back))
    return [*right, 0, *cross(back, right), 0, *back, 0, *map(float, eye), 1]


def join(shapes):
    positions, normals, indices = [], [], []
    for p, n, i in shapes:
        indices += [k + len(positions) for k in i]
        positions += p
        normals += n
    return positions, normals, indices


def quad(a, b, c, d):
    """Counter-clockwise seen from the front."""
    normal = unit(cross(subtract(b, a), subtract(d, a)))
    return [a, b, c, d], [normal] * 4, [0, 1, 2, 0, 2, 3]


def box(low, high, turn=0.0):
    """Turned about +Y through its middle."""
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    half = [(b - a) / 2 for a, b in zip(low, high)]
    sides = []
    for axis in range(3):
        for sign in (1, -1):
            n = [0.0] * 3
            u, v = [0.0] * 3, [0.0] * 3
            n[axis], u[(axis + 1) % 3] = sign, 1.0
            v = cross(n, u)
            corner = lambda s, t: tuple(h * (x + s * y + t * z) for h, x, y, z in zip(half, n, u, v))
            sides.append(quad(corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)))
    positions, normals, indices = join(sides)
    c, s = math.cos(turn), math.sin(turn)
    rotate = lambda p: (c * p[0] + s * p[2], p[1], -s * p[0] + c * p[2])
    place = lambda p: tuple(x + m for x, m in zip(rotate(p), middle))
    return [place(p) for p in positions], [rotate(n) for n in normals], indices


def sphere(center, radius, around, rings):
    """Smooth normals; triangles at the poles that are none are left out."""
    normals, indices = [], []
    for j in range(rings + 1):
        theta = math.pi * j / rings
        for i in range(around + 1):
            phi = 2 * math.pi * i / around
            normals.append((math.sin(theta) * math.cos(phi), math.cos(theta), -math.sin(theta) * math.sin(phi)))
    for j in range(rings):
        for i in range(around):
            a, d = j * (around + 1) + i, (j + 1) * (around + 1) + i
            indices += [a, d, a + 1] if j else []
            indices += [a + 1, d, d + 1] if j < rings - 1 else []
    return [tuple(c + radius * x for c, x in zip(center, n)) for n in normals], normals, indices


def octahedron(center, radius):
    """Flat."""
    corner = lambda axis, sign: tuple(c + (sign * radius if k == axis else 0.0) for k, c in enumerate(center))
    faces = []
    for x in (1, -1):
        for y in (1, -1):
            for z in (1, -1):
                abc = [corner(0, x), corner(1, y), corner(2, z)]
                abc = abc if x * y * z > 0 else abc[::-1]
                faces.append((abc, [unit((x, y, z))] * 3, [0, 1, 2]))
    return join(faces)
