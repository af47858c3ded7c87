"""The first reference engine: enclosures that hold, against other formulas, brute force and what physics demands."""

from __future__ import annotations

import math
import runpy

import numpy as np
import pytest
from flint import arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st

from lightproof import scene_file, suite
from lightproof.certify import admission, quadrature
from lightproof.certify.balls import PRECISION, CannotCertify, root
from lightproof.certify.engine import certify
from lightproof.references import read

SECOND = suite.default().root / "references"
RECTANGLE = [[-0.4, -0.7, 1.3], [-0.4, 0.3, 1.3], [0.6, 0.3, 1.3], [0.6, -0.7, 1.3]]
PLANE = {"kind": "plane", "quantity": "irradiance"}
FILM = PLANE | {"origin": [-0.3, -0.4, 0], "u": [0.6, 0, 0], "v": [0, 0.5, 0], "resolution": [3, 2]}


def scene(lights, film, surfaces=(), max_bounces=0, **more):
    """A scene from tables."""
    table = {"title": "a test", "max_bounces": max_bounces, "tolerance": 0.005, "film": film}
    return scene_file.from_table(table | {"light": list(lights), "surface": list(surfaces)} | more, "test")


def lamp(vertices=RECTANGLE, radiance=2.04, name="lamp"):
    """A polygon light."""
    return {"kind": "area", "id": name, "radiance": radiance, "shape": polygon(vertices)}


def blocker(vertices, name="blocker"):
    """A black polygon."""
    return {"id": name, "reflectance": 0, "shape": polygon(vertices)}


def polygon(vertices):
    return {"type": "polygon", "vertices": [list(vertex) for vertex in vertices]}


def at(position, normal=(0, 0, 1)):
    """A film of one point."""
    return {"kind": "points", "quantity": "irradiance", "positions": [list(position)], "normals": [list(normal)]}


def value(*args, **more):
    """The certified value of a film's first element."""
    return certify(scene(*args, **more), [0]).value[0]


def test_the_rule_encloses_what_is_known():
    """exp(s + 2 t) has mean sinh(1) sinh(2) / 2 over the square: inside the ball, which is narrow."""
    with ctx.workprec(PRECISION):
        mean = quadrature.mean(lambda s, t: (s + 2 * t).exp())
        assert mean.overlaps(arb(1).sinh() * arb(2).sinh() / 2)
        assert float(mean.rad()) < 1e-16


@pytest.mark.parametrize("f", [lambda s, t: 1 / (s - arb(1) / 3), lambda s, t: root((s - t) ** 2)], ids=["pole", "kink"])
def test_the_rule_refuses_what_is_not_smooth(f):
    """A pole on the square, and |s - t|: no number comes out."""
    with ctx.workprec(PRECISION), pytest.raises(CannotCertify, match="not smooth enough"):
        quadrature.mean(f)


def test_rectangle_over_its_corner():
    """Lambert's sum under a rectangle's corner: pi L times the form factor of Howell's catalogue."""
    a, b = 1 / 1.3, 0.7 / 1.3
    r, s = math.hypot(1, a), math.hypot(1, b)
    expected = 2.04 / 2 * (a / r * math.atan(b / r) + b / s * math.atan(a / s))
    corner = [[0, 0, 1.3], [0, 0.7, 1.3], [1, 0.7, 1.3], [1, 0, 1.3]]
    assert value([lamp(corner)], at([0, 0, 0])) == pytest.approx(expected, rel=1e-15)


def test_a_light_beneath_the_horizon_gives_nothing():
    """A receiver that faces away, and one behind the light: exactly zero."""
    assert value([lamp()], at([0, 0, 0], [0, 0, -1])) == 0
    assert value([lamp()], at([0, 0, 2], [0, 0, -1])) == 0


@pytest.mark.parametrize(("height", "below"), [(0.2, "centre above the horizon"), (-0.2, "centre below it")])
def test_sphere_cut_by_the_horizon(height, below):
    """The cone of directions in which a sphere of radius 0.5 is seen from 0.9 m, summed ring by ring above the horizon; a sun
    as wide gives the same."""
    shape = {"type": "sphere", "center": [0.9, 0, height], "radius": 0.5}
    light = {"kind": "area", "id": "lamp", "radiance": 3.1, "shape": shape}
    cone = runpy.run_path(str(SECOND / "sphere-light.py"))["cone"]
    distance = math.hypot(0.9, height)
    expected = 3.1 * float(cone(math.asin(height / distance), math.asin(0.5 / distance)))
    assert value([light], at([0, 0, 0])) == pytest.approx(expected, rel=1e-13)
    sun = {"kind": "environment", "id": "sun", "radiance": 3.1, "direction": [-0.9, 0, -height],
           "half_angle": math.degrees(math.asin(0.5 / distance))}
    assert value([sun], at([0, 0, 0])) == pytest.approx(expected, rel=1e-13)


