"""Second derivation for white-furnace-plane: the sky's radiance times the cosine, summed ring by ring about the normal.

In the ring at angle t from the normal of a plane tilted by b, the sky above the horizon fills the azimuths f with
cos(f) > -cot(t) cot(b). Double exponential quadrature in 30 digits. Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path

from mpmath import acos, cos, cot, mp, mpf, pi, quad, sin, sqrt

mp.dps = 30


def values(scene, elements):
    """Irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, sky = scene["film"], scene["light"][0]
    value = mpf(sky["radiance"]) * projected(tilt(film) if sky.get("extent") == "upper" else mpf(0))
    return [float(value) for _ in elements]


def projected(b):
    """Projected solid angle [sr] of the upper half of the sky for a plane tilted by b < pi."""
    whole = quad(lambda t: 2 * pi * cos(t) * sin(t), [0, max(0, pi / 2 - b)])
    if not b:
        return whole
    return whole + quad(lambda t: 2 * acos(max(mpf(-1), -cot(t) * cot(b))) * cos(t) * sin(t), [abs(pi / 2 - b), pi / 2])


def tilt(film):
    """Angle between the film's normal and the zenith."""
    (ux, uy, uz), (vx, vy, vz) = ([mpf(x) for x in film[side]] for side in ("u", "v"))
    normal = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    return acos(normal[2] / sqrt(sum(x * x for x in normal)))


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/white-furnace-plane.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
