"""What light must do whatever the scene: properties that tie certified values together, on random scenes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from lightproof import scene_file
from lightproof.certify.engine import certify

few = settings(max_examples=20, deadline=None)


def grid(low, high):
    """Numbers in steps of 1/64, which are exact in binary."""
    return st.integers(round(64 * low), round(64 * high)).map(lambda k: k / 64)


places = st.tuples(grid(-1, 1), grid(-1, 1), grid(0, 0.2))
normals = st.tuples(grid(-0.5, 0.5), grid(-0.5, 0.5), grid(0.5, 1))


def triangle(low, high):
    corner = st.tuples(grid(-1, 1), grid(-1, 1), grid(low, high))
    return st.tuples(corner, corner, corner).filter(lambda t: np.linalg.norm(area_vector(t)) > 0.1)


triangles = triangle(0.3, 1.6)
lamps = st.tuples(grid(-0.5, 0), grid(-0.5, 0), grid(0.2, 0.6), grid(0.2, 0.6), grid(1.0, 1.5)).map(
    lambda k: [(k[0], k[1], k[4]), (k[0], k[1] + k[3], k[4]), (k[0] + k[2], k[1] + k[3], k[4]), (k[0] + k[2], k[1], k[4])])


def area_vector(polygon):
    spokes = np.array(polygon[1:]) - polygon[0]
    return np.cross(spokes[:-1], spokes[1:]).sum(axis=0)


def lamp(polygon, radiance=1.75, name="lamp"):
    return {"kind": "area", "id": name, "radiance": radiance, "shape": shape(polygon)}


def bulb(position, intensity=2.25):
    return {"kind": "point", "id": "bulb", "position": list(position), "intensity": intensity}


def shape(polygon):
    return {"type": "polygon", "vertices": np.asarray(polygon).tolist()}


def plates(polygons):
    return [{"id": f"plate-{i}", "reflectance": 0, "shape": shape(polygon)} for i, polygon in enumerate(polygons)]


def value(lights, film, blockers=()):
    """(n,) Certified values."""
    table = {"title": "a property", "max_bounces": 0, "tolerance": 0.005, "film": film}
    return certify(scene_file.from_table(table | {"light": lights, "surface": plates(blockers)}, "test")).value


def at(place, normal=(0, 0, 1)):
    return {"kind": "points", "quantity": "irradiance", "positions": [np.asarray(place).tolist()],
            "normals": [np.asarray(normal).tolist()]}


def rectangle(origin, u, v):
    return {"kind": "plane", "quantity": "irradiance", "origin": np.asarray(origin).tolist(), "u": np.asarray(u).tolist(),
            "v": np.asarray(v).tolist(), "resolution": [1, 1]}


@given(lamps, triangles, places, normals, st.integers(1, 40))
@few
def test_linear_in_radiance(polygon, blocker, place, normal, factor):
    """k times the radiance, k times the light, behind a blocker too."""
    once, more = (value([lamp(polygon, r)], at(place, normal), [blocker])[0] for r in (1.75, 1.75 * factor))
    assert more == pytest.approx(factor * once, rel=3e-16)


@given(lamps, triangles, triangles, places, normals)
@few
def test_two_lights_add(one, other, blocker, place, normal):
    """Each alone, the other dark, and both: the sum. Lamps and blockers in one plane may overlap, which is refused."""
    assume(all(np.cross(area_vector(a), area_vector(b)).any() for a, b in ((one, other), (one, blocker), (other, blocker))))
    lights = [[lamp(one, a, "one"), lamp(other, b, "other")] for a, b in ((1.75, 3.25), (1.75, 0.0), (0.0, 3.25))]
    both, first, second = (value(pair, at(place, normal), [blocker])[0] for pair in lights)
    assert both == pytest.approx(first + second, rel=1e-15)


@given(lamps, triangles, places, normals, st.integers(-20, 20).map(lambda k: 2.0**k))
@few
def test_scale(polygon, blocker, place, normal, scale):
    """The same scene k times as large: an area light gives the same, a point light 1/k^2 of it."""
    small, large = (value([lamp(np.multiply(k, polygon))], at(np.multiply(k, place), normal), [np.multiply(k, blocker)])[0]
                    for k in (1, scale))
    assert large == small
    small, large = (value([bulb(np.multiply(k, (0.125, 0.25, 1.75)))], at(np.multiply(k, place), normal))[0] for k in (1, scale))
    assert large == pytest.approx(small / scale**2, rel=3e-16)


TURN = np.array([[2, -1, 2], [2, 2, -1], [-1, 2, 2]])  # three times a rotation, in whole numbers


@given(lamps, triangles, places, normals, st.tuples(*[st.integers(-8, 8)] * 3))
@few
def test_rotation_and_translation_change_nothing(polygon, blocker, place, normal, shift):
    """Turned by a rational rotation, scaled by 3 so that it stays exact in binary, and moved by whole metres."""
    def moved(x):
        return np.asarray(x) @ TURN.T + shift

    here = value([lamp(polygon)], at(place, normal), [blocker])[0]
    there = value([lamp(moved(polygon))], at(moved(place), TURN @ normal), [moved(blocker)])[0]
    assert there == pytest.approx(here, rel=3e-16)


@given(lamps, grid(-0.5, 0.5), grid(-0.5, 0.5), triangle(0.25, 0.75))
@settings(max_examples=3, deadline=None)
def test_flux_is_the_same_both_ways(polygon, x, y, blocker):
    """From a lamp to a cell, and from a lamp in the cell's place to a cell in the lamp's, past one blocker."""
    floor = [(x, y, 0.0), (x + 0.25, y, 0.0), (x + 0.25, y + 0.5, 0.0), (x, y + 0.5, 0.0)]
    a, b, _, d = np.array(polygon)
    areas = [np.linalg.norm(area_vector(side)) for side in (floor, polygon)]
    there = value([lamp(polygon)], rectangle(floor[0], (0.25, 0, 0), (0, 0.5, 0)), [blocker])[0]
    back = value([lamp(floor)], rectangle(a, b - a, d - a), [blocker])[0]
    assert there * areas[0] == pytest.approx(back * areas[1], rel=1e-14, abs=1e-16)


@given(lamps, triangles, triangles, places, normals)
@few
def test_a_blocker_never_adds_light(polygon, one, other, place, normal):
    """None, one, two: never more, never less than nothing."""
    lit, shaded, darker = (value([lamp(polygon)], at(place, normal), blockers)[0] for blockers in ([], [one], [one, other]))
    assert lit >= shaded >= darker >= 0


@given(lamps, triangles, places, normals, grid(0.1, 0.9))
@few
def test_a_light_cut_in_two_adds_up(polygon, blocker, place, normal, share):
    """Two parts of a lamp beside each other give what the whole gives, behind a blocker too."""
    (x0, y0, z), (_, y1, _), (x1, _, _), _ = polygon
    middle = x0 + (x1 - x0) * share
    halves = [[(a, y0, z), (a, y1, z), (b, y1, z), (b, y0, z)] for a, b in ((x0, middle), (middle, x1))]
    parts = value([lamp(half, name=f"half-{i}") for i, half in enumerate(halves)], at(place, normal), [blocker])[0]
    assert parts == pytest.approx(value([lamp(polygon)], at(place, normal), [blocker])[0], rel=3e-16, abs=1e-30)


@given(lamps, triangles, places, normals, st.permutations(range(3)))
@few
def test_any_winding_of_a_blocker(polygon, blocker, place, normal, order):
    """Whichever corner comes first and whichever way they run, a blocker hides the same."""
    shades = [value([lamp(polygon)], at(place, normal), [[blocker[i] for i in some]])[0] for some in (range(3), order)]
    assert shades[0] == shades[1]


@given(lamps, places, grid(-0.25, 0), grid(0.05, 0.5))
@few
def test_a_light_through_a_hole_is_the_lights_part(polygon, place, low, width):
    """Four plates leave a square hole in the plane z = 3/4; the receiver sees the part of the lamp that the hole's image on the
    lamp's plane covers."""
    z, high = 0.75, low + width
    shades = [[(a, c, z), (b, c, z), (b, d, z), (a, d, z)] for a, b, c, d in (
        (-64, low, -64, 64), (high, 64, -64, 64), (low, high, -64, low), (low, high, high, 64))]
    through = value([lamp(polygon)], at(place), shades)[0]
    scale = (polygon[0][2] - place[2]) / (z - place[2])
    seen = [[place[i] + (edge - place[i]) * scale for edge in (low, high)] for i in (0, 1)]
    (x0, x1), (y0, y1) = ([min(max(x, polygon[0][i]), polygon[2][i]) for x in seen[i]] for i in (0, 1))
    part = [(x, y, polygon[0][2]) for x, y in ((x0, y0), (x0, y1), (x1, y1), (x1, y0))]
    expected = value([lamp(part)], at(place))[0] if x0 < x1 and y0 < y1 else 0.0
    assert through == pytest.approx(expected, rel=1e-12, abs=1e-16)


