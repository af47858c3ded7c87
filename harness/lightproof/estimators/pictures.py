"""What a camera sees: the radiance of lights and skies, and what surfaces reflect once. Pixels are split along the outlines of
all shapes and along the edges of shadows, which are lines and conics in the picture too.

An element of a camera's film is a row (12,): in perspective the direction through its middle, its steps, and the eye; in parallel
projection its middle, its steps, and the direction of view.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numba.extending import overload

from lightproof import geometry
from lightproof.estimators import outlook, world
from lightproof.estimators.cells import HIGHEST
from lightproof.estimators.sheet import EVERYWHERE, Sheet, tidied
from lightproof.estimators.soft_curves import edges
from lightproof.estimators.sources import desk, irradiance
from lightproof.estimators.supports import plane_of
from lightproof.estimators.terms import Term
from lightproof.estimators.tracing import front_normal, nearest, sky_radiance
from lightproof.estimators.vectors import along, dot, unit
from lightproof.estimators.world import RADIANCE, REFLECTANCE, Item
from lightproof.geometry import Disk, Polygon, Sphere
from lightproof.scene import CameraFilm, OvercastSky, PlaneFilm, Scene

MARGIN = 1e-6  # of a picture: added to what bounds a line


class Picture(NamedTuple):
    """What reflects the light of `source` among `items` before `skies` (see `world`), and `glow` times what shines itself."""

    source: Any
    items: np.ndarray
    skies: np.ndarray
    perspective: bool
    glow: float


@overload(desk)
def _desk(source):
    return (lambda source: desk(source.source)) if getattr(source, "instance_class", None) is Picture else None


@overload(irradiance)
def _irradiance(source, desk, x, n):
    return seen if getattr(source, "instance_class", None) is Picture else None


def seen(source, desk, x, n):
    """Radiance along a ray: from the eye n in the direction x, or from x in the direction n."""
    origin, w = (n, unit(x)) if source.perspective else (x, n)
    i, t = nearest(source.items, origin, w, 0.0)
    if i < 0:
        return source.glow * sky_radiance(source.skies, w)
    place = along(origin, t, w)
    facing = front_normal(source.items[i], place)
    if dot(facing, w) >= 0:
        return 0.0
    value = source.glow * source.items[i, RADIANCE]
    if source.items[i, REFLECTANCE] > 0:
        value += source.items[i, REFLECTANCE] / math.pi * irradiance(source.source, desk, place, facing)
    return value


def terms(scene: Scene) -> list[Term]:
    """One term for each of the scene's direct light; what shines itself goes with the first."""
    whole, perspective = world.build(scene), scene.film.projection == "perspective"
    outlines = tidied(list(curves(scene)))

    def picture(source: Any, glow: float) -> Term:
        return Term(Picture(source, whole.items, whole.skies, perspective, glow), outlines, HIGHEST)

    return [picture(term.source, float(number == 0)) for number, term in enumerate(outlook.all_terms(scene))]


def rows(film: CameraFilm) -> np.ndarray:
    """The film's elements (n, 12)."""
    code, elements = world.film_rows(film)
    if code == world.PERSPECTIVE:
        elements[:, :3], elements[:, 9:] = elements[:, 9:].copy(), elements[:, :3].copy()
    return elements


def curves(scene: Scene) -> Iterator[np.ndarray]:
    """Rows of curves in the picture: outlines, the horizon of a sky, and what the light on flat surfaces shows."""
    lens = Lens(scene.film)
    for thing in (*scene.lights, *scene.surfaces):
        if isinstance(thing, Item):
            yield from lens.outline(thing.shape)
    if any(isinstance(light, OvercastSky) or getattr(light, "extent", "") == "upper" for light in scene.lights):
        yield lens.horizon()
    for surface in scene.surfaces:
        if surface.reflectance and scene.max_bounces and isinstance(surface.shape, Polygon | Disk):
            film = around(surface.shape, scene.film.resolution)
            for term in outlook.all_terms(replace(scene, film=film)):
                yield lens.on_plane(Sheet.of(film), term.curves)


def around(shape: Polygon | Disk, resolution: tuple[int, int]) -> PlaneFilm:
    """A film on a flat shape, as large as it is, that receives on its front."""
    point, normal = plane_of(shape)
    t, b = geometry.tangents(normal)
    corners = np.array(shape.vertices) if isinstance(shape, Polygon) else point + shape.radius * np.array([t + b, -t - b])
    s, r = (corners - point) @ t, (corners - point) @ b
    u, v = (s.max() - s.min()) * t, (r.max() - r.min()) * b
    origin = point + s.min() * t + r.min() * b
    return PlaneFilm("irradiance", *(tuple(vector.tolist()) for vector in (origin, u, v)), resolution)


