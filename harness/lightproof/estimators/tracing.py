"""Rays through a `World`: the nearest hit, whether a segment is free, what a ray sees, where a film element receives."""

from __future__ import annotations

import math

import numpy as np

from lightproof.estimators.compiled import strict
from lightproof.estimators.vectors import along, dot, scaled, sub, unit
from lightproof.estimators.world import (
    CAP,
    CENTER,
    COSINE,
    DISK,
    DUAL_U,
    DUAL_V,
    KIND,
    NORMAL,
    OVERCAST,
    PARALLELOGRAM,
    PERSPECTIVE,
    RADIANCE,
    RADIUS,
    RECEIVER,
    REFLECTANCE,
    SIDE,
    SPHERE,
    SUN,
    UNIFORM,
)


@strict
def vector(row, at):
    return row[at], row[at + 1], row[at + 2]


@strict
def distance(item, x, w, near):
    """Distance [in lengths of w] to where a ray meets the item beyond `near`; inf where it does not."""
    if item[KIND] == SPHERE:
        return sphere_distance(item, x, w, near)
    if item[KIND] == CAP:
        return cap_distance(item, x, w, near)
    normal, o = vector(item, NORMAL), sub(vector(item, CENTER), x)
    slope = dot(w, normal)
    if slope == 0:
        return np.inf
    t = dot(o, normal) / slope
    p = sub(scaled(t, w), o)
    inside = in_parameters(item[KIND], dot(p, vector(item, DUAL_U)), dot(p, vector(item, DUAL_V)))
    return t if t > near and inside else np.inf


@strict
def in_parameters(kind, s, t):
    """Whether s, t are parameters of a point of the flat shape."""
    if kind == PARALLELOGRAM:
        return abs(s) <= 0.5 and abs(t) <= 0.5
    if kind == DISK:
        return s * s + t * t <= 1
    return s >= 0 and t >= 0 and s + t <= 1


@strict
def sphere_crossings(item, x, w):
    """Where a ray's line enters the sphere and where it leaves it; inf, inf where it does neither."""
    o = sub(vector(item, CENTER), x)
    w2, b = dot(w, w), dot(o, w)
    foot = sub(o, scaled(b / w2, w))
    rest = item[RADIUS] * item[RADIUS] - dot(foot, foot)
    if rest < 0:
        return np.inf, np.inf
    half = math.sqrt(rest / w2)
    return b / w2 - half, b / w2 + half


@strict
def sphere_distance(item, x, w, near):
    enter, leave = sphere_crossings(item, x, w)
    return enter if enter > near else leave if leave > near else np.inf


@strict
def cap_distance(item, x, w, near):
    enter, leave = sphere_crossings(item, x, w)
    if enter > near and on_cap(item, along(x, enter, w)):
        return enter
    return leave if leave > near and on_cap(item, along(x, leave, w)) else np.inf


@strict
def on_cap(item, p):
    """Whether a point of the sphere belongs to the cap."""
    return dot(sub(p, vector(item, CENTER)), vector(item, NORMAL)) >= item[RADIUS] * item[COSINE]


@strict
def nearest(items, x, w, near):
    """Index of the first item along a ray beyond `near` (-1: none), and the distance to it."""
    found, closest = -1, np.inf
    for i in range(len(items)):
        t = distance(items[i], x, w, near)
        if t < closest:
            found, closest = i, t
    return found, closest


@strict
def free(items, x, d, contact):
    """Whether nothing stands on the segment from x to x + d, its ends excepted."""
    margin = contact / math.sqrt(dot(d, d))
    blocked = False
    for i in range(len(items)):
        blocked |= distance(items[i], x, d, margin) < 1 - margin
    return not blocked


@strict
def front_normal(item, x):
    """Unit normal of the item's front at its point x."""
    if item[KIND] == SPHERE or item[KIND] == CAP:
        return scaled(item[SIDE] / item[RADIUS], sub(x, vector(item, CENTER)))
    return vector(item, NORMAL)


@strict
def sky_radiance(skies, w):
    """Radiance that the skies send from direction `w`, a unit vector away from the receiver."""
    total = 0.0
    for k in range(len(skies)):
        sky = skies[k]
        if sky[0] == UNIFORM or (sky[0] == SUN and -dot(w, vector(sky, 2)) >= sky[5]):
            total += sky[1]
        elif sky[0] != SUN and w[2] > 0:
            total += sky[1] * (1 + 2 * w[2]) / 3 if sky[0] == OVERCAST else sky[1]
    return total


@strict
def seen(items, skies, x, w, contact):
    """Radiance emitted towards x by the first thing in direction `w`: a front, the black back of something, or the sky."""
    i, t = nearest(items, x, w, contact)
    if i < 0:
        return sky_radiance(skies, w)
    return items[i, RADIANCE] if dot(front_normal(items[i], along(x, t, w)), w) < 0 else 0.0


@strict
def receive(items, skies, film, element, p, q, contact):
    """Where point (p, q) of an element receives: radiance that it sees directly, factor from irradiance to the film's
    quantity (1, or reflectance/pi of the surface seen; 0: nothing to add), point, normal."""
    origin, direction = vector(element, 0), vector(element, 9)
    u, v = vector(element, 3), vector(element, 6)
    if film == RECEIVER:
        return 0.0, 1.0, along(along(origin, p, u), q, v), direction
    if film == PERSPECTIVE:
        w = unit(along(along(direction, p, u), q, v))
    else:
        origin, w = along(along(origin, p, u), q, v), direction
    i, t = nearest(items, origin, w, 0.0)
    if i < 0:
        return sky_radiance(skies, w), 0.0, origin, direction
    x = along(origin, t, w)
    n = front_normal(items[i], x)
    if dot(n, w) >= 0:
        return 0.0, 0.0, x, n
    return items[i, RADIANCE], items[i, REFLECTANCE] / math.pi, x, n
