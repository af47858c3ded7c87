"""Light that is reflected once at most on its way: by what a camera sees, or by flat surfaces that a beam lights evenly."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np

from lightproof import geometry
from lightproof.estimators.blockers import encloses
from lightproof.estimators.supports import plane_of, reaches, support
from lightproof.geometry import Disk, Polygon, Shape
from lightproof.scene import CameraFilm, DirectionalLight, Scene, Surface

EDGE_ON = 1e-15  # sine of the angle between a beam and what it passes along


def once(scene: Scene) -> Scene:
    """The same light with one reflection, for a camera, or as direct light of surfaces that glow with what they reflect; the
    scene as it is where it is neither."""
    reflecting = [surface for surface in scene.surfaces if surface.reflectance]
    if not scene.reflects or (scene.max_bounces != 1 and any(exchange(a.shape, b.shape) for a, b in combinations(reflecting, 2))):
        return scene
    if isinstance(scene.film, CameraFilm):
        return replace(scene, max_bounces=1)
    if not all(lit_evenly(scene, surface) for surface in reflecting):
        return scene
    return replace(scene, surfaces=tuple(glowing(scene, surface) for surface in scene.surfaces), max_bounces=0)


def exchange(one: Shape, other: Shape) -> bool:
    """Whether any light may go from one convex surface's front to another's."""
    flat = [(shape, partner) for shape, partner in ((one, other), (other, one)) if isinstance(shape, Polygon | Disk)]
    return all(reaches(partner, *plane_of(shape)) for shape, partner in flat)


def lit_evenly(scene: Scene, surface: Surface) -> bool:
    """Whether beams alone light a polygon, and nothing stands in their way."""
    if not isinstance(surface.shape, Polygon) or not all(isinstance(light, DirectionalLight) for light in scene.lights):
        return False
    others = [other for other in scene.surfaces if other is not surface]
    return not any(other.radiance or encloses(other) for other in others) and not any(
        in_the_way(other.shape, surface.shape, geometry.unit(light.direction)) for other in others for light in scene.lights
    )


def in_the_way(other: Shape, lit: Polygon, direction: np.ndarray) -> bool:
    """Whether a shape may stand in a beam before a polygon: it reaches in front of that, and no plane along the beam and an edge
    parts the two."""
    edge_on = isinstance(other, Polygon | Disk) and abs(plane_of(other)[1] @ direction) <= EDGE_ON
    if direction @ lit.normal >= 0 or edge_on or not reaches(other, *plane_of(lit)):
        return False
    corners = np.array(lit.vertices)
    across = np.cross(np.roll(corners, -1, axis=0) - corners, direction)
    sides = geometry.unit(across[np.abs(across).any(axis=1)])
    return not any(
        support(other, side) <= (corners @ side).min() or -support(other, -side) >= (corners @ side).max() for side in sides
    )


def glowing(scene: Scene, surface: Surface) -> Surface:
    """A surface that shines with what it reflects of beams: rho E / pi."""
    falls = [-(geometry.unit(light.direction) @ surface.shape.normal) * light.irradiance for light in scene.lights]
    lit = sum(max(float(fall), 0.0) for fall in falls) if surface.reflectance else 0.0
    return replace(surface, radiance=surface.radiance + surface.reflectance * lit / np.pi, reflectance=0.0)
