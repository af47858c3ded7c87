"""What polygons stand around a receiver, and in which directions it sees a light's front first, or anything else."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

from lightproof import geometry
from lightproof.certify import contact, planes
from lightproof.certify.balls import CannotCertify, Point, point
from lightproof.certify.loops import Convex, Region, cut, union
from lightproof.certify.planes import Plane
from lightproof.certify.polygon import convex_parts, loop, visible_pieces


@dataclass(frozen=True)
class Face:
    """A polygon, in convex tiles, and its plane, whose front is towards the receiver; `bright` where that is a light's front."""

    tiles: tuple[Convex, ...]
    plane: Plane
    bright: bool


def face(shape: geometry.Polygon, x: Point, light: bool) -> Face | None:
    """A polygon as a receiver sees it; None where it is seen edge-on. Raises CannotCertify for a receiver on it."""
    corners = tuple(map(point, shape.vertices))
    if contact.touches(shape, x, None):
        raise CannotCertify("a receiver lies on a polygon, from where a solid angle has no one value")
    plane = planes.of(corners)
    height = plane.height(x)
    return Face(tuple(convex_parts(corners)), plane if height > 0 else plane.turned, light and height > 0) if height else None


@dataclass(frozen=True)
class Surroundings:
    """The polygons around the receiver `x`."""

    x: Point
    faces: tuple[Face, ...]

    def above(self, horizon: Plane) -> Surroundings:
        """What is in front of a plane."""
        return replace(self, faces=tuple(replace(face, tiles=tuple(cut(face.tiles, horizon))) for face in self.faces))

    @property
    def swapped(self) -> Surroundings:
        """Lit what is dark, and dark what is lit."""
        return replace(self, faces=tuple(replace(face, bright=not face.bright) for face in self.faces))

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
        region: Region = []
        for face in faces:
            nearer = [loop(tile, self.x) for hider in hiders for tile in cut(hider.tiles, face.plane)]
            seen = [piece for tile in face.tiles for piece in visible_pieces(loop(tile, self.x), nearer, self.x)]
            region = union(region, seen, self.x)
        return region
