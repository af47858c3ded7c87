"""A rank-1 lattice that can be extended, shifted at random for every element (Cranley and Patterson 1976).

Point k is {phi(k) z + shift}, phi van der Corput's radical inverse in base 2, in 32-bit integers. The generator z is that of
Cools, Kuo and Nuyens 2006, "Constructing embedded lattice rules for multivariate integration" (exod2_base2_m20_CKN of the
Magic Point Shop), good for every power of two from 2^10 to 2^20 at once.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic, overload

from lightproof.estimators.points import BLOCK, drawn, opened
from lightproof.estimators.rng import halves, mix64, stream, ticks
from lightproof.estimators.vectors import like

Z0, Z1, Z2, Z3 = np.array([1, 182667, 469891, 498753], np.uint32)


class Lattice(NamedTuple):
    """The first `samples` points of the sequence."""

    samples: int
    seed: int


class Shift(NamedTuple):
    """A block: index of its first point, and what is added to the four coordinates."""

    first: int
    shifts: tuple[int, int, int, int]


@intrinsic
def reversed_bits(context, x):
    """The 32 bits of x in the other order, by one instruction of LLVM's, which runs in vector registers."""

    def generate(context, builder, signature, arguments):
        return builder.bitreverse(builder.trunc(arguments[0], ir.IntType(32)))

    return types.uint32(types.uint32), generate


@overload(opened)
def _opened(points, element, block):
    return _opened_lattice if points.instance_class is Lattice else None


def _opened_lattice(points, element, block):
    own = mix64(stream(points.seed, element, 0))
    return Shift(np.uint32(block * BLOCK), (*halves(own), *halves(mix64(own))))


@overload(drawn)
def _drawn(i, opened, model):
    return _drawn_lattice if getattr(opened, "instance_class", None) is Shift else None


def _drawn_lattice(i, opened, model):
    phi = reversed_bits(np.uint32(opened.first + np.uint32(i)))
    shifts = opened.shifts
    s, t = like(model, ticks(phi, Z0, shifts[0])), like(model, ticks(phi, Z1, shifts[1]))
    return s, t, like(model, ticks(phi, Z2, shifts[2])), like(model, ticks(phi, Z3, shifts[3]))
