"""The sphere, its camera and its surroundings, as files that every renderer of the comparison reads.

Frame and units are glTF's: right-handed, +Y up, metres. The sphere has radius 1 about the origin; an orthographic
camera
at z = 4 sees the square [-HALF, HALF]². Each sphere is a picture of its own, so that none is seen in another."""
import json
import pathlib

import numpy as np

SIZE = 64  # pixels a side
HALF = 1.05
ENVIRONMENTS = ("white", "boxes")


def sphere(around=256, rings=128):
    """Positions, normals, tangents, uv (float32) and triangles (int32); u runs around +Y from -X over +Z. The poles are
    rings of corners, so that tangents are exact there too."""
    u, v = np.meshgrid(np.linspace(0, 1, around + 1), np.linspace(0, 1, rings + 1))
    phi, theta = 2 * np.pi * u.ravel(), np.pi * v.ravel()
    normal = np.stack([-np.cos(phi) * np.sin(theta), np.cos(theta), np.sin(phi) * np.sin(theta)], 1)
    tangent = np.stack([np.sin(phi), 0 * phi, np.cos(phi), np.full(phi.shape, -1.0)], 1)
    uv = np.stack([u.ravel(), v.ravel()], 1)
    j, i = np.meshgrid(np.arange(rings), np.arange(around), indexing="ij")
    a = (j * (around + 1) + i).ravel()
    b, c, d = a + 1, a + around + 1, a + around + 2
    upper, lower = np.stack([a, c, b], 1), np.stack([b, c, d], 1)
    triangles = np.concatenate([upper[around:], lower[:-around]])  # those at the poles that are none are left out
    return [x.astype("<f4") for x in (normal, normal, tangent, uv)] + [triangles.astype("<i4")]


def environment(name):
    """Radiance, rows from +Y down, (128, 256, 3). 'white' is 1 everywhere; 'boxes' is a grey room with two soft boxes,
    all values exact in RGBE: a renderer's mean depends on nothing but its materials."""
    picture = np.ones((128, 256, 3), np.float32)
    if name == "boxes":
        picture[:] = 0.25
        picture[20:52, 16:56] = (8, 8, 8)
        picture[40:88, 96:112] = (6, 3, 1.5)
        picture[100:, :] = (0.0625, 0.09375, 0.125)
    return picture


def look_up(picture, direction):
    """The nearest texel: u = 0.5 + atan2(z, x)/2π, v = acos(y)/π from the top."""
    rows, columns = picture.shape[:2]
    u = 0.5 + np.arctan2(direction[..., 2], direction[..., 0]) / (2 * np.pi)
    v = np.arccos(np.clip(direction[..., 1], -1, 1)) / np.pi
    return picture[np.minimum((v * rows).astype(int), rows - 1), (u * columns).astype(int) % columns]


def inside():
    """The pixels that see the sphere and nothing else, (SIZE, SIZE) of bool."""
    edge = np.abs(np.linspace(-HALF, HALF, SIZE + 1))
    far = np.maximum(edge[1:], edge[:-1])
    return far[:, None] ** 2 + far[None, :] ** 2 < 0.99**2


def write_hdr(path, picture):
    mantissa, exponent = np.frexp(picture.max(2))
    scale = np.ldexp(1.0, 8 - exponent)[..., None]
    rgbe = np.concatenate([picture * scale, (exponent + 128)[..., None]], 2).astype(np.uint8)
    rows, columns = picture.shape[:2]
    head = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {rows} +X {columns}\n".encode()
    path.write_bytes(head + rgbe.tobytes())


def write_ply(path, position, normal, uv, triangles):
    fields = "".join(f"property float {n}\n" for n in ("x", "y", "z", "nx", "ny", "nz", "u", "v"))
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(position)}\n{fields}"
            f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    faces = np.zeros(len(triangles), [("n", "u1"), ("i", "<i4", 3)])
    faces["n"], faces["i"] = 3, triangles
    path.write_bytes(head.encode() + np.hstack([position, normal, uv]).astype("<f4").tobytes() + faces.tobytes())


def write_shared(folder: pathlib.Path):
    """What all cases share: sphere.bin, sphere.ply, sphere.npz, white.hdr, boxes.hdr."""
    folder.mkdir(parents=True, exist_ok=True)
    position, normal, tangent, uv, triangles = sphere()
    (folder / "sphere.bin").write_bytes(b"".join(x.tobytes() for x in (position, normal, tangent, uv, triangles)))
    write_ply(folder / "sphere.ply", position, normal, uv, triangles)
    np.savez(folder / "sphere.npz", position=position, normal=normal, uv=uv, triangles=triangles)
    for name in ENVIRONMENTS:
        write_hdr(folder / f"{name}.hdr", environment(name))


def write_gltf(path, material):
    position, normal, tangent, uv, triangles = sphere()
    parts = [(position, "VEC3", 5126), (normal, "VEC3", 5126), (tangent, "VEC4", 5126), (uv, "VEC2", 5126),
             (triangles.ravel(), "SCALAR", 5125)]
    views, accessors, offset = [], [], 0
    for index, (array, kind, component) in enumerate(parts):
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": array.nbytes})
        accessors.append({"bufferView": index, "componentType": component, "count": len(array), "type": kind})
        offset += array.nbytes
    accessors[0].update(min=position.min(0).tolist(), max=position.max(0).tolist())
    document = {
        "asset": {"version": "2.0"},
        "extensionsUsed": sorted(material.get("extensions", {})),
        "buffers": [{"uri": "sphere.bin", "byteLength": offset}],
        "bufferViews": views, "accessors": accessors, "materials": [material],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TANGENT": 2, "TEXCOORD_0": 3},
                                    "indices": 4, "material": 0}]}],
        "cameras": [{"type": "orthographic",
                     "orthographic": {"xmag": HALF, "ymag": HALF, "znear": 0.1, "zfar": 100}}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 4]}],
        "scenes": [{"nodes": [0, 1]}], "scene": 0}
    if not document["extensionsUsed"]:
        del document["extensionsUsed"]
    path.write_text(json.dumps(document))
