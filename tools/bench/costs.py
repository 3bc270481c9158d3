"""What effects cost on scenes that call for them, and would cost on scenes that do not: a table of effect by scene.

A scene is rendered as it is, without each effect that it calls for (--effects -NAME) and with the machinery of each that
it does not (+NAME), in turn, so that a noisy machine hurts all alike; of each the fastest run counts. Time is that
of a sample, without what precedes the first."""
import json
import os
import resource
import subprocess

SCENES = [  # name, file of KILN_ASSETS, options
    ("helmet", "gltf/FlightHelmet/FlightHelmet.gltf", ["--aperture", "1.4"]),
    ("sunglasses", "gltf/SunglassesKhronos.glb", []),
    ("dispersion", "gltf/dispersion-test.glb", []),
    ("attenuation", "gltf/AttenuationTest.glb", []),
    ("cloth", "gltf/19_sheen/19_sheen.gltf", []),
    ("clear coats", "gltf/ClearCoatTest.glb", []),
]


def run(kiln, scene, effects, options, folder):
    """What a render knows of itself, and the seconds of the processor that its process took."""
    stats = os.path.join(folder, "stats.json")
    command = [kiln, "render", scene, "-o", os.path.join(folder, "out.exr"), "--stats", stats, "--quiet", "--effects", effects]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(command + options, check=True)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    with open(stats) as f:
        return json.load(f), seconds


def seconds_per_sample(facts):
    return facts["render"]["seconds"] / facts["render"]["samples"]


def measure_scene(kiln, scene, options, rounds, folder):
    """{effect: (called, cost, difference)}: cost is time with over time without it, less 1; difference of the picture
    that lacks it, the root of relMSE, or None."""
    facts, _ = run(kiln, scene, "auto", options, folder)
    wishes = {row["name"]: ("-" if row["called"] else "+") + row["name"] for row in facts["effects"]
              if row["removable"] or not row["called"]}
    least, differences = {"auto": seconds_per_sample(facts)}, {}
    for _ in range(rounds):
        for wish in ["auto"] + list(wishes.values()):
            facts, _ = run(kiln, scene, wish if wish == "auto" else "auto," + wish, options, folder)
            least[wish] = min(least.get(wish, 1e9), seconds_per_sample(facts))
            if facts.get("ablation"):
                differences[wish[1:]] = facts["ablation"]["difference"]
    found = {}
    for name, wish in wishes.items():
        called = wish[0] == "-"
        ratio = least["auto"] / least[wish] if called else least[wish] / least["auto"]
        found[name] = (called, ratio - 1, differences.get(name))
    return found


def cell(entry):
    if entry is None:
        return ""
    called, cost, difference = entry
    if not called:
        return "%+.1f %%" % (100 * cost)
    return "**%+.0f %%**, %s" % (100 * cost, "?" if difference is None else "%.2g %%" % (100 * difference))


def table(kiln, assets, options, rounds, folder):
    """Markdown: bold where the scene calls for the effect."""
    columns = {}
    for name, file, more in SCENES:
        columns[name] = measure_scene(kiln, os.path.join(assets, file), options + more, rounds, folder)
    effects = list(dict.fromkeys(e for found in columns.values() for e in found))
    lines = ["| effect | " + " | ".join(columns) + " |", "| --- |" + " --- |" * len(columns)]
    for effect in effects:
        lines.append("| `%s` | " % effect + " | ".join(cell(found.get(effect)) for found in columns.values()) + " |")
    return "\n".join(lines) + "\n"
