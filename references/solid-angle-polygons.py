"""Second derivation for the solid angle of polygons: the hemisphere sum, ring by ring.

About an axis, the ring at angle b crosses edges at azimuths f0 +- acos(-cot b tan e), and between two crossings one ray tells
whether a light's front is seen first. That pattern holds between the angles of corners, of crossing edges and of circles that the
ring touches; from one to the next the lit azimuths are integrated by Gauss's rule in sin^2, which takes the square roots at both
ends, on halved panels. A single triangle is summed over its area as well. 30 digits. Prints solid-angle-triangle's base case as
JSON.
"""

import json
import tomllib
from functools import cache
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
from mpmath import acos, asin, atan2, cos, cot, legendre, mp, mpf, pi, quad, sin, sqrt

SCENES = ("solid-angle-triangle", "solid-angle-rectangle", "solid-angle-whole-sphere", "solid-angle-overlap")
NODES = 24
SAME, ENOUGH = mpf("1e-20"), mpf("1e-21")

mp.dps = 30


def values(scene, elements):
    """Visible solid angle [sr] at the film's points; `scene` is the table of a scene file."""
    film = scene["film"]
    normals = film.get("normals") or [None] * len(film["positions"])
    return [float(seen(scene, vector(film["positions"][i]), normals[i] and unit(vector(normals[i])))) for i in elements]


def seen(scene, x, normal):
    """Solid angle from one point: of a sky, or of polygons."""
    if "extent" in scene["light"][0]:
        return sky(scene["light"][0]["extent"], normal)
    sheets = [Sheet(thing, x, thing["kind"] == "area") for thing in scene["light"] + scene["surface"]]
    whole = rings(sheets, normal)
    if len(sheets) == 1 and normal is None and len(sheets[0].corners) == 3 and sheets[0].lit:
        other = area_sum(*sheets[0].corners)
        if abs(whole - other) > SAME * whole:
            raise ArithmeticError(f"the sum over directions, {whole}, and that over the area, {other}, differ")
    return whole


def sky(extent, normal):
    """The sphere of directions, or its upper half; above a horizon the rings about the normal are cut by the level."""
    if extent == "sphere" or normal is None:
        return (4 if extent == "sphere" and normal is None else 2) * pi
    tilt = acos(normal[2])
    whole = quad(lambda b: 2 * pi * sin(b), [0, max(0, pi / 2 - tilt)])
    return whole + (quad(lambda b: 2 * acos(max(-1, -cot(b) * cot(tilt))) * sin(b), [abs(pi / 2 - tilt), pi / 2]) if tilt else 0)


class Sheet:
    """A polygon around a receiver in the origin: corners, plane, and the circles of its edges; whether it is lit from here."""

    def __init__(self, thing, x, light):
        self.corners = [minus(vector(corner), x) for corner in thing["shape"]["vertices"]]
        first = self.corners[0]
        self.normal = total([cross(minus(a, first), minus(b, first)) for a, b in pairwise(self.corners[1:])])
        self.lit = light and dot(self.normal, first) < 0
        self.edges = [(unit(cross(a, b)), a, b) for a, b in zip(self.corners, [*self.corners[1:], first], strict=True)]
        self.drop = max(range(3), key=lambda axis: abs(self.normal[axis]))

    def distance(self, w):
        """Along a direction, or infinite."""
        across = dot(self.normal, w)
        t = dot(self.normal, self.corners[0]) / across if across else mpf(-1)
        return t if t > 0 and self.holds([t * c for c in w]) else mp.inf

    def holds(self, p):
        """Whether a point of the plane is inside, by how often a ray to one side crosses the rim."""
        u, v = (axis for axis in range(3) if axis != self.drop)
        inside = False
        for _, a, b in self.edges:
            if (a[v] > p[v]) != (b[v] > p[v]) and p[u] < a[u] + (b[u] - a[u]) * (p[v] - a[v]) / (b[v] - a[v]):
                inside = not inside
        return inside


def rings(sheets, normal):
    """Solid angle of the directions above the horizon in which a lit sheet comes first."""
    frame = axes(normal or unit(vector([0.36, 0.41, 0.8])))
    edges = [edge for sheet in sheets for edge in sheet.edges]
    ends = sorted({mpf(0), pi / 2 if normal else pi, *breaks(sheets, edges, frame[2], pi / 2 if normal else pi)})
    return sum(band(sheets, edges, frame, low, high) for low, high in pairwise(ends) if high - low > mpf("1e-27"))


def breaks(sheets, edges, axis, most):
    """Angles from the axis at which the pattern of a ring may change."""
    ways = [corner for sheet in sheets for corner in sheet.corners]
    for one, two in combinations(sheets, 2):
        for g, a, b in one.edges:
            for h, c, d in two.edges:
                ways += [w for w in (cross(g, h), cross(h, g)) if length(w) > SAME and within(w, g, a, b) and within(w, h, c, d)]
    angles = [acos(dot(unit(w), axis)) for w in ways]
    for g, _, _ in edges:
        touch = asin(min(1, abs(dot(g, axis))))
        angles += [touch, pi - touch]
    return [angle for angle in angles if 0 < angle < most]


def within(w, g, a, b):
    """Whether a direction on the circle g is between a and b."""
    return dot(cross(g, a), w) > 0 > dot(cross(g, b), w)


