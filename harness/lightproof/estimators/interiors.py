"""What a film inside a closed shape receives: light straight from point lights, and the even light of `zones`.

A pixel's mean is split along what a camera sees of the boundary between two zones, and of the outline of a sphere inside.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof import geometry
from lightproof.estimators.cells import HIGHEST
from lightproof.estimators.compiled import strict
from lightproof.estimators.pictures import Lens
from lightproof.estimators.sheet import tidied
from lightproof.estimators.sources import desk, irradiance
from lightproof.estimators.supports import plane_of
from lightproof.estimators.terms import Term
from lightproof.estimators.tracing import vector
from lightproof.estimators.vectors import along, cross, dot, norm, scaled, sub, unit
from lightproof.estimators.zones import Zones, is_closed, room_zones, sphere_zones
from lightproof.geometry import Cap, Disk, Vec3
from lightproof.scene import CameraFilm, PlaneFilm, PointLight, PointsFilm, Scene, Surface

ON_WALL = 1e-9  # of the radius, or of a room's size


class Inside(NamedTuple):
    """A sphere, what lies within `cosine` of `axis` being its first zone, around a `core` (radius 0: none); the `radiance` (2,)
    of the zones, the core's being the second, without the `share` (2,) of light straight from `bulbs` (l, 4: place, intensity)
    that each sends into a direction."""

    center: Vec3
    radius: float
    axis: Vec3
    cosine: float
    core: float
    radiance: np.ndarray
    share: np.ndarray
    bulbs: np.ndarray


@overload(desk)
def _desk(source):
    return (lambda source: 0) if getattr(source, "instance_class", None) is Inside else None


@overload(irradiance)
def _irradiance(source, desk, x, n):
    return seen_inside if getattr(source, "instance_class", None) is Inside else None


def seen_inside(source, desk, x, n):
    """Radiance that comes to the eye n from the direction x."""
    w, o = unit(x), sub(source.center, n)
    forth, aside = dot(o, w), cross(o, w)
    foot = dot(aside, aside)
    if foot < source.core * source.core and forth > 0:
        return source.radiance[1]
    place = along(n, forth + math.sqrt(source.radius * source.radius - foot), w)
    out = scaled(1 / source.radius, sub(place, source.center))
    zone = 0 if dot(out, source.axis) >= source.cosine or source.core > 0 else 1
    straight = 0.0
    for i in range(len(source.bulbs)):
        straight += from_bulb(source.bulbs[i], place, out)
    return source.radiance[zone] + source.share[zone] * straight


@strict
def from_bulb(bulb, place, out):
    d = sub(vector(bulb, 0), place)
    return -bulb[3] * dot(d, out) / norm(d) ** 3


def is_inside(scene: Scene) -> bool:
    """Whether this is light in a sphere or a room that reflects it."""
    return any(surface.side == "inside" for surface in scene.surfaces) or (scene.reflects and is_closed(scene.surfaces))


def unsupported(scene: Scene) -> str | None:
    """Why this light in a sphere or a room has no closed form."""
    if not any(surface.side == "inside" for surface in scene.surfaces):
        return in_room(scene)
    zones = sphere_zones(scene)
    if isinstance(zones, str):
        return zones
    wall = zones.surfaces[0]
    if not all(isinstance(light, PointLight) for light in scene.lights):
        return "its closed form of a sphere's interreflection takes point lights only; path can"
    if not all(distance(wall, light.position) < 1 for light in scene.lights):
        return f"a light stands outside the sphere '{wall.id}'; path can"
    return in_sphere(scene, zones)


def in_sphere(scene: Scene, zones: Zones) -> str | None:
    wall, film = zones.surfaces[0], scene.film
    match film:
        case CameraFilm(projection="perspective") if distance(wall, film.origin) < 1 and not in_core(zones, film.origin):
            return None
        case PointsFilm(quantity="irradiance") if all(zone_at(zones, *receiver) is not None for receiver in receivers(film)):
            return None
    return (f"its closed form takes points of the wall of '{wall.id}' that face its centre, or a perspective camera inside;"
            " path can")


def in_core(zones: Zones, place: Vec3) -> bool:
    return len(zones.surfaces) == 2 and zones.surfaces[1].side == "outside" and distance(zones.surfaces[1], place) <= 1


def receivers(film: PointsFilm) -> list[tuple[Vec3, Vec3]]:
    return list(zip(film.positions, film.normals, strict=True))


def zone_at(zones: Zones, place: Vec3, normal: Vec3) -> int | None:
    """The zone on which a receiver lies and which faces as it does; None where there is none."""
    for number, surface in enumerate(zones.surfaces):
        facing = 1 if surface.side == "outside" else -1
        out = geometry.unit(np.subtract(place, surface.shape.center))
        here = abs(distance(surface, place) - 1) < ON_WALL and np.abs(geometry.unit(normal) - facing * out).max() < ON_WALL
        if here and (not isinstance(surface.shape, Cap) or out @ geometry.unit(surface.shape.axis) >= cosine(surface.shape)):
            return number
    return None


def cosine(cap: Cap) -> float:
    return float(np.cos(np.radians(cap.half_angle)))


def distance(wall: Surface, place: Vec3) -> float:
    """Distance from the centre, in radii."""
    return float(np.linalg.norm(np.subtract(place, wall.shape.center))) / wall.shape.radius


def in_room(scene: Scene) -> str | None:
    """Why a film in a room has no closed form: it must lie inside, or under a point light be a wall or its quarters."""
    zones = room_zones(scene)
    if isinstance(zones, str):
        return zones
    if scene.lights:
        return None if is_wall(scene) else "its closed form around a point light in a cube is the mean over a wall or a quarter"
    places = corners(scene.film)
    inside = all(is_within(scene.surfaces, place) for place in places)
    return None if inside else "its closed form takes films inside a convex room only"


def corners(film: CameraFilm | PlaneFilm | PointsFilm) -> list[np.ndarray]:
    """Places that lie inside a room where the film does."""
    match film:
        case CameraFilm():
            return [np.array(film.origin)]
        case PlaneFilm():
            return [np.array(film.origin) + a * np.array(film.u) + b * np.array(film.v) for a in (0, 0.5, 1) for b in (0, 0.5, 1)]
    return list(map(np.array, film.positions))


def is_within(walls: tuple[Surface, ...], place: np.ndarray) -> bool:
    """Whether a room is convex and a place lies in it or on its walls."""
    places = np.concatenate([[place], *(wall.shape.vertices for wall in walls)])
    slack = ON_WALL * np.abs(places).max()
    return all(((places - point) @ normal).min() >= -slack for point, normal in (plane_of(wall.shape) for wall in walls))


def is_wall(scene: Scene) -> bool:
    """Whether a film is a whole wall, in one element, halves or quarters, and looks inward."""
    film = scene.film
    if not isinstance(film, PlaneFilm) or max(film.resolution) > 2:
        return False
    ends = np.array(film.origin) + np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) @ [film.u, film.v]
    slack = ON_WALL * np.abs(ends).max()
    for wall in scene.surfaces:
        apart = np.abs(ends[:, None] - np.array(wall.shape.vertices)[None]).max(axis=2).min(axis=1)
        if apart.max() <= slack and film.normal @ wall.shape.normal > 0:
            return True
    return False


def even(scene: Scene) -> np.ndarray | None:
    """The film (n,) where it needs no quadrature: everything but a picture of a sphere's inside."""
    bounces = np.inf if scene.max_bounces == "all" else scene.max_bounces
    if is_closed(scene.surfaces):
        zones = room_zones(scene)
        wall = zones.surfaces[0]
        if isinstance(scene.film, CameraFilm):
            reflected = wall.reflectance / np.pi * zones.irradiance(bounces - 1)[0] if bounces else 0.0
            return np.full(scene.size, wall.radiance + reflected)
        return np.full(scene.size, zones.irradiance(bounces)[0] + zones.lit[0])
    if not isinstance(scene.film, PointsFilm):
        return None
    zones = sphere_zones(scene)
    steady = zones.irradiance(bounces)
    return np.array([steady[zone_at(zones, *receiver)] + straight(scene, zones, *receiver) for receiver in receivers(scene.film)])


