"""The points at which an integrand is taken: numbered from 0, in blocks, four coordinates each, in units of TICK. Here the
independent ones and the grid; `jitter`, `lattice` and `sobol` have one kind each.

`opened(points, element, block)` is what the points of a block have in common, `drawn(i, opened, model)` its point i: two
coordinates over the light or the hemisphere, two over the film's element.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import types
from numba.extending import overload

from lightproof.estimators.rng import BLOCK, TICK, block_keys, draws, stream
from lightproof.estimators.vectors import like


class Random(NamedTuple):
    """Points of lattices, see `rng`; every element and block has its own random key."""

    samples: int
    seed: int


class Grid(NamedTuple):
    """Midpoints: `across` x `across` of the light or hemisphere for each of `side` x `side` of the element."""

    samples: int
    across: int
    side: int


class Line(NamedTuple):
    """A block of a grid: its first point, cells along each axis."""

    first: float
    across: float
    side: float


def grid(across: int, side: int) -> Grid:
    return Grid((across * side) ** 2, across, side)


def opened(points, element, block):
    """What a block's points have in common."""


@overload(opened)
def _opened(points, element, block):
    return {Random: _opened_random, Grid: _opened_grid}.get(points.instance_class)


def _opened_random(points, element, block):
    return block_keys(stream(points.seed, element, 0), block)


def _opened_grid(points, element, block):
    return Line(np.float64(block * BLOCK), np.float64(points.across), np.float64(points.side))


def drawn(i, opened, model):
    """Point i of a block, in the type of `model`."""


@overload(drawn)
def _drawn(i, opened, model):
    if isinstance(opened, types.BaseTuple) and not hasattr(opened, "instance_class"):
        return lambda i, opened, model: draws(i, opened, model)
    return _drawn_midpoint if getattr(opened, "instance_class", None) is Line else None


def _drawn_midpoint(i, opened, model):
    """Divided in floating point, which runs in vector registers; a half keeps the quotients off the integers."""
    cell = opened.first + i
    row = np.floor((cell + 0.5) / opened.across)
    pair = np.floor((row + 0.5) / opened.across)
    q = np.floor((pair + 0.5) / opened.side)
    s, t = middle(row - pair * opened.across, opened.across), middle(cell - row * opened.across, opened.across)
    p = middle(pair - q * opened.side, opened.side)
    return like(model, s), like(model, t), like(model, p), like(model, middle(q, opened.side))


def middle(cell, cells):
    """The middle of a cell of [-1/2, 1/2], in units of TICK."""


@overload(middle, inline="always")
def _middle(cell, cells):
    return lambda cell, cells: ((cell + 0.5) / cells - 0.5) / TICK
