"""Convex polygons cut by half-planes: rows of any width, interpolated where an edge is cut."""

from __future__ import annotations

from lightproof.estimators.compiled import strict
from lightproof.estimators.lambert import A, B, twice_area

NONE = -1


@strict
def copy(rows, i, out, j):
    """Row i of `rows` to row j of `out`."""
    for axis in range(rows.shape[1]):
        out[j, axis] = rows[i, axis]


@strict
def copy_all(rows, count, out):
    for i in range(count):
        copy(rows, i, out, i)


@strict
def clip(polygon, values, count, column, out):
    """The part of a polygon where `values` (count,) at its corners, interpolated between them, are not negative, into `out`;
    returns its count, 0 where nothing has an area. Where they are a `column` of the polygon's, that is exactly 0 at a cut."""
    kept = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        if values[i] >= 0:
            copy(polygon, i, out, kept)
            kept += 1
        if (values[i] > 0 > values[j]) or (values[i] < 0 < values[j]):
            share = values[i] / (values[i] - values[j])
            for axis in range(polygon.shape[1]):
                out[kept, axis] = polygon[i, axis] + share * (polygon[j, axis] - polygon[i, axis])
            if column != NONE:
                out[kept, column] = 0.0
            kept += 1
    return kept if kept >= 3 else 0


@strict
def clip_by_line(polygon, count, line, sign, values, out):
    """The part where sign (line . (1, a, b)) is not negative, a and b being the columns A and B; `values` is room."""
    for i in range(count):
        values[i] = sign * (line[0] + line[1] * polygon[i, A] + line[2] * polygon[i, B])
    return clip(polygon, values, count, NONE, out)


@strict
def misses(polygon, count, lines, sides):
    """Whether a polygon lies wholly on the negative side of one of `sides` lines."""
    for k in range(sides):
        beyond = True
        for i in range(count):
            beyond &= lines[k, 0] + lines[k, 1] * polygon[i, A] + lines[k, 2] * polygon[i, B] <= 0
        if beyond:
            return True
    return False


@strict
def area(polygon, count):
    total = 0.0
    for i in range(1, count - 1):
        total += twice_area(polygon, 0, i, i + 1)
    return total / 2
