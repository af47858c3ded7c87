"""What triangles change of a film, held against the light of coarse triangles themselves, by Lambert's formula."""

from __future__ import annotations

import numpy as np
import pytest

from lightproof import geometry, scene_file, suite
from lightproof.geometry import Cylinder, Disk, Shape, Sphere
from lightproof.renderers import mesh, tessellation
from lightproof.renderers.luxcore_scene import LAMP_CORNERS
from lightproof.renderers.mesh import Mesh
from lightproof.renderers.ribbons import Outlines

SUITE = suite.default()
POINT, NORMAL = np.array([0.1, 0.2, 0.05]), geometry.unit(np.array([0.1, -0.2, 1.0]))
BALL = Sphere((0.3, -0.1, 1.4), 0.31)
DISK = Disk((0.3, -0.1, 1.1), (0.1, 0.3, -1), 0.37)
ACROSS, END_ON = Cylinder((0.3, -0.9, 1.1), (0.2, 1, 0.3), 1.4, 0.2), Cylinder((0.3, -0.9, 1.1), (0.2, 0.2, 0.9), 1.4, 0.2)
FINE = 1 << 14


def circle(corners: int, normal: geometry.Vec3) -> np.ndarray:
    """Corners of a polygon of area pi around the origin."""
    angles = 2 * np.pi * np.arange(corners) / corners
    radius = np.sqrt(2 * np.pi / corners / np.sin(2 * np.pi / corners))
    return radius * np.stack([np.cos(angles), np.sin(angles)], axis=1) @ np.stack(geometry.tangents(normal))


def fan(disk: Disk, corners: int) -> Mesh:
    here = np.arange(corners)
    rim = np.array(disk.center) + disk.radius * circle(corners, disk.normal)
    return Mesh(np.vstack([rim, disk.center]), np.stack([np.full(corners, corners), here, (here + 1) % corners], axis=1))


def prism(tube: Cylinder, corners: int) -> Mesh:
    low = np.array(tube.base) + tube.radius * circle(corners, tube.axis)
    a = np.arange(corners)
    b = (a + 1) % corners
    sides = np.vstack([np.stack([a, b, b + corners], axis=1), np.stack([a, b + corners, a + corners], axis=1)])
    return Mesh(np.vstack([low, low + tube.height * geometry.unit(tube.axis)]), sides)


def globe(ball: Sphere, corners: int) -> Mesh:
    """An octahedron whose eight faces are each cut in `corners` squared and blown up to the sphere."""
    vertices, triangles = [], []
    for octant in np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T:
        places = [(i, j) for i in range(corners + 1) for j in range(corners + 1 - i)]
        index = {place: len(vertices) + number for number, place in enumerate(places)}
        vertices += [octant * (i, j, corners - i - j) for i, j in index]
        faces = [((i, j), (i + 1, j), (i, j + 1)) for i, j in index if i + j < corners]
        faces += [((i + 1, j + 1), (i, j + 1), (i + 1, j)) for i, j in index if i + j < corners - 1]
        triangles += [[index[corner] for corner in (face if octant.prod() > 0 else face[::-1])] for face in faces]
    unique, merged = np.unique(np.array(vertices), axis=0, return_inverse=True)
    return Mesh(np.array(ball.center) + ball.radius * geometry.unit(unique), merged.reshape(-1)[np.array(triangles)])


def light(mesh: Mesh) -> float:
    """Projected solid angle at POINT of the triangles that face it, all of them above the horizon (Lambert 1760)."""
    corners = mesh.vertices[mesh.triangles] - POINT
    a, b, c = corners.transpose(1, 0, 2)
    spokes = geometry.unit(corners[(np.cross(b - a, c - a) * a).sum(axis=1) < 0])
    following = np.roll(spokes, -1, axis=1)
    axes = np.cross(following, spokes)
    sines = np.linalg.norm(axes, axis=2)
    return float((np.arctan2(sines, (spokes * following).sum(axis=2)) / sines * (axes @ NORMAL)).sum() / 2)


def exact(shape: Shape) -> float:
    if isinstance(shape, Sphere):
        way = shape.center - POINT
        return np.pi * shape.radius**2 * float(way @ NORMAL) / np.linalg.norm(way) ** 3
    return light(fan(shape, FINE) if isinstance(shape, Disk) else prism(shape, FINE))


CASES = [(BALL, globe, corners) for corners in (6, 24)]
CASES += [(shape, prism, corners) for shape in (ACROSS, END_ON) for corners in (24, 101)] + [(DISK, fan, 16), (DISK, fan, 25)]


@pytest.mark.parametrize(("shape", "build", "corners"), CASES)
def test_the_ribbon_is_what_the_triangles_lack_or_add(shape, build, corners):
    """Coarse triangles in the place of a ball, a tube from the side and from its end, and a disk: their light less the shape's,
    within a twentieth of all the light of the ribbon."""
    mesh = build(shape, corners)
    ribbon = Outlines(shape, mesh).ribbon(POINT)
    pieces = ribbon.directions @ NORMAL * ribbon.solid_angles
    assert pieces.sum() == pytest.approx(light(mesh) - exact(shape), abs=0.05 * np.abs(pieces).sum())
    assert 0 < np.abs(pieces).sum() < 0.2 * exact(shape)


