"""Polygons of a scene as the closed forms take them: the frame of their plane, in exact numbers, and convex parts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import accumulate

import numpy as np

from lightproof import geometry
from lightproof.estimators import convex
from lightproof.estimators.polygon_lights import TOUCH, PolygonLight
from lightproof.geometry import Polygon, Vec3

Exact = list[Fraction]

ROOM = 4  # corners beyond those of a light's part and of all blockers: the horizon cuts off one, a piece's end another


def polygon_light(shape: Polygon, radiance: float, blockers: Sequence[Polygon], reach: float) -> PolygonLight:
    """A light behind blockers, whose receivers have coordinates of at most `reach` [m]."""
    corners, lamp = np.array(shape.vertices), Plane.of(shape)
    parts, order = runs(convex.parts(lamp.flat))
    walls = [part for blocker in blockers for part in convex_parts(blocker)]
    facings = [geometry.unit(geometry.vector_area(wall)) for wall in walls]
    shadows, _ = runs([tuple(range(len(wall))) for wall in walls])
    points = np.concatenate([np.zeros((0, 3)), *walls])
    return PolygonLight(
        radiance=float(radiance),
        corners=corners[order],
        flat=lamp.flat[order],
        parts=parts,
        frame=lamp.frame,
        low=lamp.low,
        reach=float(np.abs(corners).max()),
        blockers=points,
        shadows=shadows,
        facings=np.reshape(facings, (-1, 3)),
        reaches=np.array([np.abs(wall).max() for wall in walls]),
        touch=TOUCH * max(reach, float(np.abs(corners).max()), float(np.abs(points).max(initial=0))),
        room=int(np.diff(parts).max()) + len(points) + 2 * len(walls) + ROOM,
    )


def runs(rings: Sequence[convex.Ring]) -> tuple[np.ndarray, np.ndarray]:
    """Where each ring begins, and the end of the last, in the rings one after the other; and those."""
    return np.array([0, *accumulate(map(len, rings))]), np.array([i for ring in rings for i in ring], int)


def convex_parts(shape: Polygon) -> list[np.ndarray]:
    """Corners (m, 3) of convex polygons that tile one."""
    return [np.array(shape.vertices)[list(ring)] for ring in convex.parts(Plane.of(shape).flat)]


@dataclass(frozen=True)
class Plane:
    """Of a polygon: a `frame` whose first axis runs along its longest edge and whose third is its normal, `low`, what float64
    leaves out of that, and its corners `flat` (m, 2) along the first two axes from the first corner, all digits right."""

    frame: tuple[Vec3, Vec3, Vec3]
    low: Vec3
    flat: np.ndarray

    @classmethod
    def of(cls, shape: Polygon) -> Plane:
        corners = [vector(vertex) for vertex in shape.vertices]
        spokes = [sub(corner, corners[0]) for corner in corners]
        area = [sum(parts) for parts in zip(*map(cross, spokes, spokes[1:]), strict=True)]
        u = max(map(sub, corners, corners[1:] + corners[:1]), key=lambda edge: dot(edge, edge))
        axes = [u, cross(area, u), area]
        frame = [scaled(1 / length(axis), axis) for axis in axes]
        flat = [[float(dot(axis, spoke) / length(axis)) for axis in axes[:2]] for spoke in spokes]
        low = tuple(float(digit - Fraction(float(digit))) for digit in frame[2])
        return cls(tuple(tuple(map(float, axis)) for axis in frame), low, np.array(flat))


def vector(numbers: Sequence[float]) -> Exact:
    return [Fraction(number) for number in numbers]


def length(v: Exact) -> Fraction:
    """To the precision of a float64, and exact where v lies along an axis; however far its square is from 1."""
    largest = max(map(abs, v))
    shares = scaled(1 / largest, v)
    return largest * Fraction(math.sqrt(dot(shares, shares)))


def sub(a: Exact, b: Exact) -> Exact:
    return [x - y for x, y in zip(a, b, strict=True)]


def scaled(factor: Fraction, v: Exact) -> Exact:
    return [factor * x for x in v]


def dot(a: Exact, b: Exact) -> Fraction:
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a: Exact, b: Exact) -> Exact:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]
