"""The textbook's Riemann sum over the light: both the light's piece and the film's element are cut into a midpoint grid."""

from __future__ import annotations

import numpy as np

from lightproof.estimators.compiled import strict, strict_kernel
from lightproof.estimators.estimator import Estimator, spread
from lightproof.estimators.lighting import from_bulbs, from_item
from lightproof.estimators.limits import no_cylinders, no_reflections, no_skies, no_solid_angle
from lightproof.estimators.tracing import receive
from lightproof.estimators.world import SAMPLED, build
from lightproof.method import Rendering
from lightproof.scene import Scene


@strict
def irradiance(items, bulbs, x, n, side, contact):
    """Midpoint sum of L V cos cos / r^2 over a grid of side x side points of every light [W/m2]."""
    total = from_bulbs(items, bulbs, x, n, contact)
    for k in range(len(items)):
        if items[k, SAMPLED] != 0:
            for j in range(side * side):
                total += from_item(items, k, x, n, (j % side + 0.5) / side, (j // side + 0.5) / side, contact) / (side * side)
    return total


@strict_kernel
def estimate(items, skies, bulbs, film, elements, contact, side, light_side, out):
    """Adds up the film value of the midpoints of `side` x `side` cells of each element, each with `light_side` x
    `light_side` midpoints of every light; `out` (n, 1)."""
    for e in range(len(elements)):
        total = 0.0
        for i in range(side * side):
            p, q = (i % side + 0.5) / side - 0.5, (i // side + 0.5) / side - 0.5
            value, factor, x, n = receive(items, skies, film, elements[e], p, q, contact)
            if factor > 0:
                value += factor * irradiance(items, bulbs, x, n, light_side, contact)
            total += value
        out[e, 0] = total


class RiemannArea(Estimator):
    """Direct light from everything that has an area; `samples` become two square grids, as near as squares allow."""

    deterministic = True
    limits = (no_cylinders, no_solid_angle, no_reflections, no_skies)

    def build(self, scene: Scene) -> None:
        self.world = build(scene)
        self.extended = bool(np.any(self.world.elements[:, 3:9]))  # points have no cells
        self.lights = bool(self.world.items[:, SAMPLED].any())

    def warm_up(self) -> None:
        self.render(1, seed=0)

    def grids(self, samples: int) -> tuple[int, int]:
        """Midpoints along a side of the element and of the light, their squares' product about `samples`."""
        if not (self.extended and self.lights):
            both = max(1, round(samples**0.5))
            return (both, 1) if self.extended else (1, both)
        side = max(1, round(samples**0.25))
        return side, max(1, round(samples**0.5 / side))

    def render(self, samples: int, seed: int) -> Rendering:
        side, light_side = self.grids(samples)
        items, skies, bulbs, film, rows, contact = self.world.arrays

        def add(first: int, last: int, span: tuple[int, int], out: np.ndarray) -> None:
            estimate(items, skies, bulbs, film, rows[first:last], contact, side, light_side, out)

        sums = spread(add, self.size, 1, 1, self.threads)
        return Rendering(sums[:, 0] / side**2, (side * light_side) ** 2)
