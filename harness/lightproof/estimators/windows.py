"""Flat shapes as an element sees them, to the last digits of its height over them and of the way to their edges.

An element that lies on a shape is on the side that its normal leads to: it sees the limit as it comes to it along that.
"""

from __future__ import annotations

from typing import NamedTuple

from numba.extending import overload

from lightproof.estimators.compiled import INLINED, inlined, strict
from lightproof.estimators.shapes import COINCIDES, Disk, Flat, Parallelogram, Triangle, placed
from lightproof.estimators.vectors import dot, like, norm, sub

ALONG = 1e-15  # largest cosine of an angle that counts as a right one
NEAR = 1e-18  # of a shape's size: how far from it an element that lies on it is put


class Window(NamedTuple):
    """`level` [m] is the height of the element's middle over the shape's plane and `margins` lead, in the shape's parameters,
    from the point below the middle to its edges: what float32 would lose of a shape that is near."""

    shape: Flat
    level: float
    margins: tuple[float, ...]


@inlined
def window(shape, origin, frame, model):
    """A flat shape as seen from `origin` along the axes of `frame`, in the precision of `model`."""
    o, size = sub(origin, shape.center), norm(shape.u) + norm(shape.v)
    a, b = dot(o, shape.dual_u), dot(o, shape.dual_v)
    margins, slack = margins_of(shape, a, b), COINCIDES * (size + norm(origin))
    slacks = changes_of(shape, abs(a), abs(b), slack * norm(shape.dual_u), slack * norm(shape.dual_v))
    seen = placed(shape, origin, frame, model)
    if abs(dot(o, shape.normal)) > slack or not holds(shape, margins, slacks):
        return Window(seen, like(model, height(shape, o)), settled(margins, margins, slacks, model))
    rise = dot(frame[2], shape.normal)
    step = NEAR * size if abs(rise) > ALONG else 0.0
    drifts = changes_of(shape, a, b, step * dot(frame[2], shape.dual_u), step * dot(frame[2], shape.dual_v))
    return Window(seen, like(model, step * rise), settled(margins, drifts, slacks, model))


@strict
def height(shape, w):
    """Over the plane of a flat shape, of what lies at `w` from its centre; none where it may be rounding."""
    found = dot(w, shape.normal)
    return found if abs(found) > COINCIDES * (norm(w) + norm(shape.u) + norm(shape.v)) else 0.0


def margins_of(shape, a, b):
    """The `margins` of a flat shape at its parameters a, b."""


@overload(margins_of)
def _margins_of(shape, a, b):
    return {
        Parallelogram: lambda shape, a, b: (0.5 + a, 0.5 - a, 0.5 + b, 0.5 - b),
        Triangle: lambda shape, a, b: (a, b, 1 - a - b),
        Disk: lambda shape, a, b: (2 * a, 2 * b, 1 - a * a - b * b),
    }[shape.instance_class]


def changes_of(shape, a, b, da, db):
    """How much the margins change as the parameters change by da, db."""


@overload(changes_of)
def _changes_of(shape, a, b, da, db):
    return {
        Parallelogram: lambda shape, a, b, da, db: (da, -da, db, -db),
        Triangle: lambda shape, a, b, da, db: (da, db, -da - db),
        Disk: lambda shape, a, b, da, db: (2 * da, 2 * db, -2 * (a * da + b * db)),
    }[shape.instance_class]


def holds(shape, margins, slacks):
    """Whether margins are those of a point of the shape, but for slacks of either sign."""


@overload(holds)
def _holds(shape, margins, slacks):
    if shape.instance_class is Disk:
        return lambda shape, margins, slacks: margins[2] >= -abs(slacks[2])
    if len(margins) == 0:
        return lambda shape, margins, slacks: True
    return lambda shape, margins, slacks: margins[0] >= -abs(slacks[0]) and holds(shape, margins[1:], slacks[1:])


def settled(margins, drifts, slacks, model):
    """Margins in the type of `model`: those within the slacks are what they drift by."""


@overload(settled)
def _settled(margins, drifts, slacks, model):
    if len(margins) == 0:
        return lambda margins, drifts, slacks, model: ()
    return lambda margins, drifts, slacks, model: (
        like(model, margins[0] if abs(margins[0]) > abs(slacks[0]) else drifts[0]),
        *settled(margins[1:], drifts[1:], slacks[1:], model),
    )


def within(shape, margins, s, t, scale):
    """Whether a step of s, t over `scale` in the parameters of a flat shape stays within its `margins`, without a division."""


@overload(within, jit_options=INLINED)
def _within(shape, margins, s, t, scale):
    return {Parallelogram: _within_parallelogram, Triangle: _within_triangle, Disk: _within_disk}[shape.instance_class]


def _within_parallelogram(shape, margins, s, t, scale):
    zero = like(scale, 0)
    along_u = (s + margins[0] * scale) * (margins[1] * scale - s) >= zero
    return along_u & ((t + margins[2] * scale) * (margins[3] * scale - t) >= zero)


def _within_triangle(shape, margins, s, t, scale):
    zero = like(scale, 0)
    beyond_sides = ((s + margins[0] * scale) * scale >= zero) & ((t + margins[1] * scale) * scale >= zero)
    return beyond_sides & ((margins[2] * scale - s - t) * scale >= zero)


def _within_disk(shape, margins, s, t, scale):
    return s * (s + margins[0] * scale) + t * (t + margins[1] * scale) <= margins[2] * scale * scale
