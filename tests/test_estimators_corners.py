"""Where light is easily got wrong: far blockers, closed bodies, cameras that count no reflection, several disks."""

from __future__ import annotations

import math

import numpy as np
import pytest
from test_estimators import DISK, area_light, at_points, method, scene

from lightproof import suite
from lightproof.renderers.registry import METHODS, OURS

BEAM = {"id": "sun", "kind": "directional", "direction": [0.3, 0, -1], "irradiance": 3.0}
ROOF = {"id": "roof", "reflectance": 0, "shape": {
    "type": "polygon", "vertices": [[-9, -9, 3], [9, -9, 3], [9, 9, 3], [-9, 9, 3]]}}
BALL = {"id": "ball", "reflectance": 0, "shape": {"type": "sphere", "center": [0, 0, 0.5], "radius": 0.3}}
LAMP = area_light({"type": "polygon", "vertices": [[-1, -1, 2], [-1, 1, 2], [1, 1, 2], [1, -1, 2]]})


def able(described):
    """The names of ours that do a scene, one for each class."""
    from importlib import import_module

    for target, name in {entry.target: entry.name for entry in reversed(METHODS.values()) if entry.worker == OURS}.items():
        module, cls = target.split(":")
        if getattr(import_module(module), cls)(name, 1).unsupported(described) is None:
            yield name


def test_a_roof_above_everything_hides_the_beam():
    """A receiver at the origin under a roof of 18 m at 3 m, in a slanting beam: no light at all, for every method."""
    covered = scene([BEAM], at_points([[0, 0, 0]]), (ROOF,))
    names = list(able(covered))
    assert {"mc-area", "path"} <= set(names)
    for name in names:
        assert method(name, covered).render(256, 1).film[0] == 0, name


def test_a_ball_in_a_beam_takes_its_cross_section():
    """Of the flux through 2 x 2 m of floor, a ball of radius 0.3 m keeps E pi r^2, whatever the slant."""
    film = {"kind": "plane", "quantity": "irradiance", "origin": [-1, -1, 0], "u": [2, 0, 0], "v": [0, 2, 0],
            "resolution": [2, 2]}
    shadowed = scene([BEAM], film, (BALL,))
    expected = 3.0 / math.hypot(1, 0.3) - 3.0 * math.pi * 0.3**2 / 4
    for name in ("mc-area", "mc-area/float64", "path"):
        rendering = method(name, shadowed).render(1 << 17, 3)
        error = math.sqrt(rendering.variance.sum()) / 4
        assert abs(rendering.film.mean() - expected) < 4.5 * error, name


def test_a_camera_that_counts_no_reflection_sees_only_what_shines():
    """square-light-seen with max_bounces 0: the floor is black."""
    lit = suite.default().scene("square-light-seen")
    dark = scene([light.to_table() for light in lit.lights], lit.film.to_table(), [each.to_table() for each in lit.surfaces])
    names = list(able(dark))
    assert {"analytic", "mc-area", "path", "riemann-area", "mc-cosine"} <= set(names)
    for name in names:
        assert not method(name, dark).render(64, 1).film.any(), name


def test_no_light_gets_into_a_black_ball():
    """Points inside a black ball under a lamp outside: nothing."""
    inside = scene([LAMP], at_points([[0, 0, 0.5], [0.1, 0, 0.4]]), (BALL,))
    for name in able(inside):
        assert not method(name, inside).render(1024, 1).film.any(), name


def test_points_on_a_ball_are_not_in_its_own_shadow():
    """The top of the ball, facing the lamp: Lambert's formula for a square on the axis, 1.2 m above."""
    top = scene([LAMP], at_points([[0, 0, 0.8]]), (BALL,))
    a = 1 / 1.2
    expected = 2.04 * 4 * a / math.hypot(1, a) * math.atan(a / math.hypot(1, a))
    for name in able(top):
        rendering = method(name, top).render(1 << 14, 1)
        error = 1e-3 * expected if rendering.variance is None else math.sqrt(rendering.variance[0]) + 1e-7 * expected  # float32
        assert abs(rendering.film[0] - expected) < 4.5 * error, name


@pytest.mark.parametrize("first", ["below", "between"])
def test_a_disk_below_the_receiver_shades_nothing(first):
    """Light, one disk between, one below the receivers, in either order: as if the lowest were not there."""
    between = {"id": "between", "reflectance": 0, "shape": DISK | {"center": [0.1, 0, 0.4], "radius": 0.2}}
    below = {"id": "below", "reflectance": 0, "shape": DISK | {"center": [0.1, 0, -0.5], "radius": 0.3}}
    film = at_points([[0.1, 0, 0], [0.4, 0.1, 0], [0.9, 0.3, 0]])
    both = scene([area_light(DISK)], film, (below, between) if first == "below" else (between, below))
    alone = scene([area_light(DISK)], film, (between,))
    np.testing.assert_array_equal(method("analytic", both).render(1, 0).film, method("analytic", alone).render(1, 0).film)


def test_points_of_a_wall_that_face_elsewhere_have_no_closed_form():
    """A point of the sphere's wall whose normal does not face the centre: refused, and not taken for one that does."""
    globe = {"id": "wall", "reflectance": 0.5, "radiance": 0.83, "side": "inside",
             "shape": {"type": "sphere", "center": [0, 0, 0], "radius": 1}}
    for normal, accepted in (((-1, 0, 0), True), ((-1, 0, 1), False), ((1, 0, 0), False)):
        inside = scene([], at_points([[1, 0, 0]], normal), (globe,), "all")
        assert ("analytic" in able(inside)) is accepted


def test_what_reflects_still_shades_the_floor():
    """A camera over a floor in the shadow of a square that reflects too: analytic shows soft-shadow-picture's umbra, black."""
    picture, umbra = suite.default().scene("soft-shadow-picture"), 9 * 16 + 7
    assert suite.default().reference(picture).value[umbra] == 0
    assert method("analytic", picture).render(64, 0).film[umbra] < 1e-12


@pytest.mark.parametrize("name", ["mc-cosine", "mc-hemisphere"])
@pytest.mark.parametrize("case", ["hard-approach", "hard-approach:sphere"])
def test_directions_meet_a_lamp_that_is_nearer_than_float32_tells(case, name):
    """Before a lamp's middle, edge and corner, down to 4e-10 m: what the receiver sees of it, within five standard errors."""
    near = suite.default().scene(case)
    exact, rendering = suite.default().reference(near).value, method(name, near).render(1 << 16, 1)
    error = np.sqrt(rendering.variance) + 1e-5 * exact
    assert (np.abs(rendering.film - exact) < 5 * error).all()
