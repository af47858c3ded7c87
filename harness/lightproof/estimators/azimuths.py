"""Directions to a flat polygon, uniform in its projected solid angle: what lies between its edges, azimuth by azimuth.

Peters 2021, "BRDF importance sampling for polygonal lights". Seen from the receiver an edge is a great arc; its projection onto
the receiver's plane is an ellipse about the origin, over an azimuth interval of area g_z/2 times the angle along the arc, g the
normal of the arc's plane (Lambert). Between the azimuths of two neighbouring corners a convex polygon is what lies within one
such ellipse (g_z > 0) and outside another (g_z < 0) or none, where the zenith is in it. The azimuth that cuts off a share of
that area is found by Newton's method between bounds, along the outer arc, where the outer area is linear. Float64 throughout.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from lightproof.estimators.compiled import inlined, strict
from lightproof.estimators.trigonometry import half_turn, series
from lightproof.estimators.vectors import TINY, along, cross, norm, scaled
from lightproof.geometry import Vec3

VERTICAL = 1e-14  # g_z of a plane that counts as vertical: its ellipse has no area
LEVEL = 1e-18  # sin^2 of the slope of an edge's plane that counts as the horizon
STEPS = 60  # bisections at most, where Newton's steps leave the bounds
CLOSE = 1e-8  # of an arc: the step of Newton's that is the last, for the error of the next is its square
NONE = (0.0, 0.0, 0.0)  # the plane of no arc
HORIZON = (0.0, 0.0, 1.0)


class Vertex(NamedTuple):
    """Where arcs meet: the point over the receiver's plane, the planes' normals of the arcs that leave it and that come to it,
    with the polygon on their front, and the point where the one that leaves ends."""

    at: tuple[float, float]
    leaves: Vec3
    comes: Vec3
    end: tuple[float, float]


class Span(NamedTuple):
    """What lies within the ellipse of one plane's normal and outside that of another, from one azimuth to another."""

    outer: Vec3
    inner: Vec3
    start: tuple[float, float]
    end: tuple[float, float]


class Sector(NamedTuple):
    """A span with its projected solid angle, and `gross`, what that owes to each radian of its angles: of this it has the
    rounding."""

    span: Span
    area: float
    gross: float


@inlined
def lifted(normal, u):
    """Height of the plane over the point u of the receiver's plane times |g_z|."""
    return -math.copysign(1.0, normal[2]) * (normal[0] * u[0] + normal[1] * u[1])


@strict
def swept(normal, a, b):
    """The angle along a plane's great circle from the azimuth of a to that of b, counter-clockwise and at most a half turn."""
    flat = a[0] * b[0] + a[1] * b[1]
    turned = max(a[0] * b[1] - a[1] * b[0], 0.0)
    height = abs(normal[2])
    return half_turn(height * turned, height * height * flat + lifted(normal, a) * lifted(normal, b))


@inlined
def sector(one):
    most = one.outer[2] * swept(one.outer, one.start, one.end) / 2
    least = -one.inner[2] * swept(one.inner, one.start, one.end) / 2
    return Sector(one, max(most - least, 0.0), (one.outer[2] - one.inner[2]) / 2)


@inlined
def vertex(p, q, leaves, comes, entry):
    """Where the edge from p to q starts to lie above the horizon; the arc that comes there is the horizon where p does not."""
    up = p[2] >= 0
    if not max(p[2], q[2]) >= 0:
        return Vertex(entry, NONE, NONE, entry)
    return Vertex(flat(p) if up else entry, leaves, comes if up else HORIZON, cut(p, q, leaves) if q[2] < 0 else flat(q))


@inlined
def flat(p):
    return p[0], p[1]


@inlined
def cut(p, q, g):
    """Under which azimuth the edge from p to q crosses the horizon, if it does; g is its plane's normal. Of an edge on the
    horizon, where that normal does not tell, somewhere on it."""
    if not g[0] * g[0] + g[1] * g[1] > LEVEL:
        return p[0] + q[0], p[1] + q[1]
    return (g[1], -g[0]) if p[2] >= 0 else (-g[1], g[0])


@inlined
def sinks(p, q):
    """Whether an edge from p to q goes below the horizon."""
    return p[2] >= 0 > q[2]


@strict
def vertices(a, b, c, d, planes):
    """The vertices, five at most, of what of a quadrilateral a b c d lies above the horizon; counter-clockwise around the zenith,
    as are the normals of the edges' planes, from ab to da, unit vectors or none for a point. Vertices that there are not have
    no arcs."""
    g, h, i, j = planes
    low, high = cut(a, b, g), cut(a, b, g)
    last = g
    low, last = (cut(b, c, h), h) if sinks(b, c) else (low, last)
    low, last = (cut(c, d, i), i) if sinks(c, d) else (low, last)
    low, last = (cut(d, a, j), j) if sinks(d, a) else (low, last)
    high = cut(b, c, h) if sinks(c, b) else high
    high = cut(c, d, i) if sinks(d, c) else high
    high = cut(d, a, j) if sinks(a, d) else high
    cuts = min(a[2], b[2], c[2], d[2]) < 0 <= max(a[2], b[2], c[2], d[2])
    return (
        vertex(a, b, g, j, high),
        vertex(b, c, h, g, high),
        vertex(c, d, i, h, high),
        vertex(d, a, j, i, high),
        Vertex(low, HORIZON, last, high) if cuts else Vertex(flat(a), NONE, NONE, flat(a)),
    )


