"use strict";
// Draws the charts and tables of a study from the JSON in this page. No libraries, no network.
const study = JSON.parse(document.getElementById("study-data").textContent);
const pictures = JSON.parse(document.getElementById("picture-data").textContent);
const at = id => document.getElementById(id);

// Colours of Okabe and Ito, which people tell apart who confuse red and green; shapes and dashes tell the same.
const colors = ["#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8c6d00", "#56b4e9", "#6a3d9a"];
const dashes = ["", "7 3", "2 3", "8 3 2 3", "12 4", "4 2", "1 4", "9 2 1 2"];
const shapes = [
  r => `M${- r},0a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${- 2 * r},0`,
  r => `M${- r},${- r}h${2 * r}v${2 * r}h${- 2 * r}z`,
  r => `M0,${- 1.3 * r}L${1.2 * r},${r}H${- 1.2 * r}z`,
  r => `M0,${- 1.4 * r}L${1.4 * r},0L0,${1.4 * r}L${- 1.4 * r},0z`,
  r => `M0,${1.3 * r}L${1.2 * r},${- r}H${- 1.2 * r}z`,
];
const style = i =>
    ({color: colors[i % colors.length], dash: dashes[i % dashes.length], shape: shapes[i % shapes.length]});

const known = v => typeof v === "number";
const digits = (v, n = 3) => !known(v)       ? "–" :
    v === 0                                  ? "0" :
    Math.abs(v) >= 1e5 || Math.abs(v) < 1e-4 ? v.toExponential(1) :
                                               String(Number(v.toPrecision(n)));
const percent = v => known(v) ? digits(100 * v) + " %" : "–";
const root = v => known(v) ? Math.sqrt(Math.max(v, 0)) : null;
const signedRoot = v => known(v) ? Math.sign(v) * Math.sqrt(Math.abs(v)) : null;
const between = (r, show = digits) => known(r.low) ? `${show(r.low)} to ${show(r.high)}` : "–";
const last = c => c.levels[c.levels.length - 1];
const label = name => name === "base" ? "as it is" : name.replaceAll("+", ", ").replaceAll("=", " ");
const base = study.configs[0];
const isBiased = c => c.biased === "yes" || c.biased === "by design";

function element(tag, attributes = {}, ...children) {
  const e = document.createElement(tag);
  for (const [k, v] of Object.entries(attributes)) e.setAttribute(k, v);
  e.append(...children);
  return e;
}
function shape(tag, attributes = {}, ...children) {
  const e = document.createElementNS(
      "http:" +
          "//www.w3.org/2000/svg",
      tag);
  for (const [k, v] of Object.entries(attributes)) e.setAttribute(k, v);
  e.append(...children);
  return e;
}
// Rows of cells; texts[i] says that column i is words.
function table(head, rows, caption, texts = []) {
  const cell = (tag, v, i) => element(tag, texts.includes(i) ? {class: "text"} : {}, v);
  const t = element(
      "table", {}, element("caption", {hidden: ""}, caption),
      element("thead", {}, element("tr", {}, ...head.map(h => element("th", {scope: "col"}, h)))));
  t.append(element("tbody", {}, ...rows.map(row => element("tr", {}, ...row.map((v, i) => cell("td", v, i))))));
  return t;
}

// 1, 2, 5 … that lie in an interval, or powers of ten where there are many.
function ticks(low, high) {
  const all = [];
  const few = Math.log10(high / low) < 2.5 ? [1, 2, 5] : [1];
  for (let e = Math.floor(Math.log10(low)); e <= Math.log10(high); e++)
    for (const m of few) {
      const v = m * 10 ** e;
      if (v >= low * 0.999 && v <= high * 1.001) all.push(v);
    }
  return all;
}
// "0.05": without the rounding errors of powers of ten.
const tick = v => String(Number(v.toPrecision(6)));

