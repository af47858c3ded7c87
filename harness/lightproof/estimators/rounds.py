"""One step of every path of a batch: on along its ray to what that meets, and off again in a random direction."""

from __future__ import annotations

import math

from numba.extending import overload

from lightproof.estimators.batch import BEND, FACE, GLOW, NORMAL, PLACE, REACH, REFLECTED, TOTAL, WAY, WEIGHT, at, put
from lightproof.estimators.compiled import inlined, strict
from lightproof.estimators.rng import TICK, draws
from lightproof.estimators.skies import sky_radiances
from lightproof.estimators.solids import FAR
from lightproof.estimators.trigonometry import turn
from lightproof.estimators.vectors import along, dot, norm, scaled

GRAZING = 1e-100  # keeps a length of nothing from a division


@strict
def scatter(state, count, keys):
    """Directions of density cos(theta)/pi: towards points uniform on the unit sphere that rests on the vertex."""
    for i in range(count):
        s, t = draws(i, keys, 1.0)[:2]
        w = along(on_unit_sphere(s, t), 1.0, at(state, NORMAL, i))
        put(state, WAY, i, scaled(1 / max(norm(w), GRAZING), w))


@inlined
def on_unit_sphere(s, t):
    """A point uniform on the unit sphere, from two draws in units of TICK (Archimedes)."""
    z = 2 * TICK * s
    r = math.sqrt(max(1 - z * z, 0.0))
    sine, cosine = turn(t)
    return r * cosine, r * sine, z


def gather_sky(skies, state, count):
    """Adds the radiance of all skies to the paths that met nothing else."""


@overload(gather_sky)
def _gather_sky(skies, state, count):
    return (lambda skies, state, count: None) if len(skies) == 0 else sky_on


def sky_on(skies, state, count):
    for i in range(count):
        radiance = sky_radiances(skies, at(state, WAY, i))
        state[TOTAL + i] += state[WEIGHT + i] * math.pi * radiance if state[REACH + i] == FAR else 0.0


@strict
def land(state, count):
    """Moves to what was met; adds the radiance of its front; WEIGHT takes its reflectance, or 0 from its back. How many paths
    still have a weight."""
    going = 0
    for i in range(count):
        w = at(state, WAY, i)
        x = along(at(state, PLACE, i), state[REACH + i], w)
        n = along(at(state, FACE, i), state[BEND + i], x)
        weight = state[WEIGHT + i] if dot(n, w) < 0 else 0.0
        state[TOTAL + i] += weight * math.pi * state[GLOW + i]
        state[WEIGHT + i] = weight * state[REFLECTED + i]
        put(state, PLACE, i, x)
        put(state, NORMAL, i, n)
        going += state[WEIGHT + i] > 0
    return going


@strict
def play(state, count, keys, faint):
    """Roulette: a path of less weight than `faint` goes on with that weight or ends, so that its expectation stays (Arvo and
    Kirk 1990). How many go on."""
    going = 0
    for i in range(count):
        weight = state[WEIGHT + i]
        lives = weight > faint * (draws(i, keys, 1.0)[2] * TICK + 0.5)
        state[WEIGHT + i] = max(weight, faint) if lives else 0.0
        going += lives
    return going
