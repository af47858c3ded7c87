"""What touches: receivers that lie on something, which see the limit as they come to it along their normal, from their own side,
and polygons that overlap in one plane, of which either may be seen."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import count
from math import prod

from flint import arb

from lightproof import geometry
from lightproof.certify.balls import Number, Point, cross, dot, exact, minus, point, root, times
from lightproof.certify.polygon import area_vector, clip, convex_parts

Convex = tuple[Point, ...]

ROUNDING = exact(1e-15)  # of the coordinates: how far from a polygon a receiver may be that lies on it


def touches(shape: geometry.Shape, x: Point, normal: Point | None) -> bool:
    """Whether x lies on a shape and leaves it along `normal`, or any way: what it sees then depends on the side it comes from."""
    match shape:
        case geometry.Polygon():
            parts = convex_parts([point(corner) for corner in shape.vertices])
            return any(_lies_on(part, x) and (normal is None or _leads_out(part, normal)) for part in parts)
        case geometry.Disk():
            axis, ray = point(shape.normal), minus(x, point(shape.center))
            level = normal is not None and (dot(axis, normal) == 0 or not any(cross(axis, normal)))
            return bool(not level and dot(axis, ray) == 0 and dot(ray, ray) <= exact(shape.radius) ** 2)
        case geometry.Cylinder():
            return _on_cylinder(shape, x)
    ray = minus(x, point(shape.center))
    return bool(dot(ray, ray) == exact(shape.radius) ** 2)


def limit(parts: Iterable[Convex], x: Point, normal: Point) -> tuple[Convex, ...]:
    """Convex polygons as they are seen from x + e `normal` as e goes to 0: one that x lies on becomes the cone of directions in
    which it then is, as triangles with a corner straight behind x, or nothing where `normal` runs along it. These corners differ,
    so that none joins two triangles."""
    behind = (minus(x, times(normal, depth)) for depth in count(1))
    return tuple(piece for part in parts for piece in _seen(part, x, normal, behind))


def overlap(a: geometry.Polygon, b: geometry.Polygon) -> bool:
    """Whether two polygons in one plane have some area in common."""
    one, other = ([point(corner) for corner in shape.vertices] for shape in (a, b))
    front = area_vector(one)
    if any(dot(front, minus(corner, one[0])) != 0 for corner in other):
        return False
    return any(_common(part, cutter) for part in convex_parts(one) for cutter in convex_parts(other))


def _common(part: Convex, cutter: Convex) -> bool:
    """Whether two convex polygons in one plane have some area in common."""
    front = area_vector(cutter)
    for start, end in _edges(cutter):
        inwards = cross(front, minus(end, start))
        part = clip(part, inwards, dot(inwards, start)) if part else ()
    return bool(part)


def _seen(part: Convex, x: Point, normal: Point, behind: Iterator[Point]) -> tuple[Convex, ...]:
    if not _lies_on(part, x):
        return (part,)
    return _cone(part, x, behind) if _leads_out(part, normal) else ()


def _leads_out(convex: Convex, normal: Point) -> bool:
    """Whether a normal leads out of a polygon's plane, but for rounding."""
    front = area_vector(convex)
    return _more(dot(front, normal), ROUNDING, front, normal)


def _lies_on(convex: Convex, x: Point) -> bool:
    """Whether x lies on a convex polygon, its edges included, but for the rounding of coordinates."""
    front, slack = area_vector(convex), _slack(convex, x)
    if _more(dot(front, minus(x, convex[0])), slack, front):
        return False
    inwards = ((dot(front, cross(minus(end, start), minus(x, start))), minus(end, start)) for start, end in _edges(convex))
    return all(inward >= 0 or not _more(inward, slack, front, edge) for inward, edge in inwards)


def _slack(convex: Convex, x: Point) -> Number:
    return ROUNDING * max(abs(number) for corner in (*convex, x) for number in corner)


def _more(value: Number, slack: Number, *vectors: Point) -> bool:
    """Whether a value exceeds `slack` times the lengths of the vectors."""
    return bool(value**2 > slack**2 * prod(dot(vector, vector) for vector in vectors))


def _cone(convex: Convex, x: Point, behind: Iterator[Point]) -> tuple[Convex, ...]:
    slack = _slack(convex, x)
    return tuple((start, end, next(behind)) for start, end in _edges(convex) if _apart(x, start, end, slack))


def _apart(x: Point, start: Point, end: Point, slack: Number) -> bool:
    """Whether x is farther than `slack` from a line."""
    aside, edge = cross(minus(start, x), minus(end, x)), minus(end, start)
    return bool(dot(aside, aside) > slack**2 * dot(edge, edge))


def _edges(convex: Convex) -> Iterable[tuple[Point, Point]]:
    return zip(convex, (*convex[1:], convex[0]), strict=True)


def _on_cylinder(shape: geometry.Cylinder, x: Point) -> bool:
    axis, ray = point(shape.axis), minus(x, point(shape.base))
    aside, square, along = cross(ray, axis), dot(axis, axis), dot(ray, axis)
    reach = exact(shape.height) * root(square)
    return bool(dot(aside, aside) == exact(shape.radius) ** 2 * square and along >= 0 and not arb(along) > reach)
