"""Quantiles, tiles, repeated streams, variances and slopes: arrays whose answers are known."""

from __future__ import annotations

import numpy as np
import pytest

from lightproof import statistics


def test_simultaneous_quantile_is_students_t():
    """One two-sided 95 % interval from 16 values: t = 2.131 with 15 degrees of freedom, as every table has it."""
    assert statistics.simultaneous_quantile(0.05, 1, 16) == pytest.approx(2.13145, abs=1e-5)


def test_simultaneous_intervals_all_hold_together():
    """Ten independent intervals from 4 Gaussian values each, at 5 % together: some interval misses in 5 % of 20,000 trials."""
    values = np.random.default_rng(1).standard_normal((4, 20_000, 10))
    half = statistics.simultaneous_quantile(0.05, 10, 4) * statistics.standard_error(values)
    missed = (np.abs(values.mean(axis=0)) > half).any(axis=1).mean()
    assert missed == pytest.approx(0.05, abs=4 * np.sqrt(0.05 * 0.95 / 20_000))


def test_simultaneous_quantile_keeps_its_digits_for_many_intervals():
    """For a small level Sidak's rule is Bonferroni's: 0.001 over 16 million is 0.001/16e6 alone."""
    many = statistics.simultaneous_quantile(0.001, 16_000_000, 16)
    assert many == pytest.approx(statistics.simultaneous_quantile(0.001 / 16e6, 1, 16), rel=1e-4)


def test_standard_error():
    """Values 1, 2, 3, 4: s = sqrt(5/3), over sqrt(4)."""
    assert statistics.standard_error(np.array([[1.0], [2], [3], [4]])) == pytest.approx(np.sqrt(5 / 3) / 2)


def test_standard_error_of_equal_values_is_exactly_zero():
    """Sixteen times 0.1: over several columns numpy rounds their mean to another number."""
    assert (statistics.standard_error(np.full((16, 3), 0.1)) == 0).all()


def test_standard_error_of_one_value_is_unknown():
    assert np.isnan(statistics.standard_error(np.ones((1, 3)))).all()


@pytest.mark.parametrize("grid, tiles", [((12, 16), 48), ((18, 24), 48), ((32, 32), 64), ((1, 5), 5), ((1, 200), 50), ((1, 1), 1),
                                         ((33, 33), 49), ((4096, 1), 64), ((8, 8), 64), ((9, 8), 20)])
def test_tiles_are_the_smallest_blocks_that_are_few_enough(grid, tiles):
    """Blocks of side 1, 2, 3 ... until at most 64 cover the grid; their sides differ by at most one."""
    rows, columns = statistics.tile_starts(grid)
    assert len(rows) * len(columns) == tiles
    for starts, length in zip((rows, columns), grid, strict=True):
        assert np.ptp(np.diff(starts, append=length)) <= 1


def test_tile_means():
    """A 2 x 3 film in at most four tiles: two rows in one, columns {0} and {1, 2}."""
    film = np.array([1.0, 2, 3, 4, 5, 6])
    assert statistics.tile_means(film, (2, 3), most=2).tolist() == [2.5, 4]


def test_tile_means_agree_with_the_mean_of_the_film():
    """Tiles of 18 x 24 are equal blocks of 3 x 3, so their mean is the film's; each replicate is pooled alone."""
    films = np.random.default_rng(2).random((3, 18 * 24))
    tiles = statistics.tile_means(films, (18, 24))
    assert tiles.shape == (3, 48)
    assert tiles.mean(axis=1) == pytest.approx(films.mean(axis=1), rel=1e-12)
    assert tiles[1, 9] == pytest.approx(films[1].reshape(18, 24)[3:6, 3:6].mean(), rel=1e-12)


def test_a_repeated_film_is_noticed():
    """Sixteen noisy films of 12 elements, one of them twice."""
    films = np.random.default_rng(3).random((16, 12))
    assert not statistics.repeats(films)
    films[11] = films[2]
    assert statistics.repeats(films)


def test_two_streams_in_turn_are_noticed():
    """Sixteen films of which every second one is the same."""
    assert statistics.repeats(np.tile(np.random.default_rng(4).random((2, 12)), (8, 1)))


def test_all_films_alike_are_no_repeat():
    assert not statistics.repeats(np.full((16, 12), 0.3))


def test_films_alike_by_chance_are_no_repeat():
    """Counts of hits, from rare to many, at 5 points and at 192: of 16 films several are equal by chance in many trials."""
    rng = np.random.default_rng(5)
    counts = [rng.poisson(expected, (16, size)).astype(float)
              for size in (5, 192) for expected in (0.003, 0.03, 0.3, 3) for _ in range(50)]
    assert sum(1 < len(np.unique(films, axis=0)) < 16 for films in counts) > 150
    assert not any(statistics.repeats(films) for films in counts)


def test_one_light_added_up_in_different_orders_is_no_repeat():
    """16 films of a light without noise whose elements differ in the last digit of float32 at most: some are equal."""
    rng = np.random.default_rng(7)
    sums = [np.float32(1.66), np.nextafter(np.float32(1.66), np.float32(2))]
    films = np.array([np.where(np.arange(192) < 24 * rng.integers(8), *sums) for _ in range(16)], float)
    assert 1 < len(np.unique(films, axis=0)) < 16
    assert not statistics.repeats(films)


