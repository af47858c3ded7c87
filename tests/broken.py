"""Estimators with one classic mistake each, by which the verdict and the gate prove that they catch it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lightproof.estimators.lamps import bulbs, glowing
from lightproof.estimators.mc_area import McArea
from lightproof.estimators.shapes import Flat, Parallelogram
from lightproof.method import Rendering
from lightproof.scene import Scene

WHAT = "this mistake is made under parallelograms only"


class PiForgotten(McArea):
    """Radiosity taken for radiance: everything is too small by pi."""

    def render(self, samples: int, seed: int) -> Rendering:
        true = super().render(samples, seed)
        return replace(true, film=true.film / np.pi, variance=None if true.variance is None else true.variance / np.pi**2)


class VisibilityForgotten(McArea):
    """Nothing casts a shadow: what neither emits nor reflects is left out of the scene."""

    def build(self, scene: Scene) -> None:
        super().build(replace(scene, surfaces=tuple(one for one in scene.surfaces if one.radiance or one.reflectance)))


class CosineForgotten(McArea):
    """The receiver's cosine is left out: every estimate is divided by it, so that light from the side counts in full."""

    def unsupported(self, scene: Scene) -> str | None:
        refused = super().unsupported(scene) or (scene.surfaces and "this mistake is made without blockers only")
        if refused:
            return refused
        flat = all(isinstance(glow.shape, Parallelogram) for glow in glowing(scene))
        return None if flat and not bulbs(scene, reach=1.0) else WHAT

    def render(self, samples: int, seed: int) -> Rendering:
        rng = np.random.default_rng(seed)
        (piece,) = self.pieces
        film, variance = np.transpose([self.element(row, *piece.lamp, max(2, samples), rng) for row in self.receivers])
        return Rendering(film, max(2, samples), variance)

    def element(self, row: np.ndarray, shape: Flat, strength: float, samples: int, rng: np.random.Generator) -> tuple:
        """Mean and variance for one element under a parallelogram."""
        s, t, p, q = rng.random((4, samples, 1)) - 0.5
        x = row[:3] + (row[12] * p + row[13] * q) * row[3:6] + row[14] * q * row[6:9]
        d = np.array(shape.center) + s * np.array(shape.u) + t * np.array(shape.v) - x
        f = strength * np.maximum(-d @ shape.normal, 0) * (d @ row[9:12] > 0) / np.linalg.norm(d, axis=1) ** 3
        return f.mean(), f.var(ddof=1) / samples
