"""What lies in loops of great circles: sums and unions of them, solid angle, and the second moments that a sky needs.

Regions of directions are Counters: convex loops with whole numbers whose indicator functions add up to the region's.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from flint import arb

from lightproof.certify.balls import Ball, Point, Vector, angle, cross, dot, minus, root, times
from lightproof.certify.contour import Contour
from lightproof.certify.planes import Plane
from lightproof.certify.polygon import Loop, Parts, clip, intersection, visible

Region = Counter[Loop]


def shadow(blockers: Iterable[Parts], receiver: Point) -> Region:
    """The directions in which a receiver sees any of some polygons."""
    seen: Region = Counter()
    before: list[Parts] = []
    for blocker in blockers:
        for part, count in visible(blocker, before, receiver).items():
            seen[part] += count
        before.append(blocker)
    return _tidy(seen)


def cut(polygon: Parts, plane: Plane) -> Parts:
    """The part of a polygon in front of a plane."""
    halves = ((sign, clip(corners, plane.normal, plane.offset)) for sign, corners in polygon)
    return tuple((sign, corners) for sign, corners in halves if corners)


def union(a: Region, b: Region, receiver: Point) -> Region:
    """The directions in one region or the other."""
    both = Counter(a)
    for region, sign in ((b, 1), (_overlap(a, b, receiver), -1)):
        for part, count in region.items():
            both[part] += sign * count
    return _tidy(both)


def _overlap(a: Region, b: Region, receiver: Point) -> Region:
    shared: Region = Counter()
    for first, count in a.items():
        for second, other in b.items():
            shared[intersection(first, second, receiver)] += count * other
    return _tidy(shared)


def _tidy(region: Region) -> Region:
    return Counter({part: count for part, count in region.items() if part and count})


def measure(region: Region, receiver: Point) -> Ball:
    """Solid angle [sr] of a region."""
    return sum((count * solid_angle(part, receiver) for part, count in region.items()), arb(0))


def solid_angle(edges: Loop, receiver: Point) -> Ball:
    """Solid angle [sr] of a loop."""
    return excess(*Contour.at(edges, receiver).outline(receiver))


def excess(circles: Sequence[Vector], corners: Sequence[Vector]) -> Ball:
    """Solid angle [sr] inside great circles that meet in corners: a whole turn less the turns in the corners (Girard 1629)."""
    lengths = [root(dot(inwards, inwards)) for inwards in circles]
    total = 2 * arb.pi()
    for i, corner in enumerate(corners):
        sine = dot(cross(circles[i - 1], circles[i]), corner) / root(dot(corner, corner))
        total -= angle(sine, dot(circles[i - 1], circles[i]), lengths[i - 1] * lengths[i])
    return total


def second_moment(contour: Contour, receiver: Vector, a: Vector, b: Vector) -> Ball:
    """The integral of (a . w)(b . w) over the directions w in a convex loop [sr] (the axial moments of Arvo 1995).

    w w^T less a third of the identity is a spherical harmonic of degree 2, an eigenfunction of the Laplacian: its integral is
    -1/6 of the flux of its gradient out of the loop, which a great circle's constant inward normal g makes elementary.
    """
    circles, corners = contour.outline(receiver)
    directions = [times(corner, 1 / root(dot(corner, corner))) for corner in corners]
    total = 2 * excess(circles, corners) * dot(a, b)
    for inwards, start, end in zip(circles, directions, directions[1:] + directions[:1], strict=True):
        along = cross(minus(end, start), inwards)
        total += (dot(inwards, a) * dot(along, b) + dot(along, a) * dot(inwards, b)) / dot(inwards, inwards)
    return total / 6
