"""Second derivation for disk-light: the area form on the disk for cells, the textbook's parallel disk for points.

Cells: E = integral over the disk of L cos cos / r^2 dA in polar coordinates, Gauss in the radius (20) and equal angles (64),
times a 10 x 10 Gauss rule on the cell, in binary64; the integrand is positive and smooth. Points: the closed form in 30
digits; behind the horizon's cut, row by row as in round-shadows.py. Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path
from runpy import run_path

import numpy as np
from mpmath import mp, mpf, pi, sqrt

mp.dps = 30
RADII, ANGLES, ON_CELL = 20, 64, 10


def values(scene, elements):
    """Irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, lamp = scene["film"], scene["light"][0]
    if film["kind"] == "points" and any(normal != [0, 0, 1] for normal in film["normals"]):
        return run_path(str(Path(__file__).with_name("round-shadows.py")))["values"](scene, elements)
    if film["kind"] == "points":
        return [float(parallel(lamp, film["positions"][element], film["normals"][element])) for element in elements]
    points, weights, normal = disk(lamp["shape"])
    receiving = np.cross(film["u"], film["v"])
    receiving /= np.linalg.norm(receiving)
    means = []
    for element in elements:
        x, share = cell(film, element)
        rays = points[None] - x[:, None]
        cosines = np.maximum(rays @ receiving, 0) * np.maximum(-rays @ normal, 0)
        means.append(float(share @ (cosines / (rays**2).sum(-1) ** 2) @ weights * lamp["radiance"]))
    return means


def parallel(lamp, position, normal):
    """Irradiance at a point that faces a disk straight on: (pi L/2) (1 - (h2 + a2 - r2) / sqrt((h2 + a2 + r2)^2 - 4 r2 a2))."""
    assert list(normal) == [0, 0, 1] and list(lamp["shape"]["normal"]) == [0, 0, -1], "the closed form is for a parallel disk"
    x, y, z = (mpf(a) - mpf(b) for a, b in zip(lamp["shape"]["center"], position, strict=True))
    a2, h2, r2 = x * x + y * y, z * z, mpf(lamp["shape"]["radius"]) ** 2
    return pi * mpf(lamp["radiance"]) / 2 * (1 - (h2 + a2 - r2) / sqrt((h2 + a2 + r2) ** 2 - 4 * r2 * a2))


def disk(shape):
    """Points (1280, 3), their areas (1280,) and the unit normal of a disk."""
    normal = np.array(shape["normal"]) / np.linalg.norm(shape["normal"])
    across = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    across /= np.linalg.norm(across)
    nodes, weights = unit_rule(RADII)
    angles = 2 * np.pi * np.arange(ANGLES) / ANGLES
    directions = np.cos(angles)[:, None] * across + np.sin(angles)[:, None] * np.cross(normal, across)
    radius = shape["radius"] * nodes
    points = np.array(shape["center"]) + radius[:, None, None] * directions
    areas = np.repeat(2 * np.pi / ANGLES * radius * weights * shape["radius"], ANGLES)
    return points.reshape(-1, 3), areas, normal


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
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/disk-light.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
