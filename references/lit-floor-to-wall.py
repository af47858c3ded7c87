"""Second derivation for lit-floor-to-wall: to cells a double contour integral of ln r, to points Nusselt's analogue.

A floor under a beam is a lamp of radiance rho E cos / pi. Over a cell ln r dx . dy is integrated around cell and floor
(Schröder and Hanrahan 1993), along the floor's edges elementary, along the cell's by a 24-point Gauss rule, or by double
exponential quadrature where they are near, as that bears the logarithm where they touch. At a point the area under the floor's
image on the unit sphere is found by following its outline; what a screen hides is clipped out of the floor and taken away. 30
digits. Prints the base case as JSON.
"""

import json
import tomllib
from functools import cache
from itertools import pairwise
from pathlib import Path

from mpmath import atan, log, mp, mpf, pi, quad, sqrt

NODES = 24
mp.dps = 30


def values(scene, elements):
    """Irradiance [W/m2] of the film's elements, means over cells or at points; `scene` is the table of a scene file."""
    film, beam = scene["film"], scene["light"][0]
    polygons = [([vector(corner) for corner in each["shape"]["vertices"]], each["reflectance"]) for each in scene["surface"]]
    lamps = [(mpf(rho) * lit(polygon, beam) / pi, polygon) for polygon, rho in polygons if rho and lit(polygon, beam)]
    if film["kind"] == "plane":
        columns = [of_cells(film, polygon) for _, polygon in lamps]
        return [float(sum(radiance * mean(i) for (radiance, _), mean in zip(lamps, columns, strict=True))) for i in elements]
    screens = [polygon for polygon, rho in polygons if not rho]
    places = [(vector(film["positions"][i]), unit(vector(film["normals"][i]))) for i in elements]
    return [float(sum(radiance * at_point(*place, polygon, screens) for radiance, polygon in lamps)) for place in places]


def lit(polygon, beam):
    """Irradiance of a polygon under the beam; 0 on its back and edge-on."""
    cosine = -dot(unit(vector(beam["direction"])), unit(normal_of(polygon)))
    return mpf(beam["irradiance"]) * cosine if cosine > mpf(10) ** -20 else mpf(0)


def of_cells(film, polygon):
    """Mean irradiance per radiance of a cell, from a polygon in front of the film."""
    origin, u, v = (vector(film[key]) for key in ("origin", "u", "v"))
    columns, rows = film["resolution"]
    area = norm(cross(u, v)) / (columns * rows)
    edges = list(zip(polygon, polygon[1:] + polygon[:1], strict=True))

    def grid(column, row):
        return add(origin, add(scale(u, mpf(column) / columns), scale(v, mpf(row) / rows)))

    @cache
    def along(start, end):
        return sum(contour(grid(*start), grid(*end), *edge) for edge in edges)

    def mean(element):
        row, column = divmod(element, columns)
        right, top = column + 1, row + 1
        flux = (along((column, row), (right, row)) + along((right, row), (right, top))
                - along((column, top), (right, top)) - along((column, row), (column, top)))
        return flux / 2 / area

    return mean


def contour(p, q, a, b):
    """The integral of ln |x - y| dx . dy for x from p to q and y from a to b, all at right angles or parallel."""
    side, other = sub(q, p), sub(b, a)
    if not dot(side, other):
        return mpf(0)
    length = norm(other)
    apart = norm(cross(sub(a, p), other)) / length

    def inner(s):
        return ln_along(add(p, scale(side, s)), a, other, length)

    if apart > norm(side) / 2:
        return dot(side, other) / length * sum(weight * inner((1 + node) / 2) for node, weight in gauss(NODES)) / 2
    stops = [mpf(0), *sorted(s for s in (dot(sub(end, p), side) / dot(side, side) for end in (a, b)) if 0 < s < 1), mpf(1)]
    return dot(side, other) / length * sum(quad(inner, ends) for ends in pairwise(stops))


