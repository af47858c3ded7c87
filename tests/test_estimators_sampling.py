"""Random numbers and samplers: uniform where they must be, independent where they must be, the same for the same seed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numba import njit
from scipy import stats

from lightproof import suite
from lightproof.estimators import shapes
from lightproof.estimators.directions import cosine_power
from lightproof.estimators.lamps import Glow, arriving, faced, lamp, parameters
from lightproof.estimators.lighting import spot_on_sphere
from lightproof.estimators.meeting import Cosine, Uniform
from lightproof.estimators.rng import TICK, block_keys, draws, stream, uniform
from lightproof.estimators.skies import dome
from lightproof.estimators.trigonometry import turn
from lightproof.estimators.world import SPHERE, WIDTH

BLOCKS, BLOCK = 64, 2048
RARE = 1e-6  # a fixed seed that falls below is no accident


@njit
def lattice_points(seed, element, blocks, count):
    """Draws (blocks * count, 4) in [0, 1) exactly as the fast kernel makes them."""
    out = np.empty((blocks * count, 4))
    for block in range(blocks):
        keys = block_keys(stream(seed, element, 0), block)
        for i in range(count):
            row = out[block * count + i]
            row[0], row[1], row[2], row[3] = draws(i, keys, 1.0)
    return out * TICK + 0.5


@njit
def uniforms(seed, element, streams, draws):
    out = np.empty((streams, draws))
    for k in range(streams):
        key = stream(seed, element, k)
        for i in range(draws):
            out[k, i] = uniform(key, i)
    return out


def p_uniform(points: np.ndarray, bins: int) -> float:
    """p-value of a chi-square test that `points` (n, d) in [0, 1) fill the cells of a grid alike."""
    cells = np.ravel_multi_index(tuple(np.floor(points * bins).astype(int).T), (bins,) * points.shape[1])
    return stats.chisquare(np.bincount(cells, minlength=bins ** points.shape[1])).pvalue


def two_sided(p: float) -> bool:
    """Neither too uneven nor too even for chance."""
    return RARE < p < 1 - RARE


@pytest.mark.parametrize(("columns", "bins"), [((0,), 1024), ((1,), 1024), ((3,), 1024), ((0, 1), 32), ((1, 2), 32), ((0, 3), 32),
                                               ((0, 1, 2), 10), ((0, 1, 2, 3), 6)])
def test_draws_of_one_sample_are_uniform_together(columns, bins):
    """The four lattice coordinates of 131,072 samples, in one to four dimensions: all cells alike."""
    assert two_sided(p_uniform(lattice_points(11, 3, BLOCKS, BLOCK)[:, columns], bins))


@pytest.mark.parametrize("lag", [1, 2, 16, 64])
def test_successive_samples_are_independent(lag):
    """Pairs of samples `lag` apart in one block, in two dimensions per coordinate: all cells alike."""
    points = lattice_points(12, 5, BLOCKS, BLOCK).reshape(BLOCKS, BLOCK, 4)
    for axis in range(4):
        pairs = np.stack([points[:, :-lag, axis].ravel(), points[:, lag:, axis].ravel()], axis=1)
        assert two_sided(p_uniform(pairs[::2], 24))


@pytest.mark.parametrize("other", [(13, 8, 0), (14, 7, 0), (13, 7, 1)], ids=["element", "seed", "block"])
def test_other_element_seed_or_block_is_independent(other):
    """The same sample numbers of the next element, seed and block: pairs fill all cells alike."""
    ours = lattice_points(13, 7, BLOCKS, BLOCK)
    seed, element, block = other
    theirs = lattice_points(seed, element, BLOCKS, BLOCK) if not block else np.roll(ours, BLOCK, axis=0)
    for axis in range(4):
        assert two_sided(p_uniform(np.stack([ours[:, axis], theirs[:, axis]], axis=1), 24))


def test_means_of_blocks_scatter_as_those_of_independent_draws():
    """Block means of s t p q, an average of 2,048 products: their variance over 4,096 blocks is (1/3^4 - 1/4^4)/2048."""
    products = lattice_points(15, 0, 4096, BLOCK).prod(axis=1).reshape(4096, BLOCK).mean(axis=1)
    expected = (3.0**-4 - 4.0**-4) / BLOCK
    assert two_sided(stats.chi2.cdf(products.var(ddof=1) / expected * 4095, 4095))
    assert abs(products.mean() - 1 / 16) < 5 * math.sqrt(expected / 4096)


def test_float64_draws_are_uniform_within_and_across_streams():
    """Draws of successive indices of one stream, and of one index of successive streams: all cells alike, none 0 or 1."""
    draws = uniforms(16, 2, 4096, 32)
    assert two_sided(p_uniform(draws.reshape(-1, 2), 32))
    assert two_sided(p_uniform(draws.T.reshape(-1, 2), 32))
    assert draws.min() > 0 and draws.max() < 1


ORIGIN, ALONG, ACROSS = np.zeros(3), np.array([2.04, 0, 0]), np.array([0, 0.37, 0])
SQUARE, TRIANGLE, DISK = (shapes.flat(kind, ORIGIN, ALONG, ACROSS) for kind in shapes.PER_PARAMETER)


@pytest.mark.parametrize("shape", [SQUARE, TRIANGLE, DISK], ids=["parallelogram", "triangle", "disk"])
def test_flat_shapes_are_sampled_with_uniform_density(shape):
    """Parameters s, t from uniform draws, mapped to the unit square by their own distribution functions: all cells alike."""
    draws = (lattice_points(17, 1, BLOCKS, BLOCK)[:, :2] - 0.5) / TICK
    s, t = np.array([flat_point(shape, a, b) for a, b in draws[:20000]]).T
    unit = {
        shapes.Parallelogram: lambda: (s + 0.5, t + 0.5),
        shapes.Triangle: lambda: (1 - (1 - s) ** 2, t / (1 - s)),
        shapes.Disk: lambda: (s**2 + t**2, np.arctan2(t, s) / (2 * np.pi) + 0.5),
    }[type(shape)]()
    assert two_sided(p_uniform(np.clip(np.stack(unit, axis=1), 0, 1 - 1e-15), 16))


@njit
def flat_point(shape, s, t):
    return parameters(shape, s, t)


@njit
def cap_points(globe, x, draws):
    out = np.empty((len(draws), 3))
    seen = faced(globe, x, ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), 1.0)
    for i in range(len(draws)):
        _, d = arriving(seen, (0.0, 0.0, 0.0), draws[i, 0], draws[i, 1])
        out[i, 0], out[i, 1], out[i, 2] = d
    return out


def test_sphere_is_sampled_uniformly_over_the_cap_that_faces_the_receiver():
    """Radius 0.31 seen from 0.9 m: height above the cap's rim and angle about the axis are uniform (Archimedes)."""
    center, radius = np.array([0.2, -0.3, 0.8]), 0.31
    draws = (lattice_points(18, 1, BLOCKS, BLOCK)[:, :2] - 0.5) / TICK
    d = cap_points(lamp(Glow("", shapes.Sphere(tuple(center), radius), 1.0)), (0.0, 0.0, 0.0), draws)
    assert two_sided(p_uniform(cap_coordinates((d - center) / radius, center, radius), 32))


