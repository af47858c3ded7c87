"""The solid angle of a disk: a rigorous integral along its rim.

Around the foot of the perpendicular from the receiver to the disk's plane, h away, the azimuth turns by df along the rim, and
a point of the rim is r away: the solid angle is the contour integral of (1 - h/r) df (Paxton 1959), on the axis and off it.
"""

from __future__ import annotations

from dataclasses import dataclass

from flint import acb, arb

from lightproof import geometry
from lightproof.certify.balls import Number, Point, Undecided, Vector, cross, dot, exact, minus, plus, point, root, times, unit


def solid_angle(shape: geometry.Disk, receiver: Point, normal: Point | None) -> arb:
    """Solid angle [sr] of the front of a disk, above the horizon if there is a normal. Raises Undecided."""
    rim = _rim(shape, receiver)
    if not rim.height > 0:
        return arb(0)
    if normal is None:
        return 2 * rim.turned(arb(0), arb.pi())
    level, across = dot(rim.centre, normal), times(normal, exact(shape.radius))
    along, beside = dot(across, rim.away), dot(across, rim.beside)
    reach = root(along * along + beside * beside)
    if level >= reach:
        return 2 * rim.turned(arb(0), arb.pi())
    if level <= -reach:
        return arb(0)
    if not (level < reach and level > -reach):
        raise Undecided("a disk touches the receiver's horizon too closely to tell")
    return rim.cut(arb.atan2(beside, along), (-level / reach).acos())


@dataclass(frozen=True)
class _Rim:
    """A disk seen from the origin, which is `height` before its plane and `offset` beside its axis; `away` and `beside` are unit
    vectors in its plane, the first from the foot of the perpendicular to the centre, and counter-clockwise with its normal."""

    centre: Vector
    radius: Number
    height: arb
    offset: arb
    away: Vector
    beside: Vector

    def turned(self, start: arb, end: arb) -> arb:
        """The contour integral between two angles, counted from `away`."""
        half = self.radius * self.offset
        fixed = self.height * self.height + self.offset * self.offset + self.radius * self.radius

        def integrand(t: acb, analytic: bool) -> acb:
            distance = root(fixed + 2 * half * t.cos())
            return (self.radius * self.radius + half * t.cos()) / (distance * (distance + self.height))

        return acb.integral(integrand, start, end).real

    def cut(self, middle: arb, half: arb) -> arb:
        """The part of the disk on one side of the chord between the angles `middle` - `half` and `middle` + `half`."""
        start, end = middle - half, middle + half
        foot = minus(self.centre, times(self.away, self.offset))
        return self.turned(start, end) + _triangle(foot, self.at(start), self.at(end))

    def at(self, t: arb) -> Vector:
        """The point of the rim at an angle."""
        outwards = plus(times(self.away, t.cos()), times(self.beside, t.sin()))
        return plus(self.centre, times(outwards, self.radius))


def _rim(shape: geometry.Disk, receiver: Point) -> _Rim:
    axis, centre = point(shape.normal), minus(point(shape.center), receiver)
    offset = minus(centre, times(axis, dot(axis, centre) / dot(axis, axis)))
    away = unit(offset if any(offset) else _perpendicular(axis))
    height = -dot(axis, centre) / root(dot(axis, axis))
    return _Rim(centre, exact(shape.radius), height, root(dot(offset, offset)), away, cross(unit(axis), away))


def _triangle(a: Vector, b: Vector, c: Vector) -> arb:
    """Signed solid angle [sr] of the triangle in which three directions, of any length, are seen (Van Oosterom and Strackee
    1983): positive where a, b, c run counter-clockwise."""
    la, lb, lc = (root(dot(side, side)) for side in (a, b, c))
    volume = dot(a, cross(minus(b, a), minus(c, a)))
    return 2 * arb.atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)


def _perpendicular(axis: Point) -> Point:
    return next(across for across in (cross(axis, (1, 0, 0)), cross(axis, (0, 1, 0))) if any(across))
