"""What the adapters make of a scene: views, meshes, reflections, integrators; and every base scene against its reference."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import one_process
import pytest
from one_process import Shot

from lightproof import geometry, scene_file, suite
from lightproof.geometry import Cap, Cylinder, Disk, Polygon, Sphere
from lightproof.method import Unavailable
from lightproof.renderers import importing, mesh, mitsuba, transport, views

SUITE = suite.default()
L_SHAPE = Polygon(((0, 0, 1), (3, 0, 1), (3, 1, 1), (1, 1, 1), (1, 2, 1), (0, 2, 1)))
ROUND = {"disk": Disk((0.1, 0.2, 0.3), (1, 2, 2), 0.7), "cylinder": Cylinder((0.1, 0.2, 0.3), (1, 2, 2), 1.3, 0.7),
         "cap": Cap((0.1, 0.2, 0.3), 0.7, (1, 2, 2), 110)}


def test_meshes_keep_the_area():
    """An L of area 4, a disk, a cylinder, a cap and a sphere of radius 0.7: their triangles have that area, fronts outward."""
    ball = mesh.tessellate(Sphere((0.1, 0.2, 0.3), 0.7))
    assert ball.area == pytest.approx(4 * np.pi * 0.49, rel=1e-12)
    assert mesh.tessellate(L_SHAPE).area == pytest.approx(4, rel=1e-12)
    for shape in ROUND.values():
        assert mesh.tessellate(shape).area == pytest.approx(shape.area, rel=1e-12)
    assert mesh.tessellate(L_SHAPE).subdivided(3).area == pytest.approx(4, rel=1e-12)
    assert len(mesh.tessellate(L_SHAPE).subdivided(3).triangles) == 4 * 64


@pytest.mark.parametrize(("shape", "normal"), [(L_SHAPE, (0, 0, 1)), (ROUND["disk"], (1 / 3, 2 / 3, 2 / 3))])
def test_flat_meshes_face_as_their_shape(shape: geometry.Shape, normal: geometry.Vec3):
    """All triangles of a polygon and a disk turn counter-clockwise around the front normal."""
    made = mesh.tessellate(shape)
    a, b, c = made.vertices[made.triangles].transpose(1, 0, 2)
    np.testing.assert_allclose(geometry.unit(np.cross(b - a, c - a)), np.tile(normal, (len(a), 1)), atol=1e-9)


def test_a_sphere_seen_from_inside_holds_the_true_sphere():
    """Every triangle's plane lies at least one radius from the centre, and no more than one part in 10,000 further."""
    wall = mesh.tessellate(Sphere((0, 0, 0), 1.7), inside=True)
    assert -wall.insphere >= np.linalg.norm(wall.vertices, axis=1).max() * (1 - 1e-4)
    assert wall.flipped().insphere == pytest.approx(1.7, rel=1e-12)


def test_reflections_that_matter():
    """square-light has no surfaces: 0. sphere-furnace at reflectance 0.5 and tolerance 0.001 needs 20 for all, at 0.99 more
    than Cycles takes, though within its limit what is lost is still a tenth of the tolerance."""
    assert transport.reflections(SUITE.scene("square-light")) == 0
    assert transport.reflections(SUITE.scene("sphere-furnace")) == 20
    assert transport.reflections(SUITE.scene("sphere-furnace:five-reflections")) == 5
    brightest = SUITE.scene("sphere-furnace:brightest")
    assert transport.reflections(brightest) == 1375
    assert transport.reflections(brightest, 1024) == 1024
    assert transport.unsupported(brightest, 1024) is None
    assert transport.unsupported(brightest, 500) == "917 reflections matter here, and at most 500 are followed"


def test_only_faint_paths_may_end_early():
    """Reflectance 0.5: after 10 of 20 reflections a path is below a thousandth; five are made in any case."""
    assert transport.certain(SUITE.scene("sphere-furnace")) == 10
    assert transport.certain(SUITE.scene("sphere-furnace:five-reflections")) == 5
    assert transport.certain(SUITE.scene("square-light")) == 0


@pytest.mark.parametrize(("scene", "integrator"), [
    ("square-light", {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}),
    ("square-light-seen", {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}),
    ("white-furnace-plane", {"type": "direct", "emitter_samples": 0, "bsdf_samples": 1}),
    ("sphere-furnace:black", {"type": "path", "max_depth": 1, "rr_depth": 2}),
    ("sphere-furnace:five-reflections", {"type": "path", "max_depth": 6, "rr_depth": 7}),
    ("sphere-furnace:irradiance", {"type": "path", "max_depth": 22, "rr_depth": 23}),
])
def test_mitsuba_is_configured_lean(scene: str, integrator: dict[str, object]):
    """Lights are sampled where one reflection counts, the sky by direction; a path is as long as the scene asks."""
    assert mitsuba.integrator(SUITE.scene(scene)) == integrator


