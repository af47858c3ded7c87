"""Second derivation for occluded-square: light less the part of it behind the blocker, both rectangles under corner formulas.

Light, blocker and film are level and their sides parallel: from the floor the blocker's shadow on the light's plane is a
rectangle, and what it hides of the light is one too. A receiver under the corner of a parallel rectangle has a closed form
(Howell's catalogue). A cell is split where an edge of the light is seen on an edge of the blocker, and each part averaged
by a 16 x 16 Gauss rule in binary64. Prints the base case as JSON.
"""

import json
import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, lamp = scene["film"], scene["light"][0]
    light, blocker = (box(thing["shape"]) for thing in (lamp, scene["surface"][0]))
    assert film["u"][1:] == [0, 0] and film["v"][::2] == [0, 0] and film["u"][0] > 0 and film["v"][1] > 0
    heights = [z - film["origin"][2] for _, _, z in (blocker, light)]
    columns, rows = film["resolution"]
    return [
        lamp["radiance"] * mean(
            span(film["origin"][0], film["u"][0], element % columns, columns),
            span(film["origin"][1], film["v"][1], element // columns, rows),
            light, blocker, heights)
        for element in elements
    ]


def box(shape):
    """(x0, x1), (y0, y1) and z of a level rectangle."""
    corners = np.array(shape["vertices"])
    (x0, y0, z0), (x1, y1, z1) = corners.min(axis=0), corners.max(axis=0)
    assert z0 == z1 and {tuple(corner[:2]) for corner in corners.tolist()} == {(x, y) for x in (x0, x1) for y in (y0, y1)}
    return (x0, x1), (y0, y1), z0


def span(origin, length, index, count):
    """Where a cell begins and ends along one side of the film."""
    return origin + length * index / count, origin + length * (index + 1) / count


def mean(x_span, y_span, light, blocker, heights):
    """Mean irradiance per radiance [sr] over a cell."""
    total = 0.0
    for x, x_weights in pieces(x_span, light[0], blocker[0], heights):
        for y, y_weights in pieces(y_span, light[1], blocker[1], heights):
            total += x_weights @ seen(x[:, None], y[None, :], light, blocker, heights) @ y_weights
    return float(total / ((x_span[1] - x_span[0]) * (y_span[1] - y_span[0])))


def pieces(cell, light, blocker, heights):
    """Gauss nodes and weights between the places where an edge of the light is in line with one of the blocker."""
    low, high = heights
    events = [edge + (edge - end) * low / (high - low) for edge in blocker for end in light]
    stops = [cell[0], *sorted(event for event in events if cell[0] < event < cell[1]), cell[1]]
    return [((a + b) / 2 + (b - a) / 2 * NODES, (b - a) / 2 * WEIGHTS) for a, b in pairwise(stops)]


def seen(x, y, light, blocker, heights):
    """Irradiance per radiance [sr] at (x, y) from the part of the light that the blocker leaves."""
    scale = heights[1] / heights[0]
    open_sides, hidden_sides = [], []
    for here, sides, shadow in ((x, light[0], blocker[0]), (y, light[1], blocker[1])):
        low, high = (np.clip(here + (edge - here) * scale, *sides) for edge in shadow)
        open_sides += [sides[0] - here, sides[1] - here]
        hidden_sides += [low - here, high - here]
    return rectangle(*open_sides, heights[1]) - rectangle(*hidden_sides, heights[1])


def rectangle(x0, x1, y0, y1, h):
    """Irradiance per radiance [sr] under a parallel rectangle from (x0, y0) to (x1, y1), h above the receiver."""
    return corner(x1, y1, h) - corner(x0, y1, h) - corner(x1, y0, h) + corner(x0, y0, h)


def corner(a, b, h):
    """Irradiance per radiance [sr] under the corner of an a x b rectangle, odd in a and in b."""
    r, s = np.hypot(a, h), np.hypot(b, h)
    return (a / r * np.arctan(b / r) + b / s * np.arctan(a / s)) / 2


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/occluded-square.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
