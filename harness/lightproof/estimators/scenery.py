"""What a scene holds, as the path tracer's kernels take it: each kind of thing in a group of its own, and only what is there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lightproof.estimators.aiming import Beams, Points
from lightproof.estimators.extents import extents
from lightproof.estimators.skies import UP, Everywhere, Overcast, Sky, Sun, Upper
from lightproof.estimators.solids import grouped
from lightproof.estimators.world import (
    BEAM,
    CAP,
    CENTER,
    KIND,
    NORMAL,
    OVERCAST,
    POINT,
    RADIANCE,
    RADIUS,
    RECEIVER,
    REFLECTANCE,
    SAMPLED,
    SIDE,
    SPHERE,
    SUN,
    UNIFORM,
    UPPER,
    U,
    V,
    World,
)

MANY = 4096  # corners of elements


class Scenery(NamedTuple):
    """`solids` are met by rays and `blockers` stand between vertices and lights, both in groups of `solids`; `lamps` and `bulbs`
    are aimed at; `skies` (see `skies`) lie behind everything; `seen` (m + 1, 6) are the faces as a camera sees them, `met` the
    same without the light of lamps; `near` [m] counts as touching."""

    solids: tuple
    blockers: tuple
    lamps: tuple
    bulbs: tuple
    skies: tuple
    seen: np.ndarray
    met: np.ndarray
    near: float


def scenery(world: World) -> Scenery:
    items = world.items
    sampled = items[:, SAMPLED] != 0
    return Scenery(
        solids=grouped(items, np.ones(len(items), bool)),
        blockers=grouped(items, between(world)),
        lamps=grouped(items, sampled),
        bulbs=tuple(kind(world.bulbs[world.bulbs[:, 0] == code, 1:]) for code, kind in ((POINT, Points), (BEAM, Beams))
                    if (world.bulbs[:, 0] == code).any()),
        skies=tuple(map(sky, world.skies)),
        seen=faces(items, items[:, RADIANCE]),
        met=faces(items, np.where(sampled, 0, items[:, RADIANCE])),
        near=world.contact,
    )  # fmt: skip


def sky(row: np.ndarray) -> Sky:
    code, radiance, direction = int(row[0]), float(row[1]), tuple((-row[2:5]).tolist())
    if code == SUN:
        return Sun(direction, radiance, float(1 - row[5] ** 2))
    return {UNIFORM: Everywhere, UPPER: Upper, OVERCAST: Overcast}[code](UP, radiance)


def faces(items: np.ndarray, radiance: np.ndarray) -> np.ndarray:
    """(m + 1, 6): a (3,) and b such that the normal at x is a + b x, radiance, reflectance; the first is a black nothing."""
    round_ = np.isin(items[:, KIND], (SPHERE, CAP))
    bend = np.where(round_, items[:, SIDE] / np.where(round_, items[:, RADIUS], 1), 0)
    normal = np.where(round_[:, None], -bend[:, None] * items[:, CENTER:U], items[:, NORMAL:NORMAL + 3])
    return np.vstack([np.zeros(6), np.column_stack([normal, bend, radiance, items[:, REFLECTANCE]])])


def between(world: World) -> np.ndarray:
    """Which items (m,) can stand between two places that exchange light: not those on one side of which all the others lie."""
    items = world.items
    round_ = np.isin(items[:, KIND], (SPHERE, CAP))
    if (world.bulbs[:, 0] == BEAM).any():
        return np.ones(len(items), bool)
    return np.where(round_, ~holds_all(world), divides(world))


def divides(world: World) -> np.ndarray:
    """Whether there is something on either side of the plane of each item (m,)."""
    normals = world.items[:, NORMAL:NORMAL + 3]
    level = (world.items[:, CENTER:U] * normals).sum(axis=1)
    spots = places(world) @ normals.T
    low, high = (np.vstack([ends, spots]) - level for ends in extents(world.items, normals.T))
    return (low.min(axis=0) < -world.contact) & (high.max(axis=0) > world.contact)


def holds_all(world: World) -> np.ndarray:
    """Whether everything lies within the sphere of each item (m,) that has one."""
    items = world.items
    size = (np.linalg.norm(items[:, U:V], axis=1) + np.linalg.norm(items[:, V:NORMAL], axis=1)) + items[:, RADIUS]
    spots = places(world)
    middles, sizes = np.vstack([items[:, CENTER:U], spots]), np.append(size, np.zeros(len(spots)))
    away = np.linalg.norm(middles[:, None] - items[None, :, CENTER:U], axis=2) + sizes[:, None]
    return (away <= items[:, RADIUS] + world.contact).all(axis=0)


def places(world: World) -> np.ndarray:
    """(k, 3): corners of the elements of a film that receives, or of a box around them where they are many; point lights."""
    rows = world.elements if world.film == RECEIVER else world.elements[:0]
    ends = [rows[:, :3] + p * rows[:, 3:6] + q * rows[:, 6:9] for p in (-0.5, 0.5) for q in (-0.5, 0.5)]
    corners = np.concatenate(ends)
    if len(corners) > MANY:
        corners = np.stack(np.meshgrid(*zip(corners.min(axis=0), corners.max(axis=0), strict=True)), axis=-1).reshape(-1, 3)
    return np.vstack([corners, world.bulbs[world.bulbs[:, 0] == POINT, 1:4]])
