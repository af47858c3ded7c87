"""Second derivation for lights behind disks and spheres: the area form over the light, row by row.

The light lies in a plane: a polygon or disk does, and a sphere looks like the disk on whose rim the receiver's rays touch it.
In that plane, with coordinates (s, t), the light's rim, the shadow of each disk or sphere and the horizon are conics or lines,
a s^2 + b(t) s + c(t) = 0. Along a row they cut out what is seen, and (p + q s) / ((s - m)^2 + k^2)^2 is elementary. Gauss rules
of 24 nodes add the rows up, between the rows at which a curve ends or two of them meet (roots of discriminants and resultants),
with a sine that takes the square roots there away; pieces are halved until that changes nothing. 30 digits. Prints the base
case as JSON.
"""

import json
import tomllib
from itertools import combinations, pairwise
from pathlib import Path

from mpmath import atan, mp, mpc, mpf, pi, polyroots, sqrt
from mpmath.calculus.quadrature import GaussLegendre

SCENES = ()  # other scripts call it for their points
mp.dps = 30
RULE = GaussLegendre(mp).calc_nodes(4, mp.prec)  # 24 nodes and weights on [-1, 1]
TINY = mpf(10) ** -24  # metres: no light between rows as close as this
CLOSE = mpf(10) ** -18  # steradians: as far as two rules may differ


def values(scene, elements):
    """Irradiance [W/m2] of the film's points; `scene` is the table of a scene file."""
    film = scene["film"]
    blockers = [surface["shape"] for surface in scene["surface"]]
    receivers = [(vector(film["positions"][element]), unit(vector(film["normals"][element]))) for element in elements]
    return [float(mp.fsum(mpf(lamp["radiance"]) * seen(lamp["shape"], blockers, x, n) for lamp in scene["light"]))
            for x, n in receivers]


def seen(light, blockers, x, n):
    """Irradiance per radiance [sr] at x, with unit normal n, from what is seen of the light."""
    plane = sheet(light, x)
    if plane is None:
        return mpf(0)
    centre, (along, up, back), curves, inside, reach = plane
    between = [blocker(shape, x) for shape in blockers]
    curves = [*curves, *(conic(form, centre, along, up) for form, _ in between), line(n, centre, along, up)]

    def visible(s, t):
        y = plus(centre, plus(times(along, s), times(up, t)))
        return inside(s, t) and dot(n, y) > 0 and not any(hides(y) for _, hides in between)

    height = -dot(back, centre)
    foot = -dot(along, centre), -dot(up, centre)

    def row(t):
        ends = sorted(s for curve in curves for s in crossings(curve, t))
        square = height**2 + (t - foot[1]) ** 2
        level = dot(n, centre) + t * dot(n, up)
        parts = [part for part in pairwise(ends) if visible((part[0] + part[1]) / 2, t)]
        return height * mp.fsum(strip(level, dot(n, along), foot[0], square, *part) for part in parts)

    rows = [reach[0], *(t for t in stops(curves) if reach[0] < t < reach[1]), reach[1]]
    return mp.fsum(between_rows(row, a, b) for a, b in pairwise(rows) if b - a > TINY)


def between_rows(row, a, b, whole=None):
    """The integral of a row's part from one row to another, halved until the halves add up to the whole."""
    middle = (a + b) / 2
    whole = stretched(row, a, b) if whole is None else whole
    halves = stretched(row, a, middle), stretched(row, middle, b)
    if abs(sum(halves) - whole) < CLOSE:
        return sum(halves)
    return between_rows(row, a, middle, halves[0]) + between_rows(row, middle, b, halves[1])


def stretched(row, a, b):
    """That integral by one rule, with a sine that makes square roots at both ends smooth."""
    middle, half = (a + b) / 2, (b - a) / 2
    return half * mp.fsum(weight * pi / 2 * mp.cos(pi * x / 2) * row(middle + half * mp.sin(pi * x / 2)) for x, weight in RULE)


def strip(level, slope, foot, square, start, end):
    """The integral of (level + slope s) / ((s - foot)^2 + square)^2 from start to end."""
    root = sqrt(square)
    ends = []
    for s in (start - foot, end - foot):
        straight = (s / (s * s + square) + atan(s / root) / root) / (2 * square)
        ends.append((level + slope * foot) * straight - slope / (2 * (s * s + square)))
    return ends[1] - ends[0]


def sheet(light, x):
    """A flat light as x sees it: a point of its plane (from x), a frame whose third vector points at the front, its boundary
    curves, a test and the rows that it lies between; None where x is behind it."""
    if light["type"] == "polygon":
        corners = [minus(vector(corner), x) for corner in light["vertices"]]
        normal = unit(cross(minus(corners[1], corners[0]), minus(corners[2], corners[0])))
        return flat(corners, normal) if dot(normal, corners[0]) < 0 else None
    centre, radius = minus(vector(light["center"]), x), mpf(light["radius"])
    if light["type"] == "sphere":
        share = 1 - radius**2 / dot(centre, centre)
        centre, radius, normal = times(centre, share), radius * sqrt(share), unit(times(centre, -1))
    else:
        normal = unit(vector(light["normal"]))
    if dot(normal, centre) >= 0:
        return None
    rim = ([mpf(1)], [mpf(0)], [-(radius**2), mpf(0), mpf(1)])
    return centre, frame(normal), [rim], lambda s, t: s * s + t * t < radius**2, (-radius, radius)


