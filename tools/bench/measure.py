"""Renders one scene with every renderer in turn, seed by seed, and judges the pictures."""
import itertools
import statistics

import errors
import pictures
from runners import Failed

FIRST_SEED = 1000


def open_all(runners, path, say):
    """Those that can load the scene."""
    opened = []
    for runner in runners:
        try:
            runner.open(path)
            runner.render(1, 1)
            opened.append(runner)
        except Failed as failure:
            say(f"{path.stem}: {failure}")
    return opened


def time_runs(runners, spp, seeds, say):
    """{runner name: [(picture, what it took)]}, interleaved, and {name: [what one sample took]}. The first round makes
    kernels and warms caches, and is not kept."""
    runs, single = {r.name: [] for r in runners}, {r.name: [] for r in runners}
    for seed, runner in itertools.product(range(-1, seeds), runners):
        run, one = runner.render(spp, FIRST_SEED + seed), runner.render(1, FIRST_SEED + seed)
        if seed >= 0:
            runs[runner.name].append(run)
            single[runner.name].append(one[1])
            say(f"  seed {seed + 1} of {seeds}: {runner.name} {run[1]['seconds']:.2f} s")
    return runs, single


def row_of(runner, judge, runs, single, spp, pixels, clock, threads):
    share = threads if clock == "cpu_seconds" else 1
    one = min(s[clock] for s in single) / share
    seconds = [errors.sampling_seconds(took[clock] / share, one, spp) for _, took in runs]
    judged = [judge.relmse(picture) for picture, _ in runs]
    mean = statistics.fmean(seconds)
    return {"renderer": runner.name, "version": runner.version, "seeds": len(runs), "seconds": mean,
            "seconds_of_seeds": seconds, "fixed_seconds": max(one - mean / spp, 0.0),
            "samples_per_second": pixels * spp / mean, "peak": max(took["peak"] for _, took in runs),
            "relmse_trimmed": statistics.fmean(j[0] for j in judged), "relmse": statistics.fmean(j[1] for j in judged),
            "worst_share": statistics.fmean(j[2] for j in judged), "reference_relmse": judge.relative_noise(),
            "efficiency_trimmed": errors.efficiency([j[0] for j in judged], seconds),
            "efficiency": errors.efficiency([j[1] for j in judged], seconds)}


def agreement(references, ours):
    """Mean luminances of the others' references over ours, and the median difference of pixels."""
    out = {}
    for family, reference in references.items():
        if family == ours or ours not in references:
            continue
        a, b = references[ours].mean(), reference.mean()
        difference = [abs(x - y) for x, y in zip(errors.by_pixel(a), errors.by_pixel(b))]
        level = [x + errors.EPSILON for x in errors.by_pixel(a)]
        out[family] = {"luminance": pictures.luminance(b) / pictures.luminance(a),
                       "median_difference": statistics.median(d / l for d, l in zip(difference, level))}
    return out


def measure(name, path, settings, runners, arguments, store, say):
    """One scene's part of the results."""
    opened = open_all(runners, path, say)
    try:
        pixels = settings["width"] * settings["height"]
        references = {}
        for runner in opened:
            if runner.family not in references:
                references[runner.family] = store.get(runner, name, path, settings)
        judges = {family: errors.Judge(reference) for family, reference in references.items()}
        runs, single = time_runs(opened, arguments.spp, arguments.seeds, say)
        rows = [row_of(r, judges[r.family], runs[r.name], single[r.name], arguments.spp, pixels, arguments.clock,
                       arguments.threads) for r in opened]
        pictures.write_png(arguments.folder / f"{name}.png", [reference.mean() for reference in references.values()],
                           settings["width"], settings["height"])
        kiln = next((r for r in opened if r.family == "kiln"), None)
        return {"scene": name, "settings": settings, "spp": arguments.spp, "rows": rows,
                "pictures": list(references), "references_against_kiln": agreement(references, "kiln"),
                "replay": kiln.replay_share(arguments.spp) if kiln else None}
    finally:
        for runner in opened:
            runner.close()
