"""From a kernel's sums to a film and its variance: in compiled code, for what arrays one after the other take is half of the time
of a small film. Infinities and what is no number stay what they are."""

from __future__ import annotations

import numpy as np

from lightproof.estimators.compiled import exact, exact_kernel

LARGEST = float(np.finfo(np.float32).max)


def variance_of_mean(total, square, samples):
    """Variance of the mean of `samples` values, two or more, from the sums of them and of their squares: numbers or arrays."""
    return np.maximum(square - total * total / samples, 0) / ((samples - 1) * samples)


variance = exact(variance_of_mean)


@exact_kernel
def moments(sums, samples, factor):
    """Mean (n,) of `samples` values times `factor`, and its variance (n,), 0 for one value, from `sums` (n, 3): of a pivot, of
    what values are beyond it, and of that squared. No value is below 0: what would be is rounding. Squares beyond float32:
    their sum is no less."""
    means, variances = np.empty(len(sums)), np.zeros(len(sums))
    for e in range(len(sums)):
        pivot, square = sums[e, 0], LARGEST if np.isinf(sums[e, 2]) else sums[e, 2]
        total = -pivot if sums[e, 1] < -pivot else sums[e, 1]
        means[e] = (factor * pivot + factor * total) / samples
        if samples > 1:
            variances[e] = variance(factor * total, factor * (factor * square), samples)
    return means, variances
