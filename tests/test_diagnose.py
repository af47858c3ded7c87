"""Mistakes that a film gives away, in light summed here from points on the lamp, finely and in sub-elements."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from lightproof import diagnose, sketch, suite
from lightproof.scene import Scene

SUITE = suite.default()
FINE = 3  # sub-elements along each side of an element


@cache
def light(scene: Scene, share: sketch.Share = sketch.share) -> np.ndarray:
    """Element means (n,) of the unblocked irradiance, each from FINE x FINE points."""
    columns, rows = scene.film.resolution
    fine = replace(scene, film=replace(scene.film, resolution=(FINE * columns, FINE * rows)))
    values = sketch.irradiance(fine, np.arange(fine.size), {"light": share})["light"]
    return values.reshape(rows, FINE, columns, FINE).mean(axis=(1, 3)).ravel()


def named(film: np.ndarray, value: np.ndarray, scene: Scene, noise: float = 0.002, seed: int = 1) -> str | None:
    """The diagnosis of a film with Gaussian noise, `noise` being the standard error as a fraction of the mean light."""
    error = np.full(scene.size, noise * np.abs(film).mean())
    return diagnose.diagnose(film + error * np.random.default_rng(seed).standard_normal(scene.size), error, value, scene)


@pytest.mark.parametrize("name", ["pi", "1/pi", "4/pi", "2", "1/2", "4 pi", "683 (lumens per watt at 555 nm)"])
def test_a_constant_factor_is_named(name):
    """Square light, every element times the factor."""
    scene = SUITE.scene("square-light")
    value = light(scene)
    assert named(diagnose.FACTORS[name] * value, value, scene) == f"likely mistake: a factor of {name}"


def test_a_factor_in_a_furnace_is_named():
    """The same light everywhere: nothing but a factor can be told."""
    scene = SUITE.scene("white-furnace-plane")
    value = np.full(scene.size, 4.3)
    assert named(2 * value, value, scene) == "likely mistake: a factor of 2"


def test_a_factor_without_a_name_gets_its_number():
    """1.37 times the light, to 0.2 % of noise."""
    scene = SUITE.scene("square-light")
    assert named(1.37 * light(scene), light(scene), scene).startswith("likely mistake: a constant factor of 1.37 ± ")


@pytest.mark.parametrize("factor", [1.26, 3.0, 3.2, 680 * 1.03])
def test_a_factor_near_a_named_one_is_not_named(factor):
    """1 % beside 4/pi, 4 % and 2 % beside pi, 2.5 % beside 683."""
    scene = SUITE.scene("square-light")
    assert "a constant factor" in named(factor * light(scene), light(scene), scene)


def test_noise_gets_no_name():
    """pi times the light, each element known to 60 %; and light without a mistake, known to 0.2 %."""
    scene = SUITE.scene("square-light")
    value = light(scene)
    assert all(named(np.pi * value, value, scene, noise=0.6, seed=seed) is None for seed in range(40))
    assert all(named(value, value, scene, seed=seed) is None for seed in range(40))


def test_a_factor_known_too_coarsely_is_not_named():
    """pi times the light at five points, each known to 5 %: the factor is known to 9 %, and 3 would do as well."""
    scene = SUITE.scene("disk-light:axis")
    value = np.full(scene.size, 4.3)
    assert all(named(np.pi * value, value, scene, noise=0.05, seed=seed) is None for seed in range(40))


def test_a_mistake_that_noise_would_hide_is_not_named():
    """A cosine missing under a lamp parallel to the floor, 13 % of the light, each element known to 3 %."""
    scene = SUITE.scene("square-light")
    film = light(scene, diagnose.SHARES["the light's cosine is missing"])
    assert all(named(film, light(scene), scene, noise=0.03, seed=seed) is None for seed in range(40))


def test_three_mistakes_that_explain_a_film_name_none():
    """Light that doubles from row to row and from column to column: half of it is also the light shifted by one of either."""
    scene = SUITE.scene("white-furnace-plane")
    row, column = np.indices(scene.film.grid).reshape(2, -1)
    value = 2.0 ** (row + column)
    assert diagnose.diagnose(value / 2, np.zeros(scene.size), value, scene) is None


def test_a_film_that_no_mistake_explains_gets_no_name():
    """Square light with a tilt across the film: 30 % too bright on one side, right on the other."""
    scene = SUITE.scene("square-light")
    assert named(light(scene) * np.tile(np.linspace(1, 1.3, 16), 12), light(scene), scene) is None


def test_a_black_film_is_named():
    scene = SUITE.scene("square-light")
    assert diagnose.diagnose(np.zeros(scene.size), np.zeros(scene.size), light(scene), scene) \
        == "likely mistake: a factor of 0, the film is black"


@pytest.mark.parametrize("turned, mistake", [
    (lambda image: image[::-1], "its rows run the wrong way"),
    (lambda image: image[:, ::-1], "its columns run the wrong way"),
    (lambda image: image[::-1, ::-1], "it is turned by half a turn"),
])
def test_a_turned_film_is_named(turned, mistake):
    """Triangle light, asymmetric in both directions."""
    scene = SUITE.scene("triangle-light")
    value = light(scene)
    assert named(turned(value.reshape(scene.film.grid)).ravel(), value, scene) == f"likely mistake: {mistake}"


def test_exchanged_rows_and_columns_are_named():
    """Triangle light on a film of 12 x 12 elements."""
    scene = SUITE.scene("triangle-light")
    scene = replace(scene, film=replace(scene.film, resolution=(12, 12)))
    value = light(scene)
    assert named(value.reshape(12, 12).T.ravel(), value, scene) == "likely mistake: its rows and columns are exchanged"


@pytest.mark.parametrize("axis, step, mistake", [(0, 1, "one row"), (0, -1, "one row, backwards"),
                                                 (1, 1, "one column"), (1, -1, "one column, backwards")])
def test_a_shifted_film_is_named(axis, step, mistake):
    """The lamp close to the floor: steep edges; the film displaced by one element."""
    scene = SUITE.scene("square-light:near")
    value = light(scene)
    shifted = np.roll(value.reshape(scene.film.grid), step, axis=axis).ravel()
    assert named(shifted, value, scene) == f"likely mistake: it is shifted by {mistake}"


@pytest.mark.parametrize("mistake", diagnose.SHARES)
def test_a_forgotten_term_is_named(mistake):
    """Tilted triangle: the two cosines differ, so that the one forgotten can be told from the other."""
    scene = SUITE.scene("triangle-light")
    assert named(light(scene, diagnose.SHARES[mistake]), light(scene), scene) == f"likely mistake: {mistake}"


def test_cosines_that_are_equal_are_named_together():
    """A lamp parallel to the floor: the cosines at both ends are the same."""
    scene = SUITE.scene("square-light")
    assert named(light(scene, diagnose.SHARES["the light's cosine is missing"]), light(scene), scene) \
        == "likely mistake: the receiver's cosine is missing, or the light's cosine is missing"


def test_a_point_light_has_no_cosine_to_forget():
    """Point light: the receiver's cosine alone can be missing."""
    scene = SUITE.scene("point-light")
    assert named(light(scene, diagnose.SHARES["the receiver's cosine is missing"]), light(scene), scene) \
        == "likely mistake: the receiver's cosine is missing"


