"""The first engine on polygons and points: several blockers, concave shapes, hard edges, and what it refuses."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightproof import geometry, scene_file, suite
from lightproof.certify import convex, hard_shadows, rays
from lightproof.certify.balls import CannotCertify, point
from lightproof.certify.engine import certify
from lightproof.certify.polygon import area_vector

LAMP = [[-0.4, -0.7, 1.3], [-0.4, 0.3, 1.3], [0.6, 0.3, 1.3], [0.6, -0.7, 1.3]]
PLANE = {"kind": "plane", "quantity": "irradiance", "origin": [-0.25, -0.25, 0], "u": [0.375, 0, 0], "v": [0, 0.25, 0]}
FLOOR = {"origin": [-0.6, -0.5, 0], "u": [1.2, 0, 0], "v": [0, 0.9, 0]}
BULB = {"kind": "point", "id": "bulb", "position": [0.1, 0.2, 1.1], "intensity": 2.3}


def lamp(vertices=LAMP, name="lamp"):
    return {"kind": "area", "id": name, "radiance": 2.04, "shape": {"type": "polygon", "vertices": vertices}}


def black(shape, name="blocker"):
    shape = shape if isinstance(shape, dict) else {"type": "polygon", "vertices": shape}
    return {"id": name, "reflectance": 0, "shape": shape}


def level(x, y, z):
    """A level rectangle."""
    return [[x[0], y[0], z], [x[1], y[0], z], [x[1], y[1], z], [x[0], y[1], z]]


def scene(lights, film, surfaces=()):
    table = {"title": "a test", "max_bounces": 0, "tolerance": 0.005, "film": film}
    return scene_file.from_table(table | {"light": list(lights), "surface": list(surfaces)}, "test")


def means(lights, surfaces=(), resolution=(2, 2), **film):
    """(n,) Means over a plane film."""
    return certify(scene(lights, PLANE | {"resolution": list(resolution)} | film, surfaces)).value


def points(lights, positions, surfaces=(), normal=(0, 0, 1)):
    """(n,) Values at points."""
    film = {"kind": "points", "quantity": "irradiance", "positions": positions, "normals": [list(normal)] * len(positions)}
    return certify(scene(lights, film, surfaces)).value


def sampled(lights, surfaces, cell, count=9):
    """The mean over a cell by a midpoint rule of certified points: good to half a per cent where shadows have edges."""
    steps = (np.arange(count) + 0.5) / count
    (x0, x1), (y0, y1) = cell
    positions = [[float(x0 + (x1 - x0) * s), float(y0 + (y1 - y0) * t), 0.0] for s in steps for t in steps]
    return points(lights, positions, surfaces).mean()


LEANING = [[-0.5, -0.6, 0.3], [0.4, -0.5, 0.5], [0.2, 0.4, 0.8]]
LEVEL_PAIR = [black(level((-0.3, 0.2), (-0.4, 0.1), 0.7), "high"), black(level((-0.1, 0.4), (-0.2, 0.3), 0.5), "low")]
COPLANAR_PAIR = [black(LEANING, "one"), black([[-0.3, -0.7, 0.31], [0.5, -0.3, 0.58], [-0.1, 0.2, 0.64]], "other")]


@pytest.mark.parametrize("surfaces", [LEVEL_PAIR, [black(LEANING)]], ids=["two", "leaning"])
def test_means_behind_blockers_are_those_of_their_points(surfaces):
    """An exactly cut cell against a crude mean of exact points."""
    expected = sampled([lamp()], surfaces, ((-0.2, 0.1), (-0.3, 0.0)))
    cell = {"origin": [-0.2, -0.3, 0], "u": [0.3, 0, 0], "v": [0, 0.3, 0]}
    assert means([lamp()], surfaces, (1, 1), **cell)[0] == pytest.approx(expected, rel=6e-3)


def test_a_finer_film_sums_to_a_coarser_one():
    """Four cells or one, cut along different lines: the same flux to 15 digits."""
    whole, parts = (means([lamp()], LEVEL_PAIR, resolution) for resolution in ((1, 1), (2, 2)))
    assert parts.mean() == pytest.approx(whole[0], rel=1e-15)


def test_blockers_in_one_plane_overlap_exactly():
    """Two triangles in the plane 4z = 2x + y + 3 that overlap in a quadrilateral hide what the hexagon around them hides."""
    def on(*corners):
        return [[x, y, 0.5 * x + 0.25 * y + 0.75] for x, y in corners]

    pair = [on((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5)), on((-0.5, 0.25), (-0.5, -0.75), (0.5, 0.25))]
    around = on((-0.5, 0.25), (-0.5, -0.75), (-0.25, -0.5), (0.5, -0.5), (0.5, 0.5), (0.25, 0.25))
    cell = {"origin": [-0.1, -0.2, 0], "u": [0.1, 0, 0], "v": [0, 0.1, 0]}
    both = means([lamp()], [black(one, f"blocker-{i}") for i, one in enumerate(pair)], (1, 1), **cell)
    assert both == pytest.approx(means([lamp()], [black(around)], (1, 1), **cell), rel=1e-14)


def test_sixteen_blockers_that_all_overlap_do_not_blow_up():
    """A stack of sixteen like plates: right below it the lowest hides what the others hide; and sixteen that each hide all."""
    stack = [black(level((-0.3, 0.2), (-0.3, 0.2), 0.5 + k / 64), f"plate-{k}") for k in range(16)]
    below, beside = ([[0, 0, 0]], [[0.3, -0.1, 0]])
    assert points([lamp()], below, stack) == pytest.approx(points([lamp()], below, stack[:1]), rel=1e-15)
    assert points([lamp()], beside, stack)[0] < min(points([lamp()], beside, [plate])[0] for plate in (stack[0], stack[15]))
    plates = [black(level((-9, 9), (-9, 9), 0.5 + k / 64), f"plate-{k}") for k in range(16)]
    assert (means([lamp()], plates, (1, 1)) == 0).all()


def test_full_shadow_of_two_plates_is_exactly_none():
    """Neither plate hides the lamp alone; where both together do, there is no light at all and no rounding."""
    plates = [black(level((-0.9, 0.05), (-0.9, 0.7), 0.6), "left"), black(level((0.0, 0.9), (-0.9, 0.7), 0.59), "right")]
    film = {"origin": [-0.2, -0.3, 0], "u": [0.4, 0, 0], "v": [0, 0.4, 0]}
    assert (means([lamp()], plates, **film) == 0).all()
    assert (means([lamp()], plates[:1], **film) > 0).any()


def test_a_board_that_stands_on_the_film_is_not_smooth_there():
    """Where the foot of a wall ends within a cell the shadow turns about a point: refused, never guessed; beside it is fine."""
    wall = black([[0.0, -0.2, 0], [0.0, 0.1, 0], [0.0, 0.1, 0.5], [0.0, -0.2, 0.5]])
    with pytest.raises(CannotCertify, match="not smooth enough"):
        means([lamp()], [wall], (1, 1), origin=[-0.05, -0.25, 0], u=[0.1, 0, 0], v=[0, 0.1, 0])
    assert means([lamp()], [wall], (1, 1), origin=[0.1, -0.1, 0], u=[0.5, 0, 0], v=[0, 0.1, 0])[0] > 0


def test_what_lies_below_the_horizon_hides_nothing():
    """A board through the floor and the part of it above the floor cast one shadow."""
    whole = [[0.9, -0.3, -0.25], [0.9, 0.3, -0.25], [0.15, 0.3, 0.5], [0.15, -0.3, 0.5]]
    above = [[0.65, -0.3, 0.0], [0.65, 0.3, 0.0], [0.15, 0.3, 0.5], [0.15, -0.3, 0.5]]
    expected = means([lamp()], [black(above)])
    assert means([lamp()], [black(whole)]) == pytest.approx(expected, rel=1e-15)
    assert (expected < means([lamp()])).all()


def test_a_blocker_through_the_lamp_is_cut_at_its_plane():
    """What is above the lamp hides nothing: a wall through the lamp and its lower half are the same to the floor."""
    wall = [[0.1, -0.9, 0.8], [0.1, 0.6, 0.8], [0.1, 0.6, 1.9], [0.1, -0.9, 1.9]]
    half = [[0.1, -0.9, 0.8], [0.1, 0.6, 0.8], [0.1, 0.6, 1.3], [0.1, -0.9, 1.3]]
    assert means([lamp()], [black(wall)]) == pytest.approx(means([lamp()], [black(half)]), rel=1e-15)


def test_walls_around_cost_nothing():
    """A room around lamp and film, whose walls touch both, changes no bit."""
    room = [black([[x, -1, 0], [x, 1, 0], [x, 1, 1.3], [x, -1, 1.3]], f"wall-{i}") for i, x in enumerate((-0.6, 0.6))]
    ceiling = black(level((-0.6, 0.6), (-1, 1), 1.5), "ceiling")
    assert (means([lamp()], [*room, ceiling]) == means([lamp()])).all()


def test_a_receiver_in_line_with_an_edge():
    """Seen end-on an edge has no plane of its own: there the whole lamp is a line and gives nothing, around it little."""
    low = [[0.5, -0.5, 0.25], [0.5, 0.5, 0.75], [-0.25, 0.5, 0.75], [-0.25, -0.5, 0.25]]
    on_line, beside = points([lamp(low)], [[-0.25, -1.0, 0.0], [-0.25, -1.0, 1e-6]])
    assert on_line == 0 < beside < 1e-6
    assert means([lamp(low)], resolution=(1, 1), origin=[-0.375, -1.125, 0], u=[0.25, 0, 0], v=[0, 0.25, 0])[0] > 0


@given(st.integers(0, 2**32))
@settings(max_examples=25, deadline=None)
def test_tiles_of_a_star(seed):
    """A random star-shaped polygon of 4 to 11 corners, either way round: its tiles are convex and their areas add up."""
    random = np.random.default_rng(seed)
    count = int(random.integers(4, 12))
    turns, lengths = (np.arange(count) + random.uniform(-0.3, 0.3, count)) * 2 * math.pi / count, random.uniform(0.2, 1, count)
    star = [point([r * math.cos(f), r * math.sin(f), 0.0]) for r, f in zip(lengths, turns, strict=True)]
    corners = star[::random.choice([-1, 1])]
    front = area_vector(corners)
    tiles = convex.parts(corners, front)
    assert sum(area_vector(tile)[2] for tile in tiles) == front[2]
    for tile in tiles:
        turns = [area_vector((tile[i - 2], tile[i - 1], tile[i]))[2] * front[2] for i in range(len(tile))]
        assert min(turns) >= 0


# hard edges


def test_hard_shadows_add_up_to_the_area_they_leave():
    """A beam through the gap between two plates that overlap elsewhere: flux = irradiance times the gap's area."""
    beam = {"kind": "directional", "id": "beam", "direction": [0.125, 0.0, -1.0], "irradiance": 3.1}
    plates = [black(level((-9, -0.25), (-9, 9), 0.5), "left"), black(level((0.25, 9), (-9, 9), 0.75), "right"),
              black(level((-9, 9), (-9, -0.125), 0.25), "south")]
    cosine = 1 / math.hypot(0.125, 1)
    gap = (0.25 - 0.75 * -0.125) - (-0.25 - 0.5 * -0.125)
    area = gap * (0.4 + 0.125)
    assert means([beam], plates, (3, 2), **FLOOR).mean() * 1.2 * 0.9 == pytest.approx(3.1 * cosine * area, rel=1e-14)


