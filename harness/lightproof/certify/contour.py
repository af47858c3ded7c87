"""Lambert's formula around what a receiver sees of a polygon, made ready for many receivers near each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import acb, arb, fmpq

from lightproof.certify.balls import Ball, CannotCertify, Number, Point, Vector, angle, cross, dot, minus, plus, root, times
from lightproof.certify.polygon import Edge, Loop, chords, circle

HALF = fmpq(1, 2)


@dataclass(frozen=True)
class Fixed:
    """An end of an edge: a corner, or a point in which two lines meet, `along` of its length after its start."""

    along: arb
    sign: int = 1  # -1 where the opposite direction is meant, as may be on an edge that is continued

    def reach(self, rays: Sequence[Vector]) -> Number:
        """How far along the edge, in its own length."""
        return self.along


@dataclass(frozen=True)
class Crossing:
    """An end of an edge: where the great circle of edge number `other` crosses it."""

    other: int
    above: Vector
    below: Vector
    sign: int

    def reach(self, rays: Sequence[Vector]) -> Number:
        """How far along the edge, in its own length: a quotient of linear functions of the receiver."""
        ray = rays[self.other]
        return dot(ray, self.above) / dot(ray, self.below)


End = Fixed | Crossing


@dataclass(frozen=True)
class Contour:
    """A loop in balls: where each edge starts, how it runs, and between which ends it is seen."""

    starts: tuple[Vector, ...]
    runs: tuple[Vector, ...]
    ends: tuple[tuple[End, End], ...]

    @classmethod
    def of(cls, edges: Loop, receiver: Point) -> Contour:
        """The contour of a loop as an exact receiver sees it, and others near it. Raises CannotCertify."""
        befores, afters = edges[-1:] + edges[:-1], edges[1:] + edges[:1]
        return cls(
            tuple(_ball(start) for start, _ in edges),
            tuple(_ball(minus(end, start)) for start, end in edges),
            tuple((_end(before, here, here, i - 1, receiver), _end(here, after, here, i + 1 - len(edges), receiver))
                  for i, (before, here, after) in enumerate(zip(befores, edges, afters, strict=True))),
        )

    @classmethod
    def at(cls, edges: Loop, receiver: Point) -> Contour:
        """The contour of a loop for this receiver alone."""
        return cls.of(chords(edges, receiver), receiver)

    def outline(self, x: Vector) -> tuple[list[Vector], list[Vector]]:
        """Inward normals of the great circles on which the edges are seen, and the directions in which each edge begins."""
        circles, spans = self._seen(x)
        return circles, [times(start, ends[0].sign) for (start, _, _), ends in zip(spans, self.ends, strict=True)]

    def _seen(self, x: Vector) -> tuple[list[Vector], list[tuple[Vector, Vector, Number]]]:
        """The great circles, and of each edge the two ends as seen from x and how long it is, in its own length."""
        rays = [minus(start, x) for start in self.starts]
        circles = [cross(ray, run) for ray, run in zip(rays, self.runs, strict=True)]
        spans = []
        for ray, run, (first, last) in zip(rays, self.runs, self.ends, strict=True):
            begin, end = first.reach(rays), last.reach(rays)
            spans.append((plus(ray, times(run, begin)) if begin != 0 else ray, plus(ray, times(run, end)), end - begin))
        return circles, spans

    def irradiance(self, x: Vector, normal: Vector) -> Ball:
        """Irradiance per radiance [sr] from a loop above the horizon of a receiver with unit `normal` (Lambert 1760; Arvo
        1995): half the sum over edges of angle times cosine. Angles are signed, so it stays analytic where an edge vanishes."""
        circles, spans = self._seen(x)
        total = arb(0)
        for inwards, (start, end, span), (first, last) in zip(circles, spans, self.ends, strict=True):
            sign, lengths = first.sign * last.sign, root(dot(start, start)) * root(dot(end, end))
            total += _angle(sign * span, dot(inwards, inwards), sign * dot(start, end), lengths) * dot(inwards, normal)
        return total / 2


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


def _end(before: Edge, after: Edge, here: Edge, other: int, receiver: Point) -> End:
    """The end of an edge, which is one of two neighbours, at the `other` of them."""
    if before[1] == after[0]:
        return Fixed(arb(0 if here is after else 1))
    theirs = before if here is after else after
    run, way, apart = minus(here[1], here[0]), minus(theirs[1], theirs[0]), minus(theirs[0], here[0])
    above, below, ray = cross(way, apart), cross(way, run), minus(theirs[0], receiver)
    along = _meeting(here, theirs)
    if along is None and dot(ray, below) == 0:
        raise CannotCertify("an edge is seen to cross another one infinitely far off")
    reach = dot(ray, above) / dot(ray, below) if along is None else along
    crossing = cross(circle(before, receiver), circle(after, receiver))
    sign = 1 if dot(crossing, plus(minus(here[0], receiver), times(run, reach))) > 0 else -1
    return Fixed(arb(along), sign) if along is not None else Crossing(other, _ball(above), _ball(below), sign)


def _ball(vector: Point) -> Vector:
    return tuple(arb(component) for component in vector)
