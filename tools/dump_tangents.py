#!/usr/bin/env python3
"""Dumps Blender's tangents, which are MikkTSpace's, as the truth for tests/importers/mesh/test_tangents.c.

    pip install "numpy<2" bpy==5.0.1          (Python 3.11; in an environment of its own)
    tools/dump_tangents.py NormalTangentTest.glb tests/data/mesh/normal_tangent_test.bin
    tools/dump_tangents.py mirrored              tests/data/mesh/mirrored.bin

The file: row count and corner count (uint32), rows of 12 floats (position 3, normal 3, uv 2, tangent 3, sign), and a
row number (uint16) for each of the three corners of each triangle; little-endian. Frames are glTF's: +Y up, v down.
Blender's sign counts with v up, as glTF's w does.
"""
import math
import random
import struct
import sys

import bpy
import mathutils


def import_glb(path):
    bpy.ops.import_scene.gltf(filepath=path)
    return next(o.data for o in bpy.data.objects if o.type == "MESH")


def mirrored_mesh():
    """A bumpy torus whose uvs run there and back again, with a seam, hard edges, triangles without uv area (alone, and
    between others), and triangles without extent."""
    rng = random.Random(2008)
    rings, sides = 16, 8  # powers of two: halves of their uvs are exact
    points, uvs, faces = [], [], []
    for i in range(rings):
        for j in range(sides):
            a, b = 2 * math.pi * i / rings, 2 * math.pi * j / sides
            r = 0.4 + 0.05 * rng.random()
            points.append(((1 + r * math.cos(b)) * math.cos(a), (1 + r * math.cos(b)) * math.sin(a), r * math.sin(b)))

    def corner(i, j):
        u = abs(2 * (i % rings) / rings - 1)  # mirrored at ring 0 and ring rings / 2
        return (i % rings) * sides + j % sides, (u, j / sides)  # j runs to sides: a seam

    for i in range(rings):
        for j in range(sides):
            quad = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
            kind = rng.random()
            if kind < 0.04:
                quad = [(p, (0.25, 0.5)) for p, _ in quad]  # no uv area, and no neighbour with the same uvs
            if kind > 0.9:
                # A point beside the diagonal whose uv is on it: a triangle without uv area among its neighbours.
                a, c = quad[0], quad[2]
                quad.append((len(points), tuple((s + t) / 2 for s, t in zip(a[1], c[1]))))
                points.append(tuple((s + t) / 2 + 0.03 for s, t in zip(points[a[0]], points[c[0]])))
                triangles = ((0, 1, 2), (0, 2, 4), (0, 4, 3), (4, 2, 3))
            else:
                triangles = ((0, 1, 2), (0, 2, 3))
            for t in triangles:
                faces.append([quad[k] for k in t])
    # No extent: two points where a vertex is.
    for i in (3, 7, 11):
        twin = len(points)
        points.append(points[corner(i, 2)[0]])
        faces.append([corner(i, 2), (twin, corner(i, 2)[1]), corner(i + 1, 3)])

    mesh = bpy.data.meshes.new("mirrored")
    mesh.from_pydata(points, [], [[p for p, _ in f] for f in faces])
    layer = mesh.uv_layers.new(name="UVMap")
    for loop, uv in zip(layer.data, (uv for f in faces for _, uv in f)):
        loop.uv = uv
    # Free normals, as an importer brings them: smooth, but for some faces.
    normals = mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER")
    for k, polygon in enumerate(mesh.polygons):
        for index in polygon.loop_indices:
            x, y, z = mesh.vertices[mesh.loops[index].vertex_index].co
            ring = math.hypot(x, y)
            n = mathutils.Vector((x * (1 - 1 / ring), y * (1 - 1 / ring), z)).normalized()
            normals.data[index].vector = polygon.normal if k % 23 == 0 else n
    return mesh


def rows_of(mesh):
    mesh.calc_tangents()
    layer = mesh.uv_layers[0].data
    for polygon in mesh.polygons:
        assert len(polygon.loop_indices) == 3
        for index in polygon.loop_indices:
            loop = mesh.loops[index]
            (px, py, pz), (nx, ny, nz) = mesh.vertices[loop.vertex_index].co, loop.normal
            (tx, ty, tz), (u, v) = loop.tangent, layer[index].uv
            yield struct.pack("<12f", px, pz, -py, nx, nz, -ny, u, 1 - v, tx, tz, -ty, loop.bitangent_sign)


def main(source, target):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh = mirrored_mesh() if source == "mirrored" else import_glb(source)
    table, corners = {}, []
    for row in rows_of(mesh):
        corners.append(table.setdefault(row, len(table)))
    with open(target, "wb") as f:
        f.write(struct.pack("<2I", len(table), len(corners)) + b"".join(table))
        f.write(struct.pack(f"<{len(corners)}H", *corners))
    print(f"{target}: {len(corners) // 3} triangles, {len(table)} rows")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
