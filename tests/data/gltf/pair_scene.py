"""The scene that make_pairs.py varies: a bent 3 × 3 grid that fills the view of a camera, under a slanting distant
light, with a texture whose coordinates run from -0.5 to 1.5.
"""
import base64
import copy
import json
import math
import struct
import zlib

FLOAT, BYTE, UBYTE, SHORT, USHORT, UINT = 5126, 5120, 5121, 5122, 5123, 5125
PACK = {FLOAT: "f", BYTE: "b", UBYTE: "B", SHORT: "h", USHORT: "H", UINT: "I"}
WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def uri(data, mime="application/octet-stream"):
    return "data:%s;base64,%s" % (mime, base64.b64encode(data).decode())


def png(width, height, channels, rows, bits=8):
    kind = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    form = ">%d%s" % (width * channels, "B" if bits == 8 else "H")
    raw = b"".join(b"\0" + struct.pack(form, *row) for row in rows)

    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    header = struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b"")


def picture(function, channels, bits=8, size=4):
    rows = [[v for x in range(size) for v in function(x, y)] for y in range(size)]
    return uri(png(size, size, channels, rows, bits), "image/png")


COLORS = picture(lambda x, y: (60 + 60 * x, 60 + 60 * y, 90 + 30 * ((x + y) % 3)), 3)
COLORS_16 = picture(lambda x, y: (15420 + 15000 * x, 15420 + 15000 * y, 24000 + 7000 * ((x + y) % 3)), 3, 16)
ALPHA = picture(lambda x, y: (60 + 60 * x, 60 + 60 * y, 120, 255 if (x + y) % 2 else 60), 4)
SURFACE = picture(lambda x, y: (0, 60 + 60 * x, 60 + 60 * y), 3)
NORMALS = picture(lambda x, y: (90 + 30 * x, 90 + 30 * y, 230), 3)
MASK = picture(lambda x, y: (40 + 70 * x, 40 + 70 * y, 30, 60 + 60 * ((x + y) % 4)), 4)
WEBP = "data:image/webp;base64,UklGRjoAAABXRUJQVlA4TC0AAAAvA8AAAH9AkG2zQ9bf5gxTNSjzX4QMAMs7gCAAYs2CBQsmLViwYCSi/4Gwmg8A"


class Scene:
    """A document with a buffer that grows."""

    def __init__(self):
        self.data = bytearray()
        self.json = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": [], "extensionsUsed": []}

    def view(self, data, **more):
        self.data += bytes(-len(self.data) % 4)
        self.json["bufferViews"].append(dict(buffer=0, byteOffset=len(self.data), byteLength=len(data), **more))
        self.data += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values, kind, component=FLOAT, **more):
        width = WIDTH[kind]
        flat = [v for row in values for v in row] if width > 1 else list(values)
        view = self.view(struct.pack("<%d%s" % (len(flat), PACK[component]), *flat))
        entry = dict(bufferView=view, componentType=component, count=len(flat) // width, type=kind, **more)
        self.json["accessors"].append(entry)
        return len(self.json["accessors"]) - 1

    def use(self, *names):
        for name in names:
            if name not in self.json["extensionsUsed"]:
                self.json["extensionsUsed"].append(name)

    def image(self, where):
        images = self.json.setdefault("images", [])
        textures = self.json.setdefault("textures", [])
        images.append({"uri": where})
        textures.append({"source": len(images) - 1})
        return {"index": len(textures) - 1}

    def write(self, path):
        document = copy.deepcopy(self.json)
        if not document["extensionsUsed"]:
            del document["extensionsUsed"]
        document["buffers"] = [{"byteLength": len(self.data), "uri": uri(bytes(self.data))}]
        with open(path, "w") as out:
            json.dump(document, out, indent=1)
            out.write("\n")

    # Shorthands for the parts that features change.
    @property
    def material(self):
        return self.json["materials"][0]

    @property
    def pbr(self):
        return self.material["pbrMetallicRoughness"]

    @property
    def primitive(self):
        return self.json["meshes"][0]["primitives"][0]

    @property
    def attributes(self):
        return self.primitive["attributes"]

    @property
    def node(self):
        return self.json["nodes"][0]

    @property
    def camera(self):
        return self.json["cameras"][0]

    @property
    def light(self):
        return self.json["extensions"]["KHR_lights_punctual"]["lights"][0]

    def extend(self, name, value):
        self.use(name)
        self.material.setdefault("extensions", {})[name] = value


GRID = [(x - 1.0, y - 1.0) for y in range(3) for x in range(3)]
TRIANGLES = [i for y in range(2) for x in range(2) for c in [3 * y + x]
             for i in (c, c + 1, c + 4, c, c + 4, c + 3)]


def bend(x, y):
    return 0.25 - 0.25 * (x * x + 0.5 * y * y)


def normal(x, y):
    n = (0.5 * x, 0.25 * y, 1.0)
    length = math.sqrt(sum(v * v for v in n))
    return tuple(v / length for v in n)


def base():
    s = Scene()
    positions = s.accessor([(x, y, bend(x, y)) for x, y in GRID], "VEC3", min=[-1, -1, -0.125], max=[1, 1, 0.25])
    normals = s.accessor([normal(x, y) for x, y in GRID], "VEC3")
    uvs = s.accessor([(0.5 + x, 0.5 - y) for x, y in GRID], "VEC2")
    indices = s.accessor(TRIANGLES, "SCALAR", USHORT)
    s.json["materials"] = [{"name": "cloth", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.6}}]
    s.pbr["baseColorTexture"] = s.image(COLORS)
    s.json["meshes"] = [{"name": "sheet", "primitives": [
        {"attributes": {"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs}, "indices": indices,
         "material": 0}]}]
    s.json["cameras"] = [{"name": "eye", "type": "perspective",
                          "perspective": {"yfov": 0.8, "znear": 0.1, "zfar": 100}}]
    s.use("KHR_lights_punctual")
    s.json["extensions"] = {"KHR_lights_punctual": {"lights": [
        {"name": "sun", "type": "directional", "intensity": 3}]}}
    s.json["nodes"] = [
        {"name": "sheet", "mesh": 0},
        {"name": "eye", "camera": 0, "translation": [0, 0, 3]},
        {"name": "sun", "translation": [1, 2, 3], "rotation": [-0.2873479, 0.2391176, 0.0739128, 0.9245463],
         "extensions": {"KHR_lights_punctual": {"light": 0}}}]
    s.json["scenes"] = [{"nodes": [0, 1, 2]}]
    s.json["scene"] = 0
    return s
