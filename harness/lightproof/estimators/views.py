"""Receivers of a film, for the kernel of direct light: cells, points, or the patches of one flat surface that pixels see."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lightproof import geometry
from lightproof import scene as scenes
from lightproof.estimators import elements
from lightproof.estimators.blockers import Plane, plane_of
from lightproof.estimators.extents import reaching
from lightproof.estimators.shapes import Disk, Flat, Parallelogram, Sphere, Triangle, parts
from lightproof.estimators.world import PERSPECTIVE, build, film_rows
from lightproof.scene import CameraFilm, Scene

COVERS = {
    Parallelogram: lambda s, t: (np.abs(s) <= 0.5) & (np.abs(t) <= 0.5),
    Triangle: lambda s, t: (s >= 0) & (t >= 0) & (s + t <= 1),
    Disk: lambda s, t: s**2 + t**2 <= 1,
}


@dataclass(frozen=True)
class View:
    """`receivers` (n, 15) of a film, see `elements`, and the `plane` that all of them lie in, if any. In perspective `slopes`
    (n, 2) g, h foreshorten: the offset from a cell's centre is divided by 1 + g p + h q. The film's values are `factor` times
    the irradiance: 1 or reflectance/pi."""

    receivers: np.ndarray
    plane: Plane | None
    slopes: np.ndarray | None = None
    factor: float = 1.0

    @property
    def extended(self) -> bool:
        """Whether elements have an extent."""
        return bool(self.receivers[:, elements.CELL].any())


def view(scene: Scene) -> View | None:
    """Where the film receives; None where a camera sees anything but one flat surface that reflects once and is all that
    its pixels see."""
    if not isinstance(scene.film, CameraFilm):
        rows = elements.receivers(scene.film)
        return View(rows, elements.flat(rows))
    surfaces = scene.surfaces if scene.max_bounces else ()
    seen = (looked_at(scene, surface, piece) for surface in surfaces for piece in parts(surface.shape))
    return next((one for one in seen if one), None)


def view_from_outside(scene: Scene) -> View | None:
    """The same for what looks for lights in all directions; None inside a sphere, which would stand before everything."""
    return None if any(surface.side == "inside" for surface in scene.surfaces) else view(scene)


def looked_at(scene: Scene, surface: scenes.Surface, piece: Flat | Sphere) -> View | None:
    """The view where every pixel sees nothing but this piece of this surface."""
    if isinstance(piece, Sphere) or not surface.reflectance or surface.radiance:
        return None
    walls = pyramid(scene.film, piece)
    return View(*patches(scene.film, piece), surface.reflectance / np.pi) if walls and not reached(scene, walls) else None


def reached(scene: Scene, walls: list[Plane]) -> bool:
    """Whether anything of the scene may lie in front of all of some planes."""
    items = build(scene).items
    return bool(np.all([reaching(items, *wall) for wall in walls], axis=0).any())


def pyramid(film: CameraFilm, piece: Flat) -> list[Plane]:
    """Planes around all that the camera sees up to the piece, facing in; none where a corner of the film sees past it."""
    eyes, rays = corners(film)
    towards = rays @ piece.normal
    reach = (np.array(piece.center) - eyes) @ piece.normal / np.where(towards < 0, towards, np.nan)
    hits = eyes + reach[:, None] * rays
    offsets = hits - np.array(piece.center)
    if not (reach > 0).all() or not COVERS[type(piece)](offsets @ piece.dual_u, offsets @ piece.dual_v).all():
        return []
    sides = [geometry.unit(np.cross(hits[k] - eyes[k], hits[k - 1] - hits[k])) for k in range(4)]
    inner = hits.mean(axis=0)
    walls = [(hits[k], side * np.sign((inner - hits[k]) @ side)) for k, side in enumerate(sides)]
    return [*walls, (eyes[0], geometry.unit(rays.sum(axis=0))), plane_of(piece)]


def corners(film: CameraFilm) -> tuple[np.ndarray, np.ndarray]:
    """Origins (4, 3) and directions (4, 3) of the rays through the film's corners, in order around it."""
    code, rows = film_rows(film)
    columns = film.resolution[0]
    ends = rows[[0, columns - 1, -1, -columns]]
    p, q = np.array([[-0.5], [0.5], [0.5], [-0.5]]), np.array([[-0.5], [-0.5], [0.5], [0.5]])
    shift = p * ends[:, 3:6] + q * ends[:, 6:9]
    return (ends[:, :3], ends[:, 9:] + shift) if code == PERSPECTIVE else (ends[:, :3] + shift, ends[:, 9:])


def patches(film: CameraFilm, piece: Flat) -> tuple[np.ndarray, Plane, np.ndarray | None]:
    """Receivers, plane and slopes of what the pixels see of a piece. From where the ray along w through a pixel's centre
    meets it after `reach`, the film's step p u leads by reach (u - g w) p / (1 + g p), g = (u . n)/(w . n); in parallel
    projection by (u - g w) p."""
    code, rows = film_rows(film)
    n = np.array(piece.normal)
    origin, steps, w = rows[:, :3], rows[:, 3:9].reshape(-1, 2, 3), rows[:, 9:]
    reach = ((np.array(piece.center) - origin) @ n / (w @ n))[:, None]
    slopes = steps @ n / (w @ n)[:, None]
    u, v = ((steps - slopes[:, :, None] * w[:, None]) * (reach[:, None] if code == PERSPECTIVE else 1)).transpose(1, 0, 2)
    t = geometry.unit(u)
    b = np.cross(n, t)
    cells = np.stack([np.linalg.norm(u, axis=1), (v * t).sum(axis=1), (v * b).sum(axis=1)], axis=1)
    receivers = np.hstack([origin + reach * w, t, b, np.broadcast_to(n, t.shape), cells])
    return receivers, plane_of(piece), slopes if code == PERSPECTIVE else None
