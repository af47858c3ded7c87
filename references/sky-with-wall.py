"""Second derivation for sky-with-wall: the open sky less the wall in area form; at points the sky ring by ring.

Means: a point of the wall at height z, x aside and y ahead of a receiver takes z y/r^4 per area and radiance, and of an overcast
sky (1 + 2 z/r)/3 times as much. Over a cell and the wall that is an integral over x, weighted with the share of the cell
from which x leads to the wall (a trapezoid), over y and over z. Gauss rules in binary64, piece by piece.

Points: rings about the zenith, or about the sun. The wall's edges and the receiver's horizon cut a ring into arcs; one ray for
each tells whether it is bright. The azimuth is elementary; between the angles at which that pattern changes, Gauss's rule in
sin^2, which takes the square roots at both ends, on halved panels, in 25 digits. Prints the base case as JSON.
"""

import json
import tomllib
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
from mpmath import acos, asin, atan2, cos, cot, legendre, mp, mpf, pi, sin, sqrt

ALONG, AHEAD, UP, RINGS = 70, 24, 90, 24  # nodes
ENOUGH = mpf("1e-18")

mp.dps = 25


def values(scene, elements):
    """Irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, sky = scene["film"], scene["light"][0]
    if film["kind"] == "points":
        return [float(at_point(scene, i)) for i in elements]
    overcast = "sky" in sky
    scale = sky["zenith_radiance"] / 3 if overcast else sky["radiance"]
    wall = np.array(scene["surface"][0]["shape"]["vertices"])
    whole = 7 * np.pi / 3 if overcast else np.pi
    return [float(scale * (whole - taken(wall, film, element, overcast))) for element in elements]


def taken(wall, film, element, overcast):
    """What the wall takes from the mean over a cell, per scale [sr]."""
    (columns, rows), (row, column) = film["resolution"], divmod(element, film["resolution"][0])
    x, wx = displaced(wall[:, 0], film["origin"][0], film["u"][0] / columns, column)
    depth = film["v"][1] / rows
    near = wall[0, 1] - film["origin"][1] - (row + 1) * depth
    y, wy = rule(near, near + depth, AHEAD)
    z, wz = rule(wall[:, 2].min() - film["origin"][2], wall[:, 2].max() - film["origin"][2], UP)
    x, y = x[:, None, None], y[:, None]
    square = x**2 + y**2 + z**2
    kernel = z * y / square**2
    return wx @ ((kernel * (1 + 2 * z / np.sqrt(square)) if overcast else kernel) @ wz) @ wy / depth


def displaced(corners, origin, width, index):
    """Nodes (n,) from a cell to an interval along one axis, weighted with the share of the cell from which they lead there."""
    low, high, start = corners.min(), corners.max(), origin + index * width
    ends = np.sort([low - start - width, low - start, high - start - width, high - start])
    pieces = [rule(a, b, ALONG) for a, b in pairwise(ends)]
    x, weights = (np.concatenate(parts) for parts in zip(*pieces, strict=True))
    return x, weights * (np.minimum(high, x + start + width) - np.maximum(low, x + start)) / width


def rule(low, high, count):
    """Nodes and weights of the Gauss-Legendre rule between two ends."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (low + high + (high - low) * nodes) / 2, (high - low) / 2 * weights


def at_point(scene, i):
    """Irradiance of one receiver: rings of the sky, or of the sun."""
    film, sky = scene["film"], scene["light"][0]
    x, normal = vector(film["positions"][i]), unit(vector(film["normals"][i]))
    wall = [minus(vector(corner), x) for corner in scene["surface"][0]["shape"]["vertices"]]
    if "half_angle" in sky:
        most, frame = pi * mpf(sky["half_angle"]) / 180, axes(unit([-c for c in vector(sky["direction"])]))
        return mpf(sky["radiance"]) * rings(wall, normal, frame, most, lambda b: 1)
    frame = axes([mpf(0), mpf(0), mpf(1)])
    if "sky" in sky:
        return mpf(sky["zenith_radiance"]) / 3 * rings(wall, normal, frame, pi / 2, lambda b: 1 + 2 * cos(b))
    return mpf(sky["radiance"]) * rings(wall, normal, frame, pi / 2, lambda b: 1)


def rings(wall, normal, frame, most, brightness):
    """The integral of brightness times cosine over what is above the horizon and beside the wall, up to an angle from an axis."""
    edges = [(unit(cross(a, b)), a, b) for a, b in pairwise([*wall, wall[0]])]
    circles = [*(g for g, _, _ in edges), normal]
    ends = {mpf(0), most, *(acos(dot(unit(corner), frame[2])) for corner in wall)}
    for g in circles:
        ends |= {asin(min(1, abs(dot(g, frame[2])))), pi - asin(min(1, abs(dot(g, frame[2]))))}
    for g, _, _ in edges:
        ends |= {acos(side * dot(unit(cross(g, normal)), frame[2])) for side in (1, -1)}
    ends = sorted(end for end in ends if 0 <= end <= most)
    return sum(band(wall, normal, circles, frame, brightness, *pair) for pair in pairwise(ends) if pair[1] - pair[0] > ENOUGH)