def test_a_plane_film_is_seen_from_just_above():
    """square-light's film, 16 x 12 cells of 0.15 m at z = 0: a camera above its middle looks down, and the image's bottom row
    is the film's first. White receiver: E = pi L."""
    (view,) = views.views(SUITE.scene("square-light"))
    assert view.half == (1.2, 0.9) and view.resolution == (16, 12)
    np.testing.assert_allclose(view.target, [0, 0, 0], atol=1e-5)
    assert 0 < view.near < view.origin[2] < 1e-3
    image = np.arange(12.0)[:, None] + np.zeros(16)
    np.testing.assert_allclose(view.elements(image)[:16], np.pi * 11)


def test_a_point_is_seen_as_a_small_square():
    """disk-light:axis, five points above a floor: squares of a thousandth of the distance to the lamp, lying at the points."""
    scene = SUITE.scene("disk-light:axis")
    for view, position in zip(views.views(scene), scene.film.positions, strict=True):
        distance = np.linalg.norm(np.subtract(position, scene.lights[0].shape.center))
        assert 2 * max(view.half) <= 1.01e-3 * distance
        np.testing.assert_allclose(view.target, position, atol=1e-4 * distance)


def test_a_point_just_above_a_floor_is_a_square_clear_of_it():
    """lit-floor-to-wall:points, on the wall 0.4 mm above the floor's edge: a square a twentieth as wide. On a furnace's wall:
    a thousandth of a tenth of its size, since a point has no distance from what it lies on."""
    scene = SUITE.scene("lit-floor-to-wall:points")
    view = views.views(scene)[scene.film.positions.index((0, 0.31, 0.0004))]
    np.testing.assert_allclose(2 * max(view.half), 2e-5)
    furnace = SUITE.scene("sphere-furnace:irradiance")
    np.testing.assert_allclose([2 * max(view.half) for view in views.views(furnace)], 1e-4 * furnace.surfaces[0].shape.radius)


UNSUPPORTED = [
    ("pyrender", "square-light", "pyrender has no area lights"),
    ("pyrender", "sphere-furnace", "pyrender has no interreflection, and its point lights cast no shadows"),
    ("pyrender", "white-furnace-plane:tilted", "pyrender's ambient light comes from everywhere"),
    ("pyrender", "white-furnace-plane",
     "pyrender's 8 bits leave 0.43 % of the brightest light open, and this scene's tolerance is 0.1 %"),
]


