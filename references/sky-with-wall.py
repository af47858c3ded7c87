"""Second derivation for sky-with-wall: the open sky less what the wall takes, in area form.

A point of the wall at height z, x aside and y ahead of a receiver takes z y/r^4 per area and radiance, and of an overcast sky
(1 + 2 z/r)/3 times as much. Over a cell and the wall that is an integral over x, weighted with the share of the cell from which x
leads to the wall (a trapezoid), over y and over z. Gauss rules in binary64, piece by piece. Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path

import numpy as np

ALONG, AHEAD, UP = 70, 24, 90  # nodes


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, sky = scene["film"], scene["light"][0]
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
    pieces = [rule(a, b, ALONG) for a, b in zip(ends[:-1], ends[1:], strict=True)]
    x, weights = (np.concatenate(parts) for parts in zip(*pieces, strict=True))
    return x, weights * (np.minimum(high, x + start + width) - np.maximum(low, x + start)) / width


def rule(low, high, count):
    """Nodes and weights of the Gauss-Legendre rule between two ends."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (low + high + (high - low) * nodes) / 2, (high - low) / 2 * weights


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/sky-with-wall.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
