"""Second derivation for light inside spheres: bounce after bounce between patches, their view factors integrated.

What one patch receives per exitance of another is the integral of cos cos / (pi d^2) over what it sees of it, in 30 digits.
The share of a pixel that a patch fills is found by scan lines: the plane of a line cuts the circle that bounds the patch, its
rim or its silhouette, in two points, and between these the line sees it. Prints the base cases as JSON.
"""

import json
import tomllib
from functools import cache
from itertools import pairwise
from pathlib import Path

from mpmath import acos, atan2, cos, linspace, mp, mpf, pi, quad, radians, sin, sqrt, tan

SCENES = ("centred-point-in-sphere", "two-zone-sphere", "emitting-cap", "concentric-spheres")
mp.dps = 30


def values(scene, elements):
    """Radiance [W/(m2 sr)] or irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    patches, film, last = scene["surface"], scene["film"], scene["max_bounces"]
    if film["kind"] == "points":
        received = settled(scene, last)
        return [float(received[patch_at(patches, film["positions"][element])]) for element in elements]
    received = settled(scene, last if last == "all" else last - 1)
    radiance = [mpf(p["radiance"]) + mpf(p["reflectance"]) / pi * e for p, e in zip(patches, received, strict=True)]
    if len(patches) == 1:
        return [float(radiance[0]) for _ in elements]
    view = camera(film)
    within, circle = bounded(patches, view[0])
    shares = [share(film, view, element, circle) for element in elements]
    return [float(part * radiance[within] + (1 - part) * radiance[1 - within]) for part in shares]


def settled(scene, last):
    """Irradiance of each patch after `last` reflections, or when it has settled to 30 digits; nothing where that is negative."""
    patches = scene["surface"]
    factors = [[view_factor(mine, other, patches) for other in patches] for mine in patches]
    direct = [lit(patch, scene["light"]) for patch in patches]
    added = [e + row(factors, i, [pi * mpf(p["radiance"]) for p in patches]) for i, e in enumerate(direct)]
    total, count = [mpf(0)] * len(patches), 0
    while (last == "all" or count <= last) and any(new > mpf(10) ** -mp.dps * old for new, old in zip(added, total, strict=True)):
        total = [old + new for old, new in zip(total, added, strict=True)]
        exitance = [mpf(p["reflectance"]) * new for p, new in zip(patches, added, strict=True)]
        added, count = [row(factors, i, exitance) for i in range(len(patches))], count + 1
    return total


def row(factors, i, exitance):
    """What patch i receives."""
    return sum(factor * sent for factor, sent in zip(factors[i], exitance, strict=True))


def lit(patch, lights):
    """Irradiance from points in the centre, by the inverse square law."""
    assert all(light["position"] == patch["shape"]["center"] for light in lights)
    return sum((mpf(light["intensity"]) / mpf(patch["shape"]["radius"]) ** 2 for light in lights), mpf(0))


def view_factor(mine, other, patches):
    """The share of what leaves a patch that arrives at another: the integral over the other as a point of the first sees it."""
    if patches[0]["shape"]["type"] == "cap":
        return cap_factor(radians(mpf(other["shape"]["half_angle"])))
    r, s = mpf(mine["shape"]["radius"]), mpf(other["shape"]["radius"])
    inner = min(mpf(patch["shape"]["radius"]) for patch in patches) if len(patches) > 1 else mpf(0)
    if r == s == inner:
        return mpf(0)
    seen = acos(inner / r) + acos(inner / s)
    return quad(lambda polar: 2 * pi * s**2 * sin(polar) * kernel(r, s, polar), [0, seen])


def kernel(r, s, polar):
    """cos cos / (pi d^2) between points of concentric spheres of radii r and s, `polar` apart as seen from the centre; the
    side on which the cosines are positive is that on which they see each other."""
    chord = (r - s) ** 2 + 4 * r * s * sin(polar / 2) ** 2
    first, second = r - s * cos(polar), s - r * cos(polar)
    return abs(first * second) / (pi * chord**2) if polar else mpf(0)


@cache
def cap_factor(half_angle):
    """From a point of a sphere's wall, 77 degrees from the axis, to a cap of the wall: rings of the cap, point by point."""
    place = (sin(radians(77)), mpf(0), cos(radians(77)))

    def ring(polar):
        points = [(sin(polar) * cos(turn), sin(polar) * sin(turn), cos(polar)) for turn in linspace(0.1, 0.1 + 2 * pi, 13)[:-1]]
        return 2 * pi * sin(polar) * sum(exchanged(place, point) for point in points) / len(points)

    return quad(ring, [0, half_angle])


def exchanged(x, y):
    """cos cos / (pi d^2) between two points of the unit sphere's inside."""
    d = sub(y, x)
    squared = dot(d, d)
    return -dot(d, x) * dot(d, y) / (pi * squared**2)


def patch_at(patches, position):
    """The index of the patch that a point lies on."""
    offset = sub(vector(position), vector(patches[0]["shape"]["center"]))
    distance = sqrt(dot(offset, offset))
    if patches[0]["shape"]["type"] == "sphere":
        gaps = [abs(distance - mpf(patch["shape"]["radius"])) for patch in patches]
        return gaps.index(min(gaps))
    axis = vector(patches[0]["shape"]["axis"])
    angle = acos(dot(offset, axis) / (distance * sqrt(dot(axis, axis))))
    return int(angle > radians(mpf(patches[0]["shape"]["half_angle"])))