def test_a_point_lights_shadow_in_a_cell():
    """A half-plane hides a point light from the left half of a cell: what is left is the right half's own mean."""
    blade = black([[-9, -9, 0.55], [0.05, -9, 0.55], [0.05, 9, 0.55], [-9, 9, 0.55]])
    lit = means([BULB], (), (1, 1), **FLOOR | {"origin": [0.0, -0.5, 0], "u": [0.6, 0, 0]})
    assert means([BULB], [blade], (1, 1), **FLOOR)[0] == pytest.approx(lit[0] / 2, rel=1e-15)


BALL = {"type": "sphere", "center": [0.1, 0.2, 0.6], "radius": 0.125}
DISK = {"type": "disk", "center": [0.1, 0.2, 0.6], "normal": [0.2, 0.1, -3], "radius": 0.125}
TUBE = {"type": "cylinder", "base": [-0.4, 0.2, 0.6], "axis": [3, 0, 0], "height": 1.0, "radius": 0.125}


@pytest.mark.parametrize("shape", [BALL, DISK, TUBE, {"type": "polygon", "vertices": level((0, 0.2), (0.1, 0.3), 0.6)}],
                         ids=["ball", "disk", "tube", "plate"])
def test_rays_that_are_stopped_and_rays_that_are_not(shape):
    """Below the shape nothing arrives, beside it everything, and through a tube's open end and its wall no more than that."""
    below, beside = points([BULB], [[0.1, 0.2, 0.0], [0.9, 0.9, 0.0]], [black(shape)])
    assert below == 0
    assert beside == points([BULB], [[0.9, 0.9, 0.0]])[0]