def band(wall, normal, circles, frame, brightness, low, high):
    """That integral between two rings, where the pattern is that of the middle."""
    middle = (low + high) / 2
    marks = sorted((f % (2 * pi), g, side) for g in circles for side in (1, -1)
                   if (f := azimuth(g, side, frame, middle)) is not None)
    starts = [f for f, _, _ in marks] or [mpf(0)]
    stops = [*starts[1:], starts[0] + 2 * pi]
    shows = [bright(wall, normal, direction((f + e) / 2, middle, frame)) for f, e in zip(starts, stops, strict=True)]
    if not any(shows):
        return mpf(0)
    if not marks:
        return gauss(lambda b: brightness(b) * sin(b) * 2 * pi * cos(b) * dot(normal, frame[2]), low, high)
    moves = [(shows[i - 1] - shows[i], f, g, side, azimuth(g, side, frame, middle)) for i, (f, g, side) in enumerate(marks)]
    turns = 2 * pi if shows[-1] else mpf(0)  # the last arc ends a whole turn after the first mark
    along, across, up = (dot(normal, axis) for axis in frame)

    def ring(b):
        ends = [(step, f + azimuth(g, side, frame, b) - base) for step, f, g, side, base in moves if step]
        level = sum((step * end for step, end in ends), turns)
        swing = sum(step * (along * sin(end) - across * cos(end)) for step, end in ends)
        return brightness(b) * sin(b) * (up * cos(b) * level + sin(b) * swing)

    return gauss(ring, low, high)


def azimuth(g, side, frame, b):
    """Where the ring at angle b crosses the circle g; None where it does not."""
    u, v, along = (dot(g, axis) for axis in frame)
    cosine = -along * cot(b) / sqrt(u**2 + v**2)
    return atan2(v, u) + side * acos(cosine) if abs(cosine) <= 1 else None


def direction(f, b, frame):
    """The unit vector at an azimuth and an angle from the axis."""
    u, v, axis = frame
    return [sin(b) * (cos(f) * p + sin(f) * q) + cos(b) * r for p, q, r in zip(u, v, axis, strict=True)]


def bright(wall, normal, w):
    """Whether a direction is above the horizon and misses the wall, which is convex: one that hits it goes to the wall's plane
    and is on the same side of all edges."""
    ahead = dot(cross(minus(wall[1], wall[0]), minus(wall[2], wall[0])), w) * volume(*wall[:3]) > 0
    sides = {dot(cross(a, b), w) > 0 for a, b in pairwise([*wall, wall[0]])}
    return dot(normal, w) > 0 and not (ahead and len(sides) == 1)


def volume(a, b, c):
    return dot(a, cross(b, c))


def minus(a, b):
    return [p - q for p, q in zip(a, b, strict=True)]


def vector(numbers):
    return [mpf(number) for number in numbers]


def dot(a, b):
    return sum(p * q for p, q in zip(a, b, strict=True))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [c / sqrt(dot(a, a)) for c in a]


def axes(axis):
    """Two unit vectors across a third, and that."""
    u = unit(cross(axis, [mpf(1), mpf(0), mpf(0)]))
    return u, cross(axis, u), axis


@cache
def legendre_rule():
    """Nodes in (0, 1) and weights of Gauss's rule: numpy's, polished by Newton's method."""
    nodes = []
    for guess in np.polynomial.legendre.leggauss(RINGS)[0]:
        x = mpf(guess)
        for _ in range(3):
            slope = RINGS * (legendre(RINGS - 1, x) - x * legendre(RINGS, x)) / (1 - x * x)
            x -= legendre(RINGS, x) / slope
        nodes.append(((1 + x) / 2, 1 / ((1 - x * x) * slope**2)))
    return nodes


def gauss(f, low, high):
    """The integral of f, which may have square roots at both ends."""
    def smooth(s):
        return f(low + (high - low) * sin(pi * s / 2) ** 2) * pi / 2 * sin(pi * s)

    return (high - low) * halved(smooth, mpf(0), mpf(1), panel(smooth, mpf(0), mpf(1)))


def halved(f, low, high, whole):
    """The integral of a smooth f, by panels halved until they agree with the `whole`."""
    middle = (low + high) / 2
    halves = panel(f, low, middle), panel(f, middle, high)
    if abs(sum(halves) - whole) < ENOUGH:
        return sum(halves)
    return halved(f, low, middle, halves[0]) + halved(f, middle, high, halves[1])


def panel(f, low, high):
    return (high - low) * sum(w * f(low + (high - low) * s) for s, w in legendre_rule())


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/sky-with-wall.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
