"""Lights as points of them and directions of the hemisphere find them, half of the draws each: the protocol of `lamps`.

Veach and Guibas 1995, "Optimally combining sampling techniques for Monte Carlo rendering": the balance heuristic with one
sample. A point found either way counts L cos(theta)/((p_area + p_cosine)/2), both densities per solid angle. With F, what
the point would count if area alone had found it, that is 2 F/(1 + F/(pi L)): never above 2 pi L, however near the light.
"""

from __future__ import annotations

import math

import numpy as np
from numba.extending import overload

from lightproof.estimators import shapes
from lightproof.estimators.aims import Aim, beheld, counted
from lightproof.estimators.compiled import INLINED
from lightproof.estimators.lamps import Facing, arriving, level_from, parameters
from lightproof.estimators.meeting import Ball, around, light_placed, meet
from lightproof.estimators.rng import TICK
from lightproof.estimators.shapes import COINCIDES
from lightproof.estimators.vectors import TINY, along, cross, dot, norm, sub


class Mixed(Aim):
    """An aim at a light by its area and by the receiver's cosine."""

    __slots__ = ()


@overload(beheld)
def _beheld(lamp, origin, frame):
    return as_met if lamp.instance_class is Mixed else None


def as_met(lamp, origin, frame):
    return light_placed(lamp.shape, origin, frame, 1.0)


@overload(counted, jit_options=INLINED)
def _counted(lamp, x, s, t):
    return counted_mixed if lamp.instance_class is Mixed else None


def counted_mixed(lamp, x, s, t):
    """The half of the draws that s belongs to decides; within it s runs over the whole again."""
    first = s < 0
    again = 2 * s + (0.5 if first else -0.5) / TICK
    down = again * TICK + 0.5
    w = around(math.sqrt(max(1 - down, 0.0)), down, t)
    f_area, d_area = by_area(lamp.shape, x, again, t)
    f_cosine, d_cosine = by_cosine(lamp.shape, x, w)
    f = f_area if first else f_cosine
    return 2 * f / (1 + f / math.pi), d_area if first else d_cosine


def by_area(seen, x, s, t):
    """F of a point drawn over the light, see the module, and the vector to it."""


@overload(by_area, jit_options=INLINED)
def _by_area(seen, x, s, t):
    return ball_by_area if seen.instance_class is Ball else flat_by_area


def by_cosine(seen, x, w):
    """F of the point that the direction w meets, 0 where it meets none, and the vector to it."""


@overload(by_cosine, jit_options=INLINED)
def _by_cosine(seen, x, w):
    return ball_by_cosine if seen.instance_class is Ball else flat_by_cosine


def flat_by_area(seen, x, s, t):
    shape = seen.shape
    a, b = parameters(shape, s, t)
    d = sub(along(along(shape.center, a, shape.u), b, shape.v), x)
    return of_flat(shape, seen.level + dot(x, shape.normal), d), d


def flat_by_cosine(seen, x, w):
    met, d = meet(seen, x, w)
    return met * of_flat(seen.shape, seen.level + dot(x, seen.shape.normal), d), d


def of_flat(shape, height, d):
    """cos(theta_x) cos(theta_y) A / r^2 of the point x + d of the flat shape, x being so high over its plane."""


@overload(of_flat, jit_options=INLINED)
def _of_flat(shape, height, d):
    per_parameter = shapes.PER_PARAMETER[shape.instance_class]

    def evaluate(shape, height, d):
        r = norm(d)
        area = per_parameter * norm(cross(shape.u, shape.v))
        farthest = r + norm(shape.u) + norm(shape.v)
        return max(d[2], 0.0) / r * (height / r) * (area / (r * r)) if height > COINCIDES * farthest else 0.0

    return evaluate


def ball_by_area(seen, x, s, t):
    return arriving(Facing(seen.shape, 1.0, seen.level), x, s, t)


def ball_by_cosine(seen, x, w):
    """By area the cap that faces x is drawn from."""
    met, d = meet(seen, x, w)
    radius, away = seen.shape.radius, sub(x, seen.shape.center)
    r = norm(away)
    gap = max(level_from(seen, x), 0.0) / (r + radius)
    inward = -dot(w, along(away, 1.0, d)) / radius
    return met * (2 * np.pi * radius * radius * gap / r) * w[2] * max(inward, 0.0) / max(dot(d, d), TINY), d
