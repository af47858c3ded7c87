"""Numbers whose error is known: exact rationals for decisions, balls that enclose the true value for everything else.

Vectors are tuples of three numbers; rationals (fmpq), real balls (arb) and complex balls (acb) mix freely. Functions of
balls here are analytic continuations: where a complex ball meets a branch cut the result is not finite, never wrong.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from flint import acb, arb, fmpq

PRECISION = 128  # bits to begin with

Rational = fmpq
Ball = arb | acb
Number = Any  # fmpq | arb | acb
Vector = tuple[Number, Number, Number]
Point = tuple[Rational, Rational, Rational]
Element = Callable[[int], arb]  # index of a film element -> its value


class CannotCertify(Exception):
    """There is no proven answer for this scene; the message says what stands in the way."""


class Undecided(CannotCertify):
    """Balls too wide to tell on which side of an event a receiver is: more precision may help."""


def exact(number: float) -> Rational:
    """The rational that a binary64 is."""
    return fmpq(*float(number).as_integer_ratio())


def point(vector: Iterable[float]) -> Point:
    """The exact point that three binary64 numbers name."""
    return tuple(exact(component) for component in vector)


def plus(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def minus(a: Vector, b: Vector) -> Vector:
    """a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def times(a: Vector, factor: Number) -> Vector:
    """a times a number."""
    return a[0] * factor, a[1] * factor, a[2] * factor


def dot(a: Vector, b: Vector) -> Number:
    """Inner product, without complex conjugation: it stays analytic."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def unit(a: Vector) -> Vector:
    """`a` scaled to unit length."""
    return times(a, 1 / root(dot(a, a)))


def root(x: Number) -> Ball:
    """Square root; not finite where `x` may be negative."""
    return x.sqrt(analytic=True) if isinstance(x, acb) else arb(x).sqrt()


def exact_root(x: Rational) -> Number:
    """Square root of a rational: a rational where it is one."""
    return fmpq(x.p.isqrt(), x.q.isqrt()) if x.p.is_square() and x.q.is_square() else root(x)


def arctan(x: Ball) -> Ball:
    """Inverse tangent, continued by logarithms: arb's own would cross its branch cuts unnoticed."""
    if not isinstance(x, acb):
        return arb(x).atan()
    i = acb(0, 1)
    return ((1 + i * x).log(analytic=True) - (1 - i * x).log(analytic=True)) / (2 * i)


def angle(opposite: Ball, adjacent: Ball, hypotenuse: Ball) -> Ball:
    """The angle in (-pi, pi) of a right triangle with signed legs, atan2(opposite, adjacent): of two equal half-angle
    formulas, the one that does not cancel."""
    middle = (adjacent.real if isinstance(adjacent, acb) else arb(adjacent)).mid()
    return 2 * arctan(opposite / (hypotenuse + adjacent) if middle > 0 else (hypotenuse - adjacent) / opposite)
