"""Where other renderers are found, or installed, and what they and kiln are told so that they render the same.

Mitsuba 3 (PyPI mitsuba) and Cycles (PyPI bpy, or Blender) each run in a Python of their own: bpy wants a certain Python
and numpy. KILN_MITSUBA and KILN_CYCLES name such Pythons (or, for Cycles, Blender)."""
import glob
import os
import pathlib
import re
import shutil
import subprocess
import sys
import venv

# What kiln leaves out beside peers: their filter is a box, they refine no meshes, and only --spp ends a render.
KILN_OPTIONS = ["--noise", "0", "--filter", "box:1", "--subdivide", "off", "--working-space", "lin_rec709"]

PEERS = {"mitsuba": ("KILN_MITSUBA", "mitsuba", ("mitsuba", "numpy")), "cycles": ("KILN_CYCLES", "bpy", ("bpy",))}
LLVM_LEAST = 16  # older ones lack what Mitsuba's kernels are made of


def has(python, module):
    return bool(python) and subprocess.run([python, "-c", f"import {module}"], capture_output=True).returncode == 0


def is_blender(python):
    return "blender" in pathlib.Path(python).name


def cache():
    base = os.environ.get("KILN_CACHE_DIR") or os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache"
    return pathlib.Path(base) / "kiln"


def find(peer):
    """A Python, or Blender, that has the peer; None."""
    variable, module, _ = PEERS[peer]
    named = os.environ.get(variable)
    if named:
        return named if is_blender(named) or has(named, module) else None
    installed = cache() / peer / "bin" / "python"
    for python in (sys.executable, str(installed)):
        if pathlib.Path(python).exists() and has(python, module):
            return python
    return shutil.which("blender") if peer == "cycles" else None


def install(peer, say):
    """The same, installed from PyPI into the cache where it is not there; None when that fails."""
    variable, module, packages = PEERS[peer]
    found = find(peer)
    if found or os.environ.get(variable):
        return found
    folder = cache() / peer
    say(f"installing {' and '.join(packages)} from PyPI into {folder}")
    try:
        venv.create(folder, with_pip=True)
        done = subprocess.run([folder / "bin" / "python", "-m", "pip", "install", "--quiet", *packages],
                              capture_output=True, text=True)
    except (OSError, subprocess.CalledProcessError) as error:
        say(f"no virtual environment: {error}")
        return None
    if done.returncode or not has(folder / "bin" / "python", module):
        say(f"pip could not install {module}: {(done.stderr.strip().splitlines() or ['it does not load'])[-1]}")
        shutil.rmtree(folder, ignore_errors=True)
        return None
    return str(folder / "bin" / "python")


def llvm():
    """The newest LLVM that Mitsuba's llvm variants can use; None."""
    found = {}
    for path in glob.glob("/usr/lib/*/libLLVM*.so*") + glob.glob("/usr/lib*/llvm*/lib/libLLVM*.so*"):
        version = re.search(r"libLLVM[-.](?:so\.)?(\d+)", pathlib.Path(path).name)
        if version and int(version[1]) >= LLVM_LEAST:
            found[int(version[1])] = path
    return found[max(found)] if found else None


def environment():
    """Of a process that runs Mitsuba."""
    library = llvm()
    return {**os.environ, **({"DRJIT_LIBLLVM_PATH": library} if library and "DRJIT_LIBLLVM_PATH" not in os.environ
                             else {})}


def command(python, script, *arguments):
    """How a script runs in a Python or in Blender."""
    if is_blender(python):
        return [python, "-b", "--python-exit-code", "1", "--python", str(script), "--", *map(str, arguments)]
    return [python, str(script), *map(str, arguments)]


def cycles_settings(bounces):
    """Of scene.cycles: every path as long as kiln's, nothing clamped, filtered or denoised."""
    return {"device": "CPU", "use_adaptive_sampling": False, "use_denoising": False, "sample_clamp_direct": 0,
            "sample_clamp_indirect": 0, "light_sampling_threshold": 0, "blur_glossy": 0, "pixel_filter_type": "BOX",
            "filter_width": 1.0, "caustics_reflective": True, "caustics_refractive": True, "max_bounces": bounces,
            "diffuse_bounces": bounces, "glossy_bounces": bounces, "transmission_bounces": bounces,
            "volume_bounces": bounces, "transparent_max_bounces": bounces}
