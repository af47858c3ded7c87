"""Second derivation for triangle-light: the area form, light and cell summed by Gauss rules.

E = integral over the light of L cos cos / r^2 dA, averaged over the cell: a 20 x 20 rule on the triangle (collapsed from a
square) times a 10 x 10 rule on the cell, in binary64; the integrand is positive and smooth. Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path

import numpy as np

ON_LIGHT, ON_CELL = 20, 10


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, lamp = scene["film"], scene["light"][0]
    points, weights, normal = triangle(np.array(lamp["shape"]["vertices"]))
    u, v = np.array(film["u"]), np.array(film["v"])
    receiving = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    means = []
    for element in elements:
        x, share = cell(film, element)
        rays = points[None] - x[:, None]
        squared = (rays**2).sum(-1)
        cosines = np.maximum(rays @ receiving, 0) * np.maximum(-rays @ normal, 0)
        means.append(float(share @ (cosines / squared**2) @ weights * lamp["radiance"]))
    return means


def triangle(corners):
    """Points (400, 3), their areas (400,) and the unit normal of a triangle."""
    nodes, weights = unit_rule(ON_LIGHT)
    spokes = corners[1:] - corners[0]
    area_vector = np.cross(*spokes)
    s, t = (axis.ravel() for axis in np.meshgrid(nodes, nodes, indexing="ij"))
    points = corners[0] + (s * (1 - t))[:, None] * spokes[0] + (s * t)[:, None] * spokes[1]
    area = np.linalg.norm(area_vector)
    return points, np.outer(weights, weights).ravel() * s * area, area_vector / area


def cell(film, element):
    """Points (100, 3) of a cell and their shares of its area (100,)."""
    nodes, weights = unit_rule(ON_CELL)
    columns, rows = film["resolution"]
    row, column = divmod(element, columns)
    p, q = np.meshgrid((column + nodes) / columns, (row + nodes) / rows, indexing="ij")
    points = np.array(film["origin"]) + p.reshape(-1, 1) * np.array(film["u"]) + q.reshape(-1, 1) * np.array(film["v"])
    return points, np.outer(weights, weights).ravel()


def unit_rule(count):
    """Nodes and weights of the Gauss-Legendre rule on [0, 1]."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (1 + nodes) / 2, weights / 2


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/triangle-light.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
