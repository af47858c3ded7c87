"""What a renderer's camera has to look at to fill a film.

A camera film is a camera. An irradiance film is measured as its exitance would be: a diffuse receiver of reflectance rho
is laid into the film, an orthographic camera just above it sees the radiance L = rho E / pi, and E = pi L / rho. The mean
over a pixel is the mean over a cell; at a point the receiver is a square far smaller than the distance to anything but what it
lies on.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from lightproof import geometry
from lightproof.renderers import mesh
from lightproof.scene import AreaLight, CameraFilm, PlaneFilm, PointLight, PointsFilm, Scene, Surface

PATCH = 1e-3  # side of a point's receiver, of the distance over which the light there varies
CLOSE = 0.05  # the same at most, of the distance to the nearest shape that the point does not lie on
RESOLVED = 2e-6  # of the largest coordinate: what is smaller is lost in a renderer's float32
LIFT = 1e-6  # of the film's diagonal: a receiver lies above a surface that coincides with the film
MARGIN = 1e-4  # of the film's sides: a receiver reaches beyond the film, so that no ray along the border misses it
SQUARE = 1e-9  # cosine of the angle between the sides of a film that counts as a rectangle
COINCIDENT = 1e-6  # of the film's sides: what is no higher above the film's plane lies in it
WHITE, DARK = 1.0, 1e-3  # reflectance of a receiver: dark where its own light could come back to it


@dataclass(frozen=True)
class Receiver:
    """A diffuse rectangle: `corners` (4, 3) [m], counter-clockwise as the camera sees it."""

    corners: np.ndarray
    reflectance: float


@dataclass(frozen=True)
class View:
    """A camera, and the receiver that it looks at where the film is one of irradiance.

    `half` is half the width and height: metres (orthographic) or tangents (perspective). Columns run along
    (target - origin) x up, row 0 is on top. `near` [m] is a distance in which there is nothing to see.
    """

    projection: str
    origin: np.ndarray
    target: np.ndarray
    up: np.ndarray
    half: tuple[float, float]
    resolution: tuple[int, int]
    near: float
    receiver: Receiver | None = None

    @property
    def has_square_pixels(self) -> bool:
        """Whether a pixel is as wide as high, to a part in 10^6."""
        (width, height), (columns, rows) = self.half, self.resolution
        return abs(width * rows - height * columns) <= 1e-6 * width * rows

    def elements(self, radiance: np.ndarray) -> np.ndarray:
        """Film elements (n,) from the camera's image (rows, columns) of radiance."""
        if self.receiver is None:
            return radiance.ravel()
        return (np.pi / self.receiver.reflectance * radiance[::-1]).ravel()


def unsupported(scene: Scene) -> str | None:
    """Why no camera can fill this film, or None."""
    film = scene.film
    caps = [item.id for item in (*scene.lights, *scene.surfaces) if isinstance(getattr(item, "shape", None), geometry.Cap)]
    if caps:
        return f"renderers are given no spherical caps yet ('{caps[0]}' is one)"
    if film.quantity == "solid_angle":
        return "renderers give no solid angles"
    if isinstance(film, PlaneFilm) and abs(geometry.unit(film.u) @ geometry.unit(film.v)) > SQUARE:
        return "a camera's film is a rectangle, and this plane film is not"
    if isinstance(film, PlaneFilm) and scene.reflects and _crossed(film, scene):
        return "the receiver that stands for the film would hide light that passes through the film before it is reflected"
    return None


def views(scene: Scene) -> list[View]:
    """The views that fill the film one after the other: one for a plane or camera film, one for each point of a points film."""
    match scene.film:
        case CameraFilm() as film:
            return [_camera(film)]
        case PlaneFilm() as film:
            return [_plane(film, _reflectance(scene))]
        case PointsFilm() as film:
            return [_patch(scene, *point) for point in zip(film.positions, film.normals or (), strict=True)]


