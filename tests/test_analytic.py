"""The analytic method against proven references, formulas in mpmath and what physics demands: points to the last digits, means to
1e-9 of a film's largest value."""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from test_certify import PLANE, at, blocker, lamp, scene
from test_estimators import method

from lightproof import suite
from lightproof.certify.engine import certify
from lightproof.estimators import convex
from lightproof.estimators.compiled import strict_kernel
from lightproof.estimators.flats import Plane
from lightproof.estimators.levels import level
from lightproof.scene import Scene

CATALOGUE = suite.default()
DIGITS = 1e-13  # of a value at a point: the worst that was measured is 3e-14, for a triangle 1e2 times as long as wide
MEANS = 1e-9  # of a film's largest value
TRIANGLE = [[-0.37, -0.71, 1.1], [-0.23, 0.52, 1.6], [0.61, 0.13, 1.37]]
SQUARE = [[-0.4, -0.7, 1.3], [-0.4, 0.3, 1.3], [0.6, 0.3, 1.3], [0.6, -0.7, 1.3]]
FILM = PLANE | {"origin": [-0.6, -0.5, 0], "u": [1.2, 0, 0], "v": [0, 1.1, 0], "resolution": [6, 5]}


def film(one: Scene, samples: int = 1) -> np.ndarray:
    return method("analytic", one.tangible).render(samples, 0).film


def points(positions, normals) -> dict:
    return {"kind": "points", "quantity": "irradiance", "positions": [list(map(float, p)) for p in positions],
            "normals": [list(map(float, n)) for n in normals]}


HARD = [
    "hard-approach", "hard-approach:triangle", "hard-approach:along",
    "hard-aspect", *(f"hard-aspect:{kind}-1e{k}" for kind in ("strip", "triangle") for k in (2, 4, 6, 8)),
    "hard-aspect:long-1e3", "hard-aspect:long-1e6",
    "hard-degenerate-light", "hard-degenerate-light:doubled-back", "hard-degenerate-light:point", "hard-degenerate-light:floor",
    "hard-degenerate-light:blocker",
    "hard-distance", "hard-distance:triangle",
    "hard-grazing", "hard-grazing:triangle", "hard-grazing:sliver",
    "hard-in-plane", "hard-in-plane:triangle", "hard-in-plane:tilted",
    "hard-through-vertex", "hard-through-vertex:triangle", "hard-through-vertex:two", "hard-through-vertex:leaning",
    "hard-tiny-solid-angle", "hard-tiny-solid-angle:triangle", "hard-tiny-solid-angle:triangle-1e-24",
    "hard-touching-edge", "hard-touching-edge:leaning", "hard-touching-edge:corner",
    "hard-translation", *(f"hard-translation:moved-1e{k}" for k in (2, 4, 6, 8)),
]  # fmt: skip


@pytest.mark.parametrize("name", HARD)
def test_hard_points_are_right_to_the_last_digits(name):
    """Each row of the stability table, against the proven enclosure, relative to each value itself; zero where it is zero."""
    one, _ = suite.find(name, CATALOGUE)
    exact = CATALOGUE.reference(one).value
    np.testing.assert_allclose(film(one), exact, rtol=DIGITS, atol=0)


LAMPS = [
    "square-light", "square-light:near", "square-light:far", "square-light:tilted", "square-light:cut", "triangle-light",
    "triangle-light:tilted", "l-shaped-light", "l-shaped-light:tilted", "l-shaped-light:two-pieces", "point-light",
    "point-light:near", "point-light:tilted", "beam", "beam:tilted", "beam:patch",
    "occluded-square", "knife-edge", "two-blockers", "two-blockers:coplanar", "triangle-blocker", "l-shaped-blocker",
    "contact-shadow", "contact-shadow:penumbra", "picket-fence", "point-light-shadow", "point-light-shadow:beam",
]  # fmt: skip


@pytest.mark.parametrize("name", LAMPS)
def test_means_of_the_catalogue(name):
    """Every element at 256 nodes, lit or in shadow, against the stored reference."""
    one, _ = suite.find(name, CATALOGUE)
    exact = CATALOGUE.reference(one).value
    assert np.abs(film(one, 256) - exact).max() < MEANS * exact.max()


def test_a_lamp_before_a_lamp():
    """two-lights:one-before-the-other: the element that converges last, against the first engine's enclosure."""
    one, _ = suite.find("two-lights:one-before-the-other", CATALOGUE)
    assert film(one, 256)[52] == pytest.approx(float(certify(one, [52]).value[0]), rel=MEANS)


