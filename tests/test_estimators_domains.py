"""Domains that directions are drawn in: each against its density, its solid angle, and the exact light, near and far.

Seeds are fixed, so that each test either always passes or always fails.
"""

from __future__ import annotations

import importlib
import math
import pathlib

import numpy as np
import pytest
from numba import njit
from scipy import stats

from lightproof import suite
from lightproof.estimators import fans, shapes
from lightproof.estimators.lamps import Glow, arriving, faced, glowing
from lightproof.estimators.mixed import Mixed
from lightproof.estimators.options import SAMPLING
from lightproof.estimators.path import Path
from lightproof.estimators.points import drawn, opened
from lightproof.estimators.projected import Projected
from lightproof.estimators.rng import TICK
from lightproof.estimators.subtended import Subtended
from lightproof.estimators.trigonometry import half_turn
from lightproof.geometry import tangents, unit
from lightproof.renderers.registry import METHODS, OURS
from lightproof.scene import Scene
from lightproof.scene_file import from_table

SIGMAS = 4.5
RARE = 1e-6  # a fixed seed that falls below is no accident
CATALOGUE = suite.default()
CENTER, U, V = np.array([0.3, -0.2, 1.1]), np.array([1.3, 0, 0.2]), np.array([0.1, -0.9, 0.3])
FLAT = {
    "triangle": shapes.flat(shapes.Triangle, CENTER, U, V),
    "parallelogram": shapes.flat(shapes.Parallelogram, CENTER, U, V),
    "disk": shapes.flat(shapes.Disk, CENTER, np.array([0.9, 0, 0]), np.array([0, -0.9 * 0.8, 0.9 * 0.6])),
}
SHAPES = {**FLAT, "sphere": shapes.Sphere((0.3, -0.2, 1.1), 0.5)}


@njit
def numbers(points, count):
    """The first two coordinates (count, 2) of the first block, in units of TICK."""
    out = np.empty((count, 2))
    common = opened(points, 0, 0)
    for i in range(count):
        out[i, 0], out[i, 1] = drawn(i, common, 1.0)[:2]
    return out


@njit
def values(source, draws):
    """What each draw counts at the origin, which faces along z, and the vector to its point: (n, 4)."""
    out = np.empty((len(draws), 4))
    seen = faced(source, (0.0, 0.0, 0.0), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), 1.0)
    for i in range(len(draws)):
        f, d = arriving(seen, (0.0, 0.0, 0.0), draws[i, 0], draws[i, 1])
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = f, d[0], d[1], d[2]
    return out


def sampled(source, count: int = 2000, blocks: int = 16) -> np.ndarray:
    """`values` of independent draws."""
    return np.vstack([values(source, numbers(SAMPLING["points"]["independent"](count, seed), count)) for seed in range(blocks)])


def aimed(kind, shape):
    """An aim of a kind at a shape that emits 1 W/(m2 sr)."""
    return kind.of(Glow("", shape, 1.0, corners(shape)))


def corners(shape) -> np.ndarray | None:
    """Of a polygon (k, 3)."""
    if not isinstance(shape, shapes.Triangle | shapes.Parallelogram):
        return None
    start, u, v = np.array(shape[:3])
    if isinstance(shape, shapes.Triangle):
        return np.array([start, start + u, start + v])
    return np.array([start + s * u + t * v for s, t in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))])


def spread(shape, side: int) -> tuple[np.ndarray, np.ndarray]:
    """Midpoints (side^2, 3) of a grid over a flat shape's parameters, and area of each of its cells [m2]."""
    a, b = (np.ravel(grid) for grid in np.meshgrid(*2 * [(np.arange(side) + 0.5) / side], indexing="ij"))
    s, t, weight = {
        shapes.Parallelogram: lambda: (a - 0.5, b - 0.5, np.ones_like(a)),
        shapes.Triangle: lambda: (1 - a, a * b, a),
        shapes.Disk: lambda: (a * np.cos(2 * np.pi * b), a * np.sin(2 * np.pi * b), 2 * np.pi * a),
    }[type(shape)]()
    area = np.linalg.norm(np.cross(shape.u, shape.v)) * weight / side**2
    return np.array(shape.center) + np.outer(s, shape.u) + np.outer(t, shape.v), area


