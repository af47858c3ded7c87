"""Integrals over the square [-1, 1]^2 by tensor Gauss-Legendre rules whose error is proven, not estimated.

Where f is analytic in the ellipse with foci -1, 1 and sum of semi-axes rho, and |f| <= M there, its Chebyshev
coefficients are at most 2 M rho^-k (Trefethen 2019, theorem 8.1). An n-point rule is exact to degree 2n - 1, odd terms
vanish, and even ones beyond err by at most 2 + 2/(k^2 - 1) <= 32/15, so |I - I_n| <= (64/15) M rho^-2n / (1 - rho^-2).
Evaluations of f on complex balls that cover the ellipse give M (`ellipses`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from operator import itemgetter

from flint import arb, ctx, fmpq

from lightproof.certify import ellipses
from lightproof.certify.balls import PRECISION, Ball, CannotCertify

GOAL = 58  # bits below f in the square's centre
DEPTH = 6  # halvings before giving up
RADII = (24, 16, 11, 8, 6, 4.5, 3.5, 2.8, 2.2, 1.8, 1.5)  # tried for rho, the widest first
MANY_NODES, MOST_NODES = 14, 24
SPLITS = 4  # halvings of what a bound is taken over
WHOLE = ((fmpq(0), fmpq(1)),)  # middle and half length
HALVES = ((fmpq(-1, 2), fmpq(1, 2)), (fmpq(1, 2), fmpq(1, 2)))

Integrand = Callable[[Ball, Ball], Ball]
Rule = tuple[int, arb]  # nodes, proven error


def mean(f: Integrand) -> arb:
    """Encloses the mean of f over the square. Raises CannotCertify where f is not analytic around it."""
    return integral(f) / 4


def integral(f: Integrand, scale: arb | None = None, depth: int = DEPTH) -> arb:
    """Encloses the integral of f over the square, halved along each side where f is not analytic far enough around it. The
    error aimed at is `scale`, that of f in the middle unless given, over 2^GOAL."""
    scale = f(arb(0), arb(0)).abs_upper() if scale is None else scale
    across = _order(f, scale)
    along = _order(lambda t, s: f(s, t), scale)
    if across and along:
        return _rule(f, across[0], along[0]) + 2 * arb(0, across[1]) + 2 * arb(0, along[1])
    if not depth:
        raise CannotCertify("the irradiance is not smooth enough somewhere on the film")
    parts = [_part(f, s, t) for s in (WHOLE if across else HALVES) for t in (WHOLE if along else HALVES)]
    return sum((integral(part, scale, depth - 1) for part in parts), arb(0)) / len(parts)


def _part(f: Integrand, across: tuple[fmpq, fmpq], along: tuple[fmpq, fmpq]) -> Integrand:
    """f over a part of the square, given by the middle and half the length of its sides, stretched to the square."""
    return lambda s, t: f(across[0] + across[1] * s, along[0] + along[1] * t)


def _order(f: Integrand, scale: arb) -> Rule | None:
    """Number of nodes and proven error for f along its first variable, or None where too many nodes are needed. Bounds are
    refined where a plain one asks for many."""
    rule = _widest(f, scale, 0)
    if not rule or rule[0] > MANY_NODES:
        rule = min(filter(None, (rule, _widest(f, scale, SPLITS))), key=itemgetter(0), default=None)
    return rule if rule and rule[0] <= MOST_NODES else None


def _widest(f: Integrand, scale: arb, splits: int) -> Rule | None:
    """The best rule met on the way to the widest ellipse around which f is analytic, by bisection: on a narrower one the bound
    may be so much better that fewer nodes are enough."""
    rules, low, high = [], 0, len(RADII)
    while low < high:
        middle = (low + high) // 2
        bound = ellipses.bound(f, RADII[middle], splits)
        low, high = (middle + 1, high) if bound is None else (low, middle)
        rules += [] if bound is None else [_rule_for(RADII[middle], bound, scale)]
    return min(rules, key=itemgetter(0), default=None)


def _rule_for(rho: float, bound: arb, scale: arb) -> Rule:
    nodes = max(2, math.ceil((GOAL + 3 + _bits(bound, scale)) / (2 * math.log2(rho))))
    return nodes, arb(64) / 15 * bound * arb(rho) ** (-2 * nodes) / (1 - arb(rho) ** -2)


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