def band(sheets, edges, frame, low, high):
    """The integral of the lit azimuths between two rings, where the pattern is that of the middle."""
    middle = (low + high) / 2
    crossings = []
    for g, a, b in edges:
        for side in (1, -1):
            f = azimuth(g, side, frame, middle)
            if f is not None and within(direction(f, middle, frame), g, a, b):
                crossings.append((f % (2 * pi), g, side))
    crossings.sort(key=lambda crossing: crossing[0])
    if not crossings:
        return 2 * pi * (cos(low) - cos(high)) if lit(sheets, direction(mpf(0), middle, frame)) else mpf(0)
    starts = [crossing[0] for crossing in crossings]
    stops = [*starts[1:], starts[0] + 2 * pi]
    shows = [lit(sheets, direction((f + e) / 2, middle, frame)) for f, e in zip(starts, stops, strict=True)]
    steps = [shows[i - 1] - show for i, show in enumerate(shows)]
    fixed = sum(e - f for f, e, show in zip(starts, stops, shows, strict=True) if show)
    moving = [(step, g, side, azimuth(g, side, frame, middle))
              for step, (_, g, side) in zip(steps, crossings, strict=True) if step]

    def width(b):
        return fixed + sum(step * (azimuth(g, side, frame, b) - f) for step, g, side, f in moving)

    return gauss(lambda b: width(b) * sin(b), low, high) if moving or fixed else mpf(0)


def azimuth(g, side, frame, b):
    """Where the ring at angle b crosses the circle g; None where it does not."""
    u, v, along = (dot(g, axis) for axis in frame)
    swing = sqrt(u**2 + v**2)
    cosine = -along * cot(b) / swing if swing else mpf(2)
    return atan2(v, u) + side * acos(cosine) if abs(cosine) <= 1 else None


def direction(f, b, frame):
    """The unit vector at an azimuth and an angle from the axis."""
    return total([[c * s for c in axis] for axis, s in zip(frame, (cos(f) * sin(b), sin(f) * sin(b), cos(b)), strict=True)])


def lit(sheets, w):
    """Whether a lit sheet comes first."""
    distances = [sheet.distance(w) for sheet in sheets]
    nearest = min(range(len(sheets)), key=distances.__getitem__)
    return distances[nearest] < mp.inf and sheets[nearest].lit


def area_sum(a, b, c):
    """The integral of height / distance^3 over a triangle: across it by quadrature, along it in closed form."""
    along, across = minus(c, b), minus(b, a)
    area = cross(minus(b, a), minus(c, a))

    def line(s):
        start, run = [p + s * q for p, q in zip(a, across, strict=True)], [s * q for q in along]
        end = [p + q for p, q in zip(start, run, strict=True)]
        steps = dot(end, run) / length(end) - dot(start, run) / length(start)
        return s * steps / dot(cross(start, run), cross(start, run)) if s else mpf(0)

    return abs(dot(area, a)) * quad(line, [0, mpf(1) / 8, mpf(1) / 2, 1])


def vector(numbers):
    return [mpf(number) for number in numbers]


def minus(a, b):
    return [p - q for p, q in zip(a, b, strict=True)]


def total(vectors):
    return [sum(components) for components in zip(*vectors, strict=True)]


def dot(a, b):
    return sum(p * q for p, q in zip(a, b, strict=True))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def length(a):
    return sqrt(dot(a, a))


def unit(a):
    return [c / length(a) for c in a]


def axes(normal):
    """Two unit vectors across a third, and that."""
    u = unit(cross(normal, [mpf(1), mpf(0), mpf(0)] if abs(normal[0]) < 0.7 else [mpf(0), mpf(1), mpf(0)]))
    return u, cross(normal, u), normal


@cache
def legendre_rule():
    """Nodes in (0, 1) and weights of Gauss's rule: numpy's, polished by Newton's method."""
    rule = []
    for guess in np.polynomial.legendre.leggauss(NODES)[0]:
        x = mpf(guess)
        for _ in range(3):
            here, before = legendre(NODES, x), legendre(NODES - 1, x)
            slope = NODES * (before - x * here) / (1 - x * x)
            x -= here / slope
        slope = NODES * (legendre(NODES - 1, x) - x * legendre(NODES, x)) / (1 - x * x)
        rule.append(((1 + x) / 2, 1 / ((1 - x * x) * slope**2)))
    return rule


def gauss(f, low, high):
    """The integral of f, which may have square roots at both ends."""
    def smooth(s):
        return f(low + (high - low) * sin(pi * s / 2) ** 2) * pi / 2 * sin(pi * s)

    return (high - low) * halved(smooth, mpf(0), mpf(1), panel(smooth, mpf(0), mpf(1)))


def halved(f, low, high, whole):
    """The integral of a smooth f, by panels halved until they agree with the `whole`."""
    middle = (low + high) / 2
    halves = panel(f, low, middle), panel(f, middle, high)
    if abs(sum(halves) - whole) < ENOUGH:
        return sum(halves)
    return halved(f, low, middle, halves[0]) + halved(f, middle, high, halves[1])


def panel(f, low, high):
    return (high - low) * sum(w * f(low + (high - low) * s) for s, w in legendre_rule())


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/solid-angle-triangle.toml").read_text(encoding="utf-8"))
    print(json.dumps({"base": dict(enumerate(values(scene, range(len(scene["film"]["positions"])))))}))
