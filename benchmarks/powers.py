"""Exponents of growth: time = overhead + factor x amount^exponent, fitted to logarithms."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import OptimizeWarning, curve_fit

from lightproof import statistics
from ratios import over_rounds
from rows import Estimate, Row

FEWEST = 4  # amounts that tell an overhead from an exponent


@dataclass(frozen=True)
class Power:
    """The fitted curve, and its exponent with an interval."""

    overhead: float
    factor: float
    exponent: Estimate

    def __call__(self, amount: np.ndarray) -> np.ndarray:
        """Time at an amount [s]."""
        return self.overhead + self.factor * np.asarray(amount, float) ** self.exponent.value


def fitted(rows: Sequence[Row]) -> Power | None:
    """The curve through the medians of rows of one method and parameter, its interval over rounds; None below two amounts."""
    rows = [row for row in sorted(rows, key=lambda row: row.value) if row.each]
    if len(rows) < 2:
        return None
    amounts, rounds = np.array([row.value for row in rows]), min(len(row.each) for row in rows)
    each = np.array([row.each[:rounds] for row in rows])
    overhead, factor, _ = _fit(amounts, np.median(each, axis=1))
    return Power(overhead, factor, over_rounds(rounds, lambda chosen: _fit(amounts, np.median(each[:, chosen], axis=1))[2]))


def _fit(amounts: np.ndarray, times: np.ndarray) -> tuple[float, float, float]:
    """Overhead, factor and exponent; without an overhead where there are too few amounts to see it."""
    slope = statistics.slope(amounts, times)[0]
    factor = float(np.exp(np.log(times).mean() - slope * np.log(amounts).mean()))
    if len(amounts) < FEWEST:
        return 0.0, factor, slope
    start = np.log(times[0] / 2), np.log(times[-1]) - np.log(amounts[-1]), 1.0
    try:
        with warnings.catch_warnings(action="ignore", category=OptimizeWarning):  # of no covariance, which nobody asks for
            found, _ = curve_fit(_logarithm, np.log(amounts), np.log(times), p0=start, maxfev=2000)
    except RuntimeError:
        return 0.0, factor, slope
    return float(np.exp(found[0])), float(np.exp(found[1])), float(found[2])


def _logarithm(amount: np.ndarray, overhead: float, factor: float, exponent: float) -> np.ndarray:
    return np.logaddexp(overhead, factor + exponent * amount)
