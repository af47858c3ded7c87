"""The analytic method beyond polygons: looks around, solid angles, rooms and spheres, pictures, one reflection; against proven
references and formulas."""

from __future__ import annotations

import numpy as np
import pytest
from brute_force import solid_angle
from test_analytic import CATALOGUE, MEANS, film, points
from test_certify import blocker, lamp, scene
from test_certify_solid_angle import NORMAL, SCENES, X, seen_from

from lightproof import suite
from lightproof.estimators import outlook
from lightproof.estimators.analytic import Analytic
from lightproof.scene_file import from_table

POINTS = 1e-12  # of a value at a point
UP = [0, 0, 1]
SKY = {"id": "sky", "kind": "environment", "radiance": 1.7, "extent": "upper"}
ROOM = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]


def reference(one):
    return np.array(CATALOGUE.reference(one).value, float)


def load(name):
    return suite.find(name, CATALOGUE)[0]


def why(one):
    return Analytic("analytic", 1).unsupported(one)


def glow(shape, name="glow", radiance=3.1):
    return {"kind": "area", "id": name, "radiance": radiance, "shape": shape}


def solid(shape, name="solid"):
    return {"id": name, "reflectance": 0, "shape": shape}


def ball(center, radius):
    return {"type": "sphere", "center": center, "radius": radius}


@pytest.mark.parametrize("name", [
    "tube-light:points", "tube-light:horizon", "tube-light:upright", "disk-light:horizon", "disk-blocker:askew",
    "sphere-blocker", "sphere-blocker:disk", "sphere-blocker:sphere", "sphere-blocker:small", "sphere-blocker:low",
    "hard-tiny-solid-angle:angle", "hard-tiny-solid-angle:triangle-angle", "hard-tiny-solid-angle:disk-angle",
    "hard-tiny-solid-angle:sphere-angle",
    "hard-approach:disk", "hard-approach:sphere", "hard-grazing:disk", "hard-grazing:setting",
    "two-zone-sphere", "two-zone-sphere:two-reflections", "emitting-cap:irradiance", "concentric-spheres:irradiance",
    "concentric-spheres:narrow", "cube-furnace:irradiance", "lit-floor-to-wall:points", "lit-floor-to-wall:screen",
])  # fmt: skip
def test_points_are_right_to_the_last_digits(name):
    """Against the proven enclosures, relative to each value."""
    one = load(name)
    np.testing.assert_allclose(film(one), reference(one), rtol=POINTS, atol=1e-300)


@pytest.mark.parametrize(("name", "samples", "error"), [
    ("sky-with-wall", 64, MEANS),
    ("cube-furnace", 1, MEANS), ("cube-furnace:across", 1, MEANS),
    ("cube-room:west", 1, MEANS), ("cube-room:four-reflections", 1, MEANS),
    ("concentric-spheres:six-reflections", 4096, MEANS), ("emitting-cap", 4096, MEANS), ("two-zone-sphere:seen", 1024, MEANS),
    ("lamp-at-distance:at-1000-m", 64, MEANS), ("lamp-at-distance:grazing", 64, MEANS),
    ("soft-shadow-picture", 256, MEANS), ("square-light-seen", 64, MEANS), ("white-furnace-sphere", 4096, MEANS),
    ("lit-floor-to-wall", 256, MEANS), ("lit-floor-to-wall:in-the-corner", 256, MEANS), ("disk-blocker", 1024, MEANS),
])  # fmt: skip
def test_means_are_right(name, samples, error):
    """Relative to the film's largest value."""
    one = load(name)
    exact = reference(one)
    assert np.abs(film(one, samples) - exact).max() <= error * np.abs(exact).max()


