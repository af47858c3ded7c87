"""Light reflected again and again, as the first engine has it: against sums written out here, against itself where two ways lead
to one answer, and refused where the arrangement is not quite the one that has an answer."""

from __future__ import annotations

import math

import numpy as np
import pytest
from flint import arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st

from lightproof import scene_file
from lightproof.certify import cones, direct, perpendicular, series
from lightproof.certify.balls import PRECISION, CannotCertify, exact
from lightproof.certify.engine import certify
from lightproof.geometry import Polygon

CENTER, RADIUS = [0.3, -0.2, 0.4], 1.7
ON_WALL = {"kind": "points", "quantity": "irradiance", "positions": [[2.0, -0.2, 0.4], [0.3, -0.2, -1.3]],
           "normals": [[-1, 0, 0], [0, 0, 1]]}
INSIDE = ON_WALL | {"positions": [[0.9, 0.1, 0.8], [0.3, -0.2, 0.4]], "normals": [[1, 2, -2], [0, 1, 0]]}
CAMERA = {"kind": "camera", "quantity": "radiance", "projection": "perspective", "origin": [0.9, -0.7, -0.1],
          "target": [-0.6, 0.4, 1.1], "up": [0, 0, 1], "fov": 70, "resolution": [4, 3]}
BULB = {"id": "bulb", "kind": "point", "position": CENTER, "intensity": 2.3}
ASIDE = BULB | {"position": [0.7, 0.1, 0.2]}
BEAM = {"id": "sun", "kind": "directional", "direction": [0, 0, -1], "irradiance": 4.1}
BOUNCES = (0, 1, 2, 7, "all")


def scene(surfaces, film, lights=(), max_bounces="all"):
    table = {"title": "a test", "max_bounces": max_bounces, "tolerance": 0.005, "film": film}
    return scene_file.from_table(table | {"light": list(lights), "surface": list(surfaces)}, "test")


def value(*args, **more):
    return certify(scene(*args, **more)).value


def globe(reflectance, radiance=0.0, radius=RADIUS, side="inside", name="wall"):
    shape = {"type": "sphere", "center": CENTER, "radius": radius}
    return {"id": name, "shape": shape, "reflectance": reflectance, "radiance": radiance, "side": side}


def zones(half_angle, first, second, axis=(-0.6, 0.3, 0.9)):
    """Two caps that make a sphere; `first` and `second` are their reflectances and radiances."""
    ends = (("lamp", axis, half_angle, first), ("rest", [-x for x in axis], 180 - half_angle, second))
    return [globe(*light, name=name) | {"shape": {"type": "cap", "center": CENTER, "radius": RADIUS, "axis": list(way),
                                                  "half_angle": angle}} for name, way, angle, light in ends]


def polygon(name, vertices, reflectance, radiance=0.0):
    return {"id": name, "shape": {"type": "polygon", "vertices": vertices}, "reflectance": reflectance, "radiance": radiance}


def box(low, high, reflectance, radiance=0.0):
    """Six walls that face inward."""
    (a, b, c), (d, e, f) = low, high
    walls = {"floor": [[a, b, c], [d, b, c], [d, e, c], [a, e, c]], "ceiling": [[a, b, f], [a, e, f], [d, e, f], [d, b, f]],
             "west": [[a, b, c], [a, e, c], [a, e, f], [a, b, f]], "east": [[d, b, c], [d, b, f], [d, e, f], [d, e, c]],
             "south": [[a, b, c], [a, b, f], [d, b, f], [d, b, c]], "north": [[a, e, c], [d, e, c], [d, e, f], [a, e, f]]}
    return [polygon(name, vertices, reflectance, radiance) for name, vertices in walls.items()]


def powers(ratio, last):
    """1 + ratio + ... + ratio^last."""
    return sum(ratio**k for k in range(last + 1)) if last != "all" else 1 / (1 - ratio)


