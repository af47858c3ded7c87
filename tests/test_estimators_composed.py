"""The compiled kernel's pieces put together: sources, points and views, each against another code or a count by hand."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import pytest
from numba import njit

from lightproof import suite
from lightproof.estimators import directions, paths
from lightproof.estimators.estimator import sampled
from lightproof.estimators.mc_area import McArea
from lightproof.estimators.mc_cosine import McCosine
from lightproof.estimators.mc_hemisphere import McHemisphere
from lightproof.estimators.points import Random, drawn, grid, opened
from lightproof.estimators.riemann_hemisphere import RiemannHemisphere
from lightproof.estimators.rng import TICK
from lightproof.estimators.views import view
from lightproof.estimators.world import build
from lightproof.scene import Scene
from lightproof.scene_file import from_table

SIGMAS = 4.5
CATALOGUE = suite.default()
SEEN = CATALOGUE.scene("square-light-seen")
POINTS = {"kind": "points", "quantity": "irradiance", "positions": [[0.1, 0.05, 0], [0.5, 0.3, 0]],
          "normals": [[0, 0, 1], [0.3, -0.2, 1]]}  # fmt: skip
HEXAGON = {"type": "polygon", "vertices": [[0.5 * math.cos(a), -0.5 * math.sin(a), 1.2] for a in np.arange(6) * math.pi / 3]}
BALL = {"type": "sphere", "center": [0.2, 0.1, 0.6], "radius": 0.15}
SUN = {"id": "sun", "kind": "environment", "radiance": 30.0, "direction": [0, 0.6, -0.8], "half_angle": 25.0}
OVERCAST = {"id": "sky", "kind": "environment", "sky": "cie-overcast", "zenith_radiance": 1.3}
HALF = {"id": "half", "kind": "environment", "radiance": 0.7, "extent": "upper"}
LAMP = {"id": "lamp", "kind": "area", "shape": HEXAGON, "radiance": 2.04}
GLOBE = {"id": "globe", "kind": "area", "shape": {"type": "sphere", "center": [-0.5, 0.3, 0.9], "radius": 0.2}, "radiance": 3.7}


def scene(lights: list, surfaces: tuple = (), film: dict = POINTS, max_bounces: int = 0) -> Scene:
    table = {"title": "test", "max_bounces": max_bounces, "tolerance": 0.01, "light": lights, "film": film}
    return from_table({**table, "surface": list(surfaces)}, "test")


EVERYTHING = scene([LAMP, GLOBE, SUN, OVERCAST, HALF], ({"id": "ball", "shape": BALL, "reflectance": 0},))


def prepared(cls, one: Scene, name: str = "test"):
    made = cls(name, 2)
    made.prepare(one)
    return made


def traced(one: Scene, power: int, samples: int) -> tuple[np.ndarray, int, np.ndarray]:
    """Film, samples and variance by the generic ray tracer."""
    items, skies, _, film, elements, contact = build(one).arrays

    def add(first: int, last: int, span: tuple[int, int], out: np.ndarray) -> None:
        directions.estimate(items, skies, film, elements[first:last], contact, first, 7, span, power, out)

    return sampled(add, one.size, samples, 2)


@pytest.mark.parametrize(("cls", "power"), [(McHemisphere, 0), (McCosine, 1)])
def test_directions_meet_what_rays_meet(cls, power):
    """A hexagon, a globe, a sun, two skies and a ball that blocks, over a level and a tilted receiver: kernel and tracer agree,
    and so do their variances per sample, though the kernel looks for one piece after the other."""
    fast = prepared(cls, EVERYTHING).render(1 << 18, 6)
    film, samples, variance = traced(EVERYTHING, power, 1 << 18)
    assert (np.abs(fast.film - film) < SIGMAS * np.sqrt(fast.variance + variance)).all()
    assert fast.variance == pytest.approx(variance, rel=0.02)
    assert fast.samples == samples


def test_variance_of_pieces_in_the_same_directions():
    """Everything at once: the reported variance is what 400 replicates scatter by, within chi-square bounds."""
    made = prepared(McCosine, EVERYTHING)
    results = [made.render(512, seed) for seed in range(1, 401)]
    ratio = np.var([one.film for one in results], axis=0, ddof=1) / np.mean([one.variance for one in results], axis=0)
    assert np.abs(ratio - 1).max() < SIGMAS * math.sqrt(2 / 399)


def test_riemann_sum_meets_every_light_once():
    """The same scene by a million midpoints against the tracer's random directions."""
    film, _, variance = traced(EVERYTHING, 1, 1 << 18)
    summed = prepared(RiemannHemisphere, EVERYTHING).render(1 << 20, 0).film
    assert (np.abs(summed - film) < SIGMAS * np.sqrt(variance) + 2e-3).all()


@njit
def midpoints(cut):
    out = np.empty((cut.samples, 4))
    for i in range(cut.samples):
        out[i] = np.array(drawn(i, opened(cut, 0, 0), 1.0))
    return out * TICK


def test_grid_holds_every_midpoint_once():
    """3 x 3 directions at each of 2 x 2 receivers: 36 points, all combinations of the midpoints, each once."""
    found = midpoints(grid(3, 2))
    third, half = np.array([-1, 0, 1]) / 3, np.array([-1, 1]) / 4
    expected = np.array(np.meshgrid(third, third, half, half)).reshape(4, -1).T
    assert np.allclose(found[np.lexsort(np.round(found, 6).T)], expected[np.lexsort(np.round(expected, 6).T)], atol=1e-12)


def test_uniform_sky_is_summed_exactly():
    """white-furnace-plane: pi L from 16 midpoints, to the last digits of float32."""
    made = prepared(RiemannHemisphere, CATALOGUE.scene("white-furnace-plane"))
    assert made.render(16, 0).film == pytest.approx(math.pi * 1.37, rel=3e-7)


CAMERA = {**SEEN.to_table()["film"], "resolution": [4, 3]}
PARALLEL = {**{key: value for key, value in CAMERA.items() if key != "fov"}, "projection": "orthographic", "width": 1.1}


@pytest.mark.parametrize("film", [CAMERA, PARALLEL], ids=["perspective", "orthographic"])
def test_patches_that_pixels_see_are_the_tracer_s(film):
    """square-light-seen through two cameras: the kernel's patches against paths that trace the first ray."""
    table = SEEN.to_table()
    one = scene(table["light"], table["surface"], film, max_bounces=1)
    assert view(one) is not None
    fast = prepared(McArea, one).render(1 << 16, 3)
    film, _, variance = sampled(partial(paths.Paths(build(one), 1, glow=False).add, Random(1 << 16, 4)), one.size, 1 << 16, 2)
    assert (np.abs(fast.film - film) < SIGMAS * np.sqrt(fast.variance + variance)).all()


def test_no_view_where_pixels_see_more():
    """A ball in sight, a camera that sees past the floor, from below, or no reflection at all: left to the tracer."""
    table = SEEN.to_table()
    ball = {"id": "ball", "shape": {**BALL, "center": [0.05, 0.1, 0.2]}, "reflectance": 0}
    assert view(scene(table["light"], (*table["surface"], ball), CAMERA, 1)) is None
    assert view(scene(table["light"], table["surface"], {**CAMERA, "target": [0.9, 0, 1.1]}, 1)) is None
    assert view(scene(table["light"], table["surface"], {**CAMERA, "origin": [0.9, -2.1, -1.1]}, 1)) is None
    assert view(scene(table["light"], table["surface"], CAMERA, 0)) is None
