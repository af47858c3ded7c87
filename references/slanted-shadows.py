"""Second derivation for polygon lights behind slanted blockers: the area form, over what is hidden of the light on its plane.

From a receiver a convex blocker's shadow on the light's plane is a convex polygon, and so is what it hides of a convex light;
cut in the plane by lines (Sutherland and Hodgman 1974). Irradiance is the integral of L cos cos / r^2 over the light less that
over the hidden part. At points a polygon's integral is Lambert's sum of angles, in 30 digits. Over a cell it is a Gauss rule on
the light times one on each piece of the cell, cut along the lines on which a corner of one polygon is seen on an edge of the
other, in binary64: on such a piece the corners of the hidden part stay the same corners and crossings. Prints the base cases
as JSON.
"""

import json
import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np
from mpmath import acos, mp, mpf, sqrt

mp.dps = 30
SCENES = ("triangle-blocker", "tilted-blocker", "two-lights")
NODES, WEIGHTS = (array / 2 for array in np.polynomial.legendre.leggauss(14))
NODES = NODES + 0.5
GRID = np.stack([axis.ravel() for axis in np.meshgrid(NODES, NODES, indexing="ij")])
SHARES = np.outer(WEIGHTS, WEIGHTS).ravel()
LOWEST = 1e-2  # m above the film: what of a blocker is lower hides nothing from the cells, as far as they are from its foot


