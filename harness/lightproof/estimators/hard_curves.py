"""Where on a film the shadow of a shape before a point or a beam ends: lines for straight edges, conics for round ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from lightproof import geometry
from lightproof.estimators.sheet import EVERYWHERE, Sheet
from lightproof.estimators.soft_curves import MARGIN, edges
from lightproof.geometry import Cylinder, Disk, Polygon, Shape, Sphere

SIDES = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)], float)


class Rays:
    """Light that spreads from a point `source` (3,), or in a beam travels along it."""

    def __init__(self, source: np.ndarray, beam: bool):
        self.source, self.beam = source, beam

    def travel(self, x: np.ndarray) -> np.ndarray:
        """The direction of travel at points (..., 3), of any length."""
        return np.broadcast_to(self.source, x.shape) if self.beam else x - self.source

    def on_plane(self, x: np.ndarray, point: np.ndarray, normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where the rays to points (..., 3) meet a plane, from `point`, as (..., 3) over a common (..., 1) divisor."""
        d = self.travel(x)
        slope = (d @ normal)[..., None]
        return (x - point) * slope - d * ((x - point) @ normal)[..., None], slope

    def box(self, sheet: Sheet, points: np.ndarray) -> np.ndarray:
        """The box (4,) around the shadows of points (k, 3) on a film; without bounds where one of them casts none."""
        d = self.travel(points)
        fall = -(d @ sheet.normal)
        if not (fall > 0).all():
            return EVERYWHERE
        places = sheet.places(points + d * (sheet.height(points) / fall)[:, None])
        low, high = places.min(axis=0) - MARGIN, places.max(axis=0) + MARGIN
        return np.array([low[0], high[0], low[1], high[1]])


def curves(sheet: Sheet, rays: Rays, shapes: list[Shape]) -> list[np.ndarray]:
    """Rows of curves."""
    return [row for shape in shapes for row in OUTLINES[type(shape)](sheet, rays, shape)]


def polygon(sheet: Sheet, rays: Rays, shape: Polygon) -> Iterator[np.ndarray]:
    sides = edges(np.array(shape.vertices))
    yield plane(sheet, np.array(shape.vertices), shape.normal)
    boxes = np.array([rays.box(sheet, side) for side in sides])
    yield sheet.lines(np.cross(sides[:, 1] - sides[:, 0], rays.travel(sides[:, 0])), sides[:, 0], boxes)


def plane(sheet: Sheet, corners: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """The line along which a flat shape with `corners` around it stands on the film or passes through it."""
    heights = sheet.height(corners)
    if heights.min() > 0 or heights.max() < 0:
        return np.zeros((0, 10))
    low, high = sheet.places(corners).min(axis=0) - MARGIN, sheet.places(corners).max(axis=0) + MARGIN
    return sheet.lines(normal[None], corners[:1], np.array([[low[0], high[0], low[1], high[1]]]))


def around(center: np.ndarray, *spans: np.ndarray) -> np.ndarray:
    """The corners (8, 3) of the box with half its sides along `spans`."""
    return center + SIDES @ np.stack([*spans, *np.zeros((3 - len(spans), 3))])


def disk(sheet: Sheet, rays: Rays, shape: Disk) -> Iterator[np.ndarray]:
    center, normal = np.array(shape.center), geometry.unit(np.array(shape.normal))
    t, b = geometry.tangents(normal)
    square = around(center, shape.radius * t, shape.radius * b)
    yield plane(sheet, np.stack([square[0], *square]), normal)
    yield sheet.conics(rim(rays, center, normal, shape.radius), rays.box(sheet, square))


def rim(rays: Rays, center: np.ndarray, normal: np.ndarray, radius: float) -> Callable[[np.ndarray], np.ndarray]:
    """Zero where the ray meets a circle."""

    def f(x: np.ndarray) -> np.ndarray:
        miss, slope = rays.on_plane(x, center, normal)
        return ((miss**2).sum(axis=-1) - radius**2 * slope[..., 0] ** 2)[None]

    return f


def sphere(sheet: Sheet, rays: Rays, shape: Sphere) -> Iterator[np.ndarray]:
    center = np.array(shape.center)
    cube = around(center, *shape.radius * np.eye(3))

    def tangent(x: np.ndarray) -> np.ndarray:
        """Zero where the ray touches the ball: |d x (x - c)| = R |d|."""
        d = rays.travel(x)
        origin = x - center if rays.beam else rays.source - center
        return ((np.cross(d, origin) ** 2).sum(axis=-1) - shape.radius**2 * (d**2).sum(axis=-1))[None]

    yield sheet.conics(tangent, rays.box(sheet, cube))
    yield sheet.conics(lambda x: (((x - center) ** 2).sum(axis=-1) - shape.radius**2)[None])


def cylinder(sheet: Sheet, rays: Rays, shape: Cylinder) -> Iterator[np.ndarray]:
    base, axis = np.array(shape.base), geometry.unit(np.array(shape.axis))
    t, b = (shape.radius * side for side in geometry.tangents(axis))
    half = axis * shape.height / 2
    box = rays.box(sheet, around(base + half, t, b, half))

    def flank(x: np.ndarray) -> np.ndarray:
        """Zero where the ray touches the side, however long."""
        d = rays.travel(x)
        origin = x - base if rays.beam else rays.source - base
        return ((np.cross(d, origin) @ axis) ** 2 - shape.radius**2 * (np.cross(d, axis) ** 2).sum(axis=-1))[None]

    for center in (base, base + axis * shape.height):
        yield sheet.conics(rim(rays, center, axis, shape.radius), box)
    yield sheet.conics(flank, box)
    yield sheet.conics(lambda x: ((np.cross(x - base, axis) ** 2).sum(axis=-1) - shape.radius**2)[None])


OUTLINES: dict[type, Callable] = {Polygon: polygon, Disk: disk, Sphere: sphere, Cylinder: cylinder}
