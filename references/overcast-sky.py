"""Second derivation for overcast-sky: the sky's radiance times the cosine, summed ring by ring about the receiver's normal.

In the ring at angle t from the normal of a plane tilted by b, the sine of the elevation at azimuth f is
cos(t) cos(b) + sin(t) sin(b) cos(f), and there is sky where it is positive. The azimuth is elementary; double exponential
quadrature in 30 digits does t, split where the sky's horizon begins to cut. Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path

from mpmath import acos, cos, mp, mpf, pi, quad, sin, sqrt

mp.dps = 30


def values(scene, elements):
    """Irradiance [W/m2] of the film's elements, all alike; `scene` is the table of a scene file."""
    value = mpf(scene["light"][0]["zenith_radiance"]) / 3 * weighted(tilt(scene["film"]))
    return [float(value) for _ in elements]


def weighted(b):
    """The integral of (1 + 2 sin(elevation)) cos(t) over the sky [sr]."""
    ends = sorted({mpf(0), min(abs(pi / 2 - b), pi / 2), pi / 2})
    return quad(lambda t: ring(cos(t) * cos(b), sin(t) * sin(b)) * cos(t) * sin(t), ends)


def ring(level, swing):
    """The integral over the azimuth f of 1 + 2 (level + swing cos(f)), where the last is positive."""
    if level >= swing:
        return 2 * pi * (1 + 2 * level)
    end = acos(-level / swing) if -level < swing else 0
    return 2 * (end * (1 + 2 * level) + 2 * sin(end) * swing)


def tilt(film):
    """Angle between the film's normal and the zenith."""
    (ux, uy, uz), (vx, vy, vz) = ([mpf(x) for x in film[side]] for side in ("u", "v"))
    normal = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    return acos(normal[2] / sqrt(sum(x * x for x in normal)))


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/overcast-sky.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
