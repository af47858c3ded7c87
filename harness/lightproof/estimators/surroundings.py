"""Everything around a receiver, moved into its frame: what `Scenery` is made of."""

from __future__ import annotations

import math

from lightproof.estimators.compiled import strict
from lightproof.estimators.rows import point
from lightproof.estimators.tracing import vector
from lightproof.estimators.vectors import along, cross, dot, norm, scaled, sub, tangents, turned

INSIDE = 1e-12  # of a radius: what is no deeper in a ball lies on it
NEAR = 1e-100  # a distance that is none [m]
EDGE_ON = 1e-15  # cosine of an angle that is a right one


@strict
def settle(source, scenery, x, n):
    """Moves everything into the frame of a receiver; whether any light can reach it (not inside a ball)."""
    t, b = tangents(n)
    frame, solids = (t, b, n), source.solids
    for i in range(len(solids.corners)):
        put(scenery.corners[i], 0, turned(sub(point(solids.corners, i), x), frame, 1.0))
    for k in range(len(solids.starts) - 1):
        normal = point(solids.normals[k], 0)
        before = dot(normal, sub(point(solids.corners, solids.starts[k]), x))
        put(scenery.planes[k], 0, turned(normal, frame, 1.0))
        scenery.planes[k, 3] = before if abs(before) > solids.touch else limit(dot(normal, n))
    for i in range(len(solids.disks)):
        settle_disk(solids.disks[i], scenery, i, x, frame, solids.touch)
    for i in range(len(solids.tubes)):
        settle_tube(solids.tubes[i], scenery, i, x, frame)
    for i in range(len(source.skies)):
        put(scenery.skies[i], 2, turned(vector(source.skies[i], 2), frame, 1.0))
    free = True
    for i in range(len(solids.balls)):
        put(scenery.balls[i], 0, turned(sub(vector(solids.balls[i], 0), x), frame, 1.0))
        scenery.balls[i, 3] = solids.balls[i, 6]
        free &= norm(vector(scenery.balls[i], 0)) >= solids.balls[i, 6] * (1 - INSIDE)
    return free


@strict
def limit(facing):
    """Distance along its normal to a plane on which a receiver lies, whose own normal has this share along that: it is on the
    side that it faces, however near."""
    return -math.copysign(NEAR, facing) if abs(facing) > EDGE_ON else 0.0


@strict
def put(row, at, v):
    row[at], row[at + 1], row[at + 2] = v


@strict
def settle_disk(disk, scenery, i, x, frame, touch):
    center, normal = turned(sub(vector(disk, 0), x), frame, 1.0), turned(vector(disk, 3), frame, 1.0)
    row, before = scenery.disks[i], dot(center, normal)
    put(row, 0, center)
    put(row, 3, normal)
    row[6], row[7] = disk[6], before if abs(before) > touch else limit(normal[2])
    circle(scenery.rings[i], center, normal, disk[6])


@strict
def circle(row, center, normal, radius):
    u, v = tangents(normal)
    put(row, 0, center)
    put(row, 3, scaled(radius, u))
    put(row, 6, scaled(radius, v))


@strict
def settle_tube(tube, scenery, i, x, frame):
    """The tube, its two rims, and the two lines along which its wall turns away from the receiver (none where that is inside)."""
    base, axis, radius = turned(sub(vector(tube, 0), x), frame, 1.0), turned(vector(tube, 3), frame, 1.0), tube[6]
    row, top = scenery.tubes[i], along(base, tube[7], axis)
    put(row, 0, base)
    put(row, 3, axis)
    row[6], row[7] = radius, tube[7]
    first = len(scenery.disks) + 2 * i
    circle(scenery.rings[first], base, axis, radius)
    circle(scenery.rings[first + 1], top, axis, radius)
    foot = along(base, -dot(base, axis), axis)  # of the axis, nearest to the receiver
    d = norm(foot)
    outside = d > radius
    back, aside = (-radius * radius / d / d, radius * math.sqrt((d - radius) * (d + radius)) / d / d) if outside else (0.0, 0.0)
    for j in range(2):
        shift = along(scaled(back, foot), aside if j else -aside, cross(axis, foot))
        put(scenery.sides[2 * i + j], 0, along(base, 1.0, shift) if outside else base)
        put(scenery.sides[2 * i + j], 3, along(top, 1.0, shift) if outside else base)
