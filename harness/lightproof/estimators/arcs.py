"""Irradiance of flat regions bounded by arcs and chords: Stokes' contour integral (1/2) closed integral of n . (r x dr)/r^2.

Seen from the receiver at the origin, whose normal is n, the boundary runs clockwise around the visible front.
"""

from __future__ import annotations

import math

from lightproof.estimators import closed_forms, gauss
from lightproof.estimators.compiled import strict
from lightproof.estimators.vectors import along, cross, dot, norm, scaled, sub, tangents

ORDER = 16
NODES, WEIGHTS = gauss.rule(ORDER)
PIECES = 16  # of an arc, each with a Gauss rule


@strict
def arc(center, u, v, begin, end, n):
    """The contour's part along center + cos(a) u + sin(a) v, a from begin to end."""
    total = 0.0
    step = (end - begin) / PIECES
    for i in range(PIECES * ORDER):
        a = begin + (i // ORDER + NODES[i % ORDER]) * step
        c, s = math.cos(a), math.sin(a)
        r = along(along(center, c, u), s, v)
        tangent = along(scaled(-s, u), c, v)
        total += WEIGHTS[i % ORDER] * step * dot(cross(tangent, r), n) / dot(r, r)
    return total / 2


@strict
def chord(a, b, n):
    """The contour's part along the straight line from a to b."""
    g = cross(b, a)
    sine = norm(g)
    return math.atan2(sine, dot(a, b)) * dot(g, n) / sine / 2 if sine > 0 else 0.0


@strict
def disk(center, normal, radius, n):
    """Irradiance per radiance of a disk, cut by the horizon where it must."""
    level = dot(center, n)
    t, b = tangents(normal)
    slope = radius * math.hypot(dot(t, n), dot(b, n))
    if dot(center, normal) >= 0 or level <= -slope:
        return 0.0
    if level >= slope:
        return closed_forms.disk(center, normal, radius, n)
    top = math.atan2(dot(b, n), dot(t, n))
    half = math.acos(-level / slope)
    u, v = scaled(radius, t), scaled(radius, b)
    first = along(along(center, math.cos(top - half), u), math.sin(top - half), v)
    last = along(along(center, math.cos(top + half), u), math.sin(top + half), v)
    return arc(center, u, v, top - half, top + half, n) + chord(last, first, n)


@strict
def disk_behind_disk(center, normal, radius, blocker, blocker_radius, n):
    """Irradiance per radiance of a disk above the horizon behind a parallel disk nearer to the receiver at the origin."""
    grown = dot(center, normal) / dot(blocker, normal)
    shade, shade_radius = scaled(grown, blocker), blocker_radius * grown
    offset = sub(shade, center)
    a = norm(offset)
    whole = disk(center, normal, radius, n)
    if a >= radius + shade_radius:
        return whole
    if a <= shade_radius - radius:
        return 0.0
    if a <= radius - shade_radius:
        return whole - disk(shade, normal, shade_radius, n)
    e = scaled(1 / a, offset)
    f = cross(normal, e)
    outer = math.acos((a * a + radius * radius - shade_radius * shade_radius) / (2 * a * radius))
    inner = math.acos((a * a + shade_radius * shade_radius - radius * radius) / (2 * a * shade_radius))
    lit = arc(center, scaled(radius, e), scaled(radius, f), outer, 2 * math.pi - outer, n)
    return lit + arc(shade, scaled(shade_radius, e), scaled(shade_radius, f), math.pi + inner, math.pi - inner, n)