@inlined
def sorted_pair(a, b):
    """Two vertices by azimuth."""
    return (b, a) if a.at[0] * b.at[1] < a.at[1] * b.at[0] else (a, b)


@inlined
def by_azimuth(a, b, c, d, e):
    """Five vertices by azimuth, within a half turn."""
    a, b = sorted_pair(a, b)
    d, e = sorted_pair(d, e)
    c, e = sorted_pair(c, e)
    c, d = sorted_pair(c, d)
    b, e = sorted_pair(b, e)
    a, d = sorted_pair(a, d)
    a, c = sorted_pair(a, c)
    b, d = sorted_pair(b, d)
    b, c = sorted_pair(b, c)
    return a, b, c, d, e


@inlined
def following(before, start, end):
    """The span from one vertex to the next, from the span before and what starts at the vertex between."""
    outer = start.leaves if start.leaves[2] > VERTICAL else before.outer
    inner = start.comes if start.comes[2] < -VERTICAL else before.inner
    return Span(outer, inner, start.at, end.at)


@inlined
def whole(one):
    """The span of a vertex's own arc, of a polygon that holds the zenith."""
    return Span(one.leaves if one.leaves[2] > 0 else NONE, NONE, one.at, one.end)


@inlined
def spans(a, b, c, d, e):
    """Of a polygon with these vertices: five, of which some are empty."""
    if min(a.leaves[2], b.leaves[2], c.leaves[2], d.leaves[2]) >= -VERTICAL:
        return whole(a), whole(b), whole(c), whole(d), whole(e)
    a, b, c, d, e = by_azimuth(a, b, c, d, e)
    none = Span(NONE, NONE, a.at, a.at)
    first = following(none, a, b)
    second = following(first, b, c)
    third = following(second, c, d)
    return first, second, third, following(third, d, e), none


@strict
def sectors(a, b, c, d, planes):
    """The five sectors that a quadrilateral falls into, by corners and planes as `vertices` has them."""
    a, b, c, d, e = spans(*vertices(a, b, c, d, planes))
    return sector(a), sector(b), sector(c), sector(d), sector(e)


@inlined
def later(one, area, further):
    """The sector that `area` falls in, this one or one that follows, and what of the area is left there."""
    beyond = area >= one.area
    return (further if beyond else one), (area - one.area if beyond else area)


@strict
def summed(parts):
    """The projected solid angle of all sectors, and what its rounding is relative to."""
    a, b, c, d, e = parts
    return a.area + b.area + c.area + d.area + e.area, a.gross + b.gross + c.gross + d.gross + e.gross


@strict
def inside(parts, area, t):
    """A direction into the sectors, uniform in projected solid angle where `area` is uniform up to their sum and t in [0, 1]."""
    one, area = later(parts[0], area, parts[1])
    one, area = later(one, area, parts[2])
    one, area = later(one, area, parts[3])
    one, area = later(one, area, parts[4])
    span = one.span
    return between(span, arc_point(span, reaching(span, min(area / max(one.area, TINY), 1.0), one.area)), t)


@inlined
def arc_point(one, angle):
    """The direction on the outer arc, `angle` from its start."""
    u, normal = one.start, one.outer
    begin = normal[2] * u[0], normal[2] * u[1], lifted(normal, u)
    begin = scaled(1 / max(norm(begin), TINY), begin)
    sine, cosine = series(angle / 2)
    return along(scaled(1 - 2 * sine * sine, begin), 2 * sine * cosine, cross(normal, begin))


@inlined
def share(one, p):
    """Square of the inner ellipse's radius over the outer one's under p, a direction on the outer arc, and sin^2 of the
    inner arc's height there."""
    narrow = one.inner[2] * one.inner[2] * (p[0] * p[0] + p[1] * p[1])
    height = lifted(one.inner, p) * lifted(one.inner, p)
    return one.inner[2] * one.inner[2] / (narrow + height + TINY), (height + TINY) / (narrow + height + TINY)


@strict
def reaching(one, part, area):
    """The angle along the outer arc that cuts off a part of the span's area: first as if its density were linear."""
    low, high = 0.0, swept(one.outer, one.start, one.end)
    longest = high
    begin, end = 1 - share(one, arc_point(one, low))[0], 1 - share(one, arc_point(one, high))[0]
    angle = high * part * (begin + end) / max(begin + math.sqrt(max(begin * begin * (1 - part) + end * end * part, 0.0)), TINY)
    for _ in range(STEPS):
        p = arc_point(one, angle)
        beyond = (one.outer[2] * angle + one.inner[2] * swept(one.inner, one.start, p)) / 2 - part * area
        low, high = (low, angle) if beyond > 0 else (angle, high)
        newton = angle - 2 * beyond / max(one.outer[2] * (1 - share(one, p)[0]), TINY)
        step = abs(newton - angle)
        angle = newton if low <= newton <= high else (low + high) / 2
        if step <= CLOSE * longest:
            break
    return angle


@inlined
def between(one, p, t):
    """A direction under the azimuth of p, between the two arcs, by t uniform in [0, 1]."""
    within, high = share(one, p)
    radius = math.sqrt(within + t * (1 - within))
    return p[0] * radius, p[1] * radius, math.sqrt(max(high + t * (p[2] * p[2] - high), 0.0))
