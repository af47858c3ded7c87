"""Second derivation for sun-disc: the disc's radiance times the cosine, summed ring by ring about its axis.

In the ring at angle b from the axis, itself t from the receiver's normal, a direction at azimuth f has the cosine
cos(t) cos(b) + sin(t) sin(b) cos(f); what lies under the horizon is left out. The azimuth is elementary; double exponential
quadrature in 30 digits does b, split where the horizon begins to cut. Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path

from mpmath import acos, asin, cos, mp, mpf, pi, quad, sin, sqrt

mp.dps = 30


def values(scene, elements):
    """Irradiance [W/m2] of the film's elements, all alike; `scene` is the table of a scene file."""
    film, sun = scene["film"], scene["light"][0]
    axis = unit([-mpf(x) for x in sun["direction"]])
    height = sum(a * n for a, n in zip(axis, unit(cross(film["u"], film["v"])), strict=True))
    value = mpf(sun["radiance"]) * projected(height, pi * mpf(sun["half_angle"]) / 180)
    return [float(value) for _ in elements]


def projected(height, half_angle):
    """Projected solid angle [sr] of the part above the horizon of a disc whose axis stands at asin(`height`)."""
    across = sqrt(1 - height**2)
    cut = min(abs(asin(height)), half_angle)
    whole = quad(lambda b: 2 * pi * height * cos(b) * sin(b), [0, cut]) if height > 0 else 0
    return whole + (quad(lambda b: ring(height * cos(b), across * sin(b)) * sin(b), [cut, half_angle]) if cut < half_angle else 0)


def ring(level, swing):
    """The integral over the azimuth f of level + swing cos(f), where it is positive."""
    end = acos(max(mpf(-1), min(mpf(1), -level / swing)))
    return 2 * (end * level + sin(end) * swing)


def cross(a, b):
    """a x b."""
    a, b = [mpf(x) for x in a], [mpf(x) for x in b]
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def unit(vector):
    """Scaled to unit length."""
    length = sqrt(sum(x * x for x in vector))
    return [x / length for x in vector]


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/sun-disc.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
