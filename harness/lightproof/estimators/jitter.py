"""Stratified jitter: one random point in each cell of a grid over the light or hemisphere (Cook 1986, "Stochastic sampling
in computer graphics"), and in each cell of the same grid over the film's element.

The two grids' cells are paired by a rotation of random offset, so that each sample's own cells are independent.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.points import BLOCK, drawn, middle, opened
from lightproof.estimators.rng import block_keys, draws, stream
from lightproof.estimators.vectors import like

SIDE = 2**12  # cells along an axis, at most: products of their numbers stay exact; more samples go round again
GOLDEN = (math.sqrt(5) - 1) / 2


class Jitter(NamedTuple):
    """Cells `across` x `down`; `step` is the rotation from one cell of the element to the next."""

    samples: int
    seed: int
    across: int
    down: int
    step: int


class Cells(NamedTuple):
    """A block: its first point, the cells along both axes, the rotation's step and offset, the keys of its random draws."""

    first: float
    across: float
    down: float
    step: float
    offset: float
    keys: tuple[int, int, int, int]


def jitter(samples: int, seed: int) -> Jitter:
    """As many cells as `samples` or fewer by less than a row; whole rounds of the most cells where that is not enough."""
    across = min(math.isqrt(samples), SIDE)
    down = min(samples // across, SIDE)
    cells = across * down
    return Jitter(cells * max(1, samples // cells), seed, across, down, rotation(cells))


def rotation(cells: int) -> int:
    """The number prime to `cells` nearest to their golden section: a lattice of good quality in one dimension."""
    aim = round(cells * GOLDEN)
    return next(aim + k for k in range(cells + 1) if math.gcd(aim + k, cells) == 1)


@overload(opened)
def _opened(points, element, block):
    return _opened_jitter if points.instance_class is Jitter else None


def _opened_jitter(points, element, block):
    own = stream(points.seed, element, 0)
    across, down = np.float64(points.across), np.float64(points.down)
    offset = np.float64(own % np.uint64(points.across * points.down))
    return Cells(np.float64(block * BLOCK), across, down, np.float64(points.step), offset, block_keys(own, block))


@overload(drawn)
def _drawn(i, opened, model):
    return _drawn_jitter if getattr(opened, "instance_class", None) is Cells else None


def _drawn_jitter(i, opened, model):
    a, b, c, d = draws(i, opened.keys, model)
    count = opened.across * opened.down
    index = opened.first + i
    cell = remainder(index, count)
    pair = remainder(cell * opened.step + opened.offset, count)
    s, t = spread(cell, opened.across, opened.down, a, b)
    return s, t, *spread(pair, opened.across, opened.down, c, d)


def remainder(index, cells):
    """Of whole numbers in floating point, which runs in vector registers; a half keeps the quotient off the integers."""


@overload(remainder, inline="always")
def _remainder(index, cells):
    return lambda index, cells: index - cells * np.floor((index + 0.5) / cells)


def spread(cell, across, down, s, t):
    """A point of a cell from two draws, all in units of TICK."""


@overload(spread, inline="always")
def _spread(cell, across, down, s, t):
    def place(cell, across, down, s, t):
        row = np.floor((cell + 0.5) / across)
        x, y = middle(cell - row * across, across), middle(row, down)
        return like(s, x) + s * like(s, 1 / across), like(s, y) + t * like(s, 1 / down)

    return place
