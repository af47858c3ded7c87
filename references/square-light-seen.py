"""Second derivation for square-light-seen: four corner formulas for the floor under a rectangle, averaged over each pixel.

A receiver under the corner of a parallel a x b rectangle, at distance h, gets E = pi L F, F the corner form factor (Howell's
catalogue); a rectangle anywhere above is a sum and difference of four. Pixels by a 12 x 12 Gauss rule in 30 digits; 24 x 24
gives the same binary64. The lamp is above the camera and the floor fills the picture. Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path

from mpmath import atan, mp, mpf, pi, radians, sqrt, tan
from mpmath.calculus.quadrature import GaussLegendre

mp.dps = 30
RULE = GaussLegendre(mp).calc_nodes(3, mp.prec)  # 12 nodes and weights on [-1, 1]


def values(scene, elements):
    """Mean radiance [W/(m2 sr)] of the film's elements; `scene` is the table of a scene file."""
    film, (lamp,), (floor,) = scene["film"], scene["light"], scene["surface"]
    x, y, (z,) = (sorted({mpf(number) for number in column}) for column in zip(*lamp["shape"]["vertices"], strict=True))
    (level,) = {mpf(corner[2]) for corner in floor["shape"]["vertices"]}
    assert z > film["origin"][2] > level, "the lamp is level and above the camera"
    columns = film["resolution"][0]
    hit = camera(film, level)
    means = []
    for element in elements:
        row, column = divmod(element, columns)
        total = mpf(0)
        for s, share in RULE:
            for t, part in RULE:
                at = hit(column + (1 + s) / 2, row + (1 + t) / 2)
                total += share * part / 4 * rectangle([side - at[0] for side in x], [side - at[1] for side in y], z - level)
        means.append(float(floor["reflectance"] / pi * lamp["radiance"] * total))
    return means


def rectangle(across, along, h):
    """Irradiance per radiance [sr] under a parallel rectangle between offsets from the receiver, h above it."""
    (x0, x1), (y0, y1) = across, along
    return corner(x1, y1, h) - corner(x0, y1, h) - corner(x1, y0, h) + corner(x0, y0, h)


def corner(a, b, h):
    """Irradiance per radiance [sr] under the corner of an a x b rectangle, odd in a and in b."""
    r, s = sqrt(a * a + h * h), sqrt(b * b + h * h)
    return (a / r * atan(b / r) + b / s * atan(a / s)) / 2


def camera(film, level):
    """Where on the floor, (x, y), a place of the picture is, given in pixels from its top left corner."""
    origin = [mpf(number) for number in film["origin"]]
    forward = unit([mpf(target) - here for target, here in zip(film["target"], origin, strict=True)])
    right = unit(cross(forward, film["up"]))
    up, half, (columns, rows) = cross(right, forward), tan(radians(film["fov"]) / 2), film["resolution"]

    def hit(column, row):
        x, y = half * (2 * column - columns) / columns, half * (rows - 2 * row) / columns
        ray = [a + x * b + y * c for a, b, c in zip(forward, right, up, strict=True)]
        assert ray[2] < 0, "every pixel sees the floor"
        reach = (level - origin[2]) / ray[2]
        return origin[0] + reach * ray[0], origin[1] + reach * ray[1]

    return hit


def unit(a):
    return [x / sqrt(sum(y * y for y in a)) for x in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/square-light-seen.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
