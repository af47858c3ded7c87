"""Every estimator against light known in closed form, coded here; its variance against the scatter of replicates.

Seeds are fixed, so that each test either always passes or always fails. Bounds are in standard errors.
"""

from __future__ import annotations

import importlib
import math
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np
import pytest
from numba import njit, typeof
from scipy import integrate, stats

from lightproof import suite
from lightproof.estimators import paths, points
from lightproof.estimators.blockers import visible
from lightproof.estimators.estimator import sampled
from lightproof.estimators.lamps import Glow, lamp
from lightproof.estimators.points import Random
from lightproof.estimators.shapes import Parallelogram, flat, triangulated
from lightproof.renderers.registry import METHODS
from lightproof.scene import Scene
from lightproof.scene_file import from_table

SIGMAS = 4.5
CATALOGUE = suite.default()
SAMPLERS = ("mc-area", "mc-area/float64", "mc-hemisphere", "mc-cosine", "path")
SUMS = ("analytic", "riemann-area", "riemann-hemisphere")
AREA = ("mc-area", "mc-area/float64", "path")


def method(name: str, scene: Scene, threads: int = 2):
    """A prepared method."""
    module, cls = METHODS[name].target.split(":")
    made = getattr(importlib.import_module(module), cls)(name, threads)
    made.open()
    assert made.unsupported(scene) is None
    made.prepare(scene)
    return made


def scene(lights: list, film: dict, surfaces: tuple = (), max_bounces: int | str = 0) -> Scene:
    table = {"title": "test", "max_bounces": max_bounces, "tolerance": 0.01, "light": lights, "film": film}
    return from_table({**table, "surface": list(surfaces)}, "test")


def at_points(positions: list, normal: tuple = (0, 0, 1)) -> dict:
    return {"kind": "points", "quantity": "irradiance", "positions": positions, "normals": [normal] * len(positions)}


def area_light(shape: dict, radiance: float = 2.04) -> dict:
    return {"id": "lamp", "kind": "area", "shape": shape, "radiance": radiance}


def rectangle(x: float, y: float, width: float, depth: float, z: float) -> dict:
    """Facing down."""
    corners = [[x, y, z], [x, y + depth, z], [x + width, y + depth, z], [x + width, y, z]]
    return {"type": "polygon", "vertices": corners}


def corner(a: float, b: float, h: float) -> float:
    """Irradiance per radiance under a corner of a parallel rectangle a x b at height h (Howell's catalogue)."""
    a, b = a / h, b / h
    p, q = math.hypot(1, a), math.hypot(1, b)
    return 0.5 * (a / p * math.atan(b / p) + b / q * math.atan(a / q))


def z_score(rendering, expected: float) -> float:
    """Of the film's mean, elements being independent."""
    return (rendering.film.mean() - expected) / (math.sqrt(rendering.variance.sum()) / len(rendering.film))


UNDER_CORNER = scene([area_light(rectangle(0.13, -0.21, 0.9, 0.7, 0.8))], at_points([[0.13, -0.21, 0]]))
SPHERE = {"type": "sphere", "center": [0.3, -0.2, 1.1], "radius": 0.37}
UNDER_SPHERE = scene([area_light(SPHERE)], at_points([[0, 0, 0]]))
DISK = {"type": "disk", "center": [0.1, 0, 0.7], "normal": [0, 0, -1], "radius": 0.37}
UNDER_DISK = scene([area_light(DISK)], at_points([[0.4, 0.3, 0]]))
UNDER_BULB = scene([{"id": "bulb", "kind": "point", "position": [0.3, -0.4, 1.2], "intensity": 2.9}], at_points([[0, 0, 0]]))
IN_BEAM = scene([{"id": "sun", "kind": "directional", "direction": [0.6, 0, -0.8], "irradiance": 3.1}], at_points([[0, 0, 0]]))
SKY = {"id": "sky", "kind": "environment", "radiance": 1.37}
TILTED = (0, -0.6, 0.8)
SUN_DISC = {"id": "sun", "kind": "environment", "radiance": 900.0, "direction": [0, 0.6, -0.8], "half_angle": 12.0}
OVERCAST = {"id": "sky", "kind": "environment", "sky": "cie-overcast", "zenith_radiance": 1.3}


