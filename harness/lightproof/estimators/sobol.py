"""Sobol's sequence in four dimensions, scrambled at random, afresh for every film, and shifted at random for every element.

Matousek 1998, "On the L2-discrepancy for anchored boxes": the digits of a point, most significant first, are multiplied by a
random lower triangular matrix of bits, here of equal diagonals (Tezuka and Faure 2003, "I-binomial scrambling of digital
nets and sequences"), and then shifted by random digits. Owen 2003, "Variance with alternative scramblings of digital nets":
the variance is that of Owen's own scrambling. The shift alone makes every point uniform, so that elements share a matrix and
their errors are yet uncorrelated. All this is linear: a table serves every block of every element, and a sample costs one
exclusive or a coordinate. Direction numbers: Joe and Kuo 2008.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.compiled import strict, strict_kernel
from lightproof.estimators.points import drawn, opened
from lightproof.estimators.rng import BLOCK, halves, mix64, stream
from lightproof.estimators.vectors import like

BITS = 32
WITHIN = BLOCK.bit_length() - 1  # bits of an index within its block


class Sobol(NamedTuple):
    """The first `samples` points of the sequence: scrambled direction numbers (4, BITS), and what the points of a block are
    beyond its first one (4, BLOCK or `samples`)."""

    samples: int
    seed: int
    directions: np.ndarray
    table: np.ndarray


class Net(NamedTuple):
    """A block: the table, and the block's first point."""

    table: np.ndarray
    start: tuple[int, int, int, int]


def sobol(samples: int, seed: int) -> Sobol:
    """The sequence, scrambled."""
    return Sobol(samples, seed, *scrambled(seed, min(samples, BLOCK)))


@strict_kernel
def scrambled(seed, count):
    """Direction numbers and a table of `count` points from a random matrix for each dimension."""
    key = stream(seed, 0, 1)
    (a, b), (c, d) = halves(key), halves(mix64(key))
    regular = np.uint32(2**31)
    numbers = directions(a | regular, b | regular, c | regular, d | regular)
    return numbers, combined(numbers, count)


@strict
def directions(a, b, c, d):
    """Direction numbers (4, BITS) times the matrix whose columns are a (b, c, d in the other dimensions) shifted down. Such a
    product commutes with shifts, so that it follows the recurrences of the numbers themselves, which 2^31 gives."""
    v = np.empty((4, BITS), np.uint32)
    v[0, 0], v[1, 0], v[2, 0], v[3, 0] = a, b, c, d
    v[0, 1], v[1, 1], v[2, 1], v[3, 1] = a >> 1, b ^ b >> 1, c ^ c >> 1, d ^ d >> 1
    v[0, 2], v[1, 2], v[2, 2], v[3, 2] = a >> 2, b ^ b >> 2, c >> 1 ^ c >> 2, d >> 2
    for k in range(3, BITS):
        v[0, k] = v[0, k - 1] >> 1
        v[1, k] = v[1, k - 1] ^ v[1, k - 1] >> 1
        v[2, k] = v[2, k - 1] ^ v[2, k - 2] ^ v[2, k - 2] >> 2
        v[3, k] = v[3, k - 2] ^ v[3, k - 3] ^ v[3, k - 3] >> 3
    return v


@strict
def combined(numbers, count):
    """The points (4, count) of indices from 0 on: those from 2^k on are those before and direction number k."""
    table = np.zeros((len(numbers), count), np.uint32)
    for axis in range(len(numbers)):
        first, bit = 1, 0
        while first < count:
            for i in range(first, min(2 * first, count)):
                table[axis, i] = table[axis, i - first] ^ numbers[axis, bit]
            first, bit = 2 * first, bit + 1
    return table


@overload(opened)
def _opened(points, element, block):
    return _opened_sobol if points.instance_class is Sobol else None


def _opened_sobol(points, element, block):
    own = mix64(stream(points.seed, element, 0))
    (a, b), (c, d) = halves(own), halves(mix64(own))
    v = points.directions
    return Net(points.table, (a ^ first(v[0], block), b ^ first(v[1], block), c ^ first(v[2], block), d ^ first(v[3], block)))


@strict
def first(numbers, block):
    """The first point of a block, not shifted."""
    x, bit = np.uint32(0), WITHIN
    while block:
        if block & 1:
            x ^= numbers[bit]
        block, bit = block >> 1, bit + 1
    return x


@overload(drawn)
def _drawn(i, opened, model):
    return _drawn_sobol if getattr(opened, "instance_class", None) is Net else None


def _drawn_sobol(i, opened, model):
    table, start = opened
    s, t = like(model, np.int32(table[0, i] ^ start[0])), like(model, np.int32(table[1, i] ^ start[1]))
    return s, t, like(model, np.int32(table[2, i] ^ start[2])), like(model, np.int32(table[3, i] ^ start[3]))
