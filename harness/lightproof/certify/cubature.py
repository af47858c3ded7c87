"""Estimates of integrals over the square [-1, 1]^2 of functions with kinks, by halving squares in both directions.

Each square's rule is compared with that of its four quarters. Where they differ by too much the quarters are squares of their
own, the others count with their quarters; what the accepted ones differ by, added up, is the estimate's uncertainty.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

Array = np.ndarray
NODES, WEIGHTS = np.polynomial.legendre.leggauss(4)
LEAST, DEPTH = 2, 16  # times that squares are quartered
MOST = 20_000  # points at a time
QUARTERS = np.array([(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)])


def integral(f: Callable[[Array, Array], Array], goal: float) -> tuple[float, float]:
    """The integral of f(s, t), arrays (n,), and its uncertainty, which is aimed at `goal`."""
    centres, half = np.zeros((1, 2)), 1.0
    wholes = _rules(f, centres, half)
    total = uncertainty = 0.0
    for level in range(DEPTH):
        quarters = (centres[:, None] + half * QUARTERS).reshape(-1, 2)
        half /= 2
        parts = _rules(f, quarters, half)
        sums = parts.reshape(-1, 4).sum(-1)
        error = np.abs(sums - wholes)
        rough = ((error > goal * half) | (level < LEAST)) & (level < DEPTH - 1)
        total, uncertainty = total + sums[~rough].sum(), uncertainty + error[~rough].sum()
        centres, wholes = quarters[np.repeat(rough, 4)], parts[np.repeat(rough, 4)]
    return float(total), float(uncertainty)


def _rules(f: Callable[[Array, Array], Array], centres: Array, half: float) -> Array:
    """Integrals over squares of half a side `half`, by the rule for each."""
    s, t = (half * axis.ravel() for axis in np.meshgrid(NODES, NODES, indexing="ij"))
    share = half**2 * np.outer(WEIGHTS, WEIGHTS).ravel()
    count = MOST // len(s)
    blocks = [centres[i:i + count] for i in range(0, len(centres), count)]
    values = [f((block[:, :1] + s).ravel(), (block[:, 1:] + t).ravel()).reshape(len(block), -1) @ share for block in blocks]
    return np.concatenate(values) if values else np.zeros(0)
