"""The mean over a film element, split along the curves across which the light's visible shape changes.

A curve is c0 + c1 p + c2 q + c3 p^2 + c4 p q + c5 q^2 = 0 within a box p_low, p_high, q_low, q_high; p and q run from -1/2 to 1/2
over the element. Between two breaks (p where curves cross, end, turn back or leave the element) the curves cut every line
p = const into the same pieces: Gauss-Legendre in q over each of them, then in p.
"""

from __future__ import annotations

import math

import numpy as np

from lightproof.estimators import gauss
from lightproof.estimators.compiled import strict
from lightproof.estimators.sources import irradiance, is_round
from lightproof.estimators.tracing import vector
from lightproof.estimators.vectors import along

HIGHEST = 32  # order of a Gauss rule
BREAKS = 4096  # room for breaks
THIN = 1e-12  # of an element: an interval that is not worth a rule
SLACK = 1e-9  # of an element: how far outside its box a curve still is
STRIDES = 4  # parts of an interval in each of which a conic is crossed once at most
STEPS = 60  # of a bisection
NODES, WEIGHTS = gauss.table(HIGHEST)


@strict
def mean(source, desk, element, curves, samples, most):
    """Mean irradiance over an `element` (12,) with about `samples` nodes, and how many they are; in rules of `most` nodes a side
    at most. `curves` (m, 10) belong to the element."""
    breaks = np.empty(BREAKS if len(curves) else 2)
    count = broken(curves, breaks)
    pieces, roots = 0, np.empty(2 * len(curves) + 2)
    for k in range(count - 1):
        pieces += between(curves, (breaks[k] + breaks[k + 1]) / 2, roots) - 1
    order = max(int(math.sqrt(samples / pieces) + 0.5), int(samples ** (1 / 3) + SLACK), 1)
    bent = bends(curves)
    total, nodes = 0.0, 0
    panels = -(-order // most)
    order = -(-order // panels)
    for k in range(count - 1):
        for i in range(panels * order):
            p, weight = node(breaks[k], breaks[k + 1], panels, order, i, bent)
            value, used = line(source, desk, element, curves, p, panels, order, roots)
            total += weight * value
            nodes += used
    return total, nodes


@strict
def own(curves, row, column, grid, out):
    """The curves (m, 10) of a film of `grid` (rows, columns) that meet one element, in its own p and q, into `out`; how many."""
    a, b, kept = 1 / grid[1], 1 / grid[0], 0
    p, q = (column + 0.5) * a - 0.5, (row + 0.5) * b - 0.5
    for i in range(len(curves)):
        c, one = curves[i], out[kept]
        one[0] = c[0] + c[1] * p + c[2] * q + c[3] * p * p + c[4] * p * q + c[5] * q * q
        one[1], one[2] = a * (c[1] + 2 * c[3] * p + c[4] * q), b * (c[2] + c[4] * p + 2 * c[5] * q)
        one[3], one[4], one[5] = a * a * c[3], a * b * c[4], b * b * c[5]
        one[6], one[7], one[8], one[9] = (c[6] - p) / a, (c[7] - p) / a, (c[8] - q) / b, (c[9] - q) / b
        reach = (abs(one[1]) + abs(one[2])) / 2 + (abs(one[3]) + abs(one[4]) + abs(one[5])) / 4
        kept += abs(one[0]) < reach and max(one[6], one[8]) < 0.5 and min(one[7], one[9]) > -0.5
    return kept


@strict
def line(source, desk, element, curves, p, panels, order, roots):
    """Integral over q at p, and the number of nodes."""
    count = between(curves, p, roots)
    start, normal = along(vector(element, 0), p, vector(element, 3)), vector(element, 9)
    total, crowded = 0.0, is_round(source) and bends(curves)
    for k in range(count - 1):
        for i in range(panels * order):
            q, weight = node(roots[k], roots[k + 1], panels, order, i, crowded)
            total += weight * irradiance(source, desk, along(start, q, vector(element, 6)), normal)
    return total, (count - 1) * panels * order


@strict
def node(begin, end, panels, order, i, bent):
    """Node i of a rule of so many panels between two ends, and its weight; `bent`: crowded at both ends, so that a square root
    there does no harm."""
    t = (i // order + NODES[order, i % order]) / panels
    weight = WEIGHTS[order, i % order] / panels
    if bent:
        weight *= 6 * t * (1 - t)
        t = t * t * (3 - 2 * t)
    return begin + t * (end - begin), weight * (end - begin)


@strict
def bends(curves):
    """Whether a curve is not straight."""
    bent = False
    for c in curves:
        bent |= c[3] != 0 or c[4] != 0 or c[5] != 0
    return bent


@strict
def between(curves, p, roots):
    """The q at which the line at p is cut, in order, its ends included, into `roots`; returns how many."""
    roots[0], count = -0.5, 1
    for i in range(len(curves)):
        for q in crossings(curves[i], p):
            if within(curves[i], p, q):
                count = insert(roots, count, q)
    roots[count] = 0.5
    return count + 1


@strict
def insert(values, count, value):
    """Puts a value where it belongs among sorted ones after the first; returns the new count, the old one where it is there."""
    at = count
    while at > 0 and values[at - 1] > value:
        at -= 1
    if value - values[at - 1] < THIN or (at < count and values[at] - value < THIN):
        return count
    for k in range(count, at, -1):
        values[k] = values[k - 1]
    values[at] = value
    return count + 1


@strict
def within(c, p, q):
    """Whether a point of a curve lies in its box, in the element."""
    inside = abs(p) < 0.5 and abs(q) < 0.5
    return inside and c[6] - SLACK <= p <= c[7] + SLACK and c[8] - SLACK <= q <= c[9] + SLACK


@strict
def crossings(c, p):
    """The two q of a curve at p, the lower first; inf for one that there is not."""
    return quadratic(c[5], c[2] + c[4] * p, c[0] + c[1] * p + c[3] * p * p)


@strict
def quadratic(a, b, c):
    """The real roots of a x^2 + b x + c, the lower first; inf for one that there is not."""
    square = b * b - 4 * a * c
    if square < 0 or (a == 0 and b == 0):
        return np.inf, np.inf
    far = -(b + math.copysign(math.sqrt(square), b)) / 2
    one = far / a if a != 0 else np.inf
    other = c / far if far != 0 else 0.0
    return min(one, other), max(one, other)


@strict
def broken(curves, breaks):
    """The p between which nothing changes, in order, the element's ends included, into `breaks`; returns how many."""
    breaks[0], breaks[1], count = -0.5, 0.5, 2
    for i in range(len(curves)):
        count = ends(curves[i], breaks, count)
    meetings = breaks[:count].copy()
    for i in range(len(curves)):
        for j in range(i):
            count = meet(curves[i], curves[j], meetings, breaks, count)
    return count


@strict
def ends(c, breaks, count):
    """Adds where a curve leaves the element or its box, and where it turns back."""
    for q in (-0.5, 0.5):
        for p in quadratic(c[3], c[1] + c[4] * q, c[0] + c[2] * q + c[5] * q * q):
            count = add(breaks, count, p)
    for p in (c[6], c[7]):
        count = add(breaks, count, p)
    if c[5] != 0:
        a, b = c[4] * c[4] - 4 * c[5] * c[3], 2 * c[2] * c[4] - 4 * c[5] * c[1]
        for p in quadratic(a, b, c[2] * c[2] - 4 * c[5] * c[0]):
            if within(c, p, -(c[2] + c[4] * p) / (2 * c[5])):
                count = add(breaks, count, p)
    return count


@strict
def add(breaks, count, p):
    """A break more, if it lies in the element and there is room."""
    return insert(breaks, count, p) if abs(p) < 0.5 and count < len(breaks) else count


@strict
def meet(c, d, places, breaks, count):
    """Adds where two curves cross between neighbours of `places`."""
    straight = c[3] == 0 and c[4] == 0 and c[5] == 0 and d[3] == 0 and d[4] == 0 and d[5] == 0
    strides = 1 if straight else STRIDES
    for k in range(len(places) - 1):
        for stride in range(strides):
            a = places[k] + (places[k + 1] - places[k]) * stride / strides
            b = places[k] + (places[k + 1] - places[k]) * (stride + 1) / strides
            for one in range(2):
                for other in range(2):
                    p = meeting(c, d, one, other, a, b)
                    if p < np.inf and within(c, p, crossings(c, p)[one]) and within(d, p, crossings(c, p)[one]):
                        count = add(breaks, count, p)
    return count


@strict
def meeting(c, d, one, other, a, b):
    """Where branches `one` of c and `other` of d cross between a and b; inf where they do not."""
    low, high = apart(c, d, one, other, a), apart(c, d, one, other, b)
    if low == np.inf or high == np.inf or low * high >= 0:
        return np.inf
    for _ in range(STEPS):
        middle = (a + b) / 2
        if apart(c, d, one, other, middle) * low > 0:
            a = middle
        else:
            b = middle
    return (a + b) / 2


@strict
def apart(c, d, one, other, p):
    """How far branch `one` of c lies above branch `other` of d; inf where either is missing."""
    q, r = crossings(c, p)[one], crossings(d, p)[other]
    return q - r if abs(q) < np.inf and abs(r) < np.inf else np.inf
