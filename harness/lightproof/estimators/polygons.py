"""Convex polygons seen from a point that is the origin: clipping, shadows, and Lambert's formula for their irradiance.

A polygon is a count and the first rows of an array (VERTICES, 3); in the receiver's frame its normal is the third axis.
"""

from __future__ import annotations

import math

import numpy as np

from lightproof.estimators.compiled import strict
from lightproof.estimators.tracing import vector
from lightproof.estimators.vectors import along, cross, dot, norm, scaled, sub, tangents, turned
from lightproof.estimators.world import CENTER, KIND, NORMAL, PARALLELOGRAM, TRIANGLE, U, V

PILE = 128  # pieces of a light that wait for the next blocker
VERTICES = 24  # room for a polygon: each clip adds at most one vertex
ORDER = 10  # Gauss-Legendre nodes along a side of a small triangle
NODES, WEIGHTS = ((1 + np.polynomial.legendre.leggauss(ORDER)[0]) / 2, np.polynomial.legendre.leggauss(ORDER)[1] / 2)
CORNERS = np.array([[[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]], [[0, 0], [1, 0], [0, 1], [0, 0]]])  # s, t by kind
CANCELLED = 1e-3  # Lambert's sum below this share of its terms has lost three digits
MOST_CELLS = 16  # half of the most along a triangle's side, for light that grazes


@strict
def put(rows, i, v):
    rows[i, 0], rows[i, 1], rows[i, 2] = v


@strict
def clip(polygon, count, normal, offset, out):
    """The part where v . normal >= offset, into `out`; returns its count. Raises ValueError where `out` could overflow."""
    if count >= len(out):
        raise ValueError("a light is cut into polygons of too many corners; take fewer blockers")
    kept = 0
    for i in range(count):
        a, b = vector(polygon[i], 0), vector(polygon[(i + 1) % count], 0)
        above_a, above_b = dot(a, normal) - offset, dot(b, normal) - offset
        if above_a >= 0:
            put(out, kept, a)
            kept += 1
        if (above_a > 0 > above_b) or (above_a < 0 < above_b):
            put(out, kept, along(a, above_a / (above_a - above_b), sub(b, a)))
            kept += 1
    return kept if kept >= 3 else 0


@strict
def shadow_planes(blocker, count, planes):
    """Inward normals of the planes through the origin and the blocker's edges, into `planes`; returns how many (0: the
    blocker is seen edge-on)."""
    turn = 0.0
    for i in range(1, count - 1):
        turn += dot(vector(blocker[0], 0), cross(vector(blocker[i], 0), vector(blocker[i + 1], 0)))
    if turn == 0:
        return 0
    for i in range(count):
        put(planes, i, scaled(math.copysign(1.0, turn), cross(vector(blocker[i], 0), vector(blocker[(i + 1) % count], 0))))
    return count


@strict
def lambert(polygon, count):
    """Irradiance at the origin, normal (0, 0, 1), per radiance of a polygon above the horizon that shows its front:
    (1/2) sum_i theta_i (g_i . n) (Lambert 1760; Arvo 1995). Where the sum cancels, the integral over the area instead."""
    total, terms = 0.0, 0.0
    for i in range(count):
        a, b = vector(polygon[i], 0), vector(polygon[(i + 1) % count], 0)
        g = cross(b, a)
        sine = norm(g)
        if sine > 0:
            term = math.atan2(sine, dot(a, b)) * g[2] / sine / 2
            total += term
            terms += abs(term)
    return total if total >= CANCELLED * terms else by_area(polygon, count)


@strict
def by_area(polygon, count):
    """The same by quadrature of cos cos / r^2, a positive integrand, over a fan of triangles."""
    total = 0.0
    for i in range(1, count - 1):
        total += triangle_by_area(vector(polygon[0], 0), vector(polygon[i], 0), vector(polygon[i + 1], 0))
    return total


