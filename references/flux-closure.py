"""Second derivation for flux-closure: what a light sends to a cell, counted where it leaves.

From a point light the flux to a cell is its intensity times the cell's solid angle (Van Oosterom and Strackee 1983); a sphere
lights a plane that it stands above as a point of intensity pi R^2 L in its centre does. A flat light's flux is the integral over
the light of L times the cell's projected solid angle, by Lambert's sum around the part of the cell in front of the light: a
Gauss rule on triangles, or on rings with equal steps around; the walls are far enough for 1e-15. In binary64. Prints the base
case as JSON.
"""

import json
import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(28)
NODES, WEIGHTS = (1 + NODES) / 2, WEIGHTS / 2
AROUND = 96


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    (light,), film = scene["light"], scene["film"]
    columns, rows = film["resolution"]
    area = np.linalg.norm(np.cross(film["u"], film["v"])) / (columns * rows)
    return [float(flux(light, cell(film, element)) / area) for element in elements]


def cell(film, element):
    """The corners of a cell (4, 3)."""
    columns, rows = film["resolution"]
    row, column = divmod(element, columns)
    places = np.array([[column, row], [column + 1, row], [column + 1, row + 1], [column, row + 1]]) / [columns, rows]
    return np.array(film["origin"]) + places @ [film["u"], film["v"]]


def flux(light, corners):
    """Flux [W] from a light to a cell."""
    if light["kind"] == "point":
        return light["intensity"] * solid_angle(corners - light["position"])
    shape = light["shape"]
    if shape["type"] == "sphere":
        return light["radiance"] * np.pi * shape["radius"] ** 2 * solid_angle(corners - shape["center"])
    y, areas, normal = (on_disk if shape["type"] == "disk" else on_polygon)(shape)
    seen = in_front(corners, (corners - y.mean(axis=0)) @ normal)
    return light["radiance"] * areas @ projected(seen - y[:, None], normal) if len(seen) else 0.0


def solid_angle(rays):
    """Solid angle [sr] of a convex polygon (k, 3) around the origin's view."""
    total = 0.0
    for b, c in pairwise(rays[1:]):
        a, lengths = rays[0], [np.linalg.norm(ray) for ray in (rays[0], b, c)]
        below = np.prod(lengths) + a @ b * lengths[2] + b @ c * lengths[0] + c @ a * lengths[1]
        total += 2 * np.arctan2(abs(a @ np.cross(b, c)), below)
    return total


def projected(rays, normal):
    """Projected solid angle [sr] of convex polygons (n, k, 3), seen from as many points of a plane, by Lambert's sum."""
    ends = np.roll(rays, -1, axis=1)
    across = np.cross(rays, ends)
    length = np.linalg.norm(across, axis=-1)
    return abs((np.arctan2(length, (rays * ends).sum(-1)) * (across @ normal) / length).sum(-1)) / 2


def in_front(corners, heights):
    """The part of a polygon where heights, interpolated, are positive."""
    kept = []
    for i, (corner, height) in enumerate(zip(corners, heights, strict=True)):
        if height * heights[i - 1] < 0:
            share = heights[i - 1] / (heights[i - 1] - height)
            kept.append(corners[i - 1] + (corner - corners[i - 1]) * share)
        if height >= 0:
            kept.append(corner)
    return np.array(kept)


def on_polygon(shape):
    """Points (n, 3), their areas (n,) and the unit normal of a convex polygon."""
    corners = np.array(shape["vertices"])
    s, t = (axis.ravel() for axis in np.meshgrid(NODES, NODES, indexing="ij"))
    weights, points, areas = np.outer(WEIGHTS, WEIGHTS).ravel(), [], []
    for b, c in pairwise(corners[1:]):
        front = np.cross(b - corners[0], c - b)
        points.append(corners[0] + s[:, None] * (b - corners[0]) + (s * t)[:, None] * (c - b))
        areas.append(weights * s * np.linalg.norm(front))
    return np.concatenate(points), np.concatenate(areas), front / np.linalg.norm(front)


def on_disk(shape):
    """Points (n, 3), their areas (n,) and the unit normal of a disk."""
    normal = np.array(shape["normal"]) / np.linalg.norm(shape["normal"])
    x = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    x /= np.linalg.norm(x)
    turn = 2 * np.pi * np.arange(AROUND) / AROUND
    ring = np.outer(np.cos(turn), x) + np.outer(np.sin(turn), np.cross(normal, x))
    points = shape["center"] + shape["radius"] * (NODES[:, None, None] * ring).reshape(-1, 3)
    areas = np.repeat(WEIGHTS * NODES, AROUND) * 2 * np.pi * shape["radius"] ** 2 / AROUND
    return points, areas, normal


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/flux-closure.toml").read_text(encoding="utf-8"))
    print(json.dumps({"base": dict(enumerate(values(scene, range(4))))}))
