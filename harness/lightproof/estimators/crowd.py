"""Many blockers: arrays by kind of shape instead of a tuple, tested one blocker at a time against a whole block of samples.

A row as an element faces it: of a sphere centre and radius, of a flat shape normal, dual u, dual v, level and margins.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.blockers import all_faced, faced_by, hidden
from lightproof.estimators.compiled import fast
from lightproof.estimators.shapes import Disk, Parallelogram, Sphere, Triangle
from lightproof.estimators.solids import Disks, Parallelograms, Spheres, Triangles, grouped, solid
from lightproof.estimators.tracing import vector
from lightproof.estimators.vectors import like
from lightproof.estimators.windows import Window

COLUMNS = 14


class Crowd(NamedTuple):
    """Blockers in `groups` as `solids` has them, one for each kind of shape."""

    groups: tuple

    @classmethod
    def of(cls, rows: np.ndarray) -> Crowd:
        """Of rows (m, WIDTH) of a `World`."""
        return cls(grouped(rows, np.ones(len(rows), bool)))


class Faced(NamedTuple):
    """The same as an element faces them, each group with its `rows`, (m, COLUMNS) each."""

    groups: tuple
    rows: tuple


@overload(all_faced)
def _all_faced(blockers, origin, frame, model):
    return face if getattr(blockers, "instance_class", None) is Crowd else None


def face(blockers, origin, frame, model):
    return Faced(blockers.groups, rows_of(blockers.groups, origin, frame, model))


def rows_of(groups, origin, frame, model):
    """The rows of each group as seen from `origin` along the axes of `frame`, in the precision of `model`."""


@overload(rows_of)
def _rows_of(groups, origin, frame, model):
    if len(groups) == 0:
        return lambda groups, origin, frame, model: ()
    return lambda groups, origin, frame, model: (
        rows_of_one(groups[0], origin, frame, model),
        *rows_of(groups[1:], origin, frame, model),
    )


@fast
def rows_of_one(group, origin, frame, model):
    out = np.full((len(group.rows), COLUMNS), model)
    for k in range(len(out)):
        put(faced_by(solid(group, k), origin, frame, model), out[k])
    return out


def put(blocker, row):
    """Writes a blocker down."""


@overload(put)
def _put(blocker, row):
    return {Sphere: _put_sphere, Window: _put_window}[blocker.instance_class]


def _put_sphere(blocker, row):
    row[0], row[1], row[2] = blocker.center
    row[3] = blocker.radius


def _put_window(blocker, row):
    row[0], row[1], row[2] = blocker.shape.normal
    row[3], row[4], row[5] = blocker.shape.dual_u
    row[6], row[7], row[8] = blocker.shape.dual_v
    row[9] = blocker.level
    for k in range(len(blocker.margins)):
        row[10 + k] = blocker.margins[k]


def taken(group, row):
    """A blocker of the group from its row, as far as `hidden` looks at it."""


@overload(taken)
def _taken(group, row):
    return TAKEN[group.instance_class]


def _sphere(group, row):
    return Sphere(vector(row, 0), row[3])


def _window(kind, margins):
    def take(group, row):
        normal, dual_u, dual_v = vector(row, 0), vector(row, 3), vector(row, 6)
        return Window(kind(normal, dual_u, dual_v, normal, dual_u, dual_v), row[9], margins(row))

    return take


@fast
def three(row):
    return row[10], row[11], row[12]


@fast
def four(row):
    return row[10], row[11], row[12], row[13]


TAKEN = {Spheres: _sphere, Parallelograms: _window(Parallelogram, four), Triangles: _window(Triangle, three),
         Disks: _window(Disk, three)}  # fmt: skip


def shadow_all(groups, rows, x, d, f):
    """`shadow` of every blocker."""


@overload(shadow_all)
def _shadow_all(groups, rows, x, d, f):
    return (lambda groups, rows, x, d, f: None) if len(groups) == 0 else shadow_on


def shadow_on(groups, rows, x, d, f):
    shadow_all(groups[1:], rows[1:], x, d, f)
    for k in range(len(rows[0])):
        shadow(taken(groups[0], rows[0][k]), x, d, f)


@fast
def shadow(blocker, x, d, f):
    """Blackens every sample `f` (n,) whose segment from x (2, n) along d (3, n) the blocker cuts."""
    for i in range(len(f)):
        if hidden(blocker, (x[0, i], x[1, i], like(f[i], 0)), (d[0, i], d[1, i], d[2, i])):
            f[i] = like(f[i], 0)
