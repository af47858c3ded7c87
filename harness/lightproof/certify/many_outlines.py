"""The irradiance of many receivers of a plane at once, in binary64: `outlines` and `arrangement` for arrays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import combinations

import numpy as np
from flint import arb

from lightproof import geometry
from lightproof.certify.balls import CannotCertify
from lightproof.certify.many_circles import Array, Circles, Greats, Rims, crossings
from lightproof.certify.parting import Solid
from lightproof.certify.polygon import area_vector, convex_parts

Side = Callable[[Circles], Array]


@dataclass(frozen=True)
class Outlines:
    """A part of each receiver's sphere of directions; see `arrangement.Outline`."""

    circles: tuple[Circles, ...]
    contains: Callable[[Side], Array]


def irradiance(light: Solid, blockers: Sequence[Solid], x: Array, normal: Array) -> Array:
    """Irradiance per radiance [sr] at x (n, 3), with unit `normal` (3,), from the front of a light past blockers in front of
    it. Raises CannotCertify."""
    lamp, front = seen(light, x)
    horizon = Greats(np.broadcast_to(normal, x.shape))
    parts = [seen(blocker, x)[0] for blocker in blockers]
    circles = (*lamp.circles, horizon, *(circle for part in parts for circle in part.circles))

    def contains(side: Side) -> Array:
        hidden = reduce(np.logical_or, (part.contains(side) for part in parts), np.False_)
        return lamp.contains(side) & side(horizon) & ~hidden

    marks: dict[int, list[Array]] = {id(circle): [] for circle in circles}
    for a, b in combinations(circles, 2):
        directions = crossings(a, b)
        marks[id(a)].append(a.angle(directions))
        marks[id(b)].append(b.angle(directions))
    total = sum(_boundary(contains, circle, np.concatenate(marks[id(circle)], axis=1), normal) for circle in circles)
    return np.where(front, total / 2, 0)


def _boundary(contains: Callable[[Side], Array], circle: Circles, marks: Array, normal: Array) -> Array:
    """The contour integral (n,) along the parts of a circle on which the boundary lies."""
    start = np.sort(marks, axis=1)
    end = np.concatenate([start[:, 1:], start[:, :1] + 2 * np.pi], axis=1)
    directions = circle.at((start + end) / 2)
    left, right = (contains(lambda other, side=side: np.full(start.shape, side) if other is circle else other.left(directions))
                   for side in (True, False))
    return ((left.astype(int) - right) * circle.contour(start, end, normal)).sum(-1)


def seen(shape: Solid, x: Array) -> tuple[Outlines, Array]:
    """How receivers see a shape, and whether they see its front. Raises CannotCertify."""
    match shape:
        case tuple():
            return _polygon(shape, x)
        case geometry.Disk():
            return _disk(np.array(shape.center) - x, geometry.unit(shape.normal), shape.radius)
        case geometry.Sphere():
            return _sphere(np.array(shape.center) - x, shape.radius)
    raise CannotCertify("the shadow of a cylinder, or of what stands before one, is covered at points only")


def _polygon(corners: tuple, x: Array) -> tuple[Outlines, Array]:
    facing = (floats(corners[0]) - x) @ floats(area_vector(corners))
    edges: dict[frozenset, tuple[tuple, Greats]] = {}
    parts = []
    for part in convex_parts(corners):
        way = (floats(part[0]) - x) @ floats(area_vector(part)) > 0
        ends = list(zip(part, (*part[1:], part[0]), strict=True))
        for ab in ends:
            edges.setdefault(frozenset(ab), (ab, _edge(*ab, x)))
        known = [(ab, *edges[frozenset(ab)]) for ab in ends]
        parts.append([(edge, (way if ab == first else ~way)[:, None]) for ab, first, edge in known])

    def contains(side: Side) -> Array:
        return reduce(np.logical_or, (reduce(np.logical_and, (side(edge) == way for edge, way in part)) for part in parts))

    return Outlines(tuple(edge for _, edge in edges.values()), contains), facing < 0


def _edge(a: tuple, b: tuple, x: Array) -> Greats:
    normal = np.cross(floats(a) - x, floats(tuple(q - p for p, q in zip(a, b, strict=True))))
    return Greats(normal / np.linalg.norm(normal, axis=-1, keepdims=True))


def _disk(centre: Array, normal: Array, radius: float) -> tuple[Outlines, Array]:
    height = centre @ normal
    rims = Rims(centre, np.where(height > 0, 1, -1)[:, None] * normal, np.full(len(centre), radius))
    return _inside(rims), height < 0


def _sphere(centre: Array, radius: float) -> tuple[Outlines, Array]:
    square = (centre**2).sum(-1)
    share = 1 - radius**2 / square
    if not (share > 0).all():
        raise CannotCertify("a sphere that meets the film is covered at points only")
    rims = Rims(centre * share[:, None], centre / np.sqrt(square)[:, None], radius * np.sqrt(share))
    return _inside(rims), share > 0


def _inside(rims: Rims) -> Outlines:
    return Outlines((rims,), lambda side: side(rims))


def floats(exact: tuple) -> Array:
    """A point or a vector in binary64."""
    return np.array([float(arb(number).mid()) for number in exact])
