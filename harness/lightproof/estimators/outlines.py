"""Outlines of lights as angles are drawn from, seen from an element: what rounding could blur is taken before axes are turned.

A receiver 1e-13 m over an edge sees the light beside that edge, and turned coordinates are good to 1e-17 m: corners are those
of the scene, not of a map; an edge's line is known by its moment p x e, p any point of it; a rim by how far one is beyond it.
Over corners, and over edges and rims along the scene's axes, no digit is lost. Elsewhere the light is good to about 1e-16 m over
the distance, which is how well coordinates tell where a receiver is.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.compiled import inlined
from lightproof.estimators.lamps import beyond
from lightproof.estimators.shapes import Disk, Parallelogram, Sphere, Triangle, placed
from lightproof.estimators.vectors import TINY, along, cross, dot, norm, scaled, sub, turned
from lightproof.geometry import Vec3


class Edge(NamedTuple):
    """From a corner to another: unit vector, length [m], and the line's moment about the element's centre, per length [m]."""

    direction: Vec3
    length: float
    moment: Vec3


class Facet(NamedTuple):
    """A quadrilateral a b c d, clockwise about its normal, with the `level` of the element's centre over its plane [m]. `edges`
    are ab, bc, cd, da and the diagonal ac; `sines` of the angles that a line turns by from ab to bc and from ac to cd. A
    triangle is one whose c and d are the same, so that all polygons have one way."""

    corners: tuple[Vec3, Vec3, Vec3, Vec3]
    edges: tuple[Edge, Edge, Edge, Edge, Edge]
    sines: tuple[float, float]
    normal: Vec3
    level: float


class Rim(NamedTuple):
    """A disk; `u` leads from its centre to its rim. The element's centre is `level` over its plane [m]; `beyond` is the square of
    its distance from the disk's axis less that of the radius [m2]."""

    center: Vec3
    u: Vec3
    normal: Vec3
    level: float
    beyond: float


def clockwise(corners: np.ndarray) -> tuple[Vec3, Vec3, Vec3, Vec3]:
    """Corners (3, 3) or (4, 3), counter-clockwise about the normal, as a facet has them."""
    a, b, c, d = (tuple(map(float, corners[k])) for k in (0, -1, -2, 1))
    return a, b, c, d


def outlined(shape, corners, origin, frame):
    """A shape, and the corners if it is a polygon, as seen from `origin` along the axes of `frame`, in float64."""


@overload(outlined)
def _outlined(shape, corners, origin, frame):
    return {Sphere: sphere, Disk: rim, Parallelogram: facet, Triangle: facet}[shape.instance_class]


def sphere(shape, corners, origin, frame):
    return placed(shape, origin, frame, 1.0)


def rim(shape, corners, origin, frame):
    away = sub(origin, shape.center)
    level = dot(away, shape.normal)
    outside = beyond(norm(shape.u), along(away, -level, shape.normal))
    at, u, normal = turned(sub(shape.center, origin), frame, 1.0), turned(shape.u, frame, 1.0), turned(shape.normal, frame, 1.0)
    return Rim(at, u, normal, level, outside)


def facet(shape, corners, origin, frame):
    p, q, r, s = corners
    a, b, c, d = sub(p, origin), sub(q, origin), sub(r, origin), sub(s, origin)
    ab, bc, cd = edge(a, b, sub(q, p), frame), edge(b, c, sub(r, q), frame), edge(c, d, sub(s, r), frame)
    da, ac = edge(d, a, sub(p, s), frame), edge(a, c, sub(r, p), frame)
    seen = turned(a, frame, 1.0), turned(b, frame, 1.0), turned(c, frame, 1.0), turned(d, frame, 1.0)
    level = -dot(nearer(nearer(a, b), nearer(c, d)), shape.normal)
    sines = norm(cross(ab.direction, bc.direction)), norm(cross(ac.direction, cd.direction))
    return Facet(seen, (ab, bc, cd, da, ac), sines, turned(shape.normal, frame, 1.0), level)


@inlined
def nearer(p, q):
    return p if norm(p) < norm(q) else q


@inlined
def edge(p, q, vector, frame):
    length = norm(vector)
    direction = scaled(1 / max(length, TINY), vector)
    return Edge(turned(direction, frame, 1.0), length, turned(cross(nearer(p, q), direction), frame, 1.0))


@inlined
def about(edge, x):
    """The edge with its moment about x."""
    return Edge(edge.direction, edge.length, sub(edge.moment, cross(x, edge.direction)))
