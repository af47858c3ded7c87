"""Openings before lamps: parallelograms, which Radiance samples evenly, in front of shapes, which it does not.

An aperture is invisible and shines along the rays that meet the lamp behind it, so it is as bright as the lamp is from
everywhere outside. A flat lamp's lies in its plane; a round lamp's is a box around it, in which nothing else may be.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from lightproof import geometry
from lightproof.geometry import Cylinder, Disk, Polygon, Shape, Sphere
from lightproof.scene import AreaLight, CameraFilm, Film, PlaneFilm, PointLight, Scene, Surface

ROOM = 1e-3  # of a round lamp's size: how far the box around it stands off


def half_axes(shape: Sphere | Cylinder) -> tuple[np.ndarray, np.ndarray]:
    """Centre (3,) and right-handed half axes (3, 3) of the box around a round lamp."""
    if isinstance(shape, Sphere):
        return np.array(shape.center), (1 + ROOM) * shape.radius * np.eye(3)
    axis = geometry.unit(shape.axis)
    halves = np.array([[shape.radius], [shape.radius], [shape.height / 2]]) * np.stack([*geometry.tangents(axis), axis])
    return np.add(shape.base, halves[2]), (1 + ROOM) * halves


def box(shape: Sphere | Cylinder) -> list[np.ndarray]:
    """The six outward faces (4, 3) of the box around a round lamp."""
    centre, halves = half_axes(shape)
    return [centre + sign * halves[i] + np.array([[-1, -sign], [1, -sign], [1, sign], [-1, sign]]) @ halves[[i - 2, i - 1]]
            for i in range(3) for sign in (1, -1)]


def frame(polygon: Polygon) -> np.ndarray:
    """The smallest rectangle (4, 3) around a polygon with a side along one of its edges, facing as it does."""
    corners = np.array(polygon.vertices)
    edges = geometry.unit(np.roll(corners, -1, axis=0) - corners)
    frames = [_frame(corners, np.stack([edge, np.cross(polygon.normal, edge)])) for edge in edges]
    return min(frames, key=lambda found: float(np.linalg.norm(geometry.vector_area(found))))


def _frame(corners: np.ndarray, axes: np.ndarray) -> np.ndarray:
    flat = (corners - corners[0]) @ axes.T
    (a, b), (c, d) = flat.min(axis=0), flat.max(axis=0)
    return corners[0] + np.array([[a, b], [c, b], [c, d], [a, d]]) @ axes


def sides(triangle: Polygon) -> list[float]:
    """For each edge the inward unit normal, and where along it the edge lies [m]."""
    corners = np.array(triangle.vertices)
    inward = geometry.unit(np.cross(triangle.normal, np.roll(corners, -1, axis=0) - corners))
    return list(np.column_stack([inward, (inward * corners).sum(axis=1)]).ravel())


def outline(polygon: Polygon) -> list[float]:
    """Two axes, the number of edges, and the corners along these axes, the first again at the end."""
    axes = np.stack(geometry.tangents(polygon.normal))
    flat = np.array([*polygon.vertices, polygon.vertices[0]]) @ axes.T
    return [*axes.ravel(), len(polygon.vertices), *flat.ravel()]


def flatly(lamp: Shape, film: Film, cosine: float) -> bool:
    """Whether a plane film sees a flat lamp at less than about this cosine, or reaches behind it. Of the box around a round lamp
    a face that is seen flatly shows next to nothing."""
    if not isinstance(film, PlaneFilm) or not isinstance(lamp, Polygon | Disk):
        return False
    normal, places = (lamp.normal, lamp.vertices) if isinstance(lamp, Polygon) else (geometry.unit(lamp.normal), [lamp.center])
    (corners,) = _film(film)
    ways = corners - np.mean(places, axis=0)
    return bool((ways @ normal < cosine * np.linalg.norm(ways, axis=1)).any())


def whole(scene: Scene) -> tuple[np.ndarray, float]:
    """Centre (3,) and diagonal [m] of the box around the film and everything that has a place; 1 m where all is one point."""
    around = _around(np.concatenate([corners for _, corners in _boxes(scene)]))
    return around.mean(axis=0), float(np.linalg.norm(np.ptp(around, axis=0))) or 1.0


def crowded(scene: Scene, lamps: list[Any]) -> str | None:
    """Why the boxes around round lamps would hide something, or None."""
    for lamp in (lamp for lamp in lamps if isinstance(lamp.shape, Sphere | Cylinder)):
        low, high = _box(lamp.shape)
        for name, (lowest, highest) in _boxes(scene):
            if name != lamp.id and (highest >= low).all() and (lowest <= high).all():
                return f"Radiance is shown a round lamp through a box around it, and '{name}' reaches into that box"
    return None


def _boxes(scene: Scene) -> Iterator[tuple[str, np.ndarray]]:
    """The lowest and highest corner (2, 3) of a box around each thing that has a place."""
    for item in (*scene.lights, *scene.surfaces):
        if isinstance(item, AreaLight | Surface):
            yield item.id, _box(item.shape)
        elif isinstance(item, PointLight):
            yield item.id, np.array([item.position] * 2)
    yield from (("film", _around(points)) for points in _film(scene.film))


def _film(film: Film) -> list[np.ndarray]:
    if isinstance(film, PlaneFilm):
        return [np.array(film.origin) + np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) @ np.array([film.u, film.v])]
    return [np.array([film.origin])] if isinstance(film, CameraFilm) else [np.array([point]) for point in film.positions]


def _box(shape: Shape) -> np.ndarray:
    match shape:
        case Polygon():
            return _around(np.array(shape.vertices))
        case Sphere() | Cylinder():
            centre, halves = half_axes(shape)
            return centre + np.array([[-1.0], [1.0]]) * np.abs(halves).sum(axis=0)
        case _:
            return np.array(shape.center) + np.array([[-1.0], [1.0]]) * shape.radius


def _around(points: np.ndarray) -> np.ndarray:
    return np.stack([points.min(axis=0), points.max(axis=0)])
