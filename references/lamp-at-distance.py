"""Second derivation for lamp-at-distance: the lamp's outline on the film, and what area of it a pixel holds, strip by strip.

The lamp's corners are projected through the pinhole. From one row of the film to the next the pixel and the convex outline
share an interval, whose length is linear between the heights of the outline's corners and those at which it crosses the
pixel's left and right side: between them the area is a trapezoid. All in 30 digits. Prints the base case as JSON.
"""

import json
import tomllib
from itertools import pairwise
from pathlib import Path

from mpmath import mp, mpf, pi, sqrt, tan

mp.dps = 30


def values(scene, elements):
    """Mean radiance [W/(m2 sr)] of the film's elements; `scene` is the table of a scene file."""
    film, lamp = scene["film"], scene["light"][0]
    columns = film["resolution"][0]
    corners = [[mpf(x) for x in corner] for corner in lamp["shape"]["vertices"]]
    if behind(corners, film["origin"]):
        return [0.0] * len(elements)
    outline = [pixel_units(film, corner) for corner in corners]
    return [float(mpf(lamp["radiance"]) * shared(outline, element % columns, element // columns)) for element in elements]


def behind(corners, eye):
    """Whether the eye is on the side of a polygon from which its corners run clockwise."""
    a, b, c = corners[:3]
    normal = cross(minus(b, a), minus(c, b))
    return dot(normal, minus(eye, a)) < 0


def pixel_units(film, corner):
    """Where the camera sees a corner, in pixels from the film's upper left corner: right and down."""
    columns, rows = film["resolution"]
    forward = unit(minus(film["target"], film["origin"]))
    right = unit(cross(forward, film["up"]))
    down = cross(forward, right)
    ray = minus(corner, film["origin"])
    scale = columns / 2 / tan(pi * mpf(film["fov"]) / 360) / dot(ray, forward)
    return mpf(columns) / 2 + scale * dot(ray, right), mpf(rows) / 2 + scale * dot(ray, down)


def shared(outline, column, row):
    """The area that a convex outline and a pixel share."""
    stops = {mpf(row), mpf(row + 1), *(y for _, y in outline)}
    for (x0, y0), (x1, y1) in zip(outline, outline[1:] + outline[:1], strict=True):
        stops |= {y0 + (y1 - y0) * (side - x0) / (x1 - x0) for side in (column, column + 1) if min(x0, x1) < side < max(x0, x1)}
    inside = sorted(stop for stop in stops if row <= stop <= row + 1)
    return sum((width(outline, column, (a + b) / 2) * (b - a) for a, b in pairwise(inside)), mpf(0))


def width(outline, column, y):
    """The length of a row of the film that a convex outline and a column of pixels share: at y half way it is a strip's mean."""
    ends = zip(outline, outline[1:] + outline[:1], strict=True)
    crossings = [x0 + (x1 - x0) * (y - y0) / (y1 - y0) for (x0, y0), (x1, y1) in ends if (y0 < y) != (y1 < y)]
    if not crossings:
        return mpf(0)
    return max(mpf(0), min(max(crossings), column + 1) - max(min(crossings), column))


def minus(a, b):
    return [mpf(x) - mpf(y) for x, y in zip(a, b, strict=True)]


def dot(a, b):
    return sum(mpf(x) * mpf(y) for x, y in zip(a, b, strict=True))


def cross(a, b):
    return [mpf(a[i - 2]) * mpf(b[i - 1]) - mpf(a[i - 1]) * mpf(b[i - 2]) for i in range(3)]


def unit(a):
    length = sqrt(dot(a, a))
    return [x / length for x in a]


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/lamp-at-distance.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
