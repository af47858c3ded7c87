"""A sketch of the direct light: enough to recognise a mistake by, never to judge with.

Light is summed over a few points on each lamp, at the centres of the film's elements, with nothing in between.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from lightproof import geometry
from lightproof.geometry import Disk, Polygon, Sphere
from lightproof.scene import AreaLight, Light, PlaneFilm, PointLight, PointsFilm, Scene

ACCURACY = 0.01  # relative, over a film
STEPS = 16  # points along each side of a lamp

Share = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]


def share(receiver: np.ndarray, light: np.ndarray, square: np.ndarray) -> np.ndarray:
    """What a point of a lamp contributes: cosine at the receiver times cosine at the light over squared distance [1/m2]."""
    return receiver * light / square


def can(scene: Scene) -> bool:
    """Whether a scene is simple enough: direct irradiance from point lights and from flat or round area lights."""
    lights = scene.tangible.lights
    return scene.film.quantity == "irradiance" and not scene.reflects and bool(lights) and all(map(_simple, lights))


def irradiance(scene: Scene, elements: np.ndarray, shares: dict[str, Share]) -> dict[str, np.ndarray]:
    """Irradiance (m,) [W/m2] at `elements` (m,) when nothing blocks, for each way to compute what a point of a lamp
    contributes."""
    positions, normals = (vectors[elements] for vectors in _receivers(scene.film))
    terms = [_terms(light, positions, normals) for light in scene.tangible.lights]
    return {name: sum((strength * one(*geometric)).sum(axis=1) for strength, *geometric in terms) for name, one in shares.items()}


def _simple(light: Light) -> bool:
    return isinstance(light, PointLight) or (isinstance(light, AreaLight) and type(light.shape) in POINTS)


def _receivers(film: PlaneFilm | PointsFilm) -> tuple[np.ndarray, np.ndarray]:
    """Centres and normals (n, 3) of a film's elements."""
    if isinstance(film, PointsFilm):
        return np.array(film.positions), geometry.unit(film.normals)
    rows, columns = film.grid
    row, column = (axis.ravel()[:, None] for axis in np.mgrid[:rows, :columns] + 0.5)
    centres = np.array(film.origin) + np.array(film.u) * column / columns + np.array(film.v) * row / rows
    return centres, np.broadcast_to(film.normal, centres.shape)


def _terms(light: AreaLight | PointLight, positions: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, ...]:
    """Strength (k,), then cosine at the receiver, cosine at the light and squared distance, (m, k) each."""
    if isinstance(light, PointLight):
        points, fronts, strength = np.array([light.position]), None, np.array([light.intensity])
    else:
        points, fronts, areas = POINTS[type(light.shape)](light.shape)
        strength = light.radiance * areas
    away = points - positions[:, None]
    square = (away**2).sum(axis=-1)
    towards = away / np.sqrt(square)[..., None]
    receiver = np.maximum((towards * normals[:, None]).sum(axis=-1), 0)
    front = np.ones_like(square) if fronts is None else np.maximum(-(towards * fronts).sum(axis=-1), 0)
    return strength, receiver, front, square


def _square() -> np.ndarray:
    """Midpoints of a STEPS x STEPS grid over the unit square, (2, k)."""
    return (np.mgrid[:STEPS, :STEPS].reshape(2, -1) + 0.5) / STEPS


def _on_polygon(polygon: Polygon) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points and normals (k, 3) and areas (k,): a fan of triangles, those outside a concave polygon counted negative."""
    u, v = _square()[..., None]
    first, *others = np.array(polygon.vertices)
    points, areas = [], []
    for second, third in pairwise(others):
        points.append(first + u * (second - first) + u * v * (third - second))
        areas.append(np.cross(second - first, third - first) @ polygon.normal * u.ravel() / u.size)
    points = np.concatenate(points)
    return points, np.broadcast_to(polygon.normal, points.shape), np.concatenate(areas)


def _on_disk(disk: Disk) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points and normals (k, 3) and areas (k,)."""
    u, v = _square()[..., None]
    across, along = geometry.tangents(np.array(disk.normal))
    offsets = np.cos(2 * np.pi * v) * across + np.sin(2 * np.pi * v) * along
    points = np.array(disk.center) + disk.radius * np.sqrt(u) * offsets
    return points, np.broadcast_to(geometry.unit(disk.normal), points.shape), np.full(len(points), disk.area / len(points))


def _on_sphere(sphere: Sphere) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points and normals (k, 3) and areas (k,)."""
    u, v = _square()
    z, radius = 1 - 2 * u, 2 * np.sqrt(u * (1 - u))
    normals = np.stack([radius * np.cos(2 * np.pi * v), radius * np.sin(2 * np.pi * v), z], axis=1)
    return np.array(sphere.center) + sphere.radius * normals, normals, np.full(len(normals), sphere.area / len(normals))


POINTS = {Polygon: _on_polygon, Disk: _on_disk, Sphere: _on_sphere}
