"""What the harness asks of anything that can fill a film: an estimator of ours or somebody's renderer.

A method runs in a worker process. It sees scenes, never a reference. It imports its renderer in `open` and not before, so
that its class can be named where the renderer is not installed.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from lightproof.scene import Scene


class Unavailable(Exception):
    """The renderer is not installed, or its libraries are missing; the message says what to do."""


@dataclass(frozen=True)
class Rendering:
    """One film as a method gives it; see `trial.Result` for the fields. `seconds` may split off the phase compile; what it
    does not name, the worker counts as render. `bound` (n,) [unit] is a proof of how far off each value can be: a promise to be
    held to, not a doubt that widens an interval."""

    film: np.ndarray
    samples: int
    variance: np.ndarray | None = None
    quantization: np.ndarray | float = 0.0
    seconds: Mapping[str, float] = field(default_factory=dict)
    peak: np.ndarray | None = None
    bound: np.ndarray | None = None


class Method(ABC):
    """One way to fill a film.

    `deterministic`: the film does not depend on the seed. `samples_lights`: every sample is aimed at a light, so a black
    tile is a statement and not bad luck. `precision`: of the arithmetic or of the output, whichever is coarser; it may depend
    on the scene and is asked for after `prepare`.
    """

    deterministic: ClassVar[bool] = False
    samples_lights: ClassVar[bool] = True
    precision: str = "float32"

    def __init__(self, name: str, threads: int):
        """`name` is the full method name, options included: mitsuba/scalar."""
        self.name = name
        self.threads = threads

    def open(self) -> None:
        """Import the renderer and set its threads, once per process. Raises Unavailable."""

    @abstractmethod
    def version(self) -> str:
        """Version of the renderer, after `open`."""

    def settings(self) -> Mapping[str, Any]:
        """What decides the result besides scene, samples and seed: integrator, sampler, filter; after `prepare`."""
        return {}

    @abstractmethod
    def unsupported(self, scene: Scene) -> str | None:
        """Why this method cannot do this scene, in words such as "pyrender has no area lights"; None where it can."""

    def caveat(self, scene: Scene) -> str:
        """What is known to be wrong with this renderer on this scene, in a sentence for the reader of a verdict; else empty."""
        return ""

    def tessellation(self, scene: Scene) -> np.ndarray | None:
        """What triangles in the place of round shapes change of the film at most, (n,) [unit of the film], infinite where that
        is not known; None where every shape is the renderer's own."""
        return None

    @abstractmethod
    def prepare(self, scene: Scene) -> Mapping[str, float]:
        """Build the scene and compile what it needs; returns seconds by phase where it can tell setup and compile apart."""

    @abstractmethod
    def render(self, samples: int, seed: int) -> Rendering:
        """One film of the prepared scene at `samples` per element (or the nearest number that the method can do)."""
