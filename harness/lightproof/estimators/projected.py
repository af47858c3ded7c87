"""Lights as directions uniform in their projected solid angle find them: every sample of what nothing hides counts the same.

Polygons: see `azimuths`. Spheres: the rim of a sphere's cone is a circle in space; where none of it lies below the horizon, its
projection onto the receiver's plane bounds all that the cone projects to, an ellipse of area pi sin(a)^2 cos(theta). A point
uniform in the circle gives a point uniform in that ellipse, and this, lifted onto the hemisphere, the direction (Nusselt's
analogue). Disks, a sphere that the horizon cuts, and a polygon so small, so thin or so low over the horizon that its area is
lost in the rounding of the angles that it is made of, are drawn from by solid angle.
"""

from __future__ import annotations

import math

from numba.extending import overload

from lightproof.estimators.aims import Aim, beheld, counted
from lightproof.estimators.azimuths import inside, sectors, summed
from lightproof.estimators.compiled import INLINED, inlined, strict
from lightproof.estimators.cones import entry, over_sphere, towards
from lightproof.estimators.fans import reach
from lightproof.estimators.outlines import Facet, Rim, about, outlined
from lightproof.estimators.rng import TICK
from lightproof.estimators.shapes import COINCIDES, Sphere
from lightproof.estimators.trigonometry import turn
from lightproof.estimators.vectors import TINY, along, dot, norm, scaled, sub

SURE = 1e-7  # of what its rounding is relative to: a smaller projected solid angle is not sure of nine digits


class Projected(Aim):
    """An aim at a light's projected solid angle, all samples of which count the same: `alike`, as `kernel` asks."""

    __slots__ = ()
    alike = True


@overload(beheld)
def _beheld(lamp, origin, frame):
    if lamp.instance_class is Projected:
        return lambda lamp, origin, frame: outlined(lamp.shape, lamp.corners, origin, frame)


@overload(counted, jit_options=INLINED)
def _counted(lamp, x, s, t):
    return counted_projected if lamp.instance_class is Projected else None


def counted_projected(lamp, x, s, t):
    return irradiated(lamp.shape, x, s * TICK + 0.5, t * TICK + 0.5)


def irradiated(shape, x, s, t):
    """cos(theta)/density per solid angle of a direction into an outline, and the vector to the point there, from s, t in
    [0, 1]."""


@overload(irradiated, jit_options=INLINED)
def _irradiated(shape, x, s, t):
    return {Sphere: by_rim, Rim: by_solid_angle.py_func, Facet: by_azimuth}[shape.instance_class]


@strict
def by_solid_angle(shape, x, s, t):
    per_density, w, distance = towards(shape, x, s, t)
    return per_density * max(w[2], 0.0), scaled(distance, w)


def by_rim(shape, x, s, t):
    to = sub(shape.center, x)
    cone = over_sphere(to, shape.radius)
    if not cone.axis[2] >= cone.sines[0]:
        return by_solid_angle(shape, x, s, t)
    f, w = on_rim(cone, s, t)
    return f if norm(to) > shape.radius else 0.0, scaled(entry(to, w, shape.radius), w)


@inlined
def on_rim(cone, s, t):
    """The cone's projected solid angle, and the direction over a point uniform in the circle of its rim."""
    sine, cosine = turn((t - 0.5) / TICK)
    radius = math.sqrt(s) * cone.sines[0]
    p = along(along(scaled(cone.cosines[0], cone.axis), radius * cosine, cone.e1), radius * sine, cone.e2)
    height = math.sqrt(max(1 - p[0] * p[0] - p[1] * p[1], 0.0))
    return math.pi * cone.sines[0] * cone.sines[0] * cone.axis[2], (p[0], p[1], height)


def by_azimuth(shape, x, s, t):
    height = shape.level + dot(x, shape.normal)
    a, b, c, d = sub(shape.corners[0], x), sub(shape.corners[1], x), sub(shape.corners[2], x), sub(shape.corners[3], x)
    ab, bc, cd, da, _ = shape.edges
    parts = sectors(a, b, c, d, (plane(ab, x), plane(bc, x), plane(cd, x), plane(da, x)))
    total, gross = summed(parts)
    longest = max(norm(a), norm(b), norm(c), norm(d))
    if not (total > SURE * gross and height > COINCIDES * longest):
        return by_solid_angle(shape, x, s, t)
    w = inside(parts, s * total, t)
    return total, scaled(reach(w, shape.normal, height, longest), w)


@inlined
def plane(edge, x):
    """Normal of the plane through x and an edge; none for a point."""
    g = about(edge, x).moment
    return scaled(1 / max(norm(g), TINY), g)