def disk_irradiance(a: float, h: float, r: float) -> float:
    """Per radiance, parallel receiver at offset a (Howell's catalogue)."""
    return math.pi / 2 * (1 - (h * h + a * a - r * r) / math.sqrt((h * h + a * a + r * r) ** 2 - 4 * r * r * a * a))


EXACT = {
    "rectangle": (UNDER_CORNER, 2.04 * corner(0.9, 0.7, 0.8)),
    "sphere": (UNDER_SPHERE, 2.04 * math.pi * 0.37**2 * 1.1 / (0.3**2 + 0.2**2 + 1.1**2) ** 1.5),
    "disk": (UNDER_DISK, 2.04 * disk_irradiance(math.hypot(0.3, 0.3), 0.7, 0.37)),
    "bulb": (UNDER_BULB, 2.9 * 1.2 / (0.3**2 + 0.4**2 + 1.2**2) ** 1.5),
    "beam": (IN_BEAM, 3.1 * 0.8),
    "sky": (scene([SKY], at_points([[0, 0, 0]], TILTED)), math.pi * 1.37),
    "upper sky": (scene([{**SKY, "extent": "upper"}], at_points([[0, 0, 0]], TILTED)), math.pi * 1.37 * (1 + 0.8) / 2),
    "sun": (scene([SUN_DISC], at_points([[0, 0, 0]])), math.pi * 900 * math.sin(math.radians(12)) ** 2 * 0.8),
    "overcast": (scene([OVERCAST], at_points([[0, 0, 0]])), 7 * math.pi * 1.3 / 9),
    "overcast wall": (scene([OVERCAST], at_points([[0, 0, 0]], (0, 1, 0))), 2 / 3 * (math.pi / 4 + 2 / 3) * 1.3),
}


@pytest.mark.parametrize("name", SAMPLERS)
@pytest.mark.parametrize("case", EXACT)
def test_samplers_meet_the_closed_form(name, case):
    """One receiver under each kind of light: the mean of 16 replicates within its standard error, from their own scatter."""
    one, expected = EXACT[case]
    made = instance(name)
    if made.unsupported(one):
        assert (case, name) in REFUSED
        return
    made.prepare(one)
    films = np.array([made.render(20000, seed).film[0] for seed in range(1, 17)])
    assert abs(films.mean() - expected) <= SIGMAS * films.std(ddof=1) / 4 + 2e-7 * expected


def instance(name: str):
    module, cls = METHODS[name].target.split(":")
    return getattr(importlib.import_module(module), cls)(name, 2)


SKIES = ("sky", "upper sky", "sun", "overcast", "overcast wall")
REFUSED = {(case, name) for case in SKIES for name in ("mc-area", "mc-area/float64", "riemann-area")}
REFUSED |= {(case, name) for case in ("bulb", "beam") for name in ("mc-hemisphere", "mc-cosine", "riemann-hemisphere")}


@pytest.mark.parametrize("name", ["riemann-area", "riemann-hemisphere"])
@pytest.mark.parametrize("case", EXACT)
def test_riemann_sums_converge_to_the_closed_form(name, case):
    """The same receivers: off by less than a hundredth at 65,536 samples, and whatever the seed."""
    one, expected = EXACT[case]
    made = instance(name)
    if made.unsupported(one):
        assert (case, name) in REFUSED
        return
    made.prepare(one)
    first, second = made.render(65536, 1), made.render(65536, 2)
    assert made.deterministic and (first.film == second.film).all()
    assert first.film[0] == pytest.approx(expected, rel=1e-2)


def test_riemann_sum_over_the_light_converges_quadratically():
    """Rectangle seen from its corner: the midpoint rule's error falls by 4 from N to 4 N, give or take a tenth."""
    made = method("riemann-area", UNDER_CORNER)
    errors = [abs(made.render(n, 0).film[0] - EXACT["rectangle"][1]) for n in (256, 1024)]
    assert errors[0] / errors[1] == pytest.approx(4, abs=0.4)


