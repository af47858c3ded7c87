"""Shapes as triangles, for renderers that have no disk or sphere of their own and to scatter light emitters over."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import combinations

import numpy as np

from lightproof import geometry
from lightproof.geometry import Cap, Cylinder, Disk, Polygon, Shape, Sphere

CIRCLE = 1024  # corners of a circle; its area is off by 6e-6
MERIDIANS, PARALLELS = 256, 64  # of a cap
SPHERE = 6  # subdivisions of the icosahedron: 81,920 triangles, within 1e-4 of the radius
RIGHT = 1e-9  # how far, of its size, a rectangle's corner may be off
GOLDEN = (1 + 5**0.5) / 2


@dataclass(frozen=True)
class Mesh:
    """`vertices` (n, 3) [m]; `triangles` (m, 3), counter-clockwise seen from the front."""

    vertices: np.ndarray
    triangles: np.ndarray

    @property
    def area(self) -> float:
        """Total area [m2]."""
        return float(np.linalg.norm(self._crosses(), axis=1).sum() / 2)

    @property
    def insphere(self) -> float:
        """Distance [m] from the origin to the nearest triangle's plane."""
        normals = geometry.unit(self._crosses())
        return float((normals * self.vertices[self.triangles[:, 0]]).sum(axis=1).min())

    def distance(self, point: np.ndarray) -> float:
        """From a point (3,) to the nearest of the triangles [m]."""
        corners = self.vertices[self.triangles] - point
        following, normals = np.roll(corners, -1, axis=1), geometry.unit(self._crosses())
        sides = following - corners
        along = np.clip(-(corners * sides).sum(axis=2) / (sides**2).sum(axis=2), 0, 1)
        to_sides = np.linalg.norm(corners + along[..., None] * sides, axis=2).min(axis=1)
        above = (np.cross(corners, following) * normals[:, None]).sum(axis=2).min(axis=1) >= 0
        return float(np.where(above, np.abs((corners[:, 0] * normals).sum(axis=1)), to_sides).min())

    def flipped(self) -> Mesh:
        """The same triangles with front and back exchanged."""
        return Mesh(self.vertices, self.triangles[:, ::-1])

    def subdivided(self, times: int) -> Mesh:
        """Each triangle in 4^times equal ones."""
        return self if times == 0 else _quartered(self).subdivided(times - 1)

    def _crosses(self) -> np.ndarray:
        a, b, c = self.vertices[self.triangles].transpose(1, 0, 2)
        return np.cross(b - a, c - a)


def tessellate(shape: Shape, inside: bool = False, corners: int = CIRCLE) -> Mesh:
    """A shape's triangles, front outward or, with `inside`, inward; `corners` are those of a disk's or a cylinder's circle.

    Round shapes are scaled to keep their area, which for a convex body keeps its mean projected area (Cauchy); a sphere
    seen from inside is scaled to contain the true sphere, so that no point of its wall lies outside.
    """
    match shape:
        case Polygon():
            return _polygon(np.array(shape.vertices))
        case Disk():
            return _disk(shape, corners)
        case Sphere():
            return _sphere(shape, inside)
        case Cylinder():
            return _cylinder(shape, inside, corners)
        case Cap():
            return _cap(shape, inside)


def is_rectangle(corners: np.ndarray) -> bool:
    """Whether vertices (n, 3) are those of a rectangle."""
    if len(corners) != 4:
        return False
    a, b, c, d = corners
    size = np.linalg.norm(c - a)
    return np.linalg.norm(a + c - b - d) <= RIGHT * size and abs((b - a) @ (d - a)) <= RIGHT * size**2


def _polygon(corners: np.ndarray) -> Mesh:
    t, b = geometry.tangents(geometry.vector_area(corners))
    return Mesh(corners, np.array(_ears(corners @ np.stack([t, b], axis=1))))


def _ears(flat: np.ndarray) -> list[tuple[int, int, int]]:
    """Triangles of a simple counter-clockwise polygon (n, 2) by ear clipping (Meisters 1975)."""
    left, triangles = list(range(len(flat))), []
    while len(left) > 3:
        ear = next(i for i in range(len(left)) if _is_ear(flat, left, i))
        triangles.append((left[ear - 1], left[ear], left[(ear + 1) % len(left)]))
        del left[ear]
    return [*triangles, tuple(left)]


def _is_ear(flat: np.ndarray, left: list[int], i: int) -> bool:
    a, b, c = left[i - 1], left[i], left[(i + 1) % len(left)]
    if geometry.turn(flat[a], flat[b], flat[c]) <= 0:
        return False
    others = (flat[j] for j in left if j not in (a, b, c))
    return not any(all(geometry.turn(flat[p], flat[q], point) >= 0 for p, q in ((a, b), (b, c), (c, a))) for point in others)


