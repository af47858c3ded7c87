"""Films and variances from the sums of a kernel."""

from __future__ import annotations

import numpy as np
import pytest

from lightproof.estimators.moments import LARGEST, moments


def sums(values: np.ndarray) -> np.ndarray:
    """Of values (n, N), as the kernel adds them up: the first of each row is its pivot."""
    beyond = values - values[:, :1]
    return np.stack([values.shape[1] * values[:, 0], beyond.sum(axis=1), (beyond**2).sum(axis=1)], axis=1)


@pytest.mark.parametrize("factor", [1.0, 0.3])
def test_the_mean_of_values_and_its_variance(factor):
    values = np.random.default_rng(1).exponential(size=(5, 40))
    film, variance = moments(sums(values), 40, factor)
    assert film == pytest.approx(factor * values.mean(axis=1), rel=1e-13)
    assert variance == pytest.approx(factor**2 * values.var(axis=1, ddof=1) / 40, rel=1e-12)


def test_one_value_has_no_variance():
    film, variance = moments(sums(np.array([[2.0], [0.0]])), 1, 1.0)
    assert film.tolist() == [2, 0] and variance.tolist() == [0, 0]


def test_what_is_below_zero_is_rounding_and_what_is_no_number_is_told():
    film, variance = moments(np.array([[1.0, -1 - 1e-7, 0.5], [1.0, np.nan, np.nan], [np.inf, 0.0, 0.0]]), 4, 1.0)
    assert film[0] == 0 and np.isnan(film[1]) and np.isnan(variance[1]) and np.isinf(film[2])


def test_squares_beyond_float32_are_large():
    _, variance = moments(np.array([[0.0, 1e19, np.inf]]), 4, 1.0)
    assert variance[0] == pytest.approx((LARGEST - 1e38 / 4) / 12)
