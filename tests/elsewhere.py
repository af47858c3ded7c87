"""A method that says where it runs: its version is the interpreter's, its film the same everywhere."""

from __future__ import annotations

import sys

import numpy as np

from lightproof.method import Method, Rendering
from lightproof.scene import Scene


class Elsewhere(Method):
    """Light that depends on the seed alone."""

    def version(self) -> str:
        return sys.prefix

    def unsupported(self, scene: Scene) -> str | None:
        return None

    def prepare(self, scene: Scene) -> dict[str, float]:
        self.size = scene.size
        return {}

    def render(self, samples: int, seed: int) -> Rendering:
        return Rendering(np.random.default_rng(seed).random(self.size), samples)
