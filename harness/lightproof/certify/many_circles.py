"""The circles of `circles`, for n receivers at once and in binary64: arrays (n, ...), angles (n, k), directions (n, k, 3)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

Array = np.ndarray
PARALLEL = 1e-6  # of a form: its part in twice the angle, below which Newton's method starts without it
FARTHEST = 0.1  # radians: the longest of Newton's steps
SMALL = 1e-9  # of a rim's distance: how far off the axis its centre may be taken to lie on it


@dataclass(frozen=True, eq=False)
class Greats:
    """Great circles across `normal` (n, 3), of unit length; on their left normal . d > 0."""

    normal: Array

    @cached_property
    def basis(self) -> tuple[Array, Array]:
        """Unit vectors (n, 3) at angles 0 and pi/2."""
        first = across(self.normal)
        return first, np.cross(self.normal, first)

    def at(self, angle: Array) -> Array:
        """Directions at angles."""
        first, second = self.basis
        return np.cos(angle)[..., None] * first[:, None] + np.sin(angle)[..., None] * second[:, None]

    def angle(self, direction: Array) -> Array:
        """Angles of directions on the circles."""
        return np.arctan2(*(dots(direction, side) for side in self.basis[::-1]))

    def left(self, direction: Array) -> Array:
        """Whether directions are on the left."""
        return dots(direction, self.normal) > 0

    def contour(self, start: Array, end: Array, normal: Array) -> Array:
        """Integrals of normal . (r x dr) / |r|^2."""
        return (end - start) * (self.normal @ normal)[:, None]


@dataclass(frozen=True, eq=False)
class Rims:
    """Circles with `centre` (n, 3), across unit `axis` (n, 3), axis . centre > 0, of `radius` (n,); inside is on their left."""

    centre: Array
    axis: Array
    radius: Array

    @cached_property
    def height(self) -> Array:
        """axis . centre, (n,)."""
        return (self.axis * self.centre).sum(-1)

    @cached_property
    def basis(self) -> tuple[Array, Array]:
        """Unit vectors at angles 0, along the centre's offset from the axis, and pi/2."""
        offset = self.centre - self.height[:, None] * self.axis
        size = np.linalg.norm(offset, axis=-1, keepdims=True)
        first = np.where(size > SMALL * self.height[:, None], offset / np.maximum(size, 1e-300), across(self.axis))
        return first, np.cross(self.axis, first)

    def at(self, angle: Array) -> Array:
        """Points at angles."""
        first, second = (self.radius[:, None] * side for side in self.basis)
        return self.centre[:, None] + np.cos(angle)[..., None] * first[:, None] + np.sin(angle)[..., None] * second[:, None]

    def angle(self, direction: Array) -> Array:
        """Angles of directions on the rims."""
        spoke = (self.height[:, None] / dots(direction, self.axis))[..., None] * direction - self.centre[:, None]
        return np.arctan2(*(dots(spoke, side) for side in self.basis[::-1]))

    def form(self, a: Array, b: Array) -> Array:
        """The bilinear form, negative for a = b inside the cone through the rim; a and b (n, k, 3)."""
        high, low = dots(a, self.axis), dots(b, self.axis)
        mixed = high * dots(b, self.centre) + low * dots(a, self.centre)
        slack = (self.centre**2).sum(-1) - self.radius**2
        h = self.height[:, None]
        return h * (h * (a * b).sum(-1) - mixed) + high * low * slack[:, None]

    def left(self, direction: Array) -> Array:
        """Whether directions are inside."""
        return (self.form(direction, direction) < 0) & (dots(direction, self.axis) > 0)

    def contour(self, start: Array, end: Array, normal: Array) -> Array:
        """Integrals of normal . (r x dr) / |r|^2; see `circles.Rim.contour`."""
        level, cosines, sines = (b - a for a, b in zip(self._primitives(start), self._primitives(end), strict=True))
        first, second = (np.cross(self.centre, side) @ normal for side in self.basis)
        r = self.radius[:, None]
        return r * (r * (self.axis @ normal)[:, None] * level + second[:, None] * cosines - first[:, None] * sines)

    def _primitives(self, f: Array) -> tuple[Array, Array, Array]:
        """Integrals of 1, cos f and sin f over p + q cos f = |r|^2."""
        p = (self.centre**2).sum(-1) + self.radius**2
        q = 2 * self.radius * (self.centre * self.basis[0]).sum(-1)
        d = np.sqrt((p - q) * (p + q))
        k, p, q, d = (number[:, None] for number in (q / (p + d), p, q, d))
        slight = np.abs(k) < SMALL
        bend = np.arctan2(k * np.sin(f), 1 + k * np.cos(f))
        swing = np.where(slight, np.sin(f), bend / np.where(slight, 1, k))
        fall = np.where(slight, np.cos(f) / p, np.log1p(q / p * np.cos(f)) / np.where(slight, 1, q))
        return (f - 2 * bend) / d, ((1 + k * k) * swing - k * f) / d, -fall


