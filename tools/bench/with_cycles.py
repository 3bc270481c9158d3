"""Renders a scene of scenes.py with Cycles as often as it is told to: with_cycles.py SCENE THREADS, as server.py says,
in a Python that has bpy; or blender -b --python with_cycles.py -- SCENE THREADS. Run by runners.py."""
import pathlib
import sys
import tempfile
import time

started = time.perf_counter()
import bpy
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
import peers
import server
from scenes import settings_of


def surround(scene, sky, folder):
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    tree = scene.world.node_tree
    tree.nodes.clear()
    background = tree.nodes.new("ShaderNodeBackground")
    background.inputs[0].default_value = (0, 0, 0, 1)
    tree.links.new(background.outputs[0], tree.nodes.new("ShaderNodeOutputWorld").inputs[0])
    if sky:
        texture = tree.nodes.new("ShaderNodeTexEnvironment")
        texture.image = bpy.data.images.load(str(folder / sky["file"]))
        texture.image.colorspace_settings.name = "Linear Rec.709"
        tree.links.new(texture.outputs[0], background.inputs[0])
        background.inputs[1].default_value = sky["intensity"]


def look(scene, lens):
    scene.camera = next(o for o in bpy.data.objects if o.type == "CAMERA")
    view = scene.camera.data
    view.clip_start, view.clip_end = 0.001, 1e4
    if lens:
        view.dof.use_dof, view.dof.focus_distance = True, lens["focus_distance"]
        view.dof.aperture_fstop = view.lens * 1e-3 / (2 * lens["aperture_radius"])


def scene_of(path, threads):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(path))
    settings, scene = settings_of(path), bpy.context.scene
    scene.render.engine = "CYCLES"
    for name, value in {"resolution_x": settings["width"], "resolution_y": settings["height"], "use_motion_blur": False,
                        "resolution_percentage": 100, "threads_mode": "FIXED", "threads": threads}.items():
        setattr(scene.render, name, value)
    for name, value in peers.cycles_settings(settings["bounces"]).items():
        setattr(scene.cycles, name, value)
    for name, value in {"file_format": "OPEN_EXR", "color_depth": "32", "color_mode": "RGB"}.items():
        setattr(scene.render.image_settings, name, value)
    scene.view_settings.view_transform = "Raw"
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.use_nodes else []:
            if node.type == "BSDF_PRINCIPLED":
                node.distribution = "GGX"  # without energy compensation, as Mitsuba: less work
    look(scene, settings.get("lens"))
    surround(scene, settings.get("env"), path.parent)
    return scene


def render(scene, path, spp, seed):
    scene.cycles.samples, scene.cycles.seed = spp, seed
    bpy.ops.render.render()
    bpy.data.images["Render Result"].save_render(str(path))
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, -1)[::-1, :, :3]


def main():
    told = server.quiet()
    scene = scene_of(pathlib.Path(sys.argv[-2]), int(sys.argv[-1]))
    with tempfile.TemporaryDirectory() as folder:
        server.serve(told, time.perf_counter() - started,
                     lambda spp, seed: render(scene, pathlib.Path(folder) / "picture.exr", spp, seed))


main()
