"""A scene's direct light as a sum of terms: a source with what blocks it, and the curves between which a film of it is smooth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lightproof import geometry
from lightproof.estimators import elements, hard_curves, soft_curves, world
from lightproof.estimators.analytic_limits import receiving_planes, shades
from lightproof.estimators.blockers import Casters, between, standing
from lightproof.estimators.cells import HIGHEST
from lightproof.estimators.flats import Plane, polygon_light
from lightproof.estimators.hard_curves import Rays
from lightproof.estimators.hard_lights import TOUCH, Bulb, Solids
from lightproof.estimators.round_lights import Rounds
from lightproof.estimators.sheet import Sheet, tidied
from lightproof.estimators.sky_rows import SKIES, sky_rows
from lightproof.estimators.world import Item
from lightproof.geometry import Cylinder, Disk, Polygon, Sphere
from lightproof.scene import (
    DirectionalLight,
    PlaneFilm,
    PointLight,
    PointsFilm,
    Scene,
)

COARSE = 4  # nodes of a rule that is to shrink past a light's edges


@dataclass(frozen=True)
class Term:
    """A `source` for the kernels, the `curves` (m, 10) of its light on a plane film, and how many nodes a rule over an element
    may have at `most` a side: few where the light has edges that no curve follows."""

    source: Any
    curves: np.ndarray
    most: int


def terms(scene: Scene) -> list[Term]:
    """One term for each polygon that shines, each point light and each beam, and one for all disks, spheres and skies."""
    things = standing(scene)
    sheet = Sheet.of(scene.film) if isinstance(scene.film, PlaneFilm) else None
    bulbs = [light for light in scene.lights if isinstance(light, PointLight | DirectionalLight)]
    return [*soft(scene, things, sheet), *hard(scene, bulbs, things, sheet), *rounds(scene)]


def soft(scene: Scene, things: list[Item], sheet: Sheet | None) -> Iterator[Term]:
    flats = {thing.id: thing for thing in things if isinstance(thing.shape, Polygon)}
    casters, planes, reach = Casters.of(flats.values()), receiving_planes(scene), farthest(scene)
    for lamp in flats.values():
        if lamp.radiance:
            front = np.array(lamp.shape.vertices[0]), lamp.shape.normal
            before = {owner for plane in planes for owner in between(casters, lamp.id, plane, front).owners}
            blockers = [flat.shape for flat in flats.values() if flat.id in before]
            source = polygon_light(lamp.shape, lamp.radiance, blockers, reach)
            loops = [np.array(shape.vertices) for shape in (lamp.shape, *blockers)]
            yield Term(source, tidied(soft_curves.curves(sheet, loops[0], loops[1:]) if sheet else []), HIGHEST)


def farthest(scene: Scene) -> float:
    """The largest coordinate of any receiver [m]."""
    match scene.film:
        case PlaneFilm() as film:
            return float(np.abs([film.origin, film.u, film.v]).sum(axis=0).max())
        case PointsFilm() as film:
            return float(np.abs(film.positions).max())
    return float(np.abs(scene.film.origin).max())


def hard(scene: Scene, bulbs: list[PointLight | DirectionalLight], things: list[Item], sheet: Sheet | None) -> Iterator[Term]:
    shapes = [thing.shape for thing in things]
    for bulb in bulbs:
        beam = isinstance(bulb, DirectionalLight)
        place = np.array(bulb.direction if beam else bulb.position, float)
        source = Bulb(
            position=tuple((-place if beam else place).tolist()),
            strength=float(bulb.irradiance if beam else bulb.intensity),
            reach=np.inf if beam else 1.0,
            solids=obstacles(shapes, max(farthest(scene), 0.0 if beam else float(np.abs(place).max()))),
        )
        yield Term(source, tidied(hard_curves.curves(sheet, Rays(place, beam), shapes) if sheet else []), HIGHEST)


def obstacles(shapes: list[geometry.Shape], reach: float) -> Solids:
    """What may stand between a light and receivers with coordinates up to `reach` [m]."""
    loops = [np.array(shape.vertices) for shape in shapes if isinstance(shape, Polygon)]
    planes = [Plane.of(shape) for shape in shapes if isinstance(shape, Polygon)]
    rows = {
        kind: np.array([round_row(shape) for shape in shapes if isinstance(shape, kind)], float).reshape(-1, 8)
        for kind in (Disk, Sphere, Cylinder)
    }
    return Solids(
        corners=np.concatenate([np.zeros((0, 3)), *loops]),
        starts=np.cumsum([0, *map(len, loops)]),
        normals=np.array([(plane.frame[2], plane.low) for plane in planes], float).reshape(-1, 2, 3),
        disks=rows[Disk],
        balls=rows[Sphere],
        tubes=rows[Cylinder],
        touch=TOUCH * reach,
    )


def round_row(shape: Disk | Sphere | Cylinder) -> list[float]:
    match shape:
        case Disk():
            return [*shape.center, *geometry.unit(np.array(shape.normal)), shape.radius, 0.0]
        case Sphere():
            return [*shape.center, 0.0, 0.0, 0.0, shape.radius, 0.0]
    return [*shape.base, *geometry.unit(np.array(shape.axis)), shape.radius, shape.height]


def rounds(scene: Scene) -> Iterator[Term]:
    things = [item for item in (*scene.lights, *scene.surfaces) if isinstance(item, Item) and item.radiance]
    if any(isinstance(light, SKIES) for light in scene.lights) or any(not isinstance(item.shape, Polygon) for item in things):
        seen = without_tubes(scene)
        whole = world.build(seen)
        shade = shades(seen, whole.items)
        yield Term(Rounds(whole.items, sky_rows(scene), shade), tidied([]), COARSE if (shade >= 0).any() else HIGHEST)


def without_tubes(scene: Scene) -> Scene:
    """The scene without cylinders, which stand before no light that `terms` has."""
    lights, surfaces = (tuple(item for item in items if not isinstance(getattr(item, "shape", None), Cylinder))
                        for items in (scene.lights, scene.surfaces))
    return replace(scene, lights=lights, surfaces=surfaces)


def receivers(scene: Scene) -> np.ndarray:
    """Rows (n, 12) of the film's elements, see `world.film_rows`; the normals of points as they are given."""
    _, rows = world.film_rows(scene.film)
    if isinstance(scene.film, PointsFilm):
        rows[:, elements.NORMAL] = scene.film.normals
    return rows