@pytest.mark.parametrize("last", BOUNCES)
def test_a_bulb_between_two_zones_is_a_matrix_power(last):
    """(E_1, E_2) = D (1 + F + F^2 + ...) with F_ij = rho_j A_j / A: both zones receive alike, each sends back its own part."""
    part = math.sin(math.radians(70) / 2) ** 2
    step = np.array([[0.82 * part, 0.35 * (1 - part)]] * 2)
    total = np.linalg.inv(np.eye(2) - step) if last == "all" else sum(np.linalg.matrix_power(step, k) for k in range(last + 1))
    expected = total @ np.full(2, 2.3 / RADIUS**2)
    assert value(zones(70, (0.82,), (0.35,)), ON_WALL, [BULB], last) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("last", BOUNCES)
def test_a_lamp_in_the_wall_lights_all_of_it_alike(last):
    """E = pi L f (1 + rho + ...), f the lamp's share of the area."""
    expected = math.pi * 2.7 * math.sin(math.radians(34) / 2) ** 2 * powers(0.6, last)
    assert value(zones(34, (0.6, 2.7), (0.6,)), ON_WALL, max_bounces=last) == pytest.approx([expected] * 2, rel=1e-14)


@pytest.mark.parametrize("last", BOUNCES)
@pytest.mark.parametrize("film", [ON_WALL, INSIDE, CAMERA | {"resolution": [40, 30]}], ids=["wall", "inside", "camera"])
def test_zones_that_are_alike_are_a_sphere(last, film):
    """A glowing sphere around a bulb is the same whole and cut in two; on the wall and by camera wherever the bulb is."""
    bulb = BULB if film is INSIDE else ASIDE
    pair = ([globe(0.6, 0.4)], zones(41, (0.6, 0.4), (0.6, 0.4)))
    whole, cut = (certify(scene(surfaces, film, [bulb], last), [0, 1]).value for surfaces in pair)
    assert cut == pytest.approx(whole, rel=1e-14)


@pytest.mark.parametrize("last", BOUNCES)
def test_inside_a_sphere_that_glows_irradiance_is_pi_times_radiance(last):
    """At any point that faces anywhere, and on a plane across."""
    radiance = value([globe(0.6, 0.4)], CAMERA, (), last)[0]
    plane = {"kind": "plane", "quantity": "irradiance", "origin": [-0.3, -0.7, 0.1], "u": [1.1, 0.2, 0.3], "v": [0, 0.9, 0.4],
             "resolution": [2, 1]}
    assert radiance == pytest.approx(0.4 * powers(0.6, last), rel=1e-15)
    for film in (INSIDE, plane, ON_WALL):
        assert value([globe(0.6, 0.4)], film, (), last) == pytest.approx([math.pi * radiance] * 2, rel=1e-15)


@pytest.mark.parametrize("last", BOUNCES)
def test_concentric_spheres_are_a_matrix_power(last):
    """The inner sees the outer alone, the outer k = (r1/r2)^2 of the inner."""
    k = (0.64 / RADIUS) ** 2
    seen, kept, own = np.array([[0, 1], [k, 1 - k]]), np.diag([0.37, 0.72]), math.pi * np.array([1.1, 0.83])
    step = seen @ kept
    total = np.linalg.inv(np.eye(2) - step) if last == "all" else sum(np.linalg.matrix_power(step, n) for n in range(last + 1))
    film = ON_WALL | {"positions": [[0.3, -0.2, 1.04], [2.0, -0.2, 0.4]], "normals": [[0, 0, 1], [-1, 0, 0]]}
    spheres = [globe(0.37, 1.1, 0.64, "outside", "core"), globe(0.72, 0.83)]
    assert value(spheres, film, (), last) == pytest.approx(total @ seen @ own, rel=1e-14)


def test_concentric_spheres_as_textbooks_have_them():
    """B2 = M2 / (1 - rho2 (k rho1 + 1 - k)), and the inner sphere receives B2."""
    k = (0.64 / RADIUS) ** 2
    film = ON_WALL | {"positions": [[0.3, -0.2, 1.04]], "normals": [[0, 0, 1]]}
    expected = math.pi * 0.83 / (1 - 0.72 * (k * 0.37 + 1 - k))
    assert value([globe(0.37, 0, 0.64, "outside", "core"), globe(0.72, 0.83)], film) == pytest.approx([expected], rel=1e-15)