@given(triangles, triangles, places)
@settings(max_examples=3, deadline=None)
def test_brute_force_on_a_million_cells(polygon, blocker, place):
    """The engine against a sum over a million cells of a triangular lamp, one ray each, that keeps a thousandth of the light
    in doubt: those cells that the shadow's edge goes through."""
    assume(np.cross(area_vector(polygon), area_vector(blocker)).any())
    x, count = np.array(place), 1000
    exact = value([lamp(polygon)], at(place), [blocker])[0]
    a, b, c = np.array(polygon)
    s, t = np.meshgrid((np.arange(count) + 0.5) / count, (np.arange(count) + 0.5) / count)
    s, t = np.where(s + t > 1, 1 - s, s), np.where(s + t > 1, 1 - t, t)
    rays = a + s[..., None] * (b - a) + t[..., None] * (c - a) - x
    front = area_vector(polygon) / 2
    squared = (rays**2).sum(-1)
    light = 1.75 * np.maximum(rays[..., 2], 0) * np.maximum(-rays @ front, 0) / squared**2 / count**2
    assert exact == pytest.approx((light * ~stopped(rays, np.array(blocker) - x)).sum(), abs=2e-3 * light.sum() + 1e-15)


def stopped(rays, triangle):
    """Whether rays (..., 3) from the origin pass through a triangle before they end."""
    a, b, c = triangle
    turns = np.stack([rays @ np.cross(p, q) for p, q in ((a, b), (b, c), (c, a))])
    normal = np.cross(b - a, c - a)
    slope = rays @ normal
    reach = np.divide(a @ normal, slope, out=np.full(slope.shape, math.inf), where=slope != 0)
    return ((turns > 0).all(axis=0) | (turns < 0).all(axis=0)) & (reach > 0) & (reach < 1)
