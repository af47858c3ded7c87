"""Skies and suns behind blockers: against first hits along many rays, closed forms, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from brute_force import sky_irradiance
from hypothesis import given, settings
from hypothesis import strategies as st
from test_certify import at, blocker, polygon, scene

from lightproof.certify.balls import CannotCertify
from lightproof.certify.engine import certify

X = (0.1, 0.2, 0.05)
NORMAL = (0.3, -0.2, 0.8)
WALL = [[1, -1, -0.4], [1.25, 1, -0.25], [1, 1.25, 1.25], [0.75, -0.75, 1.1]]  # beside X, through its horizon
ELL = [[0.5, 0.5, 1], [1.5, 0.5, 1], [1.5, 1, 1], [1, 1, 1], [1, 1.5, 1], [0.5, 1.5, 1]]
ROOF = [[-1, -1, 1.5], [2, -1, 1.5], [2, 1, 1.5], [-1, 1, 1.5]]
POLYGONS = [blocker(WALL, "wall"), blocker(ELL, "ell"), blocker(ROOF, "roof")]
SKY = {"id": "sky", "kind": "environment", "radiance": 1.3}
HALF = SKY | {"extent": "upper"}
OVERCAST = {"id": "sky", "kind": "environment", "zenith_radiance": 1.3, "sky": "cie-overcast"}
BALL = {"type": "sphere", "center": [0.9, 0.3, 0.8], "radius": 0.35}
DISK = {"type": "disk", "center": [-0.5, 0.1, 0.7], "normal": [0.2, 0.1, 1], "radius": 0.4}
CYLINDER = {"type": "cylinder", "base": [0.3, -0.9, 0.1], "axis": [0.1, 0, 1], "height": 1.2, "radius": 0.2}
CARD = [[-0.3, 0.9, 0.2], [0.5, 0.9, 0.2], [0.5, 0.9, 0.9], [-0.3, 0.9, 0.9]]
PLANE = {"kind": "plane", "quantity": "irradiance", "resolution": [4, 4]}
FILM = PLANE | {"origin": [-0.3, -0.4, 0], "u": [0.6, 0, 0], "v": [0, 0.5, 0]}
SLANTED = PLANE | {"origin": [-0.3, -0.4, 0], "u": [0.6, 0, 0], "v": [0, 0.5, 0.1]}


def sun(half_angle, direction=(-0.5, 0.1, -0.7)):
    """A distant disc."""
    return {"id": "sun", "kind": "environment", "radiance": 1.3, "direction": list(direction), "half_angle": float(half_angle)}


def solid(shape, name="solid"):
    """A black surface."""
    return {"id": name, "reflectance": 0, "shape": shape}


SUNS = {f"sun of {a}, from {d}": (sun(a, d), POLYGONS)
        for a in (20, 60, 85, 90) for d in ((-0.5, 0.1, -0.7), (-0.7, -0.2, -0.2), (0.1, 0.1, -1))}
SCENES = {
    "sky": (SKY, POLYGONS),
    "half a sky": (HALF, POLYGONS),
    "overcast": (OVERCAST, POLYGONS),
    "sky behind a ball and polygons": (SKY, [*POLYGONS, solid(BALL)]),
    "half a sky behind a disk": (HALF, [solid(DISK)]),
    "sun behind a ball and a roof": (sun(40), [blocker(ROOF), solid(BALL)]),
    **SUNS,
}


@pytest.mark.parametrize("light, surfaces", SCENES.values(), ids=SCENES)
def test_first_hits(light, surfaces):
    """Half a million rays that reach the sky bring as much light as is certified, but for their grain."""
    world = scene([light], at(X, NORMAL), surfaces)
    assert certify(world).value[0] == pytest.approx(sky_irradiance(world, np.array(X), NORMAL), abs=2e-3)


def test_a_hidden_sun_is_dark():
    """A roof all over the sun: nothing but what rounding of hundreds of digits leaves."""
    certified = certify(scene([sun(3, (0.1, 0.1, -1))], at(X, NORMAL), POLYGONS))
    assert certified.value[0] == 0 and certified.uncertainty[0] < 1e-300


def test_a_small_roof_takes_its_part_of_the_overcast_sky():
    """A square of 0.02 m straight above takes L_z A / h^2, the zenith being brightest: 1e-4 from that at a height of 2 m."""
    side, height = 0.02, 2.0
    card = [[x * side / 2, y * side / 2, height] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    film = at((0, 0, 0))
    taken = certify(scene([OVERCAST], film)).value[0] - certify(scene([OVERCAST], film, [blocker(card)])).value[0]
    assert taken == pytest.approx(1.3 * side**2 / height**2, rel=1e-4)


def test_the_rest_of_a_sun_behind_a_blade():
    """A blade whose edge runs through the middle of a sun overhead halves it."""
    blade = [[0, -9, 2], [9, -9, 2], [9, 9, 2], [0, 9, 2]]
    value = certify(scene([sun(20, (0, 0, -1))], at((0, 0, 0)), [blocker(blade)])).value[0]
    assert value == pytest.approx(1.3 * math.pi * math.sin(math.radians(20)) ** 2 / 2, rel=1e-15)


def test_a_sun_in_the_horizon():
    """Half a disc: L (a - sin(a) cos(a)), though no ball tells the centre's height from 0."""
    a = math.radians(40)
    value = certify(scene([sun(40, (-0.75, 0.25, 0.25))], at(X, (0, -1, 1)))).value[0]
    assert value == pytest.approx(1.3 * (a - math.sin(a) * math.cos(a)), rel=1e-14)


