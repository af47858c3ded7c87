"""How Radiance gets the light of a scene: what shadow rays aim at, and how often it looks around from where light arrives.

Radiance aims at every `light` from every point, but finds a `glow` or the sky only by looking around ("ambient bounces",
-ab), which costs one bounce more for the same light.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from lightproof import geometry
from lightproof.geometry import Cap, Cylinder, Polygon, Shape, Sphere
from lightproof.renderers import transport
from lightproof.scene import (
    AreaLight,
    CameraFilm,
    DirectionalLight,
    Environment,
    Film,
    OvercastSky,
    PlaneFilm,
    PointLight,
    PointsFilm,
    Scene,
    Surface,
)

ROOM = 1e-3  # of a round lamp's size: how far the box around it stands off


@dataclass(frozen=True)
class Transport:
    """`bounces` is -ab. With `aims`, shadow rays aim at parallelograms; with `apertures`, at every other lamp too, through an
    aperture, which stops what looks around."""

    bounces: int
    aims: bool = True
    apertures: bool = False


def transport_of(scene: Scene) -> Transport:
    """What Radiance has to do for a scene."""
    flat = all(is_parallelogram(lamp.shape) for lamp in lamps(scene))
    camera = isinstance(scene.film, CameraFilm)
    reflections = transport.reflections(scene)
    direct = max(reflections - camera, 0)
    if not _around(scene) and direct == 0:
        return Transport(0, apertures=True)
    if not _around(scene) and flat:
        return Transport(direct)
    return Transport(reflections + (not camera), aims=scene.max_bounces == "all" or not scene.reflects)


def unsupported(scene: Scene) -> str | None:
    """Why no setting of Radiance follows the light of a scene, or None."""
    if sum(isinstance(light, Environment | OvercastSky) for light in scene.lights) > 1:
        return "Radiance sees one sky at a time"
    if not transport_of(scene).aims and any(isinstance(light, PointLight | DirectionalLight) for light in scene.lights):
        return ("Radiance counts one reflection more for a point or a beam, at which it aims, than for what it finds by looking"
                " around; this scene has both and limits reflections")
    return _crowded(scene) if transport_of(scene).apertures else None


def lamps(scene: Scene) -> list[Any]:
    """Lights and surfaces that have a shape and emit from its outside and do nothing else."""
    lights = [light for light in scene.lights if isinstance(light, AreaLight)]
    return lights + [surface for surface in scene.surfaces if is_lamp(surface, scene)]


def is_lamp(surface: Surface, scene: Scene) -> bool:
    """Whether a surface emits from its outside and reflects nothing in this scene."""
    dark = not scene.reflects or surface.reflectance == 0
    return bool(surface.radiance) and dark and surface.side == "outside"


def is_parallelogram(shape: Shape) -> bool:
    """Whether Radiance samples a lamp of this shape evenly."""
    if not isinstance(shape, Polygon) or len(shape.vertices) != 4:
        return False
    a, b, c, d = np.array(shape.vertices)
    return float(np.linalg.norm(a + c - b - d)) <= 1e-9 * float(np.linalg.norm(c - a))


def extent(scene: Scene) -> float:
    """Length [m] of the diagonal of the box around the film and everything that has a place; at least 1 m where that is none."""
    corners = np.concatenate([*_boxes(scene).values()])
    return float(np.linalg.norm(np.ptp(corners, axis=0))) or 1.0


def _around(scene: Scene) -> list[Any]:
    """What is found by looking around only: skies, walls that glow and caps that shine."""
    glowing = [surface for surface in scene.surfaces if surface.radiance and not is_lamp(surface, scene)]
    skies = [light for light in scene.lights if isinstance(light, Environment | OvercastSky)]
    return skies + glowing + [lamp for lamp in lamps(scene) if isinstance(lamp.shape, Cap)]


def _crowded(scene: Scene) -> str | None:
    """A round lamp's aperture is a box around it, in which nothing else may be."""
    for lamp in lamps(scene):
        if isinstance(lamp.shape, Sphere | Cylinder):
            low, high = _box(lamp.shape)
            for name, (lowest, highest) in _boxes(scene).items():
                if name != lamp.id and (highest >= low).all() and (lowest <= high).all():
                    return f"Radiance is shown a round lamp through a box around it, and '{name}' reaches into that box"
    return None


def _boxes(scene: Scene) -> dict[str, np.ndarray]:
    """For the film and everything that has a place, the lowest and the highest corner (2, 3) of a box that holds it."""
    shapes = {item.id: _box(item.shape) for item in (*scene.lights, *scene.surfaces) if isinstance(item, AreaLight | Surface)}
    points = {light.id: np.array([light.position] * 2) for light in scene.lights if isinstance(light, PointLight)}
    return {**shapes, **points, "film": _around_points(_film(scene.film))}


def _film(film: Film) -> np.ndarray:
    match film:
        case PlaneFilm():
            return np.array(film.origin) + np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) @ np.array([film.u, film.v])
        case PointsFilm():
            return np.array(film.positions)
        case CameraFilm():
            return np.array([film.origin])


def _box(shape: Shape) -> np.ndarray:
    """As `_boxes`; with room for the aperture of a round lamp."""
    match shape:
        case Polygon():
            return _around_points(np.array(shape.vertices))
        case Cylinder():
            ends = np.array([shape.base, np.add(shape.base, shape.height * geometry.unit(shape.axis))])
            room = (1 + ROOM) * np.hypot(shape.radius, shape.height / 2)
            return ends.mean(axis=0) + room * np.array([[-1.0], [1.0]])
        case _:
            return np.array(shape.center) + (1 + ROOM) * shape.radius * np.array([[-1.0], [1.0]])


def _around_points(points: np.ndarray) -> np.ndarray:
    return np.stack([points.min(axis=0), points.max(axis=0)])
