"""The textbook's Riemann sum over directions: the element in a midpoint grid, the hemisphere in steps of theta and phi,
E ~ sum L(theta, phi) cos(theta) sin(theta) dtheta dphi."""

from __future__ import annotations

import math

import numpy as np

from lightproof.estimators.compiled import strict, strict_kernel
from lightproof.estimators.directions import oriented
from lightproof.estimators.estimator import Estimator, spread
from lightproof.estimators.limits import no_bulbs, no_cylinders, no_reflections, no_solid_angle
from lightproof.estimators.tracing import receive, seen
from lightproof.estimators.world import build
from lightproof.method import Rendering
from lightproof.scene import Scene

TURNS = 4  # steps of phi for a step of theta: about square cells


@strict
def irradiance(items, skies, x, n, rings, contact):
    """Midpoint sum over `rings` steps of theta and TURNS * rings of phi [W/m2]."""
    total = 0.0
    step = math.pi / 2 / rings
    for j in range(rings):
        theta = (j + 0.5) * step
        sine, cosine = math.sin(theta), math.cos(theta)
        for k in range(TURNS * rings):
            phi = 2 * math.pi * (k + 0.5) / (TURNS * rings)
            w = oriented((sine * math.cos(phi), sine * math.sin(phi), cosine), n)
            total += sine * cosine * seen(items, skies, x, w, contact)
    return total * step * 2 * math.pi / (TURNS * rings)


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


class RiemannHemisphere(Estimator):
    """Direct light that fills a solid angle; `samples` become a square grid of the element times rings of directions."""

    deterministic = True
    samples_lights = False
    limits = (no_cylinders, no_solid_angle, no_reflections, no_bulbs)

    def build(self, scene: Scene) -> None:
        self.world = build(scene)
        self.extended = bool(np.any(self.world.elements[:, 3:9]))  # points have no cells

    def warm_up(self) -> None:
        self.render(1, seed=0)

    def grids(self, samples: int) -> tuple[int, int]:
        """Midpoints along a side of the element, and rings of directions: side^2 TURNS rings^2 is about `samples`."""
        side = max(1, round((samples / TURNS) ** 0.25)) if self.extended else 1
        return side, max(1, round((samples / TURNS) ** 0.5 / side))

    def render(self, samples: int, seed: int) -> Rendering:
        side, rings = self.grids(samples)
        items, skies, _, film, rows, contact = self.world.arrays

        def add(first: int, last: int, span: tuple[int, int], out: np.ndarray) -> None:
            estimate(items, skies, film, rows[first:last], contact, side, rings, out)

        sums = spread(add, self.size, 1, 1, self.threads)
        return Rendering(sums[:, 0] / side**2, side**2 * TURNS * rings**2)
