"""Methods that sample direct light, composed of a domain, points and a precision, by the options in their names."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from lightproof.estimators.composed import Composed
from lightproof.estimators.options import SAMPLING, Choices, chosen
from lightproof.estimators.points import Random
from lightproof.scene import Scene


class Sampling(Composed):
    """`domain` is what is sampled, `density` how; `traces`: whether a ray tracer, with independent points, does the scenes
    that the kernel cannot take."""

    domain: ClassVar[str]
    density: ClassVar[str]
    traces: ClassVar[bool] = True
    choices: ClassVar[Choices] = SAMPLING

    def __init__(self, name: str, threads: int):
        """Raises ValueError on an option that is not known."""
        super().__init__(name, threads)
        self.chosen = chosen(name, self.choices)
        self.points = self.choices["points"][self.chosen["points"]]
        self.real = self.choices["precision"][self.chosen["precision"]]

    def settings(self) -> Mapping[str, Any]:
        return {"domain": self.domain, "pdf": self.density, **self.chosen, "precision": self.precision}

    def unsupported(self, scene: Scene) -> str | None:
        return super().unsupported(scene) or self.untraceable(scene)

    def untraceable(self, scene: Scene) -> str | None:
        """Why a scene that the kernel cannot take cannot be traced either."""
        if (self.traces and self.points is Random) or self.seen(scene):
            return None
        return "its film needs rays, which this configuration does not follow; path can"

    def varies(self, samples: int) -> bool:
        """Whether a film of so many samples tells its variance: not where points depend on one another."""
        return self.points is Random and samples > 1
