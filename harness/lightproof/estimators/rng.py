"""Random numbers by counter: a draw is a pure function of (seed, element, stream, index), so threads and order change nothing.

Within a block of samples one 32-bit hash h gives up to four coordinates: h, a h, a2 h, a3 h modulo 2^32, a point of a
Korobov lattice of 2^32 points picked at random, moved by a shift that is drawn afresh for every block. Each coordinate is
uniform over all 2^32 values, and the shifts keep the estimate free of bias. The multiplier a is one of the full-period
generators of L'Ecuyer 1999, "Tables of linear congruential generators of different sizes and good lattice structure".
"""

from __future__ import annotations

import numpy as np

from lightproof.estimators.compiled import fast, strict
from lightproof.estimators.vectors import like

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
    """For a block of samples of stream `key`: the counter's offset, and the shifts of the lattice's last three coordinates."""
    own = mix64(key ^ np.uint64(block))
    return *halves(own), *halves(mix64(own))


@fast
def hash32(index, key):
    """Two rounds of xorshift and multiply (constants of Wellons' lowbias32) over a counter offset by a random key."""
    x = np.uint32(np.uint32(index) + key)
    x = np.uint32(np.uint32(x ^ np.uint32(x >> np.uint32(16))) * np.uint32(0x7FEB352D))
    return np.uint32(np.uint32(x ^ np.uint32(x >> np.uint32(15))) * np.uint32(0x846CA68B))


@fast
def ticks(h, multiplier, shift):
    """One lattice coordinate as a signed 32-bit integer: times TICK it is uniform in [-1/2, 1/2)."""
    return np.int32(np.uint32(np.uint32(h * multiplier) + shift))


@fast
def draws(index, keys, model):
    """The four coordinates of sample `index` of a block, in units of TICK and in the type of `model`."""
    h = hash32(index, keys[0])
    s, t = like(model, np.int32(h)), like(model, ticks(h, A1, keys[1]))
    return s, t, like(model, ticks(h, A2, keys[2])), like(model, ticks(h, A3, keys[3]))
