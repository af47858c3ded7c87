"""How far shapes of every kind reach in a direction, and whether a plane parts two of them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product

import numpy as np

from lightproof import geometry
from lightproof.estimators.blockers import Plane
from lightproof.estimators.extents import CONTACT
from lightproof.estimators.flats import convex_parts
from lightproof.geometry import Cylinder, Disk, Polygon, Shape, Vec3
from lightproof.scene import AreaLight, Surface


def plane_of(shape: Polygon | Disk) -> Plane:
    if isinstance(shape, Polygon):
        return np.array(shape.vertices[0]), shape.normal
    return np.array(shape.center), geometry.unit(shape.normal)


def reaches(shape: Shape, point: np.ndarray, normal: np.ndarray) -> bool:
    """Whether any of a shape lies in front of a plane."""
    level = float(point @ normal)
    return support(shape, normal) - level > CONTACT * (abs(level) + size(shape))


def support(shape: Shape, direction: np.ndarray) -> float:
    """The largest coordinate along a unit vector of any point of a shape, of a cap's whole sphere [m]."""
    match shape:
        case Polygon():
            return float((np.array(shape.vertices) @ direction).max())
        case Disk():
            return float(np.dot(shape.center, direction)) + shape.radius * across(shape.normal, direction)
        case Cylinder():
            rise = shape.height * float(geometry.unit(shape.axis) @ direction)
            return float(np.dot(shape.base, direction)) + max(rise, 0.0) + shape.radius * across(shape.axis, direction)
    return float(np.dot(shape.center, direction)) + shape.radius


def across(axis: Vec3, direction: np.ndarray) -> float:
    """Sine of the angle between two directions."""
    return float(np.linalg.norm(np.cross(geometry.unit(axis), direction)))


def size(shape: Shape) -> float:
    """The largest coordinate [m]."""
    return max(abs(support(shape, sign * axis)) for axis in np.eye(3) for sign in (-1, 1))


def crossing(things: list[AreaLight | Surface]) -> str | None:
    """Why a look around may not tell which of two things is in front: no plane through one's faces or edges parts them."""
    for one, other in combinations(things, 2):
        if not all(apart(*pair) for pair in product(convex(one.shape), convex(other.shape))):
            return f"'{one.id}' and '{other.id}' may cut through each other, which shadows of curved shapes and in skies may not"
    return None


def convex(shape: Shape) -> list[Shape]:
    """Convex parts of a shape."""
    return [Polygon(tuple(map(tuple, part.tolist()))) for part in convex_parts(shape)] if isinstance(shape, Polygon) else [shape]


def apart(one: Shape, other: Shape) -> bool:
    return any(parts_them(one, other, direction) for direction in directions(one, other))


def parts_them(one: Shape, other: Shape, direction: np.ndarray) -> bool:
    slack = CONTACT * (size(one) + size(other))
    return any(support(one, side) + support(other, -side) <= slack for side in (direction, -direction))


def directions(one: Shape, other: Shape) -> Iterator[np.ndarray]:
    """Unit normals of planes that may part two shapes."""
    yield from np.eye(3)
    spokes = [middle(other) - middle(one)]
    for shape, partner in ((one, other), (other, one)):
        normal, sides = faces(shape)
        spokes += [normal, *(np.cross(normal, side) for side in sides)]
        spokes += [np.cross(a, b) for a in sides for b in faces(partner)[1]]
        if isinstance(shape, Polygon):
            spokes += [np.array(corner) - middle(partner) for corner in shape.vertices]
    yield from (geometry.unit(spoke) for spoke in spokes if np.abs(spoke).any())


def middle(shape: Shape) -> np.ndarray:
    match shape:
        case Polygon():
            return np.mean(shape.vertices, axis=0)
        case Cylinder():
            return np.array(shape.base) + shape.height / 2 * geometry.unit(shape.axis)
    return np.array(shape.center)


def faces(shape: Shape) -> tuple[np.ndarray, list[np.ndarray]]:
    """A normal or an axis, and the directions of straight sides."""
    match shape:
        case Polygon():
            return shape.normal, list(np.roll(shape.vertices, -1, axis=0) - np.array(shape.vertices))
        case Disk():
            return geometry.unit(shape.normal), []
        case Cylinder():
            return geometry.unit(shape.axis), [geometry.unit(shape.axis)]
    return np.zeros(3), []