def test_a_board_through_the_floor():
    """tilted-blocker, whose shadow's edges all meet where the board does: right at 1024 nodes."""
    one, _ = suite.find("tilted-blocker", CATALOGUE)
    coarse, fine = film(one, 1024), film(one, 8192)
    assert np.abs(coarse - fine).max() < MEANS * fine.max()


@pytest.mark.parametrize("name", ["tilted-blocker:foot", "point-light-shadow:points", "point-light-shadow:round"])
def test_points_in_shadows(name):
    """Every point against the first engine's enclosure."""
    one, _ = suite.find(name, CATALOGUE)
    np.testing.assert_allclose(film(one), [float(ball) for ball in certify(one).value], rtol=DIGITS, atol=0)


@pytest.mark.parametrize("name", ["umbra", "umbra:rim", "umbra:points", "umbra:two-plates"])
def test_umbra_is_exactly_black(name):
    """Full shadow, also that of two plates which meet in a seam: zero, not almost."""
    assert not film(suite.find(name, CATALOGUE)[0], 64).any()


ON = [([0.1, 0.1, 0], [1, 0, 0.2]), ([0.1, -0.2, 0], [-1, 0.3, 0.1]), ([0.1, 0.1, 0], [0, 0, 1]), ([0.1, 0.1, 0], [1, 0, -0.2])]
BORDER = [([0.6, 0.1, 0], [-1, 0.4, 0.3]), ([0.6, 0.1, 0], [1, 0.4, 0.3]), ([-0.4, -0.7, 0], [1, 0.4, 0.3]),
          ([-0.4, -0.7, 0], [1, -0.4, 0.3])]  # fmt: skip


@pytest.mark.parametrize(("receivers", "digits"), [(ON, DIGITS), (BORDER, 1e-10)], ids=["inside", "border"])
def test_points_on_a_light_see_it_in_the_limit(receivers, digits):
    """Points of a lamp that faces up, approached from where their normals point: the limit of the first engine; on the lamp's
    edges and corners by extrapolation, which keeps fewer digits."""
    one = scene([lamp([[-0.4, -0.7, 0], [0.6, -0.7, 0], [0.6, 0.3, 0], [-0.4, 0.3, 0]])], points(*zip(*receivers, strict=True)))
    exact = [float(ball) for ball in certify(one).value]
    assert max(exact) > 1
    np.testing.assert_allclose(film(one), exact, rtol=digits, atol=digits)


coordinate = st.floats(-1, 1).map(lambda number: round(number, 3))
corner = st.tuples(coordinate, coordinate, coordinate)


@given(st.lists(corner, min_size=3, max_size=3), corner, st.integers(-20, 20))
@settings(max_examples=60, deadline=None)
def test_open_triangles_are_lambert_s_sum(corners, position, power):
    """Any triangle of any size as seen from any point far enough in front of it for the textbook's sum, which mpmath evaluates in
    60 digits; horizon and plane as they come."""
    a, b, c = (np.array(v) for v in corners)
    normal = np.cross(b - a, c - a)
    assume(np.linalg.norm(normal) > 0.01 and (np.array(position) - a) @ normal > 0.01 * np.linalg.norm(normal))
    towards = (a + b + c) / 3 - position
    scale = 2.0**power
    one = scene([lamp((np.array(corners) * scale).tolist(), 1.0)], at(np.array(position) * scale, towards.tolist()))
    exact = textbook([(v - np.array(position)) * scale for v in (a, b, c)], towards)
    assume(exact is not None)
    assert film(one)[0] == pytest.approx(float(exact), rel=1e-12)


def textbook(corners, normal):
    """(1/2) sum theta_i (g_i . n) of corners relative to the receiver; None where the horizon cuts them."""
    with mpmath.workdps(60):
        n = mpmath.matrix(normal.tolist())
        n /= mpmath.norm(n)
        v = [mpmath.matrix(corner.tolist()) for corner in corners]
        if min((n.T * corner)[0] for corner in v) <= 0:
            return None
        total = mpmath.mpf(0)
        for one, other in zip(v, v[1:] + v[:1], strict=True):
            g = cross(other, one)
            total += mpmath.acos((one.T * other)[0] / mpmath.norm(one) / mpmath.norm(other)) * (g.T * n)[0] / mpmath.norm(g)
        return total / 2