def described(lights: list, surfaces: list) -> scene_file.Scene:
    film = {"kind": "points", "quantity": "irradiance", "positions": [POINT.tolist()], "normals": [NORMAL.tolist()]}
    return scene_file.from_table({"title": "Round", "max_bounces": 0, "tolerance": 0.01, "light": lights, "surface": surfaces,
                                  "film": film}, "round")  # fmt: skip


def lamp(shape: Shape) -> dict:
    return {"id": "lamp", "kind": "area", "radiance": 3.1, "shape": shape.to_table()}


def test_a_light_alone_differs_by_its_ribbon():
    """A lone tube: what 101 flat sides change, times its radiance."""
    mesh = prism(ACROSS, 101)
    (change,) = tessellation.difference(described([lamp(ACROSS)], []), {"lamp": mesh})
    assert change == pytest.approx(3.1 * abs(light(mesh) - exact(ACROSS)), rel=0.01)


def test_a_blocker_is_bounded_by_all_of_its_ribbon():
    """A ball with its corners on the sphere, in front of a sky: at least what its triangles hide less, and less than what lies
    between the sphere and the largest one inside the triangles."""
    mesh = globe(BALL, 24)
    ball = {"id": "ball", "shape": BALL.to_table(), "reflectance": 0}
    sky = {"id": "sky", "kind": "environment", "radiance": 3.1}
    (change,) = tessellation.difference(described([sky], [ball]), {"ball": mesh})
    inner = Mesh(mesh.vertices - BALL.center, mesh.triangles).insphere
    shell = exact(BALL) - exact(Sphere(BALL.center, inner))
    assert abs(light(mesh) - exact(BALL)) <= change / 3.1 * (1 + 1e-3) < shell


@pytest.mark.parametrize(("scene", "expected"), [
    ("square-light", None),  # no round shape
    ("sphere-furnace", 0),  # the same light everywhere, whatever the wall's shape
    ("sphere-furnace:irradiance", 0),
    ("off-centre-point-in-sphere", np.inf),  # reflections
    ("point-light-shadow:round", 0),  # no point of the film lies at a shadow's edge
    ("centred-point-in-sphere:direct", np.inf),  # inside
    ("white-furnace-sphere", np.inf),  # a camera
])
def test_what_is_known_without_any_ribbon(scene, expected):
    scene = SUITE.scene(scene)
    change = tessellation.difference(scene, tessellation.meshes(scene))
    assert change is None if expected is None else (change == np.full(scene.size, expected)).all()


OURS = ("sphere-light:horizon", "disk-light:tilted", "tube-light:upright", "disk-blocker:askew", "sphere-blocker")


@pytest.mark.parametrize("lamp_corners", [mesh.CIRCLE, LAMP_CORNERS])
@pytest.mark.parametrize("scene", OURS)
def test_the_triangles_of_ours_change_little(scene, lamp_corners):
    """The meshes that adapters take cost less than a twentieth of each scene's tolerance."""
    scene = SUITE.scene(scene)
    change = tessellation.difference(scene, tessellation.meshes(scene, lamp_corners=lamp_corners))
    assert change.shape == (scene.size,)
    assert 0 < change.max() < 0.05 * scene.tolerance * SUITE.reference(scene).value.max()


TILTED, LYING = Disk((0.3, -0.1, 1.4), (0.2, -0.1, -1), 0.31), Cylinder((0.38, -0.34, 1.35), (-0.31, 0.95, 0.2), 0.5, 0.2)


@pytest.mark.parametrize("shape", [BALL, TILTED, LYING])
def test_shadows_of_points_and_beams_change_at_their_edge_alone(shape):
    """A bulb and a beam behind each round shape, and points of a floor along a line out of its shadow: with coarse triangles
    some points may lose or gain the light, those in the shadow of a shape as large as the triangles and not of one as small;
    with ours at most one may."""
    places = np.array([0.3, -0.1, 0]) + np.linspace(0, 1.5, 120)[:, None] * [0.95, 0.31, 0]
    film = {"kind": "points", "quantity": "irradiance", "positions": places.tolist(), "normals": [[0, 0, 1]] * 120}
    bulb = {"id": "bulb", "kind": "point", "position": [0.3, -0.1, 2.6], "intensity": 2.9}
    beam = {"id": "beam", "kind": "directional", "direction": [0.1, 0, -1], "irradiance": 5.7}
    blocker = {"id": "blocker", "shape": shape.to_table(), "reflectance": 0}
    build = {Sphere: lambda: globe(shape, 6), Disk: lambda: fan(shape, 7), Cylinder: lambda: prism(shape, 7)}[type(shape)]
    for lamp, most in ((bulb, 2.9 / 2.6**2), (beam, 5.7 / np.hypot(1, 0.1))):
        table = {"title": "Shadow", "max_bounces": 0, "tolerance": 0.01, "light": [lamp], "surface": [blocker], "film": film}
        scene = scene_file.from_table(table, "shadow")
        coarse = tessellation.difference(scene, {"blocker": build()})
        assert 0 < (coarse > 0).sum() < 40 and coarse.max() <= most * (1 + 1e-12)
        assert (tessellation.difference(scene, tessellation.meshes(scene)) > 0).sum() <= 1


def test_native_shapes_are_no_triangles():
    """The lamp of sphere-light, to a renderer that has spheres."""
    scene = SUITE.scene("sphere-light")
    assert tessellation.difference(scene, tessellation.meshes(scene, {"lamp"})) is None