def pooled(image: np.ndarray, block: int) -> np.ndarray:
    """Means over blocks of `block` x `block` pixels."""
    rows, columns = image.shape
    return image.reshape(rows // block, block, columns // block, block).mean(axis=(1, 3))


def pose(centre: Any, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """The matrix (4, 4) that takes the axes to `x`, `y`, `z` and the origin to `centre`."""
    matrix = np.eye(4)
    matrix[:3] = np.stack([x, y, z, np.array(centre)], axis=1)
    return matrix


def _crossed(film: PlaneFilm, scene: Scene) -> bool:
    """Whether light may come from behind the film's plane, or a shape lies in it or reaches behind it."""
    corners = [mesh.tessellate(item.shape).vertices for item in (*scene.lights, *scene.surfaces) if hasattr(item, "shape")]
    corners += [np.array([light.position]) for light in scene.lights if isinstance(light, PointLight)]
    everywhere = len(scene.lights) + len(scene.surfaces) > len(corners)
    size = float(np.linalg.norm(film.u) + np.linalg.norm(film.v))
    return everywhere or any(((points - film.origin) @ film.normal).min() <= COINCIDENT * size for points in corners)


def _camera(film: CameraFilm) -> View:
    origin, target = np.array(film.origin), np.array(film.target)
    near = 1e-5 * float(np.linalg.norm(target - origin))
    return View(film.projection, origin, target, np.array(film.up), film.half_extent, film.resolution, near)


def _plane(film: PlaneFilm, reflectance: float) -> View:
    u, v = np.array(film.u), np.array(film.v)
    diagonal = float(np.hypot(np.linalg.norm(u), np.linalg.norm(v)))
    centre = np.array(film.origin) + (u + v) / 2 + LIFT * diagonal * film.normal
    return _above(centre, u, v, film.resolution, 1e-4 * diagonal, reflectance)


def _patch(scene: Scene, position: geometry.Vec3, normal: geometry.Vec3) -> View:
    t, b = geometry.tangents(normal)
    side = _side(scene, np.array(position))
    centre = np.array(position) + 0.01 * side * geometry.unit(normal)
    return _above(centre, side * t, side * b, (1, 1), side, _reflectance(scene))


def _above(centre: np.ndarray, u: np.ndarray, v: np.ndarray, resolution: tuple[int, int], height: float,
           reflectance: float) -> View:
    """A camera `height` above the rectangle with sides `u` and `v` around `centre`."""
    normal = geometry.unit(np.cross(geometry.unit(u), geometry.unit(v)))
    half_u, half_v = u * (1 + MARGIN) / 2, v * (1 + MARGIN) / 2
    corners = centre + np.array([-half_u - half_v, half_u - half_v, half_u + half_v, half_v - half_u])
    half = float(np.linalg.norm(u) / 2), float(np.linalg.norm(v) / 2)
    receiver = Receiver(corners, reflectance)
    return View("orthographic", centre + height * normal, centre, v, half, resolution, height / 10, receiver)


def _reflectance(scene: Scene) -> float:
    return DARK if scene.reflects else WHITE


def _side(scene: Scene, point: np.ndarray) -> float:
    """Length [m] of the sides of the square that stands for a point."""
    clearance = _clearance(scene, point)
    gaps = [_distance(item.shape, point) for item in (*scene.lights, *scene.surfaces) if isinstance(item, AreaLight | Surface)]
    close = min((gap for gap in gaps if gap > COINCIDENT * clearance), default=np.inf)
    return min(PATCH * clearance, max(CLOSE * close, RESOLVED * float(np.abs(point).max())))


def _distance(shape: geometry.Shape, point: np.ndarray) -> float:
    """From a point to a shape [m]."""
    if isinstance(shape, geometry.Sphere):
        return abs(float(np.linalg.norm(point - shape.center)) - shape.radius)
    return mesh.tessellate(shape).distance(point)


def _clearance(scene: Scene, point: np.ndarray) -> float:
    """About the distance [m] over which the light at a point varies: that to the nearest light or surface, or a tenth of
    its size where the point is closer than that."""
    gaps = [_gap(item.shape, point) for item in (*scene.lights, *scene.surfaces) if isinstance(item, AreaLight | Surface)]
    gaps += [float(np.linalg.norm(point - light.position)) for light in scene.lights if isinstance(light, PointLight)]
    return min(gaps, default=1.0)


def _gap(shape: geometry.Shape, point: np.ndarray) -> float:
    if isinstance(shape, geometry.Sphere):
        return max(abs(float(np.linalg.norm(point - shape.center)) - shape.radius), shape.radius / 10)
    corners = mesh.tessellate(shape).vertices
    return max(float(np.linalg.norm(corners - point, axis=1).min()), float(np.ptp(corners, axis=0).max()) / 10)
