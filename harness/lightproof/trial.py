"""One measurement asked for (Trial) and what came of it (Result)."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from enum import StrEnum
from typing import Any

import numpy as np

PRECISIONS = ("float32", "float64")  # options of our methods that leave the points of a film alone


class Status(StrEnum):
    """How a trial ended."""

    OK = "ok"
    UNSUPPORTED = "unsupported"
    ERROR = "error"


@dataclass(frozen=True)
class Trial:
    """One film asked for: `samples` per element, one of several `replicate`s with independent seeds."""

    scene: str
    case: str
    scene_digest: str
    method: str
    samples: int
    replicate: int
    run_seed: int = 0

    @property
    def key(self) -> str:
        """SHA-256 of the fields: the same trial has the same key in every run and in any order."""
        return hashlib.sha256(json.dumps(asdict(self), sort_keys=True).encode()).hexdigest()

    @property
    def seed(self) -> int:
        """A seed in [1, 2^31 - 1], derived from the key (some renderers take no zero and no 32nd bit). A method's precision has
        no part in it: its films in float32 and in float64 are of the same points, and differ by rounding alone."""
        return int(replace(self, method=without_precision(self.method)).key[:16], 16) % (2**31 - 1) + 1


def without_precision(method: str) -> str:
    """A method's name less the option that gives its precision."""
    name, _, options = method.partition("/")
    kept = "-".join(option for option in options.split("-") if option not in PRECISIONS)
    return f"{name}/{kept}" if kept else name


@dataclass(frozen=True)
class Result:
    """What came of a trial. `film` (n,) and `variance` (n,) [unit squared; that of the element's value, already divided by
    samples] are row-major; `quantization` is half a step of the output [unit], (n,) or 0; `tessellation` (n,) [unit] is what
    triangles in the place of round shapes change at most, infinite where that is not known, None without triangles; `peak` (n,)
    [unit] is the largest value that one sample can have, infinite where there is none, None where the method does not know it;
    `bound` (n,) [unit] is how far off each value is at most, as the method proves, None where it does not;
    `samples` is what was really spent per element; `seconds` has the phases setup, compile and render."""

    trial: Trial
    status: Status
    film: np.ndarray | None = None
    variance: np.ndarray | None = None
    quantization: np.ndarray | float = 0.0
    tessellation: np.ndarray | None = None
    peak: np.ndarray | None = None
    bound: np.ndarray | None = None
    samples: int = 0
    seconds: Mapping[str, float] = field(default_factory=dict)
    version: str = ""
    settings: Mapping[str, Any] = field(default_factory=dict)
    precision: str = ""
    deterministic: bool = False
    samples_lights: bool = False
    threads: int = 1
    peak_memory_mb: float = 0.0
    message: str = ""
    caveat: str = ""
