"""Spherical caps as lights and surfaces: what traces them gets the light right, what cannot says so."""

from __future__ import annotations

import math

import pytest

import lightproof
from lightproof import scene_file
from lightproof.api import RenderError
from lightproof.checked import SceneError
from lightproof.estimators import path
from lightproof.renderers import views

CENTER, RADIUS = [0.3, -0.2, 0.4], 1.7


def cap(axis, half_angle):
    return {"type": "cap", "center": CENTER, "radius": RADIUS, "axis": axis, "half_angle": half_angle}


def scene(position, normal, surfaces=(), lights=(), max_bounces=0):
    """One point that receives."""
    film = {"kind": "points", "quantity": "irradiance", "positions": [position], "normals": [normal]}
    return scene_file.from_table({"title": "caps", "max_bounces": max_bounces, "tolerance": 0.01, "film": film,
                                  "surface": list(surfaces), "light": list(lights)}, "caps")


def lamp(half_angle):
    return {"id": "lamp", "kind": "area", "shape": cap([0, 0, 1], half_angle), "radiance": 0.83}


def wall(name, axis, half_angle, reflectance, radiance=0.0):
    return {"id": name, "shape": cap(axis, half_angle), "reflectance": reflectance, "radiance": radiance, "side": "inside"}


OUTSIDE = scene([0.3, -0.2, 4.0], [0, 0.6, -0.8], lights=[lamp(150)])
WITHIN = scene(CENTER, [0, 0, 1], surfaces=[wall("dome", [0, 0, 1], 50, 0, 0.83)])
ZONES = [wall("floor", [1, 2, 2], 70, 0.8, 0.83), wall("vault", [-1, -2, -2], 110, 0.3)]
SHARE = (1 - math.cos(math.radians(70))) / 2
EXACT = {
    "outside, as good as the sphere": (OUTSIDE, math.pi * 0.83 * (RADIUS / 3.6) ** 2 * 0.8),
    "from the centre, pi L sin2(a)": (WITHIN, math.pi * 0.83 * math.sin(math.radians(50)) ** 2),
    "two zones": (scene([2.0, -0.2, 0.4], [-1, 0, 0], ZONES, max_bounces="all"),
                  math.pi * 0.83 * SHARE / (1 - 0.8 * SHARE - 0.3 * (1 - SHARE))),
}


@pytest.mark.parametrize("name", EXACT)
def test_path_traces_caps(name):
    """Within five standard errors of the closed form."""
    one, exact = EXACT[name]
    method = path.Path("path", 1)
    assert method.unsupported(one) is None
    method.prepare(one)
    made = method.render(200_000, 7)
    assert abs(made.film[0] - exact) < 5 * math.sqrt(made.variance[0])
    assert math.sqrt(made.variance[0]) < 0.01 * exact


@pytest.mark.parametrize("name", ["analytic", "mc-area", "mc-cosine", "riemann-area", "riemann-hemisphere"])
def test_what_has_no_caps_says_so(name):
    with pytest.raises(RenderError, match="'lamp'"):
        lightproof.render(OUTSIDE, name, 16)


def test_renderers_are_given_no_caps():
    assert "'lamp'" in views.unsupported(OUTSIDE)


def test_a_white_sphere_of_two_caps_never_loses_light():
    """The same holds for no other pair."""
    with pytest.raises(SceneError, match="never loses light"):
        scene(CENTER, [0, 0, 1], [wall("a", [1, 0, 0], 40, 1, 1), wall("b", [-1, 0, 0], 140, 1)], max_bounces="all")
    scene(CENTER, [0, 0, 1], [wall("a", [1, 0, 0], 40, 1, 1), wall("b", [-1, 0, 0], 139, 1)], max_bounces="all")
