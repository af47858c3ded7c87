"""Direct light on an element by boxes, each with a proven bound of its error; the worst is halved, again and again.

A box that no light leaves, or that a blocker hides wholly, counts nothing and has no error. One that is wholly lit and seen is
summed by Gauss's rule, see `ellipses`. Of any other it is only known how much it can hold at most; what its middle holds counts.
"""

from __future__ import annotations

import math

import numpy as np

from lightproof.estimators import gauss, shafts
from lightproof.estimators.boxes import CENTER, FLAW, NORMAL, RADIANCE, SLIP, density, hull, part, reaches, spot
from lightproof.estimators.compiled import strict
from lightproof.estimators.ellipses import ORDERS, errors
from lightproof.estimators.shafts import HIDDEN, SEEN
from lightproof.estimators.shapes import COINCIDES
from lightproof.estimators.vectors import TINY, dot, norm, scaled, sub

HIGHEST = ORDERS.max()
NODES, WEIGHTS = gauss.table(HIGHEST)
DARK, UNDECIDED, SMOOTH = 0, 1, 2  # or above: SMOOTH + the number of the rule
FINEST = SMOOTH + len(ORDERS) - 1


@strict
def appraise(box, lights, blockers, starts, cell, room, coarsest):
    """What a box is, the bound of its error or what it can hold at most [W/m2], and the coordinate to halve: SMOOTH by the first
    rule from `coarsest` on whose error is less than what there is. `room` (4, 4, 3) is scratch."""
    number = int(box[8])
    light, xs, ys = lights[number], room[0], room[1]
    hull(box, light, cell, xs, ys)
    low_a, high_a, low_b, high_b = cosines(light, xs, ys)
    slack = COINCIDES * extent(xs, ys)
    if high_a <= slack or high_b <= slack:
        return DARK, 0.0, 0
    sight = sighted(blockers, starts[number], starts[number + 1], xs, ys, room)
    if sight == HIDDEN:
        return DARK, 0.0, 0
    halves, near = reaches(box, light, cell), nearest(xs, ys, low_a, low_b)
    share, patch = light[RADIANCE] * (box[1] - box[0]) * (box[3] - box[2]), (box[5] - box[4]) * (box[7] - box[6])
    most = share * min(patch * density(light, box[5]) * high_a * high_b / near**4, math.pi)
    if sight == SEEN and low_a > 0 and low_b > 0:
        for kind in range(coarsest, FINEST + 1):
            parts = errors(box, light, halves, near, (high_a, high_b), ORDERS[kind - SMOOTH])
            error = share * patch * (parts[0] + parts[1] + parts[2] + parts[3])
            if error < most:
                return kind, error, largest(parts)
    return UNDECIDED, most, largest(halves)


@strict
def largest(values):
    """The number of the largest of four values."""
    a, b, c, d = values
    most = max(max(a, b), max(c, d))
    return 0 if a == most else (1 if b == most else (2 if c == most else 3))


@strict
def cosines(light, xs, ys):
    """Least and largest A = d . n of the receiver, and B = -d . n of the light [m]."""
    center, normal = part(light, CENTER), part(light, NORMAL)
    low_a, high_a, low_b, high_b = np.inf, -np.inf, np.inf, -np.inf
    for k in range(4):
        b = dot(sub(part(xs[k], 0), center), normal)
        low_a, high_a = min(low_a, ys[k, 2]), max(high_a, ys[k, 2])
        low_b, high_b = min(low_b, b), max(high_b, b)
    return low_a, high_a, low_b, high_b


@strict
def extent(xs, ys):
    """About the largest distance between two of the points [m]."""
    return norm(sub(part(ys[0], 0), part(xs[3], 0))) + norm(sub(part(ys[3], 0), part(xs[0], 0)))


@strict
def nearest(xs, ys, low_a, low_b):
    """Less than every distance between two points of a box [m]: along the line through the middles, or over a plane."""
    axis = sub(shafts.middle(ys), shafts.middle(xs))
    axis = scaled(1 / max(norm(axis), TINY), axis)
    far, close = -np.inf, np.inf
    for k in range(4):
        far, close = max(far, dot(part(xs[k], 0), axis)), min(close, dot(part(ys[k], 0), axis))
    return max(max(close - far, 0.0), max(low_a, low_b))