def test_tilted_disk():
    """A disk that leans towards the receiver: the contour's closed form equals the area form, a Gauss sum over the disk."""
    shape = {"type": "disk", "center": [0.3, -0.2, 1.1], "normal": [0.4, 0.1, -1], "radius": 0.35}
    light = {"kind": "area", "id": "lamp", "radiance": 4.3, "shape": shape}
    points, areas, normal = runpy.run_path(str(SECOND / "disk-light.py"))["disk"](shape)
    receiver = np.array([0.1, 0.2, 1]) / math.sqrt(1.05)
    squared = (points**2).sum(-1)
    expected = 4.3 * areas @ ((points @ receiver) * -(points @ normal) / squared**2)
    assert value([light], at([0, 0, 0], [0.1, 0.2, 1])) == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize(("sky", "normal", "expected"), [
    ({"radiance": 1.37}, [3, 1, -2], math.pi * 1.37),
    ({"radiance": 1.37, "extent": "upper"}, [0, 0, 1], math.pi * 1.37),
    ({"radiance": 1.37, "extent": "upper"}, [0, 1, 0], math.pi * 1.37 / 2),
    ({"zenith_radiance": 2.1, "sky": "cie-overcast"}, [0, 0, 1], 7 * math.pi * 2.1 / 9),
    ({"zenith_radiance": 2.1, "sky": "cie-overcast"}, [0, 1, 0], 2 / 3 * (math.pi / 4 + 2 / 3) * 2.1),
    ({"radiance": 9, "direction": [0, -0.6, -0.8], "half_angle": 30}, [0, 0, 1], math.pi * 9 * 0.25 * 0.8),
    ({"radiance": 9, "direction": [0, 1, 0], "half_angle": 10}, [0, 1, 0], 0),
])  # fmt: skip
def test_skies(sky, normal, expected):
    """Whole and half skies, the overcast sky, level and upright, a sun above and below it."""
    light = {"kind": "environment", "id": "sky"} | sky
    assert value([light], at([0, 0, 0], normal)) == pytest.approx(expected, rel=1e-15, abs=0)


def test_a_beam_gives_its_cosine():
    """5 W/m2 across the beam, 60 degrees off the normal: 2.5; from behind: 0."""
    light = {"kind": "directional", "id": "beam", "direction": [0, 3**0.5, -1], "irradiance": 5}
    assert value([light], at([0, 0, 0])) == pytest.approx(2.5, rel=1e-15)
    assert value([light], at([0, 0, 0], [0, 0, -1])) == 0


@given(st.floats(-1, 1), st.floats(-1, 1), st.floats(0.1, 100))
@settings(max_examples=10, deadline=None)
def test_linear_in_radiance(x, y, radiance):
    """Twice the radiance, twice the irradiance, to the last bit."""
    once, twice = (value([lamp(radiance=factor * radiance)], at([x, y, 0])) for factor in (1, 2))
    assert twice == 2 * once


@given(st.floats(0.05, 0.95))
@settings(max_examples=10, deadline=None)
def test_a_light_cut_in_two_adds_up(share):
    """Two parts of a rectangle give each cell what the whole gives."""
    middle = -0.4 + share
    left = [[-0.4, -0.7, 1.3], [-0.4, 0.3, 1.3], [middle, 0.3, 1.3], [middle, -0.7, 1.3]]
    right = [[middle, -0.7, 1.3], [middle, 0.3, 1.3], [0.6, 0.3, 1.3], [0.6, -0.7, 1.3]]
    parts = sum(value([lamp(half)], FILM) for half in (left, right))
    assert parts == pytest.approx(value([lamp()], FILM), rel=1e-15)


L_SHAPE = [[-0.4, -0.7], [0.6, -0.7], [0.6, -0.2], [0.1, -0.2], [0.1, 0.3], [-0.4, 0.3]]
L_PARTS = [[[-0.4, -0.7], [0.6, -0.7], [0.6, -0.2], [-0.4, -0.2]], [[-0.4, -0.2], [0.1, -0.2], [0.1, 0.3], [-0.4, 0.3]]]


def level(corners, z, up=True):
    """Corners in a level plane, front up or down."""
    return [[x, y, z] for x, y in (corners if up else corners[::-1])]


