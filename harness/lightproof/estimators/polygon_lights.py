"""A polygon light behind any number of polygons: exact at a point, but for rounding.

Everything is taken in the frame of the light's plane, with the receiver subtracted first. What stands between is clipped to
what lies between the receiver's plane and the light's, and its shadow on the light cut away piece by piece (Arvo 1994).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators import contacts, lambert
from lightproof.estimators.clipping import area, clip, clip_by_line, copy_all, misses
from lightproof.estimators.compiled import strict
from lightproof.estimators.lambert import LEVEL, A, B, S, T
from lightproof.estimators.levels import ZERO, level
from lightproof.estimators.rows import point
from lightproof.estimators.sources import desk, irradiance
from lightproof.estimators.vectors import along, cross, dot, norm, scaled, sub, turned

TOUCH = 1e-13  # of the coordinates: what lies no farther from a plane coincides with it
MUCH = 0.1  # distances over heights below which a step places a corner better than its edge's ends do
BORDER = 0
FLUSH = 1e-31  # 1 - cosine of an angle between unit vectors that rounding leaves of none
STEP = 2.0**-20  # of an edge: from the border of a light, for the limit
SLACK = 1e-6  # of an angle
NOTHING = 1e-15  # of a light's area: what is left of it by rounding
U, V, W, ABOVE, BEFORE = range(5)  # columns of a blocker's corners: the light's frame, above the receiver, before the light


class PolygonLight(NamedTuple):
    """Convex `parts` (k + 1) of `corners` (m, 3), which lie at `flat` (m, 2) from the first along the first two axes of `frame`;
    the plane's normal is the third, plus `low`, and `reach` the largest coordinate. `blockers` (l, 3) come in convex `shadows`
    (j + 1) with normals `facings` (j, 3) and largest coordinates `reaches` (j,). What lies within `touch` [m] of a plane
    coincides with it. `room` is that for corners."""

    radiance: float
    corners: np.ndarray
    flat: np.ndarray
    parts: np.ndarray
    frame: tuple
    low: tuple
    reach: float
    blockers: np.ndarray
    shadows: np.ndarray
    facings: np.ndarray
    reaches: np.ndarray
    touch: float
    room: int


class Desk(NamedTuple):
    """Room for a light's part, its cells, a blocker, planes; the `lines` that bound the shadows, `sides` of them each; and a pile
    of pieces with `counts` of corners and how many shadows were `tried`."""

    light: np.ndarray
    cells: np.ndarray
    blocker: np.ndarray
    planes: np.ndarray
    values: np.ndarray
    lines: np.ndarray
    sides: np.ndarray
    pile: np.ndarray
    counts: np.ndarray
    tried: np.ndarray


@overload(desk)
def _desk(source):
    return opened if getattr(source, "instance_class", None) is PolygonLight else None


def opened(source):
    shadows, room = len(source.shadows) - 1, source.room
    height = len(source.blockers) + 2 * shadows + 2
    return Desk(
        np.empty((2, room, 5)),
        np.empty((lambert.DEPTH, 3, 4)),
        np.empty((3, room, 5)),
        np.empty((room, 3)),
        np.empty(room),
        np.empty((shadows, room, 3)),
        np.zeros(shadows, np.int64),
        np.empty((height, room, 5)),
        np.zeros(height, np.int64),
        np.zeros(height, np.int64),
    )


@overload(irradiance)
def _irradiance(source, desk, x, n):
    return from_polygon if getattr(source, "instance_class", None) is PolygonLight else None


def from_polygon(source, desk, x, n):
    h = -level(source.frame[2], source.low, point(source.corners, 0), x)
    unit = scaled(1 / norm(n), n)
    if abs(h) <= contacts.slack(source.reach, x) and place(source, x) >= BORDER:
        h = 0.0
    if h > 0:
        return source.radiance * in_front(source, desk, x, n, unit, h)
    rise = dot(unit, source.frame[2])
    if h < 0 or rise <= 0:
        return 0.0
    return source.radiance * in_plane(source, desk, x, n, unit, rise)


@strict
def in_front(source, desk, x, n, unit, h):
    """Irradiance per radiance h in front of the light's plane; `unit` is n over its length."""
    facing = turned(unit, source.frame, 1.0)
    shadows = cast(source, desk, x, unit, h)
    total = 0.0
    for part in range(len(source.parts) - 1):
        count = seen(source, desk, part, x, n)
        if count:
            settle(desk.light[1], count, h, facing)
            total += past(desk, count, shadows, h, facing)
    return total