def test_traced_sphere_is_sampled_uniformly_over_the_same_cap():
    """The sampler of the Riemann sum that follows rays, same sphere."""
    center, radius = np.array([0.2, -0.3, 0.8]), 0.31
    row = np.zeros(WIDTH)
    row[0], row[1:4], row[19], row[22] = SPHERE, center, radius, 1
    points = np.array([spot_on_sphere(row, (0.0, 0.0, 0.0), s, t)[0] for s, t in uniforms(19, 0, 20000, 2)])
    assert two_sided(p_uniform(cap_coordinates((points - center) / radius, center, radius), 16))


def cap_coordinates(normals: np.ndarray, center: np.ndarray, radius: float) -> np.ndarray:
    """Height within the cap and turn about its axis, both in [0, 1)."""
    distance = np.linalg.norm(center)
    axis = -center / distance
    side = np.cross(axis, [0, 0, 1.0])
    side /= np.linalg.norm(side)
    rim = radius / distance
    height = (normals @ axis - rim) / (1 - rim)
    angle = np.arctan2(normals @ np.cross(axis, side), normals @ side) / (2 * np.pi) + 0.5
    return np.clip(np.stack([height, angle], axis=1), 0, 1 - 1e-15)


@njit
def met_directions(source, draws, model):
    """What each draw counts, and its direction: (n, 4)."""
    out = np.empty((len(draws), 4))
    seen = faced(source, (0.0, 0.0, 0.0), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), model)
    zero = model - model
    for i in range(len(draws)):
        f, d = arriving(seen, (zero, zero, zero), draws[i, 0], draws[i, 1])
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = f, d[0], d[1], d[2]
    return out


@pytest.mark.parametrize("real", [np.float32, np.float64])
@pytest.mark.parametrize(("kind", "power"), [(Uniform, 0), (Cosine, 1)], ids=["uniform", "cosine"])
def test_hemispheres_are_sampled_by_their_density(kind, power, real):
    """What mc-hemisphere and mc-cosine draw under a uniform sky: z of density ~ z^power, the turn uniform; every draw counts
    cos(theta)/density, in either precision."""
    draws = ((lattice_points(21, power, BLOCKS, BLOCK)[:, :2] - 0.5) / TICK).astype(real)
    sky = dome(suite.default().scene("white-furnace-plane"), 1.0)
    counted, *d = met_directions(kind(sky, 1.0), draws, real(1)).T
    w = d / np.linalg.norm(d, axis=0)
    turned = np.arctan2(w[1], w[0]) / (2 * np.pi) + 0.5
    assert two_sided(p_uniform(np.clip(np.stack([w[2] ** (power + 1), turned], axis=1), 0, 1 - 1e-15), 16))
    assert counted == pytest.approx(1.37 * np.pi * (1 if power else 2 * w[2]), rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("power", [0, 1], ids=["uniform", "cosine"])
def test_directions_of_rays_follow_their_density(power):
    """z of density ~ z^power has distribution z^(power + 1), the turn is uniform: all cells alike; unit length."""
    w = np.array([cosine_power(power, s, t) for s, t in uniforms(20, power, 20000, 2)])
    assert np.allclose(np.linalg.norm(w, axis=1), 1, atol=1e-14)
    angle = np.arctan2(w[:, 1], w[:, 0]) / (2 * np.pi) + 0.5
    assert two_sided(p_uniform(np.stack([w[:, 2] ** (power + 1), np.clip(angle, 0, 1 - 1e-15)], axis=1), 16))


@pytest.mark.parametrize("real", [np.float32, np.float64])
def test_sine_and_cosine_reach_the_last_digits(real):
    """sin and cos of 2,001 fractions of a turn against math's: within five units in the last place of 1."""
    worst = 0.0
    for t in (np.linspace(-0.5, 0.5, 2001) / TICK).astype(real):
        angle = 2 * math.pi * float(t) * TICK
        worst = max(worst, *np.abs(np.subtract(turn(t), (math.sin(angle), math.cos(angle)))))
    assert worst < 5 * np.finfo(real).eps
