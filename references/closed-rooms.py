"""Second derivation for rooms with flat walls: bounce after bounce, with the form factors from points of the walls.

A wall's form factor is the sum over its edges, clipped at the receiver's horizon (Lambert 1760). Where walls glow alike, their
radiances are followed reflection by reflection. A bulb in the middle of a cube gives a cell of a wall its intensity times the
cell's solid angle (Van Oosterom and Strackee 1983). Of what a point of a wall reflects, its form factors say what comes to
walls again; as walls are alike, and the quarters of a wall, each has an equal part of it. Prints the base cases as JSON.
"""

import json
import tomllib
from pathlib import Path

from mpmath import atan2, mp, mpf, pi, sqrt

SCENES = ("cube-furnace", "cube-room")
PLACES = ((mpf(2) / 10, mpf(3) / 10), (mpf(7) / 10, mpf(1) / 20), (mpf(1) / 2, mpf(4) / 9))  # on a wall, by its first sides
mp.dps = 30


def values(scene, elements):
    """Radiance [W/(m2 sr)] or irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    walls = [[vector(corner) for corner in wall["shape"]["vertices"]] for wall in scene["surface"]]
    if scene["light"]:
        return [float(value) for value in around_bulb(scene, walls, elements)]
    radiances = glowing(scene, walls)
    if scene["film"]["kind"] == "camera":
        assert max(radiances) - min(radiances) < mpf(10) ** -20
        return [float(radiances[0]) for _ in elements]
    receivers = [receiver(scene["film"], element) for element in elements]
    return [float(sum(pi * factor(*at, wall) * light for wall, light in zip(walls, radiances, strict=True))) for at in receivers]


def glowing(scene, walls):
    """The walls' radiances after all reflections, from the form factors of one point of each."""
    own = [mpf(surface["radiance"]) for surface in scene["surface"]]
    kept = [mpf(surface["reflectance"]) for surface in scene["surface"]]
    factors = [[factor(*place(wall, *PLACES[0]), other) for other in walls] for wall in walls]

    def reflected(light):
        return [rho * sum(f * sent for f, sent in zip(row, light, strict=True)) for rho, row in zip(kept, factors, strict=True)]

    return settled(own, reflected, scene["max_bounces"])


def settled(first, reflected, last):
    """first + reflected(first) + ... up to `last` reflections, or until nothing is added to 30 digits."""
    total, added, count = first, first, 0
    while (last == "all" or count < last) and max(added) > mpf(10) ** -mp.dps * max(total):
        added, count = reflected(added), count + 1
        total = [old + new for old, new in zip(total, added, strict=True)]
    return total


def around_bulb(scene, walls, elements):
    """Mean irradiance of a wall's cells: what comes straight, and what all walls send back."""
    bulb, rho = scene["light"][0], mpf(scene["surface"][0]["reflectance"])
    at, intensity = vector(bulb["position"]), mpf(bulb["intensity"])
    again = [sum(factor(*place(wall, *where), other) for other in walls) for wall in walls for where in PLACES]
    assert max(again) - min(again) < mpf(10) ** -20
    straight = [mean_from(at, intensity, wall) for wall in walls]
    assert max(straight) - min(straight) < mpf(10) ** -20
    whole = settled(straight[:1], lambda light: [rho * again[0] * light[0]], scene["max_bounces"])[0]
    return [mean_from(at, intensity, cell(scene["film"], element)) + whole - straight[0] for element in elements]


def mean_from(at, intensity, corners):
    """Mean irradiance of a parallelogram from a point light."""
    a, b, c, d = (sub(corner, at) for corner in corners)
    area = norm(cross(sub(b, a), sub(d, a)))
    return intensity * (abs(solid_angle(a, b, c)) + abs(solid_angle(a, c, d))) / area


def solid_angle(a, b, c):
    """Of a triangle, its corners as seen from the eye."""
    lengths = norm(a), norm(b), norm(c)
    below = lengths[0] * lengths[1] * lengths[2] + dot(a, b) * lengths[2] + dot(b, c) * lengths[0] + dot(c, a) * lengths[1]
    return 2 * atan2(dot(a, cross(b, c)), below)


def factor(x, normal, polygon):
    """Form factor from a receiver to the front of a polygon; 0 where the receiver lies in its plane."""
    if abs(dot(sub(x, polygon[0]), cross(sub(polygon[1], polygon[0]), sub(polygon[2], polygon[0])))) < mpf(10) ** -25:
        return mpf(0)
    rays = above([sub(corner, x) for corner in polygon], normal)
    total = mpf(0)
    for i, ray in enumerate(rays):
        edge = cross(ray, rays[i - 1])
        if norm(edge) > 0:
            total += atan2(norm(edge), dot(ray, rays[i - 1])) * dot(edge, normal) / norm(edge)
    return total / (2 * pi)


def above(rays, normal):
    """The part of a polygon above the receiver's plane."""
    heights = [dot(ray, normal) for ray in rays]
    kept = []
    for i, (ray, height) in enumerate(zip(rays, heights, strict=True)):
        if height * heights[i - 1] < 0:
            share = heights[i - 1] / (heights[i - 1] - height)
            kept.append(add(rays[i - 1], scale(sub(ray, rays[i - 1]), share)))
        if height >= 0:
            kept.append(ray)
    return kept


def place(wall, s, t):
    """A point of a wall and the wall's normal."""
    u, v = sub(wall[1], wall[0]), sub(wall[-1], wall[0])
    return add(wall[0], add(scale(u, s), scale(v, t))), unit(cross(u, v))


def receiver(film, element):
    """Point and normal; of a cell its middle, as the light is the same all over it."""
    if film["kind"] == "points":
        return vector(film["positions"][element]), unit(vector(film["normals"][element]))
    corners = cell(film, element)
    return scale(add(corners[0], corners[2]), mpf(1) / 2), unit(cross(vector(film["u"]), vector(film["v"])))


def cell(film, element):
    """The corners of a cell of a plane film."""
    origin, u, v = (vector(film[key]) for key in ("origin", "u", "v"))
    columns, rows = film["resolution"]
    row, column = divmod(element, columns)
    steps = ((0, 0), (1, 0), (1, 1), (0, 1))
    return [add(origin, add(scale(u, mpf(column + i) / columns), scale(v, mpf(row + j) / rows))) for i, j in steps]


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


def norm(a):
    return sqrt(dot(a, a))


def unit(a):
    return scale(a, 1 / norm(a))


def base(scene_id):
    """The base case's values by element."""
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / f"scenes/{scene_id}.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    return dict(enumerate(values(scene | {"light": scene.get("light", [])}, range(columns * rows))))


if __name__ == "__main__":
    print(json.dumps({scene_id: base(scene_id) for scene_id in SCENES}))
