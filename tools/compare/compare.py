"""Renders the table of cases.py with kiln and with what else is there, and writes the page. script/compare-materials
runs
it; --help says how."""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import time

import numpy as np

import assets
import cases
import page
import scene

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import peers

# Cycles takes most of a second to begin a picture, so it is spared the white world.
SETTINGS = {"size": scene.SIZE, "half": scene.HALF, "spp": 64, "peers_spp": 32, "cycles_sees": "boxes", "seeds": 4,
    "depth": 64}


def say(*words):
    print("compare:", *words, flush=True)


def read_exr(path):
    import OpenImageIO as oiio
    pixels = oiio.ImageBuf(str(path)).get_pixels(oiio.FLOAT)
    return pixels[..., :3]


def jobs_of(grids):
    return [{**case, "id": f"{case['id']}.{environment}", "environment": environment}
            for grid in grids for case in grid["cases"] for environment in scene.ENVIRONMENTS]


def render_kiln(kiln, folder, job):
    """All seeds of one job, (seeds, SIZE, SIZE, 3), and the run's warnings."""
    runs, warnings = [], set()
    scene.write_gltf(folder / "case.gltf", job["gltf"])
    for seed in range(SETTINGS["seeds"]):
        done = subprocess.run(
            [kiln, "render", folder / "case.gltf", "-o", folder / "case.exr", *peers.KILN_OPTIONS,
             "--size", f"{scene.SIZE}x{scene.SIZE}", "--spp", str(SETTINGS["spp"]), "--seed", str(seed),
             "--max-depth", str(SETTINGS["depth"]), "--env", folder / f"{job['environment']}.hdr"],
            capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"compare: kiln on {job['id']}: {done.stderr}")
        warnings |= {line for line in done.stderr.splitlines() if "warning" in line}
        runs.append(read_exr(folder / "case.exr"))
    return np.array(runs, np.float32), warnings


def run_kiln(kiln, folder, jobs):
    for number, job in enumerate(jobs):
        target = folder / f"{job['id']}.kiln.npy"
        if target.exists():
            continue
        runs, warnings = render_kiln(kiln, folder, job)
        np.save(target, runs)
        say(f"kiln: {job['id']} ({number + 1} of {len(jobs)})", *warnings)


def run_peers(arguments, folder):
    if peers.has(arguments.mitsuba, "mitsuba"):
        subprocess.run(peers.command(arguments.mitsuba, HERE / "with_mitsuba.py", folder), check=True)
    else:
        say("no Mitsuba: pip install mitsuba, and name that Python by --mitsuba or KILN_MITSUBA")
    if arguments.cycles and (peers.is_blender(arguments.cycles) or peers.has(arguments.cycles, "bpy")):
        subprocess.run(peers.command(arguments.cycles, HERE / "with_cycles.py", folder), check=True)
    else:
        say("no Cycles: pip install bpy in an environment of its own, or Blender; name that Python, or blender,",
            "by --cycles or KILN_CYCLES")


def parse():
    p = argparse.ArgumentParser(prog="script/compare-materials",
        description="Compares kiln's materials with other renderers'")
    p.add_argument("--kiln", default=HERE.parent.parent / "build/release/kiln", help="the program [build/release/kiln]")
    p.add_argument("--mitsuba", default=peers.find("mitsuba"),
                   help="a Python that has mitsuba [$KILN_MITSUBA, else this one, else script/bench's]")
    p.add_argument("--cycles", default=peers.find("cycles"),
                   help="a Python that has bpy, or Blender [$KILN_CYCLES, else this one, else script/bench's, else "
                        "blender]")
    p.add_argument("--folder", default=HERE.parent.parent / "out/compare", type=pathlib.Path,
                   help="where pictures are kept; what is there is not rendered again [out/compare]")
    p.add_argument("--only", default="", help="grids, by commas; the page is not written")
    p.add_argument("--assets", default=os.environ.get("KILN_ASSETS"), help="folder of the sample assets [$KILN_ASSETS]")
    return p.parse_args()


def main():
    arguments = parse()
    started = time.monotonic()
    only = set(filter(None, arguments.only.split(",")))
    grids = [g for g in cases.grids() if not only or g["id"] in only]
    jobs = jobs_of(grids)
    scene.write_shared(arguments.folder)
    (arguments.folder / "jobs.json").write_text(json.dumps({"settings": SETTINGS, "jobs": jobs}))
    run_kiln(arguments.kiln, arguments.folder, jobs)
    run_peers(arguments, arguments.folder)
    say(f"rendered after {time.monotonic() - started:.0f} s")
    if only:
        return
    say("page:", page.write(grids, arguments.folder, HERE.parent.parent / "docs", assets.render(arguments)))
    say(f"done after {time.monotonic() - started:.0f} s")


main()
