"""Simple polygons taken apart into convex ones, in exact numbers."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from lightproof.certify.balls import CannotCertify, Number, Point, cross, dot, minus

Ring = tuple[int, ...]  # numbers of a polygon's corners


def parts(corners: Sequence[Point], front: Point) -> list[tuple[Point, ...]]:
    """Convex polygons that tile a simple polygon with normal `front`; itself where it is convex.

    Ears are cut off (Meisters 1975), then triangles joined where they stay convex (Hertel and Mehlhorn 1983). Raises
    CannotCertify where the polygon is not simple.
    """
    polygon = _Polygon(tuple(corners), front)
    whole = tuple(range(len(corners)))
    rings = [whole] if polygon.is_convex(whole) else _joined(polygon, _ears(polygon, whole))
    return [tuple(corners[i] for i in ring) for ring in rings]


class _Polygon:
    """Corners as seen from the front."""

    def __init__(self, corners: tuple[Point, ...], front: Point) -> None:
        self.corners, self.front = corners, front

    def turn(self, a: int, b: int, c: int) -> Number:
        """Positive where the way from corner a by b to c turns left."""
        start, middle, end = (self.corners[i] for i in (a, b, c))
        return dot(self.front, cross(minus(middle, start), minus(end, middle)))

    def is_convex(self, ring: Ring) -> bool:
        """Whether a ring never turns right."""
        return all(self.turn(ring[i - 2], ring[i - 1], ring[i]) >= 0 for i in range(len(ring)))

    def is_ear(self, ring: Ring, i: int) -> bool:
        """Whether corner i - 1 of a ring may be cut off: no other corner lies in its triangle."""
        a, b, c = triangle = ring[i - 2], ring[i - 1], ring[i]
        others = (k for k in ring if k not in triangle)
        return self.turn(a, b, c) > 0 and not any(
            all(self.turn(p, q, k) >= 0 for p, q in ((a, b), (b, c), (c, a))) for k in others)


def _ears(polygon: _Polygon, ring: Ring) -> list[Ring]:
    """The triangles of a ring."""
    triangles = []
    while len(ring) > 3:
        i = next((i for i in range(len(ring)) if polygon.is_ear(ring, i)), None)
        if i is None:
            raise CannotCertify("a polygon crosses or touches itself")
        triangles.append((ring[i - 2], ring[i - 1], ring[i]))
        ring = ring[:i - 1] + ring[i:] if i else ring[:-1]
    return [*triangles, ring]


def _joined(polygon: _Polygon, rings: list[Ring]) -> list[Ring]:
    """Fewer rings: any two that share an edge and stay convex together become one."""
    for a, b in combinations(rings, 2):
        both = _union(a, b)
        if both and polygon.is_convex(both):
            return _joined(polygon, [*(ring for ring in rings if ring not in (a, b)), both])
    return rings


def _union(a: Ring, b: Ring) -> Ring:
    """The ring around two that share an edge; () where they share none."""
    for i, start in enumerate(a):
        end = a[(i + 1) % len(a)]
        if start in b and b[b.index(start) - 1] == end:
            at = b.index(start)
            return a[i + 1:] + a[:i + 1] + (b[at + 1:] + b[:at - 1] if at else b[1:-1])
    return ()
