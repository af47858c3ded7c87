"""What the textbook's Riemann sums share: a grid of midpoints over the element and over the light or the hemisphere."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from lightproof.estimators.composed import Composed
from lightproof.estimators.estimator import TRACED, spread, tasks
from lightproof.estimators.peaks import largest
from lightproof.estimators.points import Grid
from lightproof.method import Rendering
from lightproof.scene import Scene


class Riemann(Composed):
    """Every piece of every light is summed over the same grid; `extended` says whether elements have an extent."""

    deterministic = True
    real = np.float32

    def build(self, scene: Scene) -> None:
        super().build(scene)
        self.extended = self.view.extended if self.view else bool(np.any(self.world.elements[:, 3:9]))

    @abstractmethod
    def grid(self, samples: int) -> Grid:
        """The grid of about `samples` points."""

    @abstractmethod
    def trace(self, cut: Grid, first: int, last: int, out: np.ndarray) -> None:
        """Adds up, by rays, the film's values of elements `first` to `last` at the element's midpoints; `out` (n, 1)."""

    def composed(self, samples: int, seed: int) -> Rendering:
        cut = self.grid(samples)
        film = sum(piece.received(self.view, cut, self.real(1), self.threads)[0] for piece in self.pieces)
        return Rendering(film, cut.samples, peak=largest(self.peaks, np.ones(len(self.pieces))))

    def traced(self, samples: int, seed: int) -> Rendering:
        cut = self.grid(samples)
        most = tasks(self.size * cut.samples, TRACED)
        sums = spread(lambda first, last, span, out: self.trace(cut, first, last, out), self.size, 1, 1, self.threads, most)
        return Rendering(sums[:, 0] / cut.side**2, cut.samples)
