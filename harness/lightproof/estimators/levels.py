"""How far a point lies in front of a plane, to the last digits of a float64 even where the terms cancel.

The plain dot product is taken where it keeps its digits; elsewhere every rounding error is carried along (Ogita, Rump and
Oishi 2005, "Accurate sum and dot product", algorithm Dot2).
"""

from __future__ import annotations

from numba import njit

from lightproof.estimators.compiled import strict
from lightproof.estimators.vectors import dot, sub

ZERO = (0.0, 0.0, 0.0)
CANCELLED = 0.01  # a sum below this share of its terms has lost two digits
SPLIT = 2.0**27 + 1  # cuts a float64 into two halves of 26 bits (Veltkamp)

exact = njit(error_model="numpy")  # nothing fused, nothing reordered


@exact
def two_sum(a, b):
    """a + b, rounded, and what the rounding left out (Knuth)."""
    total = a + b
    other = total - a
    return total, (a - (total - other)) + (b - other)


@exact
def halves(a):
    c = SPLIT * a
    high = c - (c - a)
    return high, a - high


@exact
def two_product(a, b):
    """a b, rounded, and what the rounding left out (Dekker)."""
    product = a * b
    a1, a2 = halves(a)
    b1, b2 = halves(b)
    return product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2


@strict
def level(normal, low, p, x):
    """(normal + low) . (p - x); `low` is what float64 leaves out of the normal."""
    d = sub(p, x)
    value = dot(normal, d)
    if abs(value) > CANCELLED * (abs(normal[0] * d[0]) + abs(normal[1] * d[1]) + abs(normal[2] * d[2])):
        return value
    return carried(normal, low, p, x)


@exact
def carried(normal, low, p, x):
    """The same with all rounding errors of first order."""
    total, rest = 0.0, 0.0
    for i in range(3):
        d, lost = two_sum(p[i], -x[i])
        product, cut = two_product(normal[i], d)
        total, off = two_sum(total, product)
        rest += cut + off + normal[i] * lost + low[i] * d
    return total + rest
