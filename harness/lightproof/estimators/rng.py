"""Random numbers by counter: a draw is a pure function of (seed, element, stream, index), so threads and order change nothing.

The samples of a block are points of a Korobov lattice of 2^32 points: k r, a k r, a2 k r, a3 k r modulo 2^32, where r is
one of BLOCK random numbers that all blocks share, and k an odd number drawn afresh for every block, as is a shift of each
coordinate. The shift makes each point uniform, which keeps the estimate free of bias; k makes two points of a block
uncorrelated. A table costs a load a sample where a hash would cost two multiplications and a long wait. The multiplier a is
one of the full-period generators of L'Ecuyer 1999, "Tables of linear congruential generators of different sizes and good
lattice structure".
"""

from __future__ import annotations

import numpy as np

from lightproof.estimators.compiled import fast, strict
from lightproof.estimators.vectors import like

BLOCK = 2048  # points between two draws of the lattice's shift; blocks add in float64
TABLE = (np.random.PCG64(BLOCK).random_raw(BLOCK) >> np.uint64(32)).astype(np.uint32)
A1 = np.uint32(32310901)
A2 = np.uint32(32310901**2 % 2**32)
A3 = np.uint32(32310901**3 % 2**32)
TICK = 2.0**-32  # a draw of 32 bits, read as a signed integer, times TICK lies in [-1/2, 1/2)


@strict
def mix64(z):
    """SplitMix64's step and finaliser (Steele, Lea and Flood 2014): a bijection of 64 bits with full avalanche."""
    z = np.uint64(np.uint64(z) + np.uint64(0x9E3779B97F4A7C15))
    z = np.uint64((z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9))
    z = np.uint64((z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB))
    return np.uint64(z ^ (z >> np.uint64(31)))


@strict
def stream(seed, element, index):
    """A 64-bit key for one stream of draws."""
    return mix64(mix64(mix64(np.uint64(seed)) ^ np.uint64(element)) ^ np.uint64(index))


@strict
def uniform(key, index):
    """Draw `index` of stream `key`, a float64 in (0, 1) that is never 0 nor 1."""
    bits = mix64(np.uint64(key + np.uint64(index) * np.uint64(0x9E3779B97F4A7C15)))
    return (np.float64(bits >> np.uint64(12)) + 0.5) * 2.0**-52


@strict
def halves(key):
    """The two 32-bit halves of a 64-bit key."""
    return np.uint32(key), np.uint32(key >> np.uint64(32))


@strict
def block_keys(key, block):
    """For a block of samples of stream `key`: multipliers and shifts of the lattice's four coordinates."""
    a = mix64(key ^ np.uint64(block))
    b, c = mix64(a), mix64(a ^ np.uint64(1))
    k = np.uint32(halves(a)[0] | np.uint32(1))
    return (k, np.uint32(k * A1), np.uint32(k * A2), np.uint32(k * A3)), (*halves(b), *halves(c))


@fast
def ticks(h, multiplier, shift):
    """One lattice coordinate as a signed 32-bit integer: times TICK it is uniform in [-1/2, 1/2)."""
    return np.int32(np.uint32(np.uint32(h * multiplier) + shift))


@fast
def draws(index, keys, model):
    """The four coordinates of sample `index` of a block, in units of TICK and in the type of `model`."""
    r, (k, shift) = TABLE[index], keys
    s, t = like(model, ticks(r, k[0], shift[0])), like(model, ticks(r, k[1], shift[1]))
    return s, t, like(model, ticks(r, k[2], shift[2])), like(model, ticks(r, k[3], shift[3]))
