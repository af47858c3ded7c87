"""Sobol's sequence in four dimensions with Owen's scrambling, hashed, afresh for every element.

Coordinates are 32-bit integers with their bits reversed, as Burley 2020, "Practical hash-based Owen scrambling", keeps them:
there a hash of Laine and Karras 2011, whose bits depend on lower bits alone, is a nested uniform scramble. The constants
are Vegdahl's (2021, "Building a better LK hash"), with a multiplier of its own, so that the added key alone makes every
coordinate uniform, whatever the index. Direction numbers: Joe and Kuo 2008.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic, overload

from lightproof.estimators.compiled import fast
from lightproof.estimators.points import BLOCK, drawn, opened
from lightproof.estimators.rng import halves, mix64, stream
from lightproof.estimators.vectors import like

BITS = 32
POLYNOMIALS = (((), ()), ((1,), (1,)), ((1, 1), (1, 3)), ((0, 1, 1), (1, 3, 1)))  # coefficients, and the first odd numbers m


class Sobol(NamedTuple):
    """The first `samples` points of the sequence."""

    samples: int
    seed: int


class Scramble(NamedTuple):
    """A block: the sequence's point at its first index, and keys to add and to multiply by, of four coordinates each."""

    start: tuple[int, int, int, int]
    shifts: tuple[int, int, int, int]
    factors: tuple[int, int, int, int]


def directions(coefficients: tuple[int, ...], m: tuple[int, ...]) -> list[int]:
    """Direction numbers (BITS,) with reversed bits, by the recurrence of a primitive polynomial (none: van der Corput's)."""
    numbers, degree = list(m) or [1] * BITS, len(m)
    for k in range(len(numbers), BITS):
        terms = [(numbers[k - j - 1] << (j + 1)) * c for j, c in enumerate(coefficients)]
        numbers.append(int(np.bitwise_xor.reduce([numbers[k - degree], *terms])))
    return [int(format(number << (BITS - 1 - k), f"0{BITS}b")[::-1], 2) for k, number in enumerate(numbers)]


def combined(columns: np.ndarray) -> np.ndarray:
    """The points of indices 0 to 2^n - 1 from the direction numbers of their n bits."""
    table = np.zeros(1, np.uint32)
    for column in columns:
        table = np.concatenate([table, table ^ column])
    return table


DIRECTIONS = np.array([directions(*polynomial) for polynomial in POLYNOMIALS], np.uint32)
WITHIN = BLOCK.bit_length() - 1  # bits of an index within its block
TABLE_1, TABLE_2, TABLE_3 = (combined(row[:WITHIN]) for row in DIRECTIONS[1:])


@intrinsic
def reversed_bits(context, x):
    """The 32 bits of x in the other order, by one instruction of LLVM's, which runs in vector registers."""

    def generate(context, builder, signature, arguments):
        return builder.bitreverse(builder.trunc(arguments[0], ir.IntType(BITS)))

    return types.uint32(types.uint32), generate


@fast
def point(block, axis):
    """Coordinate `axis` of the first point of a block."""
    x = np.uint32(0)
    for bit in range(WITHIN, BITS):
        if (block >> (bit - WITHIN)) & 1:
            x = np.uint32(x ^ DIRECTIONS[axis, bit])
    return x


@overload(opened)
def _opened(points, element, block):
    return _opened_sobol if points.instance_class is Sobol else None


def _opened_sobol(points, element, block):
    own = stream(points.seed, element, 0)
    a, b, c, d = mix64(own ^ np.uint64(1)), mix64(own ^ np.uint64(2)), mix64(own ^ np.uint64(3)), mix64(own ^ np.uint64(4))
    shifts = halves(a)[0], halves(b)[0], halves(c)[0], halves(d)[0]
    factors = halves(a)[1], halves(b)[1], halves(c)[1], halves(d)[1]
    return Scramble((point(block, 0), point(block, 1), point(block, 2), point(block, 3)), shifts, factors)


@overload(drawn)
def _drawn(i, opened, model):
    return _drawn_sobol if getattr(opened, "instance_class", None) is Scramble else None


def _drawn_sobol(i, opened, model):
    return (
        scrambled(np.uint32(i), opened, 0, model),
        scrambled(TABLE_1[i], opened, 1, model),
        scrambled(TABLE_2[i], opened, 2, model),
        scrambled(TABLE_3[i], opened, 3, model),
    )


@fast
def scrambled(x, block, axis, model):
    """A coordinate in units of TICK from what its point adds to the block's first."""
    x = hashed(np.uint32(x ^ block.start[axis]), block.shifts[axis], block.factors[axis])
    return like(model, np.int32(reversed_bits(x)))


@fast
def hashed(x, shift, factor):
    """A permutation of 32 bits in which each depends on itself and lower ones."""
    x = np.uint32(x ^ np.uint32(x * np.uint32(0x3D20ADEA)))
    x = np.uint32(np.uint32(x + shift) * np.uint32(factor | np.uint32(1)))
    x = np.uint32(x ^ np.uint32(x * np.uint32(0x05526C56)))
    return np.uint32(x ^ np.uint32(x * np.uint32(0x53A22864)))
