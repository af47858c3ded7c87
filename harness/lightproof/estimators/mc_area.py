"""Monte Carlo over the lights' area: E ~ (1/N) sum L V cos(theta_x) cos(theta_y) / (r^2 p), y uniform over the light."""

from __future__ import annotations

from functools import partial, reduce

import numpy as np

from lightproof.estimators.estimator import sampled
from lightproof.estimators.horizons import cut
from lightproof.estimators.lamps import Lamp
from lightproof.estimators.limits import no_caps, no_cylinders, no_glowing_inside, no_reflections, no_skies, no_solid_angle
from lightproof.estimators.paths import Paths
from lightproof.estimators.peaks import largest
from lightproof.estimators.pieces import Piece, aimed
from lightproof.estimators.points import Random
from lightproof.estimators.sampling import Sampling
from lightproof.estimators.touching import no_light_below
from lightproof.estimators.views import View
from lightproof.method import Rendering
from lightproof.scene import Scene

SEEDS = 2**24  # streams that one seed has for the pieces of lights


class McArea(Sampling):
    """Beside the kernel's views, what cameras see by paths of one reflection, which trace the first ray. Lights that a horizon
    cuts are float64."""

    domain = "area of the light"
    density = "1/A per area, uniform over the light; of a sphere, over the cap that faces the receiver"
    limits = (no_cylinders, no_caps, no_solid_angle, no_reflections, no_skies, no_glowing_inside, no_light_below)

    def build(self, scene: Scene) -> None:
        super().build(scene)
        self.receivers = self.view.receivers if self.view else None
        self.shares = shares([piece.power for piece in self.pieces])
        self.models = [np.float64(1) if isinstance(piece.lamp, Lamp) and cut(piece.lamp.shape, self.view) else self.real(1)
                       for piece in self.pieces]
        self.paths = None if self.view else self.followed(scene)

    def followed(self, scene: Scene) -> Paths:
        """What is traced where there is no view: paths of one reflection at most."""
        return Paths(self.world, min(scene.max_bounces, 1) if scene.reflects else 0, glow=False)

    def sources(self, scene: Scene, seen: View) -> list[Piece]:
        return aimed(scene, seen)

    def composed(self, samples: int, seed: int) -> Rendering:
        counts = (max(1, round(samples * share)) for share in self.shares)
        drawn = [self.drawn(index, count, seed) for index, count in enumerate(counts)]
        films, counts, variances = zip(*drawn, strict=True)
        taken = sum(counts)
        variance = None if any(one is None for one in variances) else reduce(np.add, variances)
        peak = largest(self.peaks, [count / taken for count in counts])
        return Rendering(reduce(np.add, films), taken, variance, peak=peak)

    def drawn(self, index: int, samples: int, seed: int) -> tuple[np.ndarray, int, np.ndarray | None]:
        """Film (n,) of one piece alone, samples taken, and its variance (n,)."""
        points = self.points(samples, int(seed) * SEEDS + index)
        film, variance = self.pieces[index].received(self.view, points, self.models[index], self.threads)
        return film, points.samples, variance if self.varies(points.samples) else None

    def traced(self, samples: int, seed: int) -> Rendering:
        points = self.points(samples, seed)
        film, taken, variance = sampled(partial(self.paths.add, points), self.size, points.samples, self.threads)
        return Rendering(film, taken, variance if self.points is Random else None)


def shares(power: list[float]) -> list[float]:
    """Of the samples, by the power of lights' pieces; equal ones where none shines."""
    total = sum(power)
    return [one / total if total else 1 / len(power) for one in power]
