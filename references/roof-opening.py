"""Second derivation for roof-opening: the open sky less what each board of the roof takes, in area form.

A level rectangle at height h takes k(x, y) = h^2/r^4 per area and radiance from a receiver displaced by (x, y), and of an
overcast sky (1 + 2 h/r)/3 times as much. Its mean over a cell is the integral of k over displacements, each weighted with the
area of the cell from which it ends in the rectangle: a product of two trapezoids. Gauss rules in binary64, piece by piece.
Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path

import numpy as np
from mpmath import mp, mpf


def rule(count):
    """Gauss's nodes and weights on [-1, 1], by Newton's method with 30 digits: numpy's weights are off by 1e-14."""
    rounded, pairs = np.polynomial.legendre.leggauss(count)[0], []
    with mp.workdps(30):
        for x in map(mpf, rounded.tolist()):
            for _ in range(2):
                before, value = mpf(1), x
                for k in range(2, count + 1):
                    before, value = value, ((2 * k - 1) * x * value - (k - 1) * before) / k
                slope = count * (x * value - before) / (x * x - 1)
                x -= value / slope
            pairs.append((float(x), float(2 / ((1 - x * x) * slope**2))))
    return np.array(pairs).T


NODES, WEIGHTS = rule(90)


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, sky = scene["film"], scene["light"][0]
    overcast = "sky" in sky
    scale = sky["zenith_radiance"] / 3 if overcast else sky["radiance"]
    boards = [np.array(surface["shape"]["vertices"]) for surface in scene["surface"]]
    whole = 7 * np.pi / 3 if overcast else np.pi
    return [float(scale * (whole - sum(taken(board, film, element, overcast) for board in boards))) for element in elements]


def taken(board, film, element, overcast):
    """What a board takes from the mean over a cell, per scale [sr]."""
    (columns, rows), (row, column) = film["resolution"], divmod(element, film["resolution"][0])
    x, wx = displaced(board[:, 0], film["origin"][0], film["u"][0] / columns, column)
    y, wy = displaced(board[:, 1], film["origin"][1], film["v"][1] / rows, row)
    height = board[0, 2] - film["origin"][2]
    square = height**2 + x[:, None] ** 2 + y**2
    kernel = height**2 / square**2
    return wx @ (kernel * (1 + 2 * height / np.sqrt(square)) if overcast else kernel) @ wy


def displaced(corners, origin, width, index):
    """Nodes (n,) from a cell to an interval along one axis, weighted with the share of the cell from which they lead there."""
    low, high, start = corners.min(), corners.max(), origin + index * width
    ends = np.sort([low - start - width, low - start, high - start - width, high - start])
    x = ((ends[1:] + ends[:-1])[:, None] + (ends[1:] - ends[:-1])[:, None] * NODES).ravel() / 2
    share = np.minimum(high, x + start + width) - np.maximum(low, x + start)
    return x, ((ends[1:] - ends[:-1])[:, None] / 2 * WEIGHTS).ravel() * share / width


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/roof-opening.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