function axes(svg, box, x, y, names) {
  for (const v of ticks(...x.range)) {
    svg.append(
        shape("line", {class: "grid", x1: x(v), x2: x(v), y1: box.top, y2: box.bottom}),
        shape("text", {x: x(v), y: box.bottom + 16, "text-anchor": "middle", class: "soft"}, tick(v)));
  }
  for (const v of ticks(...y.range)) {
    svg.append(
        shape("line", {class: "grid", y1: y(v), y2: y(v), x1: box.left, x2: box.right}),
        shape("text", {x: box.left - 6, y: y(v) + 4, "text-anchor": "end", class: "soft"}, tick(v)));
  }
  svg.append(
      shape("text", {x: box.right, y: box.bottom + 34, "text-anchor": "end"}, names[0]),
      shape("text", {x: box.left - 40, y: box.top - 10}, names[1]));
}
function scale(low, high, from, to) {
  const f = v => from + (to - from) * Math.log(v / low) / Math.log(high / low);
  f.range = [low, high];
  return f;
}

// What a configuration has for the curve: seconds, error and its interval in per cent.
function points(c) {
  return c.levels
      .map(l => ({
             spp: l.spp,
             x: l.seconds.mean,
             y: 100 * root(l.relmse.mean),
             low: 100 * root(l.relmse.low),
             high: 100 * root(l.relmse.high)
           }))
      .filter(p => known(p.x) && p.x > 0 && p.y > 0);
}
const onFront = (c, spp) => study.pareto.some(p => p.config === c.name && p.spp === spp);

function drawSeries(svg, c, i, x, y, floor) {
  const s = style(i), p = points(c), inside = v => Math.max(v || floor, floor);
  if (!p.length) return;
  const band = p.map(q => `${x(q.x)},${y(q.high || q.y)}`)
                   .concat([...p].reverse().map(q => `${x(q.x)},${y(inside(q.low))}`))
                   .join(" ");
  svg.append(shape("polygon", {points: band, fill: s.color, opacity: 0.09}));
  svg.append(shape("polyline", {
    points: p.map(q => `${x(q.x)},${y(q.y)}`).join(" "),
    fill: "none",
    stroke: s.color,
    "stroke-width": c === base ? 2.5 : 1.8,
    "stroke-dasharray": s.dash
  }));
  for (const q of p) {
    svg.append(shape("line", {x1: x(q.x), x2: x(q.x), y1: y(inside(q.low)), y2: y(q.high || q.y), stroke: s.color}));
    if (onFront(c, q.spp))
      svg.append(shape("circle", {cx: x(q.x), cy: y(q.y), r: 9, fill: "none", stroke: "#000", "stroke-width": 1.2}));
    svg.append(shape(
        "path", {
          d: s.shape(4.5),
          fill: isBiased(c) ? "#fff" : s.color,
          stroke: s.color,
          "stroke-width": 1.5,
          transform: `translate(${x(q.x)} ${y(q.y)})`
        },
        shape("title", {}, `${label(c.name)}, ${q.spp} samples: ${digits(q.y)} % in ${digits(q.x)} s`)));
  }
}

function drawKey(svg, chosen, width, from) {
  const columns = width > 560 ? 2 : 1, step = (width - 10) / columns;
  chosen.forEach((c, i) => {
    const s = style(i), left = 4 + (i % columns) * step, row = from + 20 * Math.floor(i / columns);
    svg.append(
        shape("line", {
          x1: left,
          x2: left + 34,
          y1: row,
          y2: row,
          stroke: s.color,
          "stroke-width": 2,
          "stroke-dasharray": s.dash
        }),
        shape("path", {
          d: s.shape(4.5),
          fill: isBiased(c) ? "#fff" : s.color,
          stroke: s.color,
          "stroke-width": 1.5,
          transform: `translate(${left + 17} ${row})`
        }));
    const slope = known(c.slope.mean) ? `, slope ${c.slope.mean.toFixed(2)}` : "";
    const note = isBiased(c) ? ", biased (hollow)" : "";
    svg.append(shape("text", {x: left + 42, y: row + 4}, label(c.name) + slope + note));
  });
  return 20 * Math.ceil(chosen.length / columns);
}

const options = [...new Set(study.configs.map(c => c.option).filter(o => o && o !== "effects"))];
const chosenBy = option =>
    study.configs.filter(c => c === base || (option === "*" ? !c.other_picture : c.option === option));

