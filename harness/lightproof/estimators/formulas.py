"""The formulas that textbooks print, as they print them: in world coordinates, with arccos, 1 - cos and differences of nearly
equal numbers, without a horizon. Right on paper; `textbook` shows where they are not in floating point, and nothing else
uses them.

Everything is an array of one precision, which the results keep. `x` (n, 3) and `n` (n, 3) are receivers and their unit
normals; a form factor (n,) times pi L is the irradiance. The one care taken: an arccos has its argument held to [-1, 1].
"""

from __future__ import annotations

import numpy as np


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Along the last axis."""
    return (a * b).sum(axis=-1)


def unit(a: np.ndarray) -> np.ndarray:
    """Without scaling: 0/0 where `a` is zero."""
    return a / np.sqrt(dot(a, a))[..., None]


def angle(cosine: np.ndarray) -> np.ndarray:
    """By arccos [rad]."""
    return np.arccos(np.clip(cosine, -1, 1))


def above(normal: np.ndarray, point: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Height over a plane by its equation in world coordinates, n . x - n . p [m]."""
    return dot(normal, x) - dot(normal, point)


def polygon(corners: np.ndarray, x: np.ndarray, n: np.ndarray) -> np.ndarray:
    """Lambert 1760: half the sum of each edge's angle times its plane's normal, over pi; corners (..., m, 3) or (m, 3), none
    clipped."""
    spokes = unit(corners - x[:, None])
    others = np.roll(spokes, -1, axis=1)
    sides = unit(np.cross(others, spokes))
    return (angle(dot(spokes, others)) * dot(sides, n[:, None])).sum(axis=1) / (2 * np.pi)


def polygon_angle(corners: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Girard: the solid angle of a convex polygon (m, 3) as its spherical excess, the sum of its angles less (m - 2) pi [sr]."""
    spokes = corners - x[:, None]
    sides = unit(np.cross(spokes, np.roll(spokes, -1, axis=1)))
    inner = np.pi - angle(dot(sides, np.roll(sides, -1, axis=1)))
    return inner.sum(axis=1) - np.pi * (len(corners) - 2)


def disk(center: np.ndarray, axis: np.ndarray, radius: np.ndarray, x: np.ndarray, n: np.ndarray) -> np.ndarray:
    """A disk from a receiver that lies level, (1 - (h2 + a2 - r2)/root)/2, and from one that stands, h/(2 a) ((h2 + a2 + r2)/root
    - 1), added as vectors (Howell's catalogue, B-12 and B-15); the horizon does not cut it."""
    h = above(axis, center, x)
    outward = x - center - h[:, None] * axis
    a2, h2, r2 = dot(outward, outward), h * h, radius * radius
    root = np.sqrt((h2 + a2 + r2) ** 2 - 4 * r2 * a2)
    level = (1 - (h2 + a2 - r2) / root) / 2
    standing = np.where(a2 > 0, h / (2 * np.sqrt(a2)) * ((h2 + a2 + r2) / root - 1), 0)
    inward = -outward / np.sqrt(np.where(a2 > 0, a2, 1))[:, None]
    return np.where(h > 0, level * -dot(n, axis) + standing * dot(n, inward), 0)


def disk_angle(center: np.ndarray, axis: np.ndarray, radius: np.ndarray, x: np.ndarray) -> np.ndarray:
    """From the disk's axis, 2 pi (1 - cos a) [sr]."""
    h = above(axis, center, x)
    return 2 * np.pi * (1 - h / np.sqrt(h * h + radius * radius))


def sphere(center: np.ndarray, radius: np.ndarray, x: np.ndarray, n: np.ndarray) -> np.ndarray:
    """(R/d)2 cos(theta) above the horizon; cut by it, Snyder 1996."""
    towards = center - x
    d = np.sqrt(dot(towards, towards))
    cosine = dot(towards, n) / d
    sine = np.sqrt(1 - cosine * cosine)
    h = d / radius
    w = np.sqrt(h * h - 1)
    y = np.clip(-w * cosine / sine, -1, 1)
    root = np.sqrt(1 - y * y)
    cut = ((cosine * np.arccos(y) - w * sine * root) / (h * h) + np.arctan(sine * root / w)) / np.pi
    whole = np.where(cosine > 0, cosine / (h * h), 0)
    return np.where(np.abs(d * cosine) < radius, cut, whole)


def sphere_angle(center: np.ndarray, radius: np.ndarray, x: np.ndarray) -> np.ndarray:
    """2 pi (1 - cos a), sin a = R/d [sr]."""
    d2 = dot(center - x, center - x)
    return 2 * np.pi * (1 - np.sqrt(1 - radius * radius / d2))


def hidden(light: np.ndarray, blocker: np.ndarray, x: np.ndarray) -> np.ndarray:
    """The part (k, 3) of a convex light (m, 3) behind a convex blocker, as seen from one point (3,): cut by the plane through
    the point and each of the blocker's edges (Sutherland and Hodgman 1974). Planes by their equations in world coordinates."""
    middle = blocker.mean(axis=0)
    for start, end in zip(blocker, np.roll(blocker, -1, axis=0), strict=True):
        normal = np.cross(start - x, end - x)
        inward = np.sign(above(normal, x, middle))
        light = clipped(light, inward * above(normal, x, light))
    return light


def clipped(corners: np.ndarray, heights: np.ndarray) -> np.ndarray:
    """What of a convex polygon (m, 3) has a height (m,) of zero or more."""
    kept = []
    for k in range(len(corners)):
        low, high = heights[k - 1], heights[k]
        if (low < 0) != (high < 0):
            kept.append(corners[k - 1] + low / (low - high) * (corners[k] - corners[k - 1]))
        if high >= 0:
            kept.append(corners[k])
    return np.array(kept, corners.dtype).reshape(-1, 3)


def glow(reflectance: np.ndarray, reflections: int | None) -> np.ndarray:
    """All light in a closed shape over what it emits, after so many reflections: (1 - rho^(n+1))/(1 - rho)."""
    return (1 if reflections is None else 1 - reflectance ** (reflections + 1)) / (1 - reflectance)
