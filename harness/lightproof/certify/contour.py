"""Lambert's formula around what a receiver sees of a polygon, made ready for many receivers near each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import arb

from lightproof.certify.balls import Ball, Point, Vector, angle, cross, dot, minus, plus, root, times
from lightproof.certify.polygon import Edge, Loop

Corner = tuple[Vector, int] | None  # a point, and whether its direction or the opposite one is meant


@dataclass(frozen=True)
class Contour:
    """A loop in balls: where each edge starts and how it runs, and the corner before it, None where no point is known in
    which its line and that of the edge before meet."""

    starts: tuple[Vector, ...]
    runs: tuple[Vector, ...]
    corners: tuple[Corner, ...]
    whole: tuple[bool, ...]  # whether all of an edge is seen

    @classmethod
    def of(cls, edges: Loop, receiver: Point) -> Contour:
        """The contour of a loop as an exact receiver sees it, and others near it."""
        befores, afters = edges[-1:] + edges[:-1], edges[1:] + edges[:1]
        return cls(
            tuple(_ball(start) for start, _ in edges),
            tuple(_ball(minus(end, start)) for start, end in edges),
            tuple(_corner(before, here, receiver) for before, here in zip(befores, edges, strict=True)),
            tuple(before[1] == here[0] and here[1] == after[0]
                  for before, here, after in zip(befores, edges, afters, strict=True)),
        )

    def outline(self, x: Vector) -> tuple[list[Vector], list[Vector]]:
        """Inward normals of the great circles on which the edges are seen, and the directions in which each edge begins."""
        circles = [cross(minus(start, x), run) for start, run in zip(self.starts, self.runs, strict=True)]
        return circles, [_direction(corner, circles[i - 1], circles[i], x) for i, corner in enumerate(self.corners)]

    def irradiance(self, x: Vector, normal: Vector) -> Ball:
        """Irradiance per radiance [sr] from a loop above the horizon of a receiver with unit `normal` (Lambert 1760; Arvo
        1995): half the sum over edges of angle times cosine. Angles are signed, so it stays analytic where an edge vanishes."""
        circles, corners = self.outline(x)
        lengths = [root(dot(corner, corner)) for corner in corners]
        total = arb(0)
        for i, inwards in enumerate(circles):
            a, b, length = corners[i], corners[i + 1 - len(corners)], root(dot(inwards, inwards))
            sine = length if self.whole[i] else dot(cross(a, b), inwards) / length
            total += angle(sine, dot(a, b), lengths[i] * lengths[i + 1 - len(lengths)]) * (dot(inwards, normal) / length)
        return total / 2


def total(contours: Sequence[Contour], x: Vector, normal: Vector) -> Ball:
    """Irradiance per radiance [sr] from several loops."""
    return sum((contour.irradiance(x, normal) for contour in contours), arb(0))


def _ball(vector: Point) -> Vector:
    return tuple(arb(component) for component in vector)


def _corner(before: Edge, here: Edge, receiver: Point) -> Corner:
    if before[1] == here[0]:
        return _ball(here[0]), 1
    meeting = meet(before, here)
    if meeting is None:
        return None
    ways = [cross(minus(edge[0], receiver), minus(edge[1], edge[0])) for edge in (before, here)]
    return _ball(meeting), 1 if dot(cross(*ways), minus(meeting, receiver)) > 0 else -1


def meet(a: Edge, b: Edge) -> Point | None:
    """The point in which the lines of two edges meet; None where they are parallel or pass each other."""
    along, other, apart = minus(a[1], a[0]), minus(b[1], b[0]), minus(b[0], a[0])
    normal = cross(along, other)
    if not any(normal) or dot(apart, normal) != 0:
        return None
    return plus(a[0], times(along, dot(cross(apart, other), normal) / dot(normal, normal)))


def _direction(corner: Corner, before: Vector, here: Vector, x: Vector) -> Vector:
    if corner is None:
        return cross(before, here)
    return minus(corner[0], x) if corner[1] > 0 else minus(x, corner[0])