function drawCurve() {
  const chosen = chosenBy(at("curve-option").value), all = chosen.flatMap(points);
  at("curve").replaceChildren();
  if (!all.length) return;
  const width = Math.max(at("curve").clientWidth, 280), plot = Math.min(Math.max(width * 0.55, 240), 420);
  const rows = Math.ceil(chosen.length / (width > 560 ? 2 : 1)), height = plot + 60 + 20 * rows;
  const box = {left: 48, right: width - 12, top: 26, bottom: plot};
  const low = Math.min(...all.map(p => p.y)), high = Math.max(...all.map(p => p.high || p.y), ...all.map(p => p.y));
  const times = all.map(p => p.x), x = scale(Math.min(...times) / 1.3, Math.max(...times) * 1.3, box.left, box.right);
  const y = scale(low / 1.6, high * 1.2, box.bottom, box.top);
  const summary = chosen
                      .map(c => {
                        const p = points(c).at(-1);
                        return p ? `${label(c.name)} ${digits(p.y)} % after ${digits(p.x)} s` : "";
                      })
                      .filter(Boolean)
                      .join("; ");
  const svg = shape("svg", {
    viewBox: `0 0 ${width} ${height}`,
    role: "img",
    "aria-label": "Error over time. At the most samples: " + summary
  });
  axes(svg, box, x, y, ["seconds of rendering", "error in %"]);
  chosen.forEach((c, i) => drawSeries(svg, c, i, x, y, low / 1.6));
  drawKey(svg, chosen, width, plot + 58);
  at("curve").append(svg);
  const lines = chosen.flatMap(
      c => c.levels.map(
          l =>
              [label(c.name), String(l.spp), digits(l.seconds.mean), percent(root(l.relmse.mean)),
               between({low: root(l.relmse.low), high: root(l.relmse.high)}, percent),
               percent(root(l.relmse_trimmed.mean)), percent(root(l.relmse_predicted.mean)),
               onFront(c, l.spp) ? "yes" : ""]));
  at("curve-table")
      .replaceChildren(table(
          [
            "setting", "samples", "seconds", "error", "95 % interval", "without worst 0.1 %", "as predicted",
            "unbeaten"
          ],
          lines, "Error and time of each setting"));
}

function drawEfficiency() {
  const chosen = study.configs.filter(c => !c.other_picture && known(c.efficiency.over_base.mean));
  at("efficiency").replaceChildren();
  if (!chosen.length) return;
  const width = Math.max(at("efficiency").clientWidth, 280), names = width > 560 ? 230 : 0, row = names ? 24 : 38;
  const ends =
      chosen.flatMap(c => [c.efficiency.over_base.low, c.efficiency.over_base.high, c.efficiency.over_base.mean])
          .filter(v => known(v) && v > 0);
  const x = scale(
      Math.max(Math.min(...ends, 1) / 1.1, 1e-3), Math.min(Math.max(...ends, 1) * 1.1, 1e3), names + 8, width - 12);
  const clip = v => x(Math.min(Math.max(v, x.range[0]), x.range[1]));
  const height = chosen.length * row + 42,
        svg = shape("svg", {
          viewBox: `0 0 ${width} ${height}`,
          role: "img",
          "aria-label": "Efficiency over the base's: " +
              chosen.map(c => `${label(c.name)} ${digits(c.efficiency.over_base.mean)}`).join("; ")
        });
  for (const v of ticks(...x.range))
    svg.append(
        shape("line", {class: "grid", x1: x(v), x2: x(v), y1: 6, y2: height - 36}),
        shape("text", {x: x(v), y: height - 20, "text-anchor": "middle", class: "soft"}, tick(v)));
  svg.append(shape("line", {x1: x(1), x2: x(1), y1: 6, y2: height - 36, stroke: "#000", "stroke-dasharray": "4 3"}));
  chosen.forEach((c, i) => {
    const r = c.efficiency.over_base, mid = 18 + i * row + (names ? 0 : 12);
    svg.append(shape(
        "text", {x: names ? names : 4, y: names ? mid + 4 : mid - 12, "text-anchor": names ? "end" : "start"},
        label(c.name) + (isBiased(c) ? " (biased)" : "")));
    if (known(r.low))
      svg.append(
          shape("line", {x1: clip(r.low), x2: clip(r.high), y1: mid, y2: mid, stroke: "#0072b2", "stroke-width": 2}));
    svg.append(shape("path", {
      d: shapes[0](5),
      fill: isBiased(c) ? "#fff" : "#0072b2",
      stroke: "#0072b2",
      "stroke-width": 1.5,
      transform: `translate(${clip(r.mean)} ${mid})`
    }));
  });
  svg.append(shape("text", {x: width - 12, y: height - 4, "text-anchor": "end"}, "efficiency, base = 1"));
  at("efficiency").append(svg);
}

