"""What a receiver sees of a polygon, and what blockers leave of it.

Seen from the receiver every edge lies on a great circle, whose normal is linear in the receiver's position, and every
corner is where two such circles meet. So a visible part is just a loop of edges: which edges, is decided once in exact
arithmetic; how much light, follows by Lambert's formula (`contour`) for any receiver nearby.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import reduce
from itertools import pairwise

from lightproof.certify import convex
from lightproof.certify.balls import Number, Point, Vector, cross, dot, minus, plus, times

Edge = tuple[Point, Point]
Loop = tuple[Edge, ...]  # runs round so that edge normals point inwards


def loop(corners: Sequence[Point], receiver: Point) -> Loop:
    """The edges of a polygon, run through so that (a - x) x (b - x) points to its inside; () where it is seen edge-on."""
    facing = dot(area_vector(corners), minus(corners[0], receiver))
    if facing == 0:
        return ()
    corners = corners if facing > 0 else corners[::-1]
    return tuple(zip(corners, (*corners[1:], corners[0]), strict=True))


def area_vector(corners: Sequence[Point]) -> Point:
    """Twice the vector area of a polygon, on its front."""
    spokes = [minus(corner, corners[0]) for corner in corners[1:]]
    return reduce(plus, (cross(a, b) for a, b in pairwise(spokes)))


def clip(corners: Sequence[Point], normal: Point, offset: Number) -> tuple[Point, ...]:
    """The part of a polygon where normal . x > offset (Sutherland and Hodgman 1974); () where there is none."""
    heights = [dot(normal, corner) - offset for corner in corners]
    if not any(height > 0 for height in heights):
        return ()
    if all(height >= 0 for height in heights):
        return tuple(corners)
    kept = []
    for i, (here, height) in enumerate(zip(corners, heights, strict=True)):
        before, depth = corners[i - 1], heights[i - 1]
        if (height > 0 and depth < 0) or (height < 0 and depth > 0):
            kept.append(plus(before, times(minus(here, before), depth / (depth - height))))
        if height >= 0:
            kept.append(here)
    return tuple(kept)


def convex_parts(corners: Sequence[Point]) -> list[tuple[Point, ...]]:
    """Convex polygons that tile a simple polygon. Raises CannotCertify where it is not simple."""
    return convex.parts(corners, area_vector(corners))


def difference(a: Loop, b: Loop, receiver: Point) -> list[Loop]:
    """Convex loops that tile what of one convex loop is outside another."""
    if not intersection(a, b, receiver):
        return [a]
    rest = []
    for start, end in b:
        rest.append(_half(a, (end, start), receiver))
        a = _half(a, (start, end), receiver)
    return [part for part in rest if part]


def visible_pieces(light: Loop, shades: Iterable[Loop], receiver: Point) -> list[Loop]:
    """Convex loops that tile what of one convex loop is outside others."""
    pieces = [light] if light else []
    for shade in shades:
        pieces = [rest for piece in pieces for rest in difference(piece, shade, receiver)]
    return pieces


def intersection(a: Loop, b: Loop, receiver: Point) -> Loop:
    """The loop around what two convex loops share; () where they share nothing."""
    for edge in b:
        a = _half(a, edge, receiver)
    return a if b else ()


def _half(convex: Loop, edge: Edge, receiver: Point) -> Loop:
    """The part of a convex loop on the inner side of the great circle through `edge`."""
    inwards = circle(edge, receiver)
    sides = [dot(inwards, corner) for corner in corners_of(convex, receiver)]
    ends = sides[1:] + sides[:1]
    if all(side >= 0 for side in sides):
        return convex
    kept: list[Edge] = []
    for side, start, end in zip(convex, sides, ends, strict=True):
        if start > 0 or end > 0:
            kept.append(side)
        if start > 0 >= end:
            kept.append(edge)
    return tuple(kept)


def circle(edge: Edge, receiver: Vector) -> Vector:
    """Normal of the great circle on which an edge is seen, pointing inwards."""
    return cross(minus(edge[0], receiver), minus(edge[1], edge[0]))


def corners_of(edges: Loop, receiver: Vector) -> list[Vector]:
    """The directions in which each edge of a loop begins."""
    return [
        minus(after[0], receiver) if before[1] == after[0] else cross(circle(before, receiver), circle(after, receiver))
        for before, after in zip(edges[-1:] + edges[:-1], edges, strict=True)
    ]


def chords(edges: Loop, receiver: Point) -> Loop:
    """A loop that this receiver, and no other, sees as it sees `edges`: each edge ends where the next begins."""
    corners = [plus(receiver, corner) for corner in corners_of(edges, receiver)]
    return tuple(zip(corners, corners[1:] + corners[:1], strict=True))
