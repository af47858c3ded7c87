"""What a scene is to what samples it: whether its light jumps or bends somewhere, and over how many coordinates."""

from __future__ import annotations

import numpy as np

from lightproof.estimators.rates import AREA, HEMISPHERE, PROJECTED
from lightproof.geometry import Disk, Polygon, Shape, Sphere
from lightproof.scene import AreaLight, CameraFilm, Environment, OvercastSky, PointsFilm, Scene, SunDisc

FLAT = 1e-9  # of a light's distance: nearer to the horizon it touches it
UP = (0.0, 0.0, 1.0)


def coordinates(scene: Scene, domain: str) -> int:
    """Over how many coordinates an estimate is an integral: two of the light, two of an element with an extent."""
    constant = domain == PROJECTED and not (edges(scene, domain) or any(isinstance(shape, Disk) for shape in _areas(scene)))
    light = not constant and (scene.reflects or bool(_with_extent(scene)))
    return 2 * light + 2 * (not isinstance(scene.film, PointsFilm))


def edges(scene: Scene, domain: str) -> bool:
    """Whether what is sampled has, or may have, an edge: a shadow's, the horizon's, that of what a camera sees; to directions
    of the hemisphere a light's outline; to points of its area the fold of a triangle."""
    seen = isinstance(scene.film, CameraFilm) or bool(scene.surfaces) or len(_areas(scene)) > 1
    return (seen or any(_cut(scene, shape) for shape in _areas(scene)) or (domain == HEMISPHERE and _outlined(scene))
            or (domain == AREA and any(_folded(shape) for shape in _areas(scene))))


def _areas(scene: Scene) -> list[Shape]:
    return [light.shape for light in scene.lights if isinstance(light, AreaLight)]


def _with_extent(scene: Scene) -> list[object]:
    skies = [light for light in scene.lights if isinstance(light, Environment | OvercastSky | SunDisc)]
    return [*_areas(scene), *skies, *(surface for surface in scene.surfaces if surface.radiance)]


def _receivers(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Places and unit normals (m, 3) of the planes below which nothing is received, of a film that is no camera's."""
    film = scene.film
    if not isinstance(film, PointsFilm):
        return np.array([film.origin]), np.array([film.normal])
    if film.normals is None:
        return np.empty((0, 3)), np.empty((0, 3))
    normals = np.array(film.normals, float)
    return np.array(film.positions, float), normals / np.linalg.norm(normals, axis=1, keepdims=True)


def _cut(scene: Scene, shape: Shape) -> bool:
    """Whether a light lies on both sides of a receiver's plane."""
    places, normals = _receivers(scene)
    if isinstance(shape, Polygon):
        corners, reach = np.array(shape.vertices), np.zeros(len(normals))
    else:
        corners, reach = np.array([getattr(shape, "center", getattr(shape, "base", None))]), _reach(shape, normals)
    heights = (corners[None] - places[:, None]) @ normals[:, :, None]
    margin = FLAT * np.abs(heights).max(initial=0.0)
    return bool(((heights.min(axis=(1, 2)) - reach < -margin) & (heights.max(axis=(1, 2)) + reach > margin)).any())


def _reach(shape: Shape, normals: np.ndarray) -> np.ndarray:
    """How far a round shape extends from its centre along each of `normals` (m, 3), or more."""
    if isinstance(shape, Disk):
        axis = np.array(shape.normal) / np.linalg.norm(shape.normal)
        return shape.radius * np.sqrt(np.maximum(0, 1 - (normals @ axis) ** 2))
    height = 0.0 if isinstance(shape, Sphere) else getattr(shape, "height", 0.0)
    return np.full(len(normals), shape.radius + height)


def _folded(shape: Shape) -> bool:
    """Whether a polygon is no parallelogram, so that it is cut into triangles."""
    if not isinstance(shape, Polygon):
        return False
    corners = np.array(shape.vertices)
    return len(corners) != 4 or not np.allclose(corners[0] + corners[2], corners[1] + corners[3], atol=FLAT * np.ptp(corners))


def _outlined(scene: Scene) -> bool:
    """Whether some light covers part of a receiver's hemisphere only."""
    if any(isinstance(light, AreaLight | SunDisc) for light in scene.lights):
        return True
    upper = any(isinstance(light, OvercastSky) or getattr(light, "extent", "") == "upper" for light in scene.lights)
    return upper and not np.allclose(_receivers(scene)[1], UP)
