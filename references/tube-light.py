"""Second derivation for tube-light: the area form over the wall, generator by generator.

Along a generator the wall's normal is the same, and with z measured from the foot of the receiver's perpendicular the integrand
is (a + b z) / (z^2 + k^2)^2, which is elementary; what lies under the horizon is left out. Around the tube, between the two
generators at which the receiver sees it end, a Gauss rule adds them up, for points as fine as 30 digits ask for, and a 10 x 10
Gauss rule does a cell. Prints the base case as JSON.
"""

import json
import tomllib
from itertools import pairwise
from pathlib import Path

from mpmath import acos, atan, atan2, cos, mp, mpf, pi, quadgl, sin, sqrt
from mpmath.calculus.quadrature import GaussLegendre

mp.dps = 30
AROUND = GaussLegendre(mp).calc_nodes(4, mp.prec)  # 24 nodes and weights on [-1, 1]
ON_CELL = [(mpf(x), mpf(w)) for x, w in zip(*mp.gauss_quadrature(10), strict=True)]


def values(scene, elements):
    """Irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, lamp = scene["film"], scene["light"][0]
    if film["kind"] == "points":
        receivers = [(film["positions"][element], film["normals"][element]) for element in elements]
        return [float(irradiance(lamp, vector(x), unit(vector(n)), finely)) for x, n in receivers]
    normal = unit(cross(vector(film["u"]), vector(film["v"])))
    return [float(mp.fsum(share * irradiance(lamp, x, normal, coarsely) for x, share in cell(film, element)))
            for element in elements]


def cell(film, element):
    """Points of a cell and their shares of its area."""
    columns, rows = film["resolution"]
    row, column = divmod(element, columns)
    frame = [vector(film[key]) for key in ("origin", "u", "v")]
    for s, p in ON_CELL:
        for t, q in ON_CELL:
            along, up = (column + (1 + s) / 2) / columns, (row + (1 + t) / 2) / rows
            yield [o + along * u + up * v for o, u, v in zip(*frame, strict=True)], p * q / 4


def irradiance(lamp, x, n, integral):
    """Irradiance at x from the outside of a cylinder's wall."""
    shape = lamp["shape"]
    axis, radius, height = unit(vector(shape["axis"])), mpf(shape["radius"]), mpf(shape["height"])
    base = [b - c for b, c in zip(vector(shape["base"]), x, strict=True)]
    low = dot(base, axis)
    offset = [b - low * a for b, a in zip(base, axis, strict=True)]
    distance = sqrt(dot(offset, offset))
    if distance <= radius:
        return mpf(0)
    towards = [-c / distance for c in offset]
    across, up = (dot(n, towards), dot(n, cross(axis, towards))), dot(n, axis)

    def generator(angle):
        square = distance**2 + radius**2 - 2 * distance * radius * cos(angle)
        rise = -distance * across[0] + radius * (across[0] * cos(angle) + across[1] * sin(angle))
        return (distance * cos(angle) - radius) * straight(rise, up, square, low, low + height)

    limit = acos(radius / distance)
    stops = [angle for z in (low, low + height) for angle in crossings(across, radius, distance * across[0] - up * z, limit)]
    return mpf(lamp["radiance"]) * radius * integral(generator, sorted({-limit, *stops, limit}))


def crossings(across, radius, level, limit):
    """The angles at which an end of the generator is on the horizon: radius (p cos f + q sin f) = level."""
    size = radius * sqrt(across[0] ** 2 + across[1] ** 2)
    if size <= abs(level):
        return []
    middle, half = atan2(across[1], across[0]), acos(level / size)
    angles = [middle + sign * half + turn for sign in (-1, 1) for turn in (-2 * pi, 0, 2 * pi)]
    return [angle for angle in angles if abs(angle) < limit]


def straight(rise, up, square, start, end):
    """The integral of (rise + up z) / (z^2 + square)^2 for z from start to end, where rise + up z > 0."""
    if up:
        level = -rise / up
        start, end = (max(start, level), end) if up > 0 else (start, min(end, level))
    if start >= end or (not up and rise <= 0):
        return mpf(0)
    root = sqrt(square)
    primitive = [rise / (2 * square) * (z / (z * z + square) + atan(z / root) / root) - up / (2 * (z * z + square))
                 for z in (start, end)]
    return primitive[1] - primitive[0]


def finely(function, stops):
    """The integral through the stops, to the working precision."""
    return quadgl(function, stops, maxdegree=9)


def coarsely(function, stops):
    """The integral through the stops, with 24 nodes between each two."""
    total = mpf(0)
    for a, b in pairwise(stops):
        total += (b - a) / 2 * mp.fsum(weight * function((a + b + (b - a) * node) / 2) for node, weight in AROUND)
    return total


def vector(numbers):
    """Exact components."""
    return [mpf(number) for number in numbers]


def dot(a, b):
    """Inner product."""
    return mp.fdot(a, b)


def cross(a, b):
    """Vector product."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    """Scaled to unit length."""
    length = sqrt(dot(a, a))
    return [component / length for component in a]


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/tube-light.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
