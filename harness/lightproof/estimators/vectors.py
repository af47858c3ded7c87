"""Vectors as tuples of three numbers, for compiled code; every function keeps the precision of its arguments."""

from __future__ import annotations

import math

import numpy as np
from numba import types
from numba.extending import overload

from lightproof.estimators.compiled import strict

TINY = 1e-280  # keeps a quotient from 0/0


def like(model, number):
    """`number`, a constant, in the floating-point type of `model`: a bare literal would promote float32 to float64."""
    return type(model)(number)


@overload(like, inline="always")
def _like(model, number):
    real = np.float32 if model == types.float32 else np.float64
    return lambda model, number: real(number)


@strict
def product(a, b):
    """a b, which is not regrouped with factors of the two: 1/r^4 overflows float32 where neither 1/r^2 does."""
    return a * b


@strict
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@strict
def sub(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@strict
def scaled(a, v):
    return a * v[0], a * v[1], a * v[2]


@strict
def along(origin, a, v):
    """origin + a v."""
    return origin[0] + a * v[0], origin[1] + a * v[1], origin[2] + a * v[2]


@strict
def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@strict
def norm(v):
    return math.sqrt(dot(v, v))


@strict
def unit(v):
    return scaled(1 / norm(v), v)


@strict
def turned(v, frame, model):
    """Components of `v` along the three axes of `frame`, in the type of `model`."""
    return like(model, dot(v, frame[0])), like(model, dot(v, frame[1])), like(model, dot(v, frame[2]))


@strict
def tangents(n):
    """Unit vectors t, b with t x b = n, a unit vector (Duff et al. 2017, "Building an orthonormal basis, revisited")."""
    one = like(n[2], 1)
    sign = math.copysign(one, n[2])
    a = -one / (sign + n[2])
    b = n[0] * n[1] * a
    return (one + sign * n[0] * n[0] * a, sign * b, -sign * n[0]), (b, sign + n[1] * n[1] * a, -n[1])