def _circle(corners: int) -> np.ndarray:
    angles = 2 * np.pi * np.arange(corners) / corners
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _disk(disk: Disk, corners: int) -> Mesh:
    same_area = np.sqrt(2 * np.pi / corners / np.sin(2 * np.pi / corners))
    rim = disk.radius * same_area * _circle(corners) @ np.stack(geometry.tangents(disk.normal))
    here = np.arange(corners)
    fan = np.stack([np.full(corners, corners), here, np.roll(here, -1)], axis=1)
    return Mesh(np.array(disk.center) + np.vstack([rim, np.zeros(3)]), fan)


def _cylinder(cylinder: Cylinder, inside: bool, corners: int) -> Mesh:
    same_area = np.pi / corners / np.sin(np.pi / corners)
    base = np.array(cylinder.base) + cylinder.radius * same_area * _circle(corners) @ np.stack(geometry.tangents(cylinder.axis))
    here = np.arange(corners)
    following = np.roll(here, -1)
    triangles = np.vstack([np.stack([here, following, following + corners], axis=1),
                           np.stack([here, following + corners, here + corners], axis=1)])
    mesh = Mesh(np.vstack([base, base + cylinder.height * geometry.unit(cylinder.axis)]), triangles)
    return mesh.flipped() if inside else mesh


def _cap(cap: Cap, inside: bool) -> Mesh:
    """Rings of `MERIDIANS` corners around a pole."""
    polar = np.radians(cap.half_angle) * np.arange(1, PARALLELS + 1)[:, None] / PARALLELS
    spokes = _circle(MERIDIANS) @ np.stack(geometry.tangents(cap.axis))
    rings = np.cos(polar)[..., None] * geometry.unit(cap.axis) + np.sin(polar)[..., None] * spokes
    here = np.arange(MERIDIANS)
    following = np.roll(here, -1)
    strip = np.vstack([np.stack([here, here + MERIDIANS, following + MERIDIANS], axis=1),
                       np.stack([here, following + MERIDIANS, following], axis=1)])
    strips = [strip + 1 + ring * MERIDIANS for ring in range(PARALLELS - 1)]
    fan = np.stack([np.zeros(MERIDIANS, int), here + 1, following + 1], axis=1)
    mesh = Mesh(np.vstack([geometry.unit(cap.axis)[None], rings.reshape(-1, 3)]), np.vstack([fan, *strips]))
    mesh = Mesh(np.array(cap.center) + np.sqrt(cap.area / mesh.area) * mesh.vertices, mesh.triangles)
    return mesh.flipped() if inside else mesh


def _sphere(sphere: Sphere, inside: bool) -> Mesh:
    ball = _icosphere(SPHERE)
    scale = sphere.radius * (1 / ball.insphere if inside else np.sqrt(4 * np.pi / ball.area))
    mesh = Mesh(np.array(sphere.center) + scale * ball.vertices, ball.triangles)
    return mesh.flipped() if inside else mesh


@cache
def _icosphere(times: int) -> Mesh:
    """An icosahedron, subdivided; its vertices lie on the unit sphere."""
    pairs = [(a, b * GOLDEN) for a in (-1, 1) for b in (-1, 1)]
    vertices = np.array([np.roll((0, a, b), shift) for shift in range(3) for a, b in pairs])
    mesh = Mesh(geometry.unit(vertices), _hull(geometry.unit(vertices)))
    for _ in range(times):
        finer = _quartered(mesh)
        mesh = Mesh(geometry.unit(finer.vertices), finer.triangles)
    return mesh


def _hull(vertices: np.ndarray) -> np.ndarray:
    """The faces of the icosahedron with these corners (12, 3): three that are next to each other, counter-clockwise."""
    distances = np.linalg.norm(vertices[:, None] - vertices, axis=-1)
    neighbours = distances < 1.01 * distances[distances > 0].min()
    faces = [face for face in combinations(range(12), 3) if all(neighbours[a, b] for a, b in combinations(face, 2))]
    return np.array([face if np.linalg.det(vertices[list(face)]) > 0 else face[::-1] for face in faces])


def _quartered(mesh: Mesh) -> Mesh:
    """Every triangle in four, split at the middle of its sides; neighbours share the new vertices."""
    a, b, c = mesh.triangles.T
    sides = np.sort(np.concatenate([np.stack(side, axis=1) for side in ((a, b), (b, c), (c, a))]), axis=1)
    unique, index = np.unique(sides, axis=0, return_inverse=True)
    middles = mesh.vertices[unique].mean(axis=1)
    ab, bc, ca = index.reshape(3, -1) + len(mesh.vertices)
    corners = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return Mesh(np.vstack([mesh.vertices, middles]), np.concatenate([np.stack(corner, axis=1) for corner in corners]))
