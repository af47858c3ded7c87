"""Statistics of films: arrays in, arrays out.

A film is a row (n,) of elements, row-major; replicates are stacked as (R, n) and have independent seeds.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, pairwise
from math import ceil, comb

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import pdtrc, stdtrit

TILES = 64
CHANCE = 1e-6  # below which equal films are no coincidence
ROUNDING = 1e-6  # of a value: two that differ by no more may be one sum, added up in another order


def simultaneous_quantile(level: float, intervals: int, replicates: int) -> float:
    """Student's t quantile that makes `intervals` two-sided intervals from `replicates` values all hold but for a chance of
    `level` (Sidak 1967): t with R - 1 degrees of freedom at 1 - a/2, a = 1 - (1 - level)^(1/intervals)."""
    each = -np.expm1(np.log1p(-level) / intervals)
    return float(-stdtrit(replicates - 1, each / 2))


def standard_error(values: np.ndarray) -> np.ndarray:
    """Standard error (n,) of the mean of replicates (R, n); exactly 0 where all are equal, NaN for a single one."""
    if len(values) < 2:
        return np.full(values.shape[1:], np.nan)
    return (values - values[0]).std(axis=0, ddof=1) / np.sqrt(len(values))


def tile_starts(grid: tuple[int, int], most: int = TILES) -> tuple[np.ndarray, np.ndarray]:
    """First row and first column of each row and column of tiles: the smallest near-square blocks of a (rows, columns) grid
    of which there are at most `most`."""
    side = 1
    while ceil(grid[0] / side) * ceil(grid[1] / side) > most:
        side += 1
    rows, columns = (np.arange(ceil(length / side)) * length // ceil(length / side) for length in grid)
    return rows, columns


def tile_means(values: np.ndarray, grid: tuple[int, int], most: int = TILES) -> np.ndarray:
    """Means (..., J) over the tiles of films (..., n), tiles row-major. A grid's elements have equal areas."""
    return _over_tiles(values, grid, most, np.add)


def tile_shares(values: np.ndarray, grid: tuple[int, int], most: int = TILES) -> np.ndarray:
    """The most that any one element adds to the mean over its tile (..., J), of films (..., n)."""
    return _over_tiles(values, grid, most, np.maximum)


def _over_tiles(values: np.ndarray, grid: tuple[int, int], most: int, gather: np.ufunc) -> np.ndarray:
    rows, columns = tile_starts(grid, most)
    image = values.reshape(*values.shape[:-1], *grid)
    gathered = gather.reduceat(gather.reduceat(image, rows, axis=-2), columns, axis=-1)
    counts = np.outer(np.diff(rows, append=grid[0]), np.diff(columns, append=grid[1]))
    return (gathered / counts).reshape(*values.shape[:-1], -1)


def repeats(films: np.ndarray) -> bool:
    """Whether some, but not all, of the films (R, n) are the same bit for bit, and more of them than chance explains.

    Noise with few values, such as counts of hits at a few points, makes films equal by chance: two of them with the
    product over elements, taken as independent, of how often distinct films agree there, but for rounding. The number of
    chance repeats is nearly Poisson. Black films say nothing: no sample has reached the light.
    """
    films = films[films.any(axis=1)]
    distinct = np.unique(films, axis=0)
    if len(distinct) in (1, len(films)):
        return False
    agreeing = sum(np.isclose(first, second, ROUNDING, atol=0).astype(int) for first, second in combinations(distinct, 2))
    chance = np.exp(np.log(np.maximum(agreeing, 0.5) / comb(len(distinct), 2)).sum())
    return bool(pdtrc(len(films) - len(distinct) - 1, chance * comb(len(films), 2)) < CHANCE)


def variance_per_sample(films: np.ndarray, samples: float) -> tuple[float, float]:
    """Variance of one sample, pooled over the elements of replicates (R, n) [unit squared], and the standard error of its
    logarithm, by the delete-one jackknife over replicates (Efron 1982), for which elements may depend on one another.

    NaN for fewer than three replicates; the error is infinite where all the variance hangs on one replicate or there is none.
    """
    replicates = len(films)
    if replicates < 3:
        return np.nan, np.nan
    deviations = films - films[0]
    squares = ((deviations - deviations.mean(axis=0)) ** 2).mean(axis=1)
    total = squares.sum()
    without_one = total - squares * replicates / (replicates - 1)
    variance = float(total / (replicates - 1) * samples)
    if without_one.min() <= 1e-9 * total:
        return variance, np.inf
    return variance, float(np.sqrt((replicates - 1) * np.log(without_one).var()))


def variance_ratio(films: np.ndarray, samples: float, baseline: np.ndarray, baseline_samples: float,
                   level: float = 0.001) -> tuple[float, float, float]:
    """Variance per sample of replicates (R, n) over that of `baseline` (R', n), and its interval; see `ratio_interval`."""
    measured, accepted = variance_per_sample(films, samples), variance_per_sample(baseline, baseline_samples)
    return ratio_interval(measured, accepted, len(films) + len(baseline) - 2, level)


def ratio_interval(measured: tuple[float, float], accepted: tuple[float, float], degrees: int,
                   level: float = 0.001) -> tuple[float, float, float]:
    """Ratio of two values, each given with the standard error of its logarithm, and the interval that holds the true ratio
    but for a chance of `level`, by Student's t with so many `degrees` of freedom. NaN unless both are positive."""
    if not (measured[0] > 0 and accepted[0] > 0):
        return np.nan, np.nan, np.nan
    ratio = measured[0] / accepted[0]
    spread = np.exp(min(-stdtrit(degrees, level / 2) * np.hypot(measured[1], accepted[1]), 700))
    return ratio, float(ratio / spread), float(ratio * spread)


def slope(samples: ArrayLike, rmse: ArrayLike, level: float = 0.05) -> tuple[float, float, float]:
    """d log(rmse) / d log(samples) by least squares, and its interval at 1 - `level`: -1/2 for plain Monte Carlo.

    Steps without error are left out. NaN for fewer than two steps; with two, only the interval is NaN.
    """
    samples, rmse = np.asarray(samples, float), np.asarray(rmse, float)
    x, y = np.log(samples[rmse > 0]), np.log(rmse[rmse > 0])
    if len(x) < 2:
        return np.nan, np.nan, np.nan
    x, y = x - x.mean(), y - y.mean()
    fitted = float(x @ y / (x @ x))
    if len(x) == 2:
        return fitted, np.nan, np.nan
    error = np.sqrt(((y - fitted * x) ** 2).sum() / (len(x) - 2) / (x @ x))
    half = float(-stdtrit(len(x) - 2, level / 2) * error)
    return fitted, fitted - half, fitted + half


def seconds_to(error: float, seconds: Sequence[float], rmse: Sequence[float]) -> float | None:
    """Seconds at which the error first falls to `error`, interpolated on log axes between steps given in order of samples.

    None where no step measured is that good; the first step's seconds, an upper bound, where that one already is. No step
    counts as slower than a later one.
    """
    steps = list(zip(np.minimum.accumulate(np.array(seconds, float)[::-1])[::-1], rmse, strict=True))
    if steps and steps[0][1] <= error:
        return float(steps[0][0])
    for (time, before), (later, after) in pairwise(steps):
        if before > error >= after:
            share = np.log(before / error) / np.log(before / after) if after > 0 else 1.0
            return float(time * (later / time) ** share)
    return None
