"""Second derivation for the solid angle of round things: ring by ring.

Caps, and balls, which are seen as caps: rings about their axis, of which the horizon leaves an arc. Disks: rings in their plane
about the foot of the perpendicular, h away, with h q/(h^2 + q^2)^(3/2) per radius q and azimuth; of each, the arc in the disk
and above the horizon. Double exponential quadrature in 30 digits, split where either begins to cut. Prints the base case of
solid-angle-disk as JSON.
"""

import json
import tomllib
from pathlib import Path

from mpmath import acos, asin, atan2, cos, cot, mp, mpf, pi, quad, sin, sqrt

SCENES = ("solid-angle-disk", "solid-angle-cap")
SAME = mpf("1e-20")

mp.dps = 30


def values(scene, elements):
    """Visible solid angle [sr] at the film's points; `scene` is the table of a scene file."""
    film, light = scene["film"], scene["light"][0]
    normals = film.get("normals") or [None] * len(film["positions"])
    return [float(seen(light, vector(film["positions"][i]), normals[i] and unit(vector(normals[i])))) for i in elements]


def seen(light, x, normal):
    """Solid angle of a light from one point."""
    if "half_angle" in light:
        return cap(unit([-c for c in vector(light["direction"])]), pi * mpf(light["half_angle"]) / 180, normal)
    shape = light["shape"]
    if shape["type"] == "disk":
        return disk(shape, x, normal)
    ray = minus(vector(shape["center"]), x)
    return cap(unit(ray), asin(mpf(shape["radius"]) / length(ray)), normal)


def cap(axis, half_angle, normal):
    """A cap of directions above a horizon."""
    if normal is None:
        return quad(lambda b: 2 * pi * sin(b), [0, half_angle])
    height = dot(axis, normal)
    swing, rise = sqrt(max(mpf(0), 1 - height**2)), asin(max(-1, min(1, height)))
    cut = min(abs(rise), half_angle)
    whole = quad(lambda b: 2 * pi * sin(b), [0, cut]) if height > 0 else mpf(0)
    if cut == half_angle or not swing:
        return whole
    return whole + quad(lambda b: 2 * acos(max(-1, min(1, -height * cot(b) / swing))) * sin(b), [cut, half_angle])


def disk(shape, x, normal):
    """A disk's front, by rings in its plane about the foot of the perpendicular."""
    centre, axis, radius = minus(vector(shape["center"]), x), unit(vector(shape["normal"])), mpf(shape["radius"])
    height = -dot(centre, axis)
    if height <= 0:
        return mpf(0)
    foot = [-height * c for c in axis]
    off = minus(centre, foot)
    offset = length(off)
    away = unit(off) if offset > SAME else across(axis)
    beside = cross(axis, away)
    level = (dot(foot, normal), dot(away, normal), dot(beside, normal)) if normal else (mpf(1), mpf(0), mpf(0))

    def ring(q):
        return shared(arc(q, offset, radius), horizon(q, *level)) * height * q / (height**2 + q**2) ** mpf(1.5)

    ends = {abs(offset - radius), offset + radius, *rim_crossings(offset, radius, *level)}
    ends |= {abs(level[0]) / sqrt(level[1] ** 2 + level[2] ** 2)} if level[1] or level[2] else set()
    ends = sorted(end for end in ends if max(0, offset - radius) <= end <= offset + radius)
    return quad(ring, ends if offset >= radius else [mpf(0), *ends])


def arc(q, offset, radius):
    """Half the azimuths, about that of the centre, at which a circle of radius q around the foot is in the disk."""
    if q <= radius - offset:
        return pi
    return acos(max(-1, min(1, (offset**2 + q**2 - radius**2) / (2 * offset * q))))


def horizon(q, level, along, beside):
    """Middle and half width of the azimuths at which that circle is above the horizon."""
    swing = q * sqrt(along**2 + beside**2)
    if swing <= abs(level):
        return mpf(0), pi if level > 0 else mpf(0)
    return atan2(beside, along), acos(-level / swing)


def shared(half, other):
    """Azimuths within `half` of 0 and within the other's half width of its middle."""
    middle, width = other
    return sum(max(mpf(0), min(half, middle + turn + width) - max(-half, middle + turn - width)) for turn in (-2 * pi, 0, 2 * pi))


def rim_crossings(offset, radius, level, along, beside):
    """Distances from the foot at which the horizon cuts the rim."""
    swing = radius * sqrt(along**2 + beside**2)
    if not swing or abs(level + offset * along) >= swing:
        return []
    middle, half = atan2(beside, along), acos(-(level + offset * along) / swing)
    return [sqrt(offset**2 + radius**2 + 2 * offset * radius * cos(middle + side * half)) for side in (1, -1)]


def vector(numbers):
    return [mpf(number) for number in numbers]


def minus(a, b):
    return [p - q for p, q in zip(a, b, strict=True)]


def dot(a, b):
    return sum(p * q for p, q in zip(a, b, strict=True))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def length(a):
    return sqrt(dot(a, a))


def unit(a):
    return [c / length(a) for c in a]


def across(normal):
    """A unit vector across another."""
    return unit(cross(normal, [mpf(1), mpf(0), mpf(0)] if abs(normal[0]) < 0.7 else [mpf(0), mpf(1), mpf(0)]))


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/solid-angle-disk.toml").read_text(encoding="utf-8"))
    print(json.dumps({"base": dict(enumerate(values(scene, range(len(scene["film"]["positions"])))))}))