def values(scene, elements):
    """Irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    shapes = [thing["shape"]["vertices"] for thing in (*scene["light"], *scene.get("surface", []))]
    lamps = [(lamp["radiance"], lamp["shape"]["vertices"], [shape for shape in shapes if shape is not lamp["shape"]["vertices"]])
             for lamp in scene["light"]]
    one = at_point if scene["film"]["kind"] == "points" else over_cell
    return [float(sum(radiance * one(scene["film"], element, light, others) for radiance, light, others in lamps))
            for element in elements]


# over a cell, in binary64


def over_cell(film, element, light, blockers):
    """Mean irradiance per radiance [sr] over a cell."""
    origin, u, v = (np.array(film[key]) for key in ("origin", "u", "v"))
    columns, rows = film["resolution"]
    row, column = divmod(element, columns)
    corners = np.array([[column, row], [column + 1, row], [column + 1, row + 1], [column, row + 1]]) / [columns, rows]
    normal = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    light = np.array(light)
    face = np.cross(light[1] - light[0], light[2] - light[0])
    shades = [shade for blocker in blockers if len(shade := between(np.array(blocker), origin, normal, light[0], face))]
    assert len(shades) <= 1 and all((light - origin) @ normal > 0)
    total, area = 0.0, 1 / (columns * rows)
    cuts = [plane for shade in shades for plane in (*sight_planes(light, shade), *finer(origin + corners @ [u, v], shade))]
    for piece in pieces(corners, cuts, origin, u, v):
        total += over_piece(piece, light, shades, origin, u, v, normal)
    return total / area


def finer(cell, shade):
    """Planes that cut a cell (4, 3) in quarters along each side where an edge of a blocker is as near as the cell is wide."""
    along = np.linspace(0, 1, 33)[:, None, None]
    edges = (shade + along * (np.roll(shade, -1, axis=0) - shade)).reshape(-1, 1, 3)
    sides = cell[1] - cell[0], cell[3] - cell[0]
    if np.linalg.norm(edges - cell, axis=-1).min() < max(map(np.linalg.norm, sides)):
        yield from ((cell[0] + side * share, side) for side in sides for share in (0.25, 0.5, 0.75))


def between(blocker, origin, normal, on_light, face):
    """The part of a blocker between the film's plane, or just above it, and the light's."""
    above = clip3(blocker, (blocker - origin) @ normal - LOWEST)
    return clip3(above, (above - on_light) @ face - 1e-12) if len(above) else above


def clip3(corners, heights):
    """The part of a polygon where heights, interpolated, are positive."""
    kept = []
    for i, (corner, height) in enumerate(zip(corners, heights, strict=True)):
        if height * heights[i - 1] < 0:
            share = heights[i - 1] / (heights[i - 1] - height)
            kept.append(corners[i - 1] + (corner - corners[i - 1]) * share)
        if height >= 0:
            kept.append(corner)
    return np.array(kept)


def sight_planes(light, shade):
    """Planes, as a point and a normal, through each corner of one polygon and each edge of the other."""
    for corners, edges in ((light, shade), (shade, light)):
        for corner in corners:
            for i, end in enumerate(edges):
                yield corner, np.cross(edges[i - 1] - corner, end - corner)


def pieces(corners, planes, origin, u, v):
    """Convex parts of a cell, in film positions, cut by planes."""
    parts = [corners]
    for point, normal in planes:
        heights = [((origin + part @ [u, v]) - point) @ normal for part in parts]
        halves = [(part, sign * height) for part, height in zip(parts, heights, strict=True) for sign in (1, -1)]
        parts = [kept for part, height in halves if height.max() > 1e-13 and area_of(kept := clip3(part, height)) > 1e-15]
    return parts


def area_of(part):
    x, y = part.T
    return (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2


def over_piece(piece, light, shades, origin, u, v, normal):
    """The integral over a piece of what is seen of the light."""
    total = 0.0
    for b, c in pairwise(piece[1:]):
        spokes = np.array([b - piece[0], c - b])
        at = piece[0] + np.stack([GRID[0], GRID[0] * GRID[1]], axis=1) @ spokes
        share = SHARES * GRID[0] * abs(np.linalg.det(spokes))
        x, middle = origin + at @ [u, v], origin + piece.mean(axis=0) @ [u, v]
        total += share @ np.broadcast_to(lit(x, np.broadcast_to(light, (len(x), *light.shape)), normal), share.shape)
        for shade in shades:
            hidden = hidden_part(x, middle, light, shade)
            if hidden is not None:
                total -= share @ lit(x, hidden, normal)
    return total


def lit(x, polygons, normal):
    """Irradiance per radiance [sr] at receivers x (n, 3) from convex polygons (n, corners, 3): a Gauss rule on each triangle."""
    total = 0.0
    for i in range(1, polygons.shape[1] - 1):
        a, b, c = polygons[:, 0], polygons[:, i], polygons[:, i + 1]
        front = np.cross(b - a, c - b)
        y = (a[:, None] + GRID[0][:, None] * (b - a)[:, None] + (GRID[0] * GRID[1])[:, None] * (c - b)[:, None])
        rays = y - x[:, None]
        cosines = (rays @ normal) * -(rays * front[:, None]).sum(-1)
        total = total + (cosines / (rays**2).sum(-1) ** 2) @ (SHARES * GRID[0])
    return total


def hidden_part(x, middle, light, shade):
    """What a blocker hides of the light, seen from receivers x (n, 3) as from `middle`: corners (n, k, 3), or None."""
    face = np.cross(light[1] - light[0], light[2] - light[0])
    sides = [("light", i) for i in range(len(light))]
    edges = [("light", (i, (i + 1) % len(light))) for i in range(len(light))]
    place = recipe(middle[None], light, shade, face)
    clockwise = orient(*(place(("shade", i))[0] for i in range(3)), face) < 0
    polygon = list(zip(sides, edges, strict=True))  # a corner, and the line that leaves it
    count = len(shade)
    for k in range(count):
        ends = (k, (k + 1) % count)[::-1 if clockwise else 1]
        polygon = cut(polygon, ("shade", ends), place, face)
    if len(polygon) < 3:
        return None
    place = recipe(x, light, shade, face)
    return np.stack([np.broadcast_to(place(corner), x.shape) for corner, _ in polygon], axis=1)


def recipe(x, light, shade, face):
    """A function from names of corners, ("light", i), ("shade", i) or a crossing of two lines, to places (n, 3)."""

    def place(name):
        kind, which = name
        if kind == "light":
            return light[which][None]
        if kind == "shade":
            ray = shade[which] - x
            assert (ray @ face < 0).all()
            return x + ray * (((light[0] - x) @ face) / (ray @ face))[:, None]
        (k, (a, b)), (m, (c, d)) = which
        p, q, r, s = place((k, a)), place((k, b)), place((m, c)), place((m, d))
        across = np.cross(s - r, face)
        share = ((r - p) * across).sum(-1) / ((q - p) * across).sum(-1)
        return p + (q - p) * share[:, None]

    return place


def cut(polygon, line, place, face):
    """The part of a polygon on the left of a line, by the names of its corners and lines."""
    kind, (a, b) = line
    start, end = place((kind, a))[0], place((kind, b))[0]
    sides = [orient(start, end, place(corner)[0], face) for corner, _ in polygon]
    kept = []
    for (corner, leaving), here, after in zip(polygon, sides, sides[1:] + sides[:1], strict=True):
        if here > 0:
            kept.append((corner, leaving))
        if here > 0 >= after:
            kept.append((("crossing", (leaving, line)), line))
        if here <= 0 < after:
            kept.append((("crossing", (leaving, line)), leaving))
    return kept


def orient(a, b, c, face):
    return np.cross(b - a, c - a) @ face


# at a point, in 30 digits


def at_point(film, element, light, blockers):
    """Irradiance per radiance [sr] at a point."""
    x, n = vector(film["positions"][element]), vector(film["normals"][element])
    light, blockers = in_front([vector(y) for y in light], x, n), [[vector(y) for y in blocker] for blocker in blockers]
    face = cross(sub(light[1], light[0]), sub(light[2], light[0]))
    if dot(sub(x, light[0]), face) <= 0:
        return mpf(0)
    total, up = lambert(light, x, n), scale(unit(face), -1)
    for blocker in blockers:
        low = in_front(in_front(blocker, add(x, scale(up, mpf("1e-15"))), up), light[0], face)
        if low:
            total -= lambert(within(light, [onto(corner, x, light[0], face) for corner in low], face), x, n)
    return total


def onto(corner, x, on_light, face):
    """Where the ray from x through a corner meets the light's plane."""
    ray = sub(corner, x)
    return add(x, scale(ray, dot(sub(on_light, x), face) / dot(ray, face)))


