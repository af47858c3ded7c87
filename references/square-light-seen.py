"""Second derivation for square-light-seen: four corner formulas for the floor under a rectangle, averaged over each pixel.

A receiver under the corner of a parallel a x b rectangle, at distance h, gets E = pi L F, F the corner form factor (Howell's
catalogue); a rectangle anywhere above is a sum and difference of four. Pixels by a 16 x 16 Gauss rule in binary64. The lamp
is above the camera and the floor fills the picture, so every pixel sees floor. Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)


def values(scene, elements):
    """Mean radiance [W/(m2 sr)] of the film's elements; `scene` is the table of a scene file."""
    film, lamp, floor = scene["film"], scene["light"][0], scene["surface"][0]
    corners = np.array(lamp["shape"]["vertices"])
    (x0, y0, z0), (x1, y1, z1) = corners.min(axis=0), corners.max(axis=0)
    level = floor["shape"]["vertices"][0][2]
    assert z0 == z1 > film["origin"][2] > level, "the lamp is level and above the camera"
    means = []
    for element in elements:
        x, y = hits(film, element, level)
        irradiance = lamp["radiance"] * rectangle(x0 - x, x1 - x, y0 - y, y1 - y, z0 - level)
        means.append(float(floor["reflectance"] / np.pi * (WEIGHTS @ irradiance @ WEIGHTS) / 4))
    return means


def rectangle(x0, x1, y0, y1, h):
    """Irradiance per radiance [sr] under a parallel rectangle from (x0, y0) to (x1, y1), h above the receiver."""
    return corner(x1, y1, h) - corner(x0, y1, h) - corner(x1, y0, h) + corner(x0, y0, h)


def corner(a, b, h):
    """Irradiance per radiance [sr] under the corner of an a x b rectangle, odd in a and in b."""
    r, s = np.hypot(a, h), np.hypot(b, h)
    return (a / r * np.arctan(b / r) + b / s * np.arctan(a / s)) / 2


def hits(film, element, level):
    """x and y, (16, 16) each, where the rays through a pixel's nodes meet the floor."""
    origin, (columns, rows) = np.array(film["origin"]), film["resolution"]
    forward = np.subtract(film["target"], origin)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, film["up"])
    right /= np.linalg.norm(right)
    up, half = np.cross(right, forward), np.tan(np.radians(film["fov"]) / 2)
    row, column = divmod(element, columns)
    x = half * (2 * (column + (1 + NODES) / 2) / columns - 1)
    y = half * (rows - 2 * (row + (1 - NODES) / 2)) / columns
    rays = forward + x[:, None, None] * right + y[None, :, None] * up
    reach = (level - origin[2]) / rays[..., 2]
    assert (reach > 0).all(), "every pixel sees the floor"
    return origin[0] + reach * rays[..., 0], origin[1] + reach * rays[..., 1]


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/square-light-seen.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
