"""Second derivation for point-light: the flux through a cell is the intensity times the cell's solid angle.

Two triangles a cell, by the formula of Van Oosterom and Strackee (1983), in 30 digits. Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path

from mpmath import atan2, matrix, mp, mpf, sqrt

mp.dps = 30


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, light = scene["film"], scene["light"][0]
    origin, u, v, lamp = (vector(x) for x in (film["origin"], film["u"], film["v"], light["position"]))
    columns, rows = film["resolution"]
    area = length(cross(u, v)) / (columns * rows)
    means = []
    for element in elements:
        row, column = divmod(element, columns)
        corners = ((column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1))
        a, b, c, d = (origin + u * mpf(x) / columns + v * mpf(y) / rows - lamp for x, y in corners)
        means.append(mpf(light["intensity"]) * (solid_angle(a, c, b) + solid_angle(a, d, c)) / area)
    return [float(mean) for mean in means]


def solid_angle(a, b, c):
    """Solid angle of a triangle seen from 0 [sr], positive where its corners run clockwise."""
    x, y, z = length(a), length(b), length(c)
    return 2 * atan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y)


def vector(numbers):
    return matrix([mpf(number) for number in numbers])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return matrix([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def length(a):
    return sqrt(dot(a, a))


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/point-light.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
