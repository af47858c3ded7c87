"""Ratios of what was measured in the same rounds, with intervals."""

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
    rounds = min(len(above), len(below))
    if not rounds:
        return Estimate(np.nan)
    a, b = np.array(above[:rounds]), np.array(below[:rounds])
    return over_rounds(rounds, lambda chosen: np.median(a[chosen]) / np.median(b[chosen]))
