"""Polygons as a camera sees them: exact outlines, and the nearest along a ray."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations

from lightproof.certify import planes
from lightproof.certify.balls import CannotCertify, Point, Rational, cross, dot, exact, plus, point, times
from lightproof.certify.camera import Camera, View
from lightproof.certify.planes import Flat, Line, Plane
from lightproof.scene import AreaLight, Surface

AXES = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


@dataclass(frozen=True)
class Face:
    """A polygon in a picture: its front has `radiance` of its own and sends on `reflectance` of what it receives."""

    name: str
    corners: tuple[Point, ...]
    view: View
    radiance: Rational
    reflectance: Rational

    @classmethod
    def of(cls, item: AreaLight | Surface, camera: Camera, reflectance: float) -> Face:
        """The face of a polygon."""
        corners = tuple(point(corner) for corner in item.shape.vertices)
        return cls(item.id, corners, View(camera, planes.of(corners)), exact(item.radiance), exact(reflectance))

    @property
    def plane(self) -> Plane:
        """The polygon's plane, its front the polygon's."""
        return self.view.plane

    @property
    def edges(self) -> Iterable[tuple[Point, Point]]:
        """The polygon's sides."""
        return zip(self.corners, (*self.corners[1:], self.corners[0]), strict=True)

    @property
    def axis(self) -> int:
        """The axis along which inside is told from outside: that nearest to the normal."""
        return max(range(3), key=lambda axis: abs(self.plane.normal[axis]))

    def outlines(self) -> Iterable[Plane]:
        """Planes through the edges, along that axis."""
        return (planes.through(start, end, plus(start, AXES[self.axis])) for start, end in self.edges)

    def holds(self, x: Point) -> bool:
        """Whether a point of the plane is inside: on the way from it along an axis an odd number of edges is crossed."""
        i, j = (axis for axis in range(3) if axis != self.axis)
        passed = [(a, b) for a, b in self.edges if (a[j] > x[j]) != (b[j] > x[j])]
        return sum(a[i] + (b[i] - a[i]) * (x[j] - a[j]) / (b[j] - a[j]) > x[i] for a, b in passed) % 2 == 1

    def reach(self, start: Point, along: Point) -> Rational | None:
        """How far along a ray it meets the polygon, in lengths of `along`; None where it does not."""
        if dot(self.plane.normal, along) == 0:
            return None
        reach = self.view.reach(start, along)
        return reach if reach > 0 and self.holds(plus(start, times(along, reach))) else None

    def check_apart(self, camera: Camera) -> None:
        """Raises CannotCertify where the camera, or the film of an orthographic one, lies in the polygon."""
        level = not any(cross(self.plane.normal, camera.forward)) if camera.parallel else self.holds(camera.origin)
        if level and self.plane.height(camera.origin) == 0:
            raise CannotCertify(f"the camera lies on '{self.name}'; what it sees is not defined there")


def lines(faces: Sequence[Face], camera: Camera) -> set[Line]:
    """The film positions where what is seen may change: outlines, where planes cross each other, and the camera's own."""
    seen = {face.view.line(plane) for face in faces for plane in (*face.outlines(), camera.film)}
    seen |= {one.view.line(other.plane) for one, other in combinations(faces, 2)}
    return seen - {None}


def nearest(faces: Sequence[Face], camera: Camera, position: Flat) -> Face | None:
    """What the ray through a film position meets first, if anything. Raises CannotCertify where two lie in one another."""
    start, along = camera.ray(*position)
    hits = sorted(((reach, face) for face in faces if (reach := face.reach(start, along))), key=lambda hit: hit[0])
    if len(hits) > 1 and hits[0][0] == hits[1][0]:
        raise CannotCertify(f"'{hits[0][1].name}' and '{hits[1][1].name}' lie in one another where the camera looks")
    return hits[0][1] if hits else None
