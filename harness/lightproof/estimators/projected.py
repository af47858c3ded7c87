"""Lights as directions uniform in their projected solid angle find them: every sample of what nothing hides counts the same.

Polygons: see `azimuths`. Spheres: the rim of a sphere's cone is a circle in space; where none of it lies below the horizon, its
projection onto the receiver's plane bounds all that the cone projects to, an ellipse of area pi sin(a)^2 cos(theta). A point
uniform in the circle gives a point uniform in that ellipse, and this, lifted onto the hemisphere, the direction (Nusselt's
analogue). Disks, a sphere that the horizon cuts, and a polygon so thin or so low over the horizon that its area is lost in
the terms that it is a difference of, are drawn from by solid angle.
"""

from __future__ import annotations

import math

from numba.extending import overload

from lightproof.estimators.aims import INLINED, Aim, counted
from lightproof.estimators.azimuths import corners, inside, sectors, summed
from lightproof.estimators.compiled import inlined, strict
from lightproof.estimators.cones import entry, over_sphere, towards
from lightproof.estimators.fans import add, reach
from lightproof.estimators.rng import TICK
from lightproof.estimators.shapes import COINCIDES, Disk, Parallelogram, Sphere, Triangle
from lightproof.estimators.trigonometry import turn
from lightproof.estimators.vectors import along, dot, norm, scaled, sub

SURE = 1e-6  # of its terms: a smaller projected solid angle is not sure of ten digits


class Projected(Aim):
    """An aim at a light's projected solid angle."""

    __slots__ = ()


@overload(counted, jit_options=INLINED)
def _counted(lamp, x, s, t):
    return counted_projected if lamp.instance_class is Projected else None


def counted_projected(lamp, x, s, t):
    return irradiated(lamp.shape, lamp.level, x, s * TICK + 0.5, t * TICK + 0.5)


def irradiated(shape, level, x, s, t):
    """cos(theta)/density per solid angle of a direction into a shape, and the vector to the point there, from s, t in [0, 1]."""


@overload(irradiated, jit_options=INLINED)
def _irradiated(shape, level, x, s, t):
    return {Sphere: by_rim, Disk: by_solid_angle.py_func, Triangle: by_azimuth, Parallelogram: by_azimuth}[shape.instance_class]


@strict
def by_solid_angle(shape, level, x, s, t):
    per_density, w, distance = towards(shape, level, x, s, t)
    return per_density * max(w[2], 0.0), scaled(distance, w)


def by_rim(shape, level, x, s, t):
    to = sub(shape.center, x)
    cone = over_sphere(to, shape.radius)
    if not cone.axis[2] >= cone.sines[0]:
        return by_solid_angle(shape, level, x, s, t)
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


def by_azimuth(shape, level, x, s, t):
    height = level + dot(x, shape.normal)
    a, b, c, d, parts = divided(shape, x)
    total, gross = summed(parts)
    longest = max(norm(a), norm(b), norm(c), norm(d))
    if not (total > SURE * gross and height > COINCIDES * longest):
        return by_solid_angle(shape, level, x, s, t)
    w = inside(parts, s * total, t)
    return total, scaled(reach(w, shape.normal, height, longest), w)


def divided(shape, x):
    """Corners of a polygon as seen from x, and its sectors."""


@overload(divided)
def _divided(shape, x):
    return {Triangle: divided_triangle, Parallelogram: divided_parallelogram}[shape.instance_class]


def divided_parallelogram(shape, x):
    a = along(along(sub(shape.center, x), -0.5, shape.u), -0.5, shape.v)
    b, d = add(a, shape.v), add(a, shape.u)
    c = add(b, shape.u)
    back_v, back_u = scaled(-1.0, shape.v), scaled(-1.0, shape.u)
    return a, b, c, d, sectors(corners(a, b, c, d, shape.v, shape.u, back_v, back_u))


def divided_triangle(shape, x):
    """With the middle of one edge for a fourth corner."""
    a = sub(shape.center, x)
    b, d = add(a, shape.v), add(a, shape.u)
    half = scaled(0.5, sub(shape.u, shape.v))
    c = add(b, half)
    return a, b, c, d, sectors(corners(a, b, c, d, shape.v, half, half, scaled(-1.0, shape.u)))
