"""Solid angle of one polygon, disk, sphere or sun that nothing hides, however small: forms in which nothing cancels."""

from __future__ import annotations

import numpy as np

from lightproof import geometry
from lightproof.estimators.shapes import triangulated
from lightproof.estimators.supports import plane_of, support
from lightproof.geometry import Disk, Polygon, Sphere, Vec3
from lightproof.scene import AreaLight, Scene, SunDisc

NODES = 64  # around a disk
FAR = 2.0  # radii: from here on as many nodes give all digits of a disk


def film(scene: Scene) -> np.ndarray | None:
    """The film (n,) [sr]; nan where the horizon cuts the light, or a disk is near; None where something may hide it."""
    if scene.film.quantity != "solid_angle" or len(scene.lights) != 1 or scene.surfaces:
        return None
    places = scene.film.positions
    normals = scene.film.normals or (None,) * len(places)
    angles = [angle(scene.lights[0], np.array(place), normal) for place, normal in zip(places, normals, strict=True)]
    return np.array(angles, float)


def angle(light: AreaLight | SunDisc, place: np.ndarray, normal: Vec3 | None) -> float | None:
    """Seen from a place; None where it is not seen whole."""
    if isinstance(light, SunDisc):
        sine, up = np.sin(np.radians(light.half_angle)), -geometry.unit(light.direction)
        return None if normal and up @ geometry.unit(normal) < sine else cap(sine)
    shape = getattr(light, "shape", None)
    if not isinstance(shape, Polygon | Disk | Sphere) or (normal and is_cut(shape, place, -geometry.unit(normal))):
        return None
    if isinstance(shape, Sphere):
        d = np.linalg.norm(shape.center - place)
        return cap(shape.radius / d) if d > shape.radius else None
    point, front = plane_of(shape)
    if (place - point) @ front <= 0:
        return 0.0
    if isinstance(shape, Polygon):
        return float(sum(triangle(corners, place) for corners in triangulated(np.array(shape.vertices))))
    return disk(shape.center - place, front, shape.radius)


def is_cut(shape: Polygon | Disk | Sphere, place: np.ndarray, down: np.ndarray) -> bool:
    """Whether any of a shape lies below the horizon of a place."""
    return support(shape, down) > down @ place


def cap(sine: float) -> float:
    """2 pi (1 - cos a) of a half-angle a up to a right angle."""
    return float(2 * np.pi * sine**2 / (1 + np.sqrt((1 - sine) * (1 + sine))))


def triangle(corners: np.ndarray, place: np.ndarray) -> float:
    """Van Oosterom and Strackee 1983, with the product a . (b x c) = a . ((b - a) x (c - a)) of the corners (3, 3) as
    seen from a place; their differences are those of the coordinates given."""
    r, edges = corners - place, np.cross(corners[1] - corners[0], corners[2] - corners[0])
    a, b, c = np.linalg.norm(r, axis=1)
    product = abs(r[0] @ edges)
    return float(2 * np.arctan2(product, a * b * c + (r[0] @ r[1]) * c + (r[1] @ r[2]) * a + (r[2] @ r[0]) * b))


def disk(center: np.ndarray, normal: np.ndarray, radius: float) -> float | None:
    """The integral of 1 - cos over the azimuth around the direction a of the centre: |a . normal| r^2 times that of
    1/(s (s + a . s)) over the rim s, all of it positive."""
    d = float(np.linalg.norm(center))
    if d < FAR * radius:
        return None
    turn = np.arange(NODES) * (2 * np.pi / NODES)
    t, b = geometry.tangents(normal)
    rim = center + radius * (np.cos(turn)[:, None] * t + np.sin(turn)[:, None] * b)
    far = np.linalg.norm(rim, axis=1)
    return float(abs(center @ normal) / d * radius**2 * np.mean(2 * np.pi / (far * (far + rim @ center / d))))
