"""Light inside a diffuse sphere, where the form factor from anywhere to dA is dA/(4 pi r^2): reflected light is uniform.

Of reflectance rho, glowing with Le, around point lights of intensity I: L = Le (1 - rho^(k+1))/(1 - rho) after k reflections,
and every reflection of the points' light adds the same irradiance I/r^2 times a power of rho everywhere on the wall.
"""

from __future__ import annotations

from itertools import repeat

import numpy as np

from lightproof import geometry
from lightproof.scene import CameraFilm, PointLight, PointsFilm, Scene, Surface

ON_WALL = 1e-9  # of the radius


def unsupported(scene: Scene) -> str | None:
    """Why this is no sphere with point lights and a camera, or points of its wall, inside."""
    inner = [surface for surface in scene.surfaces if surface.side == "inside"]
    if len(scene.surfaces) != 1 or not inner or not isinstance(inner[0].shape, geometry.Sphere):
        return "reflected light has a closed form only where one sphere, seen from inside, is the only surface; path can"
    if not all(isinstance(light, PointLight) for light in scene.lights):
        return "its closed form of a sphere's interreflection takes point lights only; path can"
    if not all(distance(inner[0], light.position) < 1 for light in scene.lights):
        return f"a light stands outside the sphere '{inner[0].id}'; path can"
    return film_unsupported(scene, inner[0])


def film_unsupported(scene: Scene, wall: Surface) -> str | None:
    match scene.film:
        case CameraFilm(projection="perspective") if distance(wall, scene.film.origin) < 1:
            return None
        case PointsFilm() if all(map(on_wall, repeat(wall), scene.film.positions, scene.film.normals)):
            return None
    return (f"its closed form takes points of the wall of '{wall.id}' that face its centre, or a perspective camera inside;"
            " path can")


def on_wall(wall: Surface, point: geometry.Vec3, normal: geometry.Vec3) -> bool:
    """Whether a receiver lies on the wall and faces the centre."""
    inward = geometry.unit(np.subtract(wall.shape.center, point))
    return abs(distance(wall, point) - 1) < ON_WALL and float(np.abs(geometry.unit(normal) - inward).max()) < ON_WALL


def distance(wall: Surface, point: geometry.Vec3) -> float:
    """Distance from the centre, in radii."""
    return float(np.linalg.norm(np.subtract(point, wall.shape.center))) / wall.shape.radius


def irradiance(scene: Scene, points: np.ndarray, bounces: float) -> np.ndarray:
    """At points (..., 3) of the wall after up to `bounces` reflections [W/m2]."""
    (wall,) = scene.surfaces
    inward = (np.array(wall.shape.center) - points) / wall.shape.radius
    total = np.full(points.shape[:-1], np.pi * wall.radiance * geometric(wall.reflectance, bounces + 1))
    for light in scene.lights:
        d = np.array(light.position) - points
        total += light.intensity * np.einsum("...i,...i", d, inward) / np.linalg.norm(d, axis=-1) ** 3
        total += light.intensity / wall.shape.radius**2 * wall.reflectance * geometric(wall.reflectance, bounces)
    return total


def radiance(scene: Scene, points: np.ndarray, bounces: float) -> np.ndarray:
    """Of the wall at points (..., 3) of it, the reflection there counted among `bounces` [W/(m2 sr)]."""
    (wall,) = scene.surfaces
    reflected = wall.reflectance / np.pi * irradiance(scene, points, bounces - 1) if bounces else 0.0
    return wall.radiance + reflected + np.zeros(points.shape[:-1])


def geometric(ratio: float, terms: float) -> float:
    """1 + ratio + ... of so many terms (inf: all), without cancellation near 1."""
    if ratio == 0 or terms == 0:
        return float(terms > 0)
    if ratio == 1:
        return float(terms)
    return float(-np.expm1(terms * np.log(ratio)) / (1 - ratio))


def hits(wall: Surface, origin: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Where rays from `origin` along w (..., 3) meet the sphere from inside."""
    w = geometry.unit(w)
    o = np.array(wall.shape.center) - origin
    b = w @ o
    foot = o - b[..., None] * w
    return origin + (b + np.sqrt(wall.shape.radius**2 - np.einsum("...i,...i", foot, foot)))[..., None] * w


def film(scene: Scene, elements: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """Film (n,): at the points, or the pixels' means by the quadrature `nodes` (m, 3): p, q, weight."""
    bounces = np.inf if scene.max_bounces == "all" else scene.max_bounces
    if isinstance(scene.film, PointsFilm):
        return irradiance(scene, elements[:, :3], bounces)
    steps = elements[:, None, 3:6] * nodes[:, :1] + elements[:, None, 6:9] * nodes[:, 1:2]
    points = hits(scene.surfaces[0], elements[0, :3], elements[:, None, 9:12] + steps)
    return radiance(scene, points, bounces) @ nodes[:, 2]
