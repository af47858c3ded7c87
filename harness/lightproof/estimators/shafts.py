"""Whether a blocker stands between all, none or some points of two convex cells: exact for corners, and so for all between.

Where the plane of a flat blocker parts the cells, the segment from x to y crosses it in (T p + S q)/(S + T), S and T being the
heights of x and y over the plane, p and q the plane's coordinates below them. Numerators and denominator are linear in x and in
y, so that a line that has all pairs of corners on one side has all pairs. Of a sphere, the disk across the cells' axis hides.
"""

from __future__ import annotations

import math

from lightproof.estimators.boxes import part
from lightproof.estimators.compiled import strict
from lightproof.estimators.shapes import Flat, Sphere
from lightproof.estimators.vectors import TINY, along, dot, norm, scaled, sub, tangents
from lightproof.estimators.world import DISK, KINDS, PARALLELOGRAM, SPHERE

KIND, CENTER, NORMAL, DUAL_U, DUAL_V, RADIUS, WIDTH = 0, 1, 4, 7, 10, 13, 14  # columns of a blocker
POINTS, VECTORS = (CENTER,), (NORMAL, DUAL_U, DUAL_V)
SEEN, MIXED, HIDDEN = 0, 1, 2
MARGIN = 1e-12  # of a blocker's size: what is nearer to its edge is not decided


def row(piece: Flat | Sphere) -> list[float]:
    """A blocker (WIDTH,)."""
    if isinstance(piece, Sphere):
        return [SPHERE, *piece.center, *[0.0] * 9, piece.radius]
    return [KINDS[type(piece)], *piece.center, *piece.normal, *piece.dual_u, *piece.dual_v, 0.0]


@strict
def between(blocker, xs, ys, flat):
    """SEEN, MIXED or HIDDEN by one blocker; `flat` (2, 4, 3) is room."""
    middle_x, middle_y = middle(xs), middle(ys)
    if blocker[KIND] == SPHERE:
        return beside_sphere(blocker, xs, ys, middle_x, middle_y, flat)
    center, normal, dual_u, dual_v = part(blocker, CENTER), part(blocker, NORMAL), part(blocker, DUAL_U), part(blocker, DUAL_V)
    coordinates(xs, center, normal, dual_u, dual_v, flat[0])
    coordinates(ys, center, normal, dual_u, dual_v, flat[1])
    return crossed(int(blocker[KIND]), flat)


@strict
def middle(points):
    return ((points[0, 0] + points[1, 0] + points[2, 0] + points[3, 0]) / 4,
            (points[0, 1] + points[1, 1] + points[2, 1] + points[3, 1]) / 4,
            (points[0, 2] + points[1, 2] + points[2, 2] + points[3, 2]) / 4)


@strict
def coordinates(points, center, normal, dual_u, dual_v, out):
    """u, v and height (4, 3) of points over a plane."""
    for k in range(4):
        d = sub(part(points[k], 0), center)
        out[k, 0], out[k, 1], out[k, 2] = dot(d, dual_u), dot(d, dual_v), dot(d, normal)


@strict
def crossed(kind, flat):
    """By a shape in a plane over which the cells have the coordinates `flat`."""
    low, high = heights(flat[0])
    low_y, high_y = heights(flat[1])
    if min(low, low_y) >= 0 or max(high, high_y) <= 0:
        return SEEN
    if not (low >= 0 >= high_y or low_y >= 0 >= high):
        return SEEN if aside(kind, flat) else MIXED
    return decided(kind, flat)


@strict
def heights(points):
    low, high = points[0, 2], points[0, 2]
    for k in range(1, 4):
        low, high = min(low, points[k, 2]), max(high, points[k, 2])
    return low, high


@strict
def aside(kind, flat):
    """Whether one edge of the shape, as a plane across its own, has both cells beyond it."""
    cosine, sine = outward(flat)
    out = (True, True, True, True)
    for k in range(8):
        out = beyond(kind, out, flat[k // 4, k % 4, 0], flat[k // 4, k % 4, 1], 1.0, cosine, sine)
    return out[0] or out[1] or out[2] or out[3]


@strict
def decided(kind, flat):
    cosine, sine = outward(flat)
    out, held = (True, True, True, True), True
    for i in range(4):
        for j in range(4):
            p, q, scale = crossing(flat, i, j)
            out = beyond(kind, out, p, q, scale, cosine, sine)
            held = held and inside(kind, p, q, scale)
    if out[0] or out[1] or out[2] or out[3]:
        return SEEN
    return HIDDEN if held else MIXED


@strict
def crossing(flat, i, j):
    """Numerators and denominator of where the plane is crossed from corner i of one cell to corner j of the other."""
    a, b = abs(flat[0, i, 2]), abs(flat[1, j, 2])
    return b * flat[0, i, 0] + a * flat[1, j, 0], b * flat[0, i, 1] + a * flat[1, j, 1], a + b


@strict
def outward(flat):
    """Direction in the plane from its origin to about where the cells' axis crosses it."""
    p, q = 0.0, 0.0
    for k in range(4):
        one, other, scale = crossing(flat, k, 3 - k)
        p, q = p + one / max(scale, TINY), q + other / max(scale, TINY)
    length = max(math.hypot(p, q), TINY)
    return p / length, q / length


@strict
def beyond(kind, out, p, q, scale, cosine, sine):
    """Which edges still have every point (p, q)/scale beyond them; of a disk, the tangent towards the axis."""
    far = scale * (1 + MARGIN)
    if kind == PARALLELOGRAM:
        return out[0] and 2 * p > far, out[1] and -2 * p > far, out[2] and 2 * q > far, out[3] and -2 * q > far
    if kind == DISK:
        return out[0] and cosine * p + sine * q > far, False, False, False
    return out[0] and -p > MARGIN * scale, out[1] and -q > MARGIN * scale, out[2] and p + q > far, False


@strict
def inside(kind, p, q, scale):
    near = scale * (1 - MARGIN)
    if kind == PARALLELOGRAM:
        return 2 * max(abs(p), abs(q)) < near
    if kind == DISK:
        return p * p + q * q < near * near
    return min(p, q) > MARGIN * scale and p + q < near


@strict
def beside_sphere(blocker, xs, ys, x, y, flat):
    center, radius = part(blocker, CENTER), blocker[RADIUS]
    axis = sub(y, x)
    length = norm(axis)
    share = min(max(dot(sub(center, x), axis) / (length * length), 0.0), 1.0)
    away = sub(along(x, share, axis), center)
    apart = norm(away)
    if apart > radius:
        clear = True
        for k in range(4):
            clear = clear and dot(sub(part(xs[k], 0), center), away) > radius * (1 + MARGIN) * apart
            clear = clear and dot(sub(part(ys[k], 0), center), away) > radius * (1 + MARGIN) * apart
        return SEEN if clear else MIXED
    normal = scaled(1 / length, axis)
    u, v = tangents(normal)
    coordinates(xs, center, normal, scaled(1 / radius, u), scaled(1 / radius, v), flat[0])
    coordinates(ys, center, normal, scaled(1 / radius, u), scaled(1 / radius, v), flat[1])
    parted = heights(flat[0])[1] <= 0 <= heights(flat[1])[0]
    return HIDDEN if parted and decided(DISK, flat) == HIDDEN else MIXED
