"""Ratios and differences of what was measured in the same rounds, with intervals."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.stats import bootstrap

from rows import LEVEL, Estimate

RESAMPLES = 299
SEED = 1


def over_rounds(rounds: int, statistic: Callable[[np.ndarray], float]) -> Estimate:
    """A statistic of the rounds with these indices, over all of them once, and its interval over rounds drawn anew (the
    percentile bootstrap, Efron 1982). What was measured in one round stays together, so that slow rounds cancel."""
    every = np.arange(rounds)
    value = float(statistic(every))
    if rounds < 2 or not np.isfinite(value):
        return Estimate(value)
    found = bootstrap((every,), lambda chosen: statistic(chosen.astype(int)), vectorized=False, n_resamples=RESAMPLES,
                      confidence_level=LEVEL, method="percentile", rng=np.random.default_rng(SEED))
    return Estimate(value, *map(float, found.confidence_interval))


def ratio(above: Sequence[float], below: Sequence[float]) -> Estimate:
    """Median over median of two quantities measured in the same rounds; the rounds that only one of them has are left out."""
    return _compared(np.divide, above, below)


def difference(more: Sequence[float], less: Sequence[float]) -> Estimate:
    """Median less median of two quantities measured in the same rounds, likewise."""
    return _compared(np.subtract, more, less)


def _compared(how: Callable[[float, float], float], first: Sequence[float], second: Sequence[float]) -> Estimate:
    rounds = min(len(first), len(second))
    if not rounds:
        return Estimate(np.nan)
    a, b = np.array(first[:rounds]), np.array(second[:rounds])
    return over_rounds(rounds, lambda chosen: how(np.median(a[chosen]), np.median(b[chosen])))
