"""The part of a polygon that an ellipse encloses."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from flint import arb, fmpq

from lightproof.certify import planes
from lightproof.certify.balls import Number, Rational, root
from lightproof.certify.planes import Flat, Region

Conic = tuple[Rational, Rational, Rational, Rational, Rational, Rational]


@dataclass(frozen=True)
class Ellipse:
    """The positions p with (p - centre, p - centre) <= 1 in the inner product (u, v) = a u0 v0 + b (u0 v1 + u1 v0) + c u1 v1."""

    centre: Flat
    a: Rational
    b: Rational
    c: Rational

    @classmethod
    def of(cls, conic: Conic) -> Ellipse:
        """Where a x^2 + 2 b x y + c y^2 + 2 d x + 2 e y + f <= 0; there is such an ellipse, and a > 0."""
        a, b, c, d, e, f = conic
        x, y = (b * e - c * d) / (a * c - b * b), (b * d - a * e) / (a * c - b * b)
        scale = -(d * x + e * y + f)
        return cls((x, y), a / scale, b / scale, c / scale)

    def share(self, region: Region) -> arb:
        """The share of a convex region's area; 0 and 1 are exact."""
        sides = list(self._sides(region))
        if all(self._inner(start, start) <= 1 for start, _ in sides):
            return arb(1)
        stretch = root(self.a * self.c - self.b * self.b)
        if any(self._enters(*side) for side in sides):
            enclosed = sum((self._swept(*side, stretch) for side in sides), arb(0)) / 2
        else:
            enclosed = arb.pi() if self._centred(region) else arb(0)
        return enclosed / (stretch * planes.area(region))

    def _sides(self, region: Region) -> Iterator[tuple[Flat, Flat]]:
        """The region's sides, from the centre."""
        corners = [(p[0] - self.centre[0], p[1] - self.centre[1]) for p in region]
        return zip(corners, corners[1:] + corners[:1], strict=True)

    def _centred(self, region: Region) -> bool:
        return all(planes.area((region[i - 1], region[i], self.centre)) > 0 for i in range(len(region)))

    def _inner(self, u: tuple[Number, Number], v: tuple[Number, Number]) -> Number:
        return self.a * u[0] * v[0] + self.b * (u[0] * v[1] + u[1] * v[0]) + self.c * u[1] * v[1]

    def _enters(self, start: Flat, end: Flat) -> bool:
        """Whether a part of a side is inside."""
        nearest = _along(start, end, max(fmpq(0), min(fmpq(1), self._crossing(start, end)[0])))
        return self._inner(nearest, nearest) < 1

    def _crossing(self, start: Flat, end: Flat) -> tuple[Rational, Rational]:
        """Where a side's line is half way through the ellipse, from 0 at its start to 1 at its end, and the square of how far it
        is from there to where it enters."""
        way = (end[0] - start[0], end[1] - start[1])
        squared = self._inner(way, way)
        middle = -self._inner(start, way) / squared
        return middle, middle * middle - (self._inner(start, start) - 1) / squared

    def _swept(self, start: Flat, end: Flat, stretch: arb) -> arb:
        """Twice the area that the ray from the centre to a side sweeps inside the ellipse, where that is stretched to the unit
        circle: angles on the way in and out, a triangle between."""
        middle, square = self._crossing(start, end)
        half = root(max(square, fmpq(0)))
        enter, leave = (_along(start, end, arb(t).max(arb(0)).min(arb(1))) for t in (middle - half, middle + half))
        return self._angle(start, enter, stretch) + stretch * _cross(enter, leave) + self._angle(leave, end, stretch)

    def _angle(self, u: tuple[Number, Number], v: tuple[Number, Number], stretch: arb) -> arb:
        return arb.atan2(stretch * _cross(u, v), arb(self._inner(u, v)))


def _along(start: Flat, end: Flat, t: Number) -> tuple[Number, Number]:
    return start[0] + (end[0] - start[0]) * t, start[1] + (end[1] - start[1]) * t


def _cross(u: tuple[Number, Number], v: tuple[Number, Number]) -> Number:
    return u[0] * v[1] - u[1] * v[0]
