"""Shapes and frames, in metres; right-handed, z up. Pure functions on arrays."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import combinations

import numpy as np

from lightproof.checked import SHORTEST, Checked, SceneError, direction, length, number, vector, vectors

Vec3 = tuple[float, float, float]

PLANARITY = 1e-9  # of a polygon's size: how far a vertex may lie off its plane
SLIVER = 1e-15  # of a polygon's size squared: what has no more area than this has none
FRAME = 1e-9  # sine of the smallest angle between two directions that still span a plane


@dataclass(frozen=True)
class Polygon(Checked):
    """A planar, simple polygon; its front is the side from which the vertices run counter-clockwise."""

    TAG = ("type", "polygon")

    vertices: tuple[Vec3, ...] = vectors(least=3)

    def check(self) -> None:
        corners = np.array(self.vertices)
        size = float(np.ptp(corners, axis=0).max())
        if 0 < size < SHORTEST:
            raise SceneError("vertices", f"the polygon is {size:.3g} m wide; at least {SHORTEST:g} m is accepted")
        if self.is_degenerate:
            return
        if self.area <= SLIVER * size**2:
            raise SceneError("vertices", "the polygon has no area, yet is no line: its edges cross; give a simple polygon")
        flat = (corners - corners[0]) / size
        offsets = np.abs(flat @ self.normal) if len(corners) > 3 else np.zeros(3)
        if offsets.max() > PLANARITY:
            index = int(offsets.argmax())
            raise SceneError("vertices", f"vertex {index} lies {offsets[index] * size:.3g} m off the plane of the others;"
                                         f" at most {PLANARITY * size:.3g} m is accepted")
        crossing = self_intersection(flat, self.normal)
        if crossing:
            raise SceneError("vertices", "edges {} and {} cross or touch; give a simple polygon".format(*crossing))

    @property
    def normal(self) -> np.ndarray:
        """Unit normal of the front, (3,)."""
        return unit(self._vector_area)

    @property
    def area(self) -> float:
        """Area [m2]."""
        return math.hypot(*self._vector_area)

    @property
    def is_degenerate(self) -> bool:
        """Whether all vertices lie on one line, so that it has no area."""
        corners = np.array(self.vertices)
        spokes = corners - corners[0]
        longest = spokes[np.abs(spokes).max(axis=1).argmax()]
        return bool(np.abs(np.cross(spokes, longest)).max() <= SLIVER * np.abs(longest).max() ** 2)

    @cached_property
    def _vector_area(self) -> np.ndarray:
        """As `vector_area`, in exact numbers: that of a sliver cancels."""
        corners = np.array([[Fraction(component) for component in vertex] for vertex in self.vertices])
        return vector_area(corners).astype(float)


@dataclass(frozen=True)
class Disk(Checked):
    """A flat disk; its front is the side to which `normal` points."""

    TAG = ("type", "disk")

    center: Vec3 = vector()
    normal: Vec3 = direction()
    radius: float = length()

    @property
    def area(self) -> float:
        """Area [m2]."""
        return float(np.pi * self.radius**2)


@dataclass(frozen=True)
class Sphere(Checked):
    """A sphere; its front is the outside unless a surface says `side = "inside"`."""

    TAG = ("type", "sphere")

    center: Vec3 = vector()
    radius: float = length()

    @property
    def area(self) -> float:
        """Area [m2]."""
        return float(4 * np.pi * self.radius**2)


@dataclass(frozen=True)
class Cylinder(Checked):
    """The lateral face of a circular cylinder from `base` along `axis`; no end caps."""

    TAG = ("type", "cylinder")

    base: Vec3 = vector()
    axis: Vec3 = direction()
    height: float = length()
    radius: float = length()

    @property
    def area(self) -> float:
        """Area of the lateral face [m2]."""
        return float(2 * np.pi * self.radius * self.height)


@dataclass(frozen=True)
class Cap(Checked):
    """The part of a sphere within `half_angle` [degrees] of `axis`, as seen from its centre; its front is the outside unless a
    surface says `side = "inside"`."""

    TAG = ("type", "cap")

    center: Vec3 = vector()
    radius: float = length()
    axis: Vec3 = direction()
    half_angle: float = number(above=0, below=180)

    @property
    def area(self) -> float:
        """Area [m2]."""
        return float(4 * np.pi * (self.radius * np.sin(np.radians(self.half_angle) / 2)) ** 2)

    def completes(self, other: Cap) -> bool:
        """Whether the two are exactly a whole sphere, each point of it once."""
        a, b = ([Fraction(component) for component in cap.axis] for cap in (self, other))
        opposite = all(a[i - 1] * b[i] == a[i] * b[i - 1] for i in range(3)) and sum(x * y for x, y in zip(a, b, strict=True)) < 0
        whole = Fraction(self.half_angle) + Fraction(other.half_angle) == 180
        return opposite and whole and (self.center, self.radius) == (other.center, other.radius)


Shape = Polygon | Disk | Sphere | Cylinder | Cap
SHAPES: dict[str, type] = {shape.TAG[1]: shape for shape in (Polygon, Disk, Sphere, Cylinder, Cap)}


def unit(v: np.ndarray) -> np.ndarray:
    """`v` (..., 3) scaled to unit length; scaled by its largest component first, so that no square over- or underflows."""
    v = np.asarray(v, float)
    v = v / np.abs(v).max(axis=-1, keepdims=True)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def vector_area(corners: np.ndarray) -> np.ndarray:
    """Vector area (3,) [m2] of a polygon with vertices (n, 3): length = area, direction = front normal (Newell)."""
    spokes = corners[1:] - corners[0]
    return np.cross(spokes[:-1], spokes[1:]).sum(axis=0) / 2


def tangents(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two unit vectors t, b with t x b = unit normal (Duff et al. 2017, "Building an orthonormal basis, revisited")."""
    x, y, z = unit(normal)
    sign = np.copysign(1.0, z)
    a = -1 / (sign + z)
    b = x * y * a
    return np.array([1 + sign * x * x * a, sign * b, -sign * x]), np.array([b, sign + y * y * a, -y])


