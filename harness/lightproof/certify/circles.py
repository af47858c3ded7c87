"""Circles on the sphere of directions around a receiver, which is the origin here.

Straight edges are seen on great circles, rims of disks on the directions of a circle in space. Each has a left side as it is
run through, points by angle, the angle of a direction, and its part of Lambert's contour integral in closed form.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from flint import arb, fmpq

from lightproof.certify.balls import Number, Rational, Undecided, Vector, cross, dot, minus, plus, root, times, unit

Basis = tuple[Vector, Vector]  # two orthogonal unit vectors of balls


@dataclass(frozen=True, eq=False)
class Great:
    """The great circle across `normal` (any length), run counter-clockwise about it: on its left normal . d > 0."""

    normal: Vector

    @cached_property
    def key(self) -> object:
        """Equal for great circles that are known to coincide, whatever the direction in which they are run through."""
        if not all(isinstance(component, fmpq) for component in self.normal):
            return id(self)
        leading = next(component for component in self.normal if component)
        return tuple(component / leading for component in self.normal)

    @cached_property
    def basis(self) -> Basis:
        """Unit vectors at angles 0 and pi/2."""
        return across(self.normal)

    def left(self, direction: Vector) -> bool:
        """Whether a direction is on the left. Raises Undecided."""
        return positive(dot(self.normal, direction))

    def along(self, other: Great) -> bool:
        """Whether another great circle of the same key is run through the same way."""
        return positive(dot(self.normal, other.normal))

    def at(self, angle: arb) -> Vector:
        """The direction at an angle."""
        sine, cosine = angle.sin_cos()
        return plus(times(self.basis[0], cosine), times(self.basis[1], sine))

    def angle(self, direction: Vector) -> arb:
        """The angle of a direction on the circle, in (-pi/2, 3 pi/2)."""
        return turn(dot(direction, self.basis[0]), dot(direction, self.basis[1]))

    def contour(self, start: arb, end: arb, normal: Vector) -> arb:
        """Integral of normal . (r x dr) / |r|^2 from one angle to another."""
        return (end - start) * dot(normal, unit(self.normal))

    @property
    def steepest(self) -> arb:
        """Bounds that integrand, per angle, for a unit normal."""
        return arb(1)


@dataclass(frozen=True, eq=False)
class Rim:
    """The circle of squared radius `square` whose centre is `offset` off the `axis` through the receiver (any length, offset .
    axis = 0) and at axis . centre = `height` > 0. It is run counter-clockwise about the axis: inside is on its left."""

    offset: Vector
    axis: Vector
    height: Number
    square: Number

    @classmethod
    def around(cls, centre: Vector, axis: Vector, square: Number) -> Rim:
        """The rim with a centre; its axis is turned to where it is seen. Raises Undecided."""
        height = dot(axis, centre)
        sign = 1 if positive(height) else -1
        offset = minus(centre, times(axis, height / dot(axis, axis)))
        return cls(offset, times(axis, sign), sign * height, square)

    @property
    def key(self) -> object:
        """Equal for rims that are known to coincide."""
        return id(self)

    @cached_property
    def centre(self) -> Vector:
        """The centre."""
        return plus(self.offset, times(self.axis, self.height / dot(self.axis, self.axis)))

    @cached_property
    def lean(self) -> Number:
        """The squared length of the offset."""
        return dot(self.offset, self.offset)

    @cached_property
    def basis(self) -> Basis:
        """Unit vectors at angles 0, along the offset, and pi/2."""
        if self.lean == 0:
            return across(self.axis)
        first = unit(self.offset)
        return first, cross(unit(self.axis), first)

    @cached_property
    def radius(self) -> arb:
        """The radius."""
        return root(self.square)

    def form(self, a: Vector, b: Vector) -> Number:
        """The bilinear form that is negative, for a = b, inside the cone through the rim and its mirror image."""
        high, low = dot(self.axis, a), dot(self.axis, b)
        mixed = high * dot(self.centre, b) + low * dot(self.centre, a)
        slack = dot(self.centre, self.centre) - self.square
        return self.height * (self.height * dot(a, b) - mixed) + high * low * slack

    def left(self, direction: Vector) -> bool:
        """Whether a direction is inside. Raises Undecided."""
        return positive(-self.form(direction, direction)) and positive(dot(self.axis, direction))

    def along(self, other: Rim) -> bool:
        """The same rim is run through the same way."""
        return True

    def at(self, angle: arb) -> Vector:
        """The point at an angle."""
        sine, cosine = angle.sin_cos()
        return self.towards(cosine, sine)

    def towards(self, cosine: arb, sine: arb) -> Vector:
        """The point at the angle of a cosine and a sine."""
        return plus(self.centre, times(plus(times(self.basis[0], cosine), times(self.basis[1], sine)), self.radius))

    def angle(self, direction: Vector) -> arb:
        """The angle of a direction on the rim, in (-pi/2, 3 pi/2)."""
        spoke = minus(times(direction, self.height / dot(self.axis, direction)), self.centre)
        return turn(dot(spoke, self.basis[0]), dot(spoke, self.basis[1]))

    def contour(self, start: arb, end: arb, normal: Vector) -> arb:
        """Integral of normal . (r x dr) / |r|^2 from one angle to another, up to a turn apart: |r|^2 = p + q cos f on the rim,
        and with k = q / (p + d), d^2 = p^2 - q^2, the integral of d / (p + q cos f) is f - 2 atan(k sin f / (1 + k cos f))."""
        parts = [self._primitives(angle) for angle in (start, end)]
        level, cosines, sines = (after - before for before, after in zip(*parts, strict=True))
        first, second = self.basis
        straight = self.square * level * dot(normal, unit(self.axis))
        return straight + self.radius * (
            cosines * dot(normal, cross(self.centre, second)) - sines * dot(normal, cross(self.centre, first)))

    @cached_property
    def _squares(self) -> tuple[arb, arb, arb]:
        """p, q and d."""
        p, q = arb(dot(self.centre, self.centre) + self.square), 2 * self.radius * root(self.lean)
        far, gap = p + q, self.radius - root(self.lean)
        near = self.height * self.height / dot(self.axis, self.axis) + gap * gap
        return p, q, root(far * near)

    def _primitives(self, f: arb) -> tuple[arb, arb, arb]:
        """Integrals of 1, cos f and sin f over p + q cos f."""
        (p, q, d), (sine, cosine) = self._squares, f.sin_cos()
        if self.lean == 0:
            return f / p, sine / p, -cosine / p
        k = q / (p + d)
        bend = (k * sine / (1 + k * cosine)).atan()
        return (f - 2 * bend) / d, ((1 + k * k) / k * bend - k * f) / d, -(p + q * cosine).log() / q

    @property
    def steepest(self) -> arb:
        """Bounds that integrand, per angle, for a unit normal: radius over least distance."""
        p, q, d = self._squares
        return self.radius * root(p + q) / d


Circle = Great | Rim


def positive(number: Rational | arb) -> bool:
    """Whether a number is greater than 0. Raises Undecided where it may be or not, or where a ball may be 0."""
    if isinstance(number, fmpq) or number > 0:
        return bool(number > 0)
    if number < 0:
        return False
    raise Undecided("two outlines coincide, or touch, as a receiver sees them")


def across(axis: Vector) -> Basis:
    """Unit vectors a, b with a x b along an axis."""
    sizes = [abs(arb(component).mid()) for component in axis]
    least = min(range(3), key=lambda i: sizes[i])
    first = unit(cross(axis, tuple(fmpq(i == least) for i in range(3))))
    return first, cross(unit(axis), first)


def turn(x: arb, y: arb) -> arb:
    """The angle of (x, y), in (-pi/2, 3 pi/2)."""
    return arb.atan2(y, x) if x.mid() >= 0 else arb.atan2(-y, -x) + arb.pi()
