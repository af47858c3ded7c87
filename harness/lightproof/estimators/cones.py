"""Directions into the elliptic cone that a disk or a sphere subtends.

About the axis of a cone of half-angles a, b the half-angle is that of the azimuth of a point on the ellipse sin(a) cos(psi),
sin(b) sin(psi), psi uniform; between axis and rim the cosine is uniform. That density, (1 + cos(rim))/(2 pi sin(a) sin(b)) per
solid angle, is uniform for a circular cone, and within a factor of two of uniform for any: the exactly uniform ones of Guillen
et al. 2017, "Area-preserving parameterizations for spherical ellipses", take elliptic integrals. The cone over a disk has the
axes of its quadratic form; with roots of one sign each, nothing cancels for small, far or grazing disks. All of it float64.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba.extending import overload

from lightproof.estimators.compiled import INLINED, inlined
from lightproof.estimators.fans import reach, towards
from lightproof.estimators.outlines import Rim
from lightproof.estimators.rng import TICK
from lightproof.estimators.shapes import COINCIDES, Sphere
from lightproof.estimators.trigonometry import turn
from lightproof.estimators.vectors import along, cross, dot, norm, scaled, sub, tangents
from lightproof.geometry import Vec3

NEAREST = 1e-100  # of a metre: a receiver nearer to a disk's plane is taken for this near


class Cone(NamedTuple):
    """Unit vectors e1, e2, axis; sines and cosines of the half-angles towards e1 and e2."""

    e1: Vec3
    e2: Vec3
    axis: Vec3
    sines: tuple[float, float]
    cosines: tuple[float, float]


@inlined
def inside(cone, s, t):
    """1/density per solid angle and a direction, from s, t uniform in [0, 1]."""
    sine, cosine = turn((t - 0.5) / TICK)
    p, q = cone.sines[0] * cosine, cone.sines[1] * sine
    p_rim, q_rim = cone.cosines[0] * cosine, cone.cosines[1] * sine
    rim = math.sqrt(p_rim * p_rim + q_rim * q_rim)
    down = s * (p * p + q * q) / (1 + rim)
    aside = math.sqrt(s * (2 - down) / (1 + rim))
    w = along(along(scaled(1 - down, cone.axis), aside * p, cone.e1), aside * q, cone.e2)
    return 2 * math.pi * cone.sines[0] * cone.sines[1] / (1 + rim), w


@inlined
def over_sphere(center, radius):
    """The cone that a sphere subtends at the origin, which lies outside."""
    r = norm(center)
    axis = scaled(1 / r, center)
    e1, e2 = tangents(axis)
    sine, cosine = radius / r, math.sqrt((r - radius) * (r + radius)) / r
    return Cone(e1, e2, axis, (sine, sine), (cosine, cosine))


@inlined
def over_disk(normal, height, offset, radius, beyond, aside):
    """The cone that a disk subtends at the origin, `height` above its plane; its centre is `offset` from the origin's foot, in
    the direction of the unit vector `aside`; `beyond` is offset^2 - radius^2. From h^2 x^2 + (h y - offset z)^2 =
    radius^2 z^2."""
    trace = height * height + beyond
    root = math.sqrt(trace * trace + 4 * (height * radius) ** 2)
    large = (root + abs(trace)) / 2
    small = height * radius * (height * radius / large)
    up, down = (large, small) if trace > 0 else (small, large)
    wide, narrow = height * height + down, up + down
    size = math.sqrt((height * offset) ** 2 + wide * wide)
    y, z = height * offset / size, wide / size
    axis, e2 = along(scaled(y, aside), -z, normal), along(scaled(z, aside), y, normal)
    sines = math.sqrt(down / wide), math.sqrt(down / narrow)
    return Cone(cross(e2, axis), e2, axis, sines, (height / math.sqrt(wide), math.sqrt(up / narrow)))


@overload(towards, jit_options=INLINED)
def _towards(shape, x, s, t):
    return {Rim: towards_rim, Sphere: towards_sphere}.get(shape.instance_class)


def towards_rim(shape, x, s, t):
    """The centre's offset is taken along u where there is none."""
    height = shape.level + dot(x, shape.normal)
    above, radius = max(height, NEAREST), norm(shape.u)
    foot = along(sub(shape.center, x), height, shape.normal)
    offset = norm(foot)
    aside = along(foot, NEAREST, shape.u)
    flat = along(x, -dot(x, shape.normal), shape.normal)
    beyond = shape.beyond + dot(flat, flat) - 2 * dot(flat, shape.center)
    per_density, w = inside(over_disk(shape.normal, above, offset, radius, beyond, scaled(1 / norm(aside), aside)), s, t)
    longest = above + offset + radius
    return per_density if height > COINCIDES * longest else 0.0, w, reach(w, shape.normal, above, longest)


def towards_sphere(shape, x, s, t):
    to = sub(shape.center, x)
    outside = norm(to) > shape.radius
    per_density, w = inside(over_sphere(to, shape.radius), s, t)
    return per_density if outside else 0.0, w, entry(to, w, shape.radius)


@inlined
def entry(center, w, radius):
    """Distance along w, a unit vector, to where it enters the sphere, or comes nearest to it."""
    middle = dot(center, w)
    foot = sub(center, scaled(middle, w))
    half = math.sqrt(max(radius * radius - dot(foot, foot), 0.0))
    r = norm(center)
    return (r - radius) * (r + radius) / (middle + half)