def cell(shape, points: np.ndarray, bins: int) -> np.ndarray:
    """Which of bins x bins cells of `spread`'s grid each point lies in."""
    offsets = points - np.array(shape.center)
    s, t = offsets @ shape.dual_u, offsets @ shape.dual_v
    a, b = {
        shapes.Parallelogram: lambda: (s + 0.5, t + 0.5),
        shapes.Triangle: lambda: (1 - s, t / (1 - s)),
        shapes.Disk: lambda: (np.hypot(s, t), np.arctan2(t, s) / (2 * np.pi) % 1),
    }[type(shape)]()
    return np.clip(a * bins, 0, bins - 1).astype(int) * bins + np.clip(b * bins, 0, bins - 1).astype(int)


def p_of(found: np.ndarray, expected: np.ndarray) -> float:
    """p-value of a chi-square test of counts by cell against shares."""
    counts = np.bincount(found, minlength=len(expected))
    return stats.chisquare(counts, expected / expected.sum() * counts.sum()).pvalue


@pytest.mark.parametrize("height", [1.0, 0.02], ids=["far", "near"])
@pytest.mark.parametrize("name", FLAT)
def test_flat_lights_are_sampled_by_their_density(name, height):
    """Seen from about a metre and from 2 cm over its plane: counts in 8 x 8 cells of the light's parameters against the integral
    of the density over each cell. What a draw counts per cosine is 1/density: of flat polygons, their solid angle."""
    shape = FLAT[name]
    center, normal = np.array(shape.center), np.array(shape.normal)
    lifted = shape._replace(center=tuple(center - (1 - height) * (center @ normal) * normal))
    found = sampled(aimed(Subtended, lifted))
    w = found[:, 1:] / np.linalg.norm(found[:, 1:], axis=1, keepdims=True)
    cells = cell(lifted, found[:, 1:], 8)
    points, area = spread(lifted, 800)
    r = np.linalg.norm(points, axis=1)
    solid_angle = area * -(points @ lifted.normal) / r**3
    density = np.ones(len(points)) if name != "disk" else disk_density(lifted, points / r[:, None])
    expected = np.bincount(cell(lifted, points, 8), solid_angle * density)
    up = w[:, 2] > 1e-3
    assert expected.sum() == pytest.approx(1 if name == "disk" else solid_angle.sum(), rel=2e-3)
    assert p_of(cells, expected) > RARE
    if name != "disk":
        assert found[up, 0] / w[up, 2] == pytest.approx(solid_angle.sum(), rel=2e-3)


@pytest.mark.parametrize("drop", [0.0, 0.9, 1.02, 1.25], ids=["zenith", "aside", "cut", "low"])
@pytest.mark.parametrize("name", ["triangle", "parallelogram"])
def test_polygons_are_sampled_uniformly_in_projected_solid_angle(name, drop):
    """Around the zenith, beside it, cut by the horizon and almost below it: counts in 8 x 8 cells of the light's parameters
    against the integral of the density over each cell; every draw counts the projected solid angle."""
    shape = FLAT[name]
    shape = shape._replace(center=(shape.center[0] - drop / 4, shape.center[1] + drop, shape.center[2] - drop))
    found = sampled(aimed(Projected, shape))
    points, area = spread(shape, 800)
    r = np.linalg.norm(points, axis=1)
    seen = area * -(points @ shape.normal) / r**4 * np.maximum(points[:, 2], 0)
    expected = np.bincount(cell(shape, points, 8), seen, minlength=64)
    lit = expected > 1e-3 * expected.sum()
    cells = cell(shape, found[:, 1:], 8)
    assert p_of((np.cumsum(lit) - 1)[cells[lit[cells]]], expected[lit]) > RARE
    assert found[:, 0] == pytest.approx(np.full(len(found), seen.sum()), rel=1e-2 if drop > 1 else 1e-4)
    assert np.ptp(found[:, 0]) == 0 and (found[:, 3] > 0).all()


