"""Second derivation for sphere-light: the cone in which the sphere is seen, summed ring by ring about its axis.

In the ring at angle b from the direction to the centre, which stands e above the horizon, a direction at azimuth f has cosine
sin(e) cos(b) + cos(e) sin(b) cos(f); what lies under the horizon is left out. The azimuth is elementary, and so are the rings
that the horizon misses; a Gauss rule does the others, in the root of the angle from where the horizon begins to cut. Cells by
a 9 x 9 rule in 30 digits; twice as many nodes give the same binary64. Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path

from mpmath import acos, asin, mp, mpf, pi, sin, sqrt

mp.dps = 30


def unit_rule(count):
    """Nodes and weights of the Gauss-Legendre rule on [0, 1]."""
    return [((1 + node) / 2, weight / 2) for node, weight in zip(*mp.gauss_quadrature(count), strict=True)]


RINGS, ON_CELL = unit_rule(16), unit_rule(9)


def values(scene, elements):
    """Mean irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, (lamp,) = scene["film"], scene["light"]
    origin, u, v, centre = (vector(x) for x in (film["origin"], film["u"], film["v"], lamp["shape"]["center"]))
    normal = cross(u, v)
    height = dot(sub(centre, origin), normal) / sqrt(dot(normal, normal))
    columns, rows = film["resolution"]
    means = []
    for element in elements:
        row, column = divmod(element, columns)
        total = mpf(0)
        for s, share in ON_CELL:
            for t, part in ON_CELL:
                at = [o + (column + s) / columns * a + (row + t) / rows * b for o, a, b in zip(origin, u, v, strict=True)]
                distance = sqrt(dot(sub(centre, at), sub(centre, at)))
                total += share * part * cone(asin(height / distance), asin(lamp["shape"]["radius"] / distance))
        means.append(float(lamp["radiance"] * total))
    return means


def cone(elevation, half_angle):
    """Projected solid angle [sr] of a cone whose axis stands at an elevation above the horizon; what is below is cut off."""
    (flat, rise), clear = mp.cos_sin(elevation), min(abs(elevation), half_angle)
    whole = pi * rise * sin(clear) ** 2 if elevation > 0 else mpf(0)
    rest = half_angle - clear
    cut = sum(weight * 2 * root * ring(rise, flat, clear + rest * root**2) for root, weight in RINGS) if rest else 0
    return whole + rest * cut


def ring(rise, flat, b):
    """The cosine above the horizon, summed along the directions at angle b from one of sine `rise` and cosine `flat`."""
    inward, outward = mp.cos_sin(b)
    up, across = rise * inward, flat * outward
    cosine = -up / across
    return 2 * (acos(cosine) * up + sqrt(1 - cosine**2) * across) * outward


def vector(numbers):
    return [mpf(number) for number in numbers]


def sub(a, b):
    return [x - y for x, y in zip(a, b, strict=True)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/sphere-light.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
