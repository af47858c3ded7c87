"""judge(results, reference, scene) -> Verdict: pure, recomputed from raw results whenever it is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from lightproof.reference import Reference
from lightproof.scene import Scene
from lightproof.trial import Result


class Outcome(StrEnum):
    """What a verdict says."""

    PASS = "pass"
    FAIL = "fail"
    UNDECIDED = "undecided"
    UNSUPPORTED = "unsupported"
    ERROR = "error"
    NO_REFERENCE = "no-reference"


@dataclass(frozen=True)
class Step:
    """One step of the ladder, judged alone. Errors are fractions of the tolerance scale; seconds are medians for one film."""

    samples: int
    replicates: int
    outcome: Outcome
    bias: float
    bias_low: float
    bias_high: float
    worst_tile_bias: float
    worst_tile_low: float
    worst_tile_high: float
    detectable_bias: float
    rmse: float
    max_error: float
    seconds_setup: float
    seconds_compile: float
    seconds_render: float
    peak_memory_mb: float
    message: str = ""


@dataclass(frozen=True)
class Verdict:
    """The outcome at the last step, why, and every step. `samples_needed` is what would decide an undecided one (None where
    that cannot be told); `biased` marks a pass whose film mean excludes zero at two consecutive steps."""

    outcome: Outcome
    reason: str
    tolerance: float
    steps: tuple[Step, ...] = ()
    samples_needed: int | None = None
    biased: bool = False


def judge(results: Sequence[Result], reference: Reference | None, scene: Scene) -> Verdict:
    """The verdict of one method on one scene from all its results, in any order."""
    raise NotImplementedError
