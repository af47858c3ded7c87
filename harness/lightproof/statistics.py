"""Statistics of films: arrays in, arrays out.

A film is a row (n,) of elements, row-major; replicates are stacked as (R, n) and have independent seeds.
"""

from __future__ import annotations

from itertools import combinations, pairwise
from math import ceil

import numpy as np
from scipy.special import stdtrit

TILES = 64


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
    rows, columns = tile_starts(grid, most)
    image = values.reshape(*values.shape[:-1], *grid)
    sums = np.add.reduceat(np.add.reduceat(image, rows, axis=-2), columns, axis=-1)
    counts = np.outer(np.diff(rows, append=grid[0]), np.diff(columns, append=grid[1]))
    return (sums / counts).reshape(*values.shape[:-1], -1)


def repeats(films: np.ndarray) -> bool:
    """Whether some, but not all, of the films (R, n) are the same bit for bit, and not by chance.

    Noise with few values, such as counts of hits at a few points, makes two films equal by chance. Taking elements as
    independent, the chance that two films agree is the product over elements of how often distinct films agree there.
    """
    distinct = np.unique(films, axis=0)
    if len(distinct) in (1, len(films)):
        return False
    pairs = len(distinct) * (len(distinct) - 1) / 2
    agreeing = sum((first == second).astype(int) for first, second in combinations(distinct, 2))
    chance = np.exp(np.log(np.maximum(agreeing, 0.5) / pairs).sum())
    return bool(chance * len(films) * (len(films) - 1) / 2 < 1e-3)


def variance_per_sample(films: np.ndarray, samples: float) -> tuple[float, float]:
    """Variance of one sample, pooled over the elements of replicates (R, n) [unit squared], and the standard error of its
    logarithm, by the delete-one jackknife over replicates (Efron 1982), for which elements may depend on one another.

    NaN for fewer than three replicates; the variance of films without noise is 0 and the error of its logarithm NaN.
    """
    replicates = len(films)
    if replicates < 3:
        return np.nan, np.nan
    squares = ((films - films.mean(axis=0)) ** 2).mean(axis=1)
    variance = squares.sum() / (replicates - 1) * samples
    without_one = squares.sum() - squares * replicates / (replicates - 1)
    if not np.ptp(films, axis=0).any() or (without_one <= 0).any():
        return (float(variance) if np.ptp(films, axis=0).any() else 0.0), np.nan
    logs = np.log(without_one)
    return float(variance), float(np.sqrt((replicates - 1) * logs.var()))


def variance_ratio(films: np.ndarray, samples: float, baseline: np.ndarray, baseline_samples: float,
                   level: float = 0.001) -> tuple[float, float, float]:
    """Variance per sample of replicates (R, n) over that of `baseline`, and the interval that holds the true ratio but for
    a chance of `level`; NaN where either set has fewer than three replicates or no noise."""
    variance, error = variance_per_sample(films, samples)
    accepted, accepted_error = variance_per_sample(baseline, baseline_samples)
    return ratio_interval((variance, error), (accepted, accepted_error), len(films) + len(baseline) - 2, level)


def ratio_interval(measured: tuple[float, float], accepted: tuple[float, float], degrees: int,
                   level: float = 0.001) -> tuple[float, float, float]:
    """Ratio of two values, each given with the standard error of its logarithm, and its interval by Student's t."""
    if not measured[0] > 0 or not accepted[0] > 0:
        return np.nan, np.nan, np.nan
    ratio = measured[0] / accepted[0]
    spread = float(np.exp(-stdtrit(degrees, level / 2) * np.hypot(measured[1], accepted[1])))
    return ratio, ratio / spread, ratio * spread


def slope(samples: np.ndarray, rmse: np.ndarray, level: float = 0.05) -> tuple[float, float, float]:
    """d log(rmse) / d log(samples) by least squares, and its interval at 1 - `level`: -1/2 for plain Monte Carlo.

    Steps without error are left out. NaN for fewer than two steps; with two, only the interval is NaN.
    """
    known = np.asarray(rmse) > 0
    x, y = np.log(np.asarray(samples, float)[known]), np.log(np.asarray(rmse, float)[known])
    x, y = x - x.mean() if x.size else x, y - y.mean() if y.size else y
    if x.size < 2 or not x.any():
        return np.nan, np.nan, np.nan
    fitted = float(x @ y / (x @ x))
    if x.size == 2:
        return fitted, np.nan, np.nan
    residual = ((y - fitted * x) ** 2).sum() / (x.size - 2)
    half = -stdtrit(x.size - 2, level / 2) * np.sqrt(residual / (x @ x))
    return fitted, fitted - half, fitted + half


def seconds_to(error: float, seconds: np.ndarray, rmse: np.ndarray) -> float | None:
    """Seconds at which the error first falls to `error`, interpolated on log axes between steps given in order of samples.

    None where no step measured is that good; the first step's seconds, an upper bound, where it already is.
    """
    if len(rmse) and rmse[0] <= error:
        return float(seconds[0])
    for (time, before), (later, after) in pairwise(zip(seconds, rmse, strict=True)):
        if before > error >= after:
            return float(_log_interpolated(error, before, after, time, later))
    return None


def _log_interpolated(error: float, before: float, after: float, time: float, later: float) -> float:
    if after == 0:
        return later
    share = np.log(before / error) / np.log(before / after)
    return time * (later / time) ** share