def test_variance_per_sample():
    """16 films of 400 elements at 64 samples with variance 9/64 each: 9 a sample; its logarithm known to sqrt(2/(15 x 400))."""
    films = 3 / 8 * np.random.default_rng(6).standard_normal((16, 400))
    variance, log_error = statistics.variance_per_sample(films, 64)
    assert variance == pytest.approx(films.var(axis=0, ddof=1).mean() * 64)
    assert variance == pytest.approx(9, rel=4 * np.sqrt(2 / 6000))
    assert log_error == pytest.approx(np.sqrt(2 / 6000), rel=0.6)


def test_variance_that_hangs_on_one_film_has_no_known_error():
    films = np.full((16, 3), 0.1)
    assert statistics.variance_per_sample(films, 64) == (0, np.inf)
    films[4, 1] = 7
    assert statistics.variance_per_sample(films, 64)[1] == np.inf
    assert np.isnan(statistics.variance_per_sample(films[:2], 64)).all()


@pytest.mark.parametrize("noise", [lambda rng, shape: rng.standard_normal(shape), lambda rng, shape: rng.exponential(size=shape)])
def test_variance_ratio_holds_the_truth(noise):
    """Two sets of 16 films of 50 elements that share a common error, the second with twice the variance per sample at four
    times the samples: the 95 % interval misses the ratio 1/2 in about 5 % of 600 trials, and seldom in more than 8 %."""
    rng = np.random.default_rng(7)
    missed = 0
    for _ in range(600):
        films, baseline = (noise(rng, (16, 50)) + noise(rng, (16, 1)) for _ in range(2))
        _, low, high = statistics.variance_ratio(films, 64, baseline / np.sqrt(2), 256, level=0.05)
        missed += not low < 0.5 < high
    assert 600 * 0.02 < missed < 600 * 0.085


def test_variance_ratio_notices_twice_the_variance():
    """16 films of 192 elements against the same with half the variance, at 99.9 %."""
    rng = np.random.default_rng(8)
    films, baseline = rng.standard_normal((2, 16, 192))
    ratio, low, high = statistics.variance_ratio(films, 64, baseline / np.sqrt(2), 64)
    assert 1.5 < low < 2 < high < 2.7
    assert ratio == pytest.approx(np.sqrt(low * high))


def test_variance_ratio_without_noise_is_unknown():
    assert np.isnan(statistics.variance_ratio(np.ones((4, 3)), 64, np.ones((4, 3)), 64)).all()


def test_slope_of_a_power_law():
    """rmse = 3 N^-0.5 exactly."""
    samples = np.array([64, 256, 1024, 4096])
    assert statistics.slope(samples, 3 / np.sqrt(samples)) == pytest.approx((-0.5, -0.5, -0.5), abs=1e-12)


def test_slope_interval_holds_the_truth():
    """Five steps of N^-0.5 with Gaussian errors of the logarithm: the 95 % interval misses in 5 % of 2,000 trials."""
    rng = np.random.default_rng(9)
    samples = 64 * 4.0 ** np.arange(5)
    fits = [statistics.slope(samples, np.exp(0.1 * rng.standard_normal(5)) / np.sqrt(samples)) for _ in range(2000)]
    missed = np.mean([not low < -0.5 < high for _, low, high in fits])
    assert missed == pytest.approx(0.05, abs=4 * np.sqrt(0.05 * 0.95 / 2000))


def test_slope_of_few_steps():
    """Two steps give a slope without interval, one gives nothing; a step without error has no logarithm."""
    fitted, low, _ = statistics.slope([64, 256, 1024], [0.2, 0.1, 0])
    assert fitted == pytest.approx(-0.5)
    assert np.isnan(low)
    assert np.isnan(statistics.slope([64], [0.1])).all()


def test_seconds_to_an_error():
    """Errors 10 %, 1 % at 1 s, 100 s: 3.16 % lies half way on log axes, at 10 s; 0.1 % was not reached, 20 % at once."""
    assert statistics.seconds_to(0.1 / np.sqrt(10), [1, 100], [0.1, 0.01]) == pytest.approx(10)
    assert statistics.seconds_to(0.01, [1, 100], [0.1, 0.01]) == pytest.approx(100)
    assert statistics.seconds_to(0.001, [1, 100], [0.1, 0.01]) is None
    assert statistics.seconds_to(0.2, [1, 100], [0.1, 0.01]) == 1
    assert statistics.seconds_to(0.01, [], []) is None


def test_a_smaller_error_is_never_sooner():
    """A first step that the clock found slower than the second counts as the second."""
    assert statistics.seconds_to(0.01, [3, 1, 2], [0.005, 0.001, 0.0005]) == 1
    assert statistics.seconds_to(0.0005, [3, 1, 2], [0.005, 0.001, 0.0005]) == 2


def test_seconds_to_an_error_reached_without_any_left():
    """10 % at 1 s and nothing at 2 s: at 2 s at the latest."""
    assert statistics.seconds_to(0.01, [1, 2], [0.1, 0]) == 2