@strict
def in_plane(source, desk, x, n, unit, rise):
    """Irradiance per radiance in the light's plane, in the limit from where n points, `rise` being its share along the light's
    normal: on the light it fills half the sphere; on its border the limit is taken by steps; beside it, nothing is seen."""
    inside = place(source, x)
    if inside != BORDER:
        tilt = sub(unit, source.frame[2])
        share = dot(tilt, tilt) / 2 if inside > 0 else 0.0
        return math.pi / 2 * share if share > FLUSH else 0.0
    step = STEP * norm(sub(point(source.corners, 0), point(source.corners, 1)))
    near = in_front(source, desk, along(x, step, unit), n, unit, step * rise)
    return 2 * near - in_front(source, desk, along(x, 2 * step, unit), n, unit, 2 * step * rise)


@strict
def place(source, x):
    """Where in the light's plane x lies: 1 on the light, -1 beside it, BORDER."""
    around, border = 0.0, False
    for part in range(len(source.parts) - 1):
        begin, end = source.parts[part], source.parts[part + 1]
        for i in range(begin, end):
            a, b = sub(point(source.corners, i), x), sub(point(source.corners, i + 1 if i + 1 < end else begin), x)
            sine, cosine = dot(cross(a, b), source.frame[2]), dot(a, b)
            between = abs(sine) <= source.touch * norm(sub(b, a)) and cosine <= 0
            around += 0.0 if between else math.atan2(sine, cosine)
            border |= between
    if around > 2 * math.pi - SLACK:
        return 1
    return BORDER if border else -1


@strict
def seen(source, desk, part, x, n):
    """The corners of a part of the light above the horizon, into desk.light[1]; returns their count."""
    begin, end, rows, length = source.parts[part], source.parts[part + 1], desk.light[0], norm(n)
    for i in range(begin, end):
        corner, row = point(source.corners, i), rows[i - begin]
        d = sub(corner, x)
        row[S], row[T] = source.flat[i, 0], source.flat[i, 1]
        row[A], row[B] = dot(d, source.frame[0]), dot(d, source.frame[1])
        row[LEVEL] = level(n, ZERO, corner, x) / length
    return clip(rows, rows[:, LEVEL], end - begin, LEVEL, desk.light[1])


@strict
def settle(rows, count, h, facing):
    """Puts corners that the horizon has cut off an edge much longer than their distance where they belong, by a step along it:
    between ends so far away they were placed badly."""
    for i in range(count):
        if rows[i, LEVEL] == 0:
            j, k = i + 1 if i + 1 < count else 0, i - 1 if i > 0 else count - 1
            end = j if rows[j, LEVEL] > rows[k, LEVEL] else k
            distance = math.sqrt(rows[i, A] * rows[i, A] + rows[i, B] * rows[i, B] + h * h)
            if distance < MUCH * rows[end, LEVEL]:
                off = (rows[i, A] * facing[0] + rows[i, B] * facing[1] - h * facing[2]) / rows[end, LEVEL]
                for axis in (S, T, A, B):
                    rows[i, axis] -= off * (rows[end, axis] - rows[i, axis])


@strict
def cast(source, desk, x, n, h):
    """The lines on the light's plane that bound the shadow of each blocker, seen from x; returns how many blockers cast one."""
    found = 0
    for k in range(len(source.shadows) - 1):
        desk.sides[found] = shadow(source, desk, k, x, n, h, desk.lines[found])
        found += desk.sides[found] > 0
    return found


