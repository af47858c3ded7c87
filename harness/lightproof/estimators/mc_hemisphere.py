"""Monte Carlo over the hemisphere, uniform in solid angle: E ~ (2 pi/N) sum L(w) cos(theta)."""

from __future__ import annotations

import numpy as np

from lightproof.estimators.directions import estimate
from lightproof.estimators.estimator import Sampler
from lightproof.estimators.limits import no_bulbs, no_cylinders, no_reflections, no_solid_angle
from lightproof.estimators.world import build
from lightproof.scene import Scene


class McHemisphere(Sampler):
    """Any direct light that fills a solid angle."""

    samples_lights = False
    limits = (no_cylinders, no_solid_angle, no_reflections, no_bulbs)
    power = 0

    def build(self, scene: Scene) -> None:
        self.world = build(scene)

    def add(self, first: int, last: int, samples: tuple[int, int], seed: int, out: np.ndarray) -> None:
        items, skies, _, film, elements, contact = self.world.arrays
        estimate(items, skies, film, elements[first:last], contact, first, seed, samples, self.power, out)
