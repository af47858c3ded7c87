"""Where paths start: on a film that receives, or at what the rays of a camera meet."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.batch import LIGHT, NORMAL, PLACE, REACH, TOTAL, WAY, WEIGHT, put
from lightproof.estimators.compiled import INLINED, fast, inlined, strict
from lightproof.estimators.points import Random, drawn, opened
from lightproof.estimators.rng import BLOCK, TICK, draws
from lightproof.estimators.tracing import vector
from lightproof.estimators.vectors import along, unit
from lightproof.estimators.world import ORTHOGRAPHIC, PERSPECTIVE, RECEIVER

P, Q = REACH, LIGHT  # rows that are free: a place of the element in steps from its centre


class Receivers(NamedTuple):
    """`rows` (n, 12) of a World's elements: centre, steps along a row and a column, normal."""

    rows: np.ndarray


class Within(NamedTuple):
    """The same in a room whose walls are where paths begin: what the receivers see of them."""

    rows: np.ndarray


class Pinhole(NamedTuple):
    """`rows` (n, 12): eye, steps, direction through the middle of the pixel."""

    rows: np.ndarray


class Parallel(NamedTuple):
    """`rows` (n, 12): middle of the pixel, steps, direction of view."""

    rows: np.ndarray


FILMS = {RECEIVER: Receivers, PERSPECTIVE: Pinhole, ORTHOGRAPHIC: Parallel}
CAMERAS = (Pinhole, Parallel)


def first_weight(film):
    """What a path's first ray counts per pi times radiance: of a film that receives, 1."""


@overload(first_weight)
def _first_weight(film):
    weight = 1 / math.pi if film.instance_class in CAMERAS else 1.0
    return lambda film: weight


@strict
def begin(film, points, state, slots, first, samples, number, count, keys):
    """Paths `number` and following, samples `samples[0]` to `samples[1]` of every element, at uniform places of it. The film's
    first element is number `first`."""
    for i in range(count):
        slots[i], state[WEIGHT + i], state[TOTAL + i] = i, first_weight(film), 0.0
    choose(points, state, first, samples, number, count, keys)
    each = samples[1] - samples[0]
    i = 0
    while i < count:
        element, last = run(number, i, count, each)
        start_all(film, vectors(film.rows[element]), state[i:], last - i)
        i = last


def choose(points, state, first, samples, number, count, keys):
    """Every path's place in its element: independent ones need no order."""


@overload(choose)
def _choose(points, state, first, samples, number, count, keys):
    return scattered if points.instance_class is Random else in_order


def scattered(points, state, first, samples, number, count, keys):
    for i in range(count):
        s, t = draws(i, keys, 1.0)[:2]
        state[P + i], state[Q + i] = s * TICK, t * TICK


def in_order(points, state, first, samples, number, count, keys):
    each = samples[1] - samples[0]
    i = 0
    while i < count:
        element, last = run(number, i, count, each)
        block, within = divmod(samples[0] + number + i - element * each, BLOCK)
        last = min(last, i + BLOCK - within)
        own = opened(points, first + element, block)
        for k in range(i, last):
            s, t = drawn(within + k - i, own, 1.0)[:2]
            state[P + k], state[Q + k] = s * TICK, t * TICK
        i = last


@inlined
def run(number, i, count, each):
    """The element that path number + i belongs to, and one more than the last i of it."""
    element = (number + i) // each
    return element, min(count, (element + 1) * each - number)


@inlined
def vectors(row):
    """Origin, steps, and normal or direction."""
    return vector(row, 0), vector(row, 3), vector(row, 6), vector(row, 9)


@strict
def start_all(film, element, state, count):
    """Paths of one element; `state` starts with the first of them."""
    for i in range(count):
        start(film, state, i, element, state[P + i], state[Q + i])


@strict
def sum_up(totals, number, count, each, out):
    """Adds every path's value and its square to its element's, `out` (n, 2)."""
    i = 0
    while i < count:
        element, last = run(number, i, count, each)
        value, square = moments(totals[i:last])
        out[element, 0] += value
        out[element, 1] += square
        i = last


@fast
def moments(values):
    """Sum of the values and of their squares."""
    total, square = 0.0, 0.0
    for value in values:
        total += value
        square += value * value
    return total, square


def start(film, state, i, element, p, q):
    """Place and normal of a receiver, or origin and direction of a camera's ray."""


@overload(start, jit_options=INLINED)
def _start(film, state, i, element, p, q):
    return {Receivers: _receive, Within: _receive, Pinhole: _look_out, Parallel: _look_along}[film.instance_class]


def _receive(film, state, i, element, p, q):
    place, u, v, normal = element
    put(state, PLACE, i, along(along(place, p, u), q, v))
    put(state, NORMAL, i, normal)


def _look_out(film, state, i, element, p, q):
    eye, u, v, way = element
    put(state, PLACE, i, eye)
    put(state, WAY, i, unit(along(along(way, p, u), q, v)))


def _look_along(film, state, i, element, p, q):
    place, u, v, way = element
    put(state, PLACE, i, along(along(place, p, u), q, v))
    put(state, WAY, i, way)
