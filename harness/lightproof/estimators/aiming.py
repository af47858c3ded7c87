"""Light straight from bulbs and lamps at every vertex of a batch of paths: one point of each lamp, drawn uniformly by area."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.batch import LIGHT, NORMAL, PLACE, REACH, TOTAL, WAY, WEIGHT, at, put
from lightproof.estimators.compiled import INLINED, inlined, strict
from lightproof.estimators.lamps import parameters
from lightproof.estimators.rng import TICK, block_keys, draws
from lightproof.estimators.shapes import Cap, Sphere
from lightproof.estimators.solids import FAR, shade, solid
from lightproof.estimators.tracing import vector
from lightproof.estimators.trigonometry import turn
from lightproof.estimators.vectors import along, dot, scaled, sub, tangents
from lightproof.estimators.world import AREA, RADIANCE

NOTHING = 1e-150  # keeps a length of nothing from a division


class Points(NamedTuple):
    """`rows` (l, 4): position, intensity."""

    rows: np.ndarray


class Beams(NamedTuple):
    """`rows` (l, 4): unit vector of travel, irradiance."""

    rows: np.ndarray


@strict
def illuminate(bulbs, lamps, blockers, state, count, key, near):
    """Adds to TOTAL what the vertices receive straight from all bulbs and lamps, times WEIGHT."""
    from_bulbs(bulbs, blockers, state, count, near)
    from_lamps(lamps, blockers, state, count, key, near)


def from_bulbs(bulbs, blockers, state, count, near):
    """The part of all bulbs, a tuple of groups."""


@overload(from_bulbs)
def _from_bulbs(bulbs, blockers, state, count, near):
    return (lambda bulbs, blockers, state, count, near: None) if len(bulbs) == 0 else bulbs_on


def bulbs_on(bulbs, blockers, state, count, near):
    from_bulbs(bulbs[1:], blockers, state, count, near)
    group = bulbs[0]
    for k in range(len(group.rows)):
        from_bulb(group, k, state, count)
        shade(blockers, 0, state, count, near)
        collect(state, count)


def from_bulb(group, k, state, count):
    """Unshadowed irradiance into LIGHT, the way to the bulb into WAY and REACH."""


@overload(from_bulb)
def _from_bulb(group, k, state, count):
    return {Points: _from_point, Beams: _from_beam}[group.instance_class]


def _from_point(group, k, state, count):
    place, intensity = vector(group.rows[k], 0), group.rows[k, 3]
    for i in range(count):
        d = sub(place, at(state, PLACE, i))
        r2 = max(dot(d, d), NOTHING)
        r = math.sqrt(r2)
        w = scaled(1 / r, d)
        put(state, WAY, i, w)
        state[REACH + i] = r
        state[LIGHT + i] = intensity * max(dot(w, at(state, NORMAL, i)), 0.0) / r2


def _from_beam(group, k, state, count):
    back, irradiance = scaled(-1.0, vector(group.rows[k], 0)), group.rows[k, 3]
    for i in range(count):
        put(state, WAY, i, back)
        state[REACH + i] = FAR
        state[LIGHT + i] = irradiance * max(dot(back, at(state, NORMAL, i)), 0.0)


@strict
def collect(state, count):
    for i in range(count):
        state[TOTAL + i] += state[WEIGHT + i] * state[LIGHT + i]


def from_lamps(lamps, blockers, state, count, key, near):
    """The part of all lamps, a tuple of groups of `solids`."""


@overload(from_lamps)
def _from_lamps(lamps, blockers, state, count, key, near):
    return (lambda lamps, blockers, state, count, key, near: None) if len(lamps) == 0 else lamps_on


def lamps_on(lamps, blockers, state, count, key, near):
    from_lamps(lamps[1:], blockers, state, count, key, near)
    group = lamps[0]
    for k in range(len(group.rows)):
        row, own = group.rows[k], group.numbers[k]
        from_lamp(solid(group, k), row[RADIANCE], row[AREA], state, count, block_keys(key, own))
        shade(blockers, own, state, count, near)
        collect(state, count)


@strict
def from_lamp(shape, radiance, area, state, count, keys):
    """L cos(theta_x) cos(theta_y) / (r^2 p) of one point of a lamp, whatever stands between."""
    for i in range(count):
        s, t = draws(i, keys, 1.0)[:2]
        x = at(state, PLACE, i)
        y, n, per_density = spot(shape, area, x, s, t)
        d = sub(y, x)
        r2 = max(dot(d, d), NOTHING)
        r = math.sqrt(r2)
        put(state, WAY, i, scaled(1 / r, d))
        state[REACH + i] = r
        cosines = max(dot(d, at(state, NORMAL, i)), 0.0) * max(-dot(d, n), 0.0)
        state[LIGHT + i] = radiance * per_density * cosines / (r2 * r2)


def spot(shape, area, x, s, t):
    """A point of a lamp, its normal there and 1/density per area [m2], from two draws in units of TICK. Of a sphere only the
    cap that faces x is drawn from."""


@overload(spot, jit_options=INLINED)
def _spot(shape, area, x, s, t):
    return {Sphere: _spot_on_sphere, Cap: _spot_on_cap}.get(shape.instance_class, _spot_on_flat)


def _spot_on_flat(shape, area, x, s, t):
    a, b = parameters(shape, s, t)
    return along(along(shape.center, a, shape.u), b, shape.v), shape.normal, area


def _spot_on_sphere(shape, area, x, s, t):
    away = sub(x, shape.center)
    r = max(math.sqrt(dot(away, away)), NOTHING)
    height = max(r - shape.radius, 0.0) / r
    n = around(scaled(1 / r, away), (s * TICK + 0.5) * height, t)
    return along(shape.center, shape.radius, n), n, area * height / 2


def _spot_on_cap(shape, area, x, s, t):
    n = around(shape.axis, (s * TICK + 0.5) * (1 - shape.cosine), t)
    return along(shape.center, shape.radius, n), n, area


@inlined
def around(axis, down, t):
    """The unit vector that is `down` lower along `axis` than its tip, TICK t turns about it."""
    side = math.sqrt(max(down * (2 - down), 0.0))
    sine, cosine = turn(t)
    e1, e2 = tangents(axis)
    return along(along(scaled(1 - down, axis), side * cosine, e1), side * sine, e2)