@pytest.mark.parametrize("size", [1e-9, 1e-3, 1.0, 1e9])
@pytest.mark.parametrize("name", ["triangle", "parallelogram"])
def test_polygons_in_awkward_places_stay_in_reach(name, size):
    """Tiny and vast; with a corner, an edge or the middle at the zenith or on the horizon; a hair's breadth over the receiver:
    the mean is that of directions uniform in solid angle, and every point lies on the light."""
    shape = shapes.flat(type(FLAT[name]), np.zeros(3), size * V, size * U)
    for s, t in ((0, 0), (0.5, 0), (0, 0.5), (0.5, 0.5), (0.25, 0.25), (0.3, 0.1)):
        for place in ((0, 0, 1), (0, 0, 1e-9), (1, 0, 0), (0.6, 0.8, 1e-6), (0.6, 0.8, -1e-12)):
            center = np.array(place) - s * np.array(shape.u) - t * np.array(shape.v)
            moved = shape._replace(center=tuple(center.tolist()))
            draws = np.random.default_rng(1).random((400, 2)) * 2**32 - 2**31
            found, other = (values(aimed(kind, moved), draws) for kind in (Projected, Subtended))
            assert np.isfinite(found).all() and (found[:, 0] >= 0).all()
            error = other[:, 0].std() / 20 + found[:, 0].std() / 20
            assert abs(found[:, 0].mean() - other[:, 0].mean()) <= SIGMAS * error + 1e-9 * found[:, 0].mean()
            if found[0, 0]:
                a, b = ((found[:, 1:] - center) @ dual for dual in (shape.dual_u, shape.dual_v))
                outside = np.maximum(abs(a), abs(b)) - 0.5 if name == "parallelogram" else np.max([-a, -b, a + b - 1], axis=0)
                assert outside.max() < 1e-5


@njit
def mean(source, place, frame, side):
    """What side x side draws count, one in the middle of each cell of the unit square."""
    seen = faced(source, place, frame, 1.0)
    total = 0.0
    for i in range(side):
        for j in range(side):
            s, t = ((i + 0.5) / side - 0.5) / TICK, ((j + 0.5) / side - 0.5) / TICK
            total += arriving(seen, (0.0, 0.0, 0.0), s, t)[0]
    return total / side**2


@pytest.mark.parametrize("label", ["base", "along", "triangle", "disk"])
@pytest.mark.parametrize("kind", [Subtended, Projected])
def test_nearness_adds_no_error(kind, label):
    """hard-approach, 3.7e-13 m over the middle, an edge and a corner, in frames of no one's axes: the same draws count what they
    count at 3.7e-7 m, where sixteen digits tell where one is."""
    scene = case("hard-approach", label)
    glow, = glowing(scene)
    exact = CATALOGUE.reference(scene).value
    far, near = slice(2, None, 5), slice(4, None, 5)
    errors = []
    for place, normal, value in zip(scene.film.positions, scene.film.normals, exact, strict=True):
        axes = *tangents(unit(normal)), unit(normal)
        frame = tuple(tuple(axis.tolist()) for axis in axes)
        errors.append(mean(kind.of(glow), tuple(map(float, place)), frame, 400) * glow.radiance / value - 1)
    assert np.abs(np.array(errors)[near] - np.array(errors)[far]).max() < 2e-6


def disk_density(shape, w: np.ndarray) -> np.ndarray:
    """(1 + cos(rim))/(2 pi sin(a) sin(b)) by the cone's axes, found here as eigenvectors of its quadratic form."""
    c, n, r = np.array(shape.center), np.array(shape.normal), np.linalg.norm(shape.u)
    h = c @ n
    form = h**2 * np.eye(3) - h * (np.outer(n, c) + np.outer(c, n)) + (c @ c - r**2) * np.outer(n, n)
    roots, axes = np.linalg.eigh(form)
    sine_1, sine_2 = (math.sqrt(-roots[0] / (roots[k] - roots[0])) for k in (1, 2))
    x, y = w @ axes[:, 1], w @ axes[:, 2]
    rim2 = (x**2 + y**2) / (x**2 / sine_1**2 + y**2 / sine_2**2)
    return (1 + np.sqrt(1 - rim2)) / (2 * math.pi * sine_1 * sine_2)


