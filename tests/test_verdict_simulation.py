"""What the verdict promises, by simulation: a suite of 1,600 verdicts on correct renderers holds a fail in fewer than 1 of
1,000 suites, and twice the tolerance is never passed, whether noise is Gaussian, skewed or sparse.

Noise here is that of a tile's pooled value in one replicate: a sum of `amount` draws, four times as many at each step. How
large it is beside the tolerance is the scene's and the renderer's affair, so many widths are tried. Chances as small as 1
in 10 million come as the product of two steps' chances, which are independent, each bounded from above by its count.

The promise has a limit, which one test measures: light that arrives in events so rare that the replicates see none.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from cells import LIGHT, SCENE, reference, results
from scipy.special import betaincinv

from lightproof import ladder, statistics, verdict
from lightproof.verdict import Outcome, Verdict

REPLICATES = 16
TOLERANCE = SCENE.tolerance
TRIALS, BLOCKS = 400_000, 4
WIDTHS = np.geomspace(0.1, 6.4, 7)  # standard errors of the first step in question, in tolerances
TILES, ELEMENTS = statistics.TILES + 1, 432  # intervals of the largest film of the suite
TILE = statistics.simultaneous_quantile(ladder.TILE_LEVEL, TILES, REPLICATES)
ELEMENT = statistics.simultaneous_quantile(ladder.ELEMENT_LEVEL, ELEMENTS, REPLICATES)


def one_sided(level: float, intervals: int) -> float:
    """a'/2, a' = 1 - (1 - level)^(1/intervals)."""
    return (1 - (1 - level) ** (1 / intervals)) / 2


Noise = Callable[[np.random.Generator, tuple[int, ...], float], np.ndarray]


def gaussian(rng: np.random.Generator, shape: tuple[int, ...], amount: float) -> np.ndarray:
    return rng.standard_normal(shape)


def skewed(rng: np.random.Generator, shape: tuple[int, ...], amount: float) -> np.ndarray:
    """Sums of `amount` exponential draws, mean 0 and standard deviation 1: skewness 2 / sqrt(amount)."""
    return (rng.standard_gamma(amount, shape) - amount) / np.sqrt(amount)


def sparse(rng: np.random.Generator, shape: tuple[int, ...], amount: float) -> np.ndarray:
    """`amount` rare bright samples expected, all equally bright, mean 0 and standard deviation 1."""
    return (rng.poisson(amount, shape) - amount) / np.sqrt(amount)


NOISES = [pytest.param(noise, id=noise.__name__) for noise in (gaussian, skewed, sparse)]
FEWEST = 8  # draws in a tile and replicate at the first step: the promise is for these and more


@cache
def replicated(noise: Noise, amount: float) -> tuple[np.ndarray, np.ndarray]:
    """Mean and standard error (TRIALS,) of 16 replicates, in units of the true standard error."""
    rng = np.random.default_rng([1, int(16 * amount)])
    blocks = [noise(rng, (REPLICATES, TRIALS // BLOCKS), amount) * np.sqrt(REPLICATES) for _ in range(BLOCKS)]
    return np.concatenate([block.mean(axis=0) for block in blocks]), np.concatenate([*map(statistics.standard_error, blocks)])


def vote_chances(noise: Noise, amount: float, width: float, quantile: float) -> np.ndarray:
    """Chances of an interval to vote dark and bright, (2,): their upper 99 % bounds (Clopper and Pearson 1934)."""
    mean, error = (values * width * TOLERANCE for values in replicated(noise, amount))
    half = quantile * error
    may = (error > 0) & (half <= ladder.WIDEST_VOTE * TOLERANCE)
    counts = np.array([np.count_nonzero(may & (mean + half < -TOLERANCE)),
                       np.count_nonzero(may & (mean - half > TOLERANCE))])
    return betaincinv(counts + 1, TRIALS - counts, 0.99)


def fail_chance(noise: Noise, width: float, quantile: float) -> float:
    """Chance of an interval to fail at any of three steps, the first with a standard error of `width` tolerances."""
    votes = [vote_chances(noise, FEWEST * 4**step, width / 2**step, quantile) for step in range(3)]
    return float(votes[0] @ votes[1] + votes[1] @ votes[2])


def suite_fail_chance(noise: Noise, width: float) -> float:
    """The same for any interval of 1,600 verdicts, all of them as unlucky."""
    return ladder.TRIPLES * (TILES * fail_chance(noise, width, TILE) + ELEMENTS * fail_chance(noise, width, ELEMENT))


def pass_chances(noise: Noise, amount: float, bias: float) -> np.ndarray:
    """Chance of a biased tile to look right at one step, for each of WIDTHS."""
    mean, error = (values * TOLERANCE for values in replicated(noise, amount))
    return np.array([np.mean(np.abs(width * mean + bias) + TILE * width * error <= TOLERANCE) for width in WIDTHS])


def ladder_verdict(noise: Noise, bias: float, seed: int) -> Verdict:
    """The verdict on five steps of 16 films, all elements off by `bias` tolerances, their noise 4 % of the scale at first."""
    rng, films = np.random.default_rng(seed), {}
    for step in range(5):
        errors = bias * TOLERANCE + 0.04 / 2**step * noise(rng, (REPLICATES, LIGHT.size), FEWEST * 4**step)
        films[64 * 4**step] = LIGHT + LIGHT.max() * errors
    return verdict.judge(results(films), reference(), SCENE)


@pytest.mark.parametrize("noise", NOISES)
def test_a_suite_of_correct_renderers_seldom_fails_one(noise):
    """No bias: fewer than 1 of 1,000 suites, whatever the noise is beside the tolerance."""
    assert max(suite_fail_chance(noise, width) for width in WIDTHS) < 1e-3


def test_a_suite_of_renderers_at_the_tolerance_seldom_fails_one():
    """Every tile and element off by exactly the tolerance, Gaussian noise: each votes with a chance of a'/2, as simulated, and
    fails at one of six pairs of steps with 6 (a'/2)^2: still fewer than 1 of 1,000 suites."""
    mean, error = (values * WIDTHS[0] * TOLERANCE for values in replicated(gaussian, FEWEST))
    tile, element = one_sided(ladder.TILE_LEVEL, TILES), one_sided(ladder.ELEMENT_LEVEL, ELEMENTS)
    assert np.mean(mean - TILE * error > 0) == pytest.approx(tile, abs=4 * np.sqrt(tile / TRIALS))
    assert ladder.TRIPLES * 6 * (TILES * tile**2 + ELEMENTS * element**2) < 1e-3


@pytest.mark.parametrize("noise", NOISES)
def test_twice_the_tolerance_never_passes(noise):
    """A tile too bright or too dark by twice the tolerance: not one of a million trials looks right, at any width."""
    for bias in (-2 * TOLERANCE, 2 * TOLERANCE):
        assert not pass_chances(noise, FEWEST, bias).any()


def test_the_tolerance_itself_passes_as_seldom_as_the_level_says():
    """A tile off by exactly the tolerance, Gaussian noise: where noise is small it looks right with a chance of a'/2."""
    chances = pass_chances(gaussian, FEWEST, TOLERANCE)
    level = one_sided(ladder.TILE_LEVEL, TILES)
    assert chances[0] == pytest.approx(level, abs=4 * np.sqrt(level / TRIALS))


def test_events_too_rare_to_be_seen_pass():
    """The limit: all of a tile's excess of twice the tolerance comes in events of which 4 are expected in 16 replicates. With
    a chance of exp(-4) there is none, and the tile looks right."""
    mean, error = replicated(sparse, 0.25)
    width = 2 / (np.sqrt(0.25) * 4)  # standard error in tolerances, that of an excess of 2 tolerances
    looks_right = np.abs(width * mean + 2) + TILE * width * error <= 1 + 1e-9
    assert looks_right.mean() == pytest.approx(np.exp(-4), rel=0.03)


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("bias, right, wrong", [(0, Outcome.PASS, Outcome.FAIL), (-2, Outcome.FAIL, Outcome.PASS),
                                                (2, Outcome.FAIL, Outcome.PASS)])
def test_whole_verdicts_keep_the_promise(noise, bias, right, wrong):
    """Ten ladders of five steps through the whole of judge: all end right, and no step is wrong."""
    for seed in range(10):
        found = ladder_verdict(noise, bias, seed)
        assert found.outcome is right
        assert wrong not in {step.outcome for step in found.steps}
