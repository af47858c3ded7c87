"""What stands between: which surfaces can cast a shadow on a film at all, and the test that they do."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof import geometry
from lightproof.estimators.compiled import INLINED
from lightproof.estimators.extents import reaching
from lightproof.estimators.shapes import Flat, Sphere, parts, placed
from lightproof.estimators.vectors import dot, like, sub
from lightproof.estimators.windows import Window, window, within
from lightproof.estimators.world import WIDTH, Item, item_row
from lightproof.scene import Scene

INSIDE = 0.9999  # of a sphere's radius squared: what is nearer to its centre lies inside, and not on it by rounding


Plane = tuple[np.ndarray, np.ndarray]  # a point and a unit normal


class Casters(NamedTuple):
    """Pieces that can cast a shadow, (m,): the id of what each belongs to, and its row of a `World` (m, WIDTH)."""

    owners: np.ndarray
    pieces: tuple[Flat | Sphere, ...]
    rows: np.ndarray

    @classmethod
    def of(cls, items: Iterable[Item]) -> Casters:
        """The pieces of lights and surfaces. Raises TypeError on a cylinder."""
        owned = [(item, piece) for item in items for piece in parts(item.shape)]
        rows = [item_row(item, piece, sample_surfaces=False) for item, piece in owned]
        return cls(np.array([item.id for item, _ in owned]), tuple(piece for _, piece in owned), np.reshape(rows, (-1, WIDTH)))


def standing(scene: Scene) -> list[Item]:
    """What of a scene can cast a shadow."""
    return [item for item in (*scene.lights, *scene.surfaces) if isinstance(item, Item) and not encloses(item)]


def between(casters: Casters, own: str, *planes: Plane | None) -> Casters:
    """Those that can cast a shadow of a piece of the light or surface `own`: the others that lie in front of the `planes`
    of that piece and of what receives, None for what lies in none."""
    before = [reaching(casters.rows, *plane) for plane in planes if plane is not None]
    kept = np.flatnonzero(np.all([casters.owners != own, *before], axis=0))
    return Casters(casters.owners[kept], tuple(casters.pieces[k] for k in kept), casters.rows[kept])


def plane_of(piece: Flat | Sphere) -> Plane | None:
    """The plane of a flat piece."""
    return (np.array(piece.center), np.array(piece.normal)) if isinstance(piece, Flat) else None


def encloses(item: Item) -> bool:
    """Whether this is a sphere seen from inside; it stands around film and lights, and between none."""
    return isinstance(item.shape, geometry.Sphere) and getattr(item, "side", "outside") == "inside"


def visible(blockers, x, d):
    """Whether none of a tuple of blockers cuts the segment from x to x + d; with no blockers no code at all."""


@overload(visible, jit_options=INLINED)
def _visible(blockers, x, d):
    if len(blockers) == 0:
        return lambda blockers, x, d: True
    return lambda blockers, x, d: (not hidden(blockers[0], x, d)) & visible(blockers[1:], x, d)


def hidden(blocker, x, d):
    """Whether a blocker cuts the segment from x to x + d."""


@overload(hidden, jit_options=INLINED)
def _hidden(blocker, x, d):
    return {Sphere: _behind_sphere, Window: _behind_window}.get(blocker.instance_class)


def _behind_window(blocker, x, d):
    """By the parameters, from below the element's middle, of where the segment's line meets the plane, times its slope."""
    shape = blocker.shape
    above, slope = dot(x, shape.normal) + blocker.level, dot(d, shape.normal)
    s = dot(x, shape.dual_u) * slope - above * dot(d, shape.dual_u)
    t = dot(x, shape.dual_v) * slope - above * dot(d, shape.dual_v)
    return (above * (above + slope) < like(slope, 0)) & within(shape, blocker.margins, s, t, slope)


def _behind_sphere(blocker, x, d):
    """The segment's point nearest to the centre lies inside, or an end does."""
    o = sub(blocker.center, x)
    b, d2, o2, r2 = dot(o, d), dot(d, d), dot(o, o), blocker.radius * blocker.radius
    through = (b > like(b, 0)) & (b < d2) & (o2 * d2 - b * b < r2 * d2)
    inner = r2 * like(b, INSIDE)
    return through | (o2 < inner) | (o2 - b - b + d2 < inner)


def faced_by(blocker, origin, frame, model):
    """The blocker as seen from `origin` along the axes of `frame`, in the precision of `model`."""


@overload(faced_by)
def _faced_by(blocker, origin, frame, model):
    if issubclass(blocker.instance_class, Flat):
        return lambda blocker, origin, frame, model: window(blocker, origin, frame, model)
    return lambda blocker, origin, frame, model: placed(blocker, origin, frame, model)


def all_faced(blockers, origin, frame, model):
    """Blockers as seen from `origin` along the axes of `frame`."""


@overload(all_faced)
def _all_faced(blockers, origin, frame, model):
    if getattr(blockers, "instance_class", tuple) is not tuple:
        return None
    if len(blockers) == 0:
        return lambda blockers, origin, frame, model: ()
    return lambda blockers, origin, frame, model: (
        faced_by(blockers[0], origin, frame, model),
        *all_faced(blockers[1:], origin, frame, model),
    )
