"""Diffuse paths through every scene; where nothing reflects and every light can be aimed at, the kernel of mc-area is all
that is left of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from lightproof.estimators.limits import no_bulbs, no_cylinders, no_solid_angle
from lightproof.estimators.mc_area import McArea
from lightproof.estimators.options import Choices
from lightproof.estimators.paths import Paths, paths
from lightproof.estimators.points import Random
from lightproof.estimators.sobol import sobol
from lightproof.estimators.touching import too_near
from lightproof.estimators.views import View
from lightproof.scene import Scene


class Path(McArea):
    """Every scene that the format knows, but for cylinders and solid angles; any number of reflections. path/no-next-event
    aims at no light and meets all of them by its directions; where rays are followed, path/sobol takes the places in an element,
    and nothing else, from the sequence."""

    choices: ClassVar[Choices] = {
        "lights": {"next-event": True, "no-next-event": False},
        "points": {"independent": Random, "sobol": sobol},
        "precision": {"float32": np.float32},
    }
    samples_lights = False
    limits = (no_cylinders, no_solid_angle)

    def __init__(self, name: str, threads: int):
        super().__init__(name, threads)
        self.aims = self.choices["lights"][self.chosen["lights"]]

    def settings(self) -> Mapping[str, Any]:
        density = "cos(theta)/pi per solid angle" + ("; of lights 1/A per area" if self.aims else "")
        points = {} if self.view or self.points is Random else {"points": f"{self.chosen['points']} over the element"}
        return {**super().settings(), **points, "domain": "paths", "pdf": density, "roulette": "unbiased"}

    def untraceable(self, scene: Scene) -> str | None:
        if self.seen(scene):
            return None
        return (None if self.aims else no_bulbs(scene)) or too_near(scene)

    def seen(self, scene: Scene) -> View | None:
        return super().seen(scene) if self.aims and not any(limit(scene) for limit in McArea.limits) else None

    def followed(self, scene: Scene) -> Paths:
        return paths(scene, self.aims)
