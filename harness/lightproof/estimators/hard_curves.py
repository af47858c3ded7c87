"""Where on a film the shadow of a shape before a point or a beam ends: lines for straight edges, conics for round ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from lightproof import geometry
from lightproof.estimators.sheet import EVERYWHERE, Sheet
from lightproof.estimators.soft_curves import MARGIN, edges
from lightproof.geometry import Cylinder, Disk, Polygon, Shape, Sphere

EDGE_ON = 1e-12  # sine of the angle between a ray and a plane that counts as none
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
    yield plane(sheet, np.array(shape.vertices), shape.normal)
    yield straight(sheet, rays, edges(np.array(shape.vertices)))


def straight(sheet: Sheet, rays: Rays, sides: np.ndarray) -> np.ndarray:
    """The shadows of edges (m, 2, 3)."""
    boxes = np.array([rays.box(sheet, side) for side in sides]).reshape(-1, 4)
    return sheet.lines(np.cross(sides[:, 1] - sides[:, 0], rays.travel(sides[:, 0])), sides[:, 0], boxes)


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
    yield circle(sheet, rays, center, normal, shape.radius, rays.box(sheet, square))


def circle(sheet: Sheet, rays: Rays, center: np.ndarray, normal: np.ndarray, radius: float, box: np.ndarray) -> np.ndarray:
    """The shadow of a circle: a conic, or where the light lies in its plane a line."""
    away = rays.travel(center)
    if abs(away @ normal) <= EDGE_ON * np.linalg.norm(away):
        return sheet.lines(normal[None], center[None], box[None])
    return sheet.conics(rim(rays, center, normal, radius), box)


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
    if abs(sheet.height(center)) < shape.radius:
        yield sheet.conics(lambda x: (((x - center) ** 2).sum(axis=-1) - shape.radius**2)[None])
        yield polar(sheet, rays, center, shape.radius)


def polar(sheet: Sheet, rays: Rays, center: np.ndarray, radius: float) -> np.ndarray:
    """The line through the two points of the film at which a ball's shadow touches the ball."""
    if rays.beam:
        return sheet.lines(rays.source[None], center[None])
    axis = rays.source - center
    return sheet.lines(axis[None], (center + axis * (radius**2 / (axis @ axis)))[None])


def cylinder(sheet: Sheet, rays: Rays, shape: Cylinder) -> Iterator[np.ndarray]:
    base, axis = np.array(shape.base), geometry.unit(np.array(shape.axis))
    half = axis * shape.height / 2
    box = rays.box(sheet, around(base + half, *(shape.radius * side for side in geometry.tangents(axis)), half))
    for center in (base, base + axis * shape.height):
        yield circle(sheet, rays, center, axis, shape.radius, box)
    ends = np.array([base, base + axis * shape.height]) + flanks(rays, base, axis, shape.radius)[:, None]
    yield straight(sheet, rays, np.array([standing(sheet, *end) for end in ends]).reshape(-1, 2, 3))
    yield sheet.conics(lambda x: ((np.cross(x - base, axis) ** 2).sum(axis=-1) - shape.radius**2)[None])


def flanks(rays: Rays, base: np.ndarray, axis: np.ndarray, radius: float) -> np.ndarray:
    """From the axis, the two lines (2, 3) along which rays touch a cylinder; (0, 3) from a point within it."""
    away = rays.source if rays.beam else rays.source - base
    away = away - (away @ axis) * axis
    distance = np.linalg.norm(away)
    if distance <= (0 if rays.beam else radius):
        return np.zeros((0, 3))
    along, aside = away / distance, np.cross(axis, away / distance)
    cosine = 0.0 if rays.beam else radius / distance
    return radius * np.array([cosine * along + side * np.sqrt(1 - cosine**2) * aside for side in (-1, 1)])


def standing(sheet: Sheet, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The part (2, 3) of a segment above the film, or all of it where none is."""
    first, last = sheet.height(np.array([a, b]))
    foot = a + (b - a) * first / (first - last) if first * last < 0 else None
    return np.array([a, b] if foot is None else [foot, b] if first < 0 else [a, foot])


OUTLINES: dict[type, Callable] = {Polygon: polygon, Disk: disk, Sphere: sphere, Cylinder: cylinder}
