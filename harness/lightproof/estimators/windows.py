"""Flat shapes as an element sees them, to the last digits of its height over them and of the way to their edges.

An element that lies on a shape is on the side that its normal leads to: it sees the limit as it comes to it along that.
"""

from __future__ import annotations

from typing import NamedTuple

from numba.extending import overload

from lightproof.estimators.compiled import inlined, strict
from lightproof.estimators.shapes import COINCIDES, Disk, Flat, Parallelogram, Triangle, placed
from lightproof.estimators.vectors import dot, like, norm, sub

ALONG = 1e-15  # cosine of an angle that is a right one
NEAR = 1e-18  # of a shape's size: how far from it an element is that lies on it


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
    if abs(dot(o, shape.normal)) > slack or not holds(shape, margins, -slack / size):
        return Window(placed(shape, origin, frame, model), like(model, height(shape, o)), settled(margins, margins, 0.0, model))
    rise = dot(frame[2], shape.normal)
    step = NEAR * size if abs(rise) > ALONG else 0.0
    drifts = drifts_of(shape, a, b, step * dot(frame[2], shape.dual_u), step * dot(frame[2], shape.dual_v))
    return Window(placed(shape, origin, frame, model), like(model, step * rise), settled(margins, drifts, slack / size, model))


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


def drifts_of(shape, a, b, da, db):
    """How the margins change as the parameters do."""


@overload(drifts_of)
def _drifts_of(shape, a, b, da, db):
    return {
        Parallelogram: lambda shape, a, b, da, db: (da, -da, db, -db),
        Triangle: lambda shape, a, b, da, db: (da, db, -da - db),
        Disk: lambda shape, a, b, da, db: (2 * da, 2 * db, -2 * (a * da + b * db)),
    }[shape.instance_class]


def holds(shape, margins, least):
    """Whether no edge is nearer than `least`."""


@overload(holds)
def _holds(shape, margins, least):
    if shape.instance_class is Disk:
        return lambda shape, margins, least: margins[2] >= least
    return lambda shape, margins, least: min(margins) >= least


def settled(margins, drifts, slack, model):
    """Margins in the type of `model`: those that may be rounding are what they drift by."""


@overload(settled)
def _settled(margins, drifts, slack, model):
    if len(margins) == 0:
        return lambda margins, drifts, slack, model: ()
    return lambda margins, drifts, slack, model: (
        like(model, margins[0] if abs(margins[0]) > slack else drifts[0]),
        *settled(margins[1:], drifts[1:], slack, model),
    )


def within(shape, margins, a, b):
    """Whether a step of a, b in the parameters of a flat shape stays within its `margins`."""


@overload(within)
def _within(shape, margins, a, b):
    return {
        Parallelogram: lambda shape, margins, a, b: (
            (a >= -margins[0]) & (a <= margins[1]) & (b >= -margins[2]) & (b <= margins[3])),
        Triangle: lambda shape, margins, a, b: (a >= -margins[0]) & (b >= -margins[1]) & (a + b <= margins[2]),
        Disk: lambda shape, margins, a, b: a * (a + margins[0]) + b * (b + margins[1]) <= margins[2],
    }[shape.instance_class]
