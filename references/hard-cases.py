"""Second derivation for the hard cases of direct light: the area form, in polar coordinates around the receiver's foot.

In the plane of a flat light, h below the receiver, the integral of cos cos / r^2 (for solid angles of cos / r^2) along a ray
from the foot is elementary, so the light is a sum over its rim of w x dw times `ray`, w the rim's place as seen from the
foot. Along the rim, Gauss rules in u, where the place is proportional to sinh(u): there the integrand is as smooth for rims
that nearly touch the foot as for those far away. Shadows are convex polygons, projected onto the light's plane and taken
away. A sphere is summed up ring by ring of its cone of directions. 60 digits, as slivers cancel.
"""

import json
import tomllib
from functools import cache
from itertools import pairwise
from pathlib import Path

from mpmath import acos, asin, asinh, atan, ceil, cos, cosh, exp, log, mp, mpf, pi, quad, sin, sinh, sqrt

SCENES = ("hard-distance", "hard-grazing", "hard-translation", "hard-aspect", "hard-approach", "hard-in-plane",
          "hard-touching-edge", "hard-tiny-solid-angle", "hard-through-vertex", "hard-degenerate-light")
DIGITS = 40  # of each part of a rim
PANEL = 2  # the longest part of u
mp.dps = 60


def values(scene, elements):
    """Irradiance [W/m2], or solid angle [sr], at the film's points; `scene` is the table of a scene file."""
    blockers, receivers = [surface["shape"] for surface in scene.get("surface", [])], points(scene["film"])
    return [float(sum(seen(lamp, blockers, *receivers[element]) for lamp in scene["light"])) for element in elements]


def points(film):
    """Positions and normals; of a plane the cells' corners, which will do where no light shines."""
    if film["kind"] == "points":
        return list(zip(film["positions"], film.get("normals", [None] * len(film["positions"])), strict=True))
    origin, u, v = (vector(film[key]) for key in ("origin", "u", "v"))
    columns, rows = film["resolution"]
    return [(add(origin, add(scale(u, mpf(column) / columns), scale(v, mpf(row) / rows))), cross(u, v))
            for row in range(rows) for column in range(columns)]


def seen(lamp, blockers, position, normal):
    """Irradiance from one light past the blockers, or, without a normal, the solid angle that it is seen in."""
    x, n, shape = vector(position), unit(vector(normal)) if normal else None, lamp["shape"]
    strength = mpf(lamp["radiance"]) if normal else 1
    if shape["type"] == "sphere":
        return strength * sphere(shape, x, n)
    return strength * (disk(shape, x, n) if shape["type"] == "disk" else polygon(shape, blockers, x, n))


def polygon(shape, blockers, x, n):
    """Irradiance per radiance, or solid angle [sr], of what is seen of a convex polygon."""
    corners = relative(shape, x)
    face = facing(corners)
    if dot(face, corners[0]) >= 0:  # exact in 60 digits: behind the light, or in its plane
        return mpf(0)
    plane = Plane(unit(face), corners[0], n)
    light = flat(plane, clip(corners, lambda corner: dot(corner, n)) if n else corners)
    total = outline(plane, light)
    for blocker in blockers:
        solid = relative(blocker, x)
        if any(facing(solid)):
            total -= outline(plane, common(light, flat(plane, [projected(plane, corner) for corner in solid])))
    return total


