"""Second derivation for rectangles that shade one another: the flux from light to cell in closed form, no quadrature.

Light, blocker and cell are level and their sides parallel, so the blocker's shadow on the light's plane is a rectangle, and
so is what it hides of the light. Seen from the receiver, its sides move as linear functions of the receiver's coordinates:
against it where they are the light's, (light's height / blocker's) times as fast where they are the shadow's. Four corner
terms give an irradiance, so 4 x 4 terms of their antiderivative give a flux (Howell's catalogue: rectangle to parallel
rectangle). Cells are cut where a side of the light is in line with one of the blocker; 30 digits. Prints the base cases as JSON.
"""

import json
import tomllib
from itertools import pairwise
from pathlib import Path

from mpmath import atan, log, mp, mpf, sqrt

mp.dps = 30
SCENES = ("occluded-square", "knife-edge")


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, (lamp,), (surface,) = scene["film"], scene["light"], scene["surface"]
    light, blocker = box(lamp["shape"]), box(surface["shape"])
    assert film["u"][1:] == [0, 0] and film["v"][::2] == [0, 0] and film["u"][0] > 0 and film["v"][1] > 0
    low, high = (z - mpf(film["origin"][2]) for _, _, z in (blocker, light))
    assert 0 < low < high
    columns, rows = film["resolution"]
    means = []
    for element in elements:
        row, column = divmod(element, columns)
        x = span(film["origin"][0], film["u"][0], column, columns)
        y = span(film["origin"][1], film["v"][1], row, rows)
        flux = exchange(whole(x, light[0]), whole(y, light[1]), high)
        for across in hidden(x, light[0], blocker[0], high / low):
            for along in hidden(y, light[1], blocker[1], high / low):
                flux -= exchange(across, along, high)
        means.append(float(mpf(lamp["radiance"]) * flux / ((x[1] - x[0]) * (y[1] - y[0]))))
    return means


def box(shape):
    """(x0, x1), (y0, y1) and z of a level rectangle."""
    x, y, z = (sorted({mpf(number) for number in column}) for column in zip(*shape["vertices"], strict=True))
    assert [len(x), len(y), len(z)] == [2, 2, 1] and len({tuple(corner) for corner in shape["vertices"]}) == 4
    return x, y, z[0]


def span(origin, length, index, count):
    """Where a cell begins and ends along one side of the film."""
    return [mpf(origin) + mpf(length) * i / count for i in (index, index + 1)]


def whole(cell, light):
    """Terms of the whole light, along one axis."""
    return terms(cell, *([side - x for x in cell] for side in light))


def hidden(cell, light, blocker, scale):
    """Terms of what is hidden of the light, along one axis, for each piece of a cell over which its sides move linearly."""
    events = [(edge * scale - side) / (scale - 1) for edge in blocker for side in light]
    stops = [cell[0], *sorted(event for event in events if cell[0] < event < cell[1]), cell[1]]

    def offset(edge, x):
        return min(max(x + (edge - x) * scale, light[0]), light[1]) - x

    return [terms(piece, *([offset(edge, x) for x in piece] for edge in blocker)) for piece in pairwise(stops)]


def terms(piece, low, high):
    """Weights and offsets at which an antiderivative gives the integral over a piece of receivers.

    `low` and `high` are the offsets of the two sides from the receiver at the piece's two ends, linear between.
    """
    pairs = []
    for sign, (start, end) in ((-1, low), (1, high)):
        weight = sign * (piece[1] - piece[0]) / (end - start)
        pairs += [(-weight, start), (weight, end)]
    return pairs


def exchange(across, along, height):
    """Flux per radiance [m2 sr] from the rectangles that the terms describe."""
    return sum(p * q * antiderivative(a, b, height) for p, a in across for q, b in along)


def antiderivative(a, b, h):
    """Its derivative by a and b is the irradiance per radiance under the corner of an a x b rectangle at height h."""
    r, s = sqrt(a * a + h * h), sqrt(b * b + h * h)
    return (b * r * atan(b / r) + a * s * atan(a / s) - h * h / 2 * log(a * a + s * s)) / 2


def base(name):
    """The base case of a scene."""
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / f"scenes/{name}.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    return dict(enumerate(values(scene, range(columns * rows))))


if __name__ == "__main__":
    print(json.dumps({name: base(name) for name in SCENES}))
