"""Second derivation for off-centre-point-in-sphere: direct light by the law of cosines in the triangle centre, lamp, wall;
reflected light by averaging the direct over the wall, bounce after bounce.

Any part dA of a sphere's wall receives the share dA / (4 pi r^2) of what any other part sends out, so what arrives by
reflection is everywhere the wall's mean. Points in 30 digits; pixels by a 16 x 16 Gauss rule in binary64. Prints the base
case as JSON.
"""

import json
import tomllib
from pathlib import Path

import numpy as np
from mpmath import mp, mpf, quad, sqrt

mp.dps = 30
NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)


def values(scene, elements):
    """Radiance [W/(m2 sr)] or irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, bulb, wall, last = scene["film"], scene["light"][0], scene["surface"][0], scene["max_bounces"]
    centre, radius, lamp = wall["shape"]["center"], mpf(wall["shape"]["radius"]), bulb["position"]
    offset = sqrt(sum((mpf(a) - mpf(b)) ** 2 for a, b in zip(lamp, centre, strict=True)))
    average = quad(lambda cosine: direct(radius, offset, cosine, sqrt), [-1, 1]) / 2
    rho, intensity = mpf(wall["reflectance"]), mpf(bulb["intensity"])
    if film["kind"] == "points":
        cosines = [cosine_at(film["positions"][element], centre, lamp, offset) for element in elements]
        reflected = average * series(rho, last)
        return [float(intensity * (direct(radius, offset, cosine, sqrt) + reflected)) for cosine in cosines]
    reflected = float(average * series(rho, last if last == "all" else last - 1))
    r, c, axis = float(radius), float(offset), np.subtract(lamp, centre) / float(offset)
    pixels = [mean(direct(r, c, wall_cosines(film, element, centre, r, axis), np.sqrt)) for element in elements]
    return [float(rho * intensity) / np.pi * (pixel + reflected) for pixel in pixels]


def direct(r, c, cosine, root):
    """Direct irradiance per intensity on the wall, `cosine` being that of the angle at the centre between lamp and wall."""
    return (r - c * cosine) / root(r * r + c * c - 2 * r * c * cosine) ** 3


def series(rho, last):
    """rho + rho^2 + ... to the power `last`, or until nothing is added to 30 digits."""
    total, term, count = mpf(0), rho, 1
    while term > mpf(10) ** -mp.dps and (last == "all" or count <= last):
        total, term, count = total + term, term * rho, count + 1
    return total


def cosine_at(position, centre, lamp, offset):
    """Cosine of the angle at the centre between a point of the wall and the lamp."""
    arms = [(mpf(x) - mpf(c), mpf(y) - mpf(c)) for x, y, c in zip(position, lamp, centre, strict=True)]
    return sum(x * y for x, y in arms) / (sqrt(sum(x * x for x, _ in arms)) * offset)


def wall_cosines(film, element, centre, radius, axis):
    """The same cosine where the rays through a pixel's nodes meet the wall, (16, 16)."""
    origin, (columns, rows) = np.array(film["origin"]), film["resolution"]
    forward = np.subtract(film["target"], origin)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, film["up"])
    right /= np.linalg.norm(right)
    up, half = np.cross(right, forward), np.tan(np.radians(film["fov"]) / 2)
    row, column = divmod(element, columns)
    x = half * (2 * (column + (1 + NODES) / 2) / columns - 1)
    y = half * (rows - 2 * (row + (1 - NODES) / 2)) / columns
    rays = forward + x[:, None, None] * right + y[None, :, None] * up
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    start = origin - np.array(centre)
    along = rays @ start
    reach = np.sqrt(along**2 - start @ start + radius**2) - along
    return (start + reach[..., None] * rays) @ axis / radius


def mean(samples):
    """Gauss mean over a pixel, its nodes (16, 16)."""
    return float(WEIGHTS @ samples @ WEIGHTS / 4)


if __name__ == "__main__":
    path = Path(__file__).resolve().parents[1] / "scenes/off-centre-point-in-sphere.toml"
    scene = tomllib.loads(path.read_text(encoding="utf-8"))
    columns, rows = scene["film"]["resolution"]
    print(json.dumps({"base": dict(enumerate(values(scene, range(columns * rows))))}))