@cache
def gauss(count):
    """Nodes and weights of the Gauss-Legendre rule on [-1, 1]: Newton's method on the recurrence of the polynomials."""
    rule = []
    for k in range(count):
        x = mp.cos(pi * (k + mpf(3) / 4) / (count + mpf(1) / 2))
        for _ in range(8):
            before, here = mpf(1), x
            for n in range(2, count + 1):
                before, here = here, ((2 * n - 1) * x * here - (n - 1) * before) / n
            slope = count * (x * here - before) / (x * x - 1)
            x -= here / slope
        rule.append((x, 2 / ((1 - x * x) * slope**2)))
    return rule


def ln_along(x, a, other, length):
    """The integral over a segment from `a` of ln of the distance to x."""
    start = dot(sub(a, x), other) / length
    distance = norm(cross(sub(a, x), other)) / length

    def antiderivative(u):
        if distance < mpf(10) ** -25:
            return u * log(abs(u)) - u if u else mpf(0)
        return u * log(u * u + distance**2) / 2 - u + distance * atan(u / distance)

    return antiderivative(start + length) - antiderivative(start)


def at_point(x, normal, polygon, screens):
    """Irradiance per radiance from what no screen hides of a polygon; at most one screen hides any part of it."""
    seen = clipped([sub(corner, x) for corner in polygon], normal, mpf(0))
    hidden = [behind([sub(corner, x) for corner in screen], seen) for screen in screens]
    return projected(seen, normal) - sum((projected(part, normal) for part in hidden), mpf(0))


def behind(screen, seen):
    """The part of a polygon behind a screen, both as seen from the origin: beyond its plane and in its pyramid."""
    beyond = normal_of(screen)
    level = dot(beyond, screen[0])
    part = clipped(seen, beyond, level) if level > 0 else clipped(seen, scale(beyond, -1), -level)
    middle = scale(add(screen[0], screen[2]), mpf(1) / 2)
    for a, b in zip(screen, screen[1:] + screen[:1], strict=True):
        side = cross(a, b)
        part = clipped(part, side if dot(side, middle) > 0 else scale(side, -1), mpf(0))
    return part


def clipped(polygon, normal, level):
    """The part of a convex polygon where normal . x is at least `level`."""
    heights = [dot(corner, normal) - level for corner in polygon]
    kept = []
    for i, (corner, height) in enumerate(zip(polygon, heights, strict=True)):
        if height * heights[i - 1] < 0:
            share = heights[i - 1] / (heights[i - 1] - height)
            kept.append(add(polygon[i - 1], scale(sub(corner, polygon[i - 1]), share)))
        if height >= 0:
            kept.append(corner)
    return kept


def projected(polygon, normal):
    """The area that a polygon covers in the unit circle under the unit sphere (Nusselt 1928), counter-clockwise positive."""
    edges = list(zip(polygon, polygon[1:] + polygon[:1], strict=True)) if polygon else []
    return -sum((swept(a, b, normal) for a, b in edges), mpf(0)) / 2


def swept(a, b, normal):
    """The integral of (w x dw) . normal for the direction w from a to b: with w = y/|y|, that of (y x dy) . normal / y^2."""
    side = sub(b, a)
    if norm(side) < mpf(10) ** -25:
        return mpf(0)
    nearest = -dot(a, side) / dot(side, side)
    turning = dot(cross(a, side), normal)

    def rate(s):
        y = add(a, scale(side, s))
        return turning / dot(y, y)

    return sum(quad(rate, ends) for ends in pairwise([mpf(0), *([nearest] if 0 < nearest < 1 else []), mpf(1)]))


def normal_of(polygon):
    """Not of unit length."""
    return cross(sub(polygon[1], polygon[0]), sub(polygon[2], polygon[0]))


def vector(numbers):
    return tuple(mpf(number) for number in numbers)


def add(a, b):
    return tuple(x + y for x, y in zip(a, b, strict=True))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b, strict=True))


def scale(a, factor):
    return tuple(x * factor for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def norm(a):
    return sqrt(dot(a, a))


def unit(a):
    return scale(a, 1 / norm(a))


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/lit-floor-to-wall.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
