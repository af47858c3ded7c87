"""Lights as directions are drawn into what they subtend, by `towards` in `fans` and `cones`: the protocol of `lamps`.

Whatever the precision of the kernel, the way from two draws to a direction is float64: that is where digits are lost.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators import shapes
from lightproof.estimators.cones import towards
from lightproof.estimators.lamps import arriving, faced
from lightproof.estimators.rng import TICK
from lightproof.estimators.shapes import Flat, Sphere, placed
from lightproof.estimators.vectors import dot, like, sub


class Subtended(NamedTuple):
    """A shape that emits `strength` [W/(m2 sr)] from its front, met by directions uniform in its solid angle; `level` [m] is
    the height of the frame's origin over the plane of a flat one, taken before axes are turned."""

    shape: Flat | Sphere
    strength: float
    level: float = 0.0

    @property
    def power(self) -> float:
        """What its share of samples goes by [W/sr]."""
        return self.strength * shapes.area(self.shape)


@overload(faced)
def _faced(lamp, origin, frame, model):
    return face if lamp.instance_class is Subtended else None


def face(lamp, origin, frame, model):
    return Subtended(placed(lamp.shape, origin, frame, 1.0), like(model, lamp.strength), over(lamp.shape, origin))


def over(shape, point):
    """Height of a point over the plane of a flat shape [m]."""


@overload(over)
def _over(shape, point):
    if shape.instance_class is Sphere:
        return lambda shape, point: 0.0
    return lambda shape, point: dot(sub(point, shape.center), shape.normal)


@overload(arriving, jit_options={"forceinline": True})
def _arriving(lamp, x, s, t):
    return arriving_subtended if lamp.instance_class is Subtended else None


def arriving_subtended(lamp, x, s, t):
    at = np.float64(x[0]), np.float64(x[1]), np.float64(x[2])
    per_density, w, distance = towards(lamp.shape, lamp.level, at, np.float64(s) * TICK + 0.5, np.float64(t) * TICK + 0.5)
    d = like(s, distance * w[0]), like(s, distance * w[1]), like(s, distance * w[2])
    return like(s, per_density * max(w[2], 0.0)), d
