"""What polygons stand around a receiver, and in which directions it sees a light's front first, or anything else."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from lightproof import geometry
from lightproof.certify import planes
from lightproof.certify.balls import CannotCertify, Point, cross, dot, minus, point
from lightproof.certify.loops import Region, cut, union
from lightproof.certify.planes import Plane
from lightproof.certify.polygon import Parts, convex_parts, visible


@dataclass(frozen=True)
class Face:
    """A polygon and its plane, whose front is towards the receiver; `bright` where that is the front of a light."""

    parts: Parts
    plane: Plane
    bright: bool


def face(shape: geometry.Polygon, x: Point, light: bool) -> Face | None:
    """A polygon as a receiver sees it; None where it is seen edge-on. Raises CannotCertify for a receiver on it."""
    corners = tuple(map(point, shape.vertices))
    parts, plane = convex_parts(corners), planes.of(corners)
    height = plane.height(x)
    if height:
        return Face(parts, plane if height > 0 else plane.turned, light and height > 0)
    if any(_holds(corners, plane.normal, x) for _, corners in parts):
        raise CannotCertify("a receiver lies on a polygon, from where a solid angle has no one value")
    return None


def _holds(corners: Sequence[Point], normal: Point, x: Point) -> bool:
    """Whether a convex polygon, its rim included, holds a point of its plane."""
    sides = [dot(normal, cross(minus(corner, corners[i - 1]), minus(x, corner))) for i, corner in enumerate(corners)]
    return all(side >= 0 for side in sides) or all(side <= 0 for side in sides)


@dataclass(frozen=True)
class Surroundings:
    """The polygons around the receiver `x`."""

    x: Point
    faces: tuple[Face, ...]

    def above(self, horizon: Plane) -> Surroundings:
        """What is in front of a plane."""
        return replace(self, faces=tuple(replace(face, parts=cut(face.parts, horizon)) for face in self.faces))

    @property
    def bright(self) -> tuple[Face, ...]:
        """Lights that turn their front this way."""
        return tuple(face for face in self.faces if face.bright)

    @property
    def dark(self) -> tuple[Face, ...]:
        """All others."""
        return tuple(face for face in self.faces if not face.bright)

    @cached_property
    def seen(self) -> Region:
        """The directions in which a light's front is the first thing seen."""
        return self._first(self.bright, self.dark)

    @cached_property
    def hidden(self) -> Region:
        """The directions in which something else is."""
        return self._first(self.dark, self.bright)

    def _first(self, faces: Iterable[Face], hiders: Iterable[Face]) -> Region:
        region: Region = Counter()
        for face in faces:
            nearer = [parts for hider in hiders if (parts := cut(hider.parts, face.plane))]
            region = union(region, visible(face.parts, nearer, self.x), self.x)
        return region
