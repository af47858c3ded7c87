"""Three edges that pass each other, seen to meet in one point: where a receiver sees that, a shadow changes along a conic."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations, product

from flint import arb

from lightproof.certify.balls import CannotCertify, Vector, cross, dot, minus
from lightproof.certify.contour import meet
from lightproof.certify.planes import Flat, Frame, Region
from lightproof.certify.polygon import Edge
from lightproof.certify.sightlines import Convex, edges

DEPTH = 7  # halvings of a region before giving up


def check_absent(frame: Frame, regions: Iterable[Region], polygons: Sequence[Convex]) -> None:
    """Raises CannotCertify where edges of the last polygon and of two others may be seen to meet in one point."""
    *others, last = polygons
    triples = [triple for a, b in combinations(others, 2) for triple in product(edges(a), edges(b), edges(last)) if _skew(triple)]
    for region in regions if triples else ():
        sides = [_hull(axis) for axis in zip(*region, strict=True)]
        if any(_may_meet(frame, triple, *sides, DEPTH) for triple in triples):
            raise CannotCertify("edges of three polygons that are not in one plane are seen to meet in one point from somewhere"
                                " on the film: a shadow changes along a curve there, which is covered at points only")


def _skew(triple: Sequence[Edge]) -> bool:
    """Whether no two are in one plane: of two that are, either they meet in a point or they are parallel, and then the third
    passes them along a plane."""
    return not any(_in_one_plane(a, b) for a, b in combinations(triple, 2))


def _in_one_plane(a: Edge, b: Edge) -> bool:
    return meet(a, b) is not None or not any(cross(minus(a[1], a[0]), minus(b[1], b[0])))


def _hull(numbers: Sequence[Flat]) -> arb:
    return arb(min(numbers)).union(arb(max(numbers)))


def _may_meet(frame: Frame, triple: Sequence[Edge], p: arb, q: arb, depth: int) -> bool:
    """Whether from somewhere in a box of film positions the edges may be seen to meet."""
    x = frame.at(p, q)
    circles = [cross(minus(start, x), minus(end, start)) for start, end in triple]
    if not dot(cross(circles[0], circles[1]), circles[2]).contains(0):
        return False
    if not any(_on_all(triple, circles, x, sign) for sign in (1, -1)):
        return False
    if not depth:
        return True
    return any(_may_meet(frame, triple, a, b, depth - 1) for a in _halves(p) for b in _halves(q))


def _on_all(triple: Sequence[Edge], circles: Sequence[Vector], x: Vector, sign: int) -> bool:
    """Whether the direction in which the first two great circles cross may lie on all three edges."""
    way = tuple(sign * component for component in cross(circles[0], circles[1]))
    return all(not dot(cross(circle, minus(start, x)), way) < 0 and not dot(cross(minus(end, x), circle), way) < 0
               for circle, (start, end) in zip(circles, triple, strict=True))


def _halves(interval: arb) -> tuple[arb, arb]:
    middle, quarter = interval.mid(), interval.rad() / 2
    return middle - quarter + arb(0, quarter), middle + quarter + arb(0, quarter)