@strict
def triangle_by_area(a, b, c):
    """Gauss-Legendre over a triangle cut into cells shorter than half their distance."""
    u, v = sub(b, a), sub(c, a)
    longest = max(norm(u), norm(v))
    nearest = max(min(norm(a), norm(b), norm(c)) - longest / 2, longest / MOST_CELLS)
    cells = int(1 + 2 * longest / nearest)
    normal = cross(u, v)
    total = 0.0
    for i in range(cells * ORDER):
        s = (i // ORDER + NODES[i % ORDER]) / cells
        for j in range(cells * ORDER):
            t = (j // ORDER + NODES[j % ORDER]) / cells
            y = along(along(a, s * (1 - t), u), s * t, v)
            r2 = dot(y, y)
            weight = s * WEIGHTS[i % ORDER] * WEIGHTS[j % ORDER] / (cells * cells)
            total += weight * max(y[2], 0.0) * max(-dot(y, normal), 0.0) / (r2 * r2)
    return total


@strict
def corners(item, x, frame, out):
    """The vertices of a parallelogram or triangle as seen from x along the axes of `frame`, into `out`; returns how many."""
    center, u, v = sub(vector(item, CENTER), x), vector(item, U), vector(item, V)
    kind = int(item[KIND])
    count = 4 if kind == PARALLELOGRAM else 3
    for i in range(count):
        put(out, i, turned(along(along(center, CORNERS[kind, i, 0], u), CORNERS[kind, i, 1], v), frame, 1.0))
    return count


@strict
def cone(items, k, x, frame, level, contact, planes):
    """Planes of the shadow that item k casts of what lies beyond the plane `level` (normal and offset), into `planes`; none
    where it lies wholly beyond that plane or below the horizon."""
    seen, above, front = np.empty((VERTICES, 3)), np.empty((VERTICES, 3)), np.empty((VERTICES, 3))
    count = corners(items[k], x, frame, seen)
    count = clip(seen, count, (0.0, 0.0, 1.0), contact, above)
    count = clip(above, count, level[0], level[1] + contact, front)
    return shadow_planes(front, count, planes) if count else 0


@strict
def polygon(items, k, x, n, contact, pile):
    """Irradiance at x, normal n, per radiance, from parallelogram or triangle k behind all others; `pile` (PILE, VERTICES,
    3) is room for the pieces that wait for the next blocker."""
    if dot(sub(x, vector(items[k], CENTER)), vector(items[k], NORMAL)) <= 0:
        return 0.0
    t, b = tangents(n)
    frame = t, b, n
    level = turned(vector(items[k], NORMAL), frame, 1.0), dot(sub(vector(items[k], CENTER), x), vector(items[k], NORMAL))
    planes, counts, tried = np.empty((VERTICES, 3)), np.empty(PILE, np.int64), np.zeros(PILE, np.int64)
    scratch = np.empty((VERTICES, 3))
    counts[0] = clip(scratch, corners(items[k], x, frame, scratch), (0.0, 0.0, 1.0), 0.0, pile[0])
    height, total = int(counts[0] > 0), 0.0
    while height > 0:
        height -= 1
        j = tried[height]
        if j == len(items):
            total += lambert(pile[height], counts[height])
            continue
        edges = 0 if j == k or items[j, KIND] > TRIANGLE else cone(items, j, x, frame, level, contact, planes)
        height = cut(pile, counts, tried, height, planes, edges)
    return total


@strict
def cut(pile, counts, tried, height, planes, edges):
    """Replaces the piece on top by its convex parts outside the cone of `edges` planes (0: by itself); the new height."""
    rest, spare = pile[height].copy(), np.empty((VERTICES, 3))
    count, after = counts[height], tried[height] + 1
    tried[height] = after
    if edges == 0:
        return height + 1
    if height + edges > len(pile):
        raise ValueError("a light is cut into too many pieces; take fewer blockers")
    for i in range(edges):
        normal = vector(planes[i], 0)
        counts[height] = clip(rest, count, scaled(-1.0, normal), 0.0, pile[height])
        tried[height] = after
        height += counts[height] > 0
        count = clip(rest, count, normal, 0.0, spare)
        rest, spare = spare, rest
        if count == 0:
            break
    return height
