"""Renders the benchmark's scenes with kiln and its peers, and writes the table of efficiencies. script/bench runs it;
--help says how. docs/benchmarks.md explains the numbers."""
import argparse
import fcntl
import json
import os
import pathlib
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE.parent))
import measure
import peers
import references
import runners
import scenes
import table

RENDERERS = ("kiln", "mitsuba-multijitter", "mitsuba-independent", "cycles")


def say(text):
    print(f"bench: {text}", flush=True)


def names(known):
    def parse(text):
        chosen = text.split(",")
        unknown = [name for name in chosen if name not in known]
        if unknown:
            raise argparse.ArgumentTypeError(f"{unknown[0]} is not one of {', '.join(known)}")
        return chosen
    return parse


def positive(text):
    if int(text) < 1:
        raise argparse.ArgumentTypeError("at least 1")
    return int(text)


def parse(words=None):
    p = argparse.ArgumentParser(
        prog="script/bench", description="The benchmarks, against other renderers where they can be installed",
        epilog="example: script/bench --scenes S1,S8 --renderers kiln,mitsuba-multijitter --seeds 4")
    p.add_argument("--scenes", type=names(list(scenes.SCENES)), default=list(scenes.SCENES),
                   help=f"by commas [{','.join(scenes.SCENES)}]")
    p.add_argument("--renderers", type=names(RENDERERS), default=list(RENDERERS), help=f"[{','.join(RENDERERS)}]")
    p.add_argument("--spp", type=positive, help="samples per pixel of what is measured [64; quick: 8]")
    p.add_argument("--seeds", type=positive, help="[8; quick: 3]")
    p.add_argument("--side", type=positive, help="pixels of a picture's side [256; quick: 64]")
    p.add_argument("--quick", action="store_true", help="small pictures and short references: to try it, not to cite")
    p.add_argument("--reference-seconds", type=float,
                   help="for each reference; kept ones are gone on with [180; quick: 2]")
    p.add_argument("--reference-spp", type=positive,
                   help="of each of the renders that a reference is made of [256; quick: 32]")
    p.add_argument("--clock", choices=("wall", "cpu"), default="wall",
                   help="cpu: CPU time over threads, for a machine that others use too [wall]")
    p.add_argument("--threads", type=positive, default=len(os.sched_getaffinity(0)),
                   help="of every renderer [all cores]")
    p.add_argument("--kiln", type=pathlib.Path, default=ROOT / "build/release/kiln", help="[build/release/kiln]")
    p.add_argument("--assets", default=os.environ.get("KILN_ASSETS"), help="folder for S7 and S8 [$KILN_ASSETS]")
    p.add_argument("--folder", type=pathlib.Path, default=ROOT / "out/bench", help="of the results [out/bench]")
    p.add_argument("--no-install", action="store_true", help="peers that are not there are left out")
    a = p.parse_args(words)
    usual = {"spp": 8, "seeds": 3, "side": 64, "reference_seconds": 2.0, "reference_spp": 32} if a.quick else \
        {"spp": 64, "seeds": 8, "side": 256, "reference_seconds": 180.0, "reference_spp": 256}
    for name, value in usual.items():
        if getattr(a, name) is None:
            setattr(a, name, value)
    a.clock = {"wall": "seconds", "cpu": "cpu_seconds"}[a.clock]
    return a


def machine_of(kiln, threads):
    told = json.loads(subprocess.run([kiln, "info", "--json"], capture_output=True, text=True, check=True).stdout)
    return {**told["machine"], "threads": threads}


def run(arguments):
    made, missing = scenes.make(arguments.folder / "scenes", arguments.scenes, arguments.assets, arguments.side)
    if missing:
        say(f"left out {', '.join(missing)}: --assets or KILN_ASSETS names the folder of their files")
    found = runners.available(arguments.renderers, arguments.kiln, arguments.threads, not arguments.no_install, say)
    store = references.Store(peers.cache() / "references", arguments.reference_spp, arguments.reference_seconds, say)
    results, machine = [], machine_of(arguments.kiln, arguments.threads)
    for name, path in made.items():
        say(f"{name}: {scenes.SCENES[name][0]}")
        results.append(measure.measure(name, path, scenes.settings_of(path), found, arguments, store, say))
        table.write(arguments.folder, machine, results)  # what there is, should the rest fail
    return table.write(arguments.folder, machine, results)


def main():
    arguments, started = parse(), time.monotonic()
    if not arguments.kiln.exists():
        sys.exit(f"bench: {arguments.kiln} does not exist: script/build release, or --kiln")
    arguments.folder.mkdir(parents=True, exist_ok=True)
    peers.cache().mkdir(parents=True, exist_ok=True)
    with open(peers.cache() / "bench.lock", "w") as lock:  # one renderer at a time
        fcntl.flock(lock, fcntl.LOCK_EX)
        try:
            print(run(arguments))
        except runners.Failed as failure:
            sys.exit(f"bench: {failure}")
    say(f"wrote {arguments.folder}/bench.md and bench.json after {time.monotonic() - started:.0f} s")


if __name__ == "__main__":
    main()
