"""Directions to a flat polygon, uniform in its solid angle: a fan of spherical triangles from one corner.

Arvo 1995, "Stratified sampling of spherical triangles", in the form of Peters 2021, "BRDF importance sampling for polygonal
lights", which needs no inverse function but one arctangent per triangle: a great arc from the fan's corner sweeps over the
polygon by equal solid angles, and a point of it is drawn with density sin(distance). Solid angles by Van Oosterom and
Strackee 1983, the determinant from the height above the polygon's plane. No term cancels for small, far or grazing
triangles; everything is float64, for a receiver almost in the polygon's plane sees the corners almost opposite one another.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba.extending import overload

from lightproof.estimators.compiled import inlined
from lightproof.estimators.shapes import COINCIDES, Parallelogram, Triangle
from lightproof.estimators.trigonometry import half_turn, series
from lightproof.estimators.vectors import along, cross, dot, norm, scaled, sub
from lightproof.geometry import Vec3

TINY = 1e-280  # keeps a quotient from 0/0
NEAREST = 1e-100  # of a metre: a receiver nearer to a corner is taken for this near


class Sector(NamedTuple):
    """A spherical triangle: unit vectors to its corners, its solid angle, and its corners' determinant."""

    apex: Vec3
    start: Vec3
    end: Vec3
    angle: float
    volume: float


@inlined
def add(a, b):
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@inlined
def sector(a, b, c, sixfold):
    """The spherical triangle of corners a, b, c, as seen from the origin; `sixfold` is their tetrahedron's volume times six."""
    la, lb, lc = max(norm(a), NEAREST), max(norm(b), NEAREST), max(norm(c), NEAREST)
    apex, start, end = scaled(1 / la, a), scaled(1 / lb, b), scaled(1 / lc, c)
    volume = sixfold / (la * lb * lc)
    middle = add(apex, start)
    return Sector(apex, start, end, 2 * half_turn(volume, dot(middle, middle) / 2 + dot(middle, end)), volume)


@inlined
def within(one, angle, t):
    """A direction in the sector: on the arc that has swept `angle`, by t uniform in [0, 1]."""
    sine, cosine = series(angle / 4)
    sine, cosine = 2 * sine * cosine, 1 - 2 * sine * sine
    middle = add(one.apex, one.start)
    own = one.volume * cosine - dot(middle, one.end) * sine
    half = along(scaled(own, one.start), dot(middle, middle) / 2 * sine, one.end)
    swept = sub(scaled(2 * dot(one.start, half) / max(dot(half, half), TINY), half), one.start)
    return on_arc(one.apex, swept, t)


@inlined
def on_arc(a, b, t):
    """A point of the great arc from a to b with distribution function (1 - cos)/(1 - cos of all); a and b may be as good as
    the same, or as opposite."""
    both = add(a, b)
    square = dot(both, both)
    beside = math.sqrt(t * (4 * (1 - t) + t * square) / max(square, TINY))
    return along(scaled(1 - 2 * t + square / 2 * (t - beside), a), beside, both)


def towards(shape, level, x, s, t):
    """For a direction from x into a shape, drawn with s, t uniform in [0, 1]: 1/density per solid angle (0 where x sees none
    of its front), the direction, and the distance along it; `level` is the origin's height over the plane of a flat shape."""


@overload(towards, jit_options={"forceinline": True})
def _towards(shape, level, x, s, t):
    return {Triangle: towards_triangle, Parallelogram: towards_parallelogram}.get(shape.instance_class)


def towards_triangle(shape, level, x, s, t):
    height = level + dot(x, shape.normal)
    a = sub(shape.center, x)
    b, c = add(a, shape.u), add(a, shape.v)
    one = sector(a, b, c, max(height, 0.0) * norm(cross(shape.u, shape.v)))
    w = within(one, s * one.angle, t)
    longest = max(norm(a), norm(b), norm(c))
    return one.angle if height > COINCIDES * longest else 0.0, w, reach(w, shape.normal, height, longest)


def towards_parallelogram(shape, level, x, s, t):
    """Two triangles on both sides of the diagonal from the fan's corner."""
    height = level + dot(x, shape.normal)
    a = along(along(sub(shape.center, x), -0.5, shape.u), -0.5, shape.v)
    b, d = add(a, shape.u), add(a, shape.v)
    c = add(b, shape.v)
    sixfold = max(height, 0.0) * norm(cross(shape.u, shape.v))
    first, second = sector(a, b, c, sixfold), sector(a, c, d, sixfold)
    total = first.angle + second.angle
    angle = s * total
    early = angle < first.angle
    w = within(first if early else second, angle if early else angle - first.angle, t)
    longest = max(norm(a), norm(b), norm(c), norm(d))
    return total if height > COINCIDES * longest else 0.0, w, reach(w, shape.normal, height, longest)


@inlined
def reach(w, normal, height, longest):
    """Distance along w to the plane `height` below, at most `longest`: rounding can leave w along the plane."""
    return min(height / max(-dot(w, normal), TINY), longest)