def test_what_is_unsupported_is_known_without_the_renderer():
    """The reasons come out of a process in which no renderer can be imported."""
    code = f"""
import sys
for name in ("mitsuba", "drjit", "bpy", "pyrender"): sys.modules[name] = None
from lightproof import suite
from lightproof.renderers import cycles, mitsuba, pyrender
methods = {{"mitsuba": mitsuba.Mitsuba, "cycles": cycles.Cycles, "pyrender": pyrender.Pyrender}}
for name, scene, reason in {UNSUPPORTED!r}:
    assert methods[name](name, 1).unsupported(suite.default().scene(scene)) == reason
for scene in filter(lambda scene: "quick" in scene.tags, suite.default().scenes()):
    assert methods["mitsuba"]("mitsuba", 1).unsupported(scene) is None
    assert methods["cycles"]("cycles", 1).unsupported(scene) is None
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


@pytest.mark.parametrize(("floor", "reflectance", "refused"),
                         [(-0.5, 0.8, True), (0.0, 0.8, True), (0.0, 0.0, False), (0.3, 0.8, False)])
def test_a_film_that_light_crosses_before_it_is_reflected_is_unsupported(floor, reflectance, refused):
    """square-light's film in mid-air or on a floor that reflects: the receiver in its place would hide light; with a black
    floor, or with everything above the film, it hides nothing that counts."""
    corners = [[-0.1, -0.1, floor], [0.1, -0.1, floor], [0.1, 0.1, floor], [-0.1, 0.1, floor]]
    surface = {"id": "floor", "reflectance": reflectance, "shape": {"type": "polygon", "vertices": corners}}
    table = SUITE.scene("square-light").to_table() | {"max_bounces": 1, "surface": [surface]}
    assert bool(views.unsupported(scene_file.from_table(table, "crossed"))) is refused


def test_a_missing_renderer_says_what_to_do(monkeypatch: pytest.MonkeyPatch):
    """No package: the pip command. A package whose shared library is missing: the list of system packages."""
    with pytest.raises(Unavailable, match=r"no-such-renderer is not installed: pip install 'lightproof\[mitsuba\]'"):
        importing.renderer("no-such-renderer", "mitsuba")
    monkeypatch.setattr(importing.importlib, "import_module", _broken)
    with pytest.raises(Unavailable, match=r"bpy lacks a system library \(libGL.so.1.*\): install what apt-packages.txt lists"):
        importing.renderer("bpy", "cycles")


def _broken(name: str) -> None:
    raise ImportError("libGL.so.1: cannot open shared object file")


BASE = [scene for name in SUITE.ids if "quick" in (scene := SUITE.scene(name)).tags]


@pytest.mark.parametrize("method", ["mitsuba", "cycles"])
def test_base_scenes(method: str, tmp_path: Path):
    """Every quick scene at 256 samples: the film's mean within 0.5 per cent of the reference's, the elements together within 5
    per cent of the film's largest. This is a check of the adapter; the verdict on the renderer is the harness's."""
    for scene, answer in zip(BASE, one_process.render(method, [Shot(scene, 256) for scene in BASE], tmp_path), strict=True):
        exact, film = SUITE.reference(scene).value, np.array(answer["film"])
        assert film.mean() == pytest.approx(exact.mean(), rel=0.005), scene.name
        assert np.sqrt(np.mean((film - exact) ** 2)) < 0.05 * exact.max(), scene.name


@pytest.mark.parametrize("method", ["mitsuba", "mitsuba/scalar", "cycles"])
def test_seeds_and_samples(method: str, tmp_path: Path):
    """occluded-square: the same seed gives the same film, another seed another one, and 100 samples asked for are spent."""
    scene = SUITE.scene("occluded-square")
    first, again, other = one_process.render(method, [Shot(scene, 100, seed) for seed in (7, 7, 8)], tmp_path)
    assert first["film"] == again["film"] != other["film"]
    assert first["samples"] == 100


@pytest.mark.parametrize("method", ["mitsuba", "cycles"])
def test_a_lamp_hides_what_glows_behind_it(method: str, tmp_path: Path):
    """A disk lamp of 3.7 W/(m2 sr), half-way below a glowing disk of 1.9, seen from their axis: E = pi L R^2/(R^2 + h^2) for
    each, and of the upper one what the lamp covers is missing."""
    near, far = ({"type": "disk", "center": [0, 0, h], "normal": [0, 0, -1], "radius": r} for h, r in ((0.8, 0.3), (1.6, 0.9)))
    table = {"title": "Two disks", "max_bounces": 0, "tolerance": 0.01, "light": [{"id": "lamp", "kind": "area", "shape": near,
             "radiance": 3.7}], "surface": [{"id": "glow", "shape": far, "reflectance": 0, "radiance": 1.9}],
             "film": {"kind": "points", "quantity": "irradiance", "positions": [[0, 0, 0]], "normals": [[0, 0, 1]]}}  # fmt: skip
    (answer,) = one_process.render(method, [Shot(scene_file.from_table(table, "two-disks"), 1 << 14)], tmp_path)
    exact = np.pi * ((3.7 - 1.9) * 0.3**2 / (0.3**2 + 0.8**2) + 1.9 * 0.9**2 / (0.9**2 + 1.6**2))
    assert answer["film"] == pytest.approx([exact], rel=0.01)


def test_no_sky_shines_through_two_halves_of_a_roof(tmp_path: Path):
    """A roof 4 km wide over the floor, in two halves of one reflectance, under a sky of radiance 1 and a lamp too faint to see:
    dark. Joined to optimise, the halves are beyond the bounds of Mitsuba's scene, and its sky ends there."""
    def sheet(x: float, width: float, half: float, height: float) -> dict[str, object]:
        left, right = x, x + width
        return {"type": "polygon", "vertices": [[left, -half, height], [left, half, height], [right, half, height],
                                                [right, -half, height]]}

    table = {"title": "Roof", "max_bounces": 0, "tolerance": 0.01, "film": SUITE.scene("square-light").film.to_table(), "light": [
        {"id": "sky", "kind": "environment", "radiance": 1.0},
        {"id": "lamp", "kind": "area", "radiance": 1e-6, "shape": sheet(0, 0.1, 0.05, 1)}], "surface": [
        {"id": f"half-{number}", "reflectance": 0, "shape": sheet(2000.0 * (number - 2), 2000, 2000, 3)} for number in (1, 2)]}
    (answer,) = one_process.render("mitsuba/scalar", [Shot(scene_file.from_table(table, "roof"), 256)], tmp_path)
    assert max(answer["film"]) < 1e-3


def test_mitsuba_averages_passes(tmp_path: Path):
    """white-furnace-plane at 5,000 samples: five passes of 31 x 33 strata each, and no drift of the float32 film."""
    (answer,) = one_process.render("mitsuba", [Shot(SUITE.scene("white-furnace-plane"), 5000)], tmp_path)
    assert answer["samples"] == 5 * 31 * 33
    np.testing.assert_allclose(answer["film"], np.pi * 1.37, rtol=5e-6)


def test_pyrender_declares_its_steps(tmp_path: Path):
    """white-furnace-plane, E = pi 1.37 everywhere: one code of 255 is what it is off by at most, and that is what it declares."""
    lenient = replace(SUITE.scene("white-furnace-plane"), tolerance=0.01)
    (answer,) = one_process.render("pyrender", [Shot(lenient, 16)], tmp_path)
    film, half_step = np.array(answer["film"]), np.array(answer["quantization"])
    assert answer["samples"] == 16
    assert (np.abs(film - np.pi * 1.37) <= half_step).all()
    assert (half_step < 0.006 * film).all()
