"""Errors, efficiencies and their intervals, of pictures as flat sequences of numbers. Python's own library alone."""
import math
import statistics

EPSILON = 0.01  # of relMSE's denominator
TRIM = 0.001    # the worst pixels that the trimmed error leaves out
# 97.5 % of Student's distribution by degrees of freedom; beyond, a normal one.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
           2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042)


def student(degrees):
    return STUDENT[degrees - 1] if degrees <= len(STUDENT) else 1.96


class Reference:
    """The mean of independent renders, and the variance of that mean, value by value."""

    def __init__(self, total=None, squares=None, count=0):
        self.total, self.squares, self.count = total, squares, count

    def add(self, picture):
        if self.total is None:
            self.total, self.squares = [0.0] * len(picture), [0.0] * len(picture)
        self.total = [a + x for a, x in zip(self.total, picture)]
        self.squares = [a + x * x for a, x in zip(self.squares, picture)]
        self.count += 1

    def mean(self):
        return [a / self.count for a in self.total]

    def variance(self):
        n = self.count
        return [max(q / n - (a / n) ** 2, 0.0) / (n - 1) for a, q in zip(self.total, self.squares)]


def by_pixel(values):
    """Means over three channels."""
    return [(values[i] + values[i + 1] + values[i + 2]) / 3 for i in range(0, len(values), 3)]


class Judge:
    """Compares pictures with a reference, whose own noise is taken off."""

    def __init__(self, reference):
        self.mean = reference.mean()
        self.weight = [1 / (m * m + EPSILON) for m in self.mean]
        self.noise = by_pixel([v * w for v, w in zip(reference.variance(), self.weight)])

    def relmse(self, picture):
        """(without the worst pixels, of all, share of the error that those have)"""
        raw = by_pixel([(x - m) ** 2 * w for x, m, w in zip(picture, self.mean, self.weight)])
        left = [r - n for r, n in zip(raw, self.noise)]
        worst = sorted(range(len(raw)), key=raw.__getitem__)[-max(1, round(len(raw) * TRIM)):]
        full = sum(left)
        tail = sum(left[i] for i in worst)
        return (full - tail) / (len(raw) - len(worst)), full / len(raw), tail / full if full > 0 else 0.0

    def relative_noise(self):
        """relMSE of the reference itself."""
        return sum(self.noise) / len(self.noise)


class Estimate:
    """A positive quantity as a logarithm with a standard error: products and quotients keep an interval."""

    def __init__(self, log, error, degrees):
        self.log, self.error, self.degrees = log, error, degrees

    @classmethod
    def of(cls, samples):
        """The mean of independent measurements; the error of its logarithm to first order."""
        mean, n = statistics.fmean(samples), len(samples)
        if not mean > 0:
            return None
        error = statistics.stdev(samples) / math.sqrt(n) / mean if n > 1 else math.inf
        return cls(math.log(mean), error, max(n - 1, 1))

    def over(self, other):
        return Estimate(self.log - other.log, math.hypot(self.error, other.error), min(self.degrees, other.degrees))

    def value(self):
        return math.exp(self.log)

    def interval(self):
        """95 %; (0, inf) of a single measurement."""
        reach = student(self.degrees) * self.error
        return (math.exp(self.log - reach), math.exp(self.log + reach)) if math.isfinite(reach) else (0.0, math.inf)


ONE = Estimate(0.0, 0.0, 10**9)


def efficiency(errors, seconds):
    """1/(error · time), both measured for each seed; None where the error is lost in the reference's noise."""
    error, time = Estimate.of(errors), Estimate.of(seconds)
    return ONE.over(error).over(time) if error and time else None


def sampling_seconds(whole, one, spp):
    """Time of all samples alone: what a render with one sample costs besides is its preparation."""
    return max(whole - one, 1e-9) * spp / (spp - 1) if spp > 1 else whole