def test_a_look_around_agrees_with_closed_forms():
    """A disk, a sphere cut by the horizon and a half sky, each with a ball far off that hides nothing: a look around finds what
    the closed forms say without it."""
    where = points([[0.1, 0.2, 0], [0.7, -0.3, 0.1], [0.2, 0.1, 0.3]], [UP, [0.3, 0.1, 1], [-0.9, 0.2, 0.1]])
    disk = glow({"type": "disk", "center": [0.2, 0.1, 1.3], "normal": [0.1, 0.2, -1], "radius": 0.4}, "disk")
    lights = [disk, glow(ball([0.9, 0.1, 0.4], 0.3), "ball"), SKY]
    for light in lights:
        alone = scene([light], where)
        before = scene([light], where, [solid(ball([40, 1, -90], 0.5))])
        rest = outlook.parted(before)[1]
        assert outlook.shining(rest)
        np.testing.assert_allclose(film(before), film(alone), rtol=POINTS)


@pytest.mark.parametrize("name", ["square-light", "disk-light", "sphere-light", "disk-blocker"])
def test_a_cylinder_that_stands_before_nothing_changes_nothing(name):
    """Below the floor, to the last bit."""
    table = suite.default().scene(name).to_table()
    tube = {"type": "cylinder", "base": [0, 0, -3], "axis": [0, 0, 1], "height": 1, "radius": 0.3}
    below = {**table, "surface": [*table.get("surface", []), {"id": "tube", "reflectance": 0.5, "shape": tube}]}
    np.testing.assert_array_equal(film(from_table(below, "below"), 4), film(from_table(table, "alone"), 4))


def test_what_a_ball_hides_of_a_sky():
    """A uniform sky, a ball of half-angle a above: pi L cos^2(a) is left of it."""
    where = points([[0.3, -0.2, 0.1]], [UP])
    hidden = scene([SKY], where, [solid(ball([0.3, -0.2, 1.4], 0.5))])
    assert film(hidden)[0] == pytest.approx(np.pi * 1.7 * (1 - (0.5 / 1.3) ** 2), rel=1e-14)


def test_solid_angles_count_once():
    """Two spheres on one line: the nearer one covers the farther, which adds what is left of it around."""
    where = {"kind": "points", "quantity": "solid_angle", "positions": [[0, 0, 0]]}
    sines = np.array([0.2 / 0.9, 0.7 / 2.3])
    both = scene([glow(ball([0, 0.9, 0], 0.2), "near"), glow(ball([0, 2.3, 0], 0.7), "far")], where)
    assert film(both)[0] == pytest.approx(2 * np.pi * (1 - np.sqrt(1 - sines[1] ** 2)), rel=1e-13)
    black = scene([glow(ball([0, 2.3, 0], 0.7), "far")], where, [solid(ball([0, 0.9, 0], 0.2))])
    assert film(black)[0] == pytest.approx(2 * np.pi * (np.sqrt(1 - sines[0] ** 2) - np.sqrt(1 - sines[1] ** 2)), rel=1e-13)


@pytest.mark.parametrize("normal", [None, NORMAL])
@pytest.mark.parametrize("name", [name for name, things in SCENES.items() if not why(scene(things[0], seen_from(), things[1]))])
def test_solid_angles_agree_with_first_hits(name, normal):
    """A million rays, of those scenes in which nothing cuts through another thing."""
    lights, surfaces = SCENES[name]
    one = scene(lights, seen_from(normal=normal), surfaces)
    rays = solid_angle(one, np.array(X), None if normal is None else np.array(normal))
    assert film(one)[0] == pytest.approx(rays, abs=1e-3)


def test_what_it_cannot_do_it_says():
    """Shapes that cut through each other, a film beside a room, zones around a lamp that is not in the centre."""
    where = points([[0, 0, -1]], [UP])
    crossing = scene([SKY], where, [blocker(ROOM, "floor"), blocker([[0, -1, -0.5], [0, 1, -0.5], [0, 1, 0.5]], "wall")])
    assert "cut through each other" in why(crossing)
    assert "inside a convex room" in why(scene_at(load("cube-furnace:irradiance"), [9, 9, 9]))
    zones = load("two-zone-sphere").to_table()
    zones["light"][0]["position"] = [0.4, -0.2, 0.4]
    assert "in the centre only" in why(at(zones))
    assert why(scene([lamp(ROOM)], where)) is None


def scene_at(one, place):
    table = one.to_table()
    table["film"]["positions"] = [place] * len(table["film"]["positions"])
    return at(table)


def at(table):
    return from_table(table, "moved", "base")