function fillEfficiencyTable() {
  const rows = study.configs.filter(c => !c.other_picture)
                   .map(
                       c =>
                           [label(c.name), String(last(c).spp), digits(last(c).seconds.mean),
                            percent(root(last(c).relmse.mean)), digits(c.efficiency.value.mean),
                            between(c.efficiency.value), digits(c.efficiency.over_base.mean),
                            between(c.efficiency.over_base), digits(c.efficiency_trimmed.over_base.mean), c.biased]);
  at("efficiency-table")
      .replaceChildren(table(
          [
            "setting", "samples", "seconds", "error", "1/(relMSE·s)", "95 % interval", "over base", "95 % interval",
            "trimmed", "biased"
          ],
          rows, "Efficiency of each setting", [9]));
}

function fillTables() {
  at("seen-table")
      .replaceChildren(table(
          ["setting", "samples", "FLIP", "95 % interval", "fireflies", "mean |x − r|"],
          study.configs.map(
              c =>
                  [label(c.name), String(last(c).spp), digits(last(c).flip.mean), between(last(c).flip),
                   digits(last(c).fireflies.mean), digits(last(c).mae.mean)]),
          "FLIP and fireflies"));
  at("bias-table")
      .replaceChildren(table(
          ["setting", "bias", "95 % interval", "light", "95 % interval", "lost by depth limit", "verdict"],
          study.configs.filter(c => !c.other_picture).map(c => {
            const l = last(c), b = l.bias_squared;
            return [
              label(c.name), percent(signedRoot(b.mean)),
              between({low: signedRoot(b.low), high: signedRoot(b.high)}, percent), percent(l.light.mean),
              between(l.light, percent), percent(l.lost_energy.mean), c.biased
            ];
          }),
          "Bias of each setting", [6]));
  const effects = study.configs.filter(c => c.other_picture);
  at("effects-section").hidden = !effects.length;
  at("effects-table")
      .replaceChildren(table(
          ["without", "time over base", "saves", "picture differs by", "light"], effects.map(c => {
            const ratio = last(c).seconds.mean / last(base).seconds.mean;
            return [
              c.name.replace("effects=-", ""), digits(ratio), percent(1 - ratio),
              percent(signedRoot(last(c).bias_squared.mean)), percent(last(c).light.mean)
            ];
          }),
          "Price of each effect"));
}

function drawStages() {
  const entries = Object.entries(base.stages).sort((a, b) => b[1] - a[1]),
        sum = entries.reduce((s, e) => s + e[1], 0);
  const shown = entries.filter(e => e[1] > 0.01 * sum);
  const width = Math.max(at("stages").clientWidth, 280), names = 110, height = shown.length * 22 + 8;
  const longest = shown.length ? shown[0][1] : 1;
  const svg = shape("svg", {
    viewBox: `0 0 ${width} ${height}`,
    role: "img",
    "aria-label":
        "Time by stage of the base: " + shown.map(e => `${e[0]} ${Math.round(100 * e[1] / sum)} %`).join(", ")
  });
  shown.forEach(([name, seconds], i) => {
    const length = (width - names - 70) * seconds / longest;
    svg.append(
        shape("text", {x: names - 8, y: 22 * i + 16, "text-anchor": "end"}, name),
        shape("rect", {x: names, y: 22 * i + 4, width: length, height: 16, fill: "#0072b2"}),
        shape("text", {x: names + length + 6, y: 22 * i + 16}, `${Math.round(100 * seconds / sum)} %`));
  });
  at("stages").replaceChildren(svg);
  const all = [...new Set(study.configs.flatMap(c => Object.keys(c.stages)))];
  at("stages-table")
      .replaceChildren(table(
          ["seconds of threads", ...all],
          study.configs.map(c => [label(c.name), ...all.map(s => known(c.stages[s]) ? digits(c.stages[s]) : "")]),
          "Time by stage"));
}

