"""The ribbon between the outline of a round shape and that of the triangles in its place, as a point sees it.

Both outlines are thin apart, so that light which one of them lets through and the other does not comes from directions next to
the shape's rim. Its solid angle is integrated along the triangles' own outline, the edges between those that face the point and
those that do not, by three Gauss points each: right to a thousandth of the ribbon, and without any cancellation.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lightproof import geometry
from lightproof.geometry import Cylinder, Disk, Sphere
from lightproof.renderers.mesh import Mesh

ROUND = Disk | Sphere | Cylinder
NODES, WEIGHTS = (np.polynomial.legendre.leggauss(3) + np.array([[1], [0]])) / 2
NEAR = 50  # ribbon widths: what is closer to the shape than that sees more than a ribbon


@dataclass(frozen=True)
class Ribbon:
    """Its pieces: unit `directions` (k, 3) in which they are seen, `solid_angles` (k,) [sr], positive where the triangles cover
    more than the shape."""

    directions: np.ndarray
    solid_angles: np.ndarray


@dataclass(frozen=True)
class Outlines:
    """A round shape, and the triangles in its place, their fronts outward."""

    shape: Disk | Sphere | Cylinder
    mesh: Mesh

    def faces(self, point: np.ndarray) -> bool:
        """Whether a point may see any of the shape's front."""
        if isinstance(self.shape, Disk):
            return float((point - self.shape.center) @ self.shape.normal) > 0
        return self._clearance(point) > -NEAR * self.width

    def ribbon(self, point: np.ndarray) -> Ribbon | None:
        """What a point (3,) outside the shape sees; None where it is too near."""
        if self._clearance(point) <= NEAR * self.width:
            return None
        starts, ends = self._outline(point)
        steps = (ends - starts)[:, None] * WEIGHTS[:, None]
        places = (starts[:, None] + (ends - starts)[:, None] * NODES[:, None]).reshape(-1, 3)
        way = places - point
        solid_angles = {Disk: self._disk, Sphere: self._sphere, Cylinder: self._cylinder}[type(self.shape)]
        return Ribbon(geometry.unit(way), solid_angles(point, places, steps.reshape(-1, 3)))

    @cached_property
    def width(self) -> float:
        """Largest distance [m] between the shape and a vertex or the middle of an edge."""
        starts, ends = self._edges
        rim = self._rim_distance(np.vstack([starts, (starts + ends) / 2]))
        return float(np.abs(rim).max())

    def _rim_distance(self, places: np.ndarray) -> np.ndarray:
        """Distance (k,) [m] by which places lie outside the round of the shape; for a disk only of those on its rim."""
        return np.linalg.norm(self._spokes(places), axis=-1) - self.shape.radius

    def _spokes(self, places: np.ndarray) -> np.ndarray:
        """From the centre, or from the axis, to places (k, 3)."""
        if isinstance(self.shape, Cylinder):
            spokes, axis = places - self.shape.base, geometry.unit(self.shape.axis)
            return spokes - (spokes @ axis)[..., None] * axis
        return places - self.shape.center

    def _clearance(self, point: np.ndarray) -> float:
        """Distance [m] of a point from the sphere or the infinite cylinder, or from a disk's rim."""
        if not isinstance(self.shape, Disk):
            return float(self._rim_distance(point))
        spoke, normal = point - np.array(self.shape.center), geometry.unit(self.shape.normal)
        height = spoke @ normal
        return float(np.hypot(height, np.linalg.norm(spoke - height * normal) - self.shape.radius))

    @cached_property
    def _planes(self) -> tuple[np.ndarray, np.ndarray]:
        """Of the triangles: normals (m, 3), of any length, and their products with a corner, seen from the first vertex."""
        a, b, c = (self.mesh.vertices - self.mesh.vertices[0])[self.mesh.triangles].transpose(1, 0, 2)
        normals = np.cross(b - a, c - a)
        return normals, (normals * a).sum(axis=1)

    @cached_property
    def _sides(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Each side once: its vertices (k, 2), counter-clockwise in its first triangle (k,), and the second (k,), which is the
        number of triangles where there is none."""
        sides = self.mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        keys = np.sort(sides, axis=1) @ [len(self.mesh.vertices), 1]
        order = np.argsort(keys, kind="stable")
        again = np.append(np.diff(keys[order]) == 0, False)
        first = np.flatnonzero(~np.append(False, again[:-1]))
        second = np.where(again[first], order[np.minimum(first + 1, len(order) - 1)] // 3, len(self.mesh.triangles))
        return sides[order[first]], order[first] // 3, second

    @cached_property
    def _edges(self) -> tuple[np.ndarray, np.ndarray]:
        """Starts and ends (k, 3) of the edges that an outline may have: of a disk and a cylinder those of their rims."""
        sides, _, second = self._sides
        kept = sides if isinstance(self.shape, Sphere) else sides[second == len(self.mesh.triangles)]
        return self.mesh.vertices[kept[:, 0]], self.mesh.vertices[kept[:, 1]]

    def _outline(self, point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Starts and ends (k, 3) of the edges between what faces a point and what does not; of a disk, its rim."""
        if isinstance(self.shape, Disk):
            return self._edges
        (sides, first, second), (normals, offsets) = self._sides, self._planes
        facing = np.append(normals @ (point - self.mesh.vertices[0]) > offsets, False)
        seen, beyond = facing[first], facing[second]
        kept = np.vstack([sides[seen & ~beyond], sides[beyond & ~seen][:, ::-1]])
        return self.mesh.vertices[kept[:, 0]], self.mesh.vertices[kept[:, 1]]

    def _disk(self, point: np.ndarray, places: np.ndarray, steps: np.ndarray) -> np.ndarray:
        return np.copysign(1, self.faces(point) - 0.5) * self._flat(point, places, steps)

    def _flat(self, point: np.ndarray, places: np.ndarray, steps: np.ndarray) -> np.ndarray:
        """Solid angles between chords and arcs of a circle, run through counter-clockwise as the point sees what they bound."""
        spokes = self._spokes(places)
        excess = 1 - self.shape.radius / np.linalg.norm(spokes, axis=1)[:, None]
        areas, way = np.cross(spokes, steps) * excess * (1 - excess / 2), places - spokes * excess / 2 - point
        return -(way * areas).sum(axis=1) / np.linalg.norm(way, axis=1) ** 3

    def _sphere(self, point: np.ndarray, places: np.ndarray, steps: np.ndarray) -> np.ndarray:
        """About the line of sight to the centre, (cos a - cos b) d psi of the shape's half-angle a and that of the outline, b."""
        axis = np.array(self.shape.center) - point
        distance = float(np.linalg.norm(axis))
        axis, spokes = axis / distance, places - self.shape.center
        along = spokes @ axis
        across, depth = spokes - along[:, None] * axis, distance + along
        square, sine = (across**2).sum(axis=1), self.shape.radius / distance
        turns = np.abs(np.cross(across, steps) @ axis) / square
        cosines = depth / np.sqrt(square + depth**2), np.sqrt((1 - sine) * (1 + sine))
        return (square / (square + depth**2) - sine**2) / sum(cosines) * turns

    def _cylinder(self, point: np.ndarray, places: np.ndarray, steps: np.ndarray) -> np.ndarray:
        """Along the rims as for a disk; along the sides, the angle between outline and tangent plane, about the axis."""
        axis = geometry.unit(self.shape.axis)
        side = np.abs(steps @ axis) > 0.5 * np.linalg.norm(steps, axis=1)
        way = places - point
        flat = way - (way @ axis)[:, None] * axis
        from_axis = -self._spokes(point[None])[0]
        distance = np.linalg.norm(from_axis)
        sines = np.linalg.norm(np.cross(from_axis, flat), axis=1) / distance / np.linalg.norm(flat, axis=1)
        turns = np.arcsin(sines) - np.arcsin(self.shape.radius / distance)
        lengths, reaches = np.abs(steps @ axis), (flat**2).sum(axis=1) / np.linalg.norm(way, axis=1) ** 3
        return np.where(side, turns * reaches * lengths, self._flat(point, places, steps))
