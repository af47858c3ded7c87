"""Many blockers: rows of an array instead of a tuple of types, tested one blocker at a time against a whole block of samples.

A row (COLUMNS,) is what `FIELDS` has of an item of a `World`: kind, centre, normal, dual u, dual v, radius.
"""

from __future__ import annotations

import numpy as np
from numba import types
from numba.extending import overload

from lightproof.estimators.blockers import all_placed, hidden
from lightproof.estimators.compiled import fast
from lightproof.estimators.shapes import Disk, Parallelogram, Sphere, Triangle
from lightproof.estimators.vectors import like, sub, turned
from lightproof.estimators.world import CENTER, DISK, KIND, NORMAL, PARALLELOGRAM, RADIUS, TRIANGLE, U

FIELDS = [KIND, *range(CENTER, U), *range(NORMAL, RADIUS + 1)]  # of a `World`'s item
COLUMNS = len(FIELDS)


@overload(all_placed)
def _all_placed(blockers, origin, frame, model):
    return placed_rows if isinstance(blockers, types.Array) else None


def placed_rows(blockers, origin, frame, model):
    """The rows as seen from `origin` along the axes of `frame`, in the precision of `model`."""
    out = np.full((len(blockers), COLUMNS), model)
    for k in range(len(blockers)):
        out[k, 0], out[k, COLUMNS - 1] = blockers[k, 0], blockers[k, COLUMNS - 1]
        for at in (1, 4, 7, 10):
            v = blockers[k, at], blockers[k, at + 1], blockers[k, at + 2]
            out[k, at], out[k, at + 1], out[k, at + 2] = turned(sub(v, origin) if at == 1 else v, frame, model)
    return out


@fast
def flat(kind, blocker):
    """A flat shape from its row, as far as `hidden` looks at it."""
    center, normal = (blocker[1], blocker[2], blocker[3]), (blocker[4], blocker[5], blocker[6])
    dual_u, dual_v = (blocker[7], blocker[8], blocker[9]), (blocker[10], blocker[11], blocker[12])
    return kind(center, dual_u, dual_v, normal, dual_u, dual_v)


@fast
def shadow(shape, x, d, f):
    """Blackens every sample `f` (n,) whose segment from x (2, n) along d (3, n) the shape cuts."""
    for i in range(len(f)):
        if hidden(shape, (x[0, i], x[1, i], like(f[i], 0)), (d[0, i], d[1, i], d[2, i])):
            f[i] = like(f[i], 0)


@fast
def shadow_all(blockers, x, d, f):
    """`shadow` of every row."""
    for k in range(len(blockers)):
        blocker = blockers[k]
        if blocker[0] == PARALLELOGRAM:
            shadow(flat(Parallelogram, blocker), x, d, f)
        elif blocker[0] == TRIANGLE:
            shadow(flat(Triangle, blocker), x, d, f)
        elif blocker[0] == DISK:
            shadow(flat(Disk, blocker), x, d, f)
        else:
            shadow(Sphere((blocker[1], blocker[2], blocker[3]), blocker[COLUMNS - 1]), x, d, f)