class Plane:
    """A light's plane as the receiver at the origin sees it: unit axes `e`, `f` and normal `m`, height of the receiver above
    it, and the receiver's normal along these axes: `g` and `c`."""

    def __init__(self, m, corner, n):
        self.m, self.height = m, -dot(m, corner)
        self.e = unit(cross(m, min(((1, 0, 0), (0, 1, 0), (0, 0, 1)), key=lambda axis: abs(dot(m, axis)))))
        self.f = cross(m, self.e)
        self.g, self.c = (dot(n, self.e), dot(n, self.f)) if n else None, dot(n, m) if n else None

    def ray(self, w):
        """The integral of cos cos / r^2, or of cos / r^2, over a thin wedge from the foot to w, over twice its area."""
        h, square = self.height, w[0] * w[0] + w[1] * w[1]
        if self.g is None:
            return 1 / (square + h * h + h * sqrt(square + h * h))
        rho = sqrt(square)
        bend = (atan(rho / h) - h * rho / (square + h * h)) / (rho * square) if rho else 2 / (3 * h**3)
        return ((self.g[0] * w[0] + self.g[1] * w[1]) * bend - self.c / (square + h * h)) / 2


def flat(plane, corners):
    """Places in the light's plane, counter-clockwise seen from its front."""
    places = [(dot(corner, plane.e), dot(corner, plane.f)) for corner in corners]
    turn = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(places, places[1:] + places[:1], strict=True))
    return places if turn >= 0 else places[::-1]


def projected(plane, corner):
    """Where the ray from the receiver through a blocker's corner meets the light's plane; it has to lie between."""
    depth = -dot(plane.m, corner)
    assert 0 < depth < plane.height
    return scale(corner, plane.height / depth)


def outline(plane, places):
    """The sum over the edges of a polygon."""
    return sum((edge(plane, a, b) for a, b in zip(places, places[1:] + places[:1], strict=True) if a != b), mpf(0))