def straight(scene: Scene, zones: Zones, place: Vec3, normal: Vec3) -> float:
    """Irradiance from point lights [W/m2]."""
    wall = zones.surfaces[0].shape
    out = np.subtract(place, wall.center) / wall.radius
    ways = [(light.intensity, np.subtract(light.position, place)) for light in scene.lights]
    return float(sum(-intensity * (way @ out) / np.linalg.norm(way) ** 3 for intensity, way in ways))


def term(scene: Scene) -> Term:
    """What a camera inside a sphere sees."""
    zones, lens = sphere_zones(scene), Lens(scene.film)
    bounces = np.inf if scene.max_bounces == "all" else scene.max_bounces
    wall, other = zones.surfaces[0], zones.surfaces[-1]
    share = zones.reflectance / np.pi if bounces else np.zeros(len(zones.surfaces))
    reflected = share * zones.irradiance(bounces - 1) if bounces else 0.0
    radiance = np.array([surface.radiance for surface in zones.surfaces]) + reflected
    cap, core = isinstance(wall.shape, Cap), other.side == "outside"
    source = Inside(
        center=wall.shape.center,
        radius=wall.shape.radius,
        axis=tuple(geometry.unit(wall.shape.axis).tolist()) if cap else (0.0, 0.0, 1.0),
        cosine=cosine(wall.shape) if cap else -2.0,
        core=other.shape.radius if core else 0.0,
        radiance=radiance[[0, -1]],
        share=share[[0, -1]],
        bulbs=np.array([[*light.position, light.intensity] for light in scene.lights], float).reshape(-1, 4),
    )
    outline = [lens.sheet.conics(lens.rim(rim(wall.shape)))] if cap else list(lens.outline(other.shape)) if core else []
    return Term(source, tidied(outline), HIGHEST)


def rim(cap: Cap) -> Disk:
    """The disk in the opening of a cap."""
    axis, angle = geometry.unit(cap.axis), np.radians(cap.half_angle)
    center = np.array(cap.center) + cap.radius * np.cos(angle) * axis
    return Disk(tuple(center.tolist()), cap.axis, float(cap.radius * np.sin(angle)))
