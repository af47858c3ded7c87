"""Which direct light has a closed form: what stands between a light and what receives it decides."""

from __future__ import annotations

import numpy as np

from lightproof import scene as scenes
from lightproof.estimators import elements
from lightproof.estimators.blockers import Casters, Plane, between, plane_of, standing
from lightproof.estimators.shapes import Disk, Flat, Sphere, parts, support
from lightproof.estimators.world import CENTER, DISK, KIND, V
from lightproof.scene import CameraFilm, Scene

PARALLEL = 1e-12  # 1 - |cosine| of two disks that count as parallel


def emitting_pieces(item: scenes.Light | scenes.Surface) -> list[Flat | Sphere | None]:
    """The pieces of what shines, None for a sky; nothing for what is black, nor for points and beams, which are traced."""
    if isinstance(item, scenes.AreaLight | scenes.Surface):
        return parts(item.shape) if item.radiance else []
    return [] if isinstance(item, scenes.PointLight | scenes.DirectionalLight) else [None]


def receiving_planes(scene: Scene) -> list[Plane | None]:
    """The planes that receive: the film's, or of a camera's film those of the surfaces that reflect."""
    if not isinstance(scene.film, CameraFilm):
        return [elements.flat(elements.receivers(scene.film))]
    return [plane_of(piece) for surface in scene.surfaces if surface.reflectance for piece in parts(surface.shape)]


def disks_unsupported(light: Disk, blocker: Disk, plane: Plane | None, name: str) -> str | None:
    if 1 - abs(np.dot(light.normal, blocker.normal)) > PARALLEL:
        return f"no closed form for a disk before '{name}' that is not parallel to it"
    if plane is None or any(-support(disk, -plane[1]) < plane[0] @ plane[1] for disk in (light, blocker)):
        return f"no closed form for '{name}' behind a disk where the receiver's plane cuts either"
    return None


def shades(scene: Scene, items: np.ndarray) -> np.ndarray:
    """For every item (m,) the index of the disk that stands before it where it is a disk that shines, else -1."""
    shade, casters, planes = np.full(len(items), -1), Casters.of(standing(scene)), receiving_planes(scene)
    for item in (*scene.lights, *scene.surfaces):
        for light in filter(lambda piece: isinstance(piece, Disk), emitting_pieces(item)):
            for plane in planes:
                for blocker in between(casters, item.id, plane_of(light), plane).pieces:
                    shade[row_of(light, items)] = row_of(blocker, items)
    return shade


def row_of(disk: Disk, items: np.ndarray) -> int:
    """The index of a disk among the items."""
    same = (items[:, KIND] == DISK) & (items[:, CENTER:V] == np.concatenate([disk.center, disk.u])).all(axis=1)
    return int(np.flatnonzero(same)[0])