@strict
def shadow(source, desk, k, x, n, h, lines):
    """The lines that bound the shadow of blocker k, positive inside; returns how many (0: it casts none)."""
    begin, end = source.shadows[k], source.shadows[k + 1]
    least = contacts.slack(source.reaches[k], x)
    count = contacts.sides(source.blockers, begin, end, point(source.facings, k), x, n, least, desk.planes)
    if count == contacts.APART:
        return outline(desk.blocker[2], between(source, desk, k, x, n, h), h, lines)
    for i in range(count):
        put_line(turned(point(desk.planes, i), source.frame, 1.0), h, lines[i])
    return count


@strict
def put_line(plane, h, line):
    """Where a plane through the receiver with this normal meets the light's plane, h below, positive where the normal points."""
    line[0], line[1], line[2] = -plane[2] * h, plane[0], plane[1]


@strict
def between(source, desk, k, x, n, h):
    """The corners of blocker k between the receiver's plane and the light's, into desk.blocker[2]; returns their count."""
    begin, end = source.shadows[k], source.shadows[k + 1]
    rows, above = desk.blocker[0], desk.blocker[1]
    highest, foremost = 0.0, 0.0
    for i in range(begin, end):
        d, row = sub(point(source.blockers, i), x), rows[i - begin]
        row[U], row[V], row[W] = turned(d, source.frame, 1.0)
        row[ABOVE], row[BEFORE] = dot(d, n), row[W] + h
        highest, foremost = max(highest, row[ABOVE]), max(foremost, row[BEFORE])
    if highest <= source.touch or foremost <= source.touch:
        return 0
    count = clip(rows, rows[:, ABOVE], end - begin, ABOVE, above)
    return clip(above, above[:, BEFORE], count, BEFORE, desk.blocker[2])


@strict
def outline(rows, count, h, lines):
    """Where the planes through the receiver and the edges of a blocker meet the light's plane, positive inside; returns how many
    (0: there is no blocker, or it is seen edge-on)."""
    turn = 0.0
    for i in range(1, count - 1):
        turn += dot(point(rows, 0), cross(point(rows, i), point(rows, i + 1)))
    if turn == 0:
        return 0
    for i in range(count):
        plane = cross(point(rows, i), point(rows, i + 1 if i + 1 < count else 0))
        put_line(scaled(1.0 if turn > 0 else -1.0, plane), h, lines[i])
    return count


@strict
def past(desk, count, shadows, h, facing):
    """Irradiance per radiance from what desk.light[1] shows past the shadows."""
    if shadows == 0:
        return lambert.irradiance(desk.light[1], count, h, facing, desk.cells)
    pile, counts, tried = desk.pile, desk.counts, desk.tried
    copy_all(desk.light[1], count, pile[0])
    counts[0], tried[0] = count, 0
    least = NOTHING * area(desk.light[1], count)
    total, height = 0.0, 1
    while height > 0:
        top = height - 1
        if tried[top] < shadows:
            height = cut(desk, top)
            continue
        height = top
        if area(pile[top], counts[top]) > least:
            total += lambert.irradiance(pile[top], counts[top], h, facing, desk.cells)
    return total


@strict
def cut(desk, top):
    """Replaces the piece on top of the pile by its convex parts outside the next shadow; the new height of the pile."""
    pile, counts, tried = desk.pile, desk.counts, desk.tried
    shadow = tried[top]
    lines, sides = desk.lines[shadow], desk.sides[shadow]
    tried[top] += 1
    if misses(pile[top], counts[top], lines, sides):
        return top + 1
    rest, spare = desk.light[0], desk.light[1]
    count, height = counts[top], top
    copy_all(pile[top], count, rest)
    for i in range(sides):
        counts[height], tried[height] = clip_by_line(rest, count, lines[i], -1.0, desk.values, pile[height]), shadow + 1
        height += counts[height] > 0
        count = clip_by_line(rest, count, lines[i], 1.0, desk.values, spare)
        rest, spare = spare, rest
        if count == 0:
            break
    return height
