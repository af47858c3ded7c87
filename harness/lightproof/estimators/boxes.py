"""Boxes of four coordinates: p, q over an element and s, t over a flat light, each light with its map of s, t to points.

A parallelogram's map is that of `shapes`. A triangle's s runs from its first corner (0) to the opposite edge (1), t along that
edge; a disk's s is the radius and t the azimuth. Rows of lights and blockers are in the element's own frame: its centre is the
origin, its normal the third axis. Points of a film are elements without extent.
"""

from __future__ import annotations

import math

import numpy as np

from lightproof.estimators.compiled import strict
from lightproof.estimators.shapes import Disk, Flat, Parallelogram, Triangle
from lightproof.estimators.vectors import along, cross, norm, sub, turned
from lightproof.estimators.world import DISK, KINDS, PARALLELOGRAM, TRIANGLE

KIND, CENTER, U, V, NORMAL, RADIANCE, SLIP, FLAW, WIDTH = 0, 1, 4, 7, 10, 13, 14, 15, 16  # columns of a light
POINTS, VECTORS = (CENTER,), (U, V, NORMAL)
RANGES = {Parallelogram: ((-0.5, 0.5), (-0.5, 0.5)), Triangle: ((0.0, 1.0), (0.0, 1.0)), Disk: ((0.0, 1.0), (0.0, 2 * np.pi))}
ROUNDING = 8 * np.finfo(float).eps
QUARTERS = 4  # boxes that a disk starts as: a hull of a longer arc would reach far


def row(shape: Flat, radiance: float, farthest: float) -> list[float]:
    """A light (WIDTH,), with what rounding may do to it where coordinates reach as far as `farthest` [m]: SLIP, by how far its
    points may be off [m], and FLAW, by how much of them its area and normal are, which is more for slivers."""
    u, v = np.array(shape.u), np.array(shape.v)
    slender = np.linalg.norm(u) * np.linalg.norm(v) / np.linalg.norm(np.cross(u, v))
    return [KINDS[type(shape)], *shape.center, *u, *v, *shape.normal, radiance, ROUNDING * farthest, ROUNDING * slender]


def whole(shape: Flat, light: int) -> list[list[float]]:
    """The boxes (9,) of all of an element and all of the light: low and high of p, q, s, t; and the light's number."""
    (s, t), count = RANGES[type(shape)], QUARTERS if isinstance(shape, Disk) else 1
    edges = np.linspace(*t, count + 1).tolist()
    return [[-0.5, 0.5, -0.5, 0.5, *s, *edges[k:k + 2], light] for k in range(count)]


@strict
def part(row, at):
    return row[at], row[at + 1], row[at + 2]


@strict
def place(rows, points, vectors, origin, frame, out):
    """The rows as seen from `origin` along the axes of `frame`; which columns start points, and which vectors."""
    for k in range(len(rows)):
        out[k] = rows[k]
        for at in points:
            out[k, at], out[k, at + 1], out[k, at + 2] = turned(sub(part(rows[k], at), origin), frame, 1.0)
        for at in vectors:
            out[k, at], out[k, at + 1], out[k, at + 2] = turned(part(rows[k], at), frame, 1.0)


@strict
def spot(light, s, t):
    """The point of a light at s, t."""
    u, v = part(light, U), part(light, V)
    if light[KIND] == PARALLELOGRAM:
        a, b = s, t
    elif light[KIND] == TRIANGLE:
        a, b = s * (1 - t), s * t
    else:
        a, b = s * math.cos(t), s * math.sin(t)
    return along(along(part(light, CENTER), a, u), b, v)


@strict
def density(light, s):
    """Area per ds dt [m2]."""
    area = norm(cross(part(light, U), part(light, V)))
    return area if light[KIND] == PARALLELOGRAM else area * s


@strict
def hull(box, light, cell, xs, ys):
    """Corners (4, 3) of the element's part of a box, and of a quadrilateral that holds the light's part."""
    outer = 1 / math.cos((box[7] - box[6]) / 2) if light[KIND] == DISK else 1.0
    for k in range(4):
        p, q = box[k % 2], box[2 + k // 2]
        xs[k, 0], xs[k, 1], xs[k, 2] = cell[0] * p + cell[1] * q, cell[2] * q, 0.0
        ys[k, 0], ys[k, 1], ys[k, 2] = spot(light, box[4 + k % 2] * (outer if k % 2 else 1.0), box[6 + k // 2])


@strict
def reaches(box, light, cell):
    """How far half of each side of a box leads at most [m]."""
    u, v = part(light, U), part(light, V)
    p, q, s, t = (box[1] - box[0]) / 2, (box[3] - box[2]) / 2, (box[5] - box[4]) / 2, (box[7] - box[6]) / 2
    if light[KIND] == PARALLELOGRAM:
        s, t = s * norm(u), t * norm(v)
    elif light[KIND] == TRIANGLE:
        s, t = s * max(norm(u), norm(v)), t * box[5] * norm(sub(v, u))
    else:
        s, t = s * norm(u), t * box[5] * norm(u)
    return p * abs(cell[0]), q * math.hypot(cell[1], cell[2]), s, t
