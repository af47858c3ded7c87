"""The textbook's Riemann sum over the light: both the light's piece and the film's element are cut into a midpoint grid."""

from __future__ import annotations

import numpy as np

from lightproof.estimators.compiled import strict, strict_kernel
from lightproof.estimators.lamps import glowing
from lightproof.estimators.lighting import from_bulbs, from_item
from lightproof.estimators.limits import no_caps, no_cylinders, no_reflections, no_skies, no_solid_angle
from lightproof.estimators.pieces import Piece, aimed
from lightproof.estimators.points import Grid, grid
from lightproof.estimators.riemann import Riemann
from lightproof.estimators.touching import no_light_below
from lightproof.estimators.tracing import receive
from lightproof.estimators.views import View
from lightproof.estimators.world import SAMPLED
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


class RiemannArea(Riemann):
    """Direct light from everything that has an area; `samples` become two square grids, as near as squares allow."""

    limits = (no_cylinders, no_caps, no_solid_angle, no_reflections, no_skies, no_light_below)

    def build(self, scene: Scene) -> None:
        super().build(scene)
        self.lights = bool(glowing(scene))

    def sources(self, scene: Scene, seen: View) -> list[Piece]:
        return aimed(scene, seen)

    def grid(self, samples: int) -> Grid:
        """As many midpoints along a side of the element as of the light; all of them where the other has no extent."""
        if not self.lights:
            return grid(1, max(1, round(samples**0.5)) if self.extended else 1)
        side = max(1, round(samples**0.25)) if self.extended else 1
        light_side = max(1, round(samples**0.5 / side))
        return grid(light_side, side)

    def trace(self, cut: Grid, first: int, last: int, out: np.ndarray) -> None:
        items, skies, bulbs, film, elements, contact = self.world.arrays
        estimate(items, skies, bulbs, film, elements[first:last], contact, cut.side, cut.across, out)
