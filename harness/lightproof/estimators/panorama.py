"""Anything behind anything: light from shapes and skies of all kinds, integrated over all `meridians` of a receiver.

Between two breaks (azimuths at which a meridian meets a corner, touches an outline, or meets two outlines at once) the light
along a meridian is an analytic function of its azimuth, but for square roots at the ends. The breaks of the first two kinds have
closed forms; the others show by a change in what is seen, and are found by bisection.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.compiled import strict
from lightproof.estimators.hard_lights import Solids
from lightproof.estimators.meridians import Scenery, insert, meridian
from lightproof.estimators.sources import desk, irradiance
from lightproof.estimators.surroundings import settle
from lightproof.estimators.vectors import unit
from lightproof.estimators.world import SUN, UNIFORM

SHORT = 1e-14  # a stretch of azimuth that is not worth a rule [rad]
DEPTH = 100  # parts of a stretch that wait
MOST = 200  # of them that are tried
HALVINGS = 48  # of a bisection
FINE, COARSE, CHANGE = range(3)  # what a rule returns
KRONROD = np.array(
    [
        [0.991455371120812639206854697526329, 0.022935322010529224963732008058970, 0.0],
        [0.949107912342758524526189684047851, 0.063092092629978553290700663189204, 0.129484966168869693270611432679082],
        [0.864864423359769072789712788640926, 0.104790010322250183839876322541518, 0.0],
        [0.741531185599394439863864773280788, 0.140653259715525918745189590510238, 0.279705391489276667901467771423780],
        [0.586087235467691130294144691693013, 0.169004726639267902826583426598550, 0.0],
        [0.405845151377397166906606412076961, 0.190350578064785409913256402421014, 0.381830050505118944950369775488975],
        [0.207784955007898467600689403773245, 0.204432940075298892414161999234649, 0.0],
        [0.0, 0.209482141084727828012999174891714, 0.417959183673469387755102040816327],
    ]
)  # nodes of a pair of rules (Kronrod 1965), weights of the better one with 15 nodes and of Gauss's with 7
RULE = np.concatenate([KRONROD * [-1, 1, 1], KRONROD[-2::-1]])
NODES, WEIGHTS, FEWER = (1 + RULE[:, 0]) / 2, RULE[:, 1] / 2, RULE[:, 2] / 2


class Panorama(NamedTuple):
    """`solids` whose fronts shine with `glow`, and `skies` (s, 6), see `Scenery`; light counts with its `cosine` or not, from the
    receiver's side only or from the `whole` sphere of directions. The two rules may differ by `enough` of the light; the better
    one is then right to about the square of that."""

    solids: Solids
    glow: np.ndarray
    skies: np.ndarray
    cosine: bool
    whole: bool
    enough: float

    ROUND = True


class Desk(NamedTuple):
    """The receiver's `scenery`, and room: angles of `cuts` and `breaks`, what the `first` rule gave between those, parts of a
    stretch that are `waiting`, and the `keys` of a rule's nodes."""

    scenery: Scenery
    cuts: np.ndarray
    breaks: np.ndarray
    first: np.ndarray
    waiting: np.ndarray
    keys: np.ndarray


@overload(desk)
def _desk(source):
    return opened if getattr(source, "instance_class", None) is Panorama else None


def opened(source):
    solids = source.solids
    corners, tubes = len(solids.corners), len(solids.tubes)
    rings, balls = len(solids.disks) + 2 * tubes, len(solids.balls) + len(source.skies)
    scenery = Scenery(
        np.empty((corners, 3)),
        solids.starts,
        np.empty((len(solids.starts) - 1, 4)),
        np.empty((len(solids.disks), 8)),
        np.empty((len(solids.balls), 4)),
        np.empty((tubes, 8)),
        source.glow,
        np.empty((rings, 9)),
        np.empty((2 * tubes, 6)),
        source.skies.copy(),
        math.pi if source.whole else math.pi / 2,
        source.cosine,
    )
    room = corners + 4 * (rings + balls) + 4 * tubes + 8
    cuts, breaks, first = np.empty(room), np.empty(room), np.empty((room, 3))
    return Desk(scenery, cuts, breaks, first, np.empty((DEPTH, 2)), np.empty(len(NODES), np.int64))


@overload(irradiance)
def _irradiance(source, desk, x, n):
    return from_panorama if getattr(source, "instance_class", None) is Panorama else None


def from_panorama(source, desk, x, n):
    if not settle(source, desk.scenery, x, unit(n)):
        return 0.0
    breaks, first = desk.breaks, desk.first
    count = broken(desk.scenery, breaks)
    total = 0.0
    for k in range(count - 1):
        first[k, FINE], first[k, COARSE], first[k, CHANGE] = rule(desk, breaks[k], breaks[k + 1], 0.0, 1.0)
        total += first[k, FINE]
    tolerance = source.enough * total
    for k in range(count - 1):
        rough = first[k, CHANGE] >= 0 or abs(first[k, FINE] - first[k, COARSE]) > tolerance
        if rough and breaks[k + 1] - breaks[k] > SHORT:
            total += stretch(desk, breaks[k], breaks[k + 1], tolerance) - first[k, FINE]
    return total


