"""Reads what Mitsuba needs of a .glb of scenes.py. Wants numpy."""
import json
import struct

import numpy as np

TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Asset:
    def __init__(self, path):
        data = path.read_bytes()
        length, = struct.unpack_from("<I", data, 12)
        self.json, self.data = json.loads(data[20:20 + length]), data[28 + length:]

    def view(self, index):
        v = self.json["bufferViews"][index]
        return self.data[v.get("byteOffset", 0):v.get("byteOffset", 0) + v["byteLength"]], v.get("byteStride")

    def accessor(self, index):
        """Rows; not interleaved, or by byteStride."""
        a = self.json["accessors"][index]
        data, stride = self.view(a["bufferView"])
        kind, width = np.dtype(TYPES[a["componentType"]]), WIDTHS[a["type"]]
        return np.ndarray((a["count"], width), kind, data, a.get("byteOffset", 0),
                          (stride or kind.itemsize * width, kind.itemsize)).copy()

    def image(self, texture):
        """Encoded bytes and their kind of file."""
        image = self.json["images"][self.json["textures"][texture]["source"]]
        return self.view(image["bufferView"])[0], {"image/png": "png", "image/jpeg": "jpg"}[image["mimeType"]]

    def nodes(self):
        """(node, its matrix in the world)"""
        def walk(index, parent):
            node = self.json["nodes"][index]
            world = parent @ matrix(node)
            yield node, world
            for child in node.get("children", []):
                yield from walk(child, world)
        for root in self.json["scenes"][self.json.get("scene", 0)]["nodes"]:
            yield from walk(root, np.eye(4))


def matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    m = np.eye(4)
    m[:3, :3] = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                          [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                          [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    m[:3, :3] *= np.array(node.get("scale", (1, 1, 1)))[None]
    m[:3, 3] = node.get("translation", (0, 0, 0))
    return m
