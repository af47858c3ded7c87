"""Shapes and frames against answers known by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lightproof import geometry
from lightproof.checked import SceneError
from lightproof.geometry import Cap, Cylinder, Disk, Polygon, Sphere

coordinates = st.floats(-1e3, 1e3, allow_subnormal=False).filter(lambda x: x == 0 or abs(x) > 1e-3)
directions = st.tuples(coordinates, coordinates, coordinates).filter(any)


@given(directions)
def test_tangents_make_a_right_handed_frame(normal):
    """t x b = n, all of unit length, for any normal, the south pole included."""
    t, b = geometry.tangents(np.array(normal))
    np.testing.assert_allclose(np.cross(t, b), geometry.unit(normal), atol=1e-14)
    np.testing.assert_allclose([t @ t, b @ b, t @ b], [1, 1, 0], atol=1e-14)


def test_tangents_at_the_south_pole():
    t, b = geometry.tangents(np.array([0.0, 0.0, -1.0]))
    np.testing.assert_allclose(np.cross(t, b), [0, 0, -1])


@pytest.mark.parametrize("length", [1e-200, 1.0, 1e200])
def test_unit_survives_lengths_whose_squares_do_not_exist(length):
    np.testing.assert_allclose(geometry.unit(np.array([3.0, 0, 4.0]) * length), [0.6, 0, 0.8], rtol=1e-15)


def test_areas():
    """A 3-4-5 triangle: 6 m2; a disk, a sphere and a cylinder of radius 2 m: 4 pi, 16 pi, and 12 pi at a height of 3 m."""
    assert Polygon([[0, 0, 7], [3, 0, 7], [0, 4, 7]]).area == 6
    assert Disk([0, 0, 0], [0, 0, 5], 2).area == pytest.approx(4 * np.pi)
    assert Sphere([0, 0, 0], 2).area == pytest.approx(16 * np.pi)
    assert Cylinder([0, 0, 0], [0, 1, 0], 3, 2).area == pytest.approx(12 * np.pi)


def test_two_caps_make_a_sphere():
    """60 and 120 degrees about opposite axes: a quarter and three quarters of 16 pi m2, and only together a whole sphere."""
    small, large = Cap([1, 2, 3], 2, [0, 3, 4], 60), Cap([1, 2, 3], 2, [0, -6, -8], 120)
    assert (small.area, large.area) == (pytest.approx(4 * np.pi), pytest.approx(12 * np.pi))
    assert small.completes(large) and large.completes(small)
    others = [Cap([1, 2, 3], 2, [0, 6, 8], 120), Cap([1, 2, 3], 2, [0, -6, -8], 119.5), Cap([1, 2, 3], 2.1, [0, -6, -8], 120),
              Cap([1, 2, 3], 2, [1e-12, -6, -8], 120)]
    assert not any(small.completes(other) for other in others)


@pytest.mark.parametrize("half_angle", [0, -10, 180, 200])
def test_a_cap_is_neither_nothing_nor_a_whole_sphere(half_angle):
    with pytest.raises(SceneError, match="greater than 0 and less than 180"):
        Cap([0, 0, 0], 1, [0, 0, 1], half_angle)


def test_polygon_front_is_the_counter_clockwise_side():
    corners = [[0, 0, 1], [2, 0, 1], [2, 1, 1], [1, 0.2, 1]]
    assert Polygon(corners).normal.tolist() == [0, 0, 1]
    assert Polygon(corners[::-1]).normal.tolist() == [0, 0, -1]


def test_concave_polygons_are_simple_and_star_shapes_are_not():
    ell = [[0, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0], [1, 2, 0], [0, 2, 0]]
    assert Polygon(ell).area == 3
    angles = np.radians(90 + 144 * np.arange(5))
    with pytest.raises(SceneError, match="cross"):
        Polygon([[float(np.cos(a)), float(np.sin(a)), 0] for a in angles])


def test_camera_frame():
    """Looking along +y with z up: columns to +x, rows down."""
    right, up, forward = geometry.camera_frame((0, 0, 0), (0, 5, 0), (0, 0, 2))
    np.testing.assert_allclose([right, up, forward], [[1, 0, 0], [0, 0, 1], [0, 1, 0]], atol=1e-16)
    with pytest.raises(SceneError, match="up"):
        geometry.camera_frame((0, 0, 0), (0, 0, 5), (0, 0, 1))
    with pytest.raises(SceneError, match="target"):
        geometry.camera_frame((1, 2, 3), (1, 2, 3), (0, 0, 1))
