"""Irradiance of a convex polygon, in the frame of its own plane: Lambert's sum, or where that cancels the integral over its area.

A polygon is a count and the first rows of an array (room, 5), counter-clockwise from its front: the corner in the plane from a
corner of the light, the same from the receiver, which is `h` in front of the plane, and the level above the receiver's plane.
The first gives edges and areas to the last digit however far the receiver, the second distances however near.
"""

from __future__ import annotations

import math

from lightproof.estimators import gauss
from lightproof.estimators.compiled import strict

CANCELLED = 0.01  # Lambert's sum below this share of its terms has lost two digits
NEAR, FAR = 2.5, 30.0  # distances, in lengths of a cell, from which a rule is right to the last digits
DEPTH = 64  # cells that wait
S, T, A, B, LEVEL = range(5)
(CLOSE_NODES, CLOSE_WEIGHTS), (FAR_NODES, FAR_WEIGHTS) = gauss.rule(8), gauss.rule(4)


@strict
def irradiance(polygon, count, h, n, cells):
    """Irradiance per radiance of a polygon above the horizon on a receiver with unit normal n, given in the polygon's frame;
    `cells` (DEPTH, 3, 4) is room."""
    total, terms = edges(polygon, count, h, n)
    return total if total > CANCELLED * terms else by_area(polygon, count, h, cells)


@strict
def edges(polygon, count, h, n):
    """(1/2) sum_i theta_i (g_i . n) (Lambert 1760; Arvo 1995) and the sum of the terms' sizes; g_i from differences of corners,
    and along the horizon n itself."""
    total, terms = 0.0, 0.0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        s, t, u, v = polygon[i, A], polygon[i, B], polygon[j, A], polygon[j, B]
        ds, dt = apart(polygon, i, j, A, S), apart(polygon, i, j, B, T)
        up = s * dt - t * ds if s * s + t * t < u * u + v * v else u * dt - v * ds
        sine = math.sqrt(h * h * (ds * ds + dt * dt) + up * up)
        if sine > 0:
            angle = math.atan2(sine, s * u + t * v + h * h)
            level = polygon[i, LEVEL] == 0 and polygon[j, LEVEL] == 0
            cosine = 1.0 if level else (h * (ds * n[1] - dt * n[0]) - up * n[2]) / sine
            total += angle * cosine / 2
            terms += abs(angle * cosine) / 2
    return total, terms


@strict
def apart(polygon, i, j, near, own):
    """How far corner j lies beyond corner i along an axis, from whichever origin is nearer to them."""
    from_receiver = abs(polygon[i, near]) + abs(polygon[j, near]) < abs(polygon[i, own]) + abs(polygon[j, own])
    return polygon[j, near] - polygon[i, near] if from_receiver else polygon[j, own] - polygon[i, own]


@strict
def by_area(polygon, count, h, cells):
    """The integral of cos cos / r^2, which is positive, over a fan of triangles."""
    total = 0.0
    for i in range(1, count - 1):
        for k in range(3):
            corner = 0 if k == 0 else i + k - 1
            cells[0, k, 0], cells[0, k, 1], cells[0, k, 2] = polygon[corner, A], polygon[corner, B], polygon[corner, LEVEL]
        cells[0, 0, 3] = twice_area(polygon, 0, i, i + 1)
        total += triangle(h, cells)
    return h * total


@strict
def twice_area(polygon, i, j, k):
    """Twice the area of the triangle of three corners, positive where they turn left."""
    us, ut = apart(polygon, i, j, A, S), apart(polygon, i, j, B, T)
    return us * apart(polygon, i, k, B, T) - ut * apart(polygon, i, k, A, S)


@strict
def triangle(h, cells):
    """The integral of level / r^4 over the triangle cells[0] of place and level; its doubled area stands beside its first corner.
    It is cut in two until each part is shorter than its distance."""
    total, waiting = 0.0, 1
    while waiting > 0:
        waiting -= 1
        cell = cells[waiting]
        longest, length = longest_side(cell)
        s, t = (cell[0, 0] + cell[1, 0] + cell[2, 0]) / 3, (cell[0, 1] + cell[1, 1] + cell[2, 1]) / 3
        distance = s * s + t * t + h * h
        if distance > FAR * FAR * length:
            total += by_rule(cell, h, FAR_NODES, FAR_WEIGHTS)
        elif distance > NEAR * NEAR * length or waiting + 2 > len(cells):
            total += by_rule(cell, h, CLOSE_NODES, CLOSE_WEIGHTS)
        else:
            halve(cells, waiting, longest)
            waiting += 2
    return total


@strict
def longest_side(cell):
    """The corner of a triangle where its longest side begins, and that side's length squared."""
    longest, length = 0, 0.0
    for i in range(3):
        j = i + 1 if i < 2 else 0
        side = (cell[j, 0] - cell[i, 0]) ** 2 + (cell[j, 1] - cell[i, 1]) ** 2
        if side > length:
            longest, length = i, side
    return longest, length


@strict
def halve(cells, at, longest):
    """Replaces a triangle by its two halves on either side of the middle of its longest side."""
    a, b = longest, longest + 1 if longest < 2 else 0
    cells[at, 0, 3] /= 2
    cells[at + 1, 0, 3] = cells[at, 0, 3]
    for axis in range(3):
        middle = (cells[at, a, axis] + cells[at, b, axis]) / 2
        for k in range(3):
            cells[at + 1, k, axis] = middle if k == a else cells[at, k, axis]
        cells[at, b, axis] = middle


@strict
def by_rule(cell, h, nodes, weights):
    """Gauss-Legendre over a triangle as the image of a square, one side of which shrinks to the first corner."""
    us, ut, ul = cell[1, 0] - cell[0, 0], cell[1, 1] - cell[0, 1], cell[1, 2] - cell[0, 2]
    vs, vt, vl = cell[2, 0] - cell[0, 0], cell[2, 1] - cell[0, 1], cell[2, 2] - cell[0, 2]
    total = 0.0
    for i in range(len(nodes)):
        line = 0.0
        for j in range(len(nodes)):
            p, q = nodes[i] * (1 - nodes[j]), nodes[i] * nodes[j]
            s, t = cell[0, 0] + p * us + q * vs, cell[0, 1] + p * ut + q * vt
            per_r2 = 1 / (s * s + t * t + h * h)
            line += weights[j] * (cell[0, 2] + p * ul + q * vl) * per_r2 * per_r2
        total += weights[i] * nodes[i] * line
    return total * cell[0, 3]
