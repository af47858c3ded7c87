"""Irradiance from a polygon, and from what blockers leave of it, at one receiver.

Seen from the receiver every edge lies on a great circle, whose normal is linear in the receiver's position, and every
corner is where two such circles meet. So a visible part is just a loop of edges: which edges, is decided once in exact
arithmetic; how much light, follows by Lambert's formula for any receiver nearby.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import reduce
from itertools import pairwise

from flint import arb

from lightproof.certify.balls import Ball, Number, Point, Vector, angle, cross, dot, minus, plus, root, times

Edge = tuple[Point, Point]
Loop = tuple[Edge, ...]  # runs round so that edge normals point inwards
Parts = tuple[tuple[int, tuple[Point, ...]], ...]  # convex polygons, each with a sign, that add up to a polygon


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
    kept = []
    for i, (here, height) in enumerate(zip(corners, heights, strict=True)):
        before, depth = corners[i - 1], heights[i - 1]
        if (height > 0 and depth < 0) or (height < 0 and depth > 0):
            kept.append(plus(before, times(minus(here, before), depth / (depth - height))))
        if height >= 0:
            kept.append(here)
    return tuple(kept)


def convex_parts(corners: Sequence[Point]) -> Parts:
    """Convex polygons with signs that add up to the polygon: itself, or the triangles of a fan."""
    front = area_vector(corners)
    triangles = [(corners[0], b, c) for b, c in pairwise(corners[1:])]
    turns = [dot(front, area_vector((corners[i - 2], corners[i - 1], corners[i]))) for i in range(len(corners))]
    if all(turn >= 0 for turn in turns):
        return ((1, tuple(corners)),)
    signs = [dot(front, area_vector(triangle)) for triangle in triangles]
    return tuple((1 if sign > 0 else -1, triangle) for sign, triangle in zip(signs, triangles, strict=True) if sign != 0)


def visible(light: Parts, blockers: Sequence[Parts], receiver: Point) -> Counter[Loop]:
    """Loops with counts that add up to what the receiver sees of a light behind blockers."""
    seen: Counter[Loop] = Counter()
    for sign, corners in light:
        for part, count in _uncovered(loop(corners, receiver), blockers, receiver).items():
            seen[part] += sign * count
    return Counter({part: count for part, count in seen.items() if part and count})


def _uncovered(light: Loop, blockers: Sequence[Parts], receiver: Point) -> Counter[Loop]:
    """What is seen past all blockers but the first, less what of that the first one hides."""
    if not blockers:
        return Counter({light: 1})
    first, *others = blockers
    seen = _uncovered(light, others, receiver)
    for sign, corners in first:
        hidden = intersection(light, loop(corners, receiver), receiver)
        if hidden:
            for part, count in _uncovered(hidden, others, receiver).items():
                seen[part] -= sign * count
    return seen


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


def lambert(edges: Loop, receiver: Vector, normal: Vector) -> Ball:
    """Irradiance per radiance [sr] from a loop above the horizon of a receiver with unit `normal` (Lambert 1760; Arvo 1995):
    half the sum over edges of angle times cosine. Angles are signed, so it stays analytic where an edge vanishes."""
    corners = corners_of(edges, receiver)
    lengths = [root(dot(corner, corner)) for corner in corners]
    total = arb(0)
    for i, edge in enumerate(edges):
        j = (i + 1) % len(edges)
        inwards = circle(edge, receiver)
        length = root(dot(inwards, inwards))
        whole = edges[i - 1][1] == edge[0] and edge[1] == edges[j][0]
        sine = length if whole else dot(cross(corners[i], corners[j]), inwards) / length
        total += angle(sine, dot(corners[i], corners[j]), lengths[i] * lengths[j]) * dot(inwards, normal) / length
    return total / 2
