"""Methods of direct light: by the compiled kernel where the film has a `View`, else by a ray tracer."""

from __future__ import annotations

from abc import abstractmethod
from typing import ClassVar

import numpy as np

from lightproof.estimators import peaks, world
from lightproof.estimators.estimator import Estimator
from lightproof.estimators.pieces import Piece
from lightproof.estimators.views import View, view
from lightproof.method import Rendering
from lightproof.scene import Scene


class Composed(Estimator):
    """`real` is the kernel's arithmetic; the ray tracer's is float64."""

    real: ClassVar[type[np.floating]] = np.float32

    def build(self, scene: Scene) -> None:
        seen = self.seen(scene)
        self.pieces = self.sources(scene, seen) if seen else []
        self.view = seen if self.pieces else None  # where nothing shines, rays find nothing
        self.peaks = peaks.peaks(seen, [piece.lamp for piece in self.pieces]) if self.view else None
        self.precision = np.dtype(self.real).name if self.view else "float64"
        self.world = None if self.view else world.build(scene)

    def seen(self, scene: Scene) -> View | None:
        """What receives, as the kernel takes it; None where it cannot."""
        return view(scene)

    @abstractmethod
    def sources(self, scene: Scene, seen: View) -> list[Piece]:
        """The kernel's sources."""

    def warm_up(self) -> None:
        self.render(1, seed=0)

    def render(self, samples: int, seed: int) -> Rendering:
        return self.composed(samples, seed) if self.view else self.traced(samples, seed)

    @abstractmethod
    def composed(self, samples: int, seed: int) -> Rendering:
        """The film by the kernel."""

    @abstractmethod
    def traced(self, samples: int, seed: int) -> Rendering:
        """The film by a ray tracer."""
