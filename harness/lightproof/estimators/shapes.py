"""Shapes as compiled code wants them: named tuples of scalars, dispatched on by type.

A flat shape is an affine map of two parameters: centre + s u + t v, with s and t in [-1/2, 1/2] (parallelogram), in the
unit triangle (triangle, whose `center` is a corner) or in the unit circle (disk). `dual_u`, `dual_v` give s and t back.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof import geometry
from lightproof.estimators.vectors import like, sub, turned
from lightproof.geometry import Vec3

COINCIDES = 2e-15  # of a distance: what lies no higher over a plane lies in it, but for rounding, and sees nothing of it
PARALLEL = 1e-12  # of a quadrilateral's size: how far its fourth corner may be off and still count as a parallelogram's


class Parallelogram(NamedTuple):
    """center + s u + t v, s and t in [-1/2, 1/2]."""

    center: Vec3
    u: Vec3
    v: Vec3
    normal: Vec3
    dual_u: Vec3
    dual_v: Vec3


class Triangle(NamedTuple):
    """center + s u + t v, s and t at least 0, s + t at most 1."""

    center: Vec3
    u: Vec3
    v: Vec3
    normal: Vec3
    dual_u: Vec3
    dual_v: Vec3


class Disk(NamedTuple):
    """center + s u + t v, s^2 + t^2 at most 1."""

    center: Vec3
    u: Vec3
    v: Vec3
    normal: Vec3
    dual_u: Vec3
    dual_v: Vec3


class Sphere(NamedTuple):
    """The outside of a sphere."""

    center: Vec3
    radius: float


class Cap(NamedTuple):
    """What of a sphere lies within the angle of this `cosine` of the unit vector `axis`, as seen from its centre."""

    center: Vec3
    radius: float
    axis: Vec3
    cosine: float


Flat = Parallelogram | Triangle | Disk
PER_PARAMETER = {Parallelogram: 1.0, Triangle: 0.5, Disk: np.pi}  # area of the parameters' domain


def parts(shape: geometry.Shape) -> list[Flat | Sphere | Cap]:
    """A shape of the scene, in pieces. Raises TypeError on a cylinder."""
    return [piece for piece, _ in cornered(shape)]


def cornered(shape: geometry.Shape) -> list[tuple[Flat | Sphere | Cap, np.ndarray | None]]:
    """A shape of the scene, in pieces, those of a polygon with their corners. Raises TypeError on a cylinder."""
    match shape:
        case geometry.Polygon():
            return [(over(corners), corners) for corners in facets(shape)]
        case geometry.Disk():
            t, b = geometry.tangents(np.array(shape.normal))
            return [(flat(Disk, np.array(shape.center), shape.radius * t, shape.radius * b), None)]
        case geometry.Sphere():
            return [(Sphere(shape.center, shape.radius), None)]
        case geometry.Cap():
            axis = tuple(map(float, geometry.unit(shape.axis)))
            return [(Cap(shape.center, shape.radius, axis, float(np.cos(np.radians(shape.half_angle)))), None)]
    raise TypeError(f"no pieces for a {type(shape).__name__}")


def facets(polygon: geometry.Polygon) -> list[np.ndarray]:
    """Corners of a polygon's pieces: of one parallelogram (4, 3) where they make one, else of triangles (3, 3); of no piece
    where they hold no area."""
    corners = np.array(polygon.vertices)
    if not geometry.vector_area(corners).any():
        return []
    if len(corners) == 4 and np.abs(corners[0] - corners[1] + corners[2] - corners[3]).max() <= PARALLEL * np.ptp(corners):
        return [corners]
    return triangulated(corners)


def over(corners: np.ndarray) -> Flat:
    """The parallelogram or triangle with these corners."""
    u, v = corners[1] - corners[0], corners[-1] - corners[0]
    if len(corners) == 4:
        return flat(Parallelogram, (corners[0] + corners[2]) / 2, u, v)
    return flat(Triangle, corners[0], u, v)


def triangulated(corners: np.ndarray) -> list[np.ndarray]:
    """Triangles (3, 3) of a simple polygon, with its orientation: ears cut off one by one."""
    normal = geometry.unit(geometry.vector_area(corners))
    left, triangles = list(range(len(corners))), []
    while len(left) > 3:
        ear = next(i for i in range(len(left)) if is_ear(corners, left, i, normal))
        triangles.append(corners[[left[ear - 1], left[ear], left[(ear + 1) % len(left)]]])
        del left[ear]
    return [*triangles, corners[left]]


def is_ear(corners: np.ndarray, left: list[int], i: int, normal: np.ndarray) -> bool:
    """Whether the corner `left[i]` turns left and its triangle holds none of the other corners."""
    a, b, c = corners[left[i - 1]], corners[left[i]], corners[left[(i + 1) % len(left)]]
    others = [corners[k] for k in left if k not in (left[i - 1], left[i], left[(i + 1) % len(left)])]

    def turn(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> float:
        return float(np.cross(q - p, r - p) @ normal)

    return turn(a, b, c) > 0 and not any(min(turn(a, b, p), turn(b, c, p), turn(c, a, p)) >= 0 for p in others)


def flat(kind: type, center: np.ndarray, u: np.ndarray, v: np.ndarray) -> Flat:
    """A flat shape from its map; the dual vectors are the rows of the pseudo-inverse of [u v]."""
    dual_u, dual_v = np.linalg.pinv(np.stack([u, v], axis=1))
    return kind(*(tuple(map(float, w)) for w in (center, u, v, geometry.unit(np.cross(u, v)), dual_u, dual_v)))


def area(shape: Flat | Sphere | Cap) -> float:
    """Area [m2]."""
    if isinstance(shape, Cap):
        return float(2 * np.pi * shape.radius**2 * (1 - shape.cosine))
    if isinstance(shape, Sphere):
        return float(4 * np.pi * shape.radius**2)
    return float(np.linalg.norm(np.cross(shape.u, shape.v))) * PER_PARAMETER[type(shape)]


def placed(shape, origin, frame, model):
    """The shape seen from `origin` along the axes of `frame`, subtracted in float64, then in the precision of `model`."""


@overload(placed)
def _placed(shape, origin, frame, model):
    return placed_sphere if shape.instance_class is Sphere else PLACED.get(shape.instance_class)


def placed_sphere(shape, origin, frame, model):
    return Sphere(turned(sub(shape.center, origin), frame, model), like(model, shape.radius))


def _placed_flat(kind):
    def place(shape, origin, frame, model):
        return kind(
            turned(sub(shape.center, origin), frame, model),
            turned(shape.u, frame, model),
            turned(shape.v, frame, model),
            turned(shape.normal, frame, model),
            turned(shape.dual_u, frame, model),
            turned(shape.dual_v, frame, model),
        )

    return place


PLACED = {kind: _placed_flat(kind) for kind in (Parallelogram, Triangle, Disk)}


def covers(shape, a, b):
    """Whether a, b are parameters of a point of the flat shape."""


@overload(covers)
def _covers(shape, a, b):
    return {
        Parallelogram: lambda shape, a, b: (abs(a) <= like(a, 0.5)) & (abs(b) <= like(a, 0.5)),
        Triangle: lambda shape, a, b: (a >= like(a, 0)) & (b >= like(a, 0)) & (a + b <= like(a, 1)),
        Disk: lambda shape, a, b: a * a + b * b <= like(a, 1),
    }[shape.instance_class]


def support(part: Flat | Sphere, direction: np.ndarray) -> np.ndarray:
    """The largest coordinate along each `direction` (..., 3), unit vectors, of any point of the part (...) [m]."""
    center = np.dot(direction, part.center)
    if isinstance(part, Sphere):
        return center + part.radius
    s, t = np.dot(direction, part.u), np.dot(direction, part.v)
    reaches = {Parallelogram: (np.abs(s) + np.abs(t)) / 2, Triangle: np.maximum(np.maximum(s, t), 0), Disk: np.hypot(s, t)}
    return center + reaches[type(part)]