@pytest.mark.parametrize("name", ["mc-area", "mc-cosine", "mc-hemisphere", "path"])
def test_variance_is_what_replicates_scatter_by(name):
    """square-light, 192 cells, 64 replicates: the reported variances add up to the observed one within chi-square bounds."""
    made = method(name, CATALOGUE.scene("square-light"))
    results = [made.render(256, seed) for seed in range(1, 65)]
    films = np.array([result.film for result in results])
    reported = np.mean([result.variance for result in results], axis=0)
    freedom = 63 * films.shape[1]
    ratio = (films.var(axis=0, ddof=1) / reported).mean()
    assert abs(ratio - 1) < 8 * math.sqrt(2 / freedom)


DIRECT = ("square-light", "triangle-light", "disk-light", "sphere-light", "occluded-square", "disk-blocker", "square-light-seen")


@pytest.mark.parametrize("name", ["mc-area", "mc-area/float64", "mc-cosine", "mc-hemisphere"])
@pytest.mark.parametrize("scene_id", DIRECT)
def test_methods_agree_with_the_analytic_one(name, scene_id):
    """Every element of direct scenes against the analytic estimator: z-scores have variance 1 and mean 0, and none is wild."""
    one = CATALOGUE.scene(scene_id)
    exact = method("analytic", one).render(256, 0).film
    result = method(name, one).render(4096, 5)
    lit = result.variance > 0
    z = (result.film[lit] - exact[lit]) / np.sqrt(result.variance[lit])
    assert abs(z.mean()) < SIGMAS / math.sqrt(len(z))
    if name.startswith("mc-area"):  # the others meet the light too seldom for a normal law
        assert np.abs(z).max() < stats.norm.isf(1e-7)


@pytest.mark.parametrize("name", ["mc-area", "mc-hemisphere", "path"])
@pytest.mark.parametrize("samples", [1000, 5001])
def test_threads_change_nothing(name, samples):
    """occluded-square with 1, 2 and 5 threads: bit for bit the same film and variance."""
    one = CATALOGUE.scene("occluded-square")
    results = [method(name, one, threads).render(samples, 77) for threads in (1, 2, 5)]
    for result in results[1:]:
        assert (result.film == results[0].film).all() and (result.variance == results[0].variance).all()


def test_one_element_alone_uses_all_threads_and_changes_nothing():
    """One point, a million samples, cut into blocks: the same for 1 and 2 threads, the same seed, another for another."""
    one, two = (method("mc-area", UNDER_CORNER, threads) for threads in (1, 2))
    assert (one.render(1 << 20, 3).film == two.render(1 << 20, 3).film).all()
    assert (one.render(1 << 20, 3).film != two.render(1 << 20, 4).film).all()


@pytest.mark.parametrize("name", ["mc-area", "mc-area/float64"])
def test_sums_have_no_bias_from_rounding(name):
    """A cell of 0.1 mm far from a small light, where the integrand varies little, 16 M samples: within 1e-6 and the noise."""
    film = {"kind": "plane", "quantity": "irradiance", "origin": [0.2, 0.3, 0], "u": [1e-4, 0, 0], "v": [0, 1e-4, 0]}
    one = scene([area_light(rectangle(-0.02, -0.02, 0.04, 0.04, 3.1))], {**film, "resolution": [1, 1]})
    result = method(name, one).render(1 << 24, 9)
    exact = method("analytic", one).render(16, 0).film[0]
    assert abs(result.film[0] / exact - 1) < 1e-6 + SIGMAS * math.sqrt(result.variance[0]) / exact


def test_half_a_million_metres_from_the_origin_nothing_changes():
    """square-light and its film moved by 500 km in x and y: the single-precision film differs by less than 1e-6."""
    table = CATALOGUE.scene("square-light").to_table()
    shift = np.array([5e5, -5e5, 0])
    light, film = table["light"][0], table["film"]
    moved_shape = {**light["shape"], "vertices": [list(shift + v) for v in light["shape"]["vertices"]]}
    moved_film = {**film, "origin": list(shift + film["origin"])}
    moved = from_table({**table, "light": [{**light, "shape": moved_shape}], "film": moved_film}, "moved")
    here, there = (method("mc-area", one).render(4096, 2).film for one in (CATALOGUE.scene("square-light"), moved))
    assert np.abs(there / here - 1).max() < 1e-6


