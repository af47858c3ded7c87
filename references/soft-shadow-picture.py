"""Second derivation for soft-shadow-picture: each pixel laid out on lamp, blocker and floor, and integrated there.

A patch dA of a level surface, h above or below the camera, takes h dA / (w . f)^3 of a film at distance 1, w being the way to
it and f forward. Lamp, blocker and floor are level rectangles with parallel sides. So is what the blocker hides of the floor
from the camera, and of the lamp from the floor; the floor is cut where these rectangles end and where an edge of the lamp is
seen on one of the blocker. In each rectangle irradiance is four corner formulas (Howell's catalogue) less four for the
shadow, and what a pixel sees of it a convex polygon: its triangles by a 16 x 16 Gauss rule in binary64. The lamp is above
the camera and the blocker below, so neither hides the other. Prints the base case as JSON.
"""

import json
import tomllib
from itertools import pairwise, product
from pathlib import Path

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
S, T = np.meshgrid((1 + NODES) / 2, (1 + NODES) / 2, indexing="ij")
DENSITY = np.outer(WEIGHTS, WEIGHTS) / 4 * S  # of the nodes in a triangle, per twice its area


def values(scene, elements):
    """Mean radiance [W/(m2 sr)] of the film's elements; `scene` is the table of a scene file."""
    lamp, surfaces = scene["light"][0], {surface["id"]: surface for surface in scene["surface"]}
    light, floor, blocker = (box(thing["shape"]) for thing in (lamp, surfaces["floor"], surfaces["blocker"]))
    camera = Camera(scene["film"])
    assert floor[2] < blocker[2] < camera.eye[2] < light[2] and scene["max_bounces"] == 1
    steps, top = list(floor_cells(floor, light, blocker, camera.eye)), surfaces["blocker"]["reflectance"]
    shade = surfaces["floor"]["reflectance"]
    means = []
    for element in elements:
        sides = camera.sides(element)
        seen = camera.integral(sides, light, lambda x, y: 1)
        lit = camera.integral(sides, blocker, lambda x, y: beneath(x, y, light, blocker[2]))
        soft = sum(camera.integral(sides, cell, lambda x, y: behind(x, y, light, blocker, floor[2])) for cell in steps)
        means.append(float(lamp["radiance"] * (seen + top / np.pi * lit + shade / np.pi * soft)))
    return means


def box(shape):
    """(x0, x1), (y0, y1) and z of a level rectangle."""
    corners = np.array(shape["vertices"])
    (x0, y0, z0), (x1, y1, z1) = corners.min(axis=0), corners.max(axis=0)
    assert z0 == z1 and {tuple(corner[:2]) for corner in corners.tolist()} == {(x, y) for x in (x0, x1) for y in (y0, y1)}
    return (x0, x1), (y0, y1), z0


def floor_cells(floor, light, blocker, eye):
    """The rectangles of the floor that the blocker does not hide from the eye and in each of which the shadow is smooth."""
    hidden = [tuple(shifted(edge, origin, eye[2], blocker[2], floor[2]) for edge in edges)
              for edges, origin in zip(blocker[:2], eye, strict=False)]
    stops = []
    for ends, edges, lamp, inner in zip(floor[:2], blocker[:2], light[:2], hidden, strict=True):
        events = [shifted(edge, end, light[2], blocker[2], floor[2]) for edge, end in product(edges, lamp)]
        stops.append(sorted({*ends, *(stop for stop in (*events, *inner) if ends[0] < stop < ends[1])}))
    for xs, ys in product(*(list(pairwise(axis)) for axis in stops)):
        if not all(inner[0] <= (a + b) / 2 <= inner[1] for inner, (a, b) in zip(hidden, (xs, ys), strict=True)):
            yield xs, ys, floor[2]


def shifted(edge, origin, top, middle, bottom):
    """Where the line from `origin` at height `top` through `edge` at height `middle` comes down to `bottom`."""
    return edge + (edge - origin) * (middle - bottom) / (top - middle)


def beneath(x, y, light, level):
    """Irradiance per radiance [sr] at a height, from all of the light."""
    return rectangle(*(end - x for end in light[0]), *(end - y for end in light[1]), light[2] - level)


def behind(x, y, light, blocker, level):
    """Irradiance per radiance [sr] at a height, from what the blocker leaves of the light."""
    scale = (light[2] - level) / (blocker[2] - level)
    sides = []
    for here, ends, edges in ((x, light[0], blocker[0]), (y, light[1], blocker[1])):
        sides += [np.clip(here + (edge - here) * scale, *ends) - here for edge in edges]
    return beneath(x, y, light, level) - rectangle(*sides, light[2] - level)


def rectangle(x0, x1, y0, y1, h):
    """Irradiance per radiance [sr] under a parallel rectangle from (x0, y0) to (x1, y1), h above the receiver."""
    return corner(x1, y1, h) - corner(x0, y1, h) - corner(x1, y0, h) + corner(x0, y0, h)


def corner(a, b, h):
    """Irradiance per radiance [sr] under the corner of an a x b rectangle, odd in a and in b."""
    r, s = np.hypot(a, h), np.hypot(b, h)
    return (a / r * np.arctan(b / r) + b / s * np.arctan(a / s)) / 2


class Camera:
    """A perspective camera, its film at distance 1."""

    def __init__(self, film):
        self.eye, (self.columns, self.rows) = np.array(film["origin"]), film["resolution"]
        self.forward = np.subtract(film["target"], self.eye)
        self.forward /= np.linalg.norm(self.forward)
        right = np.cross(self.forward, film["up"])
        self.right = right / np.linalg.norm(right)
        self.up = np.cross(self.right, self.forward)
        self.half = np.tan(np.radians(film["fov"]) / 2)

    def sides(self, element):
        """Normals (4, 3), inwards, of the planes through the eye and the sides of a pixel."""
        row, column = divmod(element, self.columns)
        x = [self.half * (2 * (column + i) - self.columns) / self.columns for i in (0, 1)]
        y = [self.half * (self.rows - 2 * (row + i)) / self.columns for i in (1, 0)]
        return np.array([self.right - x[0] * self.forward, x[1] * self.forward - self.right,
                         self.up - y[0] * self.forward, y[1] * self.forward - self.up])

    def integral(self, sides, cell, f):
        """The integral of f(x, y) over what a pixel sees of a level rectangle, per area of the pixel."""
        (x0, x1), (y0, y1), z = cell
        height = z - self.eye[2]
        polygon = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
        for side in sides:
            polygon = clipped(polygon, side[:2], side @ self.eye - side[2] * z)
        total = 0.0
        for i in range(1, len(polygon) - 1):
            a, b, c = (np.array(polygon[j]) for j in (0, i, i + 1))
            x, y = (a[k] + S * (b[k] - a[k]) + S * T * (c[k] - b[k]) for k in (0, 1))
            depth = (x - self.eye[0]) * self.forward[0] + (y - self.eye[1]) * self.forward[1] + height * self.forward[2]
            area = abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
            total += area * (DENSITY * f(x, y) * abs(height) / depth**3).sum()
        return total / (2 * self.half / self.columns) ** 2


def clipped(polygon, normal, offset):
    """The part of a convex polygon where normal . p >= offset."""
    kept = []
    for (p, q) in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        here, there = (float(normal @ np.array(end) - offset) for end in (p, q))
        if here >= 0:
            kept.append(p)
        if here * there < 0:
            share = here / (here - there)
            kept.append(tuple(a + share * (b - a) for a, b in zip(p, q, strict=True)))
    return kept


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/soft-shadow-picture.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
