"""The results as Markdown and JSON."""
import json

from scenes import SCENES

OURS = "kiln"


def best_peer(rows, kind):
    """The most efficient of the others; None."""
    others = [r for r in rows if r["renderer"] != OURS and r[kind]]
    return max(others, key=lambda r: r[kind].value(), default=None)


def ratio(rows, kind):
    """kiln's efficiency over the best peer's, and that peer's name; (None, None)."""
    ours = next((r[kind] for r in rows if r["renderer"] == OURS), None)
    best = best_peer(rows, kind)
    return (ours.over(best[kind]), best["renderer"]) if ours and best else (None, None)


def figures(number):
    """Three significant digits."""
    return f"{number:.3g}" if number < 1000 else f"{number:.0f}"


def with_interval(estimate):
    if estimate is None:
        return "-"
    low, high = estimate.interval()
    return figures(estimate.value()) + (f" ({figures(low)} to {figures(high)})" if high < float("inf") else "")


def describe_scene(result):
    """Lines of one scene."""
    name, rows = result["scene"], result["rows"]
    lines = [f"## {name}: {SCENES[name][0]}", "",
             "| renderer | M samples/s | s | relMSE | worst 0.1 % | efficiency, trimmed | efficiency, full |",
             "| --- | --- | --- | --- | --- | --- | --- |"]
    for r in rows:
        cells = [r["renderer"], figures(r["samples_per_second"] / 1e6), figures(r["seconds"]), figures(r["relmse"]),
                 f"{100 * r['worst_share']:.0f} %", with_interval(r["efficiency_trimmed"]),
                 with_interval(r["efficiency"])]
        lines.append(f"| {' | '.join(cells)} |")
    lines.append("")
    if result["replay"]:
        speed = figures(result["replay"]["samples_per_second"] / 1e6)
        lines.append(f"kiln runs at {100 * result['replay']['render_share']:.0f} % of the replay of its rays "
                     f"({speed} M samples/s).")
    for family, a in result["references_against_kiln"].items():
        lines.append(f"Reference of {family} beside kiln's: mean luminance × {a['luminance']:.4f}, median difference "
                     f"of pixels {100 * a['median_difference']:.1f} %.")
    lines += [f"References, from left to right ({', '.join(result['pictures'])}): ![{name}]({name}.png)", ""]
    return lines


def describe_ratios(results):
    lines = ["| scene | best peer | kiln / best peer, trimmed | full | samples/s over Mitsuba's |",
             "| --- | --- | --- | --- | --- |"]
    for result in results:
        rows = result["rows"]
        trimmed, peer = ratio(rows, "efficiency_trimmed")
        full, _ = ratio(rows, "efficiency")
        rates = {r["renderer"]: r["samples_per_second"] for r in rows}
        mitsuba = max((rate for name, rate in rates.items() if name.startswith("mitsuba")), default=None)
        speed = figures(rates[OURS] / mitsuba) if mitsuba and OURS in rates else "-"
        lines.append(f"| {result['scene']} {SCENES[result['scene']][0]} | {peer or '-'} | {with_interval(trimmed)} | "
                     f"{with_interval(full)} | {speed} |")
    return lines


def markdown(machine, results):
    spp = {result["spp"] for result in results}
    versions = sorted({r["version"] for result in results for r in result["rows"]})
    lines = ["# Benchmarks", "",
             f"{machine['cpu']}, {machine['threads']} threads; {', '.join(versions)}. "
             f"{', '.join(map(str, sorted(spp)))} samples per pixel; seconds are of sampling alone. Each renderer is "
             "measured against its own reference. Efficiency is 1/(relMSE · s), trimmed without the worst 0.1 % of the "
             "pixels, with 95 % intervals over the seeds.", "", *describe_ratios(results), ""]
    for result in results:
        lines += describe_scene(result)
    return "\n".join(lines)


def plain(value):
    """Estimates as numbers."""
    if hasattr(value, "interval"):
        low, high = value.interval()
        return {"value": value.value(), "low": low, "high": high if high < float("inf") else None}
    if isinstance(value, dict):
        return {k: plain(v) for k, v in value.items()}
    return [plain(v) for v in value] if isinstance(value, list) else value


def write(folder, machine, results):
    ratios = {result["scene"]: {kind: ratio(result["rows"], kind)[0] for kind in ("efficiency_trimmed", "efficiency")}
              for result in results}
    text = markdown(machine, results)
    (folder / "bench.md").write_text(text)
    (folder / "bench.json").write_text(json.dumps(plain({"machine": machine, "ratios": ratios, "scenes": results}),
                                                  indent=1))
    return text
