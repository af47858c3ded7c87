"""The inner loop of `mc-area` under a flat light parallel to the film with parts left out, to see what each part costs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import njit

from lightproof.estimators.compiled import FAST
from lightproof.estimators.kernel import cell_of, on_cell
from lightproof.estimators.lamps import arriving, faced, parameters
from lightproof.estimators.points import BLOCK, drawn, opened
from lightproof.estimators.vectors import like

inline = njit(fastmath=FAST, error_model="numpy")


@inline
def as_it_is(i, block, model):
    return drawn(i, block, model)


@inline
def counted(i, block, model):
    """The block's shifts plus the sample's number, neither from a table nor multiplied."""
    at, (_, shift) = np.uint32(i), block
    return (like(model, np.int32(np.uint32(at + shift[0]))), like(model, np.int32(np.uint32(at + shift[1]))),
            like(model, np.int32(np.uint32(at + shift[2]))), like(model, np.int32(np.uint32(at + shift[3]))))


@inline
def divided(lamp, x, s, t):
    return arriving(lamp, x, s, t)[0]


@inline
def multiplied(lamp, x, s, t):
    """The same with a product in the place of the quotient: a wrong number, at the speed of a right one."""
    a, b = parameters(lamp.shape, s, t)
    center, u, v = lamp.shape.center, lamp.shape.u, lamp.shape.v
    d0, d1 = center[0] + a * u[0] + b * v[0] - x[0], center[1] + a * u[1] + b * v[1] - x[1]
    share = center[2] * (d0 * d0 + d1 * d1 + center[2] * center[2])
    return share * share


@inline
def with_square(total, square, f):
    return total + f, square + f * f


@inline
def alone(total, square, f):
    return total + f, square


def compiled(draw: Callable, value: Callable, add: Callable) -> Callable:
    """The loop of these parts: (lamp, receivers, points, blocks, model) -> a sum over elements, blocks and samples."""

    @njit(fastmath=FAST, error_model="numpy", nogil=True)
    def loop(lamp, receivers, points, blocks, model):
        whole = 0.0
        for e in range(len(receivers)):
            row = receivers[e]
            frame = (row[3], row[4], row[5]), (row[6], row[7], row[8]), (row[9], row[10], row[11])
            seen, cell = faced(lamp, (row[0], row[1], row[2]), frame, model), cell_of(receivers, None, e, model)
            for number in range(blocks):
                block = opened(points, e, number)
                total, square = like(model, 0), like(model, 0)
                for i in range(BLOCK):
                    s, t, p, q = draw(i, block, model)
                    total, square = add(total, square, value(seen, on_cell(cell, p, q), s, t))
                whole += total + square
        return whole

    return loop


VARIANTS = {
    "the whole loop": (as_it_is, divided, with_square),
    "without random numbers": (counted, divided, with_square),
    "without the division": (as_it_is, multiplied, with_square),
    "without the variance": (as_it_is, divided, alone),
    "without all three": (counted, multiplied, alone),
}
