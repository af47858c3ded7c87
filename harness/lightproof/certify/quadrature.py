"""Integrals over the square [-1, 1]^2 by tensor Gauss-Legendre rules whose error is proven, not estimated.

Where f is analytic in the ellipse with foci -1, 1 and sum of semi-axes rho, and |f| <= M there, its Chebyshev
coefficients are at most 2 M rho^-k (Trefethen 2019, theorem 8.1). An n-point rule is exact to degree 2n - 1, odd terms
vanish, and even ones beyond err by at most 2 + 2/(k^2 - 1) <= 32/15, so |I - I_n| <= (64/15) M rho^-2n / (1 - rho^-2).
One evaluation of f on a complex ball that holds the ellipse gives M.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

from flint import acb, arb, ctx, fmpq

from lightproof.certify.balls import PRECISION, Ball, CannotCertify

GOAL = 58  # bits below f in the square's centre
DEPTH = 6  # halvings before giving up
RADII = (24, 16, 11, 8, 6, 4.5, 3.5, 2.8, 2.2, 1.8, 1.5)  # tried for rho, the widest first
MOST_NODES = 24
WHOLE = ((fmpq(0), fmpq(1)),)  # middle and half length
HALVES = ((fmpq(-1, 2), fmpq(1, 2)), (fmpq(1, 2), fmpq(1, 2)))

Integrand = Callable[[Ball, Ball], Ball]


def mean(f: Integrand) -> arb:
    """Encloses the mean of f over the square. Raises CannotCertify where f is not analytic around it."""
    return integral(f) / 4


def integral(f: Integrand, scale: arb | None = None, depth: int = DEPTH) -> arb:
    """Encloses the integral of f over the square, halved along each side where f is not analytic far enough around it. The
    error aimed at is `scale`, that of f in the middle unless given, over 2^GOAL."""
    whole = acb(arb(0, 1))
    scale = f(arb(0), arb(0)).abs_upper() if scale is None else scale
    across = _order(lambda ellipse: f(ellipse, whole), scale)
    along = _order(lambda ellipse: f(whole, ellipse), scale)
    if across and along:
        return _rule(f, across[0], along[0]) + 2 * arb(0, across[1]) + 2 * arb(0, along[1])
    if not depth:
        raise CannotCertify("the irradiance is not smooth enough somewhere on the film")
    parts = [_part(f, s, t) for s in (WHOLE if across else HALVES) for t in (WHOLE if along else HALVES)]
    return sum((integral(part, scale, depth - 1) for part in parts), arb(0)) / len(parts)


def _part(f: Integrand, across: tuple[fmpq, fmpq], along: tuple[fmpq, fmpq]) -> Integrand:
    """f over a part of the square, given by the middle and half the length of its sides, stretched to the square."""
    return lambda s, t: f(across[0] + across[1] * s, along[0] + along[1] * t)


def _order(f: Callable[[acb], Ball], scale: arb) -> tuple[int, arb] | None:
    """Number of nodes and proven error for f on [-1, 1], or None where too many nodes are needed."""
    best = None
    for rho in RADII:
        bound = f(acb(arb(0, (rho + 1 / rho) / 2), arb(0, (rho - 1 / rho) / 2))).abs_upper()
        if not bound.is_finite():
            continue
        nodes = max(1, math.ceil((GOAL + 3 + _bits(bound, scale)) / (2 * math.log2(rho))))
        if best and nodes > best[0]:
            break
        if nodes <= MOST_NODES:
            best = nodes, arb(64) / 15 * bound * arb(rho) ** (-2 * nodes) / (1 - arb(rho) ** -2)
    return best


def _bits(bound: arb, scale: arb) -> float:
    """log2 of a bound over the scale."""
    return math.log2(float(bound / scale)) if bound > 0 and scale > 0 else 0.0


def _rule(f: Integrand, across: int, along: int) -> arb:
    rows = nodes(along)
    return sum((u * sum((v * f(s, t) for t, v in rows), arb(0)) for s, u in nodes(across)), arb(0))


@cache
def nodes(order: int) -> tuple[tuple[arb, arb], ...]:
    """Nodes and weights of the Gauss-Legendre rule on [-1, 1], as balls."""
    with ctx.workprec(PRECISION):
        return tuple(arb.legendre_p_root(order, k, weight=True) for k in range(order))