@pytest.mark.parametrize("radius", [0.5, 1.155], ids=["far", "near"])
def test_spheres_are_sampled_uniformly_in_solid_angle(radius):
    """In its cone, also from 2 cm above it: the cosine from the axis and the turn about it are uniform; what a draw counts per
    cosine is 2 pi (1 - cos(a))."""
    ball = shapes.Sphere(tuple(CENTER), radius)
    found = sampled(aimed(Subtended, ball))
    w = found[:, 1:] / np.linalg.norm(found[:, 1:], axis=1, keepdims=True)
    rim = math.sqrt(1 - radius**2 / (CENTER @ CENTER))
    height, turn = around(w, CENTER)
    assert p_of(grid_cell((1 - height) / (1 - rim), turn), np.ones(256)) > RARE
    up = w[:, 2] > 1e-3
    assert found[up, 0] / w[up, 2] == pytest.approx(2 * math.pi * (1 - rim), rel=1e-12)
    assert (found[w[:, 2] <= 0, 0] == 0).all()


def around(w: np.ndarray, axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cosine from an axis, and the turn about it in [0, 1)."""
    axis = axis / np.linalg.norm(axis)
    side = np.cross(axis, [1.0, 0, 0])
    side /= np.linalg.norm(side)
    return w @ axis, np.arctan2(w @ np.cross(axis, side), w @ side) / (2 * np.pi) % 1


def grid_cell(a: np.ndarray, b: np.ndarray, bins: int = 16) -> np.ndarray:
    return np.clip(a * bins, 0, bins - 1).astype(int) * bins + np.clip(b * bins, 0, bins - 1).astype(int)


def test_spheres_are_sampled_uniformly_in_projected_solid_angle():
    """Above the horizon: projected onto the receiver's plane and then, along the normal, onto the circle of the rim, directions
    fill it alike; every draw counts pi sin(a)^2 cos(theta)."""
    ball = shapes.Sphere(tuple(CENTER), 0.5)
    found = sampled(aimed(Projected, ball))
    w = found[:, 1:] / np.linalg.norm(found[:, 1:], axis=1, keepdims=True)
    r = math.sqrt(CENTER @ CENTER)
    axis, sine, cosine = CENTER / r, 0.5 / r, math.sqrt(1 - 0.25 / r**2)
    lowered = w.copy()
    lowered[:, 2] = (cosine - w[:, :2] @ axis[:2]) / axis[2]
    offset = lowered - cosine * axis
    assert p_of(grid_cell((offset**2).sum(axis=1) / sine**2, around(offset, axis)[1]), np.ones(256)) > RARE
    assert found[:, 0] == pytest.approx(math.pi * sine**2 * axis[2], rel=1e-12)


def spread_cap(ball, side: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Midpoints (side^2, 3) of a grid over the cap of a sphere that faces the receiver, the normals there, and the area of each
    of its cells [m2]."""
    center = np.array(ball.center)
    rim = ball.radius / np.linalg.norm(center)
    axis = -center / np.linalg.norm(center)
    one = np.cross(axis, [1.0, 0, 0])
    one /= np.linalg.norm(one)
    down, turn = (np.ravel(grid) for grid in np.meshgrid(*2 * [(np.arange(side) + 0.5) / side], indexing="ij"))
    height, angle = 1 - (1 - rim) * down, 2 * np.pi * turn
    out = np.sqrt(1 - height**2)[:, None] * (np.cos(angle)[:, None] * one + np.sin(angle)[:, None] * np.cross(axis, one))
    normals = height[:, None] * axis + out
    return center + ball.radius * normals, normals, np.full(side**2, 2 * np.pi * ball.radius**2 * (1 - rim) / side**2)


def cap_cell(ball, points: np.ndarray, bins: int) -> np.ndarray:
    """Which of bins x bins cells of `spread_cap`'s grid each point lies in."""
    height, turn = around((points - np.array(ball.center)) / ball.radius, -np.array(ball.center))
    rim = ball.radius / np.linalg.norm(ball.center)
    return grid_cell((1 - height) / (1 - rim), turn, bins)


@pytest.mark.parametrize("name", SHAPES)
def test_mixture_is_sampled_by_its_density(name):
    """Counts in 8 x 8 cells of the light, and of directions that miss it, against the integral over each cell of
    (1/A + cos(theta_x) cos(theta_y)/(pi r^2))/2 per area, of a sphere over the cap that faces the receiver."""
    shape = SHAPES[name]
    if isinstance(shape, shapes.Sphere):
        (points, normals, area), place = spread_cap(shape, 800), cap_cell
    else:
        (points, area), place = spread(shape, 800), cell
        normals = np.broadcast_to(shape.normal, points.shape)
    r = np.linalg.norm(points, axis=1)
    by_cosine = area * np.maximum(points[:, 2], 0) * -(points * normals).sum(axis=1) / (np.pi * r**4)
    expected = np.bincount(place(shape, points, 8), (area / area.sum() + by_cosine) / 2, minlength=64)
    found = sampled(aimed(Mixed, shape), blocks=64)
    cells = np.where(found[:, 0] > 0, place(shape, found[:, 1:], 8), 64)
    assert p_of(cells, np.append(expected, 1 - expected.sum())) > RARE


@pytest.mark.parametrize("name", SHAPES)
def test_mixture_has_a_mean_and_a_bound(name):
    """What the draws of area and cosine count: the same mean as directions into the light, none above 2 pi."""
    both, alone = (sampled(aimed(kind, SHAPES[name]), blocks=128)[:, 0] for kind in (Mixed, Subtended))
    error = math.hypot(*(one.std() / math.sqrt(len(one)) for one in (both, alone)))
    assert abs(both.mean() - alone.mean()) < SIGMAS * error
    assert both.max() <= 2 * math.pi


def test_arctangent_reaches_the_last_digits():
    """half_turn against math.atan2 over 32 decades of slopes, either way: within three units in the last place."""
    slopes = np.logspace(-16, 16, 1001)
    for sign in (1, -1):
        found = np.array([half_turn(y, float(sign)) for y in slopes])
        exact = np.array([math.atan2(y, sign) for y in slopes])
        assert np.abs(found / exact - 1).max() < 3 * np.finfo(float).eps
    assert half_turn(0.0, -1.0) == math.pi and half_turn(0.0, 1.0) == 0


NEW = ("mc-solid-angle", "mc-projected-solid-angle", "mc-mis")


def case(name: str, label: str) -> Scene:
    return next(one for one in CATALOGUE.scenes() if (one.id, one.case) == (name, label))


def films(name: str, scene: Scene, samples: int, replicates: int) -> np.ndarray | None:
    """(replicates, n); None where the method cannot."""
    module, cls = METHODS[name].target.split(":")
    made = getattr(importlib.import_module(module), cls)(name, 2)
    if made.unsupported(scene):
        return None
    made.prepare(scene)
    return np.array([made.render(samples, seed).film for seed in range(1, replicates + 1)])


def unbiased(found: np.ndarray, exact: np.ndarray, digits: float) -> bool:
    """Whether the mean of replicates (k, n) lies within Student's bounds, or within relative rounding of `digits`."""
    count = len(found)
    error = found.std(axis=0, ddof=1) / math.sqrt(count)
    allowed = stats.t.isf(RARE / 2, count - 1) * error + digits * np.abs(exact)
    return bool(np.isfinite(found).all() and (np.abs(found.mean(axis=0) - exact) <= allowed).all())


@pytest.mark.parametrize("label", ["base", "triangle", "disk", "sphere"])
@pytest.mark.parametrize("name", NEW)
def test_lights_from_a_micrometre_to_a_light_second_away(name, label):
    """hard-distance, float32: no bias beyond chance and 2e-7, a deviation per sample below three times the value near the light,
    where that of points of the light is 1e6 times."""
    scene = case("hard-distance", label)
    found = films(name, scene, 2000, 16)
    exact = CATALOGUE.reference(scene).value
    assert unbiased(found, exact, 2e-7)
    assert (found.std(axis=0, ddof=1) * math.sqrt(2000) < 3 * exact).all()


@pytest.mark.parametrize(("name", "scene", "label"), [
    ("mc-cosine", "hard-approach", "sphere"), ("mc-hemisphere", "hard-approach", "sphere"),
    ("mc-area", "hard-grazing", "sliver"), ("mc-area", "hard-grazing", "setting"),
])
def test_float32_shifts_no_light(name, scene, label):
    """Next to a sphere, and where a horizon leaves next to nothing of a lamp: films of the same points in float64 are the same
    in the mean but for 5e-6."""
    exact = CATALOGUE.reference(case(scene, label)).value
    single, double = (films(each, case(scene, label), 65536, 8) for each in (name, f"{name}/float64"))
    assert (np.abs((single - double).mean(axis=0)) <= 5e-6 * exact).all()


@pytest.mark.parametrize("label", ["base", "along", "triangle"])
def test_directions_meet_a_light_over_whose_corner_one_is(label):
    """hard-approach, 0.37 pm from a lamp: a hit or a miss that rounding decides beside an edge would weigh 2 pi L, some 3e-4 of
    the light over a corner in the mean."""
    scene = case("hard-approach", label)
    assert unbiased(films("mc-mis/lattice", scene, 65536, 64), CATALOGUE.reference(scene).value, 2e-7)


@pytest.mark.parametrize("name", [*NEW, "mc-area"])
def test_float32_adds_up_equal_samples(name):
    """Half of a lamp 300 m above, so that samples count the same or nothing: half of all points are within 1e-6 of float64. In a
    few, a sample hits or misses by rounding, which is 6e-5."""
    lamp = {"id": "lamp", "kind": "area", "radiance": 2.04, "shape": {
        "type": "polygon", "vertices": [[-0.5, -0.5, 300], [-0.5, 0.5, 300], [0.5, 0.5, 300], [0.5, -0.5, 300]]}}
    screen = {"id": "screen", "reflectance": 0, "shape": {
        "type": "polygon", "vertices": [[0.13, -1, 299], [0.13, 1, 299], [3, 1, 299], [3, -1, 299]]}}
    positions = [[x, y, 0.0] for x in np.linspace(-0.3, 0.3, 8).tolist() for y in (-0.2, -0.1, 0.1, 0.2)]
    film = {"kind": "points", "quantity": "irradiance", "positions": positions, "normals": [[0, 0, 1]] * len(positions)}
    table = {"title": "test", "max_bounces": 0, "tolerance": 0.01, "light": [lamp], "surface": [screen], "film": film}
    single, double = (films(each, from_table(table, "test"), 16384, 2) for each in (name, f"{name}/float64"))
    assert np.median(abs(single / double - 1)) <= 1e-6


def test_degenerate_lights_are_black():
    """hard-degenerate-light: a polygon of no area gives zero, not NaN."""
    scene = case("hard-degenerate-light", "base")
    assert (films("mc-area", scene, 16, 1) == 0).all()


@pytest.mark.parametrize("name, label", [("hard-approach", "base"), ("hard-approach", "along"), ("hard-approach", "triangle"),
                                         ("hard-grazing", "base"), ("hard-touching-edge", "base"), ("hard-aspect", "base")])
def test_projected_polygons_have_no_noise(name, label):
    """Lights almost in reach, also over an edge and a corner, grazing, and on the horizon: the exact light, but for the noise of
    grazing ones."""
    scene = case(name, label)
    found, exact = films("mc-projected-solid-angle/float64", scene, 500, 16), CATALOGUE.reference(scene).value
    assert unbiased(found, exact, 1e-9)
    assert (found.std(axis=0) <= (1e-12 if name != "hard-grazing" else 0.05) * exact).all()


@pytest.mark.parametrize("label", ["base", "tilted"])
@pytest.mark.parametrize("name", [*NEW, "mc-area", "mc-hemisphere", "mc-cosine/float64"])
def test_nothing_is_seen_from_a_light_s_plane_or_its_back(name, label):
    """hard-in-plane: exactly zero, also on the lamp, where rounding could lift the receiver over it."""
    assert (films(name, case("hard-in-plane", label), 256, 1) == 0).all()


@pytest.mark.parametrize("name", ["mc-solid-angle/sobol", "mc-projected-solid-angle", "mc-mis/jitter"])
def test_domains_and_points_compose(name):
    """occluded-square: free of bias behind a blocker with points that depend on one another."""
    scene = CATALOGUE.scene("occluded-square")
    assert unbiased(films(name, scene, 1000, 16), CATALOGUE.reference(scene).value, 1e-6)


def test_paths_that_aim_at_no_light_meet_it():
    """A lamp over a floor, a white wall beside it, all reflections: the same light on the floor as by next-event estimation;
    a bulb is refused."""
    lamp = {"id": "lamp", "kind": "area", "radiance": 2.04,
            "shape": {"type": "polygon", "vertices": [[-0.5, -0.5, 1.1], [-0.5, 0.5, 1.1], [0.5, 0.5, 1.1], [0.5, -0.5, 1.1]]}}
    wall = {"id": "wall", "reflectance": 0.8,
            "shape": {"type": "polygon", "vertices": [[0.7, -1, 0], [0.7, -1, 2], [0.7, 1, 2], [0.7, 1, 0]]}}
    floor = {"id": "floor", "reflectance": 0.5,
             "shape": {"type": "polygon", "vertices": [[-1, -1, 0], [0.7, -1, 0], [0.7, 1, 0], [-1, 1, 0]]}}
    film = {"kind": "points", "quantity": "irradiance", "positions": [[0.1, 0.2, 0], [0.5, -0.3, 0]], "normals": [[0, 0, 1]] * 2}
    table = {"title": "test", "max_bounces": "all", "tolerance": 0.01, "light": [lamp], "surface": [wall, floor], "film": film}
    met, aimed = (films(name, from_table(table, "test"), 20000, 8) for name in ("path/no-next-event", "path"))
    error = np.sqrt((met.var(axis=0, ddof=1) + aimed.var(axis=0, ddof=1)) / 8)
    assert (np.abs(met.mean(axis=0) - aimed.mean(axis=0)) < SIGMAS * error).all()
    assert (met.mean(axis=0) > 0.5).all()
    assert "no direction meets it" in Path("path/no-next-event", 1).unsupported(CATALOGUE.scene("point-light"))


def test_paths_that_aim_at_no_light_refuse_one_that_touches():
    """A receiver 0.37 pm from the lamp: rays would pass it, for they pass what they start from. One that lies on a lamp, or on
    the wall of a furnace, is no such case."""
    method = Path("path/no-next-event", 1)
    assert "3.7e-13 m from a receiver" in method.unsupported(case("hard-approach", "base"))
    for name in ("hard-in-plane", "sphere-furnace", "cube-furnace", "emitting-cap"):
        assert method.unsupported(case(name, "base")) is None


def test_every_method_of_ours_has_a_row():
    """In the README's table, with every option of its name; and no row is of nothing."""
    readme = (pathlib.Path(fans.__file__).parent / "README.md").read_text(encoding="utf-8")
    rows = {line.split("`")[1] for line in readme.splitlines() if line.startswith("| `")}
    ours = {name for name, entry in METHODS.items() if entry.worker == OURS}
    needed = {part for name in ours for part in ([name] if name in rows else parts_of(name))}
    assert rows == needed


def parts_of(name: str) -> list[str]:
    """Rows of a method with options: its own, and one per option."""
    method, _, options = name.partition("/")
    return [method, *(f"…/{option}" for option in options.split("-") if option)]
