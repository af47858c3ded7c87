"""Stratified jitter: one random point in each cell of a grid over the light or hemisphere (Cook 1986, "Stochastic sampling
in computer graphics"), and in each cell of the same grid over the film's element.

The two grids' cells are paired by a rotation of random offset, so that each sample's own cells are independent.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.points import drawn, opened
from lightproof.estimators.rng import BLOCK, TICK, block_keys, draws, stream
from lightproof.estimators.vectors import like

SIDE = 2**10  # cells along an axis, at most: quotients of their numbers stay exact in float32; more samples go round again
GOLDEN = (math.sqrt(5) - 1) / 2


class Jitter(NamedTuple):
    """Cells `across` x `down`; `step` is the rotation from one cell of the element to the next, `turns` (n,) its multiples for
    the points of a block."""

    samples: int
    seed: int
    across: int
    down: int
    step: int
    turns: np.ndarray


class Cells(NamedTuple):
    """A block: its first cells of the light and of the element, the rotation from there, how many cells there are, and a cell's
    size as a share of all, the keys of its random draws."""

    first: int
    start: int
    turns: np.ndarray
    count: int
    across: float
    width: float
    height: float
    keys: tuple


def jitter(samples: int, seed: int) -> Jitter:
    """As many cells as `samples` or fewer by less than a row; whole rounds of the most cells where that is not enough."""
    across = min(math.isqrt(samples), SIDE)
    down = min(samples // across, SIDE)
    cells = across * down
    step = rotation(cells)
    turns = (np.arange(min(cells, BLOCK)) * step % cells).astype(np.uint32)
    return Jitter(cells * max(1, samples // cells), seed, across, down, step, turns)


def rotation(cells: int) -> int:
    """The number prime to `cells` nearest to their golden section: a lattice of good quality in one dimension."""
    aim = round(cells * GOLDEN)
    return next(aim + k for k in range(cells + 1) if math.gcd(aim + k, cells) == 1)


@overload(opened)
def _opened(points, element, block):
    return _opened_jitter if points.instance_class is Jitter else None


def _opened_jitter(points, element, block):
    own = stream(points.seed, element, 0)
    count = points.across * points.down
    first = block * BLOCK % count
    start = (first * points.step + np.int64(own % np.uint64(count))) % count
    shape = np.float64(points.across), 1 / points.across, 1 / points.down
    return Cells(np.uint32(first), np.uint32(start), points.turns, np.uint32(count), *shape, block_keys(own, block))


@overload(drawn)
def _drawn(i, opened, model):
    return _drawn_jitter if getattr(opened, "instance_class", None) is Cells else None


def _drawn_jitter(i, opened, model):
    a, b, c, d = draws(i, opened.keys, model)
    pair = np.uint32(opened.start + opened.turns[i])
    pair = min(pair, np.uint32(pair - opened.count))  # a difference below zero is a large number
    s, t = within(opened, like(model, np.int32(opened.first + np.uint32(i))), a, b)
    return s, t, *within(opened, like(model, np.int32(pair)), c, d)


def within(cells, cell, s, t):
    """A point of a cell from two draws, all in units of TICK."""


@overload(within, inline="always")
def _within(cells, cell, s, t):
    def place(cells, cell, s, t):
        width, height = like(s, cells.width), like(s, cells.height)
        row = np.floor((cell + like(s, 0.5)) * width)  # the half keeps the quotient off whole numbers
        column = cell - row * like(s, cells.across)
        return middle(column, width) + s * width, middle(row, height) + t * height

    return place


def middle(cell, size):
    """The middle of a cell of [-1/2, 1/2], in units of TICK."""


@overload(middle, inline="always")
def _middle(cell, size):
    return lambda cell, size: (cell + like(cell, 0.5)) * (size * like(cell, 1 / TICK)) - like(cell, 0.5 / TICK)
