"""A scene as arrays, for the kernels that trace rays through any scene: one row per piece of a surface or light.

Columns of an item: kind, centre, u, v, normal, dual u, dual v (as in `shapes`), radius, radiance, reflectance, side (+1: the
front is out, -1: in), area, whether its light is sampled point by point, whether it is a light; a cap has its axis for the
normal and the cosine of its half-angle for dual u. Rows of a sky: kind, radiance, direction, cosine of the half-angle. Rows
of a bulb (point light or beam): kind, position or direction, strength.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lightproof import geometry
from lightproof import scene as scenes
from lightproof.estimators import shapes
from lightproof.estimators.shapes import Cap, Disk, Parallelogram, Sphere, Triangle
from lightproof.scene import Scene

KIND, CENTER, U, V, NORMAL, DUAL_U, DUAL_V, RADIUS, RADIANCE, REFLECTANCE, SIDE, AREA, SAMPLED, LAMP, WIDTH = (
    0, 1, 4, 7, 10, 13, 16, 19, 20, 21, 22, 23, 24, 25, 26)  # fmt: skip
COSINE = DUAL_U
KINDS = {Parallelogram: 0, Triangle: 1, Disk: 2, Sphere: 3, Cap: 4}
PARALLELOGRAM, TRIANGLE, DISK, SPHERE, CAP = KINDS.values()
UNIFORM, UPPER, SUN, OVERCAST = range(4)
POINT, BEAM = range(2)
RECEIVER, PERSPECTIVE, ORTHOGRAPHIC = range(3)
CONTACT = 1e-9  # of the scene's size: what lies nearer than this touches

Item = scenes.AreaLight | scenes.Surface


@dataclass(frozen=True)
class World:
    """`items` (m, WIDTH), `skies` (k, 6), `bulbs` (l, 5); `film` is a code, `elements` (n, 12) its rows: origin, steps along
    a row and a column, and normal or direction of view; `contact` [m] is the distance that counts as touching."""

    items: np.ndarray
    skies: np.ndarray
    bulbs: np.ndarray
    film: int
    elements: np.ndarray
    contact: float

    @property
    def arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, int, np.ndarray, float]:
        """What every kernel takes."""
        return self.items, self.skies, self.bulbs, self.film, self.elements, self.contact


def build(scene: Scene, sample_surfaces: bool = True) -> World:
    """The arrays of a scene; `sample_surfaces`: whether a surface's own emission is sampled point by point, like a light's."""
    things = [item for item in (*scene.lights, *scene.surfaces) if isinstance(item, Item)]
    items = [item_row(item, piece, sample_surfaces) for item in things for piece in shapes.parts(item.shape)]
    skies = [row for light in scene.lights for row in sky_rows(light)]
    bulbs = [row for light in scene.lights for row in bulb_rows(light)]
    film, elements = film_rows(scene.film)
    items = np.array(items, float).reshape(-1, WIDTH)
    items[:, REFLECTANCE] *= scene.max_bounces != 0
    return World(items, np.array(skies, float).reshape(-1, 6), np.array(bulbs, float).reshape(-1, 5), film, elements,
                 CONTACT * size(scene.film, elements, items))


def size(film: scenes.Film, elements: np.ndarray, items: np.ndarray) -> float:
    """About the distance from the film to what it receives light from [m]; 1 where there is nothing."""
    reach = np.abs(items[:, CENTER:CENTER + 3] - elements[0, :3]).max(initial=0)
    return float(max(reach, items[:, RADIUS].max(initial=0))) or 1.0


def item_row(item: Item, piece: shapes.Flat | Sphere | Cap, sample_surfaces: bool) -> np.ndarray:
    row = np.zeros(WIDTH)
    row[KIND] = KINDS[type(piece)]
    if isinstance(piece, Sphere | Cap):
        row[CENTER:U], row[RADIUS] = piece.center, piece.radius
        if isinstance(piece, Cap):
            row[NORMAL:DUAL_U], row[COSINE] = piece.axis, piece.cosine
    else:
        row[CENTER:RADIUS] = np.concatenate([np.array(field) for field in piece])
    row[RADIANCE] = item.radiance
    row[REFLECTANCE] = getattr(item, "reflectance", 0.0)
    row[SIDE] = -1 if getattr(item, "side", "outside") == "inside" else 1
    row[AREA] = shapes.area(piece)
    row[LAMP] = isinstance(item, scenes.AreaLight)
    row[SAMPLED] = item.radiance > 0 and (sample_surfaces or row[LAMP])
    return row


def sky_rows(light: scenes.Light) -> list[list[float]]:
    match light:
        case scenes.Environment():
            return [[UNIFORM if light.extent == "sphere" else UPPER, light.radiance, 0, 0, 0, 0]]
        case scenes.SunDisc():
            return [[SUN, light.radiance, *geometry.unit(light.direction), np.cos(np.radians(light.half_angle))]]
        case scenes.OvercastSky():
            return [[OVERCAST, light.zenith_radiance, 0, 0, 0, 0]]
    return []


def bulb_rows(light: scenes.Light) -> list[list[float]]:
    match light:
        case scenes.PointLight():
            return [[POINT, *light.position, light.intensity]]
        case scenes.DirectionalLight():
            return [[BEAM, *geometry.unit(light.direction), light.irradiance]]
    return []


def film_rows(film: scenes.Film) -> tuple[int, np.ndarray]:
    """The film's code and its rows (n, 12); element (row, column) is origin + p step_u + q step_v, p and q in [-1/2, 1/2]."""
    rows, columns = film.grid
    row, column = (index[:, None] + 0.5 for index in np.divmod(np.arange(rows * columns), columns))
    match film:
        case scenes.PlaneFilm():
            u, v = np.array(film.u) / columns, np.array(film.v) / rows
            return RECEIVER, joined(np.array(film.origin) + column * u + row * v, u, v, film.normal)
        case scenes.PointsFilm():
            zero = np.zeros(3)
            return RECEIVER, joined(np.array(film.positions), zero, zero, geometry.unit(np.array(film.normals)))
    right, up, forward = geometry.camera_frame(film.origin, film.target, film.up)
    half_width, half_height = film.half_extent
    u, v = right * (2 * half_width / columns), -up * (2 * half_height / rows)
    offset = -half_width * right + half_height * up + column * u + row * v
    if film.projection == "perspective":
        return PERSPECTIVE, joined(np.array(film.origin), u, v, forward + offset)
    return ORTHOGRAPHIC, joined(np.array(film.origin) + offset, u, v, forward)


def joined(*columns: np.ndarray) -> np.ndarray:
    count = max(len(column) for column in columns if column.ndim == 2)
    return np.hstack([np.broadcast_to(column, (count, 3)) for column in columns])
