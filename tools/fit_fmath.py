#!/usr/bin/env python3
"""Fits the polynomials of base/fmath.h and prints their coefficients.

Each row is a minimax fit by Remez's exchange: the largest weighted error |w(z) (f(z) - p(z))| on [0, b] or [a, b] is as
small as the degree allows. Coefficients are rounded to the format they are stored in one at a time, lowest power
first, and the remaining ones are fitted again to what is left, so that a rounded coefficient's error is made good by
the later ones. The header's own evaluation rounds too; tests/base/test_fmath.c measures the total in ulp.

Needs mpmath:  python3 -m pip install mpmath && python3 tools/fit_fmath.py
"""

import struct

from mpmath import asin, atan, cos, exp, log, lu_solve, matrix, mp, mpf, pi, sin, sqrt

mp.prec = 200
LN2 = log(mpf(2))


def to_single(x):
    return mpf(struct.unpack("f", struct.pack("f", float(x)))[0])


def to_double(x):
    return mpf(float(x))


def chebyshev_nodes(a, b, count):
    """Shifted a little, for a middle of exactly 0 would divide by it."""
    return [(a + b) / 2 - (b - a) / 2 * cos(pi * (i + mpf("0.501")) / count) for i in range(count)]


def remez(f, weight, degree, a, b):
    """Coefficients of the polynomial, lowest power first."""
    count = degree + 2
    nodes = chebyshev_nodes(a, b, count)
    grid = chebyshev_nodes(a, b, 60 * count)
    target = [(z, f(z), weight(z)) for z in grid]
    best = None
    for _ in range(30):
        rows = matrix(count, count)
        right = matrix(count, 1)
        for i, z in enumerate(nodes):
            for power in range(degree + 1):
                rows[i, power] = z ** power
            rows[i, count - 1] = (-1) ** i / weight(z)
            right[i] = f(z)
        solution = lu_solve(rows, right)
        coefficients = [solution[j] for j in range(count - 1)]
        errors = [(w * (value - sum(c * z ** i for i, c in enumerate(coefficients))), z)
                  for z, value, w in target]
        # The extremum of every run of one sign is a node of the next round.
        extrema = [errors[0]]
        for error in errors[1:]:
            if (error[0] > 0) == (extrema[-1][0] > 0):
                if abs(error[0]) > abs(extrema[-1][0]):
                    extrema[-1] = error
            else:
                extrema.append(error)
        while len(extrema) > count:
            extrema.pop(0 if abs(extrema[0][0]) < abs(extrema[-1][0]) else -1)
        worst = max(abs(error) for error, _ in errors)
        if best is None or worst < best[0]:
            best = worst, coefficients
        if len(extrema) < count:
            break
        nodes = [z for _, z in extrema]
    return best[1]


def fit(name, f, weight, degree, a, b, rounding=to_single):
    """p(z) = c0 + c1 z + … of the given degree, coefficients rounded one by one."""
    fixed = []
    for power in range(degree + 1):
        def rest(z):
            return (f(z) - sum(c * z ** i for i, c in enumerate(fixed))) / z ** power

        def rest_weight(z):
            return weight(z) * abs(z) ** power

        fixed.append(rounding(remez(rest, rest_weight, degree - power, a, b)[0]))
    worst = max(weight(z) * abs(f(z) - sum(c * z ** i for i, c in enumerate(fixed)))
                for z in chebyshev_nodes(a, b, 2000))
    digits = "%.9gf" if rounding is to_single else "%.17g"
    print("%-12s 2^%.1f  %s" % (name, float(log(worst) / LN2), ", ".join(digits % float(c) for c in fixed)))


def split(name, value, *bits):
    """value as a sum of parts of one sign, each of so many significant bits; the last in single precision."""
    parts = []
    for count in bits:
        left = value - sum(parts)
        scale = mpf(2) ** (count - 1 - mp.floor(log(abs(left)) / LN2))
        parts.append(mp.floor(left * scale) / scale)
    parts.append(to_single(value - sum(parts)))
    print("%-12s %s" % (name, " + ".join("%.9gf" % float(p) for p in parts)))