def test_umbra_is_exactly_black():
    """occluded-square: where the analytic film is zero, mc-area's film and variance are zero, not small."""
    film = scene_with_film("occluded-square", origin=[0.0, -0.45, 0.55], u=[0.2, 0, 0], v=[0, 0.2, 0], resolution=[4, 4])
    result = method("mc-area", film).render(4096, 1)
    assert (result.film == 0).all() and (result.variance == 0).all()


def scene_with_film(name: str, **changes) -> Scene:
    one = CATALOGUE.scene(name)
    return replace(one, film=replace(one.film, **{key: tuple(value) for key, value in changes.items()}))


@pytest.mark.parametrize("count", [2, 5])
def test_several_blockers_overlap_and_are_not_multiplied(count):
    """A bar of `count` squares side by side before a square light, against one rectangle: the same film."""
    edges = np.linspace(-0.4, 0.4, count + 1)
    bar = [blocker(f"b{i}", rectangle(a, -0.2, b - a, 0.4, 0.5)) for i, (a, b) in enumerate(pairwise(edges))]
    light, film = [area_light(rectangle(-0.5, -0.5, 1, 1, 1.2))], at_points([[0.1, 0.05, 0], [0.5, 0.3, 0], [0.9, 0, 0]])
    parts, whole = scene(light, film, tuple(bar)), scene(light, film, (blocker("b", rectangle(-0.4, -0.2, 0.8, 0.4, 0.5)),))
    exact = [method("analytic", one).render(1, 0).film for one in (parts, whole)]
    assert exact[0] == pytest.approx(exact[1], rel=1e-12)
    result = method("mc-area", parts).render(1 << 18, 6)
    assert (np.abs(result.film - exact[1]) < SIGMAS * np.sqrt(result.variance)).all()


def blocker(name: str, shape: dict) -> dict:
    return {"id": name, "shape": shape, "reflectance": 0}


ELL = [[0, 0, 0.6], [0.3, 0, 0.6], [0.3, 0.1, 0.6], [0.1, 0.1, 0.6], [0.1, 0.3, 0.6], [0, 0.3, 0.6]]
BLOCKERS = {
    "sphere": {"type": "sphere", "center": [0.1, 0, 0.6], "radius": 0.2},
    "disk": {"type": "disk", "center": [0.1, 0, 0.6], "normal": [0.3, 0.1, 1], "radius": 0.25},
    "triangle": {"type": "polygon", "vertices": [[0, 0, 0.6], [0.3, 0, 0.5], [0.1, 0.4, 0.7]]},
    "l-shape": {"type": "polygon", "vertices": ELL},
}


@pytest.mark.parametrize("shape", [[name] for name in BLOCKERS] + [list(BLOCKERS)], ids="-".join)
def test_fast_shadows_are_the_ray_tracer_s(shape):
    """mc-area against traced paths, two codes of visibility, behind each shape of blocker, and behind all of them at once."""
    blockers = tuple(blocker(name, BLOCKERS[name]) for name in shape)
    one = scene([area_light(rectangle(-0.5, -0.5, 1, 1, 1.2))], at_points([[0.1, 0.05, 0], [0.5, 0.3, 0]]), blockers)
    fast = method("mc-area", one).render(1 << 17, 1)
    film, _, variance = sampled(partial(paths.paths(one).add, Random(1 << 17, 2)), one.size, 1 << 17, 2)
    assert (np.abs(fast.film - film) < SIGMAS * np.sqrt(fast.variance + variance)).all()