def camera_frame(origin: Vec3, target: Vec3, up: Vec3) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit vectors right, up, forward of a pinhole camera; columns run along right, rows against up.

    Raises SceneError where the view direction is zero or parallel to `up`.
    """
    view = np.subtract(target, origin)
    if not view.any():
        raise SceneError("target", "the camera looks at its own origin; give a target elsewhere")
    forward = unit(view)
    right = np.cross(forward, unit(up))
    if np.linalg.norm(right) < FRAME:
        raise SceneError("up", "up is parallel to the view direction; give an up that is not")
    right = unit(right)
    return right, np.cross(right, forward), forward


def self_intersection(corners: np.ndarray, normal: np.ndarray) -> tuple[int, int] | None:
    """The first pair of polygon edges that cross or touch though they are not neighbours, or None."""
    t, b = tangents(normal)
    flat = (corners - corners[0]) @ np.stack([t, b], axis=1)
    ends = np.roll(flat, -1, axis=0)
    count = len(flat)
    for first, second in combinations(range(count), 2):
        neighbours = second == first + 1 or (first == 0 and second == count - 1)
        if not neighbours and segments_meet(flat[first], ends[first], flat[second], ends[second]):
            return first, second
    return None


def segments_meet(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> bool:
    """Whether the closed plane segments ab and cd share a point; all (2,)."""
    if (np.minimum(a, b) > np.maximum(c, d)).any() or (np.minimum(c, d) > np.maximum(a, b)).any():
        return False
    return turn(a, b, c) * turn(a, b, d) <= 0 and turn(c, d, a) * turn(c, d, b) <= 0


def turn(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> float:
    """Twice the signed area of the plane triangle abc: positive where it turns left."""
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
