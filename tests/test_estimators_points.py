"""Points that depend on one another: uniform one by one, evenly spread together, afresh for every element and seed.

Seeds are fixed, so that each test either always passes or always fails.
"""

from __future__ import annotations

import numpy as np
import pytest
from numba import njit
from scipy import stats
from scipy.stats import qmc

from lightproof import suite
from lightproof.estimators.mc_area import McArea
from lightproof.estimators.mc_cosine import McCosine
from lightproof.estimators.options import SAMPLING, chosen
from lightproof.estimators.path import Path
from lightproof.estimators.points import drawn, opened
from lightproof.estimators.rng import TICK
from lightproof.estimators.sobol import combined, directions
from lightproof.scene import Scene

RARE = 1e-6  # a fixed seed that falls below is no accident
DEPENDENT = ("jitter", "lattice", "sobol")
CATALOGUE = suite.default()


@njit
def block_of(points, element, block, count):
    """The first `count` points (count, 4) of a block, in [0, 1)."""
    out = np.empty((count, 4))
    common = opened(points, element, block)
    for i in range(count):
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = drawn(i, common, 1.0)
    return out * TICK + 0.5


@pytest.mark.parametrize("kind", DEPENDENT)
def test_every_point_alone_is_uniform(kind):
    """Point 1,234 of 4,096 elements: its four coordinates fill 4^4 cells as chance does, for each element has a key of its
    own. This is what makes the estimate free of bias. A jittered point is uniform over its own cell of 16 x 16."""
    points = SAMPLING["points"][kind](4096, 21)
    alone = np.array([block_of(points, element, 0, 1235)[-1] for element in range(4096)])
    if kind == "jitter":
        assert np.ptp(np.floor(alone[:, :2] * 64), axis=0).max() == 0
        alone[:, :2] = alone[:, :2] * 64 % 1
    cells = np.ravel_multi_index(tuple(np.floor(alone * 4).astype(int).T), (4,) * 4)
    assert RARE < stats.chisquare(np.bincount(cells, minlength=4**4)).pvalue < 1 - RARE


def test_sobol_is_the_published_sequence():
    """Unscrambled, from the numbers that follow from 2^31: the first 4,096 points are those of scipy's table, Joe and Kuo's
    too, in some order."""
    plain = (combined(directions(*np.full(4, 2**31, np.uint32)), 4096).T / 2**32).tolist()
    assert sorted(plain) == sorted(qmc.Sobol(4, scramble=False).random_base2(12).tolist())


@pytest.mark.parametrize("block", [0, 5])
def test_scrambled_sobol_points_stay_a_net(block):
    """2,048 points, the first or a later block of 2^11: every interval of 2^-11 in one dimension and, in dimensions 1 and 2
    together, every box of 2^-j x 2^(j - 11) holds just one. Another element has other points."""
    points = block_of(SAMPLING["points"]["sobol"](2**14, 22), 7, block, 2048)
    for axis in range(4):
        assert (np.bincount((points[:, axis] * 2048).astype(int)) == 1).all()
    for j in range(12):
        boxes = np.floor(points[:, :2] * (2**j, 2 ** (11 - j))) @ (2 ** (11 - j), 1)
        assert (np.bincount(boxes.astype(int)) == 1).all()
    assert not np.isin(points, block_of(SAMPLING["points"]["sobol"](2**14, 22), 8, block, 2048)).any()


def test_lattice_is_the_published_one():
    """1,024 points less the first one, modulo 1: multiples of the generator over 1,024, in the order of bits reversed."""
    points = block_of(SAMPLING["points"]["lattice"](1024, 23), 7, 0, 1024)
    k = np.array([int(format(i, "010b")[::-1], 2) for i in range(1024)])
    expected = np.outer(k, [1, 182667, 469891, 498753]) % 1024
    assert (np.round((points - points[0]) % 1 * 1024) % 1024 == expected).all()


@pytest.mark.parametrize("samples", [1, 1000, 2**10])
def test_jitter_fills_each_cell_once(samples):
    """Of the light's grid and of the element's, whatever the number of samples."""
    points = SAMPLING["points"]["jitter"](samples, 24)
    assert samples - samples**0.5 <= points.samples <= samples
    found = block_of(points, 3, 0, points.samples)
    for pair in (found[:, :2], found[:, 2:]):
        cells = np.floor(pair * (points.across, points.down)) @ (1, points.across)
        assert (np.bincount(cells.astype(int), minlength=points.samples) == 1).all()


def rms_error(name: str, scene: Scene, samples: int) -> float:
    made = McArea(name, 2)
    made.prepare(scene)
    exact = CATALOGUE.reference(scene).value
    result = made.render(samples, 31)
    assert result.variance is None
    return float(np.sqrt(np.mean((result.film - exact) ** 2)) / exact.max())


@pytest.mark.parametrize(("kind", "factor"), [("jitter", 6), ("lattice", 8), ("sobol", 40)])
def test_error_falls_faster_than_by_the_square_root(kind, factor):
    """square-light, 256 to 4,096 samples, where independent points gain a factor of 4: half as much again, Sobol ten times."""
    scene = CATALOGUE.scene("square-light")
    few, many = (rms_error(f"mc-area/{kind}-float64", scene, samples) for samples in (256, 4096))
    assert few / many > factor


def test_options_are_told():
    """By `settings`, after `prepare`."""
    made = McCosine("mc-cosine/sobol-float64", 1)
    made.prepare(CATALOGUE.scene("umbra"))
    assert made.settings() == {"domain": "hemisphere of the receiver", "pdf": "cos(theta)/pi per solid angle", "points": "sobol",
                               "precision": "float64"}


@pytest.mark.parametrize(("name", "reason"), [
    ("mc-area/halton", "mc-area has no option 'halton'; its options are independent, jitter, lattice, sobol, float32, float64"),
    ("mc-area/sobol-jitter", "'sobol' and 'jitter' are two options for its points"),
    ("mc-area/sobol_float64", "mc-area has no option 'sobol_float64'"),
])  # fmt: skip
def test_unknown_options_are_refused(name, reason):
    with pytest.raises(ValueError, match=reason):
        McArea(name, 1)
    assert chosen("mc-area/float64-sobol", SAMPLING) == chosen("mc-area/sobol-float64", SAMPLING)


def test_paths_order_no_points_but_the_places_in_an_element():
    """Where rays are followed the settings say so; where the kernel of mc-area is all that is left, all points are ordered."""
    with pytest.raises(ValueError, match="path has no option 'jitter'"):
        Path("path/jitter", 1)
    for name, points in (("soft-shadow-picture", "sobol over the element"), ("square-light", "sobol")):
        path = Path("path/sobol", 1)
        path.prepare(CATALOGUE.scene(name))
        assert path.settings()["points"] == points


def test_a_film_that_needs_rays_is_refused():
    """soft-shadow-picture is followed by rays, whose points are independent."""
    scene = CATALOGUE.scene("soft-shadow-picture")
    assert McArea("mc-area", 1).unsupported(scene) is None
    assert "needs rays" in McArea("mc-area/sobol", 1).unsupported(scene)
