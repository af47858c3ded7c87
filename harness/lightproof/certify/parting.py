"""Which of two shapes is nearer: a plane between them tells, for every ray that meets both."""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce

from lightproof import geometry
from lightproof.certify import planes
from lightproof.certify.balls import CannotCertify, Number, Point, cross, dot, exact, exact_root, minus, plus, point, times
from lightproof.certify.planes import Plane
from lightproof.certify.polygon import area_vector

Solid = tuple[Point, ...] | geometry.Disk | geometry.Sphere | geometry.Cylinder  # a polygon by its exact corners


def solid(shape: geometry.Shape) -> Solid:
    """A shape with a polygon's corners exact. Raises CannotCertify."""
    if isinstance(shape, geometry.Polygon):
        return tuple(point(corner) for corner in shape.vertices)
    if isinstance(shape, geometry.Disk | geometry.Sphere | geometry.Cylinder):
        return shape
    raise CannotCertify(f"a {type(shape).__name__.lower()} as a light, or before one, is not covered")


def extent(shape: Solid, along: Point) -> tuple[Number, Number]:
    """The least and the greatest along . y over the points y of a shape; rational where they are."""
    match shape:
        case tuple():
            heights = [dot(along, corner) for corner in shape]
            return min(heights), max(heights)
        case geometry.Disk():
            return _round(dot(along, point(shape.center)), shape.radius, _across(along, point(shape.normal)))
        case geometry.Sphere():
            return _round(dot(along, point(shape.center)), shape.radius, dot(along, along))
    axis = point(shape.axis)
    low, high = _round(dot(along, point(shape.base)), shape.radius, _across(along, axis))
    rise = exact(shape.height) * dot(along, axis) / exact_root(dot(axis, axis))
    return (low, high + rise) if dot(along, axis) > 0 else (low + rise, high)


def _round(middle: Number, radius: float, square: Number) -> tuple[Number, Number]:
    reach = exact(radius) * exact_root(square)
    return middle - reach, middle + reach


def _across(along: Point, axis: Point) -> Number:
    """The squared length of what of a vector is across an axis."""
    side = cross(along, axis)
    return dot(side, side) / dot(axis, axis)


def face(shape: Solid) -> Plane | None:
    """The plane of a flat shape, in front of its front; None for others."""
    match shape:
        case tuple():
            return planes.of(shape)
        case geometry.Disk():
            normal = point(shape.normal)
            return Plane(normal, dot(normal, point(shape.center)))
    return None


def below(shape: Solid, plane: Plane) -> bool:
    """Whether no part of a shape is known to be in front of a plane."""
    return bool(extent(shape, plane.normal)[1] <= plane.offset)


def above(shape: Solid, plane: Plane) -> bool:
    """Whether all of a shape is known to be in front of a plane, or on it."""
    return bool(extent(shape, plane.normal)[0] >= plane.offset)


def in_front(blocker: Solid, light: Solid, receiver: Point) -> bool | None:
    """Whether a ray from the receiver that meets both meets the blocker first; None where no plane that is tried parts them."""
    for along in _directions(blocker, light):
        for way in (along, times(along, -1)):
            (_, end), (start, _) = extent(blocker, way), extent(light, way)
            if end <= start:
                return bool(dot(way, receiver) <= start)
    return None


def _directions(a: Solid, b: Solid) -> Iterator[Point]:
    """Normals of planes that may part two shapes."""
    apart = minus(middle(a), middle(b))
    axes = [axis for shape in (b, a) for axis in _axes(shape)]
    yield from axes
    tried = [apart] + [minus(apart, times(axis, dot(apart, axis) / dot(axis, axis))) for axis in axes]
    tried += [cross(p, q) for p in _edges(a) for q in _edges(b)]
    yield from (along for along in tried if any(along))


def middle(shape: Solid) -> Point:
    """A point in the middle of a shape, or of a cylinder's base."""
    if isinstance(shape, tuple):
        return times(reduce(plus, shape), exact(1) / len(shape))
    return point(shape.base if isinstance(shape, geometry.Cylinder) else shape.center)


def _axes(shape: Solid) -> list[Point]:
    """The normal of a flat shape, the axis of a cylinder."""
    match shape:
        case tuple():
            return [area_vector(shape)]
        case geometry.Disk():
            return [point(shape.normal)]
        case geometry.Cylinder():
            return [point(shape.axis)]
    return []


def _edges(shape: Solid) -> list[Point]:
    """Directions of straight edges."""
    if isinstance(shape, tuple):
        return [minus(b, a) for a, b in zip(shape, (*shape[1:], shape[0]), strict=True)]
    return [point(shape.axis)] if isinstance(shape, geometry.Cylinder) else []
