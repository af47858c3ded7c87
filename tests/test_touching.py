"""Receivers that lie on something, which see the limit as they come to it along their normal: against the proven reference, for
every method that takes it; what does not says so."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from test_certify import PLANE, at, blocker, lamp, scene
from test_estimators import method

from lightproof.certify.balls import CannotCertify
from lightproof.certify.engine import certify
from lightproof.estimators.analytic import Analytic
from lightproof.estimators.cubature import Cubature
from lightproof.estimators.mc_area import McArea
from lightproof.estimators.mc_mis import McMis
from lightproof.estimators.path import Path

SQUARE = [[-0.4, -0.7, 1.3], [-0.4, 0.3, 1.3], [0.6, 0.3, 1.3], [0.6, -0.7, 1.3]]
TRIANGLE = [[0, 0, 0.6], [0, 0, -0.4], [0, 1, 0.6]]
PLATE = [[-0.5, -0.5, -0.25], [0.5, -0.5, 0.25], [0.5, 0.5, 0.25], [-0.5, 0.5, -0.25]]
ELL = [[-0.5, -0.5, -0.25], [0.5, -0.5, 0.25], [0.5, -0.25, 0.25], [0, -0.25, 0], [0, 0.5, 0], [-0.5, 0.5, -0.25]]
UPWARDS, LEANING, STEEP = (0.1, 0.2, 1), (-0.1, 0.2, 1), (-0.3, -0.2, 0.5)
CONTACTS = [
    (TRIANGLE, (0, 0, 0), UPWARDS), (TRIANGLE, (0, 0, 0), LEANING), (TRIANGLE, (0, 0.1, 0), UPWARDS),
    (TRIANGLE, (0, 0.1, 0), LEANING), (TRIANGLE, (0, 0, 0.25), (0.1, -0.2, 1)), (TRIANGLE, (0, 0, 0.6), STEEP),
    (PLATE, (0, 0, 0), STEEP), (PLATE, (0.5, 0, 0.25), UPWARDS), (PLATE, (0.5, 0.5, 0.25), (0.1, -0.2, 1)),
    (PLATE, (0, 0.5, 0), (1, 1, 0.5)), (ELL, (-0.25, 0, -0.125), UPWARDS), (ELL, (0, -0.25, 0), (-0.5, 0, 1)),
]  # fmt: skip
METHODS = ["mc-area/sobol", "mc-area/sobol-float64", "mc-cosine/sobol", "mc-solid-angle/sobol", "mc-mis/sobol", "riemann-area"]
SPARE = [blocker([[5 + k, 5, 0.3], [6 + k, 5, 0.5], [5 + k, 6, 0.7]], f"spare{k}") for k in range(4)]
LYING = [[-0.4, -0.7, 0], [0.6, -0.7, 0], [0.6, 0.3, 0], [-0.4, 0.3, 0]]


def film(name, one, samples=1):
    return float(method(name, one).render(samples, 1).film[0])


def error(name, vertices, place, normal, others=()):
    """Of 2^14 samples, relative to what would come without blockers."""
    receiver = at(place, normal)
    one = scene([lamp(SQUARE)], receiver, [blocker(vertices), *others])
    exact = float(certify(scene([lamp(SQUARE)], at(np.round(place, 9).tolist(), normal), [blocker(vertices)])).value[0])
    return abs(film(name, one, 2**14) - exact) / film("analytic", scene([lamp(SQUARE)], receiver))


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize(("vertices", "place", "normal"), CONTACTS)
def test_blockers_below(vertices, place, normal, name):
    """Inside, on edges and on corners of a triangle, a parallelogram and an L in triangles; where the wrong side is taken, light
    goes wrong by a tenth and more."""
    assert error(name, vertices, place, normal) < 0.02


@pytest.mark.parametrize("name", ["mc-area/sobol", "mc-cosine/sobol"])
@pytest.mark.parametrize(("vertices", "place", "normal"), CONTACTS)
def test_the_limit_is_that(vertices, place, normal, name):
    """0.1 nm off, along the normal."""
    assert error(name, vertices, np.add(place, 1e-10 * np.array(normal)), normal) < 0.02


@pytest.mark.parametrize(("vertices", "place", "normal"), CONTACTS)
def test_a_crowd_of_blockers(vertices, place, normal):
    assert error("mc-area/sobol", vertices, place, normal, SPARE) < 0.02


@pytest.mark.parametrize(("size", "far"), [(1e-6, 1e3), (1e-6, 1e6), (1, 1e3), (1, 1e6), (1e5, 1e3)])
def test_contact_at_any_size_and_place(size, far):
    """The plate of the first contact that hides something, as large as may be and so many sizes away."""
    vertices, place, _ = CONTACTS[7]
    moved = [[[size * (x + far), size * y, size * z] for x, y, z in corners] for corners in (SQUARE, vertices, [place])]
    one = scene([lamp(moved[0])], at(moved[2][0], (-0.1, 0.2, 1)), [blocker(moved[1])])
    exact = float(certify(one).value[0])
    for name, digits in (("analytic", 1e-9), ("mc-area/sobol", 0.02), ("mc-area/sobol-float64", 0.02)):
        assert film(name, one, 2**14) == pytest.approx(exact, rel=digits), name


number = st.floats(-1, 1).map(lambda value: round(value, 3))
corner = st.tuples(number, number, number)


@given(st.lists(corner, min_size=3, max_size=3), st.lists(st.integers(0, 7), min_size=3, max_size=3), corner)
@settings(max_examples=200, deadline=None)
def test_any_place_on_any_triangle(corners, weights, normal):
    """On it but for rounding: inside, on edges and corners, whichever way the receiver looks."""
    assume(np.linalg.norm(np.cross(np.subtract(corners[1], corners[0]), np.subtract(corners[2], corners[0]))) > 0.01)
    assume(sum(weights) > 0 and np.linalg.norm(normal) > 0.1)
    place = (np.array(weights) / sum(weights) @ np.array(corners)).tolist()
    one = scene([lamp(SQUARE)], at(place, normal), [blocker(corners)])
    whole = film("analytic", scene([lamp(SQUARE)], at(place, normal)))
    assert film("analytic", one) == pytest.approx(proven(one), rel=1e-12, abs=1e-12 * whole)


def proven(one):
    try:
        return float(certify(one).value[0])
    except CannotCertify as doubt:
        assume("to 1e-14" not in str(doubt))
        raise


def test_what_is_not_quite_on_it_is_on_its_side():
    """Below the plate: black, whatever else there is, but for a band in which the reference does not say."""
    for gap in (1e-14, 1e-12, 1e-9):
        place = np.array((0, 0, 0)) - gap * np.array((-0.5, 0, 1)) / math.hypot(0.5, 1)
        two = at(place.tolist(), (0.1, 0.2, 1))
        two = two | {"positions": [*two["positions"], [1e6, 0, 0]], "normals": 2 * two["normals"]}
        one = scene([lamp(SQUARE)], two, [blocker(PLATE)])
        assert certify(one, [0]).value[0] == 0
        for name in ("analytic", "mc-area", "mc-area/float64", "mc-cosine"):
            assert method(name, one).render(256, 1).film[0] == 0, name
    with pytest.raises(CannotCertify, match="to 1e-14 of the coordinates but not to 1e-15"):
        certify(scene([lamp(SQUARE)], at((0, 0, -2e-15), (0.1, 0.2, 1)), [blocker(PLATE)]))


@pytest.mark.parametrize("width", [1e-2, 1e-4])
@pytest.mark.parametrize("seed", range(4))
def test_edges_of_thin_strips(width, seed):
    """On a long edge but for rounding."""
    start = np.array([0.13, -0.55, 0.07]) + np.random.default_rng(seed).uniform(-0.05, 0.05, 3)
    along, down = np.array([0.1, 1, 0.05]), width * np.array([-0.17, 0.1, -0.985])
    strip = np.array([start, start + along, start + along + down, start + down]).tolist()
    one = scene([lamp(SQUARE)], at((start + (0.3 + 0.1 * seed) * along).tolist(), (-0.3, 0.2, 1)), [blocker(strip)])
    assert film("mc-area/sobol", one, 2**14) == pytest.approx(float(certify(one).value[0]), rel=1e-3)


@pytest.mark.parametrize(("place", "normal"), [
    ((0.1, 0.1, 0), (1, 0, 0.2)), ((0.1, 0.1, 0), (1, 0, -0.2)), ((0.1, 0.1, 0), (0, 0, 1)), ((0.6, 0.1, 0), (-1, 0.4, 0.3)),
    ((0.6, 0.1, 0), (1, 0.4, 0.3)), ((-0.4, -0.7, 0), (1, 0.4, 0.3)),
])  # fmt: skip
@pytest.mark.parametrize("name", ["mc-hemisphere/sobol", "mc-cosine/sobol-float64", "riemann-hemisphere"])
def test_lights_below(place, normal, name):
    """A lamp that fills half of what a receiver on it sees, if it looks along it from the front; and the same turned, where it is
    on the lamp but for rounding."""
    turn = np.array([[math.cos(0.5), 0, math.sin(0.5)], [0, 1, 0], [-math.sin(0.5), 0, math.cos(0.5)]])
    tables = [[(np.array(vectors) @ way).tolist() for vectors in (LYING, place, normal)] for way in (np.eye(3), turn)]
    level, turned = (scene([lamp(corners)], at(*receiver)) for corners, *receiver in tables)
    exact = float(certify(level).value[0])
    assert float(certify(turned).value[0]) == pytest.approx(exact, rel=1e-12)
    for one in (level, turned):
        assert film(name, one, 2**14) == pytest.approx(exact, abs=0.02)
        assert film("analytic", one) == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize("cls", [McArea, McMis, Path, Cubature])
def test_what_aims_declines_a_light_below(cls):
    one = scene([lamp(LYING)], at((0.1, 0.1, 0), (1, 0, 0.2)))
    assert "'lamp'" in reason(cls, one)
    flush, behind = (scene([lamp(LYING)], at((0.1, 0.1, 0), normal)) for normal in ((0, 0, 1), (0, 0.2, -1)))
    assert reason(cls, flush) is None
    assert (reason(cls, behind) is None) == (cls is not Cubature)  # which declines what blocks at a slant too


@pytest.mark.parametrize("shape", [
    {"type": "sphere", "center": [0, 0, -0.5], "radius": 0.5},
    {"type": "disk", "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 0.5},
])  # fmt: skip
def test_round_lights_below(shape):
    """Black where the receiver faces as the light does, by every method, also where its density has no bound; at a slant those
    that do not take the limit decline."""
    round_lamp = {"id": "lamp", "kind": "area", "radiance": 2.0, "shape": shape}
    flush, slanting = (scene([round_lamp], at((0, 0, 0), normal)) for normal in ((0, 0, 1), (1, 0, 0.2)))
    for name in ("analytic", "mc-area", "mc-cosine", "mc-solid-angle", "mc-projected-solid-angle", "mc-mis", "path"):
        assert film(name, flush, 64) == 0, name
    for cls in (Analytic, McArea, McMis, Path):
        assert "'lamp'" in reason(cls, slanting)


BULB = {"id": "bulb", "kind": "point", "position": [0.1, -0.2, 1.3], "intensity": 2.0}
SKY = {"id": "sky", "kind": "environment", "radiance": 1.0}


@pytest.mark.parametrize(("cls", "lights", "place", "text"), [
    (Cubature, [lamp(SQUARE)], (0, 0.1, 0), "lies on 'blocker' at a slant"),
    (Path, [SKY], (0, 0.1, 0), "'blocker' is 0 m from a receiver"),
    (Path, [SKY], (1e-11, 0.1, 0), "'blocker' is 1e-11 m from a receiver"),
    (Analytic, [BULB], (0, 0, 0), "on an edge of 'blocker'"),
    (Analytic, [SKY], (0, 0, 0), "on an edge of 'blocker'"),
])  # fmt: skip
def test_what_takes_no_limit_says_so(cls, lights, place, text):
    """And takes the scene with the receiver well beside it."""
    assert text in reason(cls, scene(lights, at(place, UPWARDS), [blocker(TRIANGLE)]))
    assert reason(cls, scene(lights, at((0.1, 0.1, 0), UPWARDS), [blocker(TRIANGLE)])) is None


def test_bulbs_and_skies_from_inside_a_blocker():
    """From inside an edge the side alone decides: a hard shadow, and half a sky but for the slant."""
    for place, lit in (((0, 0.1, 0), UPWARDS), ((0, 0.1, 0), LEANING)):
        one = scene([BULB], at(place, lit), [blocker(TRIANGLE)])
        off = scene([BULB], at(np.add(place, 1e-6 * np.array(lit)), lit), [blocker(TRIANGLE)])
        assert film("analytic", one) == pytest.approx(film("analytic", off), rel=1e-5)
        assert film("mc-area", one) == pytest.approx(film("analytic", off), rel=1e-5)
    sky = scene([SKY], at((0, 0.1, 0), UPWARDS), [blocker(TRIANGLE)])
    assert film("mc-cosine/sobol", sky, 2**14) == pytest.approx(float(certify(sky).value[0]), rel=0.01)
    assert film("analytic", sky) == pytest.approx(float(certify(sky).value[0]), rel=1e-9)


@pytest.mark.parametrize("more", [{}, {"normals": [list(UPWARDS)]}])
def test_a_solid_angle_from_a_triangle_has_no_value(more):
    """Which side counts, nothing says; where the receiver is beside it, it has."""
    points = {"kind": "points", "quantity": "solid_angle", "positions": [[0, 0, 0]]} | more
    lit = scene([lamp(SQUARE)], points, [blocker(TRIANGLE)])
    assert "'blocker', from where a solid angle has no one value" in reason(Analytic, lit)
    for place in ((0, 0, 0), (-1e-17, 0, 0)):
        with pytest.raises(CannotCertify, match="no one value"):
            certify(scene([lamp(SQUARE)], points | {"positions": [place]}, [blocker(TRIANGLE)]))
    assert reason(Analytic, scene([lamp(SQUARE)], points | {"positions": [[0.1, 0, 0]]}, [blocker(TRIANGLE)])) is None


@pytest.mark.parametrize("height", [1e-12, 1e-9, 0.1])
def test_a_film_that_faces_away_from_the_floor_below(height):
    """No ray of it goes there."""
    plane = PLANE | {"origin": [-0.5, -0.5, height], "u": [1, 0, 0], "v": [0, 1, 0], "resolution": [2, 2]}
    floor = blocker([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], "floor") | {"reflectance": 0.5}
    one = scene([lamp(SQUARE)], plane, [floor], max_bounces=2)
    assert reason(Path, one) is None
    assert "direct light only" in reason(Analytic, one)


def test_a_film_that_a_wall_runs_through():
    """The elements' middles lie on the wall: no element does, and every method takes it."""
    plane = PLANE | {"origin": [-0.5, -0.5, 0], "u": [1, 0, 0], "v": [0, 1, 0], "resolution": [1, 3]}
    one = scene([lamp(SQUARE)], plane, [blocker([[0, -1, -1], [0, 1, -1], [0.3, 1, 1], [0.3, -1, 1]])])
    for cls in (McArea, Path, Cubature, Analytic):
        assert reason(cls, one) is None


def reason(cls, one):
    name = {McArea: "mc-area", McMis: "mc-mis", Path: "path", Cubature: "cubature", Analytic: "analytic"}[cls]
    return cls(name, 1).unsupported(one)
