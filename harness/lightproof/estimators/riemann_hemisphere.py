"""The textbook's Riemann sum over directions: the element in a midpoint grid, the hemisphere in cells of equal solid angle,
midpoints in z = cos(theta) and phi, E ~ sum L(z, phi) z dz dphi."""

from __future__ import annotations

import math

import numpy as np

from lightproof.estimators.compiled import strict, strict_kernel
from lightproof.estimators.directions import cosine_power, oriented
from lightproof.estimators.limits import no_bulbs, no_caps, no_cylinders, no_reflections, no_solid_angle
from lightproof.estimators.meeting import Uniform
from lightproof.estimators.pieces import Piece, met
from lightproof.estimators.points import Grid, grid
from lightproof.estimators.riemann import Riemann
from lightproof.estimators.touching import no_ball_below
from lightproof.estimators.tracing import receive, seen
from lightproof.estimators.views import View, view_from_outside
from lightproof.scene import Scene


@strict
def irradiance(items, skies, x, n, rings, contact):
    """Midpoint sum over `rings` steps of z and as many of phi [W/m2]."""
    total = 0.0
    for j in range(rings):
        for k in range(rings):
            w = cosine_power(0, (j + 0.5) / rings, (k + 0.5) / rings)
            total += w[2] * seen(items, skies, x, oriented(w, n), contact)
    return total * 2 * math.pi / rings**2


@strict_kernel
def estimate(items, skies, film, elements, contact, side, rings, out):
    """Adds up the film value of the midpoints of `side` x `side` cells of each element; `out` (n, 1)."""
    for e in range(len(elements)):
        total = 0.0
        for i in range(side * side):
            p, q = (i % side + 0.5) / side - 0.5, (i // side + 0.5) / side - 0.5
            value, factor, x, n = receive(items, skies, film, elements[e], p, q, contact)
            if factor > 0:
                value += factor * irradiance(items, skies, x, n, rings, contact)
            total += value
        out[e, 0] = total


class RiemannHemisphere(Riemann):
    """Direct light that fills a solid angle; `samples` become a square grid of the element times rings of directions."""

    samples_lights = False
    limits = (no_cylinders, no_caps, no_solid_angle, no_reflections, no_bulbs, no_ball_below)

    def seen(self, scene: Scene) -> View | None:
        return view_from_outside(scene)

    def sources(self, scene: Scene, seen: View) -> list[Piece]:
        return met(scene, seen, Uniform)

    def grid(self, samples: int) -> Grid:
        """Along the element's side half the sixth root of `samples`, for directions decide the error; as many steps of z as of
        phi: more of phi would leave the rings near the normal too wide."""
        side = max(1, round(samples ** (1 / 6) / 2)) if self.extended else 1
        rings = max(1, round(samples**0.5 / side))
        return grid(rings, side)

    def trace(self, cut: Grid, first: int, last: int, out: np.ndarray) -> None:
        items, skies, _, film, elements, contact = self.world.arrays
        estimate(items, skies, film, elements[first:last], contact, cut.side, cut.across, out)
