"""Diffuse paths through every scene; where nothing reflects and every light can be aimed at, the kernel of mc-area is all
that is left of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from lightproof.estimators.limits import no_cylinders, no_solid_angle
from lightproof.estimators.mc_area import McArea
from lightproof.estimators.options import Choices
from lightproof.estimators.paths import Paths, paths
from lightproof.estimators.points import Random
from lightproof.estimators.views import View
from lightproof.scene import Scene


class Path(McArea):
    """Every scene that the format knows, but for cylinders and solid angles; any number of reflections."""

    domain = "paths, and the area of the lights at each of their points"
    density = "cos(theta)/pi per solid angle, 1/A per area of a light"
    choices: ClassVar[Choices] = {"points": {"independent": Random}, "precision": {"float32": np.float32}}
    samples_lights = False
    limits = (no_cylinders, no_solid_angle)

    def settings(self) -> Mapping[str, Any]:
        return {**super().settings(), "lights": "next event", "roulette": "unbiased"}

    def seen(self, scene: Scene) -> View | None:
        return None if any(limit(scene) for limit in McArea.limits) else super().seen(scene)

    def followed(self, scene: Scene) -> Paths:
        return paths(scene)
