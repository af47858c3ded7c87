"""Second derivation for disk-blocker: the area form on what is seen of the light, and the divergence theorem on the cell.

On the light's plane the blocker's shadow is a disk, and what it leaves of the light lies between two arcs. Strips across the
line of centres are elementary; a Gauss rule in the angle along each arc adds them up. The irradiance E depends on the distance
r from the axis alone, so a cell's flux is that of the field F(r)/r^2 (x, y) out of it, where F is the integral of E r dr. F is
a Chebyshev series between the distances at which the rims seem to touch; a sine takes the square roots there away. 30 digits;
rules and series twice as long change the binary64 of no element. Points off the axis: row by row, as in
round-shadows.py. Prints the base case as JSON.
"""

import json
import tomllib
from functools import cache
from itertools import pairwise
from pathlib import Path
from runpy import run_path

from mpmath import acos, asin, atan, cos, mp, mpf, pi, sin, sqrt
from mpmath.calculus.quadrature import GaussLegendre

mp.dps = 30
RULE = GaussLegendre(mp).calc_nodes(5, mp.prec)  # 48 nodes and weights on [-1, 1]
TERMS = 60


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, (lamp,), (surface,) = scene["film"], scene["light"], scene["surface"]
    if film["kind"] == "points":
        return run_path(str(Path(__file__).with_name("round-shadows.py")))["values"](scene, elements)
    light, blocker = lamp["shape"], surface["shape"]
    assert light["center"][:2] == blocker["center"][:2] and light["normal"][:2] == blocker["normal"][:2] == [0, 0]
    assert film["u"][1:] == [0, 0] and film["v"][::2] == [0, 0]
    low, high = (mpf(shape["center"][2]) - mpf(film["origin"][2]) for shape in (blocker, light))
    columns, rows = film["resolution"]
    across = grid(film["origin"][0], film["u"][0], columns, light["center"][0])
    along = grid(film["origin"][1], film["v"][1], rows, light["center"][1])
    reach = max(sqrt(x * x + y * y) for x in across for y in along)
    out = outflow(mpf(light["radius"]), mpf(blocker["radius"]), high, low / high, reach)
    means = []
    for element in elements:
        row, column = divmod(element, columns)
        x, y = across[column:column + 2], along[row:row + 2]
        flux = out(x[1], *y) - out(x[0], *y) + out(y[1], *x) - out(y[0], *x)
        means.append(float(mpf(lamp["radiance"]) * flux / ((x[1] - x[0]) * (y[1] - y[0]))))
    return means


def grid(origin, length, count, axis):
    """Where cells begin and end along one side of the film, from the axis."""
    return [mpf(origin) - mpf(axis) + mpf(length) * i / count for i in range(count + 1)]


def outflow(light, blocker, h, k, reach):
    """The field's flux [m2 sr] through a line at a distance from the axis, from a start to an end along it."""
    rims = sorted(abs(blocker + sign * k * light) / (1 - k) for sign in (-1, 1))
    stops = [mpf(0), *(rim for rim in rims if 0 < rim < reach), reach]
    integral = cumulative(lambda r: r * irradiance(r, light, blocker / k, r * (1 - k) / k, h), stops)

    @cache
    def out(distance, start, end):
        crossings = sorted(sign * sqrt(stop**2 - distance**2) for stop in stops if stop > abs(distance) for sign in (-1, 1))
        total = mpf(0)
        for piece in pairwise([start, *(t for t in crossings if start < t < end), end]):
            for node, weight in RULE:
                t, speed = stretch(*piece, node)
                squared = distance**2 + t**2
                total += weight * speed * integral(sqrt(squared)) / squared
        return distance * total

    return out


def stretch(a, b, x):
    """Where x in [-1, 1] comes to lie between a and b, and its speed there: nothing at the ends."""
    middle, half = (a + b) / 2, (b - a) / 2
    return middle + half * sin(pi * x / 2), half * pi / 2 * cos(pi * x / 2)


def cumulative(function, stops):
    """The integral of a function from the first stop on, if it is analytic in square roots between the stops."""
    zones, total = [], mpf(0)
    for a, b in pairwise(stops):
        series = integrated(function, a, b)
        zones.append((a, b, total, series))
        total += chebyshev(series, 1)

    def integral(r):
        a, b, before, series = next(zone for zone in zones if r <= zone[1])
        return before + chebyshev(series, 2 / pi * asin((2 * r - a - b) / (b - a)))

    return integral


def integrated(function, a, b):
    """Chebyshev series, in the stretched variable, of the integral of a function from a on."""
    angles = [pi * (2 * j + 1) / (2 * TERMS) for j in range(TERMS)]
    heights = [function(r) * speed for r, speed in (stretch(a, b, cos(angle)) for angle in angles)]
    own = [2 * mp.fdot(heights, [cos(n * angle) for angle in angles]) / TERMS for n in range(TERMS)] + [0, 0]
    series = [(own[n - 1] - own[n + 1]) / (2 * n) for n in range(1, TERMS + 1)]
    return [sum(series[::2]) - sum(series[1::2]), *series]


def chebyshev(series, x):
    """Sum of a Chebyshev series at x (Clenshaw's recurrence)."""
    twice, here, after = 2 * x, mpf(0), mpf(0)
    for coefficient in reversed(series[1:]):
        here, after = coefficient + twice * here - after, here
    return series[0] + x * here - after


def irradiance(r, light, shadow, gap, h):
    """Irradiance per radiance [sr] at r from the axis; the shadow's centre lies `gap` beyond the light's."""
    light_arc = half_angle(gap, light, shadow), pi
    shadow_arc = mpf(0), half_angle(gap, shadow, light)
    return strips(r, light, light_arc, h) + strips(r + gap, -shadow, shadow_arc, h)


def half_angle(gap, radius, other):
    """Half the arc of a circle that lies in the other, whose centre is `gap` away."""
    cosine = (gap**2 + radius**2 - other**2) / (2 * gap * radius)
    return acos(min(max(cosine, -1), 1))


def strips(centre, radius, arc, h):
    """Sum of the strips from the line of centres to an arc and its mirror image, negative for a negative radius."""
    middle, half = sum(arc) / 2, (arc[1] - arc[0]) / 2
    total = mpf(0)
    for node, weight in RULE if half else ():
        cosine, sine = mp.cos_sin(middle + half * node)
        total += weight * strip(centre + radius * cosine, abs(radius) * sine, h) * sine
    return radius * half * total


def strip(x, y, h):
    """The integral of h^2 / (x^2 + t^2 + h^2)^2 for t from -y to y."""
    squared = x * x + h * h
    root = sqrt(squared)
    return h * h * (y / (squared * (squared + y * y)) + atan(y / root) / (squared * root))


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/disk-blocker.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