@strict
def sighted(blockers, first, last, xs, ys, room):
    """SEEN, MIXED or HIDDEN by the blockers of a light."""
    found = SEEN
    for k in range(first, last):
        one = shafts.between(blockers[k], xs, ys, room[2:4])
        if one == HIDDEN:
            return HIDDEN
        found = max(found, one)
    return found


@strict
def likely(box, lights, blockers, starts, cell, room):
    """What an undecided box holds if all of it is as its middle [W/m2]."""
    number = int(box[8])
    light, s = lights[number], (box[4] + box[5]) / 2
    x, y = on_cell(cell, (box[0] + box[1]) / 2, (box[2] + box[3]) / 2), spot(light, s, (box[6] + box[7]) / 2)
    for k in range(4):
        room[0, k, 0], room[0, k, 1], room[0, k, 2] = x
        room[1, k, 0], room[1, k, 1], room[1, k, 2] = y
    sight = sighted(blockers, starts[number], starts[number + 1], room[0], room[1], room)
    d, volume = sub(y, x), (box[1] - box[0]) * (box[3] - box[2]) * (box[5] - box[4]) * (box[7] - box[6])
    cosines = max(d[2], 0.0) * max(dot(sub(x, part(light, CENTER)), part(light, NORMAL)), 0.0)
    whole = light[RADIANCE] * volume * density(light, s) * cosines / max(dot(d, d) * dot(d, d), TINY)
    return whole * (1.0 if sight == SEEN else 0.0 if sight == HIDDEN else 0.5)


@strict
def on_cell(cell, p, q):
    return cell[0] * p + cell[1] * q, cell[2] * q, 0.0


@strict
def cost(kind, cell):
    """Points that a box takes."""
    if kind < SMOOTH:
        return 1
    a, b, c, d = nodes(kind, cell)
    return a * b * c * d


@strict
def nodes(kind, cell):
    """Orders of a smooth box's rule along p, q, s and t; a point needs none along p and q."""
    orders = ORDERS[kind - SMOOTH]
    return orders[0] if cell[0] != 0 else 1, orders[1] if cell[2] != 0 else 1, orders[2], orders[3]


@strict
def summed(box, kind, light, cell):
    """Gauss's rule over a box [W/m2], and what rounding may change of it."""
    a, b, c, d = nodes(kind, cell)
    value, loss = 0.0, 0.0
    for i in range(a):
        p, weight_p = node(box, 0, a, i)
        for j in range(b):
            q, weight_q = node(box, 2, b, j)
            one, lost = over_light(box, light, on_cell(cell, p, q), c, d)
            value += weight_p * weight_q * one
            loss += weight_p * weight_q * lost
    return light[RADIANCE] * value, light[RADIANCE] * loss


@strict
def over_light(box, light, x, orders_s, orders_t):
    """The same at a point of the element."""
    value, loss, height = 0.0, 0.0, dot(sub(x, part(light, CENTER)), part(light, NORMAL))
    for i in range(orders_s):
        s, weight_s = node(box, 4, orders_s, i)
        for j in range(orders_t):
            t, weight_t = node(box, 6, orders_t, j)
            d = sub(spot(light, s, t), x)
            square = dot(d, d)
            weight = weight_s * weight_t * density(light, s) / (square * square)
            value += weight * d[2] * height
            flaw, slip = light[FLAW], light[SLIP] / math.sqrt(square)
            loss += weight * (math.sqrt(square) * (flaw + slip) * (d[2] + height) + (flaw + 4 * slip) * d[2] * height)
    return value, loss


@strict
def node(box, at, order, i):
    """Node i of a rule between two sides of a box, and its weight."""
    length = box[at + 1] - box[at]
    return box[at] + NODES[order, i] * length, WEIGHTS[order, i] * length