def flat(corners, normal):
    """A convex polygon with corners counter-clockwise about its normal."""
    along, up, back = frame(normal)
    spots = [(dot(along, spoke), dot(up, spoke)) for spoke in (minus(corner, corners[0]) for corner in corners)]
    edges = list(zip(spots, spots[1:] + spots[:1], strict=True))
    sides = [((a[1] - b[1]), (b[0] - a[0]), a[0] * b[1] - a[1] * b[0]) for a, b in edges]
    curves = [([mpf(0)], [p], [r, q]) for p, q, r in sides]
    rows = [t for _, t in spots]
    return (corners[0], (along, up, back), curves, lambda s, t: all(p * s + q * t + r > 0 for p, q, r in sides),
            (min(rows), max(rows)))


def blocker(shape, x):
    """A disk or a sphere as x sees it: the quadratic form of the cone through its outline, and whether it hides a point."""
    centre, radius = minus(vector(shape["center"]), x), mpf(shape["radius"])
    if shape["type"] == "sphere":
        slack = dot(centre, centre) - radius**2
        form = [[centre[i] * centre[j] - (slack if i == j else 0) for j in range(3)] for i in range(3)]
        return form, lambda y: distance_to_segment(centre, y) < radius
    normal = unit(vector(shape["normal"]))
    h, slack = dot(normal, centre), dot(centre, centre) - radius**2
    form = [[(h * h if i == j else 0) - h * (normal[i] * centre[j] + normal[j] * centre[i]) + slack * normal[i] * normal[j]
             for j in range(3)] for i in range(3)]

    def hides(y):
        share = h / dot(normal, y)
        spoke = minus(times(y, share), centre)
        return 0 < share < 1 and dot(spoke, spoke) < radius**2

    return form, hides


def distance_to_segment(point, end):
    """From a point to the segment from the origin to an end."""
    share = min(max(dot(point, end) / dot(end, end), 0), 1)
    spoke = minus(point, times(end, share))
    return sqrt(dot(spoke, spoke))


def conic(form, centre, along, up):
    """Where a cone meets the light's plane, as polynomials in t."""
    def value(a, b):
        return mp.fsum(form[i][j] * a[i] * b[j] for i in range(3) for j in range(3))

    return ([value(along, along)], [2 * value(along, centre), 2 * value(along, up)],
            [value(centre, centre), 2 * value(centre, up), value(up, up)])


def line(normal, centre, along, up):
    """Where the receiver's horizon meets the light's plane."""
    return [mpf(0)], [dot(normal, along)], [dot(normal, centre), dot(normal, up)]


def crossings(curve, t):
    """Where a curve meets a row."""
    a, b, c = (mp.polyval(part, t, asc=True) for part in curve)
    if a == 0:
        return [-c / b] if b else []
    square = b * b - 4 * a * c
    return [(-b + sign * sqrt(square)) / (2 * a) for sign in (-1, 1)] if square > 0 else []


def stops(curves):
    """The rows at which a curve begins or ends, or two of them meet."""
    rows = []
    for a, b, c in curves:
        rows += roots(add(product(b, b), product([mpf(-4)], product(a, c)))) if any(a) else []
    for (a, b, c), (d, e, f) in combinations(curves, 2):
        first = add(product(a, f), product([mpf(-1)], product(d, c)))
        second = add(product(a, e), product([mpf(-1)], product(d, b)))
        third = add(product(b, f), product([mpf(-1)], product(e, c)))
        if any(a) or any(d):
            rows += roots(add(product(first, first), product([mpf(-1)], product(second, third))))
        else:
            rows += roots(third)
    return sorted(rows)


def roots(polynomial):
    """Real parts of the roots that may be real, of a polynomial given from its constant up."""
    size = max(map(abs, polynomial))
    while polynomial and abs(polynomial[-1]) <= size * mpf(10) ** -25:
        polynomial = polynomial[:-1]
    if len(polynomial) < 2:
        return []
    found = polyroots(polynomial, maxsteps=200, extraprec=200, asc=True)
    return [mpc(root).real for root in found if abs(mpc(root).imag) < 1e-6]


def product(a, b):
    """Of two polynomials."""
    total = [mpf(0)] * (len(a) + len(b) - 1)
    for i, p in enumerate(a):
        for j, q in enumerate(b):
            total[i + j] += p * q
    return total


def add(a, b):
    """Sum of two polynomials."""
    length = max(len(a), len(b))
    return [p + q for p, q in zip(a + [mpf(0)] * (length - len(a)), b + [mpf(0)] * (length - len(b)), strict=True)]


def frame(normal):
    """Two unit vectors across a unit normal, and the normal, right-handed."""
    least = min(range(3), key=lambda i: abs(normal[i]))
    along = unit(cross([mpf(i == least) for i in range(3)], normal))
    return along, cross(normal, along), normal


def vector(numbers):
    """Exact components."""
    return [mpf(number) for number in numbers]


def plus(a, b):
    """a + b."""
    return [p + q for p, q in zip(a, b, strict=True)]


def minus(a, b):
    """a - b."""
    return [p - q for p, q in zip(a, b, strict=True)]


def times(a, factor):
    """a times a number."""
    return [p * factor for p in a]


def dot(a, b):
    """Inner product."""
    return mp.fdot(a, b)


def cross(a, b):
    """Vector product."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    """Scaled to unit length."""
    return times(a, 1 / sqrt(dot(a, a)))


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/sphere-blocker.toml").read_text(encoding="utf-8"))
    print(json.dumps({"base": dict(enumerate(values(scene, range(len(scene["film"]["positions"])))))}))
