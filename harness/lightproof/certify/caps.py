"""Round regions of directions, such as a sun or a ball, against loops of great circles, from one receiver in exact numbers.

What a cap and a convex loop share is convex, and runs round along great circles and the cap's rim. Which arcs these are is
decided exactly, or in balls wherever these can tell; solid angle and irradiance follow arc by arc.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from flint import arb, fmpq

from lightproof import geometry
from lightproof.certify import balls
from lightproof.certify.balls import CannotCertify, Number, Point, Undecided, Vector, cross, dot, minus, plus, root, times, unit
from lightproof.certify.polygon import Loop, circle, corners_of
from lightproof.certify.rounded import Arc, Contour
from lightproof.scene import SunDisc


@dataclass(frozen=True)
class Cap:
    """The directions within an angle, of at most 90 degrees, of an `axis` of any length."""

    axis: Point
    cosine_squared: Number

    @property
    def cosine(self) -> arb:
        """Cosine of the angle between axis and rim."""
        return root(self.cosine_squared)

    def holds(self, direction: Point) -> bool:
        """Whether a direction is strictly inside."""
        along, lengths = dot(self.axis, direction), dot(self.axis, self.axis) * dot(direction, direction)
        return along > 0 and sign(along * along - self.cosine_squared * lengths) > 0

    def meets(self, normal: Point) -> bool:
        """Whether the great circle with this normal runs through the inside."""
        along, lengths = dot(self.axis, normal), dot(self.axis, self.axis) * dot(normal, normal)
        return sign((1 - self.cosine_squared) * lengths - along * along) > 0


def sun(light: SunDisc) -> Cap:
    """The directions in which a sun is seen."""
    turn = balls.exact(light.half_angle) / 180
    cosine_squared = fmpq(0) if light.half_angle == 90 else (arb.pi() * turn).cos() ** 2
    return Cap(times(balls.point(light.direction), -1), cosine_squared)


def ball(shape: geometry.Sphere, receiver: Point) -> Cap:
    """The directions in which a sphere is seen. Raises CannotCertify from within."""
    axis = minus(balls.point(shape.center), receiver)
    share = balls.exact(shape.radius) ** 2 / dot(axis, axis) if any(axis) else fmpq(1)
    if share >= 1:
        raise CannotCertify("a receiver is inside a sphere, or on it")
    return Cap(axis, 1 - share)


def sign(number: Number) -> int:
    """-1, 0 or 1. Raises Undecided where a ball holds 0."""
    if isinstance(number, arb) and number.contains(0) and not number.is_zero():
        raise Undecided("the rim of something round touches an edge, a corner, the horizon or another rim too closely to tell")
    return int(number > 0) - int(number < 0)


def apart(a: Cap, b: Cap) -> bool:
    """Whether two caps share nothing."""
    return sign(a.cosine * b.cosine - _sine(a) * _sine(b) - _between(a, b)) >= 0


def within(a: Cap, b: Cap) -> bool:
    """Whether a cap lies in another."""
    if sign(a.cosine - b.cosine) < 0:
        return False
    return sign(_between(a, b) - a.cosine * b.cosine - _sine(a) * _sine(b)) >= 0


def _sine(cap: Cap) -> arb:
    return root(1 - cap.cosine_squared)


def _between(a: Cap, b: Cap) -> arb:
    """Cosine of the angle between two axes."""
    return dot(unit(a.axis), unit(b.axis))


def whole(cap: Cap) -> Contour:
    """The contour of a cap."""
    axis, cosine = unit(cap.axis), cap.cosine
    across = unit(_perpendicular(cap.axis))
    start = plus(times(axis, cosine), times(across, root(1 - cap.cosine_squared)))
    return (Arc(axis, cosine, start, start, 2 * arb.pi()),)


def above(cap: Cap, normal: Point) -> Contour:
    """What a cap has on one side of the great circle with an inward `normal`."""
    if not cap.meets(normal):
        return whole(cap) if dot(cap.axis, normal) > 0 else ()
    enter, leave = _crossings(cap, normal)
    return _great(normal, enter, leave), _rim(cap, leave, enter)


def shared(cap: Cap, edges: Loop, receiver: Point) -> Contour:
    """What a cap and a convex loop share. Raises CannotCertify where that cannot be decided."""
    corners = corners_of(edges, receiver)
    normals = [circle(edge, receiver) for edge in edges]
    pieces = list(_pieces(cap, corners, normals))
    if not pieces:
        return whole(cap) if all(dot(normal, cap.axis) > 0 for normal in normals) else ()
    following = pieces[1:] + pieces[:1]
    return tuple(arc for piece, after in zip(pieces, following, strict=True) for arc in _linked(cap, piece, after))


@dataclass(frozen=True)
class _Piece:
    """The part of an edge inside a cap; `leaves` where it ends on the rim rather than in the loop's next corner."""

    arc: Arc
    leaves: bool


def _pieces(cap: Cap, corners: Sequence[Point], normals: Sequence[Point]) -> Iterator[_Piece]:
    inside = [cap.holds(corner) for corner in corners]
    for i, normal in enumerate(normals):
        j = (i + 1) % len(normals)
        between = dot(cross(normal, corners[i]), cap.axis) > 0 > dot(cross(normal, corners[j]), cap.axis)
        if inside[i] or inside[j] or (between and cap.meets(normal)):
            start = unit(corners[i]) if inside[i] else _crossings(cap, normal)[0]
            end = unit(corners[j]) if inside[j] else _crossings(cap, normal)[1]
            yield _Piece(_great(normal, start, end), not inside[j])


def _linked(cap: Cap, piece: _Piece, after: _Piece) -> Iterator[Arc]:
    """A piece and, where it leaves the cap, the rim up to the next."""
    yield piece.arc
    if piece.leaves:
        yield _rim(cap, piece.arc.end, after.arc.start)


def _crossings(cap: Cap, normal: Point) -> tuple[Vector, Vector]:
    """Where a great circle enters and leaves a cap."""
    axis, inwards = unit(cap.axis), unit(normal)
    along = dot(axis, inwards)
    across = 1 - along * along
    nearest = times(minus(axis, times(inwards, along)), cap.cosine / across)
    half = times(cross(inwards, axis), root(1 - cap.cosine_squared / across) / root(across))
    return minus(nearest, half), plus(nearest, half)


def _great(normal: Point, start: Vector, end: Vector) -> Arc:
    """The arc of a great circle, half a turn at most."""
    axis = unit(normal)
    return Arc(axis, 0, start, end, arb.pi() / 2 - arb.atan2(dot(start, end), dot(axis, cross(start, end))))


def _rim(cap: Cap, start: Vector, end: Vector) -> Arc:
    """The arc of a rim from where one edge leaves to where the next enters: less than a whole turn. Raises CannotCertify."""
    axis, cosine = unit(cap.axis), cap.cosine
    opposite, adjacent = dot(axis, cross(start, end)), dot(start, end) - cap.cosine_squared
    if adjacent < 0:
        return Arc(axis, cosine, start, end, arb.pi() + arb.atan2(-opposite, -adjacent))
    turn = arb.atan2(opposite, adjacent)
    return Arc(axis, cosine, start, end, turn if sign(opposite) > 0 else turn + 2 * arb.pi())


def _perpendicular(axis: Point) -> Point:
    return next(across for across in (cross(axis, (1, 0, 0)), cross(axis, (0, 1, 0))) if any(across))
