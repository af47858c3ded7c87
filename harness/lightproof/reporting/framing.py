"""Where the camera of a picture stands, and how much of a scene it shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lightproof import geometry
from lightproof.geometry import Cap, Polygon, Sphere
from lightproof.renderers import mesh
from lightproof.scene import AreaLight, CameraFilm, PlaneFilm, PointLight, Scene

AZIMUTH, ELEVATION = np.radians(-64.0), np.radians(21.0)
FOV = 24.0  # degrees, across the width
BORDER = 1.08
BEYOND = 0.12  # how far surfaces are shown beyond lights and film, of the diagonal of both


@dataclass(frozen=True)
class Box:
    """An axis-aligned box with corners `low` and `high` (3,) [m]."""

    low: np.ndarray
    high: np.ndarray

    @property
    def size(self) -> float:
        """Length of the diagonal [m]."""
        return float(np.linalg.norm(self.high - self.low))

    def grown(self, part: float) -> Box:
        """The box with `part` of its diagonal added on every side."""
        return Box(self.low - part * self.size, self.high + part * self.size)


@dataclass(frozen=True)
class Camera:
    """A perspective camera: where it stands and where it looks [m]."""

    origin: np.ndarray
    target: np.ndarray
    fov: float = FOV


def towards_viewer() -> np.ndarray:
    """Unit vector (3,) from the scene to the camera."""
    return np.array([np.cos(AZIMUTH) * np.cos(ELEVATION), np.sin(AZIMUTH) * np.cos(ELEVATION), np.sin(ELEVATION)])


def region(scene: Scene) -> Box:
    """The box around film, lights, spheres and caps: what a picture of the scene is about."""
    points = [_film_points(scene.film)]
    points += [mesh.tessellate(light.shape).vertices for light in scene.lights if isinstance(light, AreaLight)]
    points += [np.array([light.position]) for light in scene.lights if isinstance(light, PointLight)]
    points += [mesh.tessellate(surface.shape).vertices for surface in scene.surfaces if isinstance(surface.shape, Sphere | Cap)]
    every = np.concatenate(points)
    box = Box(every.min(axis=0), every.max(axis=0))
    return box if box.size else Box(box.low - 0.5, box.high + 0.5)


def clipped(polygon: Polygon, box: Box) -> np.ndarray:
    """The corners (n, 3) of what lies of a convex polygon inside a box (Sutherland and Hodgman 1974); n may be 0."""
    corners = np.array(polygon.vertices)
    for axis in range(3):
        for sign, limit in ((1, box.high[axis]), (-1, -box.low[axis])):
            corners = _below(corners, sign * corners[:, axis] - limit) if len(corners) else corners
    return corners


def _below(corners: np.ndarray, height: np.ndarray) -> np.ndarray:
    kept = []
    for start, end, a, b in zip(corners, np.roll(corners, -1, axis=0), height, np.roll(height, -1), strict=True):
        if a <= 0:
            kept.append(start)
        if a * b < 0:
            kept.append(start + (end - start) * a / (a - b))
    return np.array(kept)


def camera(points: np.ndarray, aspect: float) -> Camera:
    """The nearest camera of the house's direction that sees all `points` (n, 3); `aspect` is width over height."""
    right, up, forward = geometry.camera_frame(towards_viewer(), (0, 0, 0), (0, 0, 1))
    across, along, depth = points @ right, points @ up, points @ forward
    width = np.tan(np.radians(FOV) / 2) / BORDER
    x, back_x = _fit(across, depth, width)
    y, back_y = _fit(along, depth, width / aspect)
    origin = x * right + y * up + min(back_x, back_y) * forward
    return Camera(origin, origin + forward)


def _fit(offset: np.ndarray, depth: np.ndarray, tangent: float) -> tuple[float, float]:
    """Where on its axis, and how far forward, a camera stands whose half angle of view has this tangent and just holds all."""
    most, least = (offset - tangent * depth).max(), (offset + tangent * depth).min()
    return float(most + least) / 2, float(least - most) / (2 * tangent)


def _film_points(film: PlaneFilm | CameraFilm) -> np.ndarray:
    match film:
        case PlaneFilm():
            sides = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
            return np.array(film.origin) + sides @ np.array([film.u, film.v])
        case CameraFilm():
            return np.array([film.origin, film.target])
        case _:
            return np.array(film.positions)