@given(st.floats(0, 1 - 1e-6), st.integers(0, 200))
def test_series(ratio, last):
    """The sum written out, and (1 - ratio)(1 + ... + ratio^n) = 1 - ratio^(n+1), both in balls of 128 bits."""
    with ctx.workprec(PRECISION):
        rho, total = arb(exact(ratio)), series.geometric(exact(ratio), last)
        assert total.overlaps(sum((rho**k for k in range(last + 1)), arb(0)))
        assert ((1 - rho) * total).overlaps(1 - rho ** (last + 1))
        assert total.rel_accuracy_bits() > 100


def test_nearly_white_walls_lose_no_digit():
    """Reflectance 1 - 1e-6: a million times the emission; after a million reflections 1 - 1/e of it; white: n + 1 times."""
    rho = 1 - 1e-6
    assert value([globe(rho, 0.5)], ON_WALL) == pytest.approx([math.pi * 0.5 / (1 - rho)] * 2, rel=1e-15)
    cut = -math.expm1((10**6 + 1) * math.log1p(-(1 - rho))) / (1 - rho)
    assert value([globe(rho, 0.5)], ON_WALL, (), 10**6) == pytest.approx([math.pi * 0.5 * cut] * 2, rel=1e-14)
    assert value([globe(1, 0.5)], ON_WALL, (), 40) == pytest.approx([math.pi * 0.5 * 41] * 2, rel=1e-15)


@settings(max_examples=50)
@given(st.lists(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), min_size=3, max_size=3))
def test_a_triangle_in_a_circle(corners):
    """Against scan lines: at each height the chord of the circle and the triangle's, to 1 in 1,000 of the circle."""
    (ax, ay), (bx, by), (cx, cy) = corners
    turn = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if abs(turn) < 1e-3:
        return
    loop = corners if turn > 0 else corners[::-1]
    heights = (np.arange(20_000) + 0.5) / 10_000 - 1
    low, high = -np.sqrt(1 - heights**2), np.sqrt(1 - heights**2)
    for (x, y), (u, v) in zip(loop, loop[1:] + loop[:1], strict=True):
        inner = (u - x) * (heights - y)  # (v - y) (place - x) <= inner on the left of the edge
        with np.errstate(divide="ignore", invalid="ignore"):
            edge = x + inner / (v - y)
        high = np.where(v > y, np.minimum(high, edge), high)
        low = np.where(v < y, np.maximum(low, edge), low)
        if v == y:
            high = np.where(inner >= 0, high, low)
    expected = np.maximum(high - low, 0).sum() / 10_000
    with ctx.workprec(PRECISION):
        assert float(cones.in_circle([(arb(x), arb(y)) for x, y in loop]).mid()) == pytest.approx(expected, abs=3e-3)


def test_a_zone_and_a_core_fill_their_shares_of_the_picture():
    """Emission alone, by a million rays: the pixels' means of what the first thing on each ray emits."""
    for surfaces, camera in ((zones(34, (0.6, 2.7), (0.6,)), CAMERA),
                             ([globe(0.3, 2.7, 0.64, "outside", "core"), globe(0.5)], CAMERA | {"origin": [1.5, -0.9, 0.3]})):
        made = scene(surfaces, camera, (), 0)
        assert certify(made).value == pytest.approx(by_rays(made, 300), abs=0.01)


def by_rays(made, side):
    """Mean emission seen in each pixel of CAMERA's resolution, `side` x `side` rays each."""
    film = made.film
    forward = np.subtract(film.target, film.origin) / np.linalg.norm(np.subtract(film.target, film.origin))
    right = np.cross(forward, film.up) / np.linalg.norm(np.cross(forward, film.up))
    places = (np.arange(side * np.array(film.resolution)[:, None].max()) + 0.5) / side
    columns, rows = film.resolution
    x = film.half_extent[0] * (2 * places[: side * columns] / columns - 1)
    y = film.half_extent[1] * (1 - 2 * places[: side * rows] / rows)
    rays = forward + x[None, :, None] * right + y[:, None, None] * np.cross(right, forward)
    seen = emission(made, np.array(film.origin), rays / np.linalg.norm(rays, axis=-1, keepdims=True))
    return seen.reshape(rows, side, columns, side).mean(axis=(1, 3)).ravel()


