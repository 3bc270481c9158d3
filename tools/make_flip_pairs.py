#!/usr/bin/env python3
"""Pairs of pictures with their FLIP errors by the authors' own evaluator: tests/data/compare.

    pip install flip-evaluator numpy pillow OpenImageIO
    tools/make_flip_pairs.py tests/data/compare

Pictures are small and made here, so that anybody can make them anew: a blurred edge, noise on a ramp, hues, dots and
lines, unlike pictures, and two scene-linear ones with values from 0.001 to 100. flip.json has, for each pair, the mean of
the error map and the errors of some pixels.
"""
import json
import os
import sys

import flip_evaluator
import numpy as np
import OpenImageIO as oiio
from PIL import Image

WIDTH, HEIGHT = 41, 29
PIXELS = [(0, 0), (20, 14), (40, 28), (10, 5), (33, 20), (5, 27)]
y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
random = np.random.default_rng(7)


def grey(values):
    return np.repeat(values[..., None], 3, axis=2)


def displayed():
    """Pairs reference, picture of sRGB values."""
    ramp = np.stack([x / WIDTH, y / HEIGHT, 0.5 + 0 * x], axis=2)
    edge = grey((x > 20) * 0.8 + 0.1)
    soft = grey(0.5 + 0.4 * np.tanh((x - 20.5) / 2))
    hue = 2 * np.pi * x / WIDTH
    hues = np.stack([0.5 + 0.3 * np.cos(hue), 0.5 - 0.15 * np.cos(hue), 0.5 + 0.4 * np.sin(hue)], axis=2)
    dots = grey(((x % 7 == 3) & (y % 5 == 2)) * 0.7 + (y == 15) * 0.3)
    yield "edge", edge, soft
    yield "noise", ramp, ramp + random.normal(0, 0.08, ramp.shape)
    yield "hues", hues, hues[:, ::-1]
    yield "dots", dots, 0 * dots
    yield "unlike", grey(0 * x + 0.0), np.stack([x % 2, y % 2, (x + y) % 2], axis=2) * 1.0


def linear():
    """The same, scene-linear."""
    light = 0.02 + 10 * np.exp(-((x - 12) ** 2 + (y - 9) ** 2) / 8.0)
    scene = np.stack([light, 0.8 * light + 0.3 * x / WIDTH, 0.6 * light + 0.001], axis=2)
    lamp = scene + grey(100.0 * ((x == 30) & (y == 20)))
    yield "noise_linear", scene, scene * random.gamma(6, 1 / 6, scene.shape)
    yield "lamp_linear", lamp, scene


def write_exr(path, values):
    out = oiio.ImageOutput.create(path)
    out.open(path, oiio.ImageSpec(WIDTH, HEIGHT, 3, "float"))
    out.write_image(np.ascontiguousarray(values, dtype=np.float32))
    out.close()


def main(folder):
    rows = []
    for name, reference, picture in displayed():
        codes = [np.round(np.clip(v, 0, 1) * 255).astype(np.uint8) for v in (reference, picture)]
        for suffix, v in zip(("a", "b"), codes):
            Image.fromarray(v).save(os.path.join(folder, "%s_%s.png" % (name, suffix)), optimize=True)
        rows.append((name, ".png", [v.astype(np.float32) / 255 for v in codes], "LDR"))
    for name, reference, picture in linear():
        values = [v.astype(np.float32) for v in (reference, picture)]
        for suffix, v in zip(("a", "b"), values):
            write_exr(os.path.join(folder, "%s_%s.exr" % (name, suffix)), v)
        rows.append((name, ".exr", values, "HDR"))
    pairs = []
    for name, suffix, (reference, picture), kind in rows:
        error, mean, _ = flip_evaluator.evaluate(reference, picture, kind, applyMagma=False)
        error = error.reshape(HEIGHT, WIDTH)
        pairs.append({"reference": name + "_a" + suffix, "picture": name + "_b" + suffix, "mean": round(float(mean), 6),
                      "pixels": [[px, py, round(float(error[py, px]), 6)] for px, py in PIXELS]})
    with open(os.path.join(folder, "flip.json"), "w") as f:
        f.write('{"evaluator": "flip-evaluator 1.7", "pairs": [\n')
        f.write(",\n".join(json.dumps(pair) for pair in pairs) + "\n]}\n")


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    main(sys.argv[1])
