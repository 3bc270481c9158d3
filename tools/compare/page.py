"""Tables and pictures of docs/compare-materials.md from what compare.py rendered. Prose is in prose.py."""
import json
import re

import numpy as np
from PIL import Image

import exact
import prose
import scene

PEERS = ("mitsuba", "cycles")
NAMES = {"kiln": "kiln", "mitsuba": "Mitsuba", "cycles": "Cycles"}
STUDENT = 3.182  # 95 % two-sided, of four seeds
ENOUGH = 0.02


class Measured:
    """Mean RGB over the sphere, and half of its confidence interval, relative to the mean."""

    def __init__(self, runs):
        means = runs[:, scene.inside()].astype(float).mean(1)
        self.mean = means.mean(0)
        self.interval = STUDENT * means.std(0, ddof=1) / np.sqrt(len(means)) / self.mean
        self.picture = runs.mean(0)


class Known:
    """A mean without noise."""

    def __init__(self, mean):
        self.mean, self.interval = mean, np.zeros(3)


def load(folder, case, environment):
    measured = {}
    for renderer in NAMES:
        path = folder / f"{case['id']}.{environment}.{renderer}.npy"
        if path.exists():
            measured[renderer] = Measured(np.load(path))
    return measured


def against(ours, other, expected):
    """The ratio of the channel that is furthest from what is expected, that expectation, and the ratio's interval."""
    ratio = ours.mean / other.mean
    channel = np.argmax(np.abs(np.log(ratio / expected)))
    interval = np.hypot(ours.interval, other.interval)[channel]
    return ratio[channel], expected[channel], interval


def note_for(grid, peer, case, environment, ratio):
    """The number of the first explanation in prose.NOTES that speaks of this difference and covers its size."""
    for number, (grids, peers, pattern, low, high, _) in enumerate(prose.NOTES, 1):
        if grid in grids and peer in peers and re.search(pattern, f"{case}.{environment}") and low <= ratio <= high:
            return number
    return None


def judge(grid, peer, case, environment, found):
    ratio, expected, interval = found
    if abs(ratio / expected - 1) <= max(ENOUGH, interval):
        return "same" if abs(expected - 1) < 0.005 else "as computed"
    number = note_for(grid, peer, case, environment, ratio)
    return f"note {number}" if number else "**unexplained**"


def formulas(folder, case, environment):
    """What exact.py says of each renderer, kept beside the pictures."""
    if not case["exact"]:
        return {}
    path = folder / f"{case['id']}.{environment}.exact.json"
    if not path.exists():
        means = {r: exact.mean(case["exact"], r, environment) for r in NAMES}
        path.write_text(json.dumps({r: list(m) for r, m in means.items() if m is not None}))
    return {r: np.array(m) for r, m in json.loads(path.read_text()).items()}


def row(grid, case, environment, measured, formula, tally):
    ours = measured["kiln"]
    cells = [case["label"], environment, "{:.4f} ± {:.1%}".format(ours.mean.mean(), ours.interval.max())]
    reference = formula.get("kiln")
    if reference is not None:
        found = against(ours, Known(reference), np.ones(3))
        verdict = judge(grid, "formula", case["id"], environment, found)
        tally[verdict] = tally.get(verdict, 0) + 1
        cells.append(f"{found[0]:.4f} {'' if verdict == 'same' else verdict}".strip())
    else:
        cells.append("")
    for peer in PEERS:
        if peer not in measured:
            cells += [""]
            continue
        theirs = formula.get(peer)
        expected = reference / theirs if reference is not None and theirs is not None else np.ones(3)
        found = against(ours, measured[peer], expected)
        verdict = judge(grid, peer, case["id"], environment, found)
        tally[verdict] = tally.get(verdict, 0) + 1
        computed = f", computed {found[1]:.4f}" if abs(found[1] - 1) >= 0.005 else ""
        cells.append(f"{found[0]:.4f} ± {found[2]:.1%}{computed}: {verdict}")
    return "| " + " | ".join(cells) + " |"


def shown(picture):
    linear = np.clip(picture * 0.7, 0, 1)
    return np.where(linear < 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def sheet(grid, folder, target):
    """Columns are the cases under 'boxes'; rows kiln, each peer, and grey plus twice the difference from each peer."""
    found = [load(folder, case, "boxes") for case in grid["cases"]]
    peers = [p for p in PEERS if any(p in f for f in found)]
    blank = np.full((scene.SIZE, scene.SIZE, 3), 1.0)
    rows = [[shown(f[r].picture) if r in f else blank for f in found] for r in ("kiln", *peers)]
    rows += [[np.clip(0.5 + 2 * (f["kiln"].picture - f[p].picture), 0,
        1) if p in f else blank for f in found] for p in peers]
    pixels = np.concatenate([np.concatenate(r, 1) for r in rows], 0)
    target.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray((pixels * 255 + 0.5).astype(np.uint8)).save(target, quality=85)
    return ["kiln", *(NAMES[p] for p in peers), *(f"difference from {NAMES[p]}" for p in peers)]


def write(grids, folder, docs, assets):
    tally, body = {}, []
    for grid in grids:
        rows = sheet(grid, folder, docs / f"images/compare/{grid['id']}.webp")
        body += [f"## {grid['title']}", "", prose.ABOUT[grid["id"]].strip(), "",
                 f"![{grid['title']}](images/compare/{grid['id']}.webp)", "",
                 f"Rows: {', '.join(rows)}. Columns as in the table.", "",
                 "| case | light | kiln | kiln/formula | kiln/Mitsuba | kiln/Cycles |",
                     "| --- | --- | --- | --- | --- | --- |"]
        for case in grid["cases"]:
            for environment in scene.ENVIRONMENTS:
                measured = load(folder, case, environment)
                if "kiln" in measured:
                    body.append(row(grid["id"], case, environment, measured, formulas(folder, case, environment),
                        tally))
        body.append("")
    counted = ", ".join(f"{verdict}: {count}" for verdict, count in sorted(tally.items()))
    notes = [f"{number}. {note[-1]}" for number, note in enumerate(prose.NOTES, 1)]
    page = [prose.HEAD.strip(), "", f"Verdicts: {counted}.", "", *body, "## Notes", "", *notes, "", *assets]
    (docs / "compare-materials.md").write_text("\n".join(page).rstrip() + "\n")
    return counted