class Lens:
    """How places lie in the picture of a camera: a sheet of directions (perspective) or of places, rays running along `view`."""

    def __init__(self, film: CameraFilm):
        right, up, forward = geometry.camera_frame(film.origin, film.target, film.up)
        half_width, half_height = film.half_extent
        self.perspective = film.projection == "perspective"
        self.eye, self.view = np.array(film.origin), forward
        center = forward if self.perspective else self.eye
        self.sheet = Sheet(center, 2 * half_width * right, -2 * half_height * up, forward, film.grid)

    def ray(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Origins and directions of the rays at points (..., 3) of the sheet."""
        shape = np.broadcast_shapes(x.shape, (3,))
        return (np.broadcast_to(self.eye, shape), x) if self.perspective else (x, np.broadcast_to(self.view, shape))

    def outline(self, shape: geometry.Shape) -> Iterator[np.ndarray]:
        match shape:
            case Polygon():
                yield self.lines(edges(np.array(shape.vertices)))
            case Disk():
                yield self.sheet.conics(self.rim(shape))
            case Sphere():
                yield self.sheet.conics(self.tangent(shape))

    def lines(self, sides: np.ndarray) -> np.ndarray:
        """Rows for straight edges (m, 2, 3), as long as those where their ends lie before the camera."""
        if not self.perspective:
            normals = np.cross(sides[:, 1] - sides[:, 0], self.view)
            return self.sheet.lines(normals, sides[:, 0], boxes(self.sheet.places(sides)))
        offsets = sides - self.eye
        depth = offsets @ self.view
        with np.errstate(divide="ignore", invalid="ignore"):
            places = self.sheet.places(offsets / depth[..., None])
        bounds = np.where((depth > 0).all(axis=1)[:, None], boxes(places), EVERYWHERE)
        normals = np.cross(offsets[:, 0], offsets[:, 1])
        seen_flat = np.abs(normals).max(axis=1) > 0
        return self.sheet.lines(normals[seen_flat], np.zeros_like(normals[seen_flat]), bounds[seen_flat])

    def rim(self, disk: Disk) -> Callable[[np.ndarray], np.ndarray]:
        """Zero where a ray meets a circle."""
        center, normal = np.array(disk.center), geometry.unit(disk.normal)

        def f(x: np.ndarray) -> np.ndarray:
            origin, w = self.ray(x)
            slope = (w @ normal)[:, None]
            miss = (origin - center) * slope - w * ((origin - center) @ normal)[:, None]
            return ((miss**2).sum(axis=-1) - disk.radius**2 * slope[:, 0] ** 2)[None]

        return f

    def tangent(self, ball: Sphere) -> Callable[[np.ndarray], np.ndarray]:
        """Zero where a ray touches a sphere."""

        def f(x: np.ndarray) -> np.ndarray:
            origin, w = self.ray(x)
            return ((np.cross(w, origin - ball.center) ** 2).sum(axis=-1) - ball.radius**2 * (w**2).sum(axis=-1))[None]

        return f

    def horizon(self) -> np.ndarray:
        return self.sheet.lines(np.array([[0.0, 0.0, 1.0]]), np.zeros((1, 3))) if self.perspective else np.zeros((0, 10))

    def on_plane(self, plane: Sheet, rows: np.ndarray) -> np.ndarray:
        """Rows of curves on a flat surface as they lie in the picture."""
        p_axis, q_axis = np.linalg.pinv(np.stack([plane.u, plane.v], axis=1))

        def f(x: np.ndarray) -> np.ndarray:
            origin, w = self.ray(x)
            slope = w @ plane.normal
            place = (origin - plane.center) * slope[:, None] - w * ((origin - plane.center) @ plane.normal)[:, None]
            p, q = place @ p_axis, place @ q_axis
            basis = np.stack([slope**2, p * slope, q * slope, p * p, p * q, q * q])
            straight = (rows[:, 3:6] == 0).all(axis=1)
            return np.where(straight[:, None], rows[:, :3] @ np.stack([slope, p, q]), rows[:, :6] @ basis)

        return self.sheet.conics(f) if len(rows) else np.zeros((0, 10))


def boxes(places: np.ndarray) -> np.ndarray:
    """Boxes (m, 4) around the ends (m, 2, 2) of lines."""
    low, high = places.min(axis=1) - MARGIN, places.max(axis=1) + MARGIN
    return np.stack([low[:, 0], high[:, 0], low[:, 1], high[:, 1]], axis=1)
