"""Monte Carlo over the lights' area: E ~ (1/N) sum L V cos(theta_x) cos(theta_y) / (r^2 p), y uniform over the light."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from lightproof.estimators.composed import Composed
from lightproof.estimators.estimator import sampled, variance_of_mean
from lightproof.estimators.limits import no_caps, no_cylinders, no_glowing_inside, no_reflections, no_skies, no_solid_angle
from lightproof.estimators.paths import Paths
from lightproof.estimators.pieces import Piece, aimed
from lightproof.estimators.points import Random
from lightproof.estimators.views import View
from lightproof.method import Rendering
from lightproof.scene import Scene

SEEDS = 2**24  # streams that one seed has for the pieces of lights


class McArea(Composed):
    """Beside the kernel's views, what cameras see by paths of one reflection, which trace the first ray."""

    limits = (no_cylinders, no_caps, no_solid_angle, no_reflections, no_skies, no_glowing_inside)

    def __init__(self, name: str, threads: int):
        super().__init__(name, threads)
        self.real = np.float64 if name.endswith("/float64") else np.float32

    def settings(self) -> Mapping[str, Any]:
        return {"sampler": "independent", "density": "uniform over the light; of a sphere, over the cap that faces the receiver"}

    def build(self, scene: Scene) -> None:
        super().build(scene)
        self.receivers = self.view.receivers if self.view else None
        self.paths = None if self.view else self.followed(scene)

    def followed(self, scene: Scene) -> Paths:
        """What is traced where there is no view: paths of one reflection at most."""
        return Paths(self.world, min(scene.max_bounces, 1) if scene.reflects else 0, glow=False)

    def sources(self, scene: Scene, seen: View) -> list[Piece]:
        return aimed(scene, seen)

    def composed(self, samples: int, seed: int) -> Rendering:
        counts = self.counts(samples)
        films, variances = zip(*[self.drawn(index, count, seed) for index, count in enumerate(counts)], strict=True)
        return Rendering(sum(films), sum(counts), None if any(one is None for one in variances) else sum(variances))

    def counts(self, samples: int) -> list[int]:
        """Samples are shared out over the lights' pieces by strength."""
        power = np.array([piece.lamp.strength for piece in self.pieces])
        shares = power / power.sum() if power.any() else np.full(len(power), 1 / len(power))
        return [max(1, round(samples * share)) for share in shares]

    def drawn(self, index: int, samples: int, seed: int) -> tuple[np.ndarray, np.ndarray | None]:
        """Film (n,) of one piece alone and its variance (n,)."""
        points = Random(samples, int(seed) * SEEDS + index)
        pivots, totals, squares = self.view.factor * self.pieces[index].sums(self.view, points, self.real(1), self.threads)
        return (pivots + totals) / samples, variance_of_mean(totals, self.view.factor * squares, samples)

    def traced(self, samples: int, seed: int) -> Rendering:
        return Rendering(*sampled(self.paths.add, self.size, samples, seed, self.threads))
