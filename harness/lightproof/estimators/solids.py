"""What rays meet: the items of a `World` in one group for each kind of shape, and where a ray meets each kind.

Only the kinds that a scene has are compiled, and each in one loop over a batch of rays, whatever the number of items.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.batch import BEND, FACE, GLOW, LIGHT, PLACE, REACH, REFLECTED, SIZE, WAY, at, put
from lightproof.estimators.compiled import INLINED, inlined, strict
from lightproof.estimators.shapes import Cap, Disk, Parallelogram, Sphere, Triangle, covers
from lightproof.estimators.tracing import vector
from lightproof.estimators.vectors import along, dot, scaled, sub
from lightproof.estimators.world import CENTER, COSINE, DUAL_U, DUAL_V, KIND, KINDS, NORMAL, RADIUS, U, V

FAR = 1e30  # m: nothing is as far


class Parallelograms(NamedTuple):
    """`rows` (m, WIDTH) of a World's items, and the `numbers` (m,) of these from 1 on."""

    rows: np.ndarray
    numbers: np.ndarray


class Triangles(NamedTuple):
    """As `Parallelograms`."""

    rows: np.ndarray
    numbers: np.ndarray


class Disks(NamedTuple):
    """As `Parallelograms`."""

    rows: np.ndarray
    numbers: np.ndarray


class Spheres(NamedTuple):
    """As `Parallelograms`."""

    rows: np.ndarray
    numbers: np.ndarray


class Caps(NamedTuple):
    """As `Parallelograms`."""

    rows: np.ndarray
    numbers: np.ndarray


GROUPS = {Parallelogram: Parallelograms, Triangle: Triangles, Disk: Disks, Sphere: Spheres, Cap: Caps}


def grouped(items: np.ndarray, which: np.ndarray) -> tuple:
    """The items (m, WIDTH) for which `which` (m,) holds, by kind."""
    chosen = {kind: np.flatnonzero(which & (items[:, KIND] == code)) for kind, code in KINDS.items()}
    return tuple(GROUPS[kind](items[found], np.uint32(found + 1)) for kind, found in chosen.items() if len(found))


def solid(group, k):
    """The shape of item k of a group."""


@overload(solid)
def _solid(group, k):
    return {Spheres: _sphere, Caps: _cap}.get(group.instance_class) or FLAT[group.instance_class]


def _sphere(group, k):
    return Sphere(vector(group.rows[k], CENTER), group.rows[k, RADIUS])


def _cap(group, k):
    return Cap(vector(group.rows[k], CENTER), group.rows[k, RADIUS], vector(group.rows[k], NORMAL), group.rows[k, COSINE])


def _flat(kind):
    def shape(group, k):
        row = group.rows[k]
        return kind(vector(row, CENTER), vector(row, U), vector(row, V), vector(row, NORMAL), vector(row, DUAL_U),
                    vector(row, DUAL_V))  # fmt: skip

    return shape


FLAT = {Parallelograms: _flat(Parallelogram), Triangles: _flat(Triangle), Disks: _flat(Disk)}


def met(shape, x, w, near):
    """Distance beyond `near` at which a ray along w, a unit vector, meets the shape; FAR where it does not."""


@overload(met, jit_options=INLINED)
def _met(shape, x, w, near):
    return {Sphere: _met_sphere, Cap: _met_cap}.get(shape.instance_class, _met_flat)


def _met_flat(shape, x, w, near):
    o, slope = sub(shape.center, x), dot(w, shape.normal)
    t = dot(o, shape.normal) / (slope if slope != 0 else 1.0)
    p = sub(scaled(t, w), o)
    within = (slope != 0) & (t > near) & covers(shape, dot(p, shape.dual_u), dot(p, shape.dual_v))
    return t if within else FAR


@inlined
def crossings(shape, x, w):
    """Where a line enters the sphere and where it leaves it; FAR, FAR where it does neither."""
    o = sub(shape.center, x)
    b = dot(o, w)
    foot = sub(o, scaled(b, w))
    rest = shape.radius * shape.radius - dot(foot, foot)
    half = math.sqrt(max(rest, 0.0))
    return b - half if rest >= 0 else FAR, b + half if rest >= 0 else FAR


def _met_sphere(shape, x, w, near):
    enter, leave = crossings(shape, x, w)
    last = leave if leave > near else FAR
    return enter if enter > near else last


def _met_cap(shape, x, w, near):
    enter, leave = crossings(shape, x, w)
    last = leave if (leave > near) & on_cap(shape, along(x, leave, w)) else FAR
    return enter if (enter > near) & on_cap(shape, along(x, enter, w)) else last


@inlined
def on_cap(shape, p):
    """Whether a point of the sphere belongs to the cap."""
    return dot(sub(p, shape.center), shape.axis) >= shape.radius * shape.cosine


def find(groups, faces, state, count, near):
    """The nearest item along each ray beyond `near`: the distance into REACH (FAR: none), its front into FACE, BEND, GLOW and
    REFLECTED; `faces` (m + 1, 6) has the fronts by number, 0 being a black nothing."""


@overload(find)
def _find(groups, faces, state, count, near):
    return find_nothing if len(groups) == 0 else find_on


def find_nothing(groups, faces, state, count, near):
    for i in range(count):
        state[REACH + i] = FAR
        front(state, i, (0.0, 0.0, 0.0), 0.0, 0.0, 0.0)


def find_on(groups, faces, state, count, near):
    find(groups[1:], faces, state, count, near)
    group = groups[0]
    for k in range(len(group.rows)):
        row = faces[group.numbers[k]]
        shorten(solid(group, k), vector(row, 0), row[3], row[4], row[5], state, count, near)


@inlined
def front(state, i, a, b, radiance, reflectance):
    put(state, FACE, i, a)
    state[BEND + i], state[GLOW + i], state[REFLECTED + i] = b, radiance, reflectance


@strict
def shorten(shape, a, b, radiance, reflectance, state, count, near):
    """Ends the rays that meet this shape at it."""
    for i in range(count):
        t = met(shape, at(state, PLACE, i), at(state, WAY, i), near)
        closer = t < state[REACH + i]
        other = at(state, FACE, i)
        state[REACH + i] = t if closer else state[REACH + i]
        state[FACE + i] = a[0] if closer else other[0]
        state[FACE + SIZE + i] = a[1] if closer else other[1]
        state[FACE + 2 * SIZE + i] = a[2] if closer else other[2]
        state[BEND + i] = b if closer else state[BEND + i]
        state[GLOW + i] = radiance if closer else state[GLOW + i]
        state[REFLECTED + i] = reflectance if closer else state[REFLECTED + i]


def shade(groups, own, state, count, near):
    """Blackens LIGHT where an item, but for number `own`, stands between: nearer than REACH by more than `near`."""


@overload(shade)
def _shade(groups, own, state, count, near):
    return (lambda groups, own, state, count, near: None) if len(groups) == 0 else shade_on


def shade_on(groups, own, state, count, near):
    shade(groups[1:], own, state, count, near)
    group = groups[0]
    for k in range(len(group.rows)):
        if group.numbers[k] != own:
            blacken(solid(group, k), state, count, near)


@strict
def blacken(shape, state, count, near):
    for i in range(count):
        t = met(shape, at(state, PLACE, i), at(state, WAY, i), near)
        state[LIGHT + i] = 0.0 if t < state[REACH + i] - near else state[LIGHT + i]
