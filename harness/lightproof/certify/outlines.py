"""How a receiver, which is the origin here, sees a shape: as an outline of circles on its sphere of directions.

A polygon's edges are seen on great circles and a disk's rim on itself. A sphere is seen as its polar disk, on whose rim the
rays touch it. For cylinders see `walls`.
"""

from __future__ import annotations

from flint import fmpq

from lightproof import geometry
from lightproof.certify.arrangement import EVERYTHING, NOTHING, Outline, Side
from lightproof.certify.balls import CannotCertify, Point, Rational, Vector, cross, dot, exact, minus, point, times
from lightproof.certify.circles import Great, Rim
from lightproof.certify.parting import Solid
from lightproof.certify.polygon import area_vector, convex_parts
from lightproof.certify.walls import Wall


def seen(shape: Solid, receiver: Point) -> Outline:
    """The directions in which a shape is seen, its back and its inside too. Raises CannotCertify."""
    match shape:
        case tuple():
            return polygon([minus(corner, receiver) for corner in shape])
        case geometry.Disk():
            return disk(minus(point(shape.center), receiver), point(shape.normal), exact(shape.radius))
        case geometry.Sphere():
            return sphere(minus(point(shape.center), receiver), exact(shape.radius))
    return Wall.of(shape, receiver).either


def lit(shape: Solid, receiver: Point) -> Outline:
    """The directions in which a light's front is seen. Raises CannotCertify."""
    if isinstance(shape, geometry.Cylinder):
        return Wall.of(shape, receiver).outside
    if isinstance(shape, geometry.Sphere) and seen(shape, receiver) is EVERYTHING:
        raise CannotCertify("a receiver is inside a sphere light, or on it")
    return NOTHING if _behind(shape, receiver) else seen(shape, receiver)


def _behind(shape: Solid, receiver: Point) -> bool:
    """Whether a flat shape turns its back, or its edge, to the receiver."""
    match shape:
        case tuple():
            return bool(dot(area_vector(shape), minus(shape[0], receiver)) >= 0)
        case geometry.Disk():
            return bool(dot(point(shape.normal), minus(point(shape.center), receiver)) >= 0)
    return False


def polygon(corners: list[Point]) -> Outline:
    """A polygon, convex or not; nothing where it is seen edge-on."""
    facing = dot(area_vector(corners), corners[0])
    if facing == 0:
        return NOTHING
    parts = []
    for part in convex_parts(corners if facing > 0 else corners[::-1]):
        ends = (*part[1:], part[0])
        way = 1 if dot(area_vector(part), part[0]) > 0 else -1
        parts.append([Great(times(cross(a, minus(b, a)), way)) for a, b in zip(part, ends, strict=True)])

    def contains(side: Side) -> bool:
        return any(all(map(side, edges)) for edges in parts)

    return Outline(tuple(edge for edges in parts for edge in edges), contains)


def disk(centre: Point, axis: Point, radius: Rational) -> Outline:
    """A disk; nothing where it is seen edge-on."""
    if dot(axis, centre) == 0:
        return NOTHING
    return _inside(Rim.around(centre, axis, radius * radius))


def sphere(centre: Point, radius: Rational) -> Outline:
    """A sphere, from outside, or from inside, where it is all around."""
    square = dot(centre, centre)
    share = 1 - radius * radius / square if square else fmpq(-1)
    if share < 0:
        return EVERYTHING
    if share == 0:
        raise CannotCertify("a receiver is on a sphere")
    return _inside(Rim.around(times(centre, share), centre, radius * radius * share))


def _inside(rim: Rim) -> Outline:
    return Outline((rim,), lambda side: side(rim))


def half(normal: Vector) -> Outline:
    """The directions with normal . d > 0: those above a receiver's horizon."""
    plane = Great(normal)
    return Outline((plane,), lambda side: side(plane))
