"""Lights with an area as directions find them: what the domains that aim at a light share, by the protocol of `lamps`.

Whatever the precision of the kernel, the way from two draws to a direction is float64: that is where digits are lost.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators import shapes
from lightproof.estimators.lamps import arriving, faced
from lightproof.estimators.shapes import Flat, Sphere, placed
from lightproof.estimators.vectors import dot, like, sub

INLINED = {"forceinline": True}


class Aim(NamedTuple):
    """A shape that emits `strength` [W/(m2 sr)] from its front; `level` [m] is the height of the frame's origin over the plane
    of a flat one, taken before axes are turned. Each domain is a subclass."""

    shape: Flat | Sphere
    strength: float
    level: float = 0.0

    @property
    def power(self) -> float:
        """What its share of samples goes by [W/sr]."""
        return self.strength * shapes.area(self.shape)


@overload(faced)
def _faced(lamp, origin, frame, model):
    kind = lamp.instance_class
    if not issubclass(kind, Aim):
        return None

    def face(lamp, origin, frame, model):
        return kind(placed(lamp.shape, origin, frame, 1.0), like(model, lamp.strength), over(lamp.shape, origin))

    return face


def over(shape, point):
    """Height of a point over the plane of a flat shape [m]."""


@overload(over)
def _over(shape, point):
    if shape.instance_class is Sphere:
        return lambda shape, point: 0.0
    return lambda shape, point: dot(sub(point, shape.center), shape.normal)


@overload(arriving, jit_options=INLINED)
def _arriving(lamp, x, s, t):
    return arriving_aimed if issubclass(lamp.instance_class, Aim) else None


def arriving_aimed(lamp, x, s, t):
    f, d = counted(lamp, (np.float64(x[0]), np.float64(x[1]), np.float64(x[2])), np.float64(s), np.float64(t))
    return like(s, f), (like(s, d[0]), like(s, d[1]), like(s, d[2]))


def counted(lamp, x, s, t):
    """What `arriving` gives, in float64: each domain's own."""
