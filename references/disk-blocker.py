"""Second derivation for disk-blocker: the area form, circle by circle of the light, and cells summed line by line.

On the circle of radius s of the light, a receiver at distance r from the axis sees the azimuths with cos(f) greater than
(b^2 - (1 - k)^2 r^2 - k^2 s^2) / (2 k (1 - k) r s), for a blocker of radius b and k = blocker's height / light's; over them
h^2 / (h^2 + r^2 + s^2 - 2 r s cos f)^2 is elementary. Gauss rules do s, and x and y of a cell, each split where the
picture changes and stretched there by a cosine, which takes the square roots away; binary64. Prints the base case as JSON.
"""

import json
import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)
STRETCHED = (1 - np.cos(np.pi * (1 + NODES) / 2)) / 2  # nodes and weights on [0, 1]
SHARES = WEIGHTS * np.pi / 4 * np.sin(np.pi * (1 + NODES) / 2)


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, lamp, blocker = scene["film"], scene["light"][0], scene["surface"][0]["shape"]
    light = lamp["shape"]
    assert light["center"][:2] == blocker["center"][:2] and film["u"][1:] == [0, 0] and film["v"][::2] == [0, 0]
    height = light["center"][2] - film["origin"][2]
    scale = (blocker["center"][2] - film["origin"][2]) / height
    disks = light["radius"], blocker["radius"], height, scale
    rims = [abs(blocker["radius"] + sign * scale * light["radius"]) / (1 - scale) for sign in (-1, 1)]
    columns, rows = film["resolution"]
    means = []
    for element in elements:
        row, column = divmod(element, columns)
        x_span = [film["origin"][0] + film["u"][0] * (column + i) / columns - light["center"][0] for i in (0, 1)]
        y_span = [film["origin"][1] + film["v"][1] * (row + i) / rows - light["center"][1] for i in (0, 1)]
        area = (x_span[1] - x_span[0]) * (y_span[1] - y_span[0])
        means.append(lamp["radiance"] * flux(x_span, y_span, rims, disks) / area)
    return means


def flux(x_span, y_span, rims, disks):
    """The integral of irradiance per radiance over a cell, in coordinates from the axis."""
    crossings = [sign * np.sqrt(max(rim**2 - x**2, 0)) for sign in (-1, 1) for rim in rims for x in (*x_span, 0)]
    total = 0.0
    for y, share in rule(y_span, crossings):
        ends = [sign * np.sqrt(max(rim**2 - y**2, 0)) for sign in (-1, 1) for rim in rims]
        x, shares = (np.array(column) for column in zip(*rule(x_span, [*ends, 0]), strict=True))
        total += share * float(shares @ visible(np.hypot(x, y), *disks))
    return total


def rule(span, stops):
    """Nodes and weights over an interval split at the stops inside it."""
    ends = pairwise(sorted({*span, *(stop for stop in stops if span[0] < stop < span[1])}))
    return [(a + (b - a) * node, (b - a) * share) for a, b in ends for node, share in zip(STRETCHED, SHARES, strict=True)]


def visible(r, light, blocker, h, k):
    """Irradiance per radiance [sr] at distances r from the axis, (m,)."""
    touches = [np.minimum(np.abs(blocker + sign * (1 - k) * r) / k, light) for sign in (-1, 1)]
    total = np.zeros_like(r)
    for a, b in pairwise([np.zeros_like(r), *touches, np.full_like(r, light)]):
        s = a[:, None] + (b - a)[:, None] * STRETCHED
        limit = (blocker**2 - ((1 - k) * r[:, None]) ** 2 - (k * s) ** 2) / (2 * k * (1 - k) * r[:, None] * s + 1e-300)
        total += (b - a) * (2 * h**2 * s * turn(h**2 + r[:, None] ** 2 + s**2, 2 * r[:, None] * s, limit) @ SHARES)
    return total


def turn(p, q, limit):
    """The integral of (p - q cos f)^-2 for f from 0 to acos(limit)."""
    end = np.arccos(np.clip(limit, -1, 1))
    root = np.sqrt(p**2 - q**2)
    first = 2 / root * np.arctan2(np.sqrt(p + q) * np.sin(end / 2), np.sqrt(p - q) * np.cos(end / 2))
    return (q * np.sin(end) / (p - q * np.cos(end)) + p * first) / root**2


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/disk-blocker.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
