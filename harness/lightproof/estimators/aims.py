"""Lights with an area as directions find them: what the domains that aim at a light share, by the protocol of `lamps`.

Whatever the precision of the kernel, the way from two draws to a direction is float64: that is where digits are lost.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators import shapes
from lightproof.estimators.compiled import INLINED
from lightproof.estimators.lamps import Glow, arriving, faced
from lightproof.estimators.meeting import Ball
from lightproof.estimators.outlines import Facet, Rim, clockwise
from lightproof.estimators.shapes import Flat, Sphere
from lightproof.estimators.vectors import like
from lightproof.estimators.windows import Window
from lightproof.geometry import Vec3


class Aim(NamedTuple):
    """A shape that emits `strength` [W/(m2 sr)] from its front, with the corners of a polygon as the scene has them; where an
    element sees it, `shape` is what the domain has for it. Each domain is a subclass."""

    shape: Flat | Sphere | Facet | Rim | Window | Ball
    strength: float
    corners: tuple[Vec3, ...] = ()

    @classmethod
    def of(cls, glow: Glow) -> Aim:
        """At a piece of a light."""
        return cls(glow.shape, glow.radiance, () if glow.corners is None else clockwise(glow.corners))

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
        return kind(beheld(lamp, origin, frame), like(model, lamp.strength), ())

    return face


def beheld(lamp, origin, frame):
    """The shape as seen from `origin` along the axes of `frame`, in float64: each domain's own."""


@overload(arriving, jit_options=INLINED)
def _arriving(lamp, x, s, t):
    return arriving_aimed if issubclass(lamp.instance_class, Aim) else None


def arriving_aimed(lamp, x, s, t):
    f, d = counted(lamp, (np.float64(x[0]), np.float64(x[1]), np.float64(x[2])), np.float64(s), np.float64(t))
    return like(s, f), (like(s, d[0]), like(s, d[1]), like(s, d[2]))


def counted(lamp, x, s, t):
    """What `arriving` gives, in float64: each domain's own."""
