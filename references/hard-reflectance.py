"""Second derivation for hard-reflectance: reflections doubled, the radiance of n and of 2 n of them gathered over the wall.

What a wall of uniform radiance 1 gives back of itself, `kept`, is an integral of cos cos / d^2 over the sphere with the chord
d between two points of it, by double exponential quadrature. After n reflections it has added 1 + kept + ... + kept^n; after
2 n + 1 that and kept^(n+1) times it, so that 10^8 reflections are 27 steps. A point light's own light is reflected once,
then the wall does the rest; its flux reaches the wall through rings of directions. 50 digits.
"""

import json
import tomllib
from pathlib import Path

from mpmath import mp, mpf, pi, quad, sin, sqrt

mp.dps = 50


def values(scene, elements):
    """Irradiance [W/m2] at points of the wall; `scene` is the table of a scene file."""
    wall, film = scene["surface"][0], scene["film"]
    radius, kept = mpf(wall["shape"]["radius"]), mpf(wall["reflectance"]) / pi * gather(mpf(wall["shape"]["radius"]))
    settled = series(kept, scene["max_bounces"])
    glow = gather(radius) * mpf(wall["radiance"]) * settled
    return [float(glow + sum(bulb(light, wall, film["positions"][element], film["normals"][element], settled - 1)
                             for light in scene.get("light", []))) for element in elements]


def gather(radius):
    """Irradiance on the wall of a sphere whose wall has radiance 1: the integral of cos^2 / d^2 over its area."""

    def ring(polar):
        chord = 2 * radius * sin(polar / 2)
        cosine = chord / (2 * radius)
        return cosine * cosine / chord**2 * 2 * pi * radius**2 * sin(polar)

    return quad(ring, [0, pi])


def series(kept, last):
    """1 + kept + ... + kept^last, to the last digit where `last` is "all", by doubling the number of terms."""
    if last == "all":
        total, power = mpf(1), kept
        while power * total > mpf(10) ** -mp.dps:
            total, power = total * (1 + power), power * power
        return total
    total, power = mpf(0), mpf(1)  # of as many terms as the bits of last + 1 read so far say
    for bit in f"{last + 1:b}":
        total, power = total * (1 + power), power * power
        if bit == "1":
            total, power = total + power, power * kept
    return total


def bulb(light, wall, position, normal, reflected):
    """A point light's own irradiance, and its mean over the wall as often as it is reflected."""
    centre, radius = vector(wall["shape"]["center"]), mpf(wall["shape"]["radius"])
    place, n = vector(light["position"]), vector(normal)
    ray = [p - x for p, x in zip(place, vector(position), strict=True)]
    intensity, square = mpf(light["intensity"]), sum(x * x for x in ray)
    own = intensity * sum(a * b for a, b in zip(ray, n, strict=True)) / (square * sqrt(square * sum(x * x for x in n)))
    return own + reflected * intensity * mean(sqrt(sum((p - c) ** 2 for p, c in zip(place, centre, strict=True))), radius)


def mean(off, radius):
    """Mean irradiance on the wall per intensity from a point at a distance from the centre, by rings around that line."""

    def ring(height):
        square = radius**2 + off**2 - 2 * off * height
        return (radius - off * height / radius) / (square * sqrt(square)) * 2 * pi * radius

    return quad(ring, [-radius, 0, radius]) / (4 * pi * radius**2)


def vector(numbers):
    return tuple(mpf(number) for number in numbers)


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/hard-reflectance.toml").read_text(encoding="utf-8"))
    print(json.dumps({"base": dict(enumerate(values(scene, range(len(scene["film"]["positions"])))))}))