@pytest.mark.parametrize("name", ["occluded-square", "disk-blocker", "knife-edge"])
def test_missing_shadows_are_named(name):
    """The exact light is dark in a disk of elements; the film is lit as if nothing blocked."""
    scene = SUITE.scene(name)
    open_light = light(scene)
    row, column = np.indices(scene.film.grid).reshape(2, -1)
    value = open_light * (np.hypot(row - 7, column - 6) > 4)
    assert named(open_light, value, scene) == "likely mistake: the shadows are missing"


def test_missing_shadows_are_named_where_no_light_is_due():
    """All of the film in the umbra, the exact light zero."""
    scene = SUITE.scene("occluded-square")
    assert named(light(scene), np.zeros(scene.size), scene) == "likely mistake: the shadows are missing"


def test_radiance_is_diagnosed_by_its_film_alone():
    """A camera's image of the floor, brighter by pi."""
    scene = SUITE.scene("square-light-seen")
    value = np.random.default_rng(2).uniform(1, 2, scene.size)
    assert named(np.pi * value, value, scene) == "likely mistake: a factor of pi"


def test_the_sketch_agrees_with_a_closed_form():
    """Disk on its axis at h = 1.13 m, R = 0.37 m: E = pi L R^2/(R^2 + h^2); point light: E = I cos/r^2."""
    scene = SUITE.scene("disk-light:axis")
    sketched = sketch.irradiance(scene, np.array([0]), {"light": sketch.share})["light"]
    assert sketched == pytest.approx(np.pi * 4.3 * 0.37**2 / (0.37**2 + 1.13**2), rel=2e-3)


def test_the_sketch_of_a_sphere_agrees_with_a_closed_form():
    """Sphere of R = 0.31 m, d away and wholly above the horizon: E = pi L (R/d)^2 cos(theta)."""
    scene = SUITE.scene("sphere-light")
    x, y = np.meshgrid(-1.2 + 2.4 / 16 * (np.arange(16) + 0.5), -0.9 + 1.8 / 12 * (np.arange(12) + 0.5))
    square = (x - 0.17) ** 2 + (y + 0.23) ** 2 + 0.93**2
    exact = np.pi * 3.1 * 0.31**2 / square * 0.93 / np.sqrt(square)
    sketched = sketch.irradiance(scene, np.arange(scene.size), {"light": sketch.share})["light"]
    assert np.linalg.norm(sketched - exact.ravel()) < sketch.ACCURACY * np.linalg.norm(exact)


def test_a_concave_lamp_counts_its_area_once():
    """An L of three unit squares, 50 m away: E = L A / d^2 but for the spread of distances."""
    scene = SUITE.scene("square-light:far")
    corners = ((0, 0, 50), (0, 2, 50), (1, 2, 50), (1, 1, 50), (2, 1, 50), (2, 0, 50))
    lamp = replace(scene.lights[0], shape=replace(scene.lights[0].shape, vertices=corners))
    sketched = sketch.irradiance(replace(scene, lights=(lamp,)), np.arange(scene.size), {"light": sketch.share})["light"]
    assert sketched == pytest.approx(2.04 * 3 / 50**2, rel=0.01)
