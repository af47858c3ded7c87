"""A point light or a beam behind shapes of any kind: lit or not, and how much; shadows are hard."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.compiled import strict
from lightproof.estimators.levels import ZERO, level
from lightproof.estimators.rows import point
from lightproof.estimators.sources import desk, irradiance
from lightproof.estimators.vectors import along, cross, dot, norm, scaled, sub, tangents

CENTER, AXIS, RADIUS, LENGTH = 0, 3, 6, 7  # columns of a round shape
TOUCH = 1e-12  # of a shape's size: what lies no farther from its surface touches it


class Solids(NamedTuple):
    """What may stand in between: polygons of `corners` (m, 3), which begin at `starts` (k + 1), with `normals` (k, 2, 3), the
    second row being what float64 leaves out of the first; rows (l, 8) of `disks`, `balls` and `tubes`: centre or base, axis,
    radius, length. What lies within `touch` [m] of a plane coincides with it."""

    corners: np.ndarray
    starts: np.ndarray
    normals: np.ndarray
    disks: np.ndarray
    balls: np.ndarray
    tubes: np.ndarray
    touch: float


class Bulb(NamedTuple):
    """`strength`: intensity [W/sr] of a light at `position`, or with `reach` = inf the irradiance [W/m2] across a beam that comes
    from the direction `position`; else `reach` is 1."""

    position: tuple
    strength: float
    reach: float
    solids: Solids


@overload(desk)
def _desk(source):
    return (lambda source: 0) if getattr(source, "instance_class", None) is Bulb else None


@overload(irradiance)
def _irradiance(source, desk, x, n):
    return from_bulb if getattr(source, "instance_class", None) is Bulb else None


def from_bulb(source, desk, x, n):
    beam = source.reach == np.inf
    d = source.position if beam else sub(source.position, x)
    level_ = level(n, ZERO, source.position, ZERO if beam else x) / norm(n)
    if level_ <= 0 or hidden(source.solids, x, n, d, source.reach):
        return 0.0
    return source.strength * level_ / (norm(d) if beam else norm(d) ** 3)


@strict
def hidden(solids, x, n, d, reach):
    """Whether anything stands on the way from x along d, up to `reach` lengths of it."""
    for k in range(len(solids.starts) - 1):
        begin, end = solids.starts[k], solids.starts[k + 1]
        normal, low = point(solids.normals[k], 0), point(solids.normals[k], 1)
        before = level(normal, low, point(solids.corners, begin), x)
        if crossed(before, dot(normal, d), dot(normal, n), reach, solids.touch) and in_loop(solids.corners, begin, end, x, d):
            return True
    for disk in solids.disks:
        if behind_disk(disk, x, n, d, reach, solids.touch):
            return True
    for ball in solids.balls:
        if behind_ball(ball, x, d, reach):
            return True
    behind = False
    for tube in solids.tubes:
        behind |= behind_tube(tube, x, d, reach)
    return behind


@strict
def crossed(before, slope, facing, reach, touch):
    """Whether the way from x along d crosses a plane that lies `before` x along its normal; `slope` and `facing` are the shares
    of d and of the receiver's normal along that. A receiver on the plane is on the side that it faces."""
    if abs(before) <= touch:
        return facing * slope < 0
    return before * slope > 0 and abs(before) < reach * abs(slope) - (touch if reach < np.inf else 0.0)


@strict
def in_loop(corners, begin, end, x, d):
    """Whether the line from x along d runs through a polygon, convex or not: the number of edges to one side is odd."""
    s, t = tangents(scaled(1 / norm(d), d))
    odd = False
    a = sub(point(corners, end - 1), x)
    a_s, a_t = dot(a, s), dot(a, t)
    for i in range(begin, end):
        b = sub(point(corners, i), x)
        b_s, b_t = dot(b, s), dot(b, t)
        if (a_t > 0) != (b_t > 0):
            odd ^= (a_s * (b_t - a_t) > a_t * (b_s - a_s)) == (b_t > a_t)
        a_s, a_t = b_s, b_t
    return odd


@strict
def behind_disk(disk, x, n, d, reach, touch):
    normal = (disk[AXIS], disk[AXIS + 1], disk[AXIS + 2])
    o = sub((disk[CENTER], disk[CENTER + 1], disk[CENTER + 2]), x)
    before, slope = dot(o, normal), dot(d, normal)
    if not crossed(before, slope, dot(normal, n), reach, touch):
        return False
    miss = sub(scaled(before / slope, d), o)
    return dot(miss, miss) <= disk[RADIUS] * disk[RADIUS]


@strict
def behind_ball(ball, x, d, reach):
    o = sub((ball[CENTER], ball[CENTER + 1], ball[CENTER + 2]), x)
    along_d, d2, r2 = dot(o, d), dot(d, d), ball[RADIUS] * ball[RADIUS]
    aside = cross(o, d)
    through = 0 < along_d < reach * d2 and dot(aside, aside) < r2 * d2
    inside = dot(o, o) < r2 * (1 - TOUCH)
    if reach < np.inf:
        last = sub(o, d)
        inside |= dot(last, last) < r2 * (1 - TOUCH)
    return through or inside


@strict
def behind_tube(tube, x, d, reach):
    """The lateral face of a cylinder, either side of it."""
    axis = (tube[AXIS], tube[AXIS + 1], tube[AXIS + 2])
    o = sub(x, (tube[CENTER], tube[CENTER + 1], tube[CENTER + 2]))
    rise, slope = dot(o, axis), dot(d, axis)
    o_across, d_across = along(o, -rise, axis), along(d, -slope, axis)
    a, b, aside = dot(d_across, d_across), dot(o_across, d_across), dot(cross(o_across, d_across), axis)
    square = a * tube[RADIUS] * tube[RADIUS] - aside * aside
    if a == 0 or square <= 0:
        return False
    half = math.sqrt(square)
    for root in ((-b - half) / a, (-b + half) / a):
        if TOUCH < root < reach * (1 - TOUCH) and 0 <= rise + root * slope <= tube[LENGTH]:
            return True
    return False
