"""Sine, cosine and arctangent as polynomials: unlike those of math these run in vector registers."""

from __future__ import annotations

import math

import numpy as np
from numba.extending import overload

from lightproof.estimators.compiled import fast, inlined
from lightproof.estimators.rng import TICK
from lightproof.estimators.vectors import TINY, like

EIGHTH = math.tan(math.pi / 8)
ARCTANGENT = tuple((-1) ** k / (2 * k + 1) for k in reversed(range(21)))  # to the last digit up to EIGHTH
TERMS = {4: 6, 8: 12}  # bytes of a float -> terms of the Taylor series that reach its last digit up to pi/2


@fast
def turn(t):
    """sin and cos of 2 pi TICK t, by Taylor series of the half angle."""
    half = t * like(t, np.pi * TICK)
    sine, cosine = series(half)
    return like(t, 2) * sine * cosine, like(t, 1) - like(t, 2) * sine * sine


@inlined
def half_turn(y, x):
    """The angle of the point x, y in float64, y at least 0: from 0 to pi, to the last digits of itself."""
    width = abs(x)
    ratio = min(width, y) / max(width, y, TINY)
    steep = ratio > EIGHTH
    rest = (ratio - 1) / (ratio + 1) if steep else ratio
    angle = rest * horner(ARCTANGENT, rest * rest) + (math.pi / 4 if steep else 0.0)
    angle = math.pi / 2 - angle if y > width else angle
    return math.pi - angle if x < 0 else angle


def series(angle):
    """sin and cos of an angle within a quarter turn, to the last digit of its type."""


@overload(series)
def _series(angle):
    terms = TERMS[angle.bitwidth // 8]
    sine = tuple((-1) ** k / math.factorial(2 * k + 1) for k in reversed(range(terms)))
    cosine = tuple((-1) ** k / math.factorial(2 * k) for k in reversed(range(terms + 1)))

    def evaluate(angle):
        square = angle * angle
        return angle * horner(sine, square), horner(cosine, square)

    return evaluate


def horner(coefficients, x):
    """The polynomial with `coefficients`, highest first, at x."""


@overload(horner)
def _horner(coefficients, x):
    if len(coefficients) == 1:
        return lambda coefficients, x: like(x, coefficients[0])
    return lambda coefficients, x: like(x, coefficients[-1]) + x * horner(coefficients[:-1], x)