Circles = Greats | Rims


def crossings(a: Circles, b: Circles) -> Array:
    """Directions (n, k, 3) among which all crossings of two circles are."""
    if isinstance(a, Greats) and isinstance(b, Greats):
        both = np.cross(a.normal, b.normal)
        return np.stack([both, -both], axis=1)
    if isinstance(a, Rims) and isinstance(b, Rims):
        return a.at(_roots(a, b))
    rim, great = (a, b) if isinstance(a, Rims) else (b, a)
    x, y = (rim.radius * (side * great.normal).sum(-1) for side in rim.basis)
    level = (rim.centre * great.normal).sum(-1)
    reach = np.sqrt(np.maximum(x * x + y * y - level * level, 0))
    return rim.at(np.stack([np.arctan2(y, x) + sign * np.arctan2(reach, -level) for sign in (-1, 1)], axis=1))


def _roots(path: Rims, rim: Rims) -> Array:
    """Angles (n, 4) on a rim among which all crossings with another are: those of a quartic in exp(i f), of a quadratic where
    the rims are parallel, and a few of Newton's steps on."""
    r, c, (a, b) = path.radius, path.centre[:, None], (side[:, None] for side in path.basis)
    aa, bb, ab, ca, cb, cc = (rim.form(p, q)[:, 0] for p, q in ((a, a), (b, b), (a, b), (c, a), (c, b), (c, c)))
    level, once, twice = cc + r**2 * (aa + bb) / 2, 2 * r * (ca - 1j * cb), r**2 * ((aa - bb) / 2 - 1j * ab)
    size = np.abs(level) + np.abs(once) + np.abs(twice)
    bent = np.abs(twice) > PARALLEL * size
    angles = np.where(bent[:, None], _quartic(level, once, np.where(bent, twice, size)), _quadratic(level, once))
    for _ in range(3):
        turn = np.exp(1j * angles)
        waves = once[:, None] * turn, twice[:, None] * turn**2
        slope = -(waves[0] + 2 * waves[1]).imag
        step = (level[:, None] + (waves[0] + waves[1]).real) / np.where(slope, slope, 1)
        angles = angles - np.clip(step, -FARTHEST, FARTHEST)
    return np.angle(np.exp(1j * angles))


def _quartic(level: Array, once: Array, twice: Array) -> Array:
    """The arguments (n, 4) of the roots z of level + Re(once z + twice z^2) = 0 on |z| = 1, and of some that are not on it."""
    rest = np.stack([once, 2 * level + 0j, np.conj(once), np.conj(twice)], axis=-1) / twice[:, None]
    matrix = np.zeros((len(level), 4, 4), complex)
    matrix[:, 0] = -rest
    matrix[:, [1, 2, 3], [0, 1, 2]] = 1
    return np.angle(np.linalg.eigvals(matrix))


def _quadratic(level: Array, once: Array) -> Array:
    """The angles, each twice, at which level + Re(once exp(i f)) = 0."""
    half = np.arctan2(np.sqrt(np.maximum(np.abs(once) ** 2 - level**2, 0)), -level)
    return np.stack([sign * half - np.angle(once) for sign in (-1, 1, -1, 1)], axis=1)


def dots(a: Array, b: Array) -> Array:
    """Inner products (n, k) of (n, k, 3) with (n, 3)."""
    return np.einsum("nki,ni->nk", a, b)


def across(axis: Array) -> Array:
    """Unit vectors (n, 3) across unit vectors."""
    side = np.cross(axis, np.eye(3)[np.abs(axis).argmin(axis=-1)])
    return side / np.linalg.norm(side, axis=-1, keepdims=True)