def within(light, shade, face):
    """What two convex polygons of one plane share."""
    spokes = [sub(corner, shade[0]) for corner in shade[1:]]
    way = 1 if sum(dot(cross(a, b), face) for a, b in pairwise(spokes)) > 0 else -1
    for i, end in enumerate(shade):
        light = in_front(light, end, scale(cross(face, sub(end, shade[i - 1])), way))
    return light


def in_front(corners, point, normal):
    """The part of a polygon in front of a plane."""
    heights = [dot(sub(corner, point), normal) for corner in corners]
    kept = []
    for i, (corner, height) in enumerate(zip(corners, heights, strict=True)):
        if height * heights[i - 1] < 0:
            share = heights[i - 1] / (heights[i - 1] - height)
            kept.append(add(corners[i - 1], scale(sub(corner, corners[i - 1]), share)))
        if height >= 0:
            kept.append(corner)
    return kept if len(kept) > 2 else []


def lambert(corners, x, n):
    """Half the sum over edges of angle times cosine, whichever way round."""
    rays = [unit(sub(corner, x)) for corner in corners]
    total = mpf(0)
    for a, b in zip(rays, rays[1:] + rays[:1], strict=True):
        total += acos(min(dot(a, b), mpf(1))) * dot(unit(cross(a, b)), unit(n)) if any(cross(a, b)) else 0
    return abs(total) / 2


def vector(numbers):
    return tuple(mpf(number) for number in numbers)


def add(a, b):
    return tuple(x + y for x, y in zip(a, b, strict=True))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b, strict=True))


def scale(a, factor):
    return tuple(x * factor for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def unit(a):
    return scale(a, 1 / sqrt(dot(a, a)))


def base(name):
    """The base case of a scene."""
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / f"scenes/{name}.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    return dict(enumerate(values(scene, range(columns * rows))))


if __name__ == "__main__":
    print(json.dumps({name: base(name) for name in SCENES}))
