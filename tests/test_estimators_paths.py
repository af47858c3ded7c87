"""Paths: every step of a batch against its density or another code, every scene that reflects against its exact light.

Seeds are fixed, so that each test either always passes or always fails.
"""

from __future__ import annotations

import importlib
import math
from functools import partial

import numpy as np
import pytest
from numba import njit, typeof
from scipy import stats

from lightproof import suite
from lightproof.estimators import aiming, batch, directions, recursion, rounds, shapes
from lightproof.estimators.batch import NORMAL, PLACE, SIZE, TOTAL, WAY, WEIGHT
from lightproof.estimators.estimator import sampled
from lightproof.estimators.path_recursion import PathRecursion
from lightproof.estimators.paths import paths
from lightproof.estimators.points import Random
from lightproof.estimators.rng import block_keys, draws, stream
from lightproof.estimators.world import build
from lightproof.renderers.registry import METHODS
from lightproof.scene import Scene
from lightproof.scene_file import from_table

RARE = 1e-6  # a fixed seed that falls below is no accident
CATALOGUE = suite.default()
AXIS = np.array([0.48, -0.6, 0.64])


def named(name: str, label: str) -> Scene:
    return CATALOGUE.cases(name)[label]


def films(name: str, scene: Scene, samples: int, replicates: int = 16) -> np.ndarray:
    """(replicates, n)."""
    module, cls = METHODS[name].target.split(":")
    made = getattr(importlib.import_module(module), cls)(name, 2)
    assert made.unsupported(scene) is None
    made.prepare(scene)
    return np.array([made.render(samples, seed).film for seed in range(1, replicates + 1)])


def unbiased(found: np.ndarray, exact: np.ndarray) -> bool:
    """Whether the mean of replicates (k, n) lies within Student's bounds everywhere, and over the film."""
    found, exact = (np.column_stack([film, film.mean(axis=1)]) for film in (found, exact[None]))
    error = found.std(axis=0, ddof=1) / math.sqrt(len(found))
    allowed = stats.t.isf(RARE / 2, len(found) - 1) * error + 1e-9 * np.abs(exact)
    return bool(np.isfinite(found).all() and (np.abs(found.mean(axis=0) - exact[0]) <= allowed).all())


REFLECTING = [
    *(("sphere-furnace", case) for case in ("base", "five-reflections")),
    *(("two-zone-sphere", case) for case in ("base", "black-floor", "two-reflections")),
    *(("cube-room", case) for case in ("base", "four-reflections")),
    ("concentric-spheres", "irradiance"),
    ("cube-furnace", "tetrahedron"),
    ("lit-floor-to-wall", "screen"),
]