@pytest.mark.parametrize("film", [FILM, FILM | {"origin": [-0.3, -2.2, -0.9], "v": [0, 0.36, 0.48]}], ids=["level", "cut"])
def test_a_concave_light_is_its_parts(film):
    """An L-shaped light and its two rectangles, above the film and cut by its plane."""
    parts = sum(certify(scene([lamp(level(part, 1.3, up=False))], film)).value for part in L_PARTS)
    assert certify(scene([lamp(level(L_SHAPE, 1.3, up=False))], film)).value == pytest.approx(parts, rel=1e-14, abs=0)


def test_a_concave_blocker_is_its_parts():
    """Behind an L and behind its two rectangles a point sees the same, in and around the shadow."""
    for position in ([-0.2, -0.4, 0], [0.4, 0.1, 0], [0.9, -0.9, 0], [-0.7, 0.5, 0.1]):
        whole = value([lamp()], at(position), [blocker(level(L_SHAPE, 0.6))])
        parts = value([lamp()], at(position), [blocker(level(part, 0.6), f"part-{i}") for i, part in enumerate(L_PARTS)])
        assert whole == pytest.approx(parts, rel=1e-14)


millimetres = st.tuples(st.integers(-1200, 1200), st.integers(-1200, 1200), st.integers(-300, 1600))
corner = millimetres.map(lambda c: tuple(x / 1000 for x in c))
triangle = st.lists(corner, min_size=3, max_size=3).filter(
    lambda c: np.linalg.norm(np.cross(np.subtract(c[1], c[0]), np.subtract(c[2], c[0]))) > 0.05)


@given(st.lists(triangle, min_size=1, max_size=2), st.tuples(st.floats(-1, 1), st.floats(-1, 1)))
@settings(max_examples=20, deadline=None)
def test_shadows_at_points(triangles, place):
    """One or two triangles anywhere, even through the horizon or the light: a brute-force sum over 160 x 160 points of the
    light gives the same to a hundredth of the open light, and light is never added nor negative."""
    receiver = at([*place, 0])
    lit = value([lamp()], receiver)
    seen = value([lamp()], receiver, [blocker(t, f"blocker-{i}") for i, t in enumerate(triangles)])
    assert -1e-30 <= seen <= lit * (1 + 1e-15)
    assert seen == pytest.approx(brute_force(np.array([*place, 0.0]), triangles), abs=0.01 * lit)


def brute_force(x, triangles, count=160):
    """Irradiance from the rectangle light past triangles: a midpoint sum with a ray to each point."""
    steps = (np.arange(count) + 0.5) / count
    points = np.stack([*np.meshgrid(-0.4 + steps, -0.7 + steps), np.full((count, count), 1.3)], axis=-1).reshape(-1, 3)
    rays = points - x
    visible = ~np.any([crosses(x, rays, np.array(t)) for t in triangles], axis=0)
    return float(2.04 / count**2 * np.sum(visible * rays[:, 2] ** 2 / (rays**2).sum(-1) ** 2))


def crosses(x, rays, triangle):
    """Whether each segment from x along a ray passes through a triangle (Möller and Trumbore)."""
    a, b = triangle[1] - triangle[0], triangle[2] - triangle[0]
    p = np.cross(rays, b)
    scale = p @ a
    s = x - triangle[0]
    u, v, t = p @ s / scale, rays @ np.cross(s, a) / scale, b @ np.cross(s, a) / scale
    return (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0) & (t < 1)


def test_shadows_in_means():
    """A tilted triangle between light and film: a cell cut where the shadow changes, against the mean of 9 x 9 Gauss points,
    each certified for itself."""
    leaning = [blocker([[-0.5, -0.9, 0.3], [0.7, -0.6, 0.5], [0.2, 0.4, 0.9]])]
    nodes, weights = np.polynomial.legendre.leggauss(9)
    positions = [[-0.3 + 0.1 * (1 + s), -0.4 + 0.125 * (1 + t), 0] for s in nodes for t in nodes]
    film = at([0, 0, 0]) | {"positions": positions, "normals": [[0, 0, 1]] * len(positions)}
    sampled = np.outer(weights, weights).ravel() / 4 @ certify(scene([lamp()], film, leaning)).value
    assert value([lamp()], FILM, leaning) == pytest.approx(sampled, rel=0.002)


@pytest.mark.parametrize("radius", [0.41, 0.07], ids=["umbra", "ring"])
def test_round_shadows(radius):
    """A disk over a disk, one that leaves an umbra and one that leaves a ring of light: the area form gives the same."""
    table = suite.default().scene("disk-blocker").to_table()
    table["surface"][0]["shape"]["radius"] = radius
    table["film"]["resolution"] = [4, 3]
    second = runpy.run_path(str(SECOND / "disk-blocker.py"))["values"](table, [0, 5])
    assert certify(scene_file.from_table(table, "test"), [0, 5]).value == pytest.approx(second, rel=1e-13)