def test_a_tube_is_open_at_its_ends():
    """A ray down the axis of an upright tube passes; one that enters at the top and leaves by the wall does not; a receiver
    inside the tube and a bulb inside it see each other."""
    upright = {"type": "cylinder", "base": [0.1, 0.2, 0.4], "axis": [0, 0, 2], "height": 0.3, "radius": 0.05}
    clear, crossed = points([BULB], [[0.1, 0.2, 0.0], [0.2, 0.2, 0.0]], [black(upright)])
    assert clear > 0 and crossed == 0
    around = upright | {"base": [0.1, 0.2, -1.0], "height": 4.0, "radius": 0.5}
    assert points([BULB], [[0.3, 0.2, 0.0]], [black(around)])[0] > 0


def test_a_ray_that_starts_on_a_ball():
    """It is stopped where it goes in, not where it leaves."""
    ball, up = geometry.Sphere((0, 0, 0.5), 0.125), point([0.25, 0, 1])
    assert not rays.blocked(ball, point([0, 0, 0.625]), up, None)
    assert rays.blocked(ball, point([0, 0, 0.375]), up, None)


@pytest.mark.parametrize(("position", "shape"), [
    ([0.125, 0.0, 0.0], {"type": "polygon", "vertices": [[0.125, -1, 0.5], [0.125, 1, 0.5], [1, 1, 0.5], [1, -1, 0.5]]}),
    ([0.375, 0.0, 0.0], {"type": "disk", "center": [0.125, 0, 0.5], "normal": [0, 0, 1], "radius": 0.125}),
    ([0.25, 0.0, 0.0], {"type": "sphere", "center": [0.0, 0, 0.5], "radius": 0.25}),
], ids=["edge", "rim", "tangent"])  # fmt: skip
def test_a_hard_edge_has_no_value(position, shape):
    """Rays that just touch an edge, a rim, a ball: refused."""
    bulb = BULB | {"position": [position[0] if shape["type"] != "disk" else 0.125, 0.0, 1.0]}
    with pytest.raises(CannotCertify, match="just touches"):
        points([bulb], [position], [black(shape)])


