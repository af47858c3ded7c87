"""Reflected light in a sphere, summed and not walked: the form factor from anywhere on the wall to dA is dA/(4 pi r^2), so that
the vertices of a path after the first are independent points, uniform over the sphere, and its series is geometric.

With <f> the mean of f over the wall, a place of the wall receives E = E_bulbs + pi <L>, and after up to n reflections
<L> = <Le> (1 - <rho>^(n+1))/(1 - <rho>) + <rho E_bulbs>/pi (1 - <rho>^n)/(1 - <rho>). By Gauss' law <E_bulbs> is the bulbs'
intensity over r^2. Where two zones differ in reflectance, one point of the smaller stands for what it receives.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof import geometry
from lightproof.estimators import shapes
from lightproof.estimators.aiming import from_bulbs, spot
from lightproof.estimators.batch import NORMAL, PLACE, TOTAL, WEIGHT, at, put
from lightproof.estimators.compiled import strict
from lightproof.estimators.rng import block_keys, draws
from lightproof.estimators.vectors import scaled
from lightproof.estimators.world import PERSPECTIVE, film_rows
from lightproof.estimators.zones import geometric
from lightproof.geometry import Cap, Sphere, Vec3
from lightproof.scene import PointLight, PointsFilm, Scene, Surface

ON_WALL = 1e-9  # of the radius
ZONE = 2**32  # number of the draws for points of a zone, beyond every lamp's


class Even(NamedTuple):
    """The wall receives `even` [W/m2] besides the light of bulbs."""

    even: float


class Zoned(NamedTuple):
    """The same, and `excess` times what a point of the `zone` receives from bulbs, uniform over it."""

    even: float
    zone: shapes.Cap
    excess: float


def reflect(recursion, bulbs, state, count, key, near):
    """Adds all that vertices on the wall receive, but the light of bulbs."""


@overload(reflect)
def _reflect(recursion, bulbs, state, count, key, near):
    return reflect_zoned if recursion.instance_class is Zoned else reflect_even


def reflect_even(recursion, bulbs, state, count, key, near):
    for i in range(count):
        state[TOTAL + i] += state[WEIGHT + i] * recursion.even


def reflect_zoned(recursion, bulbs, state, count, key, near):
    reflect(Even(recursion.even), bulbs, state, count, key, near)
    jump(recursion.zone, recursion.excess, state, count, block_keys(key, ZONE))
    from_bulbs(bulbs, (), state, count, near)


@strict
def jump(zone, excess, state, count, keys):
    """On to points uniform over the zone."""
    for i in range(count):
        s, t = draws(i, keys, 1.0)[:2]
        x, n, _ = spot(zone, 1.0, at(state, PLACE, i), s, t)
        put(state, PLACE, i, x)
        put(state, NORMAL, i, scaled(-1.0, n))
        state[WEIGHT + i] *= excess


def recursion(scene: Scene) -> Even | Zoned:
    """That of a scene for which `unsupported` gives no reason."""
    zone, rest = min(scene.surfaces, key=area), max(reversed(scene.surfaces), key=area)
    share = 0.0 if zone is rest else area(zone) / (area(zone) + area(rest))
    reflectance = share * zone.reflectance + (1 - share) * rest.reflectance
    glow = share * zone.radiance + (1 - share) * rest.radiance
    bounces = np.inf if scene.max_bounces == "all" else scene.max_bounces
    left = max(bounces if on_wall(scene) else bounces - 1, -1)
    echo = geometric(reflectance, max(left, 0))
    lit = sum(light.intensity for light in scene.lights) / rest.shape.radius**2
    even = float(np.pi * glow * geometric(reflectance, left + 1) + echo * rest.reflectance * lit)
    if zone.reflectance == rest.reflectance or not lit:
        return Even(even)
    return Zoned(even, shapes.parts(zone.shape)[0], float(echo * share * (zone.reflectance - rest.reflectance)))


def area(wall: Surface) -> float:
    return wall.shape.area


def unsupported(scene: Scene) -> str | None:
    """Why reflected light is not the same everywhere on the wall, or this film cannot tell."""
    walls = scene.surfaces
    if not is_sphere(walls):
        return "its recursion holds inside one sphere only, whole or of two caps that complete each other; path can"
    strange = [light.id for light in scene.lights if not isinstance(light, PointLight) or offset(walls[0], light.position) >= 1]
    if strange:
        return f"its recursion takes point lights inside '{walls[0].id}' only, which '{strange[0]}' is not; path can"
    if not all(offset(walls[0], place) < 1 - ON_WALL or faces_centre(walls[0], place, normal) for place, normal in places(scene)):
        return f"its recursion takes films inside '{walls[0].id}', or points of it that face its centre; path can"
    return None


def is_sphere(walls: tuple[Surface, ...]) -> bool:
    """Whether the surfaces are one whole sphere seen from inside."""
    shapes = [wall.shape for wall in walls if wall.side == "inside"]
    match shapes:
        case [Sphere()]:
            return len(walls) == 1
        case [Cap() as one, Cap() as other]:
            return len(walls) == 2 and one.completes(other)
    return False


def on_wall(scene: Scene) -> bool:
    """Whether the film lies on the wall, so that no ray leads there."""
    return all(offset(scene.surfaces[0], place) > 1 - ON_WALL for place, _ in places(scene))


def places(scene: Scene) -> list[tuple[np.ndarray, np.ndarray | None]]:
    """Places between which all of the film lies, with its normal there; the eyes of a camera have none."""
    film = scene.film
    if isinstance(film, PointsFilm):
        return list(zip(map(np.array, film.positions), map(geometry.unit, film.normals), strict=True))
    kind, rows = film_rows(film)
    if kind == PERSPECTIVE:
        return [(rows[0, :3], None)]
    corners = [rows[:, :3] + p * rows[:, 3:6] + q * rows[:, 6:9] for p in (-0.5, 0.5) for q in (-0.5, 0.5)]
    return [(place, getattr(film, "normal", None)) for place in np.concatenate(corners)]


def offset(wall: Surface, place: Vec3) -> float:
    """Distance from the centre, in radii."""
    return float(np.linalg.norm(np.subtract(place, wall.shape.center))) / wall.shape.radius


def faces_centre(wall: Surface, place: np.ndarray, normal: np.ndarray | None) -> bool:
    """Whether a receiver lies on the wall and faces as it does."""
    inward = geometry.unit(np.subtract(wall.shape.center, place))
    return normal is not None and abs(offset(wall, place) - 1) < ON_WALL and np.abs(normal - inward).max() < ON_WALL
