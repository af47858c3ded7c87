"""Second derivation for white-furnace-sphere: how much of a pixel the sphere's outline holds, by two other ways than sectors.

Orthographic: the area of a circle to the left of and below a point has a closed form, S(x) = (x s + asin x)/2 with
s = sqrt(1 - x^2) being the area under the arc; a pixel is a sum and difference of four. Perspective: the sphere is seen in a
cone of half-angle asin(R/d), in each row of the film along an interval that a quadratic equation gives; what of it is in the
pixel is integrated over the rows between the places where it meets the pixel's sides. All in 30 digits. Prints the base case
as JSON.
"""

import json
import tomllib
from itertools import pairwise
from pathlib import Path

from mpmath import asin, cos, mp, mpf, pi, quad, sin, sqrt, tan

mp.dps = 30


def values(scene, elements):
    """Mean radiance [W/(m2 sr)] of the film's elements; `scene` is the table of a scene file."""
    film, ball = scene["film"], scene["surface"][0]
    sky, rho = mpf(scene["light"][0]["radiance"]), mpf(ball["reflectance"])
    enclosed = {"orthographic": circle, "perspective": cone}[film["projection"]]
    shares = [enclosed(film, ball["shape"], *pixel(film, element)) for element in elements]
    return [float(sky * (1 - share + rho * share)) for share in shares]


def pixel(film, element):
    """Left, right, low and high of a pixel on the film: in metres, or as tangents."""
    columns, rows = film["resolution"]
    orthographic = film["projection"] == "orthographic"
    half = mpf(film["width"]) / 2 if orthographic else tan(pi * mpf(film["fov"]) / 360)
    row, column = divmod(element, columns)
    sides, ends = (2 * column - columns, 2 * column - columns + 2), (rows - 2 * row - 2, rows - 2 * row)
    return [half * step / columns for step in (*sides, *ends)]


def centre(film, sphere):
    """The sphere's centre along right, up and forward of the camera [m]."""
    forward = unit(minus(film["target"], film["origin"]))
    right = unit(cross(forward, film["up"]))
    ray = minus(sphere["center"], film["origin"])
    return [dot(ray, side) for side in (right, cross(right, forward), forward)]


def circle(film, sphere, left, right, low, high):
    """The share of a pixel that a sphere takes in parallel projection."""
    x, y, depth = centre(film, sphere)
    r = mpf(sphere["radius"])
    assert depth > r
    a, b, c, d = (left - x) / r, (right - x) / r, (low - y) / r, (high - y) / r
    return (quarter(b, d) - quarter(a, d) - quarter(b, c) + quarter(a, c)) / ((b - a) * (d - c))


def quarter(x, y):
    """The area of the unit circle to the left of x and below y."""
    x, y = max(-mpf(1), min(mpf(1), x)), max(-mpf(1), min(mpf(1), y))
    if y < 0:
        return 2 * under(-1, x) - quarter(x, -y)
    reach = sqrt(1 - y * y)
    ends = [-1, *(max(-mpf(1), min(x, end)) for end in (-reach, reach)), x]
    return under(-1, x) + under(ends[0], ends[1]) + y * (ends[2] - ends[1]) + under(ends[2], ends[3])


def under(a, b):
    """The area under the unit circle's upper arc from a to b."""
    return (b * sqrt(1 - b * b) + asin(b) - a * sqrt(1 - a * a) - asin(a)) / 2 if b > a else mpf(0)


def cone(film, sphere, left, right, low, high):
    """The share of a pixel that a sphere takes in perspective."""
    ray = centre(film, sphere)
    distance = sqrt(dot(ray, ray))
    p, q, z = (x / distance for x in ray)
    half = asin(mpf(sphere["radius"]) / distance)
    assert z > sin(half), "all of the sphere is before the camera"
    c = cos(half) ** 2

    def inside(y):
        """The length of a row within the pixel in which (x, y, 1) is in the cone."""
        across = z + y * q
        ends = roots(p * p - c, p * across, across * across - c * (1 + y * y))
        return max(mpf(0), min(ends[1], right) - max(ends[0], left)) if ends else mpf(0)

    stops = {low, high, *roots(p * p + q * q - c, z * q, z * z + p * p - c)}
    for x in (left, right):
        stops |= set(roots(q * q - c, q * (z + x * p), (z + x * p) ** 2 - c * (1 + x * x)))
    rows = sorted(stop for stop in stops if low <= stop <= high)
    return sum((quad(inside, [a, b]) for a, b in pairwise(rows)), mpf(0)) / ((right - left) * (high - low))


def roots(a, b, c):
    """The real roots of a x^2 + 2 b x + c, the smaller one first; none where there are none."""
    square = b * b - a * c
    return sorted((-b + sign * sqrt(square)) / a for sign in (-1, 1)) if square > 0 else []


def minus(a, b):
    return [mpf(x) - mpf(y) for x, y in zip(a, b, strict=True)]


def dot(a, b):
    return sum(mpf(x) * mpf(y) for x, y in zip(a, b, strict=True))


def cross(a, b):
    return [mpf(a[i - 2]) * mpf(b[i - 1]) - mpf(a[i - 1]) * mpf(b[i - 2]) for i in range(3)]


def unit(a):
    length = sqrt(dot(a, a))
    return [x / length for x in a]


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/white-furnace-sphere.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
