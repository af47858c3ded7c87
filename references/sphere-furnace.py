"""Second derivation for sphere-furnace: bounce after bounce, the wall's radiance gathered over the wall.

The gathering is the integral of cos cos / d^2 over the sphere, with the chord d between two points of it, done by double
exponential quadrature in 30 digits. Prints the base case as JSON.
"""

import json
import tomllib
from pathlib import Path

from mpmath import mp, mpf, pi, quad, sin

mp.dps = 30


def values(scene, elements):
    """Radiance [W/(m2 sr)] or irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    wall = scene["surface"][0]
    gathered = gather(mpf(wall["shape"]["radius"]))
    radiance = settle(mpf(wall["radiance"]), mpf(wall["reflectance"]) / pi * gathered, scene["max_bounces"])
    value = radiance if scene["film"]["quantity"] == "radiance" else gathered * radiance
    return [float(value) for _ in elements]


def gather(radius):
    """Irradiance on the wall of a sphere whose wall has radiance 1: the integral of cos^2 / d^2 over its area."""

    def ring(polar):
        chord = 2 * radius * sin(polar / 2)
        cosine = chord / (2 * radius)
        return cosine * cosine / chord**2 * 2 * pi * radius**2 * sin(polar)

    return quad(ring, [0, pi])


def settle(emitted, kept, bounces):
    """Radiance after a number of bounces, or when it has settled to 30 digits; each bounce keeps a share of it."""
    radiance, added, bounce = emitted, emitted, 0
    while added > radiance * mpf(10) ** -mp.dps and (bounces == "all" or bounce < bounces):
        added *= kept
        radiance += added
        bounce += 1
    return radiance


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/sphere-furnace.toml").read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
