"""Spheres as directions uniform in projected solid angle find them: the protocol of `lamps`.

The rim of a sphere's cone is a circle in space; where none of it lies below the horizon, its projection onto the receiver's
plane bounds all that the cone projects to, an ellipse of area pi sin(a)^2 cos(theta). A point uniform in the circle gives a
point uniform in that ellipse, and this, lifted onto the hemisphere, the direction (Nusselt's analogue). Every sample then
counts the same. A sphere that the horizon cuts is drawn from by solid angle.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators import shapes
from lightproof.estimators.compiled import inlined
from lightproof.estimators.cones import entry, inside, over_sphere
from lightproof.estimators.lamps import arriving, faced
from lightproof.estimators.rng import TICK
from lightproof.estimators.shapes import Sphere, placed
from lightproof.estimators.trigonometry import turn
from lightproof.estimators.vectors import along, like, norm, scaled, sub


class Projected(NamedTuple):
    """A sphere that emits `strength` [W/(m2 sr)]; all geometry is float64, as in `subtended`."""

    shape: Sphere
    strength: float

    @property
    def power(self) -> float:
        """What its share of samples goes by [W/sr]."""
        return self.strength * shapes.area(self.shape)


@overload(faced)
def _faced(lamp, origin, frame, model):
    return face if lamp.instance_class is Projected else None


def face(lamp, origin, frame, model):
    return Projected(placed(lamp.shape, origin, frame, 1.0), like(model, lamp.strength))


@overload(arriving, jit_options={"forceinline": True})
def _arriving(lamp, x, s, t):
    return arriving_projected if lamp.instance_class is Projected else None


def arriving_projected(lamp, x, s, t):
    to = sub(lamp.shape.center, (np.float64(x[0]), np.float64(x[1]), np.float64(x[2])))
    f, w = irradiated(over_sphere(to, lamp.shape.radius), np.float64(s) * TICK + 0.5, np.float64(t) * TICK + 0.5)
    d = scaled(entry(to, w, lamp.shape.radius), w)
    return like(s, f if norm(to) > lamp.shape.radius else 0.0), (like(s, d[0]), like(s, d[1]), like(s, d[2]))


@inlined
def irradiated(cone, s, t):
    """cos(theta)/density per solid angle of a direction in a circular cone, and the direction, from s, t in [0, 1]."""
    whole, raised = on_rim(cone, s, t)
    per_density, free = inside(cone, s, t)
    above = cone.axis[2] >= cone.sines[0]
    w = raised if above else free
    return whole if above else per_density * max(free[2], 0.0), w


@inlined
def on_rim(cone, s, t):
    """The cone's projected solid angle, and the direction over a point uniform in the circle of its rim."""
    sine, cosine = turn((t - 0.5) / TICK)
    radius = math.sqrt(s) * cone.sines[0]
    p = along(along(scaled(cone.cosines[0], cone.axis), radius * cosine, cone.e1), radius * sine, cone.e2)
    height = math.sqrt(max(1 - p[0] * p[0] - p[1] * p[1], 0.0))
    return math.pi * cone.sines[0] * cone.sines[0] * cone.axis[2], (p[0], p[1], height)
