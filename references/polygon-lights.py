"""Second derivation for lights that are polygons: flux from polygon to cell as a double contour integral of ln r.

Stokes' theorem on both sides turns the flux into (L/2) times the sum over a cell's edges and the light's of the integral of
ln r dx . dy (Schröder and Hanrahan 1993). Along the light's edge it is elementary, along the cell's a 16-point Gauss rule; 30
digits, as distant edges nearly cancel; 32 points give the same binary64. The part of the light behind the film's plane is cut
off first. Prints the base cases as JSON.
"""

import json
import tomllib
from functools import cache
from pathlib import Path

from mpmath import atan, log, mp, mpf, sqrt

mp.dps = 30
RULE = list(zip(*mp.gauss_quadrature(16), strict=True))  # nodes and weights on [-1, 1]
SCENES = ("l-shaped-light", "square-light", "triangle-light")


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, lamp = scene["film"], scene["light"][0]
    origin, u, v = (vector(film[key]) for key in ("origin", "u", "v"))
    columns, rows = film["resolution"]
    normal = cross(u, v)
    light = in_front([vector(corner) for corner in lamp["shape"]["vertices"]], origin, normal)
    edges = list(zip(light, light[1:] + light[:1], strict=True))
    area = sqrt(dot(normal, normal)) / (columns * rows)

    def grid(column, row):
        return add(origin, add(scale(u, mpf(column) / columns), scale(v, mpf(row) / rows)))

    @cache
    def along(start, end):
        return sum(contour(grid(*start), grid(*end), a, b) for a, b in edges)

    means = []
    for element in elements:
        row, column = divmod(element, columns)
        right, top = column + 1, row + 1
        flux = (along((column, row), (right, row)) + along((right, row), (right, top))
                - along((column, top), (right, top)) - along((column, row), (column, top)))
        means.append(float(mpf(lamp["radiance"]) / 2 * flux / area))
    return means


def contour(p, q, a, b):
    """The integral of ln |x - y| dx . dy for x from p to q and y from a to b."""
    side, other = sub(q, p), sub(b, a)
    if not dot(side, other):
        return mpf(0)
    length = sqrt(dot(other, other))
    total = sum(weight * ln_along(add(p, scale(side, (1 + node) / 2)), a, other, length) for node, weight in RULE) / 2
    return total * dot(side, other) / length


def ln_along(x, a, other, length):
    """The integral over a segment from `a` of ln of the distance to x."""
    start = dot(sub(a, x), other) / length
    distance = sqrt(max(mpf(0), dot(sub(a, x), sub(a, x)) - start**2))

    def antiderivative(u):
        return u * log(u * u + distance**2) / 2 - u + distance * atan(u / distance) if distance else u * log(abs(u)) - u

    return antiderivative(start + length) - antiderivative(start)


def in_front(corners, origin, normal):
    """The part of a polygon in front of a plane; edges that join pieces along the plane are run through both ways and cancel."""
    heights = [dot(sub(corner, origin), normal) for corner in corners]
    kept = []
    for i, (corner, height) in enumerate(zip(corners, heights, strict=True)):
        if height * heights[i - 1] < 0:
            share = heights[i - 1] / (heights[i - 1] - height)
            kept.append(add(corners[i - 1], scale(sub(corner, corners[i - 1]), share)))
        if height >= 0:
            kept.append(corner)
    return kept


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


def base(name):
    """The base case of a scene."""
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / f"scenes/{name}.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    return dict(enumerate(values(scene, range(columns * rows))))


if __name__ == "__main__":
    print(json.dumps({name: base(name) for name in SCENES}))
