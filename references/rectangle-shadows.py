"""Second derivation for rectangles that shade one another: the flux from light to cell in closed form, no quadrature.

Light, blockers and cell are level and their sides parallel, so a blocker's shadow on the light's plane is a rectangle, and so
is what it hides of the light, and what several hide together: inclusion and exclusion add them up. Seen from the receiver,
sides move as linear functions of the receiver's coordinates: against it where they are the light's, (light's height /
blocker's) times as fast where they are a shadow's. Four corner terms give an irradiance, so 4 x 4 terms of their
antiderivative give a flux (Howell's catalogue: rectangle to parallel rectangle). Cells are cut where one side is in line with
another; 30 digits. A point that sees nothing of the light receives nothing. Prints the base cases as JSON.
"""

import json
import tomllib
from collections import namedtuple
from itertools import combinations, pairwise
from math import prod
from pathlib import Path

from mpmath import atan, log, mp, mpf, sqrt

mp.dps = 30
SCENES = ("occluded-square", "knife-edge", "two-blockers", "l-shaped-blocker", "picket-fence", "contact-shadow", "umbra")
Box = namedtuple("Box", "x y z")  # a level rectangle: (x0, x1), (y0, y1) and z


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, (lamp,) = scene["film"], scene["light"]
    (light,), blockers = boxes(lamp["shape"]), [box for surface in scene["surface"] for box in boxes(surface["shape"])]
    if film["kind"] == "points":
        return [dark(film["positions"][element], light, blockers) for element in elements]
    assert film["u"][1:] == [0, 0] and film["v"][::2] == [0, 0] and film["u"][0] > 0 and film["v"][1] > 0
    return [float(mpf(lamp["radiance"]) * mean(cell(film, element), light, blockers)) for element in elements]


def cell(film, element):
    """A cell of the film as a box."""
    row, column = divmod(element, film["resolution"][0])
    x = span(film["origin"][0], film["u"][0], column, film["resolution"][0])
    return Box(x, span(film["origin"][1], film["v"][1], row, film["resolution"][1]), mpf(film["origin"][2]))


def mean(floor, light, blockers):
    """Mean irradiance per radiance [sr] over a cell."""
    height = light.z - floor.z
    flux = exchange(whole(floor.x, light.x), whole(floor.y, light.y), height)
    for sign, shadows in together(floor, light, blockers):
        for across in hidden(floor.x, light.x, [(box.x, scale) for box, scale in shadows]):
            for along in hidden(floor.y, light.y, [(box.y, scale) for box, scale in shadows]):
                flux -= sign * exchange(across, along, height)
    return flux / ((floor.x[1] - floor.x[0]) * (floor.y[1] - floor.y[0]))


def together(floor, light, blockers):
    """Sets of blockers, each with the scale of its shadow, that may hide the same part of the light, with alternating signs."""
    shadows = [(box, (light.z - floor.z) / (box.z - floor.z)) for box in blockers]
    assert all(scale > 1 for _, scale in shadows)
    sets = [()]
    for shadow in shadows:
        sets += [(*before, shadow) for before in sets if overlap(floor, light, (*before, shadow))]
    return [((-1) ** (len(some) + 1), some) for some in sets[1:]]


def overlap(floor, light, shadows):
    """Whether from somewhere in the cell some shadows share a part of the light."""
    return all(hidden(floor[axis], light[axis], [(box[axis], scale) for box, scale in shadows]) for axis in (0, 1))


def dark(position, light, blockers):
    """0 for a receiver from which the blockers hide all of the light; others are not covered here."""
    x, y, z = map(mpf, position)
    sides = [[shade((low, high), at, (light.z - z) / (box.z - z), span) for low, high, at, span in (
        (*box.x, x, light.x), (*box.y, y, light.y))] for box in blockers]
    area = 0
    for count in range(len(sides) + 1):
        for some in combinations(sides, count):
            shared = [(max(s[i][0] for s in (*some, light)), min(s[i][1] for s in (*some, light))) for i in (0, 1)]
            area += (-1) ** count * prod(max(high - low, mpf(0)) for low, high in shared)
    assert area == 0
    return 0.0


def shade(blocker, x, scale, light):
    """A shadow on the light's plane along one axis, as far as the light reaches."""
    return [min(max(x + (edge - x) * scale, light[0]), light[1]) for edge in blocker]


def boxes(shape):
    """Level rectangles that tile a level polygon whose sides run along x and y."""
    corners = [tuple(map(mpf, corner)) for corner in shape["vertices"]]
    edges = list(zip(corners, corners[1:] + corners[:1], strict=True))
    assert len({z for _, _, z in corners}) == 1 and all((a[0] == b[0]) != (a[1] == b[1]) for a, b in edges)
    found = []
    for x0, x1 in pairwise(sorted({x for x, _, _ in corners})):
        crossed = sorted(a[1] for a, b in edges if min(a[0], b[0]) <= x0 and x1 <= max(a[0], b[0]))
        found += [Box((x0, x1), side, corners[0][2]) for side in zip(crossed[::2], crossed[1::2], strict=True)]
    return found


def span(origin, length, index, count):
    """Where a cell begins and ends along one side of the film."""
    return [mpf(origin) + mpf(length) * i / count for i in (index, index + 1)]


def whole(cell, light):
    """Terms of the whole light, along one axis."""
    return terms(cell, *([side - x for x in cell] for side in light))


def hidden(cell, light, shadows):
    """Terms of what some blockers hide together of the light, along one axis, for each piece of a cell over which its sides
    move linearly; of each blocker are given its two edges and the scale of its shadow."""
    lines = [(edge * scale, 1 - scale) for edges, scale in shadows for edge in edges] + [(side, 0) for side in light]
    events = {(b - a) / (p - q) for (a, p), (b, q) in combinations(lines, 2) if p != q}
    stops = [cell[0], *sorted(event for event in events if cell[0] < event < cell[1]), cell[1]]

    def sides(x):
        seen = [shade(edges, x, scale, light) for edges, scale in shadows]
        return max(low for low, _ in seen), min(high for _, high in seen)

    pieces = [(piece, *zip(*map(sides, piece), strict=True)) for piece in pairwise(stops)]
    return [terms(piece, *([side - x for side, x in zip(ends, piece, strict=True)] for ends in (low, high)))
            for piece, low, high in pieces if sum(high) > sum(low)]


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
