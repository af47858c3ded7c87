"""What a receiver sees along a meridian: half a great circle of directions from its normal (angle 0) round to behind it (pi).

Everything is given in the receiver's frame, the receiver at the origin and its normal the third axis. The outlines of what there
is cut a meridian into arcs; along each the same thing is in front, and the light that comes from it has a closed form.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from lightproof.estimators.compiled import strict
from lightproof.estimators.hard_lights import in_loop
from lightproof.estimators.rows import point
from lightproof.estimators.tracing import vector
from lightproof.estimators.vectors import along, cross, dot, norm, scaled, sub
from lightproof.estimators.world import OVERCAST, SUN, UNIFORM

THIN = 3e-15  # an arc that is not worth adding [rad]
NARROW = 1e-10  # an arc that may be one of rounding, as between shapes that share an edge [rad]
NOTHING, DARK = -1, -2  # what a ray sees where there is nothing, or the inside of a ball


class Scenery(NamedTuple):
    """What surrounds a receiver, in its frame: `corners` (m, 3) of polygons that begin at `starts` (k + 1); rows of their
    `planes` (k, 4): normal, distance along it (0: seen edge-on); of `disks` (d, 8): centre, normal, radius, distance along the
    normal; of `balls` (b, 4): centre, radius; and of `tubes` (t, 8): base, axis, radius, length. Their fronts shine with `glow`
    (k + d + b + t), in that order. `rings` (d + 2 t, 9) are centres and two radii of circles, `sides` (2 t, 6) the ends of the
    lines where a tube's wall turns away. Rows of `skies` (s, 6): kind, radiance, unit vector up or to the sun, sine of its
    half-angle. `up` to this angle light is received; `cosine`: whether it counts with the cosine, or for its solid angle."""

    corners: np.ndarray
    starts: np.ndarray
    planes: np.ndarray
    disks: np.ndarray
    balls: np.ndarray
    tubes: np.ndarray
    glow: np.ndarray
    rings: np.ndarray
    sides: np.ndarray
    skies: np.ndarray
    up: float
    cosine: bool


@strict
def meridian(scenery, azimuth, cuts):
    """Light received along the meridian per angle of azimuth, and a number that tells what shines, between what else, in what
    order; `cuts` is room for angles."""
    c, s = math.cos(azimuth), math.sin(azimuth)
    count = divided(scenery, c, s, cuts)
    total, key, last, was_lit = 0.0, 0, DARK, False
    for i in range(count - 1):
        if cuts[i + 1] - cuts[i] > THIN:
            middle = (cuts[i] + cuts[i + 1]) / 2
            w = (c * math.sin(middle), s * math.sin(middle), math.cos(middle))
            seen, front = nearest(scenery, w)
            value = 0.0
            if seen == NOTHING:
                value, seen = sky(scenery, w, c, s, cuts[i], cuts[i + 1])
            elif front and scenery.glow[seen] > 0:
                value = scenery.glow[seen] * weight(cuts[i], cuts[i + 1], scenery.cosine)
            total += value
            if cuts[i + 1] - cuts[i] > NARROW:
                lit = value > 0
                if seen != last and (lit or was_lit):
                    key = key * 31 + 2 * seen + lit
                last, was_lit = seen, lit
    return total, key


@strict
def weight(a, b, cosine):
    """The integral over a meridian's arc of sin(angle), times its cosine where that counts."""
    return math.sin(a + b) * math.sin(b - a) / 2 if cosine else 2 * math.sin((a + b) / 2) * math.sin((b - a) / 2)


@strict
def divided(scenery, c, s, cuts):
    """The angles at which the meridian crosses an outline, in order, its ends included, into `cuts`; returns how many."""
    cuts[0], count = 0.0, 1
    for k in range(len(scenery.starts) - 1):
        begin, end = scenery.starts[k], scenery.starts[k + 1]
        a = point(scenery.corners, end - 1)
        for i in range(begin, end):
            b = point(scenery.corners, i)
            count = cut_by_edge(a, b, c, s, cuts, count)
            a = b
    for i in range(len(scenery.sides)):
        count = cut_by_edge(vector(scenery.sides[i], 0), vector(scenery.sides[i], 3), c, s, cuts, count)
    for i in range(len(scenery.rings)):
        count = cut_by_ring(scenery.rings[i], c, s, cuts, count)
    for ball in scenery.balls:
        count = cut_by_ball(vector(ball, 0), ball[3], c, s, cuts, count)
    for lit in scenery.skies:
        count = cut_by_sky(lit, c, s, cuts, count)
    while count > 1 and cuts[count - 1] >= scenery.up:
        count -= 1
    cuts[count] = scenery.up
    return count + 1


@strict
def insert(values, count, value):
    """Puts a value where it belongs among the first `count`, which are in order; returns the new count."""
    at = count
    while at > 0 and values[at - 1] > value:
        values[at] = values[at - 1]
        at -= 1
    values[at] = value
    return count + 1


@strict
def cut_by_edge(a, b, c, s, cuts, count):
    off_a, off_b = c * a[1] - s * a[0], c * b[1] - s * b[0]
    if (off_a > 0) == (off_b > 0):
        return count
    return cut_at(along(a, off_a / (off_a - off_b), sub(b, a)), c, s, cuts, count)


@strict
def cut_at(p, c, s, cuts, count):
    """Adds the angle of a point in the meridian's plane, if it is on its side."""
    out = c * p[0] + s * p[1]
    return insert(cuts, count, math.atan2(out, p[2])) if out >= 0 else count


