"""Bounds of analytic functions on Bernstein's ellipses, with foci -1 and 1 and sum of semi-axes rho."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from flint import acb, arb

from lightproof.certify.balls import Ball

SLACK = 1 + 1e-12  # for the rounding of semi-axes
Interval = tuple[float, float]


@dataclass(frozen=True)
class Box:
    """A box of the complex plane and an interval of a real variable."""

    real: Interval
    imaginary: Interval
    beside: Interval

    def halves(self, splits: int) -> tuple[Box, Box]:
        """Two boxes that cover it: in turn the complex box is cut, where it is longest, and the interval."""
        sides = {name: getattr(self, name) for name in (("real", "imaginary") if splits % 2 == 0 else ("beside",))}
        name = max(sides, key=lambda name: sides[name][1] - sides[name][0])
        low, high = sides[name]
        return replace(self, **{name: (low, (low + high) / 2)}), replace(self, **{name: ((low + high) / 2, high)})


def bound(f: Callable[[Ball, Ball], Ball], rho: float, splits: int) -> arb | None:
    """A bound of |f(z, t)| for z in the ellipse and t in [-1, 1]; None where f may not be analytic there, as
    far as boxes show that have been halved `splits` times.

    f is real for real arguments, so |f| is the same on the lower half of the ellipse as on the upper.
    """
    width, height = ((rho + sign / rho) / 2 * SLACK for sign in (1, -1))

    def outside(box: Box) -> bool:
        x = max(0.0, box.real[0], -box.real[1])
        return (x / width) ** 2 + (box.imaginary[0] / height) ** 2 > SLACK

    def over(box: Box, splits: int) -> arb | None:
        value = f(acb(_ball(box.real), _ball(box.imaginary)), acb(_ball(box.beside))).abs_upper()
        if value.is_finite():
            return value
        parts = [over(half, splits - 1) for half in box.halves(splits) if not outside(half)] if splits else [None]
        return None if None in parts else max(parts)

    return over(Box((-width, width), (0.0, height), (-1.0, 1.0)), splits)


def _ball(interval: Interval) -> arb:
    return arb(interval[0]).union(arb(interval[1]))
