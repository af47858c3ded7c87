"""Whether a shape stands in the way of a ray: decided exactly, and refused where the ray just touches an edge or an outline."""

from __future__ import annotations

from collections.abc import Sequence

from lightproof import geometry
from lightproof.certify import parting
from lightproof.certify.balls import CannotCertify, Number, Point, cross, dot, exact, exact_root, minus, plus, point, times
from lightproof.certify.caps import sign
from lightproof.certify.field import Shape

TOUCHES = "a ray from a receiver to a light just touches what stands there: a hard shadow has no value on its edge"


def blocked(shape: Shape, x: Point, ray: Point, last: Number | None) -> bool:
    """Whether x + t ray meets a shape for some t from 0 to `last`, or beyond all bounds where that is None; at x itself nothing
    is met. Raises CannotCertify on edges."""
    match shape:
        case geometry.Polygon() | geometry.Disk():
            return _meets_flat(shape, x, ray, last)
        case geometry.Sphere():
            return _meets_sphere(shape, x, ray, last)
        case geometry.Cylinder():
            return _meets_cylinder(shape, x, ray, last)
    raise CannotCertify(f"a {type(shape).__name__.lower()} before a point light or a beam is not covered")


def lies_on(shape: Shape, y: Point) -> bool:
    """Whether a point lies on a flat shape."""
    if not isinstance(shape, geometry.Polygon | geometry.Disk):
        return False
    face = parting.face(parting.solid(shape))
    return face.height(y) == 0 and _side_of_rim(shape, face.normal, y) >= 0


def _meets_flat(shape: geometry.Polygon | geometry.Disk, x: Point, ray: Point, last: Number | None) -> bool:
    face = parting.face(parting.solid(shape))
    slope, height = dot(face.normal, ray), face.height(x)
    if slope == 0:
        return False
    reach = -height / slope
    if reach <= 0 or (last is not None and reach > last):
        return False
    side = _side_of_rim(shape, face.normal, plus(x, times(ray, reach)))
    if side == 0:
        raise CannotCertify(TOUCHES)
    return side > 0


def _side_of_rim(shape: geometry.Polygon | geometry.Disk, normal: Point, y: Point) -> int:
    """1 where a point of a flat shape's plane is inside, -1 where it is outside, 0 on the rim."""
    if isinstance(shape, geometry.Disk):
        apart = minus(y, point(shape.center))
        return sign(exact(shape.radius) ** 2 - dot(apart, apart))
    corners = [point(corner) for corner in shape.vertices]
    return _winding(corners, normal, y)


def _winding(corners: Sequence[Point], normal: Point, y: Point) -> int:
    """1 inside a simple polygon, -1 outside, 0 on it: an odd number of edges is crossed on the way out along an axis."""
    k = max(range(3), key=lambda axis: abs(normal[axis]))
    i, j = (k + 1) % 3, (k + 2) % 3
    inside = -1
    for a, b in zip(corners, (*corners[1:], corners[0]), strict=True):
        turn = (b[i] - a[i]) * (y[j] - a[j]) - (b[j] - a[j]) * (y[i] - a[i])
        if turn == 0 and min(a[i], b[i]) <= y[i] <= max(a[i], b[i]) and min(a[j], b[j]) <= y[j] <= max(a[j], b[j]):
            return 0
        if (a[j] > y[j]) != (b[j] > y[j]) and (turn > 0) == (b[j] > a[j]):
            inside = -inside
    return inside


def _meets_sphere(sphere: geometry.Sphere, x: Point, ray: Point, last: Number | None) -> bool:
    apart = minus(x, point(sphere.center))
    square = dot(apart, apart) - exact(sphere.radius) ** 2
    return _has_root((dot(ray, ray), dot(apart, ray), square), exact(0), last)


def _meets_cylinder(cylinder: geometry.Cylinder, x: Point, ray: Point, last: Number | None) -> bool:
    """The lateral face: the quadratic of the infinite cylinder has a root where the ray is between the two ends."""
    axis, apart = point(cylinder.axis), minus(x, point(cylinder.base))
    aside, along = cross(apart, axis), cross(ray, axis)
    form = dot(along, along), dot(aside, along), dot(aside, aside) - exact(cylinder.radius) ** 2 * dot(axis, axis)
    span = _between_ends(dot(apart, axis), dot(ray, axis), exact(cylinder.height) * exact_root(dot(axis, axis)), last)
    return span is not None and form[0] != 0 and _has_root(form, *span)


def _between_ends(start: Number, slope: Number, top: Number, last: Number | None) -> tuple[Number, Number | None] | None:
    """For which t from 0 to `last` a height start + t slope is between 0 and top; None where it never is."""
    if slope == 0:
        if sign(start) * sign(top - start) == 0:
            raise CannotCertify(TOUCHES)
        return (exact(0), last) if start > 0 and sign(top - start) > 0 else None
    low, high = (-start / slope, (top - start) / slope) if slope > 0 else ((top - start) / slope, -start / slope)
    low = low if sign(low) > 0 else exact(0)
    high = high if last is None or sign(last - high) > 0 else last
    return (low, high) if sign(high - low) > 0 else None


def _has_root(form: tuple[Number, Number, Number], low: Number, high: Number | None) -> bool:
    """Whether a t^2 + 2 b t + c, a > 0, has a root between two ends; one at 0 is where the ray starts, and does not count."""
    a, b, c = form
    at_low, at_high = (sign(a * t * t + 2 * b * t + c) if t is not None else 1 for t in (low, high))
    if at_high == 0 or (at_low == 0 and low != 0):
        raise CannotCertify(TOUCHES)
    if at_low == 0:
        return sign(b) < 0 and at_high > 0
    if at_low < 0 or at_high < 0:
        return at_low != at_high
    if sign(-b - a * low) <= 0 or (high is not None and sign(-b - a * high) >= 0):
        return False
    if sign(b * b - a * c) == 0:
        raise CannotCertify(TOUCHES)
    return sign(b * b - a * c) > 0
