"""Films of solid angle: against first hits along many rays, closed forms, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from brute_force import solid_angle
from hypothesis import given, settings
from hypothesis import strategies as st
from test_certify import blocker, lamp, scene

from lightproof.certify.balls import CannotCertify
from lightproof.certify.engine import certify

X = (0.1, 0.2, 0.05)
NORMAL = (0.3, -0.2, 0.8)
WALL = [[1, -1, -0.4], [1.25, 1, -0.25], [1, 1.25, 1.25], [0.75, -0.75, 1.1]]  # beside X, through its horizon
ELL = [[0.5, 0.5, 1], [0.5, 1.5, 1], [1, 1.5, 1], [1, 1, 1], [1.5, 1, 1], [1.5, 0.5, 1]]
ROOF = [[-1, -1, 1.5], [-1, 1, 1.5], [2, 1, 1.5], [2, -1, 1.5]]
SKY = {"id": "sky", "kind": "environment", "radiance": 1.3}
HALF = SKY | {"extent": "upper"}
SUN = {"id": "sun", "kind": "environment", "radiance": 1.3, "direction": [-0.7, -0.2, -0.7], "half_angle": 30.0}
BALL = {"type": "sphere", "center": [1.7, 0.6, 2.4], "radius": 0.55}
SMALL = {"type": "sphere", "center": [0.5, 0.35, 0.6], "radius": 0.12}
DISK = {"type": "disk", "center": [-0.8, -0.3, 0.9], "normal": [0.5, 0.1, -0.7], "radius": 0.6}


def seen_from(x=X, normal=None):
    """A film of one point."""
    return {"kind": "points", "quantity": "solid_angle", "positions": [list(x)]} | ({"normals": [list(normal)]} if normal else {})


def glow(shape, name="glow"):
    """A round light."""
    return {"kind": "area", "id": name, "radiance": 3.1, "shape": shape}


def solid(shape, name="solid"):
    """A round surface."""
    return {"id": name, "reflectance": 0, "shape": shape}


SCENES = {
    "polygon": ([lamp(WALL[::-1])], []),
    "non-convex polygon": ([lamp(ELL)], []),
    "overlapping lights": ([lamp(WALL[::-1], name="a"), lamp(ELL, name="b"), lamp(ROOF, name="c")], []),
    "blocker": ([lamp(ROOF)], [blocker(ELL)]),
    "backs block": ([lamp(ROOF, name="a"), lamp(ELL[::-1], name="b"), lamp(WALL, name="c")], []),
    "sky": ([SKY], [blocker(ELL), blocker(WALL, "wall")]),
    "sky, light before a blocker": ([SKY, lamp(ELL)], [blocker(ROOF), blocker(WALL, "wall")]),
    "half a sky, light below": ([HALF, lamp(WALL[::-1])], [blocker(ELL)]),
    "half a sky, dark below": ([HALF, lamp(ELL)], [blocker(WALL)]),
    "sun behind": ([SUN, lamp(ROOF)], [blocker(ELL)]),
    "sphere beside and behind": ([glow(BALL), lamp(WALL[::-1])], [blocker(ELL)]),
    "sphere before": ([lamp(ROOF)], [solid(SMALL), blocker(WALL)]),
    "disk": ([glow(DISK), lamp(WALL[::-1])], []),
    "sky with balls and a card": (
        [SKY, glow(BALL | {"center": [2.5, -0.6, 0.7]}), lamp(WALL[::-1])], [solid(SMALL), blocker(ROOF)]),
    "one ball before another": ([glow(BALL), glow({"type": "sphere", "center": [0.9, 0.4, 1.2], "radius": 0.1}, "small")], []),
    "an eclipse": (
        [SUN | {"half_angle": 8.0}, lamp(ROOF)], [solid({"type": "sphere", "center": [0.8, 0.4, 0.75], "radius": 0.2})]),
    "sky with a disk turned away": ([SKY, SUN, glow(DISK | {"normal": [-0.5, -0.1, 0.7]})], [blocker(WALL)]),
}


@pytest.mark.parametrize("normal", [None, NORMAL], ids=["all round", "above"])
@pytest.mark.parametrize("lights, surfaces", SCENES.values(), ids=SCENES)
def test_first_hits(lights, surfaces, normal):
    """Half a million rays hit a light's front first in as much of the sphere as is certified, but for their grain."""
    world = scene(lights, seen_from(X, normal), surfaces)
    assert certify(world).value[0] == pytest.approx(solid_angle(world, np.array(X), normal), abs=2e-3)


