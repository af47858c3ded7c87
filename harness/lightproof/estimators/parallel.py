"""Flat lights parallel to the film that they face, and what stands parallel between them.

Both cosines are then height over distance, and every shadow ray crosses a blocker's plane at the same share of its way: half
of the arithmetic is not there. Which scenes these are is decided exactly, by the numbers of the scene.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.blockers import Plane, hidden
from lightproof.estimators.compiled import INLINED
from lightproof.estimators.lamps import Lamp, arriving, drawable, faced, parameters
from lightproof.estimators.shapes import Flat, Sphere, covers, placed
from lightproof.estimators.vectors import like, product


class Level(NamedTuple):
    """A lamp whose shape is flat and parallel to the film, before which it hangs facing it."""

    shape: Flat
    strength: float


class Between(NamedTuple):
    """A blocker parallel to both, which segments from film to light cross at `share` of their way."""

    shape: Flat
    share: float


def levelled(lamp: Lamp, blockers: tuple, film: Plane | None) -> tuple[Lamp | Level, tuple]:
    """A lamp and its blockers as simple as they are before a film, which may lie in a plane."""
    if film is None or not isinstance(lamp, Lamp) or not parallel(lamp.shape, film) or np.dot(lamp.shape.normal, film[1]) > 0:
        return lamp, blockers
    height = rise(lamp.shape, film)
    if not height > 0:
        return lamp, blockers
    shares = [rise(blocker, film) / height if parallel(blocker, film) else 0.0 for blocker in blockers]
    return Level(*lamp), tuple(Between(one, share) if 0 < share < 1 else one for one, share in zip(blockers, shares, strict=True))


def parallel(shape: Flat | Sphere, film: Plane) -> bool:
    """Whether a shape is flat and parallel to the film, to the last digit."""
    return not isinstance(shape, Sphere) and not np.cross(shape.normal, film[1]).any()


def rise(shape: Flat, film: Plane) -> float:
    """The height of the centre over the film [m]."""
    return float((np.array(shape.center) - film[0]) @ film[1])


@overload(faced)
def _faced(lamp, origin, frame, model):
    return face if lamp.instance_class is Level else None


def face(lamp, origin, frame, model):
    return Level(drawable(placed(lamp.shape, origin, frame, model)), like(model, lamp.strength))


@overload(arriving, jit_options=INLINED)
def _arriving(lamp, x, s, t):
    return arriving_level if lamp.instance_class is Level else None


def arriving_level(lamp, x, s, t):
    a, b = parameters(lamp.shape, s, t)
    center, u, v = lamp.shape.center, lamp.shape.u, lamp.shape.v
    d = center[0] + a * u[0] + b * v[0] - x[0], center[1] + a * u[1] + b * v[1] - x[1], center[2]
    share = d[2] / (d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    return product(share, share), d


@overload(placed)
def _placed(shape, origin, frame, model):
    return placed_between if shape.instance_class is Between else None


def placed_between(shape, origin, frame, model):
    return Between(placed(shape.shape, origin, frame, model), like(model, shape.share))


@overload(hidden, jit_options=INLINED)
def _hidden(blocker, x, d):
    return behind_level if blocker.instance_class is Between else None


def behind_level(blocker, x, d):
    center, du, dv = blocker.shape.center, blocker.shape.dual_u, blocker.shape.dual_v
    o0, o1 = x[0] + blocker.share * d[0] - center[0], x[1] + blocker.share * d[1] - center[1]
    return covers(blocker.shape, o0 * du[0] + o1 * du[1], o0 * dv[0] + o1 * dv[1])
