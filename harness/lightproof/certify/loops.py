"""What lies in loops of great circles: sums and unions of them, solid angle, and the second moments that a sky needs.

Regions of directions are Counters: convex loops with whole numbers whose indicator functions add up to the region's.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from itertools import pairwise

from flint import arb

from lightproof.certify.balls import Ball, Point, Vector, angle, cross, dot, minus, root, times
from lightproof.certify.planes import Plane
from lightproof.certify.polygon import Loop, Parts, circle, clip, corners_of, intersection, visible

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


def measure(region: Region, receiver: Vector) -> Ball:
    """Solid angle [sr] of a region."""
    return sum((count * solid_angle(part, receiver) for part, count in region.items()), arb(0))


def solid_angle(edges: Loop, receiver: Vector) -> Ball:
    """Solid angle [sr] of a convex loop: a fan of triangles."""
    first, *others = corners_of(edges, receiver)
    return sum((triangle(first, b, c) for b, c in pairwise(others)), arb(0))


def triangle(a: Vector, b: Vector, c: Vector) -> Ball:
    """Signed solid angle [sr] of the triangle in which three directions, of any length, are seen (Van Oosterom and Strackee
    1983): positive where a, b, c run counter-clockwise."""
    la, lb, lc = (root(dot(side, side)) for side in (a, b, c))
    ab, bc, ca = la * lb + dot(a, b), lb * lc + dot(b, c), lc * la + dot(c, a)
    volume = dot(a, cross(minus(b, a), minus(c, a)))
    return 2 * angle(volume, ab * lc + lb * dot(c, a) + la * dot(b, c), root(2 * ab * bc * ca))


def second_moment(edges: Loop, receiver: Vector, a: Vector, b: Vector) -> Ball:
    """The integral of (a . w)(b . w) over the directions w in a convex loop [sr] (the axial moments of Arvo 1995).

    w w^T less a third of the identity is a spherical harmonic of degree 2, an eigenfunction of the Laplacian: its integral is
    -1/6 of the flux of its gradient out of the loop, which a great circle's constant inward normal g makes elementary.
    """
    corners = corners_of(edges, receiver)
    directions = [times(corner, 1 / root(dot(corner, corner))) for corner in corners]
    total = 2 * solid_angle(edges, receiver) * dot(a, b)
    for edge, start, end in zip(edges, directions, directions[1:] + directions[:1], strict=True):
        inwards = circle(edge, receiver)
        along = cross(minus(end, start), inwards)
        total += (dot(inwards, a) * dot(along, b) + dot(along, a) * dot(inwards, b)) / dot(inwards, inwards)
    return total / 6
