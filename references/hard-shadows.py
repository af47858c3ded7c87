"""Second derivation for point lights and beams behind blockers: solid angles and areas of what is lit of a cell.

The flux of a point light through part of a plane is its intensity times the solid angle of that part (Van Oosterom and Strackee
1983), that of a beam its irradiance times the part's area across the beam. What is dark of a cell is what the blockers' corners,
projected from the light onto the film's plane, enclose of it (Sutherland and Hodgman 1974). At points the nearest point of the
ray to a sphere's centre, or its crossing of a plane or of a tube, tells whether it gets through. All in 30 digits. Prints the
base cases as JSON.
"""

import json
import tomllib
from itertools import pairwise
from pathlib import Path

from mpmath import atan2, mp, mpf, sqrt

mp.dps = 30
SCENES = ("point-light-shadow", "beam")


def values(scene, elements):
    """Irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, (light,) = scene["film"], scene["light"]
    shapes = [surface["shape"] for surface in scene.get("surface", [])]
    one = at_point if film["kind"] == "points" else over_cell
    return [float(one(film, element, light, shapes)) for element in elements]


def over_cell(film, element, light, shapes):
    """Mean irradiance [W/m2] over a cell; the blockers' shadows must not overlap."""
    cell, normal = corners_of(film, element), cross(vector(film["u"]), vector(film["v"]))
    whole, dark = measure(cell, light, normal), mpf(0)
    for shape in shapes:
        shadow = [project(vector(corner), light, cell[0], normal) for corner in shape["vertices"]]
        dark += measure(within(cell, shadow, normal), light, normal)
    area = length(normal) / (film["resolution"][0] * film["resolution"][1])
    return (whole - dark) / area


def corners_of(film, element):
    """The corners of a cell."""
    (columns, rows), origin = film["resolution"], vector(film["origin"])
    row, column = divmod(element, columns)
    places = ((column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1))
    u, v = vector(film["u"]), vector(film["v"])
    return [add(origin, add(scale(u, mpf(p) / columns), scale(v, mpf(q) / rows))) for p, q in places]


def measure(polygon, light, normal):
    """Flux [W] through a convex polygon of the film's plane."""
    if light["kind"] == "point":
        rays = [sub(corner, vector(light["position"])) for corner in polygon]
        return mpf(light["intensity"]) * sum(abs(solid_angle(rays[0], b, c)) for b, c in pairwise(rays[1:]))
    spokes = [sub(corner, polygon[0]) for corner in polygon[1:]]
    across = scale(vector(light["direction"]), -1 / length(vector(light["direction"])))
    area = sum((dot(cross(b, c), across) for b, c in pairwise(spokes)), mpf(0)) / 2
    return max(mpf(light["irradiance"]) * area, mpf(0))


def solid_angle(a, b, c):
    """Solid angle [sr] of the triangle in which three rays end."""
    x, y, z = length(a), length(b), length(c)
    return 2 * atan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y)


def project(corner, light, origin, normal):
    """The shadow of a point on the film's plane."""
    way = sub(corner, vector(light["position"])) if light["kind"] == "point" else vector(light["direction"])
    reach = dot(sub(origin, corner), normal) / dot(way, normal)
    assert reach > 0 and dot(sub(corner, origin), normal) > 0
    return add(corner, scale(way, reach))


def within(polygon, other, normal):
    """What two convex polygons of the film's plane share."""
    way = 1 if dot(cross(sub(other[1], other[0]), sub(other[2], other[1])), normal) > 0 else -1
    for i, end in enumerate(other):
        left = scale(cross(normal, sub(end, other[i - 1])), way)
        heights = [dot(sub(corner, end), left) for corner in polygon]
        kept = []
        for k, (corner, height) in enumerate(zip(polygon, heights, strict=True)):
            if height * heights[k - 1] < 0:
                share = heights[k - 1] / (heights[k - 1] - height)
                kept.append(add(polygon[k - 1], scale(sub(corner, polygon[k - 1]), share)))
            if height >= 0:
                kept.append(corner)
        polygon = kept
        if len(polygon) < 3:
            return [polygon[0]] * 3 if polygon else [end] * 3
    return polygon


def at_point(film, element, light, shapes):
    """Irradiance [W/m2] at a point lit by a point light."""
    x, n = vector(film["positions"][element]), vector(film["normals"][element])
    ray = sub(vector(light["position"]), x)
    if any(STOPS[shape["type"]](shape, x, ray) for shape in shapes):
        return mpf(0)
    return mpf(light["intensity"]) * max(dot(ray, n), mpf(0)) / (length(n) * length(ray) ** 3)


def stops_polygon(shape, x, ray):
    """Whether the segment from x along the ray goes through a triangle: all three volumes with the ray have one sign."""
    a, b, c = (sub(vector(corner), x) for corner in shape["vertices"])
    turns = [dot(ray, cross(p, q)) for p, q in ((a, b), (b, c), (c, a))]
    normal = cross(sub(b, a), sub(c, a))
    return (min(turns) > 0 or max(turns) < 0) and 0 < dot(a, normal) / dot(ray, normal) < 1


def stops_disk(shape, x, ray):
    """Whether it meets the disk's plane within the radius."""
    n, centre = vector(shape["normal"]), sub(vector(shape["center"]), x)
    reach = dot(centre, n) / dot(ray, n)
    return 0 < reach < 1 and length(sub(scale(ray, reach), centre)) < mpf(shape["radius"])


def stops_sphere(shape, x, ray):
    """Whether it comes closer to the centre than the radius; both its ends are outside."""
    centre = sub(vector(shape["center"]), x)
    nearest = min(max(dot(centre, ray) / dot(ray, ray), mpf(0)), mpf(1))
    return length(sub(scale(ray, nearest), centre)) < mpf(shape["radius"])


def stops_tube(shape, x, ray):
    """Whether it crosses the infinite cylinder, once on the way in or once on the way out, between the two ends."""
    axis = scale(vector(shape["axis"]), 1 / length(vector(shape["axis"])))
    start, a = sub(x, vector(shape["base"])), dot(ray, axis)
    across, beside = sub(ray, scale(axis, a)), sub(start, scale(axis, dot(start, axis)))
    p, q, r = dot(across, across), dot(across, beside), dot(beside, beside) - mpf(shape["radius"]) ** 2
    if q * q <= p * r:
        return False
    roots = [(-q + sign * sqrt(q * q - p * r)) / p for sign in (-1, 1)]
    return any(0 < t < 1 and 0 < dot(start, axis) + t * a < mpf(shape["height"]) for t in roots)


STOPS = {"polygon": stops_polygon, "disk": stops_disk, "sphere": stops_sphere, "cylinder": stops_tube}


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


def length(a):
    return sqrt(dot(a, a))


def base(name):
    """The base case of a scene."""
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / f"scenes/{name}.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    return dict(enumerate(values(scene, range(columns * rows))))


if __name__ == "__main__":
    print(json.dumps({name: base(name) for name in SCENES}))
