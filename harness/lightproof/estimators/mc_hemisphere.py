"""Monte Carlo over the hemisphere, uniform in solid angle: E ~ (2 pi/N) sum L(w) cos(theta)."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from lightproof.estimators import directions
from lightproof.estimators.estimator import sampled
from lightproof.estimators.limits import no_bulbs, no_caps, no_cylinders, no_reflections, no_solid_angle
from lightproof.estimators.meeting import Cosine, Uniform
from lightproof.estimators.pieces import Piece, met
from lightproof.estimators.sampling import Sampling
from lightproof.estimators.touching import no_ball_below
from lightproof.estimators.views import View, view_from_outside
from lightproof.method import Rendering
from lightproof.scene import Scene


class McHemisphere(Sampling):
    """Any direct light that fills a solid angle."""

    domain = "hemisphere of the receiver"
    density = "1/(2 pi) per solid angle"
    samples_lights = False
    limits = (no_cylinders, no_caps, no_solid_angle, no_reflections, no_bulbs, no_ball_below)
    source: ClassVar[type[Uniform | Cosine]] = Uniform

    def seen(self, scene: Scene) -> View | None:
        return view_from_outside(scene)

    def sources(self, scene: Scene, seen: View) -> list[Piece]:
        return met(scene, seen, self.source)

    def composed(self, samples: int, seed: int) -> Rendering:
        """All pieces are looked for in the same directions. A direction meets one of them, so that the values' products
        vanish: the covariance of two sums over N directions is minus the product of their means over N."""
        points = self.points(samples, seed)
        taken = points.samples
        films, own = zip(*(piece.received(self.view, points, self.real(1), self.threads) for piece in self.pieces), strict=True)
        film = sum(films)
        if not self.varies(taken):
            return Rendering(film, taken)
        shared = (film**2 - sum(one**2 for one in films)) / (taken - 1)
        return Rendering(film, taken, np.maximum(sum(own) - shared, 0))

    def traced(self, samples: int, seed: int) -> Rendering:
        items, skies, _, film, elements, contact = self.world.arrays
        power = {Uniform: 0, Cosine: 1}[self.source]

        def add(first: int, last: int, span: tuple[int, int], out: np.ndarray) -> None:
            directions.estimate(items, skies, film, elements[first:last], contact, first, seed, span, power, out)

        return Rendering(*sampled(add, self.size, samples, self.threads))