def test_a_light_blocks_another_light_and_lights_add_up():
    """A small lamp under a large one, both facing down: the receiver gets both, less what the small one hides of the large."""
    low, high = rectangle(-0.2, -0.2, 0.4, 0.4, 0.6), rectangle(-0.6, -0.6, 1.2, 1.2, 1.2)
    film = at_points([[0, 0, 0]])
    one = scene([{**area_light(low, 0.7), "id": "low"}, area_light(high)], film)
    expected = 0.7 * 4 * corner(0.2, 0.2, 0.6) + 2.04 * 4 * (corner(0.6, 0.6, 1.2) - corner(0.4, 0.4, 1.2))
    assert method("analytic", one).render(1, 0).film[0] == pytest.approx(expected, rel=1e-13)
    result = method("mc-area", one).render(1 << 18, 8)
    assert abs(result.film[0] - expected) < SIGMAS * math.sqrt(result.variance[0])


@pytest.mark.parametrize("bounces", [0, 1, 5, "all"])
@pytest.mark.parametrize("reflectance", [0.0, 0.6, 0.99])
def test_paths_in_a_glowing_sphere(bounces, reflectance):
    """Le (1 - rho^(k+1))/(1 - rho) after k reflections, seen by a camera from inside."""
    base = CATALOGUE.scene("sphere-furnace")
    one = replace(base, surfaces=(replace(base.surfaces[0], reflectance=reflectance),), max_bounces=bounces)
    terms = math.inf if bounces == "all" else bounces + 1
    expected = 0.83 * (1 - reflectance**terms) / (1 - reflectance)
    result = method("path", one).render(64, 3)
    assert abs(result.film.mean() - expected) < SIGMAS * math.sqrt(result.variance.sum()) / one.size + 1e-12
    assert method("analytic", one).render(4, 0).film == pytest.approx(np.full(one.size, expected), rel=1e-13)


OFF_CENTRE = "off-centre-point-in-sphere"


@pytest.mark.parametrize("name", [OFF_CENTRE, f"{OFF_CENTRE}:irradiance", "sphere-furnace:irradiance"])
def test_paths_agree_with_closed_forms_of_interreflection(name):
    """A point light off the centre of a diffuse sphere, and points of a furnace's wall, element by element."""
    one = CATALOGUE.scene(name)
    exact, result = method("analytic", one).render(256, 0).film, method("path", one).render(2048, 4)
    assert (np.abs(result.film - exact) < 5 * np.sqrt(result.variance) + 1e-9).all()


