"""The largest value that one sample of a light can have. Of its area, L A cos(theta_x) cos(theta_y) / d^2: it grows without
bound as a receiver comes close. Of directions into it, twice its solid angle at most. Bounds from the geometry alone, for
elements with and without extent.

`rows` (n, 15) are elements as `elements` has them.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import singledispatch

import numpy as np

from lightproof.estimators.aims import Aim
from lightproof.estimators.elements import CELL, CENTER, NORMAL
from lightproof.estimators.lamps import Beam, Lamp, Point
from lightproof.estimators.parallel import Level
from lightproof.estimators.shapes import Disk, Flat, Sphere, Triangle, area, support
from lightproof.estimators.views import COVERS, View


def peaks(view: View, sources: Sequence[object]) -> np.ndarray | None:
    """The `peak` of each source, (sources, n); None where one is not known."""
    found = [peak(view, source) for source in sources]
    return np.array(found) if found and not any(one is None for one in found) else None


def largest(bounds: np.ndarray | None, shares: Sequence[float]) -> np.ndarray | None:
    """What one sample of a film can add at most (n,), where each source has a share of the samples (sources,), and a single one
    all of them; None where the `bounds` on sources (sources, n) are not known."""
    if bounds is None:
        return None
    return bounds[0] if len(bounds) == 1 else (bounds / np.array(shares)[:, None]).max(axis=0)


def peak(view: View, source: object) -> np.ndarray | None:
    """Bound (n,) on one sample of a source, per element [unit of the film]: infinite where an element touches the light, None
    where the source is no light that is aimed at, and where a camera's perspective stretches the elements."""
    if view.slopes is not None or not isinstance(source, Lamp | Level | Aim | Point | Beam):
        return None
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        values = of_source(source, view.receivers)
    return view.factor * source.strength * np.where(np.isnan(values), 0, values)  # 0/0: it touches what it does not see


def of_source(source: Lamp | Level | Aim | Point | Beam, rows: np.ndarray) -> np.ndarray:
    """The bound for a `strength` of 1."""
    if isinstance(source, Aim):
        return of_angle(source.shape, rows)
    if isinstance(source, Beam):
        return np.ones(len(rows))
    if isinstance(source, Point):
        return nearest(np.linalg.norm(rows[:, CENTER] - source.position, axis=1), rows) ** -2.0
    return of_shape(source.shape, rows)


def of_angle(shape: Flat | Sphere, rows: np.ndarray) -> np.ndarray:
    """Twice the solid angle, half a sphere at most, with the receiver's cosine: no domain draws less densely."""
    whole = of_shape(shape, rows) * (1 if isinstance(shape, Sphere) else area(shape))
    return 2 * np.minimum(whole, 2 * np.pi)


@singledispatch
def of_shape(shape: Flat, rows: np.ndarray) -> np.ndarray:
    """min(1, h/d) min(1, H/d) / d^2 of a flat light: d is the distance, h the receiver's height over the light's plane, H the
    light's over the receiver's."""
    middle, half = (rows[:, CENTER] - shape.center) @ shape.normal, half_height(rows, np.array(shape.normal))
    distances = np.maximum(nearest(distance(shape, rows[:, CENTER]), rows), middle - half)
    return cosine(middle + half, distances) * cosine(rise(shape, rows), distances) / distances**2


@of_shape.register
def _(shape: Sphere, rows: np.ndarray) -> np.ndarray:
    """2 pi R^2 / (r d) min(1, H/d), d = r - R: the cap that faces the receiver over the square of the distance."""
    distances = nearest(np.linalg.norm(rows[:, CENTER] - shape.center, axis=1) - shape.radius, rows)
    caps = 2 * np.pi * shape.radius**2 / ((distances + shape.radius) * distances)
    return caps * cosine(rise(shape, rows), distances)


def half_height(rows: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Half of the length of each element along a direction [m]."""
    (a, b, c), t, s = rows[:, CELL].T, rows[:, 3:6] @ normal, rows[:, 6:9] @ normal
    return (np.abs(a * t) + np.abs(b * t + c * s)) / 2


def nearest(distances: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """The least distance that any point of each element can have whose centre has `distances` [m]."""
    a, b, c = rows[:, CELL].T
    reach = np.maximum(np.hypot(a + b, c), np.hypot(a - b, c)) / 2
    return np.maximum(distances - reach, 0)


def rise(shape: Flat | Sphere, rows: np.ndarray) -> np.ndarray:
    """The greatest height of a light over each receiver's plane [m]."""
    return support(shape, rows[:, NORMAL]) - (rows[:, CENTER] * rows[:, NORMAL]).sum(axis=1)


def cosine(height: np.ndarray, distance: np.ndarray) -> np.ndarray:
    """The most that the cosine can be of what is so high and so far."""
    return np.clip(height / distance, 0, 1)


def distance(shape: Flat, x: np.ndarray) -> np.ndarray:
    """Distance (n,) of points (n, 3) from a flat shape [m]."""
    offsets = x - np.array(shape.center)
    heights = offsets @ shape.normal
    if isinstance(shape, Disk):
        beside = np.linalg.norm(offsets - heights[:, None] * shape.normal, axis=1) - np.linalg.norm(shape.u)
        return np.hypot(heights, np.maximum(beside, 0))
    over = COVERS[type(shape)](offsets @ shape.dual_u, offsets @ shape.dual_v)
    return np.where(over, np.abs(heights), from_border(shape, x))


def from_border(shape: Flat, x: np.ndarray) -> np.ndarray:
    """Distance (n,) of points (n, 3) from the border of a flat shape [m]."""
    offsets = x - np.array(shape.center)
    if isinstance(shape, Disk):
        heights = offsets @ shape.normal
        beside = np.linalg.norm(offsets - heights[:, None] * shape.normal, axis=1) - np.linalg.norm(shape.u)
        return np.hypot(heights, beside)
    return np.min([from_edge(offsets, *edge) for edge in edges(shape)], axis=0)


def edges(shape: Flat) -> list[tuple[np.ndarray, np.ndarray]]:
    """Start, counted from the shape's centre, and vector of every edge of a triangle or a parallelogram."""
    u, v = np.array(shape.u), np.array(shape.v)
    if isinstance(shape, Triangle):
        return [(0 * u, u), (u, v - u), (v, -v)]
    start = -(u + v) / 2
    return [(start, u), (start + u, v), (start + u + v, -u), (start + v, -v)]


def from_edge(x: np.ndarray, start: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Distance (n,) of points (n, 3) from an edge [m]."""
    share = np.clip((x - start) @ along / (along @ along), 0, 1)
    return np.linalg.norm(x - start - share[:, None] * along, axis=1)