def test_a_camera_straight_above_sees_the_film_below_it():
    """An orthographic camera over a floor of reflectance 0.4: in each pixel 0.4 / pi of what a plane film of the same cells
    receives, with row 0 on top."""
    film = PLANE | {"origin": [-0.3, -0.3, 0], "u": [0.6, 0, 0], "v": [0, 0.6, 0], "resolution": [3, 3]}
    camera = ABOVE | {"origin": [0, 0, 1], "width": 0.6, "up": [0, 1, 0], "resolution": [3, 3]}
    irradiance = certify(scene([lamp()], film)).value.reshape(3, 3)[::-1]
    radiance = certify(scene([lamp()], camera, [FLOOR], 1)).value.reshape(3, 3)
    assert radiance == pytest.approx(0.4 / np.pi * irradiance, rel=1e-14)


LEANING = [[-0.5, -0.9, 0.3], [0.7, -0.6, 0.5], [0.2, 0.4, 0.9]]
ATHWART = [[-0.6, -0.1, 0.8], [0.5, -0.7, 0.35], [0.4, 0.5, 0.6]]
MIRROR = {"id": "wall", "reflectance": 0.5, "shape": polygon([[1, -1, 0], [1, 1, 0], [1, 1, 1], [1, -1, 1]])}
FLOOR = {"id": "floor", "reflectance": 0.4, "shape": polygon([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])}
LOOK = {"kind": "camera", "quantity": "radiance", "projection": "perspective", "target": [0, 0, 0], "up": [0, 0, 1]}
CAMERA = LOOK | {"origin": [0, -0.5, 1], "fov": 10, "resolution": [2, 2]}
ABOVE = LOOK | {"projection": "orthographic", "origin": [0, -1, 1], "width": 1, "resolution": [2, 2]}
BALL = {"id": "ball", "reflectance": 0.5, "shape": {"type": "sphere", "center": [0, 0, 0.6], "radius": 0.1}}
GLOBE = {"id": "wall", "reflectance": 0.5, "radiance": 1.0, "side": "inside",
         "shape": {"type": "sphere", "center": [0, 0, 0], "radius": 1}}


@pytest.mark.parametrize(("table", "reason"), [
    (([lamp()], FILM, [blocker(LEANING), blocker(ATHWART, "other")]), "edges of three polygons"),
    (([lamp()], FILM, [MIRROR], 1), "reflected between surfaces"),
    (([lamp()], FILM, [MIRROR | {"radiance": 1.0}]), "emits light of its own"),
    (([lamp() | {"shape": BALL["shape"]}], at([0, 0, 0.6], [0, 0, 1])), "inside a sphere light"),
    (([], CAMERA | {"origin": [0, 0.1, 1.5]}, [GLOBE]), "does not lie inside"),
    (([], ABOVE | {"origin": [0, 0.1, 0.5]}, [GLOBE]), "a perspective camera"),
    (([lamp()], at([-0.4, -0.9, 1.3], [0, 0, 1])), None),
])  # fmt: skip
def test_refusals(table, reason):
    """What is not covered is refused with the reason, and never guessed; a receiver in the light's plane gets nothing."""
    if reason is None:
        assert certify(scene(*table)).value[0] == 0
        return
    with pytest.raises(CannotCertify, match=reason):
        certify(scene(*table))


def test_a_scene_of_ones_own(tmp_path):
    """No script beside it: admitted on the proof alone, written, and read back as it was."""
    own = scene([lamp()], FILM)
    admitted = admission.admit(own, tmp_path)
    admission.write(tmp_path, {"base": admitted})
    stored = read(tmp_path, own)
    assert stored.second_engine == "none"
    assert (stored.value == admitted.certified.value).all()
    assert (stored.uncertainty >= admitted.certified.uncertainty).all()


def test_engines_that_disagree_admit_nothing(tmp_path):
    """A second engine that is off by 1e-9 of every value: refused, with the difference."""
    own = scene([lamp()], FILM)
    wrong = (certify(own).value * (1 + 1e-9)).tolist()
    script = f"def values(scene, elements):\n    return [{wrong}[element] for element in elements]\n"
    (tmp_path / "test.py").write_text(script)
    with pytest.raises(CannotCertify, match=r"test\.py differs by"):
        admission.admit(own, tmp_path)