def test_path_counts_the_receiver_s_neighbour_once():
    """A lit floor reflects onto a wall: a fifth method, a double Riemann sum in numpy, gives the wall's irradiance."""
    square = {"type": "polygon", "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]}
    floor = {"id": "floor", "shape": square, "reflectance": 0.7}
    beam = {"id": "beam", "kind": "directional", "direction": [0, 0, -1], "irradiance": 3.1}
    one = scene([beam], at_points([[0, 0.4, 0.3]], (1, 0, 0)), (floor,), max_bounces=1)
    x, y = np.meshgrid((np.arange(2000) + 0.5) / 2000, (np.arange(2000) + 0.5) / 2000)
    r2 = x**2 + (y - 0.4) ** 2 + 0.3**2
    expected = 0.7 * 3.1 / math.pi * (x * 0.3 / r2**2).mean()
    result = method("path", one).render(1 << 17, 5)
    assert abs(result.film[0] - expected) < SIGMAS * math.sqrt(result.variance[0])


def test_no_visibility_code_without_blockers():
    """A surface behind the receiver cannot cast a shadow: the kernel gets no blockers, and for none `visible` is a constant;
    its machine code holds fewer comparisons than that for one blocker."""
    behind = blocker("floor", rectangle(-1, -1, 2, 2, -0.3))
    open_scene = scene([area_light(rectangle(0, 0, 1, 1, 1))], at_points([[0, 0, 0]]), (behind,))
    assert method("mc-area", open_scene).pieces[0].blockers == ()
    (blocked,) = method("mc-area", CATALOGUE.scene("occluded-square")).pieces
    assert len(blocked.blockers) == 1
    assert comparisons(()) < comparisons(blocked.blockers)


SQUARE = flat(Parallelogram, np.array([0, 0, 1.0]), np.array([1.0, 0, 0]), np.array([0, 1.0, 0]))


def comparisons(blockers: tuple) -> int:
    """Floating-point comparisons in the code compiled for a square light and such blockers."""
    signature = (typeof(lamp(Glow("", SQUARE, 1.0))), typeof(blockers))
    compiled = njit(lambda lamp, blockers: visible(blockers, lamp.shape.center, lamp.shape.u))
    compiled.compile(signature)
    return sum("fcmp" in line for line in compiled.inspect_llvm(compiled.signatures[0]).splitlines())


def test_reasons_name_what_is_in_the_way():
    """Unsupported scenes: the answer names the light or the reflection, and what can do it."""
    assert "'sky'" in instance("mc-area").unsupported(EXACT["sky"][0])
    assert "'bulb'" in instance("mc-cosine").unsupported(UNDER_BULB)
    assert "path can" in instance("mc-area").unsupported(CATALOGUE.scene("sphere-furnace"))
    cylinder = {"type": "cylinder", "base": [0, 0, 1], "axis": [1, 0, 0], "height": 1, "radius": 0.1}
    tube = scene([area_light(cylinder)], at_points([[0, 0, 0]]))
    assert all("'lamp'" in instance(name).unsupported(tube) for name in (*SAMPLERS, *SUMS) if name != "analytic")
    assert instance("analytic").unsupported(tube) is None


def test_prepare_reports_setup_and_compile():
    """Phases in seconds, both there and not negative."""
    phases = instance("mc-area").prepare(UNDER_CORNER)
    assert set(phases) == {"setup", "compile"} and min(phases.values()) >= 0


def test_samples_are_what_was_spent():
    """A hexagon, four triangles, and grids that need squares: the number reported is the number of samples drawn."""
    corners = [[0.5 * math.cos(a), -0.5 * math.sin(a), 1] for a in np.arange(6) * math.pi / 3]
    hexagon = scene([area_light({"type": "polygon", "vertices": corners})], at_points([[0, 0, 0]]))
    made = method("mc-area", hexagon)
    drawn = sum(round(1000 * share) for share in made.shares)
    assert len(made.pieces) == 4 and made.render(1000, 1).samples == drawn == pytest.approx(1000, abs=4)
    assert method("mc-cosine", hexagon).render(1000, 1).samples == 1000
    assert method("riemann-area", UNDER_CORNER).render(1000, 1).samples == 32**2
    assert method("mc-area", UNDER_CORNER).render(1, 1).variance is None


def test_triangles_of_a_polygon_cover_it():
    """An L and a star with a collinear corner: the triangles' areas add up, each turned the polygon's way."""
    ell = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0], [1, 2, 0], [0, 2, 0], [0, 1, 0]], float)
    areas = [np.cross(b - a, c - a)[2] / 2 for a, b, c in triangulated(ell)]
    assert sum(areas) == pytest.approx(3) and min(areas) >= 0


def test_block_is_where_precision_changes():
    """Samples that do not fill the last block are drawn all the same: N and N + 1 around a block's edge differ by one value."""
    made = method("mc-area/float64", UNDER_CORNER)
    less, more = (made.render(n, 5).film[0] * n for n in (points.BLOCK, points.BLOCK + 1))
    assert 0 < more - less < 5 * EXACT["rectangle"][1]


def test_analytic_light_that_grazes_keeps_its_digits():
    """A square 1e-5 m above the receiver's plane, beside it, where Lambert's sum cancels, and one 11 cm above:
    cos cos / r^2 integrated by scipy."""
    for height in (1e-5, 0.11):
        one = scene([area_light(rectangle(-0.39, -0.73, 1.04, 1.04, height), 1.0)], at_points([[1.125, 0.675, 0]]))
        bounds = (-0.39 - 1.125, 0.65 - 1.125, -0.73 - 0.675, 0.31 - 0.675)
        exact, _ = integrate.dblquad(lambda y, x, h=height: h**2 / (x**2 + y**2 + h**2) ** 2, *bounds, epsabs=0, epsrel=1e-13)
        assert method("analytic", one).render(1, 0).film[0] == pytest.approx(exact, rel=1e-11)
