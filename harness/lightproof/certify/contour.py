"""Lambert's formula around what a receiver sees of a polygon, made ready for many receivers near each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import acb, arb, fmpq

from lightproof.certify.balls import Ball, CannotCertify, Number, Point, Vector, angle, cross, dot, minus, plus, root, times
from lightproof.certify.polygon import Edge, Loop, chords, circle

HALF = fmpq(1, 2)
BEYOND = "the line of an edge is seen to cross another one infinitely far off, or beyond that"


@dataclass(frozen=True)
class Corner:
    """Where an edge and the one before it meet as they are seen: a point of edge number `edge`, at its start + `along` run, or,
    where `along` is None, where the great circle of edge `other` crosses it. `before` is how far along the edge before it
    is, where that is known."""

    edge: int
    other: int
    along: arb | None
    before: arb | None
    above: Vector
    below: Vector

    def reach(self, rays: Sequence[Vector]) -> Number:
        """How far along its edge, in the edge's own length: a quotient of linear functions of the receiver."""
        if self.along is not None:
            return self.along
        ray = rays[self.other]
        return dot(ray, self.above) / dot(ray, self.below)


@dataclass(frozen=True)
class Contour:
    """A loop in balls: where each edge starts, how it runs, and the corner before it."""

    starts: tuple[Vector, ...]
    runs: tuple[Vector, ...]
    corners: tuple[Corner, ...]

    @classmethod
    def of(cls, edges: Loop, receiver: Point) -> Contour:
        """The contour of a loop as an exact receiver sees it, and others near it. Raises CannotCertify."""
        return cls(
            tuple(_ball(start) for start, _ in edges),
            tuple(_ball(minus(end, start)) for start, end in edges),
            tuple(_corner(edges, i, receiver) for i in range(len(edges))),
        )

    @classmethod
    def at(cls, edges: Loop, receiver: Point) -> Contour:
        """The contour of a loop for this receiver alone."""
        joined = all(before[1] == here[0] for before, here in zip(edges[-1:] + edges[:-1], edges, strict=True))
        return cls.of(edges if joined else chords(edges, receiver), receiver)

    def outline(self, x: Vector) -> tuple[list[Vector], list[Vector]]:
        """Inward normals of the great circles on which the edges are seen, and the directions in which each edge begins."""
        rays = [minus(start, x) for start in self.starts]
        circles = [cross(ray, run) for ray, run in zip(rays, self.runs, strict=True)]
        return circles, self._directions(rays, [corner.reach(rays) for corner in self.corners])

    def _directions(self, rays: Sequence[Vector], reaches: Sequence[Number]) -> list[Vector]:
        return [plus(rays[corner.edge], times(self.runs[corner.edge], reach))
                for corner, reach in zip(self.corners, reaches, strict=True)]

    def irradiance(self, x: Vector, normal: Vector) -> Ball:
        """Irradiance per radiance [sr] from a loop above the horizon of a receiver with unit `normal` (Lambert 1760; Arvo
        1995): half the sum over edges of angle times cosine. Angles are signed, so it stays analytic where an edge vanishes."""
        rays = [minus(start, x) for start in self.starts]
        reaches = [corner.reach(rays) for corner in self.corners]
        corners = self._directions(rays, reaches)
        lengths = [root(dot(corner, corner)) for corner in corners]
        total = arb(0)
        for i, (ray, run) in enumerate(zip(rays, self.runs, strict=True)):
            j = i + 1 - len(rays)
            inwards = cross(ray, run)
            span = self._span(i, reaches)
            square = dot(inwards, inwards)
            if span is None:
                span = dot(cross(corners[i], corners[j]), inwards) / square
            total += _angle(span, square, dot(corners[i], corners[j]), lengths[i] * lengths[j]) * dot(inwards, normal)
        return total / 2

    def _span(self, i: int, reaches: Sequence[Number]) -> Number | None:
        """How much of an edge is seen, in its own length; None where one of its ends is measured on a neighbour only."""
        first, last = self.corners[i], self.corners[i + 1 - len(reaches)]
        end = reaches[i + 1 - len(reaches)] if last.edge == i else last.before
        if first.edge != i or end is None:
            return None
        return end - reaches[i]


def _angle(span: Ball, square: Ball, adjacent: Ball, hypotenuse: Ball) -> Ball:
    """An angle by its legs span l and `adjacent`, over l, given l^2. Where an edge is seen end-on l vanishes, and the quotient
    does not: it is atan(sqrt y)/sqrt y, a hypergeometric function of y, times half of it."""
    length = root(square)
    if length.is_finite() and not length.contains(0):
        return angle(span * length, adjacent, hypotenuse) / length
    half = span / (hypotenuse + adjacent)
    value = 2 * half * acb(-half * half * square).hypgeom_2f1(HALF, 1, 3 * HALF)
    return value if isinstance(square, acb) else value.real


def total(contours: Sequence[Contour], x: Vector, normal: Vector) -> Ball:
    """Irradiance per radiance [sr] from several loops."""
    return sum((contour.irradiance(x, normal) for contour in contours), arb(0))


def meet(a: Edge, b: Edge) -> Point | None:
    """The point in which the lines of two edges meet; None where they are parallel or pass each other."""
    along = _meeting(a, b)
    return None if along is None else plus(a[0], times(minus(a[1], a[0]), along))


def _meeting(a: Edge, b: Edge) -> Number | None:
    """How far along the first of two edges, in its own length, their lines meet."""
    along, other, apart = minus(a[1], a[0]), minus(b[1], b[0]), minus(b[0], a[0])
    normal = cross(along, other)
    if not any(normal) or dot(apart, normal) != 0:
        return None
    return dot(cross(apart, other), normal) / dot(normal, normal)


def _corner(edges: Loop, i: int, receiver: Point) -> Corner:
    """The corner between an edge and the one before it, as a point of that of the two which is farther away there: it moves
    less as the receiver does."""
    before, here = edges[i - 1], edges[i]
    if before[1] == here[0]:
        return Corner(i, i - 1, arb(0), arb(1), (), ())
    along = _meeting(here, before)
    if along is not None:
        seen = minus(plus(here[0], times(minus(here[1], here[0]), along)), receiver)
        corner = Corner(i, i - 1, arb(along), arb(_meeting(before, here)), (), ())
    else:
        edge, other, above, below, seen = max((_crossing(edges, *pair, receiver) for pair in ((i, i - 1), (i - 1, i))), key=_far)
        corner = Corner(edge % len(edges), other, None, None, _ball(above), _ball(below))
    if dot(cross(circle(before, receiver), circle(here, receiver)), seen) < 0:
        raise CannotCertify(BEYOND)
    return corner


def _far(crossing: tuple[int, int, Vector, Vector, Vector]) -> Number:
    return dot(crossing[-1], crossing[-1])


def _crossing(edges: Loop, i: int, other: int, receiver: Point) -> tuple[int, int, Vector, Vector, Vector]:
    """Where the great circle of another edge crosses an edge, and that point as seen from the receiver."""
    (start, end), (first, last) = edges[i], edges[other]
    run, way, ray = minus(end, start), minus(last, first), minus(first, receiver)
    above, below = cross(way, minus(first, start)), cross(way, run)
    if dot(ray, below) == 0:
        raise CannotCertify(BEYOND)
    return i, other, above, below, plus(minus(start, receiver), times(run, dot(ray, above) / dot(ray, below)))


def _ball(vector: Point) -> Vector:
    return tuple(arb(component) for component in vector)