@pytest.mark.parametrize(("lights", "surfaces", "reason"), [
    ([BULB], [black(BALL)], "covered at points only"),
    ([BULB | {"position": [0.1, 0.2, 0.6]}], [black(level((0, 0.3), (0, 0.3), 0.6))], "lies on what stands before it"),
])
def test_refused_over_films(lights, surfaces, reason):
    """Curved edges of hard shadows, and a bulb on a plate."""
    with pytest.raises(CannotCertify, match=reason):
        means(lights, surfaces)


def test_a_winding_polygon_holds_its_points():
    """A U: inside an arm, between the arms, on the rim."""
    u = geometry.Polygon(((0, 0, 0.5), (3, 0, 0.5), (3, 3, 0.5), (2, 3, 0.5), (2, 1, 0.5), (1, 1, 0.5), (1, 3, 0.5), (0, 3, 0.5)))
    up = point([0, 0, 1])
    assert rays.blocked(u, point([0.5, 2, 0]), up, None)
    assert not rays.blocked(u, point([1.5, 2, 0]), up, None)
    assert not rays.blocked(u, point([0.5, 2, 0]), up, point([0.25, 0, 0])[0])
    with pytest.raises(CannotCertify):
        rays.blocked(u, point([1, 2, 0]), up, None)


def test_only_what_is_before_them_is_asked():
    """Without blockers another module knows the light."""
    bulb = scene([BULB], PLANE | {"resolution": [1, 1]}).lights[0]
    assert not hard_shadows.covers(bulb, [])


# the suite's own closures


@pytest.mark.parametrize(("kind", "power"), [
    ("point", lambda light: 4 * math.pi * light.intensity),
    ("polygon", lambda light: math.pi * light.radiance * light.shape.area),
    ("disk", lambda light: math.pi * light.radiance * light.shape.area),
    ("sphere", lambda light: math.pi * light.radiance * light.shape.area),
])  # fmt: skip
def test_six_walls_collect_the_power(kind, power):
    """The references of flux-closure, summed: all of the light arrives, to 15 digits."""
    home = suite.default()
    cases = home.cases("flux-closure")
    walls = [scene_ for name, scene_ in cases.items() if name.replace("base", "point").startswith(kind)]
    areas = [np.linalg.norm(np.cross(wall.film.u, wall.film.v)) for wall in walls]
    flux = sum(home.reference(wall).value.mean() * area for wall, area in zip(walls, areas, strict=True))
    assert len(walls) == 6
    assert flux == pytest.approx(power(walls[0].lights[0]), rel=1e-14)


def test_the_floor_collects_what_passes_the_opening():
    """beam:patch: irradiance across the beam times the opening's area across it."""
    home = suite.default()
    patch = home.scene("beam:patch")
    beam = patch.lights[0]
    cosine = -beam.direction[2] / np.linalg.norm(beam.direction)
    expected = beam.irradiance * cosine * (0.36 + 0.41) * (0.64 - 0.07)
    assert home.reference(patch).value.mean() * 2.4 * 1.8 == pytest.approx(expected, rel=1e-14)