@pytest.mark.parametrize("half_angle", [1e-7, 0.3, 45, 90])
def test_caps(half_angle):
    """A sun: 4 pi sin^2(a/2)."""
    value = certify(scene([SUN | {"half_angle": float(half_angle)}], seen_from())).value[0]
    assert value == pytest.approx(4 * math.pi * math.sin(math.radians(half_angle) / 2) ** 2, rel=4e-15)


def test_a_disk_on_its_axis():
    """2 pi R^2 / (s (s + h)), s = hypot(R, h)."""
    disk = {"type": "disk", "center": [0, 0, 0.9], "normal": [0, 0, -1], "radius": 0.6}
    value = certify(scene([glow(disk)], seen_from((0, 0, 0)))).value[0]
    s = math.hypot(0.6, 0.9)
    assert value == pytest.approx(2 * math.pi * 0.36 / (s * (s + 0.9)), rel=1e-15)


def test_the_sphere_of_directions_in_two_halves():
    """What is above a horizon and what is below it make up the whole, whatever the shape."""
    for lights, surfaces in SCENES.values():
        whole, above, below = (certify(scene(lights, seen_from(X, normal), surfaces)).value[0]
                               for normal in (None, NORMAL, [-c for c in NORMAL]))
        assert above + below == pytest.approx(whole, rel=1e-15)


@settings(max_examples=20, deadline=None)
@given(st.lists(st.tuples(*[st.integers(-9, 9)] * 3), min_size=3, max_size=3), st.floats(0, 1))
def test_two_parts_of_a_triangle(corners, share):
    """Cut from a corner, however near its edge, the parts add up to the triangle, seen from either side."""
    a, b, c = (np.array(corner) / 4 for corner in corners)
    share = round(share * 64) / 64  # so that the cut is exact
    middle = b + share * (c - b)
    if not 0 < share < 1 or np.linalg.norm(np.cross(b - a, c - a)) == 0 or np.dot(np.cross(b - a, c - a), a - X) == 0:
        return
    whole = certify(scene([lamp([a, b, c]), lamp([a, c, b], name="back")], seen_from())).value[0]
    parts = [lamp([a, b, middle], name="one"), lamp([a, middle, b], name="two"),
             lamp([a, middle, c], name="three"), lamp([a, c, middle], name="four")]
    assert certify(scene(parts, seen_from())).value[0] == pytest.approx(whole, rel=1e-15)


@pytest.mark.parametrize("distance", [1e-6, 1.0, 1e8])
def test_size_does_not_matter(distance):
    """A triangle and a copy of it, a power of two larger and farther away, look alike."""
    corners = np.array([[-0.39, -0.31, 1.37], [0.13, 0.73, 1.19], [0.65, -0.47, 0.94]])
    scale = 2.0 ** round(math.log2(distance))
    values = [certify(scene([lamp(corners * factor)], seen_from((0, 0, 0)))).value[0] for factor in (1, scale)]
    assert values[0] == values[1]


def test_a_light_seen_edge_on():
    """In the plane of a light, beside it: nothing, exactly."""
    certified = certify(scene([lamp()], seen_from((3.0, 0.1, 1.3))))
    assert certified.value[0] == certified.uncertainty[0] == 0


REFUSED = {
    "lies on a polygon": ([lamp()], [], (0, 0, 1.3)),
    "inside a sphere, or on it": ([glow(BALL)], [], BALL["center"]),
    "may overlap disk 'glow'": ([glow(DISK), lamp([[-1, -1, 1.5], [-1, 1, 1.5], [2, 1, 1.5], [2, -1, 1.5]])], [], X),
    "'glow' and 'other', which are round": ([glow(BALL), glow(BALL | {"center": [1.7, 0.9, 2.4]}, "other")], [], X),
    "touches an edge, a corner, the horizon or another rim": (
        [glow({"type": "sphere", "center": [x, 0, 4], "radius": 0.5}, name) for x, name in ((-0.5, "one"), (0.5, "two"))], [],
        (0, 0, 0)),
    "is a cylinder": ([glow({"type": "cylinder", "base": [1, 1, 1], "axis": [0, 0, 1], "height": 1.0, "radius": 0.2})], [], X),
    "round, together with half a sky": ([HALF], [solid(BALL)], X),
    "plane of a polygon cuts sphere 'glow'": (
        [glow(BALL)], [blocker([[-3, -3, 2.4], [9, -3, 2.4], [9, 9, 2.4], [-3, 9, 2.4]])], X),
}


@pytest.mark.parametrize("reason", REFUSED)
def test_refusals(reason):
    """What has no proven answer is refused, and why."""
    lights, surfaces, x = REFUSED[reason]
    with pytest.raises(CannotCertify, match=reason):
        certify(scene(lights, seen_from(x), surfaces))
