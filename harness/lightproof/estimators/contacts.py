"""The shadow of a convex polygon on which a receiver lies, in the limit as it comes to it along its normal: the directions that
lead behind the polygon's plane, and at an edge to the inner side of the plane of edge and normal."""

from __future__ import annotations

import math

from lightproof.estimators.compiled import strict
from lightproof.estimators.rows import point
from lightproof.estimators.shapes import COINCIDES
from lightproof.estimators.vectors import cross, dot, norm, scaled, sub
from lightproof.estimators.windows import ALONG

APART = -1


@strict
def slack(reach, x):
    """How far a receiver that lies on a polygon with coordinates up to `reach` may be from it by rounding [m]."""
    return COINCIDES * max(reach, abs(x[0]), abs(x[1]), abs(x[2]))


@strict
def sides(corners, begin, end, facing, x, n, least, out):
    """Normals of the planes through x that bound the shadow, pointing into it, into `out` (end - begin + 1, 3); returns how many:
    none where n, a unit vector, runs along the polygon, and APART where x is farther than `least` [m] from it. `facing` is its
    unit normal, about which `corners` from `begin` to `end` run."""
    if abs(dot(facing, sub(point(corners, begin), x))) > least:
        return APART
    rise = dot(n, facing)
    side = math.copysign(1.0, rise)
    out[0, 0], out[0, 1], out[0, 2] = scaled(-side, facing)
    found = 1
    for i in range(begin, end):
        edge = sub(point(corners, i + 1 if i + 1 < end else begin), point(corners, i))
        inwards = dot(cross(facing, edge), sub(x, point(corners, i))) / norm(edge)
        if inwards < -least:
            return APART
        if inwards <= least:
            out[found, 0], out[found, 1], out[found, 2] = scaled(side, cross(n, edge))
            found += 1
    return found if abs(rise) > ALONG else 0