function fillPictures() {
  const entries = [];
  for (const [name, p] of Object.entries(pictures)) {
    if (p.picture) entries.push([label(name === "reference" ? "the reference" : name), p.picture]);
    if (p.error) entries.push([label(name) + ": errors", p.error]);
  }
  for (const side of ["left", "right"]) {
    at(side).append(...entries.map(([name], i) => element("option", {value: i}, name)));
    at(side).addEventListener("change", showPictures);
  }
  if (!entries.length) {
    at("slider").hidden = true;
    return;
  }
  at("right").value = entries.findIndex(e => e[1] === pictures.reference.picture);
  at("split").addEventListener("input", showPictures);
  document.querySelector(".stack").addEventListener("pointermove", e => {
    if (!e.buttons && e.pointerType === "mouse") return;
    const r = e.currentTarget.getBoundingClientRect();
    at("split").value = 100 * (e.clientX - r.left) / r.width;
    showPictures();
  });
  function showPictures() {
    const split = at("split").value, left = entries[at("left").value], right = entries[at("right").value];
    at("left-image").src = left[1];
    at("right-image").src = right[1];
    at("left-image").alt = "Left of the divider: " + left[0];
    at("right-image").alt = "Right of the divider: " + right[0];
    at("left-image").style.clipPath = `inset(0 ${100 - split}% 0 0)`;
    at("divider").style.left = split + "%";
    at("slider-text").textContent = `Left: ${left[0]}. Right: ${right[0]}.`;
  }
  showPictures();
  const end = percent(study.picture.map_end);
  at("maps").before(element(
      "p", {}, "Error maps: the root of the relative error of each pixel, from black, none, to pale, ",
      `${end} and more. `, element("span", {class: "ramp", role: "img", "aria-label": `scale from 0 to ${end}`})));
  for (const c of study.configs) {
    const p = pictures[c.name];
    if (!p || !p.error) continue;
    at("maps").append(element(
        "figure", {}, element("img", {
          src: p.error,
          loading: "lazy",
          alt: `Errors of ${label(c.name)}, ${percent(root(last(c).relmse.mean))} in all`
        }),
        element(
            "figcaption", {}, `${label(c.name)}, ${last(c).spp} samples: ${percent(root(last(c).relmse.mean))}`)));
  }
}

function fillFacts() {
  const r = study.reference, p = study.picture, m = study.machine;
  at("facts").textContent = `${study.preset} preset, ${study.configs.length} configurations, ${study.renders} of ` +
      `${study.renders_planned} renders, ${p.width} × ${p.height} pixels` +
      (study.complete ? "" :
                        " (not complete: the same " +
               "command goes on)");
  const reference = r.file ? `The reference is ${r.file}, whose own noise is unknown and counts as error.` :
                             `The reference is ${r.samples_per_pixel} samples a pixel by the estimator ${
                                 r.estimator}, from ${r.independent_renders} ` +
          `independent renders with seeds of their own; its error, ${
                                 percent(root(r.relmse))}, is taken off what is measured.`;
  const settings = Object.entries(study.options).map(([k, v]) => `--${k} ${v}`).join(" ");
  const lines = [
    reference,
    `Every setting was rendered with ${study.seeds} seeds, in turns, so that what else the machine does ` +
        "meets all alike. Intervals are 95 %, by Student's distribution over the seeds; they do not hold what no seed " +
        "has met.",
    `Time: ${study.clock}; of rendering alone, without import and building.`,
    `Machine: ${m.cpu}, ${m.threads} threads, kernels ${m.isa}. kiln ${study.versions.kiln}, Embree ${
        study.versions.Embree}.`,
    `View: ${p.view}; camera ${p.camera}. Settings as they are: ${settings || "the defaults"}.`,
    "rows.csv beside this file has every render, study.json what is shown here."
  ];
  at("how").append(...lines.map(l => element("p", {}, l)));
}

at("curve-option")
    .append(
        ...options.map(o => element("option", {value: o}, o)),
        ...(options.length > 1 ? [element("option", {value: "*"}, "all")] : []));
if (!options.length) at("curve-option").append(element("option", {value: "*"}, "all"));
at("curve-option").addEventListener("change", drawCurve);
function drawAll() {
  drawCurve();
  drawEfficiency();
  drawStages();
}
fillFacts();
fillEfficiencyTable();
fillTables();
fillPictures();
drawAll();
let width = innerWidth;
addEventListener("resize", () => {
  if (innerWidth !== width) {
    width = innerWidth;
    drawAll();
  }
});
