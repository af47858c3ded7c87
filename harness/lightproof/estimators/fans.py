"""Directions to a flat polygon, uniform in its solid angle: a fan of spherical triangles from one corner.

Arvo 1995, "Stratified sampling of spherical triangles": a great arc from the fan's corner sweeps over the polygon by equal
solid angles, and a point of it is drawn with density sin(distance). Solid angles by Van Oosterom and Strackee 1983, the
determinant from the height above the polygon's plane, the sum of cosines from the pair of corners that is the most opposite;
sines and cosines of angles from the moments of edges. One arctangent a triangle is the only inverse function, and no term
cancels, for small, far and grazing triangles, nor from next to one, as far as `outlines` knows where that is. Float64 throughout.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba.extending import overload

from lightproof.estimators.compiled import INLINED, inlined
from lightproof.estimators.outlines import Edge, Facet, about
from lightproof.estimators.shapes import COINCIDES
from lightproof.estimators.trigonometry import half_turn, series
from lightproof.estimators.vectors import TINY, along, cross, dot, norm, scaled, sub
from lightproof.geometry import Vec3

NEAREST = 1e-100  # of a metre: a receiver nearer to a corner is taken for this near


class Sector(NamedTuple):
    """A spherical triangle a b c by its solid angle, the unit vector to a, the moment of the line ab [m], the arc's sine over
    that moment's length [1/m] and the arc's cosine, and sine and cosine of the angle at b times its sides' moments [m2]."""

    angle: float
    apex: Vec3
    moment: Vec3
    spread: float
    cosine: float
    turn: tuple[float, float]


class Pair(NamedTuple):
    """Unit vectors to two corners, the corners' inverse distances [1/m], the edge through them, and 1 + the vectors' cosine."""

    p: Vec3
    q: Vec3
    inverses: tuple[float, float]
    edge: Edge
    chord: float


@inlined
def add(a, b):
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@inlined
def sector(a, b, c, ab, bc, ac, sine):
    """The spherical triangle of corners a, b, c, as seen from the origin, which lie on the lines of the edges ab, bc, ac; `sine`
    is that of the angle between ab and bc, times the origin's height over their plane [m]."""
    la, lb, lc = max(norm(a), NEAREST), max(norm(b), NEAREST), max(norm(c), NEAREST)
    ia, ib, ic = 1 / la, 1 / lb, 1 / lc
    apex, start, end = scaled(ia, a), scaled(ib, b), scaled(ic, c)
    first, second, third = pair(apex, start, ia, ib, ab), pair(start, end, ib, ic, bc), pair(apex, end, ia, ic, ac)
    widest, other = (first, end) if first.chord < second.chord else (second, apex)
    widest, other = (widest, other) if widest.chord < third.chord else (third, start)
    both = added(widest)
    volume = sine * (ab.length * ia) * (bc.length * ib) * ic
    angle = 2 * half_turn(volume, dot(both, both) / 2 + dot(both, other))
    turn = sine * lb, -dot(ab.moment, bc.moment)
    return Sector(angle, apex, ab.moment, ab.length * ia * ib, dot(apex, start), turn)


@inlined
def pair(p, q, ip, iq, edge):
    return Pair(p, q, (ip, iq), edge, 1 + dot(p, q))


@inlined
def added(one):
    """Sum of the unit vectors of a pair: where they are almost opposite, by the foot f of the origin on the line through the
    corners, and 1 - |a - f|/|a| = f^2/(|a| (|a| + |a - f|))."""
    direction, (ip, iq) = one.edge.direction, one.inverses
    foot = cross(direction, one.edge.moment)
    on_p, on_q = dot(one.p, direction), dot(one.q, direction)
    before, after = 1 + abs(on_p), 1 + abs(on_q)
    rest = dot(foot, foot) * (ip * ip * after - iq * iq * before) / (before * after)
    opposite = along(scaled(ip + iq, foot), rest if on_q > 0 else -rest, direction)
    return opposite if one.chord < 1 else add(one.p, one.q)


@inlined
def within(one, angle, t):
    """A direction in the sector: on the arc from a that has swept `angle`, by t uniform in [0, 1]. By Girard's sum of angles,
    cos(area - at_a - at_b) = cos(at_a) cos(at_b) - sin(at_a) sin(at_b) cos(ab) has one unknown, the angle at a; by the four
    parts formula the arc goes on to bc for cot(arc) sin(ab) = cos(ab) cos(at_a) + sin(at_a) cot(at_b)."""
    sine, cosine = series(angle / 4)
    sine, cosine = 2 * sine * cosine, 1 - 2 * sine * sine
    (s, c), run, moment = one.turn, one.cosine, norm(one.moment)
    rise = moment * one.spread
    y = sine * (s * cosine - c * sine)
    x = s * (rise * rise / (2 + 2 * run) if run > 0 else (1 - run) / 2) - sine * (c * cosine + s * sine)
    size = math.sqrt(x * x + y * y)
    high, wide = rise * s * size, run * x * s + y * c
    length = math.sqrt(high * high + wide * wide)
    top, whole = (high * high, length * (length + wide)) if wide > 0 else (length - wide, length)
    per = 1 / max(size * moment, TINY)
    tangent = along(scaled(x * per, cross(one.moment, one.apex)), y * per, one.moment)
    return on_arc(one.apex, tangent, top / max(whole, TINY), t)


@inlined
def on_arc(a, tangent, most, t):
    """A point of the great arc from a along a tangent, with a distribution function (1 - cos)/`most`."""
    down = t * most
    return along(scaled(1 - down, a), math.sqrt(down * max(2 - down, 0.0)), tangent)


def towards(shape, x, s, t):
    """For a direction from x into an outline, drawn with s, t uniform in [0, 1]: 1/density per solid angle (0 where x sees none
    of its front), the direction, and the distance along it."""


@overload(towards, jit_options=INLINED)
def _towards(shape, x, s, t):
    return towards_facet if shape.instance_class is Facet else None


def towards_facet(shape, x, s, t):
    """Two triangles on both sides of the diagonal ac, of which one may be empty."""
    height = shape.level + dot(x, shape.normal)
    a, b, c, d = sub(shape.corners[0], x), sub(shape.corners[1], x), sub(shape.corners[2], x), sub(shape.corners[3], x)
    edges = shape.edges
    ab, bc, cd, da, ac = about(edges[0], x), about(edges[1], x), about(edges[2], x), about(edges[3], x), about(edges[4], x)
    above = max(height, 0.0)
    first = sector(a, b, c, ab, bc, ac, above * shape.sines[0])
    second = sector(a, c, d, ac, cd, da, above * shape.sines[1])
    total = first.angle + second.angle
    angle = s * total
    early = angle < first.angle
    w = within(first if early else second, angle if early else angle - first.angle, t)
    longest = max(norm(a), norm(b), norm(c), norm(d))
    return total if height > COINCIDES * longest else 0.0, w, reach(w, shape.normal, above, longest)


@inlined
def reach(w, normal, height, longest):
    """Distance along w to the plane `height` below, at most `longest`: rounding can leave w along the plane."""
    return min(height / max(-dot(w, normal), TINY), longest)
