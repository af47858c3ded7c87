"""Second derivation for sphere-light: the cone in which the sphere is seen, summed ring by ring about its axis.

In the ring at angle b from the direction to the centre, itself t from the receiver's normal, a direction at azimuth f has
cosine cos(t) cos(b) + sin(t) sin(b) cos(f); what lies under the horizon is left out. The azimuth is elementary; Gauss rules
do b (40 nodes, split where the horizon begins to cut, where a square root asks for a square) and the cell (12 x 12), in
binary64. Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path

import numpy as np

RINGS, ON_CELL = 40, 12


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, lamp = scene["film"], scene["light"][0]
    normal = np.cross(film["u"], film["v"])
    normal /= np.linalg.norm(normal)
    means = []
    for element in elements:
        x, share = cell(film, element)
        rays = np.array(lamp["shape"]["center"]) - x
        distance = np.linalg.norm(rays, axis=-1)
        half_angle = np.arcsin(lamp["shape"]["radius"] / distance)
        elevation = np.arcsin(rays @ normal / distance)
        means.append(float(lamp["radiance"] * share @ cone(elevation, half_angle)))
    return means


def cone(elevation, half_angle):
    """Projected solid angle [sr] of cones whose axes stand at an elevation above the horizon, (n,); what is below is cut."""
    rise = np.minimum(np.abs(elevation), half_angle)
    nodes, weights = unit_rule(RINGS)
    inner = rise[:, None] * nodes
    whole = 2 * np.pi * np.sin(elevation)[:, None] * np.cos(inner) * np.sin(inner) @ weights * rise
    outer = rise[:, None] + (half_angle - rise)[:, None] * nodes**2
    rings = ring(elevation[:, None], outer) * np.sin(outer) * 2 * nodes
    return np.where(elevation > 0, whole, 0) + rings @ weights * (half_angle - rise)


def ring(elevation, b):
    """The integral over the azimuth of the cosine, where it is positive: from -end to end."""
    up, across = np.sin(elevation) * np.cos(b), np.cos(elevation) * np.sin(b)
    end = np.arccos(np.clip(-up / across, -1, 1))
    return 2 * (end * up + np.sin(end) * across)


def cell(film, element):
    """Points (144, 3) of a cell and their shares of its area (144,)."""
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
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/sphere-light.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