def emission(made, eye, rays):
    """What is emitted towards the eye from inside the larger sphere, with a smaller one or two zones in it."""
    first, second = made.surfaces
    offset = np.subtract(CENTER, eye)
    along = rays @ offset
    if first.side == "outside":
        return np.where((along > 0) & (offset @ offset - along**2 < first.shape.radius**2), first.radiance, second.radiance)
    hit = rays * (along + np.sqrt(along**2 - offset @ offset + RADIUS**2))[..., None] - offset
    axis = np.array(first.shape.axis) / np.linalg.norm(first.shape.axis)
    return np.where(hit @ axis > RADIUS * math.cos(math.radians(first.shape.half_angle)), first.radiance, second.radiance)


DYADIC = ([-1.25, -0.5, 0.25], [1.875, 2.625, 3.375])
MIDDLE = BULB | {"position": [0.3125, 1.0625, 1.8125]}
FLOOR = {"kind": "plane", "quantity": "irradiance", "origin": [-1.25, -0.5, 0.25], "u": [3.125, 0, 0], "v": [0, 3.125, 0],
         "resolution": [2, 1]}


@pytest.mark.parametrize("last", [1, 4, "all"])
def test_what_a_cube_sends_back_is_a_part_of_what_arrives(last):
    """The mean over half a wall: the direct mean, integrated over the cell, times 1 + rho + ..."""
    straight = value([], FLOOR, [MIDDLE], 0)
    assert straight == pytest.approx([4 * math.pi * 2.3 / 6 / 3.125**2] * 2, rel=1e-12)
    assert value(box(*DYADIC, 0.6), FLOOR, [MIDDLE], last) == pytest.approx(straight * powers(0.6, last), rel=1e-12)


@pytest.mark.parametrize("last", [0, 3, "all"])
def test_a_room_that_glows_is_a_furnace_whatever_its_shape(last):
    """A long low box, a glowing cube with a bulb in it: E = pi L (1 + rho + ...), and the bulb's light beside it."""
    room = box([-2.1, -0.3, 0.1], [3.7, 1.1, 0.9], 0.7, 0.83)
    film = {"kind": "points", "quantity": "irradiance", "positions": [[3.69, 1.0, 0.2], [0.5, 0.2, 0.1]],
            "normals": [[1, -2, 2], [0, 0, 1]]}
    assert value(room, film, (), last) == pytest.approx([math.pi * 0.83 * powers(0.7, last)] * 2, rel=1e-15)
    both = value(box(*DYADIC, 0.6, 0.83), FLOOR, [MIDDLE]) - value(box(*DYADIC, 0.6), FLOOR, [MIDDLE])
    assert both == pytest.approx([math.pi * 0.83 / 0.4] * 2, rel=1e-14)


LIT = polygon("floor", [[0, -0.9, 0], [2.7, -0.9, 0], [2.7, 1.2, 0], [0, 1.2, 0]], 0.57)
WALL = {"kind": "plane", "quantity": "irradiance", "origin": [0, -1.3, 0.2], "u": [0, 2.6, 0], "v": [0, 0, 1.8],
        "resolution": [3, 2]}
PATCH = WALL | {"origin": [0, 0.1, 0.7], "u": [0, 0.4, 0], "v": [0, 0, 0.3], "resolution": [2, 1]}


@pytest.mark.parametrize("direction", [[0, 0, -1], [0.6, 0.3, -1.1]])
def test_a_lit_floor_is_a_lamp(direction):
    """Its radiance is rho E cos / pi; a strip beside it adds its own light."""
    cosine = -direction[2] / math.hypot(*direction)
    lamp = {"id": "floor", "kind": "area", "shape": LIT["shape"], "radiance": 0.57 * 4.1 * cosine / math.pi}
    beam = BEAM | {"direction": direction}
    expected = value([], PATCH, [lamp], 0)
    assert value([LIT], PATCH, [beam], 1) == pytest.approx(expected, rel=1e-15)
    strip = polygon("strip", [[0.3, 1.2, 0], [1.7, 1.2, 0], [1.7, 2.1, 0], [0.3, 2.1, 0]], 0.9)
    alone = value([strip], PATCH, [beam], 1)
    assert value([LIT, strip], PATCH, [beam], "all") == pytest.approx(expected + alone, rel=1e-15)