@strict
def cut_by_ring(ring, c, s, cuts, count):
    center, u, v = vector(ring, 0), vector(ring, 3), vector(ring, 6)
    a, b, off = c * u[1] - s * u[0], c * v[1] - s * v[0], c * center[1] - s * center[0]
    r = math.hypot(a, b)
    if abs(off) >= r:
        return count
    half = math.sqrt((r - off) * (r + off))
    for sign in (-1.0, 1.0):
        p = along(center, (-off * a - sign * half * b) / (r * r), u)
        count = cut_at(along(p, (-off * b + sign * half * a) / (r * r), v), c, s, cuts, count)
    return count


@strict
def cut_by_ball(center, radius, c, s, cuts, count):
    off = c * center[1] - s * center[0]
    if abs(off) >= radius:
        return count
    out = c * center[0] + s * center[1]
    d = norm(center)
    middle = math.atan2(out, center[2])
    half = math.atan2(math.sqrt((radius - off) * (radius + off)), math.sqrt(max((d - radius) * (d + radius), 0.0)))
    for angle in (middle - half, middle + half, middle + half - 2 * math.pi, middle - half + 2 * math.pi):
        if 0 < angle < math.pi:
            count = insert(cuts, count, angle)
    return count


@strict
def cut_by_sky(lit, c, s, cuts, count):
    """The horizon of a sky, or the rim of a sun."""
    if lit[0] == SUN:
        return cut_by_ball(vector(lit, 2), lit[5], c, s, cuts, count)
    out = c * lit[2] + s * lit[3]
    if lit[0] == UNIFORM or out == 0:
        return count
    return insert(cuts, count, math.atan2(abs(lit[4]), -math.copysign(1.0, lit[4]) * out))


@strict
def nearest(scenery, w):
    """The number of the first thing that a ray along w meets, and whether on its front."""
    found, front, closest, at = NOTHING, False, np.inf, 0
    for k in range(len(scenery.planes)):
        normal = vector(scenery.planes[k], 0)
        t = along_ray(scenery.planes[k, 3], dot(normal, w))
        if 0 < t < closest and in_loop(scenery.corners, scenery.starts[k], scenery.starts[k + 1], (0.0, 0.0, 0.0), w):
            found, front, closest = k, dot(normal, w) < 0, t
    at += len(scenery.planes)
    for i in range(len(scenery.disks)):
        normal, center = vector(scenery.disks[i], 3), vector(scenery.disks[i], 0)
        t = along_ray(scenery.disks[i, 7], dot(normal, w))
        miss = sub(scaled(t, w), center)
        if 0 < t < closest and dot(miss, miss) < scenery.disks[i, 6] ** 2:
            found, front, closest = at + i, dot(normal, w) < 0, t
    at += len(scenery.disks)
    for i in range(len(scenery.balls)):
        t = to_ball(vector(scenery.balls[i], 0), scenery.balls[i, 3], w)
        if t < closest:
            found, front, closest = at + i, True, t
    at += len(scenery.balls)
    for i in range(len(scenery.tubes)):
        t, outside = to_tube(scenery.tubes[i], w)
        if t < closest:
            found, front, closest = at + i, outside, t
    return found, front


@strict
def along_ray(distance, slope):
    return distance / slope if distance != 0 and slope != 0 else 0.0


@strict
def to_ball(center, radius, w):
    """Distance along a ray; inf where it misses."""
    forth, aside = dot(center, w), cross(center, w)
    rest = radius * radius - dot(aside, aside)
    return max(forth - math.sqrt(rest), 0.0) if forth > 0 and rest > 0 else np.inf


@strict
def to_tube(tube, w):
    """Distance along a ray to a tube's wall, inf where it misses, and whether that is the outside."""
    base, axis = vector(tube, 0), vector(tube, 3)
    rise, slope = dot(base, axis), dot(w, axis)
    o, d = along(base, -rise, axis), along(w, -slope, axis)
    a, b, aside = dot(d, d), dot(o, d), dot(cross(o, d), axis)
    square = a * tube[6] * tube[6] - aside * aside
    if a == 0 or square <= 0:
        return np.inf, False
    for sign in (-1.0, 1.0):
        t = (b + sign * math.sqrt(square)) / a
        if t > 0 and 0 <= t * slope - rise <= tube[7]:
            return t, sign < 0
    return np.inf, False


@strict
def sky(scenery, w, c, s, a, b):
    """Light of the skies along an arc around the direction w, and which of them shine there, as a number below NOTHING."""
    total, which = 0.0, 1
    for lit in scenery.skies:
        above = dot(w, vector(lit, 2))
        lost = norm(cross(w, vector(lit, 2))) > lit[5] if lit[0] == SUN else False
        shines = lit[0] == UNIFORM or (above > 0 and not lost)
        which = 2 * which + shines
        if shines:
            total += lit[1] * (overcast(lit, c, s, a, b) if lit[0] == OVERCAST else weight(a, b, scenery.cosine))
    return total if scenery.cosine else min(total, weight(a, b, False)), DARK - which


@strict
def overcast(lit, c, s, a, b):
    """(1 + 2 sin(elevation))/3 over an arc: the cubes are the integrals of cos^2 sin and of sin^2 cos."""
    level = lit[4] * (math.cos(a) ** 3 - math.cos(b) ** 3) / 3
    out = (c * lit[2] + s * lit[3]) * (math.sin(b) ** 3 - math.sin(a) ** 3) / 3
    return (weight(a, b, True) + 2 * (level + out)) / 3
