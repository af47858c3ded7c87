"""What lies in loops of great circles: unions, solid angle, and the second moments that a sky needs.

A region of directions is a list of convex loops that share nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from flint import arb

from lightproof.certify.balls import Ball, Point, Vector, angle, cross, dot, minus, root, times
from lightproof.certify.contour import Contour
from lightproof.certify.planes import Plane
from lightproof.certify.polygon import Loop, clip, intersection, loop, visible_pieces

Convex = tuple[Point, ...]  # corners of a convex polygon
Region = list[Loop]


def cut(tiles: Iterable[Convex], plane: Plane) -> list[Convex]:
    """The parts of convex polygons in front of a plane."""
    return [part for corners in tiles if (part := clip(corners, plane.normal, plane.offset))]


def shadow(tiles: Iterable[Convex], receiver: Point) -> Region:
    """The directions in which a receiver sees any of some convex polygons."""
    region: Region = []
    for corners in tiles:
        region = union(region, [loop(corners, receiver)], receiver)
    return region


def overlays(tiles: Iterable[Convex], receiver: Point) -> list[tuple[int, Loop]]:
    """Loops with signs that add up to the directions in which any of some convex polygons is seen. Their edges are parts of the
    polygons' own, so that they hold for receivers nearby."""
    terms: list[tuple[int, Loop]] = []
    for corners in tiles:
        whole = loop(corners, receiver)
        terms += [(1, whole), *((-sign, intersection(part, whole, receiver)) for sign, part in terms)]
        terms = [(sign, part) for sign, part in terms if part]
    return terms


def union(a: Region, b: Region, receiver: Point) -> Region:
    """The directions in one region or the other."""
    return [*a, *(piece for part in b for piece in visible_pieces(part, a, receiver))]


def measure(region: Region, receiver: Point) -> Ball:
    """Solid angle [sr] of a region."""
    return sum((solid_angle(part, receiver) for part in region), arb(0))


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