def bounded(patches, eye):
    """The patch that a camera sees within a circle, all of it before the camera, and the circle: centre, radius, axis."""
    centre = vector(patches[0]["shape"]["center"])
    if patches[0]["shape"]["type"] == "sphere":
        index = min(range(2), key=lambda i: patches[i]["shape"]["radius"])
        return index, silhouette(eye, centre, mpf(patches[index]["shape"]["radius"]))
    circles = [rim(patch["shape"], centre) for patch in patches]
    return next((i, circle) for i, circle in enumerate(circles) if dot(sub(eye, circle[0]), circle[2]) < 0)


def rim(cap, centre):
    axis, angle, radius = unit(vector(cap["axis"])), radians(mpf(cap["half_angle"])), mpf(cap["radius"])
    return add(centre, scale(axis, radius * cos(angle))), radius * sin(angle), axis


def silhouette(eye, centre, radius):
    away = sub(eye, centre)
    nearer = radius**2 / dot(away, away)
    return add(centre, scale(away, nearer)), radius * sqrt(1 - nearer), unit(away)


def camera(film):
    """Eye and unit vectors to the right, up and forward."""
    eye = vector(film["origin"])
    forward = unit(sub(vector(film["target"]), eye))
    right = unit(cross(forward, vector(film["up"])))
    return eye, right, cross(right, forward), forward


def share(film, view, element, circle):
    """The part of a pixel in which a circle is seen: the seen length of vertical scan lines, integrated from one event to the
    next. Events are lines that touch the circle and lines that meet it in the pixel's lower or upper edge."""
    (columns, rows), half = film["resolution"], tan(radians(mpf(film["fov"])) / 2)
    line, column = divmod(element, columns)
    left, right = (half * (2 * (column + i) - columns) / columns for i in (0, 1))
    low, high = (half * (rows - 2 * (line + i)) / columns for i in (1, 0))

    def length(x):
        ends = sorted(crossings(view, circle, x, upright=True))
        return max(mpf(0), min(high, ends[1]) - max(low, ends[0])) if ends else mpf(0)

    events = [x for y in (low, high) for x in crossings(view, circle, y, upright=False)] + touching(view, circle)
    stops = [left, *sorted(x for x in events if left < x < right), right]
    area = sum((between(length, a, b, high - low) for a, b in pairwise(stops)), mpf(0))
    return area / ((right - left) * (high - low))


def between(length, a, b, full):
    """The integral of the seen length between two events; all or nothing in the middle is all or nothing throughout."""
    middle = length((a + b) / 2)
    return middle * (b - a) if middle in (0, full) else quad(length, [a, b])


def crossings(view, circle, place, upright):
    """Where an upright line of the film at x = `place` (a level one at y) meets the image of the circle: y (x), two or none."""
    eye, right, up, forward = view
    along, across = (up, right) if upright else (right, up)
    a, b, k, arms = harmonic(circle, eye, cross(add(forward, scale(across, place)), along))
    if a * a + b * b <= k * k:
        return []
    turns = [atan2(b, a) + sign * acos(-k / sqrt(a * a + b * b)) for sign in (1, -1)]
    points = [sub(add(circle[0], add(scale(arms[0], cos(t)), scale(arms[1], sin(t)))), eye) for t in turns]
    return [dot(point, along) / dot(point, forward) for point in points]


def harmonic(circle, eye, normal):
    """a, b, k with a cos t + b sin t + k = normal . (point t of the circle - eye), and the circle's two radii."""
    centre, radius, axis = circle
    side = cross(axis, (1, 0, 0) if abs(axis[0]) < 0.7 else (0, 1, 0))
    first = scale(unit(side), radius)
    second = cross(axis, first)
    return dot(normal, first), dot(normal, second), dot(normal, sub(centre, eye)), (first, second)


def touching(view, circle):
    """The places x of upright lines that touch the circle: there a^2 + b^2 = k^2, all three linear in x."""
    eye, right, up, forward = view
    at, slope = (harmonic(circle, eye, cross(direction, up))[:3] for direction in (forward, right))
    p, q, r = (x[0] * y[0] + x[1] * y[1] - x[2] * y[2] for x, y in ((slope, slope), (slope, at), (at, at)))
    root = sqrt(q * q - p * r)
    return [(-q + root) / p, (-q - root) / p]


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


def base(scene_id):
    """The base case's values by element."""
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / f"scenes/{scene_id}.toml").read_text(encoding="utf-8"))
    for item in scene["surface"]:
        item.setdefault("radiance", 0)
    film, scene["light"] = scene["film"], scene.get("light", [])
    count = len(film["positions"]) if film["kind"] == "points" else film["resolution"][0] * film["resolution"][1]
    return dict(enumerate(values(scene, range(count))))


if __name__ == "__main__":
    print(json.dumps({scene_id: base(scene_id) for scene_id in SCENES}))