def cross(a, b):
    return mpmath.matrix([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


@given(st.lists(st.lists(corner, min_size=3, max_size=3), min_size=1, max_size=3), corner)
@example([[(0, 0, 0), (0, 0, -1), (0, 1, 0)]], (0, 0, 0))  # on an edge
@settings(max_examples=25, deadline=None)
def test_any_blockers_at_any_point(blockers, place):
    """Up to three triangles anywhere, through the light's plane or the receiver's, before each other: the exact clipping of the
    first engine, to the rounding of what is left of the light."""
    sides = [np.cross(np.subtract(b, a), np.subtract(c, a)) for a, b, c in blockers]
    assume(all(np.linalg.norm(side) > 0.01 for side in sides))
    walls = [blocker([[x, y, 0.6 + z] for x, y, z in corners], f"b{k}") for k, corners in enumerate(blockers)]
    receiver = at([place[0], place[1], 0.0], [0.1, 0.2, 1])
    exact = float(certify(scene([lamp(SQUARE)], receiver, walls)).value[0])
    whole = film(scene([lamp(SQUARE)], receiver))[0]
    assert film(scene([lamp(SQUARE)], receiver, walls))[0] == pytest.approx(exact, rel=1e-12, abs=1e-13 * whole)


def test_what_lies_in_the_light_s_plane_or_the_receiver_s_hides_nothing():
    """Plates flush with a tilted lamp and with the floor."""
    a, b, c = map(np.array, TRIANGLE)
    flush = [(a + 0.1 * (b - a)).tolist(), (a + 2 * (b - a)).tolist(), (a + 2 * (c - a)).tolist()]
    floor = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
    bare = scene([lamp(TRIANGLE)], FILM)
    np.testing.assert_allclose(film(scene([lamp(TRIANGLE)], FILM, [blocker(flush), blocker(floor, "floor")]), 64), film(bare, 64),
                               rtol=1e-13)


ELL = [[-0.3, -0.3, 0.5], [0.3, -0.3, 0.5], [0.3, -0.1, 0.5], [-0.1, -0.1, 0.5], [-0.1, 0.3, 0.5], [-0.3, 0.3, 0.5]]


def test_pieces_add_up():
    """An L before a square, whole and in two rectangles that overlap; and the square cut in two lamps: the same film."""
    arms = [blocker([ELL[0], ELL[1], ELL[2], [-0.3, -0.1, 0.5]], "one"), blocker([ELL[0], [-0.1, -0.3, 0.5], *ELL[4:]], "two")]
    whole = film(scene([lamp(SQUARE)], FILM, [blocker(ELL)]), 256)
    left = [*SQUARE[:2], [0.1, 0.3, 1.3], [0.1, -0.7, 1.3]]
    right = [[0.1, -0.7, 1.3], [0.1, 0.3, 1.3], *SQUARE[2:]]
    for one in (scene([lamp(SQUARE)], FILM, arms), scene([lamp(left, name="a"), lamp(right, name="b")], FILM, [blocker(ELL)])):
        np.testing.assert_allclose(film(one, 256), whole, rtol=0, atol=MEANS * whole.max())


SKEW = [[[-0.1, -0.2, 0.3], [0.3, 0.1, 0.45], [0.0, 0.4, 0.35]], [[-0.4, 0.0, 0.9], [0.2, -0.3, 0.7], [0.3, 0.3, 0.8]]]


def test_shadows_of_skew_blockers_overlap_in_conics():
    """Two triangles that lie askew, one above the other: 512 nodes and eight times as many agree, and less light comes than past
    either alone."""
    floor = FILM | {"resolution": [3, 2]}
    both = scene([lamp(SQUARE)], floor, [blocker(SKEW[0], "low"), blocker(SKEW[1], "high")])
    coarse, fine = film(both, 512), film(both, 4096)
    assert np.abs(coarse - fine).max() < MEANS * fine.max()
    assert (fine <= np.minimum(*(film(scene([lamp(SQUARE)], floor, [blocker(one)]), 512) for one in SKEW)) + 1e-12).all()


BALL = {"type": "sphere", "center": [0.03, 0.02, 0.5], "radius": 0.21}
SLANT = {"type": "disk", "center": [0.03, 0.02, 0.5], "normal": [0.6, 0, 0.8], "radius": 0.3}
TUBE = {"type": "cylinder", "base": [-0.2, 0.02, 0.5], "axis": [1, 0, 0], "height": 0.4, "radius": 0.13}


@pytest.mark.parametrize(("shape", "shown"), [
    (BALL, math.pi * 0.21**2), (SLANT, 0.64 * math.pi * 0.3**2), (TUBE, 2 * 0.13 * 0.4),
])  # fmt: skip
def test_flux_past_a_shape_in_a_beam(shape, shown):
    """A beam that comes in at cos = 0.8, across the tube and askew on the disk: the floor loses the irradiance across the beam
    times the area that the shape shows it."""
    beam = {"kind": "directional", "id": "beam", "direction": [0, 0.6, -0.8], "irradiance": 3.1}
    floor = PLANE | {"origin": [-0.9, -0.8, 0], "u": [1.8, 0, 0], "v": [0, 2.2, 0], "resolution": [3, 4]}
    flux = film(scene([beam], floor, [{"id": "blocker", "reflectance": 0, "shape": shape}]), 4096).mean() * 1.8 * 2.2
    assert flux == pytest.approx(3.1 * (0.8 * 1.8 * 2.2 - shown), rel=MEANS)


def test_flux_past_a_ball_before_a_point_light():
    """The floor loses what goes into the ball's cone, 2 pi I (1 - cos a), of I times the solid angle of the floor."""
    light = {"kind": "point", "id": "bulb", "position": [0.1, 0.05, 1.2], "intensity": 2.3}
    ball = {"id": "ball", "reflectance": 0, "shape": {"type": "sphere", "center": [0.1, 0.05, 0.7], "radius": 0.14}}
    floor = PLANE | {"origin": [-0.9, -0.8, 0], "u": [1.8, 0, 0], "v": [0, 1.7, 0], "resolution": [4, 3]}
    solid_angle = sum(math.atan2(a * b, 1.2 * math.sqrt(a * a + b * b + 1.44)) for a in (1.0, 0.8) for b in (0.85, 0.85))
    cone = 2 * math.pi * (1 - math.sqrt(1 - (0.14 / 0.5) ** 2))
    assert film(scene([light], floor, [ball]), 4096).mean() * 1.8 * 1.7 == pytest.approx(2.3 * (solid_angle - cone), rel=MEANS)


@strict_kernel
def levels(normals, places, receivers, out):
    for i in range(len(out)):
        n, p, x = normals[i], places[i], receivers[i]
        out[i] = level((n[0], n[1], n[2]), (0.0, 0.0, 0.0), (p[0], p[1], p[2]), (x[0], x[1], x[2]))


def test_levels_keep_their_digits_where_terms_cancel():
    """Points within rounding of a plane through the receiver, 1 to 1e8 m from the origin, against exact fractions."""
    rng = np.random.default_rng(5)
    normals, receivers = rng.normal(size=(2, 1000, 3))
    receivers *= 10 ** rng.uniform(0, 8, size=(1000, 1))
    within = np.cross(normals, rng.normal(size=(1000, 3)))
    places, out = receivers + within, np.empty(1000)
    levels(normals, places, receivers, out)
    exact = [sum(Fraction(n) * (Fraction(p) - Fraction(x)) for n, p, x in zip(*rows, strict=True))
             for rows in zip(normals.tolist(), places.tolist(), receivers.tolist(), strict=True)]
    np.testing.assert_allclose(out, [float(value) for value in exact], rtol=1e-12)


@given(st.integers(3, 9), st.integers(0, 10**6))
@settings(max_examples=50, deadline=None)
def test_convex_parts_tile_a_star(spikes, seed):
    """A star with corners in and out: all parts are convex, and their areas add up to its own."""
    rng = np.random.default_rng(seed)
    angles = np.arange(2 * spikes) * math.pi / spikes
    star = (rng.uniform(0.2, 1, 2 * spikes) * np.exp(1j * angles)).view(float).reshape(-1, 2)
    parts = convex.parts(star)
    assert all(convex.is_convex(star, part) for part in parts)
    assert sum(area(star[list(part)]) for part in parts) == pytest.approx(area(star), rel=1e-12)


def area(flat):
    x, y = flat.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def test_a_frame_keeps_the_width_of_a_sliver():
    """A strip 1 m long and 2e-9 m wide that lies askew: as wide in its own frame as the difference of its corners."""
    a, b = np.array([0.3, 0.1, 0.2]), np.array([1.1, 0.5, 0.6])
    width = np.array([-1.0, 2.0, 0.0]) * 2.0**-30
    one = scene([lamp([a.tolist(), b.tolist(), (b + width).tolist(), (a + width).tolist()])], at([0, 0, 0]))
    flat = Plane.of(one.lights[0].shape).flat
    assert abs(flat[2, 1] - flat[1, 1]) == pytest.approx(np.linalg.norm((b + width) - b), rel=1e-6)
