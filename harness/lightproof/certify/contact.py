"""What touches: receivers that lie on something, which see the limit as they come to it along their normal, from their own side,
and polygons that overlap in one plane, of which either may be seen."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import count
from math import prod

from flint import arb

from lightproof import geometry
from lightproof.certify.balls import CannotCertify, Number, Point, cross, dot, exact, minus, point, root, times
from lightproof.certify.polygon import area_vector, clip, convex_parts

Convex = tuple[Point, ...]

ROUNDING = exact(1e-15)  # of the coordinates: how far from a shape a receiver may be that lies on it
DOUBT = exact(1e-14)  # of the coordinates: a receiver farther than this does not


def touches(shape: geometry.Shape, x: Point, normal: Point | None) -> bool:
    """Whether x lies on a shape and leaves it along `normal`, or any way: what it sees then depends on the side it comes from.
    Raises CannotCertify where that is in doubt of a polygon; of another shape, x then lies on it."""
    if isinstance(shape, geometry.Polygon):
        parts = [part for part in convex_parts([point(corner) for corner in shape.vertices]) if holds(part, x)]
        return any([normal is None or _leads_out(part, normal) for part in parts])
    middle = point(shape.base if isinstance(shape, geometry.Cylinder) else shape.center)
    ray, radius, slack = minus(x, middle), exact(shape.radius), DOUBT * _largest((middle,), x)
    match shape:
        case geometry.Disk():
            axis = point(shape.normal)
            level = normal is not None and (dot(axis, normal) == 0 or not any(cross(axis, normal)))
            return not level and not _more(dot(axis, ray), slack, axis) and bool(dot(ray, ray) <= (radius + slack) ** 2)
        case geometry.Cylinder():
            return _on_cylinder(shape, ray, radius, slack)
    return bool((radius - slack) ** 2 <= dot(ray, ray) <= (radius + slack) ** 2)


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
    if not holds(part, x):
        return (part,)
    return _cone(part, x, behind) if _leads_out(part, normal) else ()


def holds(convex: Convex, x: Point) -> bool:
    """Whether a convex polygon, its edges included, holds x but for the rounding of coordinates. Raises CannotCertify where
    that is in doubt, and for x on the polygon where it is whether that is on an edge."""
    front, largest = area_vector(convex), _largest(convex, x)
    edges = [minus(end, start) for start, end in _edges(convex)]
    inwards = [dot(front, cross(edge, minus(x, start))) for edge, start in zip(edges, convex, strict=True)]
    if any(inward < 0 and _more(inward, DOUBT * largest, front, edge) for inward, edge in zip(inwards, edges, strict=True)):
        return False
    if _sure(dot(front, minus(x, convex[0])), largest, front):
        return False
    beyond = [_sure(inward, largest, front, edge) and inward < 0 for inward, edge in zip(inwards, edges, strict=True)]
    return not any(beyond)


def _leads_out(convex: Convex, normal: Point) -> bool:
    """Whether a normal leads out of a polygon's plane, but for rounding. Raises CannotCertify where that is in doubt."""
    front = area_vector(convex)
    return _sure(dot(front, normal), exact(1), front, normal)


def _largest(points: Iterable[Point], x: Point) -> Number:
    """The largest coordinate."""
    return max(abs(number) for corner in (*points, x) for number in corner)


def _sure(value: Number, scale: Number, *vectors: Point) -> bool:
    """Whether a value, over the lengths of the vectors, is more than rounding of numbers as large as `scale`. Raises
    CannotCertify where that is in doubt."""
    more = _more(value, ROUNDING * scale, *vectors)
    if more != _more(value, DOUBT * scale, *vectors):
        raise CannotCertify("a receiver is on a polygon, or on its edge, to 1e-14 of the coordinates but not to 1e-15; move it")
    return more


def _more(value: Number, slack: Number, *vectors: Point) -> bool:
    """Whether a value exceeds `slack` times the lengths of the vectors."""
    return bool(value**2 > slack**2 * prod(dot(vector, vector) for vector in vectors))


def _cone(convex: Convex, x: Point, behind: Iterator[Point]) -> tuple[Convex, ...]:
    slack = ROUNDING * _largest(convex, x)
    return tuple((start, end, next(behind)) for start, end in _edges(convex) if _apart(x, start, end, slack))


def _apart(x: Point, start: Point, end: Point, slack: Number) -> bool:
    """Whether x is farther than `slack` from a line."""
    aside, edge = cross(minus(start, x), minus(end, x)), minus(end, start)
    return bool(dot(aside, aside) > slack**2 * dot(edge, edge))


def _edges(convex: Convex) -> Iterable[tuple[Point, Point]]:
    return zip(convex, (*convex[1:], convex[0]), strict=True)


def _on_cylinder(shape: geometry.Cylinder, ray: Point, radius: Number, slack: Number) -> bool:
    axis = point(shape.axis)
    aside, square, along = cross(ray, axis), dot(axis, axis), dot(ray, axis)
    on = (radius - slack) ** 2 * square <= dot(aside, aside) <= (radius + slack) ** 2 * square
    length = root(square)
    return bool(on and not arb(along) < -slack * length and not arb(along) > (exact(shape.height) + slack) * length)