def test_the_wall_a_receiver_stands_on():
    """At the foot of a wall without end half the sky is left, but for what shows past its ends: a part in 1e4 of it."""
    wall = [[0, -9000, -1], [0, 9000, -1], [0, 9000, 9000], [0, -9000, 9000]]
    value = certify(scene([SKY], at((0, 0, 0), (0.5, 0, 1)), [blocker(wall)])).value[0]
    assert value == pytest.approx(1.3 * math.pi * (1 + 0.5 / math.hypot(0.5, 1)) / 2, rel=1e-3)


@pytest.mark.parametrize("light", [SKY, HALF, OVERCAST], ids=["whole", "half", "overcast"])
def test_means_are_those_of_the_points(light):
    """A cell before a card: the mean of 8 x 8 points by Gauss's rule."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    p, q = (1 + nodes) / 2, (1 + nodes) / 2
    places = [(-0.3 + 0.15 * a, -0.4 + 0.125 * b, 0) for a in p for b in q]
    film = {"kind": "points", "quantity": "irradiance", "positions": places, "normals": [[0, 0, 1]] * len(places)}
    points = certify(scene([light], film, [blocker(CARD)])).value
    mean = certify(scene([light], FILM, [blocker(CARD)]), [0]).value[0]
    assert mean == pytest.approx(float(points @ np.outer(weights, weights).ravel()) / 4, rel=1e-12)


def test_means_where_two_shadows_meet():
    """A card that shows past an edge of another: the mean of 12 x 12 places, to what its kinks leave."""
    surfaces = [blocker(CARD), blocker([[-0.6, 0.5, 0.3], [0.1, 0.5, 0.2], [0.2, 0.7, 0.8]], "other")]
    steps = (np.arange(12) + 0.5) / 12
    places = [(-0.3 + 0.15 * a, -0.4 + 0.125 * b, 0) for a in steps for b in steps]
    film = {"kind": "points", "quantity": "irradiance", "positions": places, "normals": [[0, 0, 1]] * len(places)}
    points = certify(scene([SKY], film, surfaces)).value
    assert certify(scene([SKY], FILM, surfaces), [0]).value[0] == pytest.approx(points.mean(), rel=2e-5)


def test_a_film_beside_a_ball():
    """An open sky less a ball's light as a lamp, cell by cell."""
    ball = {"type": "sphere", "center": [0.9, 0.3, 0.8], "radius": 0.35}
    lamp = {"kind": "area", "id": "lamp", "radiance": 1.3, "shape": ball}
    dark, bright = certify(scene([SKY], FILM, [solid(ball)])), certify(scene([lamp], FILM))
    assert dark.value + bright.value == pytest.approx(1.3 * math.pi, rel=1e-14)


@settings(max_examples=15, deadline=None)
@given(st.lists(st.tuples(*[st.floats(-2, 2)] * 3), min_size=3, max_size=3), st.tuples(*[st.floats(-1, 1)] * 3))
def test_a_sky_and_the_lamp_in_its_place(corners, normal):
    """A triangle takes from a uniform sky what it would give as a lamp on either side: an identity, for any receiver."""
    area = np.linalg.norm(np.cross(np.subtract(corners[1], corners[0]), np.subtract(corners[2], corners[0])))
    if area < 1e-3 or np.linalg.norm(normal) < 1e-3:
        return
    film = at((0.1, 0.2, 0.3), normal)
    lamps = [{"kind": "area", "id": name, "radiance": 1.3, "shape": polygon(side)}
             for name, side in (("front", corners), ("back", corners[::-1]))]
    given_ = sum(certify(scene([lamp], film)).value[0] for lamp in lamps)
    assert certify(scene([SKY], film, [blocker(corners)])).value[0] + given_ == pytest.approx(1.3 * math.pi, abs=1e-14)


REFUSED = {
    "curved edges": (sun(20), FILM, [blocker(CARD)]),
    "horizon is not that of the sky": (HALF, SLANTED, [blocker(CARD)]),
    "three convex polygons": (SKY, FILM, POLYGONS),
    "before an overcast sky": (OVERCAST, at(X), [solid(BALL)]),
    "behind something curved": (SKY, FILM, [solid(CYLINDER), blocker(CARD)]),
}


@pytest.mark.parametrize("reason", REFUSED)
def test_refusals(reason):
    """What has no proven answer is refused, and why."""
    light, film, surfaces = REFUSED[reason]
    with pytest.raises(CannotCertify, match=reason):
        certify(scene([light], film, surfaces))