@pytest.mark.parametrize(("name", "label"), REFLECTING)
def test_paths_have_no_bias(name, label):
    """Rooms, spheres, caps, cameras and receivers, all reflections and few: the reference within the replicates' scatter."""
    scene = named(name, label)
    samples = max(64, 2**16 // scene.size)
    assert unbiased(films("path", scene, samples), CATALOGUE.reference(scene).value)


def test_places_in_order_have_no_bias_and_less_noise():
    """A sphere before a sky, where all noise is at its rim: shares of pixels, over several blocks of the sequence."""
    scene = named("white-furnace-sphere", "base")
    exact = CATALOGUE.reference(scene).value
    ordered, independent = (films(name, scene, 5000) for name in ("path/sobol", "path"))
    assert unbiased(ordered, exact)
    assert ((ordered - exact) ** 2).mean() < 0.1 * ((independent - exact) ** 2).mean()


SPHERES = ("sphere-furnace", "centred-point-in-sphere", "off-centre-point-in-sphere", "two-zone-sphere", "emitting-cap")
IN_SPHERES = [(name, label) for name in SPHERES for label in CATALOGUE.cases(name)]


@pytest.mark.parametrize(("name", "label"), IN_SPHERES)
def test_recursion_has_no_bias(name, label):
    """Every sphere of the catalogue."""
    scene = named(name, label)
    assert unbiased(films("path/recursion", scene, 256), CATALOGUE.reference(scene).value)


TWO_ZONES = named("two-zone-sphere", "base").to_table()
BULBS = [{"id": "low", "kind": "point", "position": [0.9, -0.5, 0.1], "intensity": 1.7},
         {"id": "high", "kind": "point", "position": [0.1, 0.4, 1.4], "intensity": 0.9}]  # fmt: skip
WITHIN = {"kind": "plane", "quantity": "irradiance", "origin": [-0.2, -0.9, 0.2], "u": [1, 0.2, 0], "v": [-0.1, 1, 0.5],
          "resolution": [2, 2]}  # fmt: skip


@pytest.mark.parametrize("bounces", [0, 1, 2, "all"])
def test_recursion_is_what_paths_find_within_a_sphere(bounces):
    """Two zones of which one glows, two bulbs off the centre, a plane across the sphere, where no closed form is: the same light
    as by traced paths, with less noise."""
    floor, vault = TWO_ZONES["surface"]
    table = {**TWO_ZONES, "light": BULBS, "surface": [{**floor, "radiance": 0.4}, vault], "film": WITHIN, "max_bounces": bounces}
    scene = from_table(table, "test")
    known, traced = (films(name, scene, 4096) for name in ("path/recursion", "path"))
    error = np.sqrt((known.var(axis=0, ddof=1) + traced.var(axis=0, ddof=1)) / 16)
    assert (np.abs(known.mean(axis=0) - traced.mean(axis=0)) < 5 * error + 1e-12).all()
    assert known.var(axis=0).mean() <= traced.var(axis=0).mean() * 1.2


def test_recursion_says_where_it_does_not_hold():
    """A room, a body in the sphere, a light that is no point, a receiver that does not face the centre."""
    furnace = named("sphere-furnace", "irradiance").to_table()
    turned = {**furnace, "film": {**furnace["film"], "normals": [[-1, 0, 1], [0, -1, 0], [0, 0, 1]]}}
    sky = {**furnace, "light": [{"id": "sky", "kind": "environment", "radiance": 1.0}]}
    reasons = {
        "inside one sphere": [named("cube-room", "base"), named("concentric-spheres", "base")],
        "'sky' is not": [from_table(sky, "test")],
        "face its centre": [from_table(turned, "test")],
    }
    for reason, scenes in reasons.items():
        for scene in scenes:
            assert reason in PathRecursion("path/recursion", 1).unsupported(scene)


QUAD = {"type": "polygon", "vertices": [[-0.5, -0.5, 1.5], [-0.5, 0.5, 1.5], [0.5, 0.5, 1.5], [0.5, -0.5, 1.5]]}
KINDS = [
    {"type": "polygon", "vertices": [[0, 0, 0.6], [0.3, 0, 0.5], [0.1, 0.4, 0.7]]},
    {"type": "polygon", "vertices": [[-0.4, 0, 0.4], [-0.4, 0.2, 0.5], [-0.2, 0.2, 0.5], [-0.2, 0, 0.4]]},
    {"type": "disk", "center": [0.1, -0.4, 0.6], "normal": [0.3, 0.1, 1], "radius": 0.25},
    {"type": "sphere", "center": [0.5, 0.3, 0.6], "radius": 0.2},
    {"type": "cap", "center": [-0.3, -0.5, 0.6], "radius": 0.25, "axis": [0.2, 0, 1], "half_angle": 70},
]
AROUND = {"kind": "points", "quantity": "irradiance", "positions": [[0.1, 0.05, 0], [0.5, 0.3, 0], [-0.4, -0.4, 0.1]],
          "normals": [[0, 0, 1], [0.3, -0.2, 1], [0.1, 0.2, 1]]}  # fmt: skip
SKIES = [{"id": "sun", "kind": "environment", "radiance": 30.0, "direction": [0, 0.6, -0.8], "half_angle": 25.0},
         {"id": "sky", "kind": "environment", "sky": "cie-overcast", "zenith_radiance": 1.3}]  # fmt: skip


def crowded(copies: int, lights: list, kinds: list = KINDS) -> Scene:
    """Blockers of all `kinds`, `copies` of each beside one another; some glow."""
    surfaces = [{"id": f"s{k}-{i}", "shape": moved(shape, 1.3 * k), "reflectance": 0, "radiance": 0.2 * i}
                for k in range(copies) for i, shape in enumerate(kinds)]  # fmt: skip
    table = {"title": "test", "max_bounces": 0, "tolerance": 0.01, "light": lights, "surface": surfaces, "film": AROUND}
    return from_table(table, "test")


def moved(shape: dict, by: float) -> dict:
    if "center" in shape:
        return {**shape, "center": [shape["center"][0] + by, *shape["center"][1:]]}
    return {**shape, "vertices": [[x + by, y, z] for x, y, z in shape["vertices"]]}


def test_rays_meet_what_the_scalar_tracer_meets():
    """A lamp, a sun, a sky and five kinds of things that glow and block: directions by paths, and by rays one after the other."""
    scene = crowded(3, [{"id": "lamp", "kind": "area", "shape": QUAD, "radiance": 2.04}, *SKIES])
    items, skies, _, film, elements, contact = build(scene).arrays

    def add(first: int, last: int, span: tuple[int, int], out: np.ndarray) -> None:
        directions.estimate(items, skies, film, elements[first:last], contact, first, 3, span, 1, out)

    ours, theirs = (sampled(one, scene.size, 2**16, 2) for one in (partial(paths(scene, aim=False).add, Random(2**16, 3)), add))
    error = np.sqrt(ours[2] + theirs[2])
    assert (np.abs(ours[0] - theirs[0]) < 4.5 * error).all()
    assert ours[2] == pytest.approx(theirs[2], rel=0.06)


def test_shadows_are_where_directions_find_them():
    """A quadrilateral and a cap before two round lamps: next-event estimation and directions alone."""
    lamps = [{"type": "sphere", "center": [-0.6, 0.7, 1.2], "radius": 0.3},
             {"type": "cap", "center": [0.8, -0.6, 1.2], "radius": 0.4, "axis": [-0.3, 0.4, -1], "half_angle": 60}]  # fmt: skip
    lights = [{"id": f"l{i}", "kind": "area", "shape": shape, "radiance": 2.0 + i} for i, shape in enumerate(lamps)]
    scene = crowded(1, lights, kinds=[KINDS[1], KINDS[4]])
    aimed, met = (films(name, scene, 2**14) for name in ("path", "path/no-next-event"))
    error = np.sqrt((aimed.var(axis=0, ddof=1) + met.var(axis=0, ddof=1)) / 16)
    assert (np.abs(aimed.mean(axis=0) - met.mean(axis=0)) < 5 * error).all()


def test_a_thousand_things_take_the_same_kernel_as_five():
    """What is compiled goes by the kinds of things, not by their number."""
    few, many = (paths(crowded(copies, SKIES)).scenery for copies in (1, 200))
    assert typeof(few) == typeof(many) and len(many.met) == 1001


def test_only_what_is_there_is_composed():
    """A cube around a bulb: nothing can stand between, and there are no lamps nor skies; a screen in the room can."""
    room = paths(named("cube-room", "base")).scenery
    assert (room.blockers, room.lamps, room.skies) == ((), (), ()) and len(room.solids) == len(room.bulbs) == 1
    table = named("cube-room", "base").to_table()
    screen = {"id": "screen", "shape": KINDS[1], "reflectance": 0.0}
    (group,) = paths(from_table({**table, "surface": [*table["surface"], screen]}, "test")).scenery.blockers
    assert group.numbers.tolist() == [7]
    assert paths(named("two-zone-sphere", "base")).scenery.blockers == ()


@njit
def scattered(normal, count):
    state, out = np.empty(batch.ROWS * SIZE), np.empty((count * SIZE, 3))
    for k in range(count):
        for i in range(SIZE):
            batch.put(state, NORMAL, i, normal)
        rounds.scatter(state, SIZE, block_keys(stream(31, k, 0), 0))
        for i in range(SIZE):
            out[k * SIZE + i, 0], out[k * SIZE + i, 1], out[k * SIZE + i, 2] = batch.at(state, WAY, i)
    return out


@njit
def spots(shape, x, count):
    out = np.empty((count * SIZE, 3))
    for k in range(count):
        keys = block_keys(stream(32, k, 0), 0)
        for i in range(SIZE):
            s, t = draws(i, keys, 1.0)[:2]
            row = out[k * SIZE + i]
            row[0], row[1], row[2] = aiming.spot(shape, 1.0, x, s, t)[0]
    return out


@njit
def jumped(zone, count):
    state, out = np.empty(batch.ROWS * SIZE), np.empty((count * SIZE, 6))
    for k in range(count):
        for i in range(SIZE):
            batch.put(state, PLACE, i, (0.0, 0.0, 0.0))
            state[WEIGHT + i] = 1.0
        recursion.jump(zone, 0.5, state, SIZE, block_keys(stream(33, k, 0), 0))
        for i in range(SIZE):
            row = out[k * SIZE + i]
            row[0], row[1], row[2] = batch.at(state, PLACE, i)
            row[3], row[4], row[5] = batch.at(state, NORMAL, i)
    return out


def p_uniform(a: np.ndarray, b: np.ndarray, bins: int = 16) -> float:
    """p-value of a chi-square test that pairs in [0, 1] fill a square alike."""
    cells = np.clip(a * bins, 0, bins - 1).astype(int) * bins + np.clip(b * bins, 0, bins - 1).astype(int)
    return stats.chisquare(np.bincount(cells, minlength=bins**2)).pvalue


def around(w: np.ndarray, axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cosine from an axis, and the turn about it in [0, 1)."""
    side = np.cross(axis, [1.0, 0, 0])
    side /= np.linalg.norm(side)
    return w @ axis, np.arctan2(w @ np.cross(axis, side), w @ side) / (2 * np.pi) % 1


def test_directions_follow_the_cosine():
    """About a slanting normal: the squared cosine and the turn are uniform, lengths are 1."""
    w = scattered(tuple(AXIS), 256)
    cosine, turn = around(w, AXIS)
    assert p_uniform(cosine**2, turn) > RARE
    assert np.linalg.norm(w, axis=1) == pytest.approx(1, abs=1e-12)


def test_round_lamps_are_sampled_uniformly():
    """A sphere from outside, over the cap that faces the vertex, and a cap: height and turn are uniform (Archimedes)."""
    center, radius, x = np.array([0.2, -0.3, 0.8]), 0.31, np.array([0.5, 0.1, -0.4])
    away = x - center
    rim = radius / np.linalg.norm(away)
    cosine, turn = around((spots(shapes.Sphere(tuple(center), radius), tuple(x), 256) - center) / radius,
                          away / np.linalg.norm(away))  # fmt: skip
    assert p_uniform((cosine - rim) / (1 - rim), turn) > RARE
    cap = shapes.Cap(tuple(center), radius, tuple(AXIS), -0.3)
    cosine, turn = around((spots(cap, tuple(x), 256) - center) / radius, AXIS)
    assert p_uniform((cosine + 0.3) / 1.3, turn) > RARE


def test_vertices_of_the_recursion_are_uniform_over_their_zone():
    """On the wall, facing the centre; height and turn are uniform."""
    zone = shapes.Cap((0.3, -0.2, 0.4), 1.7, tuple(AXIS), 0.35)
    found = jumped(zone, 256)
    cosine, turn = around(-found[:, 3:], AXIS)
    assert p_uniform((cosine - 0.35) / 0.65, turn) > RARE
    assert found[:, :3] == pytest.approx(np.array(zone.center) - 1.7 * found[:, 3:], abs=1e-12)


@njit
def played(weights, faint, count):
    state, out = np.empty(batch.ROWS * SIZE), np.zeros(SIZE)
    for k in range(count):
        for i in range(SIZE):
            state[WEIGHT + i] = weights[i]
        rounds.play(state, SIZE, block_keys(stream(34, k, 0), 0), faint)
        for i in range(SIZE):
            out[i] += state[WEIGHT + i] / count
    return out


def test_roulette_keeps_the_expectation():
    """Weights from 0 to twice what is faint: their means over 20,000 games stay, to five standard errors."""
    weights, games = np.linspace(0, 0.1, SIZE), 20000
    found = played(weights, 0.05, games)
    error = np.sqrt(np.maximum(weights * (0.05 - weights), 0) / games)
    assert (np.abs(found - weights) <= 5 * error + 1e-12).all()


def test_moving_together_loses_no_path():
    """Every second path has ended: all are settled in their places, the others stand at the front in order."""
    state, slots, totals = np.zeros(batch.ROWS * SIZE), np.arange(SIZE, dtype=np.uint32)[::-1].copy(), np.zeros(SIZE)
    state[TOTAL:TOTAL + SIZE] = np.arange(SIZE)
    state[WEIGHT:WEIGHT + SIZE] = np.arange(SIZE) % 2
    assert batch.keep(state, slots, totals, SIZE, SIZE // 2) == SIZE // 2
    assert (totals == np.arange(SIZE)[::-1]).all()
    assert (state[TOTAL:TOTAL + SIZE // 2] == np.arange(1, SIZE, 2)).all()
    assert (slots[:SIZE // 2] == np.arange(SIZE - 2, -1, -2)).all()
