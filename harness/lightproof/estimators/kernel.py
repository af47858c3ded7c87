"""The one kernel of direct light: sums of an integrand over a film's elements, compiled for what the scene needs.

It is composed of a source (`lamps`: points of a light; `meeting`: directions that may meet it; `aims`: directions into it), the
blockers between (none: no visibility test), the points (random, jittered, of a lattice, Sobol's or a grid) and the precision.
"""

from __future__ import annotations

import numpy as np
from numba import types
from numba.extending import overload

from lightproof.estimators.blockers import all_faced, visible
from lightproof.estimators.compiled import fast, fast_kernel
from lightproof.estimators.crowd import Faced, shadow_all
from lightproof.estimators.lamps import arriving, faced
from lightproof.estimators.points import BLOCK, drawn, opened
from lightproof.estimators.rng import TICK
from lightproof.estimators.vectors import like


def cell_of(receivers, slopes, e, model):
    """Extent of element e in the type of `model`, per draw: a, b, c of its row, and its foreshortening if there is any."""


@overload(cell_of)
def _cell_of(receivers, slopes, e, model):
    return cell_flat.py_func if slopes is types.none else cell_foreshortened


@fast
def cell_flat(receivers, slopes, e, model):
    row = receivers[e]
    return like(model, row[12] * TICK), like(model, row[13] * TICK), like(model, row[14] * TICK)


def cell_foreshortened(receivers, slopes, e, model):
    return (*cell_flat(receivers, None, e, model), like(model, slopes[e, 0] * TICK), like(model, slopes[e, 1] * TICK))


def on_cell(cell, p, q):
    """A point of the element in its own frame."""


@overload(on_cell)
def _on_cell(cell, p, q):
    return on_parallelogram if len(cell) == 3 else on_quadrilateral


def on_parallelogram(cell, p, q):
    return p * cell[0] + q * cell[1], q * cell[2], like(p, 0)


def on_quadrilateral(cell, p, q):
    """Uniform over a pixel's square, as perspective projects it."""
    scale = like(p, 1) / (like(p, 1) + p * cell[3] + q * cell[4])
    return (p * cell[0] + q * cell[1]) * scale, q * cell[2] * scale, like(p, 0)


def sum_block(source, blockers, cell, block, count, pivot):
    """Sum of (f - pivot) and of its square over `count` points, f per strength of the source."""


@overload(sum_block)
def _sum_block(source, blockers, cell, block, count, pivot):
    return sum_staged if getattr(blockers, "instance_class", None) is Faced else sum_fused


def sum_fused(source, blockers, cell, block, count, pivot):
    """Few blockers: all in one loop, which runs in vector registers but for what solves each direction by steps."""
    zero = like(pivot, 0)
    total, square = nought(source, pivot), nought(source, pivot)
    for i in range(count):
        s, t, p, q = drawn(i, block, pivot)
        x = on_cell(cell, p, q)
        f, d = arriving(source, x, s, t)
        f = (f if visible(blockers, x, d) else zero) - pivot
        total += f
        square += f * f
    return total, square


def nought(source, pivot):
    """Zero in the type that a block is added up in. 2,048 values that are alike, one after the other, would round the same way
    each time in float32, by 1e-5 of their sum; values that differ, or partial sums in vector registers, do not."""


@overload(nought)
def _nought(source, pivot):
    alike = getattr(source.instance_class, "alike", False)
    return (lambda source, pivot: 0.0) if alike else lambda source, pivot: like(pivot, 0)


def sum_staged(source, blockers, cell, block, count, pivot):
    """Many blockers: the block's points are laid out first, then shadowed by one blocker after the other."""
    x, d, f = np.full((2, count), pivot), np.full((3, count), pivot), np.full(count, pivot)
    for i in range(count):
        s, t, p, q = drawn(i, block, pivot)
        at = on_cell(cell, p, q)
        f[i], to = arriving(source, at, s, t)
        x[0, i], x[1, i] = at[0], at[1]
        d[0, i], d[1, i], d[2, i] = to
    shadow_all(blockers.groups, blockers.rows, x, d, f)
    total, square = like(pivot, 0), like(pivot, 0)
    for i in range(count):
        total += f[i] - pivot
        square += (f[i] - pivot) * (f[i] - pivot)
    return total, square


@fast
def sum_blocks(source, blockers, cell, points, element, blocks, model):
    """The same over blocks `blocks[0]` to `blocks[1]` in float64, and the pivot: the element's first value."""
    pivot = like(model, sum_block(source, blockers, cell, opened(points, element, 0), 1, like(model, 0))[0])
    total, square = 0.0, 0.0
    for block in range(blocks[0], blocks[1]):
        count = min(BLOCK, points.samples - block * BLOCK)
        sums = sum_block(source, blockers, cell, opened(points, element, block), count, pivot)
        total += sums[0]
        square += sums[1]
    return pivot, total, square


@fast_kernel
def estimate(source, blockers, receivers, slopes, first, points, blocks, model, out):
    """Adds up blocks `blocks[0]` to `blocks[1]` of `points` for each of `receivers` (n, 15) with `slopes` (n, 2) or None, the
    first of which is the film's element `first`. `out` (n, 3): sums of the pivot, of f - pivot and of its square."""
    taken = np.float64(min(blocks[1] * BLOCK, points.samples) - blocks[0] * BLOCK)
    for e in range(len(receivers)):
        row = receivers[e]
        origin = row[0], row[1], row[2]
        frame = (row[3], row[4], row[5]), (row[6], row[7], row[8]), (row[9], row[10], row[11])
        seen, between = faced(source, origin, frame, model), all_faced(blockers, origin, frame, model)
        cell = cell_of(receivers, slopes, e, model)
        pivot, total, square = sum_blocks(seen, between, cell, points, first + e, blocks, model)
        out[e, 0], out[e, 1], out[e, 2] = source.strength * taken * pivot, source.strength * total, source.strength**2 * square
