"""Renderers as the benchmark sees them: render(scene, spp, seed) gives a picture and what it took."""
import json
import math
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

import pictures
import scenes

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import peers


class Failed(Exception):
    pass


def children_cpu():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def kiln_options(path):
    """A scene's settings. Lens: kiln's f-stop is that of a sensor 24 mm high, a metre per unit."""
    s = scenes.settings_of(path)
    options = [*peers.KILN_OPTIONS, "--size", f"{s['width']}x{s['height']}", "--max-depth", str(s["bounces"] + 1)]
    sky = s.get("env")
    options += ["--env", str(path.parent / sky["file"]), "--env-intensity", str(sky["intensity"])] if sky else \
        ["--env", "none"]
    if "lens" in s:
        focal = 0.012 / math.tan(s["yfov"] / 2)
        options += ["--aperture", f"{focal / (2 * s['lens']['aperture_radius']):.9g}",
                    "--focus", str(s["lens"]["focus_distance"])]
    return options


class Kiln:
    """A process for each picture; its time is that of its phase 'render'."""
    name = family = "kiln"

    def __init__(self, program, threads):
        self.program, self.threads = program, threads
        self.version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()

    def open(self, path):
        self.path, self.options = path, kiln_options(path)

    def close(self):
        pass

    def render(self, spp, seed):
        with tempfile.TemporaryDirectory() as folder:
            picture, stats = pathlib.Path(folder) / "picture.exr", pathlib.Path(folder) / "stats.json"
            before = children_cpu()
            done = subprocess.run([self.program, "render", self.path, *self.options, "--spp", str(spp), "--seed",
                                   str(seed), "--threads", str(self.threads), "-o", picture, "--stats", stats, "-q"],
                                  capture_output=True, text=True)
            cpu = children_cpu() - before
            if done.returncode:
                raise Failed(f"kiln: {done.stderr.strip()}")
            told = json.loads(stats.read_text())
            return pictures.read_exr(picture)[0], {"seconds": told["render"]["seconds"], "cpu_seconds": cpu,
                                                   "peak": told["memory"]["peak"]}

    def replay_share(self, spp):
        """What share of the speed of Embree's replay of the same rays the render has, and that replay's samples/s."""
        done = subprocess.run([self.program, "bench", self.path, *bench_options(self.options), "--spp", str(spp),
                               "--threads", str(self.threads), "--embree", "--json"], capture_output=True, text=True)
        if done.returncode:
            raise Failed(f"kiln bench: {done.stderr.strip()}")
        told = json.loads(done.stdout)["embree"]
        return {"render_share": told["render_share"], "samples_per_second": told["samples_per_second"]}


def bench_options(options):
    """kiln bench knows no --noise."""
    at = options.index("--noise")
    return options[:at] + options[at + 2:]


class Peer:
    """A process for each scene, told of pictures line by line (server.py)."""

    def __init__(self, name, family, script, python, arguments, version):
        self.name, self.family, self.version = name, family, version
        self.script, self.python, self.arguments = script, python, arguments

    def open(self, path):
        self.settings, self.errors = scenes.settings_of(path), tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen(peers.command(self.python, self.script, path.resolve(), *self.arguments),
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.errors, text=True,
                                        bufsize=1, env=peers.environment())
        self.answer()

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            self.process.wait()
            self.errors.seek(0)
            error = self.errors.read().strip().splitlines()
            raise Failed(f"{self.name}: {error[-1] if error else 'ended without a word'}")
        return json.loads(line)

    def render(self, spp, seed):
        handle, file = tempfile.mkstemp(suffix=".f32")
        os.close(handle)
        try:
            self.process.stdin.write(json.dumps({"spp": spp, "seed": seed, "file": file}) + "\n")
            told = self.answer()
            return pictures.read_raw(pathlib.Path(file), self.settings["width"], self.settings["height"]), told
        except BrokenPipeError:
            return self.answer()
        finally:
            os.unlink(file)

    def close(self):
        if self.process.poll() is None:
            self.process.stdin.close()
            self.process.wait()
        self.errors.close()


def version_of(python, code):
    if peers.is_blender(python):
        return subprocess.run([python, "--version"], capture_output=True, text=True).stdout.split("\n")[0]
    return subprocess.run([python, "-c", code], capture_output=True, text=True).stdout.strip().splitlines()[-1]


def available(wanted, program, threads, may_install, say):
    """Runners of the names that are there; what is not, is told."""
    found = []
    get = (lambda peer: peers.install(peer, say)) if may_install else peers.find
    if "kiln" in wanted:
        found.append(Kiln(program, threads))
    samplers = [s for s in ("multijitter", "independent") if f"mitsuba-{s}" in wanted]
    python = get("mitsuba") if samplers else None
    if samplers and not python:
        say("no Mitsuba: pip install mitsuba numpy, and name that Python by KILN_MITSUBA")
    elif samplers and not peers.llvm():
        say(f"no Mitsuba: its llvm variants need LLVM {peers.LLVM_LEAST} or newer, such as Debian's libllvm19")
    elif samplers:
        version = version_of(python, "import mitsuba; print('Mitsuba', mitsuba.__version__, 'llvm')")
        found += [Peer(f"mitsuba-{s}", "mitsuba", HERE / "with_mitsuba.py", python, [s, threads], version)
                  for s in samplers]
    if "cycles" in wanted:
        python = get("cycles")
        if python:
            version = version_of(python, "import bpy; print('Cycles of Blender', bpy.app.version_string)")
            found.append(Peer("cycles", "cycles", HERE / "with_cycles.py", python, [threads], version))
        else:
            say("no Cycles: pip install bpy in a Python of its own, or Blender, named by KILN_CYCLES")
    return found