@strict
def broken(scenery, breaks):
    """The azimuths of corners, and of meridians that touch outlines, in order, -pi to pi, into `breaks`; returns how many."""
    breaks[0], breaks[1], count = -math.pi, math.pi, 2
    for i in range(len(scenery.corners)):
        count = towards(scenery.corners[i, 0], scenery.corners[i, 1], breaks, count)
    for i in range(len(scenery.sides)):
        for j in (0, 3):
            count = towards(scenery.sides[i, j], scenery.sides[i, j + 1], breaks, count)
    for ring in scenery.rings:
        xx = ring[0] * ring[0] - ring[3] * ring[3] - ring[6] * ring[6]
        xy = ring[0] * ring[1] - ring[3] * ring[4] - ring[6] * ring[7]
        yy = ring[1] * ring[1] - ring[4] * ring[4] - ring[7] * ring[7]
        count = touches(xx, xy, yy, breaks, count)
    for ball in scenery.balls:
        count = touches_ball(ball[0], ball[1], ball[3], breaks, count)
    for lit in scenery.skies:
        if lit[0] == SUN:
            count = touches_ball(lit[2], lit[3], lit[5], breaks, count)
        elif lit[0] != UNIFORM:
            count = towards(-lit[3], lit[2], breaks, count)
            count = towards(lit[3], -lit[2], breaks, count)
    return count


@strict
def towards(x, y, breaks, count):
    return insert(breaks, count, math.atan2(y, x))


@strict
def touches_ball(x, y, radius, breaks, count):
    return touches(x * x - radius * radius, x * y, y * y - radius * radius, breaks, count)


@strict
def touches(xx, xy, yy, breaks, count):
    """Adds the azimuths of meridians whose plane has a normal h = (-sin, cos) with xx h1^2 + 2 xy h1 h2 + yy h2^2 = 0."""
    square = xy * xy - xx * yy
    if square < 0:
        return count
    root = math.copysign(math.sqrt(square), xy)
    for x, y in ((xx, xy + root), (xy + root, yy)):
        count = towards(x, y, breaks, count)
        count = towards(-x, -y, breaks, count)
    return count


@strict
def stretch(desk, begin, end, tolerance):
    """Light from the meridians between two breaks, halved until the two rules differ by no more than `tolerance`."""
    waiting, total, height, tried = desk.waiting, 0.0, 1, 0
    waiting[0, 0], waiting[0, 1] = 0.0, 1.0
    while height > 0:
        height -= 1
        tried += 1
        low, high = waiting[height, 0], waiting[height, 1]
        fine, coarse, change = rule(desk, begin, end, low, high)
        last = high - low < SHORT or tried > MOST or height + 2 > len(waiting)
        if last or (change < 0 and abs(fine - coarse) <= tolerance):
            total += fine
            continue
        middle = parting(desk, begin, end, low, high, change) if change >= 0 else (low + high) / 2
        waiting[height, 0], waiting[height, 1] = low, middle
        waiting[height + 1, 0], waiting[height + 1, 1] = middle, high
        height += 2
    return total


@strict
def azimuth(begin, end, t):
    """Runs from begin to end as t does from 0 to 1, slowly near the ends, so that a square root there does no harm."""
    return begin + t * t * (3 - 2 * t) * (end - begin)


@strict
def rule(desk, begin, end, low, high):
    """The better and the lesser rule over a stretch, and the first node after which something else is seen; -1 where there is
    none."""
    fine, coarse, change = 0.0, 0.0, -1
    for i in range(len(NODES)):
        t = low + NODES[i] * (high - low)
        value, key = meridian(desk.scenery, azimuth(begin, end, t), desk.cuts)
        value *= 6 * t * (1 - t) * (end - begin) * (high - low)
        fine += WEIGHTS[i] * value
        coarse += FEWER[i] * value
        if i > 0 and change < 0 and key != desk.keys[i - 1]:
            change = i - 1
        desk.keys[i] = key
    return fine, coarse, change


@strict
def parting(desk, begin, end, low, high, change):
    """Where between two nodes of a rule what is seen changes."""
    a, b = low + NODES[change] * (high - low), low + NODES[change + 1] * (high - low)
    for _ in range(HALVINGS):
        middle = (a + b) / 2
        _, key = meridian(desk.scenery, azimuth(begin, end, middle), desk.cuts)
        if key == desk.keys[change]:
            a = middle
        else:
            b = middle
    return (a + b) / 2
