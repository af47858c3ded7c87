"""Camera films of the first engine: shares of area against brute force and closed forms, and what is refused."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest
from flint import arb, ctx, fmpq
from hypothesis import given, settings
from hypothesis import strategies as st

from lightproof import scene_file
from lightproof.certify.balls import PRECISION, CannotCertify
from lightproof.certify.ellipse import Ellipse
from lightproof.certify.engine import certify
from lightproof.geometry import camera_frame

SKY = {"kind": "environment", "id": "sky", "radiance": 1.37}
BALL = {"id": "ball", "reflectance": 0.5, "shape": {"type": "sphere", "center": [0, 0, 0], "radius": 0.5}}
ABOVE = {"kind": "camera", "quantity": "radiance", "projection": "orthographic", "origin": [0, 0, 2], "target": [0, 0, 0],
         "up": [0, 1, 0], "width": 2.0, "resolution": [2, 2]}
FRONT = {"kind": "camera", "quantity": "radiance", "projection": "perspective", "origin": [0.1, -2, 0.3],
         "target": [0, 0, 0.2], "up": [0, 0, 1], "fov": 50.0, "resolution": [4, 3]}


def scene(film, lights=(SKY,), surfaces=(), max_bounces=0):
    """A scene from tables."""
    table = {"title": "a test", "max_bounces": max_bounces, "tolerance": 0.005, "film": film}
    return scene_file.from_table(table | {"light": list(lights), "surface": list(surfaces)}, "test")


def picture(*args, **more):
    """The certified film, row by row."""
    made = scene(*args, **more)
    return certify(made).value.reshape(made.film.grid)


def lamp(vertices, radiance=2.04, name="lamp"):
    return {"kind": "area", "id": name, "radiance": radiance, "shape": polygon(vertices)}


def surface(vertices, name="surface", reflectance=0.0, **more):
    return {"id": name, "reflectance": reflectance, "shape": polygon(vertices)} | more


def polygon(vertices):
    return {"type": "polygon", "vertices": [list(map(float, vertex)) for vertex in vertices]}


def square(x, y, z, half=0.5):
    """A level square that faces up."""
    return [[x - half, y - half, z], [x + half, y - half, z], [x + half, y + half, z], [x - half, y + half, z]]


def rays(film, count):
    """Origins and directions through count x count midpoints of each pixel, (rows, columns, count^2, 3)."""
    right, up, forward = camera_frame(film["origin"], film["target"], film["up"])
    columns, rows = film["resolution"]
    perspective = film["projection"] == "perspective"
    half = math.tan(math.radians(film["fov"]) / 2) if perspective else film["width"] / 2
    x = (2 * (np.arange(columns * count) + 0.5) / count - columns) * half / columns
    y = (rows - 2 * (np.arange(rows * count) + 0.5) / count) * half / columns
    offsets = x[None, :, None] * right + y[:, None, None] * up
    offsets = offsets.reshape(rows, count, columns, count, 3).transpose(0, 2, 1, 3, 4).reshape(rows, columns, -1, 3)
    origin = np.broadcast_to(film["origin"], offsets.shape)
    return (origin, forward + offsets) if perspective else (origin + offsets, np.broadcast_to(forward, offsets.shape))


def brute_force(film, items, sky, count=48):
    """Mean radiance of each pixel: the nearest of some triangles, each (corners, radiance in front), by rays."""
    origins, ways = rays(film, count)
    nearest, shown = np.full(origins.shape[:-1], np.inf), np.full(origins.shape[:-1], sky)
    for corners, radiance in items:
        distance, front = crossing(origins, ways, np.array(corners))
        shown = np.where(distance < nearest, np.where(front, radiance, 0.0), shown)
        nearest = np.minimum(distance, nearest)
    return shown.mean(axis=-1)


def crossing(origins, ways, triangle):
    """How far along rays a triangle is, infinite where they miss it, and whether its front is seen (Möller and Trumbore)."""
    a, b = triangle[1] - triangle[0], triangle[2] - triangle[0]
    p = np.cross(ways, b)
    scale = p @ a
    start = origins - triangle[0]
    q = np.cross(start, a)
    u, v, t = (p * start).sum(-1) / scale, (ways * q).sum(-1) / scale, q @ b / scale
    hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)
    return np.where(hit, t, np.inf), ways @ np.cross(a, b) < 0


millimetres = st.tuples(st.integers(-900, 900), st.integers(-900, 900), st.integers(-900, 900))
corner = millimetres.map(lambda c: tuple(x / 1000 for x in c))
triangle = st.lists(corner, min_size=3, max_size=3).filter(
    lambda c: np.linalg.norm(np.cross(np.subtract(c[1], c[0]), np.subtract(c[2], c[0]))) > 0.05)


@pytest.mark.parametrize("film", [FRONT, FRONT | {"origin": [0.1, -0.4, 0.2], "fov": 100.0},
                                  ABOVE | {"origin": [0.3, -1.1, 1.7]}], ids=["outside", "amid", "orthographic"])
@given(st.lists(triangle, min_size=1, max_size=3))
@settings(max_examples=8, deadline=None)
def test_triangles_before_a_sky(film, triangles):
    """One to three triangles anywhere, also through one another, beside and behind the camera: in each pixel what 48 x 48 rays
    see, to two hundredths."""
    lights = [lamp(t, 1 + i, f"lamp-{i}") for i, t in enumerate(triangles)]
    seen = brute_force(film, [(t, 1 + i) for i, t in enumerate(triangles)], SKY["radiance"])
    assert picture(film, [SKY, *lights]) == pytest.approx(seen, abs=0.02 * (len(triangles) + SKY["radiance"]))


def test_a_concave_outline():
    """An L of three of four quarters, seen from straight above: one pixel each, exactly all or nothing."""
    shape = [[-1, -1, 0], [1, -1, 0], [1, 0, 0], [0, 0, 0], [0, 1, 0], [-1, 1, 0]]
    assert picture(ABOVE, [lamp(shape)]).tolist() == [[2.04, 0], [2.04, 2.04]]


def test_a_tilted_lamp_takes_its_area_times_the_cosine():
    """A triangle before an orthographic camera: the pixels' sum is radiance times area times cosine over a pixel's area, to the
    last digit; moving it along the view changes nothing."""
    corners = [[-0.31, -0.52, 0.11], [0.62, -0.17, -0.4], [0.05, 0.71, 0.3]]
    film = ABOVE | {"resolution": [7, 7]}
    shadow = np.cross(np.subtract(corners[1], corners[0]), np.subtract(corners[2], corners[0]))[2] / 2
    near = picture(film, [lamp(corners)])
    assert near.sum() == pytest.approx(2.04 * shadow / (2 / 7) ** 2, rel=1e-14)
    assert (picture(film | {"origin": [0, 0, 7]}, [lamp(corners)]) == near).all()


def test_a_pixel_is_the_mean_of_its_quarters():
    """Lamp, black square and lit floor: a pixel of floor in penumbra, cut by the square's outline, and one of lamp and black
    beyond, are the means of four of a picture twice as fine."""
    things = {"lights": [lamp(square(0, 0.1, 1.2)[::-1])], "max_bounces": 1, "surfaces": [
        surface(square(0, 0, 0, 0.9), "floor", 0.7), surface(square(0.1, 0, 0.5, 0.3), "blocker")]}
    film = FRONT | {"origin": [0.4, -1.8, 0.8], "target": [0, 0, 0.3], "fov": 66.0}
    for row, column in ((4, 4), (0, 3)):
        coarse = certify(scene(film | {"resolution": [10, 8]}, **things), [10 * row + column]).value[0]
        quarters = [20 * (2 * row + i) + 2 * column + j for i in (0, 1) for j in (0, 1)]
        fine = certify(scene(film | {"resolution": [20, 16]}, **things), quarters).value
        assert fine.min() < fine.max() and coarse == pytest.approx(fine.mean(), rel=1e-14)


def test_a_camera_below_a_blocker_sees_its_shadow():
    """An orthographic camera between floor and blocker: 0.4 / pi of what a plane film of the same cells receives behind it."""
    lights, blocker = [lamp(square(0.2, 0.1, 1.3)[::-1])], surface(square(-0.05, 0.1, 0.6, 0.3), "blocker")
    film = {"kind": "plane", "quantity": "irradiance", "origin": [-0.4, -0.4, 0], "u": [0.8, 0, 0], "v": [0, 0.8, 0],
            "resolution": [3, 3]}
    camera = ABOVE | {"origin": [0, 0, 0.5], "width": 0.8, "resolution": [3, 3]}
    irradiance = picture(film, lights, [blocker])[::-1]
    radiance = picture(camera, lights, [surface(square(0, 0, 0), "floor", 0.4), blocker], max_bounces=1)
    assert radiance == pytest.approx(0.4 / math.pi * irradiance, rel=1e-14)


def test_the_floor_ends_where_it_ends():
    """A floor 40 m long under a sky that it does not block, seen at a grazing angle up to its far edge: 0.4 of the sky's
    radiance where rays meet it, the sky beyond."""
    floor = [[-30, -1, 0], [30, -1, 0], [30, 40, 0], [-30, 40, 0]]
    film = FRONT | {"origin": [0.1, 0.2, 0.3], "target": [0.1, 1.2, 0.28]}
    seen = brute_force(film, [((floor[0], floor[1], floor[2]), 0.4 * 1.37), ((floor[0], floor[2], floor[3]), 0.4 * 1.37)], 1.37)
    shown = picture(film, [SKY], [surface(floor, "floor", 0.4)], 1)
    assert shown == pytest.approx(seen, abs=0.02)
    assert set(shown[0]) == {1.37} and shown[2] == pytest.approx(0.4 * 1.37, rel=1e-15)


def test_backs_are_black():
    """A camera that sees the back of a lamp before a sky, and a floor from below: exactly nothing there."""
    assert picture(ABOVE, [SKY, lamp(square(0, 0, 0, 2)[::-1])]).tolist() == [[0, 0], [0, 0]]
    assert picture(ABOVE, [SKY], [surface(square(0, 0, 0, 2)[::-1], reflectance=0.4)], 1).tolist() == [[0, 0], [0, 0]]


def test_what_is_behind_the_camera_is_not_seen():
    """A lamp behind a pinhole, one behind an orthographic film, and one that an orthographic film cuts in half."""
    assert picture(FRONT, [SKY, lamp([[-9, -3, -9], [9, -3, -9], [0, -3, 9]])]).tolist() == [[1.37] * 4] * 3
    assert picture(ABOVE, [SKY, lamp(square(0, 0, 2.5))]).tolist() == [[1.37] * 2] * 2
    slope = lamp([[-1, -1, 1], [1, -1, 3], [1, 1, 3], [-1, 1, 1]])
    assert picture(ABOVE, [SKY, slope]).tolist() == [[2.04, 1.37]] * 2


def test_two_lamps_through_one_another():
    """Two slopes that cross in the plane x = 0, seen from above: left the one that is higher there, right the other."""
    slopes = [lamp([[-1, -1, a], [1, -1, -a], [1, 1, -a], [-1, 1, a]], radiance, f"lamp-{radiance}")
              for a, radiance in ((0.5, 1), (-0.5, 3))]
    assert picture(ABOVE, slopes).tolist() == [[1, 3], [1, 3]]


def test_a_white_box_vanishes():
    """A box of reflectance 0.5 or 1 under a uniform sky, all reflections counted: half the sky's radiance, or the sky's own."""
    for rho in (0.5, 1):
        shown = picture(FRONT | {"fov": 5.0}, [SKY], [surface(face, f"face-{i}", rho) for i, face in enumerate(box())], "all")
        assert shown == pytest.approx(np.full((3, 4), rho * 1.37), rel=1e-15)


def box(half=0.3):
    """The faces of a cube, seen from outside counter-clockwise."""
    for axis, sign in product(range(3), (-1, 1)):
        corners = []
        for u, v in ((-1, -1), (sign, -sign), (1, 1), (-sign, sign)):
            corner = [u * half, v * half]
            corner.insert(axis, sign * half)
            corners.append(corner if axis != 1 else [v * half, sign * half, u * half])
        yield corners


def test_skies_are_seen():
    """Upwards the overcast sky's zenith is its mean over a small pixel; level, half of the sky above is seen; a sun fills a
    small picture or is not in it."""
    up = FRONT | {"target": [0.1, -2, 1.3], "up": [0, 1, 0], "fov": 0.01, "resolution": [1, 1]}
    overcast = {"kind": "environment", "id": "sky", "sky": "cie-overcast", "zenith_radiance": 3.0}
    assert picture(up, [overcast])[0, 0] == pytest.approx(3, rel=1e-8)
    level = FRONT | {"target": [0.1, 0, 0.3], "resolution": [2, 2]}
    assert picture(level, [SKY | {"extent": "upper"}]).tolist() == [[1.37, 1.37], [0, 0]]
    sun = {"kind": "environment", "id": "sun", "radiance": 9.0, "direction": [0, 0, -1], "half_angle": 0.5}
    assert picture(up, [sun]).tolist() == [[9]]
    assert picture(level, [sun]).tolist() == [[0, 0], [0, 0]]


def test_the_overcast_sky_over_a_wide_pixel():
    """sin(elevation) over 90 degrees of film: its mean by 200 x 200 rays, to a hundred-thousandth."""
    film = FRONT | {"target": [0.1, -1, 1.5], "fov": 90.0, "resolution": [1, 1]}
    _, ways = rays(film, 200)
    sine = np.maximum(ways[..., 2] / np.linalg.norm(ways, axis=-1), -0.5)
    overcast = {"kind": "environment", "id": "sky", "sky": "cie-overcast", "zenith_radiance": 3.0}
    expected = np.where(sine > 0, 1 + 2 * sine, 0).mean()
    assert picture(film, [overcast])[0, 0] == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("rho", [0, 0.5, 1])
def test_a_ball_fills_a_quarter_circle_of_each_pixel(rho):
    """A ball of radius 0.5 in an orthographic picture of 2 x 2 pixels of 0.5 m, from above: pi/4 of each; white, it vanishes."""
    expected = 1.37 * (1 - (1 - rho) * math.pi / 4)
    assert picture(ABOVE | {"width": 1.0}, surfaces=[BALL | {"reflectance": rho}], max_bounces="all") == pytest.approx(
        np.full((2, 2), expected), rel=1e-15)


def test_a_ball_in_perspective():
    """Off the axis it is seen as an ellipse: against 120 x 120 rays a pixel, to a thousandth."""
    film = FRONT | {"origin": [0.3, -0.9, 0.4], "target": [0.2, 0, 0.1], "fov": 80.0}
    origins, ways = rays(film, 120)
    along, squared = (origins * ways).sum(-1), (ways * ways).sum(-1)
    hit = along**2 > squared * ((origins**2).sum(-1) - 0.25)
    expected = 1.37 * (1 - 0.5 * hit.mean(axis=-1))
    assert picture(film, surfaces=[BALL], max_bounces=1) == pytest.approx(expected, abs=1.5e-3)


def test_a_ball_lamp_and_the_places_of_the_camera():
    """A sphere light on black, the same from inside (its back), and behind the camera."""
    light = {"kind": "area", "id": "lamp", "radiance": 3.0, "shape": BALL["shape"]}
    small = ABOVE | {"width": 0.2}
    assert picture(small, [light]).tolist() == [[3, 3], [3, 3]]
    assert picture(FRONT | {"origin": [0, -0.1, 0]}, [SKY, light]).tolist() == [[0] * 4] * 3
    assert picture(ABOVE | {"target": [0, 0, 3]}, [SKY, light]).tolist() == [[1.37] * 2] * 2


@given(st.tuples(*[st.integers(-30, 30)] * 2), st.tuples(*[st.integers(1, 30)] * 2), st.integers(-9, 9))
@settings(max_examples=30, deadline=None)
def test_the_share_of_an_ellipse(start, size, shear):
    """A sheared circle of radius 1 and a rectangle anywhere, also touching it: against a midpoint sum."""
    (x, y), (w, h), b = (fmpq(start[0], 16), fmpq(start[1], 16)), (fmpq(size[0], 16), fmpq(size[1], 16)), fmpq(shear, 10)
    with ctx.workprec(PRECISION):
        ellipse = Ellipse.of((fmpq(1), b, fmpq(1), fmpq(0), fmpq(0), fmpq(-1)))
        share = ellipse.share(((x, y), (x + w, y), (x + w, y + h), (x, y + h)))
    steps = (np.arange(300) + 0.5) / 300
    u, v = float(x) + float(w) * steps[:, None], float(y) + float(h) * steps
    assert float(share.mid()) == pytest.approx((u**2 + 2 * float(b) * u * v + v**2 <= 1).mean(), abs=3e-3)
    assert share.rad() < arb(1e-15)


@pytest.mark.parametrize(("made", "reason"), [
    ((ABOVE, [SKY, lamp(square(0, 0, 0)), lamp(square(0.2, 0, 0), name="other")]), "lie in one another"),
    ((ABOVE, [lamp(square(0, 0, 2))]), "camera lies on 'lamp'"),
    ((FRONT | {"origin": [0.1, 0.1, 0]}, [lamp(square(0, 0, 0))]), "camera lies on 'lamp'"),
    ((FRONT, [SKY], [surface(square(0, 0, -1), "floor", 0.4), surface(square(0, 0, 1)[::-1], "ceiling", 0.4)], 2), "and on"),
    ((FRONT, [SKY], [BALL, surface(square(0, 0, -1), "floor", 0.4)], 1), "may see the sphere 'ball'"),
    ((FRONT, [SKY], [surface(square(0, 0, 0), "floor", 0.4, radiance=1.0)], 1), "emits light of its own"),
    ((FRONT, [{"kind": "environment", "id": "sun", "radiance": 9.0, "direction": [0, -1, 0], "half_angle": 5}]), "rim of 'sun'"),
    ((FRONT | {"origin": [0, -0.5, 0]}, [SKY], [BALL]), "camera lies on the sphere"),
    ((ABOVE | {"origin": [0, 0, 0.3], "target": [0, 0, 0]}, [SKY], [BALL]), "before the camera to behind"),
    ((FRONT, [SKY | {"extent": "upper"}], [BALL], 1), "not the same everywhere"),
    ((FRONT, [SKY, {"kind": "point", "id": "bulb", "position": [1, 1, 1], "intensity": 1.0}], [BALL], 1), "from one side"),
])  # fmt: skip
def test_refusals(made, reason):
    """What is not covered, or not defined, is refused with the reason."""
    with pytest.raises(CannotCertify, match=reason):
        picture(*made)
