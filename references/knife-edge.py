"""Second derivation for knife-edge: the blade cuts the lamp's rectangle along one straight line, the rest is a corner formula.

From the floor the blade's near edge is seen on the lamp's plane as the line x = edge + (edge - x) (H - h)/h; what lies beyond
it is hidden, for the blade's other edges are out of sight. A receiver under the corner of a parallel rectangle has a closed
form (Howell's catalogue). A cell is split where an edge of the lamp is seen on the blade's, and each part averaged by a
16 x 16 Gauss rule in binary64. Prints the base case as JSON.
"""

import json
import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, lamp, blade = scene["film"], scene["light"][0], np.array(scene["surface"][0]["shape"]["vertices"])
    corners = np.array(lamp["shape"]["vertices"])
    (x0, y0, level), (x1, y1, height) = corners.min(axis=0), corners.max(axis=0)
    edge, low = blade[:, 0].min(), blade[0, 2]
    assert film["u"][1:] == [0, 0] and film["v"][::2] == [0, 0] and film["origin"][2] == 0 and level == height
    check_out_of_sight(film, blade, (x1, y0, y1), low / height)
    columns, rows = film["resolution"]
    means = []
    for element in elements:
        row, column = divmod(element, columns)
        left, right = (film["origin"][0] + film["u"][0] * (column + i) / columns for i in (0, 1))
        near, far = (film["origin"][1] + film["v"][1] * (row + i) / rows for i in (0, 1))
        events = sorted(edge + (edge - end) * low / (height - low) for end in (x0, x1))
        stops = [left, *(event for event in events if left < event < right), right]
        flux = sum(strip(a, b, near, far, (x0, x1, y0, y1), (edge, low), height) for a, b in pairwise(stops))
        means.append(float(lamp["radiance"] * flux / ((right - left) * (far - near))))
    return means


def check_out_of_sight(film, blade, lamp, share):
    """No ray from the film to the lamp passes beyond the blade's far ends, `share` of the way up."""
    x1, y0, y1 = lamp
    lows = np.array(film["origin"][:2])
    highs = lows + np.array([film["u"][0], film["v"][1]])
    assert highs[0] + (x1 - highs[0]) * share < blade[:, 0].max()
    assert highs[1] + (y1 - highs[1]) * share < blade[:, 1].max() and lows[1] + (y0 - lows[1]) * share > blade[:, 1].min()


def strip(a, b, near, far, lamp, blade, height):
    """The integral of irradiance per radiance over a rectangle of the floor in which the lamp is seen in one way."""
    x, y = ((low + high) / 2 + (high - low) / 2 * NODES for low, high in ((a, b), (near, far)))
    x0, x1, y0, y1 = lamp
    edge, low = blade
    line = np.clip(edge + (edge - x) * (height - low) / low, x0, x1)
    seen = rectangle(x0 - x[:, None], (line - x)[:, None], y0 - y, y1 - y, height)
    return (b - a) * (far - near) / 4 * (WEIGHTS @ seen @ WEIGHTS)


def rectangle(x0, x1, y0, y1, h):
    """Irradiance per radiance [sr] under a parallel rectangle from (x0, y0) to (x1, y1), h above the receiver."""
    return corner(x1, y1, h) - corner(x0, y1, h) - corner(x1, y0, h) + corner(x0, y0, h)


def corner(a, b, h):
    """Irradiance per radiance [sr] under the corner of an a x b rectangle, odd in a and in b."""
    r, s = np.hypot(a, h), np.hypot(b, h)
    return (a / r * np.arctan(b / r) + b / s * np.arctan(a / s)) / 2


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/knife-edge.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