def main():
    tiny = mpf(10) ** -12
    octant = (pi / 4 * (1 + mpf(2) ** -20)) ** 2
    # sin x = x + x z p(z), cos x = 1 - z/2 + z^2 p(z), z = x^2, |x| <= pi/4
    fit("sin", lambda z: (sin(sqrt(z)) / sqrt(z) - 1) / z, lambda z: z * sqrt(z) / sin(sqrt(z)), 3, tiny, octant)
    fit("cos", lambda z: (cos(sqrt(z)) - 1 + z / 2) / z ** 2, lambda z: z ** 2 / cos(sqrt(z)), 2, tiny, octant)
    # sin 2 pi r = r (hi + lo + z p(z)), cos 2 pi r = 1 + z p(z), z = r^2, |r| <= 1/8
    turn = 2 * pi
    eighth = mpf(1) / 64
    fit("sin turn", lambda z: (sin(turn * sqrt(z)) / sqrt(z) - turn) / z,
        lambda z: z * sqrt(z) / sin(turn * sqrt(z)), 3, tiny, eighth)
    fit("cos turn", lambda z: (cos(turn * sqrt(z)) - 1) / z, lambda z: z / cos(turn * sqrt(z)), 3, tiny, eighth)
    # 2^f = 1 + f p(f), |f| <= 1/2;  e^r = 1 + r + r^2 p(r), |r| <= ln 2 / 2
    half = mpf(1) / 2 * (1 + mpf(2) ** -20)
    fit("exp2", lambda f: (2 ** f - 1) / f, lambda f: abs(f) / 2 ** f, 5, -half, half)
    fit("exp", lambda r: (exp(r) - 1 - r) / r ** 2, lambda r: r ** 2 / exp(r), 4, -half * LN2, half * LN2)
    # log(1 + f) = 2 s + s z p(z), s = f / (2 + f), z = s^2, 1 + f in [sqrt(1/2), sqrt(2)]
    s = (sqrt(mpf(2)) - 1) / (sqrt(mpf(2)) + 1) * (1 + mpf(2) ** -20)
    fit("log", lambda z: (2 * mp.atanh(sqrt(z)) / sqrt(z) - 2) / z, lambda z: z / 2, 3, tiny, s * s)
    # atan t = t + t z p(z), z = t^2, 0 <= t <= 1;  asin t = t + t z p(z), 0 <= t <= 1/2
    fit("atan", lambda z: (atan(sqrt(z)) / sqrt(z) - 1) / z, lambda z: z * sqrt(z) / atan(sqrt(z)), 8, tiny, mpf(1))
    fit("asin", lambda z: (asin(sqrt(z)) / sqrt(z) - 1) / z, lambda z: z * sqrt(z) / asin(sqrt(z)), 4, tiny,
        mpf(1) / 4)
    # Double precision, for pow: log2((1 + s)/(1 - s)) = s p(z);  2^f = p(f)
    fit("pow log2", lambda z: 2 * mp.atanh(sqrt(z)) / sqrt(z) / LN2, lambda z: LN2 / 2, 5, tiny, s * s, to_double)
    fit("pow exp2", lambda f: 2 ** f, lambda f: 2 ** -f, 6, -half, half, to_double)

    split("pi/2", pi / 2, 16, 16)
    split("ln 2", LN2, 12)
    split("log2 e", 1 / LN2)
    split("log2 e - 1", 1 / LN2 - 1)
    print("%-12s %.9gf + %.9gf" % ("pi", float(to_single(pi)), float(to_single(pi - to_single(pi)))))
    print("%-12s %.9gf + %.9gf" % ("2 pi", float(to_single(turn)), float(to_single(turn - to_single(turn)))))
    split("2 / pi", 2 / pi)


if __name__ == "__main__":
    main()