def edge(plane, a, b):
    """The sum over an edge: w = foot of the perpendicular + t along, t = s sinh(u)."""
    length = sqrt((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2)
    along = (b[0] - a[0]) / length, (b[1] - a[1]) / length
    aside, start = a[0] * along[1] - a[1] * along[0], a[0] * along[0] + a[1] * along[1]
    if not aside:
        return mpf(0)
    s = sqrt(aside**2 + plane.height**2)

    def part(u):
        grown = exp(u)
        t = s * (grown - 1 / grown) / 2 - start
        return plane.ray((a[0] + along[0] * t, a[1] + along[1] * t)) * s * (grown + 1 / grown) / 2

    return aside * integral(part, asinh(start / s), asinh((start + length) / s))


def disk(shape, x, n):
    """Irradiance per radiance, or solid angle [sr], of a disk above the horizon. On its near half
    tan(angle/2) = tau sinh(u)."""
    centre, radius = sub(vector(shape["center"]), x), mpf(shape["radius"])
    if dot(vector(shape["normal"]), centre) >= 0:
        return mpf(0)
    plane = Plane(unit(vector(shape["normal"])), centre, n)
    (middle,) = flat(plane, [centre])
    offset = sqrt(middle[0] ** 2 + middle[1] ** 2)
    towards = scale(middle, -1 / offset) if offset else (mpf(1), mpf(0))
    tau = sqrt(((offset - radius) ** 2 + plane.height**2) / ((offset + radius) ** 2 + plane.height**2))

    def turn(c, s):
        """w x dw times `ray` per angle, at the rim's point whose angle from the foot has cosine c and sine s."""
        out = c * towards[0] - s * towards[1], c * towards[1] + s * towards[0]
        w = middle[0] + radius * out[0], middle[1] + radius * out[1]
        return radius * (w[0] * out[0] + w[1] * out[1]) * plane.ray(w)

    def near(u):
        half = tau * sinh(u)
        return turn((1 - half * half) / (1 + half * half), 2 * half / (1 + half * half)) * 2 * tau * cosh(u) / (1 + half * half)

    end = asinh(1 / tau)
    return integral(near, -end, end) + integral(lambda angle: turn(cos(angle), sin(angle)), pi / 2, 3 * pi / 2)


def sphere(shape, x, n):
    """Irradiance per radiance, or solid angle [sr], of a sphere, by rings around the receiver's normal."""
    centre = sub(vector(shape["center"]), x)
    distance = sqrt(dot(centre, centre))
    half = asin(mpf(shape["radius"]) / distance)
    if n is None:
        return quad(lambda angle: 2 * pi * sin(angle), [0, half])
    off = acos(dot(centre, n) / distance)
    whole = max(mpf(0), half - off)
    low, high = max(off - half, half - off), min(off + half, pi / 2)
    full = pi * sin(min(whole, pi / 2)) ** 2

    def ring(polar):
        share = (cos(half) - cos(polar) * cos(off)) / (sin(polar) * sin(off))
        return 2 * acos(max(mpf(-1), min(mpf(1), share))) * cos(polar) * sin(polar)

    return full + (quad(ring, [low, (low + high) / 2, high]) if high > low and off else mpf(0))


def integral(f, low, high):
    """Gauss-Legendre over panels, with as many nodes as the strip |Im u| < pi/2, in which f is analytic, asks for."""
    panels = max(1, int(ceil((high - low) / PANEL)))
    half = (high - low) / (2 * panels)
    if not half:
        return mpf(0)
    reach = pi / 2 / half
    nodes = gauss(2 + int(ceil(DIGITS * log(10) / (2 * log(reach + sqrt(1 + reach**2))))))
    middles = [low + half * (2 * panel + 1) for panel in range(panels)]
    return half * sum(weight * f(middle + half * node) for middle in middles for node, weight in nodes)


@cache
def gauss(count):
    """Nodes and weights of the Gauss-Legendre rule on [-1, 1]: Newton's method on the recurrence of the polynomials."""
    rule = []
    for k in range(count):
        x = cos(pi * (k + mpf(3) / 4) / (count + mpf(1) / 2))
        for _ in range(8):
            before, here = mpf(1), x
            for degree in range(2, count + 1):
                before, here = here, ((2 * degree - 1) * x * here - (degree - 1) * before) / degree
            slope = count * (x * here - before) / (x * x - 1)
            x -= here / slope
        rule.append((x, 2 / ((1 - x * x) * slope**2)))
    return rule


def common(polygon, other):
    """What two convex polygons share; both counter-clockwise."""
    for start, end in zip(other, other[1:] + other[:1], strict=True):
        polygon = clip(polygon, left_of(start, end))
    return polygon


def left_of(start, end):
    """How far a place is to the left of an edge, times the edge's length."""
    x, y = sub(end, start)
    return lambda w: x * (w[1] - start[1]) - y * (w[0] - start[0])


def clip(corners, height):
    """The part of a convex polygon whose `height`, a linear function, is not negative; none without area."""
    heights = [height(corner) for corner in corners]
    kept = []
    for i, (corner, here) in enumerate(zip(corners, heights, strict=True)):
        before, depth = corners[i - 1], heights[i - 1]
        if here * depth < 0:
            kept.append(add(before, scale(sub(corner, before), depth / (depth - here))))
        if here >= 0:
            kept.append(corner)
    return kept if len(kept) > 2 else []


def relative(shape, x):
    return [sub(vector(corner), x) for corner in shape["vertices"]]


def facing(corners):
    """Twice the vector area."""
    spokes = [sub(corner, corners[0]) for corner in corners[1:]]
    return [sum(column) for column in zip(*(cross(a, b) for a, b in pairwise(spokes)), strict=True)]


def vector(numbers):
    return tuple(mpf(number) for number in numbers)


def add(a, b):
    return tuple(x + y for x, y in zip(a, b, strict=True))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b, strict=True))


def scale(a, factor):
    return tuple(x * factor for x in a)


def unit(a):
    return scale(a, 1 / sqrt(dot(a, a)))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def base(name):
    """The base case of a scene."""
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / f"scenes/{name}.toml").read_text(encoding="utf-8"))
    return dict(enumerate(values(scene, range(len(scene["film"]["positions"])))))


if __name__ == "__main__":
    print(json.dumps({name: base(name) for name in SCENES}))
