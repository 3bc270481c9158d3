#!/usr/bin/env python3
"""Writes tests/color/views_table.c: what OpenColorIO's own ACES config makes of some colours.

    pip install opencolorio numpy             (2.6.0; in an environment of its own)
    tools/dump_views.py > tests/color/views_table.c
"""
import random

import numpy
import PyOpenColorIO as ocio

CONFIG = "cg-config-v2.2.0_aces-v1.3_ocio-v2.4"
ACES = "ACES 1.0 - SDR Video"
VIEWS = [("sRGB", "sRGB - Display", ACES), ("Rec.1886", "Rec.1886 Rec.709 - Display", ACES),
         ("Display P3", "Display P3 - Display", ACES), ("sRGB", "sRGB - Display", "Un-tone-mapped"),
         ("Display P3", "Display P3 - Display", "Un-tone-mapped")]


def colours():
    yield from ([x] * 3 for x in (0, 1e-4, 0.001, 0.0031308, 0.01, 0.05, 0.18, 0.5, 0.9, 1, 2, 5, 16, 100, 1000))
    for scale in (0.02, 0.18, 1, 8):
        for k in range(1, 7):
            yield [scale * (k >> c & 1) for c in range(3)]
    rng = random.Random(31)
    for _ in range(16):
        yield [2 ** rng.uniform(-9, 6) for _ in range(3)]
    yield from ([-0.1, 0.4, 0.2], [0.5, -0.02, 0.01], [-1, -1, -1], [-0.3, 2, -0.3])


def literal(x):
    text = f"{x:.9g}"
    return text + ("f" if set(".e") & set(text) else ".0f")


def main():
    config = ocio.Config.CreateFromBuiltinConfig(CONFIG)
    source = numpy.array(list(colours()), dtype=numpy.float32)
    print(f"/* Written by tools/dump_views.py with OpenColorIO {ocio.GetVersion()}: {CONFIG},")
    print(" * from linear Rec.709, without its faster mathematics, clamped to [0,1]. */")
    print('#include "tests/color/views_table.h"\n')
    print("const float views_colors[][3] = {")
    for r in source:
        print("    {" + ", ".join(literal(x) for x in r) + "},")
    print("};\nconst size_t views_color_count = sizeof views_colors / sizeof *views_colors;\n")
    print("const views_row views_rows[] = {")
    for display, theirs, view in VIEWS:
        processor = config.getProcessor("lin_rec709", theirs, view, ocio.TRANSFORM_DIR_FORWARD)
        cpu = processor.getOptimizedCPUProcessor(ocio.OPTIMIZATION_LOSSLESS)
        pixels = source.copy()
        cpu.applyRGB(pixels)
        pixels = pixels.clip(0, 1)
        print(f'    {{"{display}", "{view}", {{')
        for r in pixels:
            print("        {" + ", ".join(f"{x:.6f}f" for x in r) + "},")
        print("    }},")
    print("};\nconst size_t views_row_count = sizeof views_rows / sizeof *views_rows;")


if __name__ == "__main__":
    main()
