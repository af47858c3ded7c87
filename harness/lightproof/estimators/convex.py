"""Simple polygons in the plane, cut into few convex ones: ears are cut off one by one, then joined where no corner turns in."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

STRAIGHT = 1e-15  # sine of the turn at a corner that counts as none

Ring = tuple[int, ...]


def parts(flat: np.ndarray) -> list[Ring]:
    """The corners of convex polygons that tile a simple one with `flat` (m, 2) corners, counter-clockwise."""
    ring = tuple(range(len(flat)))
    if is_convex(flat, ring):
        return [ring]
    bent = tuple(i for i in ring if abs(turn(flat, ring[i - 1], i, ring[(i + 1) % len(ring)])) > STRAIGHT)
    return joined(flat, ears(flat, bent))


def turn(flat: np.ndarray, a: int, b: int, c: int) -> float:
    """Sine of the turn to the left at b on the way from a to c."""
    (s, t), (u, v) = flat[b] - flat[a], flat[c] - flat[b]
    return float((s * v - t * u) / np.hypot(s, t) / np.hypot(u, v))


def is_convex(flat: np.ndarray, ring: Ring) -> bool:
    return all(turn(flat, ring[i - 2], ring[i - 1], ring[i]) >= -STRAIGHT for i in range(len(ring)))


def ears(flat: np.ndarray, ring: Ring) -> list[Ring]:
    """Triangles that tile a ring."""
    cut = []
    while len(ring) > 3:
        i = max(range(len(ring)), key=lambda i: ear(flat, ring, i))
        cut.append((ring[i - 1], ring[i], ring[(i + 1) % len(ring)]))
        ring = (*ring[:i], *ring[i + 1:])
    return [*cut, ring]


def ear(flat: np.ndarray, ring: Ring, i: int) -> float:
    """How well the triangle at a corner can be cut off: the sine of its turn, -1 where another corner lies in the triangle."""
    a, b, c = ring[i - 1], ring[i], ring[(i + 1) % len(ring)]
    others = [flat[k] for k in ring if k not in (a, b, c)]
    triangle = flat[[a, b, c]]
    return -1.0 if any(inside(triangle, point) for point in others) else turn(flat, a, b, c)


def inside(triangle: np.ndarray, point: np.ndarray) -> bool:
    """Whether a point lies in a triangle, its border included."""
    to, along = point - triangle, np.roll(triangle, -1, axis=0) - triangle
    return bool((along[:, 0] * to[:, 1] >= along[:, 1] * to[:, 0]).all())


def joined(flat: np.ndarray, rings: Sequence[Ring]) -> list[Ring]:
    """Neighbours made one as long as the union is convex."""
    for one, other in combinations(rings, 2):
        union = united(one, other)
        if union and is_convex(flat, union):
            return joined(flat, [ring for ring in rings if ring not in (one, other)] + [union])
    return list(rings)


def united(one: Ring, other: Ring) -> Ring | None:
    """The ring around two rings that share an edge."""
    for i, start in enumerate(one):
        end = one[(i + 1) % len(one)]
        if start in other and end in other and other[other.index(start) - 1] == end:
            return around(one, i, other, other.index(start))
    return None


def around(one: Ring, i: int, other: Ring, k: int) -> Ring:
    """All of `one` from behind its edge i on, then all of `other` between the ends of that edge, which begins at other[k]."""
    first = (*one[i + 1:], *one[:i + 1])
    second = (*other[k + 1:], *other[:k])
    return (*first, *second[:-1])