def test_two_beams_add():
    """On the wall and on the floor: a beam that the wall faces arrives straight too."""
    second = {"id": "lamp", "kind": "directional", "direction": [-1, 0, -1], "irradiance": 1.3}
    floor = polygon("floor", [[0.1, -0.9, 0], [2.7, -0.9, 0], [2.7, 1.2, 0], [0.1, 1.2, 0]], 0.57)
    film = {"kind": "points", "quantity": "irradiance", "positions": [[0, 0.2, 0.9], [0, -1.1, 0.3]], "normals": [[1, 0, 0]] * 2}
    alone = value([floor], film, [BEAM], 1), value([floor], film, [second], 1)
    assert value([floor], film, [BEAM, second], 1) == pytest.approx(sum(alone), rel=1e-14)
    assert (alone[1] > 1.3 / math.sqrt(2)).all()


@pytest.mark.parametrize("beside", [-1.3, -0.9, 1.2, 3.1])
def test_perpendicular_rectangles_down_to_the_line_where_they_meet(beside):
    """Cells that stay off the line, or are beside the light: as Lambert's formula integrates. Halves of a cell average to it."""
    lamp = {"id": "floor", "kind": "area", "shape": LIT["shape"], "radiance": 1.3}
    film = WALL | {"origin": [0, beside, 0], "v": [0, 0, 3.2]}
    made = scene([], film, [lamp], 0)
    assert perpendicular.covers(made)
    with ctx.workprec(PRECISION):
        whole, smooth = perpendicular.solve(made), direct.solve(made)
        for element in (3, 5):
            assert whole(element).overlaps(smooth(element))
        halves = perpendicular.solve(scene([], film | {"resolution": [3, 4]}, [lamp], 0))
        for element in range(3):
            assert ((halves(element) + halves(element + 3)) / 2).overlaps(whole(element))


def test_a_turned_corner_is_the_same_corner():
    """The whole arrangement turned by a 3-4-5 angle, every number exact."""
    turn = np.array([[3, -4, 0], [4, 3, 0], [0, 0, 5]])
    lamp = {"id": "floor", "kind": "area", "radiance": 1.3, "shape": {"type": "polygon", "vertices": None}}
    corners, edges = np.array([[0, -1, 0], [2, -1, 0], [2, 1, 0], [0, 1, 0]]), np.array([[0, -1, 0], [0, 2, 0], [0, 0, 2]])
    values = []
    for matrix, size in ((np.eye(3), 1), (turn, 5)):
        lamp["shape"]["vertices"] = (corners @ matrix.T).tolist()
        origin, u, v = (edges @ matrix.T).tolist()
        values.append(value([], WALL | {"origin": origin, "u": u, "v": v}, [lamp | {"radiance": 1.3}], 0))
        assert Polygon(lamp["shape"]["vertices"]).area == pytest.approx(4 * size**2)
    np.testing.assert_allclose(*values, rtol=1e-15)


def without(walls, name):
    return [wall for wall in walls if wall["id"] != name]


def prism(outline, height, reflectance, radiance):
    """A room over a floor whose corners run counter-clockwise, as seen from above."""
    low, high = [[[x, y, z] for x, y in outline] for z in (0, height)]
    ends = [polygon("floor", low, reflectance, radiance), polygon("ceiling", high[::-1], reflectance, radiance)]
    sides = [[low[i], low[i - 1], high[i - 1], high[i]] for i in range(len(low))]
    return ends + [polygon(f"side-{i}", side, reflectance, radiance) for i, side in enumerate(sides)]


def turned(walls):
    """The same walls facing outward."""
    return [wall | {"shape": wall["shape"] | {"vertices": wall["shape"]["vertices"][::-1]}} for wall in walls]


