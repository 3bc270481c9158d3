"""Renders the jobs of jobs.json with Cycles: with_cycles.py FOLDER, in a Python that has bpy; or
blender -b --python with_cycles.py -- FOLDER. Run by compare.py."""
import json
import os
import pathlib
import sys

import bpy
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import peers


def build_node(tree, recipe):
    """A recipe is {"node": type, "inputs": {name: value or recipe}, "set": {property: value}}; gives the output
    socket."""
    node = tree.nodes.new(recipe["node"])
    for name, value in recipe.get("set", {}).items():
        setattr(node, name, value)
    for name, value in recipe.get("inputs", {}).items():
        socket = node.inputs[int(name)] if name.isdigit() else node.inputs[name]
        if isinstance(value, dict):
            tree.links.new(build_node(tree, value), socket)
        elif isinstance(value, list):
            socket.default_value = value + [1.0] * (len(socket.default_value) - len(value))
        else:
            socket.default_value = value
    return node.outputs[0]


def set_up(folder, settings):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = settings["size"]
    scene.render.resolution_percentage = 100
    for name, value in {**peers.cycles_settings(settings["depth"]), "samples": settings["peers_spp"]}.items():
        setattr(scene.cycles, name, value)
    for name, value in {"file_format": "OPEN_EXR", "color_depth": "32", "color_mode": "RGB"}.items():
        setattr(scene.render.image_settings, name, value)
    scene.view_settings.view_transform = "Raw"
    data = np.load(folder / "sphere.npz")
    turn = lambda p: np.stack([p[:, 0], -p[:, 2], p[:, 1]], 1)  # Blender has +Z up
    mesh = bpy.data.meshes.new("sphere")
    mesh.from_pydata(turn(data["position"]).tolist(), [], data["triangles"].tolist())
    layer = mesh.uv_layers.new(name="uv")
    layer.data.foreach_set("uv", data["uv"][data["triangles"].ravel()].ravel())
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    mesh.normals_split_custom_set_from_vertices(turn(data["normal"]).tolist())
    ball = bpy.data.objects.new("sphere", mesh)
    scene.collection.objects.link(ball)
    mesh.materials.append(bpy.data.materials.new("material"))
    mesh.materials[0].use_nodes = True
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 2 * settings["half"]
    camera.location, camera.rotation_euler = (0, -4, 0), (np.pi / 2, 0, 0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    return scene, mesh.materials[0].node_tree, scene.world.node_tree


def surround(tree, path):
    tree.nodes.clear()
    background = tree.nodes.new("ShaderNodeBackground")
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(str(path.resolve()), check_existing=True)
    texture.image.colorspace_settings.name = "Linear Rec.709"
    texture.interpolation = "Closest"
    tree.links.new(texture.outputs[0], background.inputs[0])
    tree.links.new(background.outputs[0], tree.nodes.new("ShaderNodeOutputWorld").inputs[0])


def render(scene, path, seed, size):
    scene.cycles.seed = seed
    bpy.ops.render.render()
    bpy.data.images["Render Result"].save_render(str(path))
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(size, size, -1)[::-1, :, :3]


def main():
    folder = pathlib.Path(sys.argv[-1]).resolve()
    work = json.loads((folder / "jobs.json").read_text())
    settings = work["settings"]
    told = os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # Blender talks
    scene, tree, world = set_up(folder, settings)
    for job in work["jobs"]:
        target = folder / f"{job['id']}.cycles.npy"
        if job["environment"] != work["settings"]["cycles_sees"] or job["cycles"] is None or target.exists():
            continue
        tree.nodes.clear()
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        for name, recipe in job["cycles"].items():
            tree.links.new(build_node(tree, recipe), output.inputs[name])
        surround(world, folder / f"{job['environment']}.hdr")
        runs = [render(scene, folder / "cycles.exr", seed, settings["size"]) for seed in range(settings["seeds"])]
        np.save(target, np.array(runs, np.float32))
        print(f"cycles: {job['id']}", file=told, flush=True)


main()
