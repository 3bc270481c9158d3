"""Renders the jobs of jobs.json with Mitsuba 3: with_mitsuba.py FOLDER. Run by compare.py in a Python that has mitsuba.

The variant is $KILN_MITSUBA_VARIANT, or scalar_rgb, which needs nothing else."""
import json
import os
import pathlib
import sys

import mitsuba as mi
import numpy as np

mi.set_variant(os.environ.get("KILN_MITSUBA_VARIANT", "scalar_rgb"))


def scene(folder, job, settings):
    look = mi.ScalarTransform4f().look_at([0, 0, 4], [0, 0, 0], [0, 1, 0])
    shape = {"type": "ply", "filename": str(folder / "sphere.ply"), "bsdf": job["mitsuba"]["bsdf"]}
    if "interior" in job["mitsuba"]:
        shape["interior"] = job["mitsuba"]["interior"]
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "volpath" if "interior" in shape else "path", "max_depth": settings["depth"] + 1},
        "sphere": shape,
        "environment": {"type": "envmap", "filename": str(folder / f"{job['environment']}.hdr"),
                        "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], 90)},
        "sensor": {
            "type": "orthographic", "near_clip": 0.1, "far_clip": 100,
            "to_world": look @ mi.ScalarTransform4f().scale([settings["half"], settings["half"], 1]),
            "film": {"type": "hdrfilm", "width": settings["size"], "height": settings["size"],
                     "rfilter": {"type": "box"}, "pixel_format": "rgb", "component_format": "float32"},
            "sampler": {"type": "independent"}}})


def main():
    folder = pathlib.Path(sys.argv[1])
    work = json.loads((folder / "jobs.json").read_text())
    for job in work["jobs"]:
        target = folder / f"{job['id']}.mitsuba.npy"
        if job["mitsuba"] is None or target.exists():
            continue
        world = scene(folder, job, work["settings"])
        runs = [np.array(mi.render(world, spp=work["settings"]["peers_spp"], seed=seed))[..., :3]
                for seed in range(work["settings"]["seeds"])]
        np.save(target, np.array(runs, np.float32))
        print(f"mitsuba: {job['id']}", flush=True)


main()