ROOM = box([-1, -1, -1], [1, 1.5, 2], 0.5, 1.0)
ELL = prism([[-1, -1], [2, -1], [2, 1], [1, 1], [1, 2], [-1, 2]], 2, 0.5, 1.0)
LID = polygon("lid", [[1, 0, 1], [2, 0, 1], [2, 1, 1], [1, 1, 1]], 0)
RAMP = polygon("ramp", [[3, -1, 0], [3, -1, 1], [3, 1, 1], [3, 1, 0]], 0.4)
REFUSED = {
    "eye outside": (([globe(0.5, 1)], CAMERA | {"origin": [0.3, -0.2, 2.3]}), "does not lie inside"),
    "bulb outside": (([globe(0.5)], ON_WALL, [BULB | {"position": [3, 0, 0]}]), "does not lie inside"),
    "wall facing out": (([globe(0.5, 1)], ON_WALL | {"normals": [[1, 0, 0], [0, 0, 1]]}), "does not face the centre"),
    "sun in a sphere": (([globe(0.5)], ON_WALL, [BEAM]), "point lights are covered"),
    "bulb aside of zones": ((zones(40, (0.5,), (0.6,)), ON_WALL, [ASIDE]), "off the centre"),
    "inside zones": ((zones(40, (0.5, 1), (0.5,)), INSIDE), "differs from place to place"),
    "zones seen from between": ((zones(90, (0.5, 1), (0.5,)), CAMERA | {"target": [3.9, -0.7, 1.9]}), "no ellipse"),
    "core too large": (([globe(0.5, 1, 1.8, "outside", "core"), globe(0.5, 1)], ON_WALL), "the inner facing out"),
    "bulb beside a core": (([globe(0.5, 1, 0.4, "outside", "core"), globe(0.5, 1)], ON_WALL, [ASIDE]), "the spheres themselves"),
    "between spheres": (([globe(0.5, 1, 0.2, "outside", "core"), globe(0.5, 1)], INSIDE), "lies on neither"),
    "walls that differ": (([*ROOM[:5], ROOM[5] | {"reflectance": 0.6}], INSIDE), "the walls of the room differ"),
    "an l-shaped room": ((ELL, INSIDE), "behind its wall"),
    "eye out of the room": ((ROOM, CAMERA | {"origin": [0, 0, 2.5]}), "does not stand inside"),
    "film out of the room": ((ROOM, INSIDE | {"positions": [[0, 0, 0], [0, 0, 2.1]]}), "reaches out"),
    "film aslant on a wall": ((ROOM, INSIDE | {"positions": [[0, 0, 0], [0, 0, -1]]}), "does not face as the wall"),
    "bulb in a box": ((ROOM, INSIDE, [BULB]), "exact centre of an exact cube"),
    "bulb aside in a cube": ((box(*DYADIC, 0.5), FLOOR, [ASIDE]), "exact centre of an exact cube"),
    "part of a wall": ((box(*DYADIC, 0.5), FLOOR | {"u": [3, 0, 0]}, [MIDDLE]), "the mean over a whole wall"),
    "thirds of a wall": ((box(*DYADIC, 0.5), FLOOR | {"resolution": [3, 1]}, [MIDDLE]), "the mean over a whole wall"),
    "shade on the floor": (([LIT, LID], WALL, [BEAM], 1), "'lid' may shade 'floor' from 'sun'"),
    "a ball over the floor": (([LIT, globe(0, 0, 0.1, "outside")], WALL, [BEAM], 1), "'wall' may shade"),
    "back and forth": (([LIT, RAMP], WALL, [BEAM], 2), "between 'floor' and 'ramp'"),
    "a lit ball": (([globe(0.5, 0, 0.1, "outside")], WALL, [BEAM], 1), "reflects and is no polygon"),
    "a lit floor that glows": (([LIT | {"radiance": 1.0}], WALL, [BEAM], 1), "emits light of its own"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_quite_the_arrangement_is_refused(name):
    arrangement, reason = REFUSED[name]
    with pytest.raises(CannotCertify, match=reason):
        certify(scene(*arrangement))


OPEN = {"open room": without(ROOM, "north"), "room from outside": turned(ROOM), "open sphere": zones(40, (0.5, 1), (0.5,))[:1]}


@pytest.mark.parametrize("name", OPEN)
def test_what_is_open_is_no_furnace(name):
    with pytest.raises(CannotCertify):
        certify(scene(OPEN[name], INSIDE))


def test_one_reflection_asks_no_more_of_a_ramp_than_it_must():
    """The floor cannot be lit again where only one reflection counts, nor where a second floor lies in its plane."""
    film = {"kind": "points", "quantity": "irradiance", "positions": [[0, 0.2, 0.9]], "normals": [[1, 0, 0]]}
    assert value([LIT, RAMP], film, [BEAM], 1) == value([LIT], film, [BEAM], 1)
