"""judge(results, reference, scene) -> Verdict: pure, recomputed from raw results whenever it is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from lightproof import diagnose, ladder
from lightproof.ladder import Rung
from lightproof.reference import Reference
from lightproof.scene import Scene
from lightproof.trial import Result, Status, Trial


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
    """One step of the ladder, judged with the step before it where there is one. Errors are fractions of the tolerance
    scale; `seconds_*` are medians for one film; a number that cannot be told is NaN."""

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


@dataclass(frozen=True)
class _Finding:
    """What one step comes to."""

    outcome: Outcome
    message: str
    samples_needed: int | None = None
    biased: bool = False


def judge(results: Sequence[Result], reference: Reference | None, scene: Scene, *, triples: int = ladder.TRIPLES) -> Verdict:
    """The verdict of one method on one scene from all its results, in any order.

    `triples` is how many (scene, case, method) the suite holds: more than 1,600 widen the tiles' intervals. What a method
    says of itself comes first: `unsupported`, whatever else there is; then an `error`, where it leaves no step that decides
    (with or without a reference: it is the renderer's); then `no-reference`. A trial repeated after an error counts once.
    Raises ValueError where the results belong to several methods.
    """
    if len({result.trial.method for result in results}) > 1:
        raise ValueError("these results belong to several methods; judge one at a time")
    results = _once([_sound(result, scene) for result in results])
    unsupported = [result for result in results if result.status is Status.UNSUPPORTED]
    errors = [result for result in results if result.status is Status.ERROR]
    if unsupported:
        return Verdict(Outcome.UNSUPPORTED, unsupported[0].message, scene.tolerance)
    if reference is None:
        refusal = _error(errors) if errors else _Finding(Outcome.NO_REFERENCE, "the exact light of this scene is not known")
        return Verdict(refusal.outcome, refusal.message, scene.tolerance)
    try:
        scale = ladder.scale(scene, reference)
    except ValueError as error:
        return Verdict(Outcome.ERROR, str(error), scene.tolerance)
    rungs = ladder.climb(results, scene, scale, triples)
    findings = [_find(rung, _before(rung, rungs)) for rung in rungs]
    final = _final(rungs, findings, errors)
    steps = tuple(_step(rung, finding) for rung, finding in zip(rungs, findings, strict=True))
    reason = _diagnosed(final, rungs, reference, scene)
    return Verdict(final.outcome, reason, scene.tolerance, steps, final.samples_needed, final.biased)


def _sound(result: Result, scene: Scene) -> Result:
    """The result, or an error in its place where its film cannot be judged."""
    problem = ""
    if result.trial.scene_digest != scene.digest:
        problem = "it was rendered from another version of the scene; run it again"
    elif result.status is Status.OK and np.shape(result.film) != (scene.size,):
        problem = f"the film has shape {np.shape(result.film)}; it must be ({scene.size},)"
    elif result.status is Status.OK and not np.isfinite(result.film).all():
        problem = f"{np.count_nonzero(~np.isfinite(result.film))} of the film's {scene.size} elements are not finite"
    return replace(result, status=Status.ERROR, film=None, message=problem) if problem else result


def _once(results: Sequence[Result]) -> list[Result]:
    """One result for each trial, in order: the last one, but a film rather than an error."""
    kept: dict[Trial, Result] = {}
    for result in sorted(results, key=lambda result: result.status is Status.OK):
        kept[result.trial] = result
    return sorted(kept.values(), key=lambda result: (result.trial.samples, result.trial.run_seed, result.trial.replicate))


def _before(rung: Rung, rungs: Sequence[Rung]) -> Rung | None:
    """The complete step one factor below, which can confirm."""
    return next((other for other in rungs if other.complete and other.samples * ladder.FACTOR == rung.samples), None)


def _find(rung: Rung, before: Rung | None) -> _Finding:
    """The outcome of one step, judged with the one before it."""
    if not rung.complete:
        return _Finding(Outcome.UNDECIDED, f"{len(rung.results)} of {rung.replicates} replicates")
    if rung.declared and not rung.identical:
        return _Finding(Outcome.ERROR, "the method is declared deterministic, but its films differ")
    if rung.declared:
        return _find_noiseless(rung, before)
    if rung.repeated:
        return _Finding(Outcome.ERROR, "repeated random stream: some of the replicates are identical and some are not")
    if rung.noiseless:
        return _find_identical(rung, before)
    return _find_noisy(rung, before)


def _find_identical(rung: Rung, before: Rung | None) -> _Finding:
    if before is None or not before.noiseless:
        count = len(rung.results)
        return _Finding(Outcome.UNDECIDED, f"all {count} films are identical: the next step tells whether the seed is ignored",
                        ladder.FACTOR * rung.samples)
    if not rung.agrees(before):
        return _Finding(Outcome.ERROR, f"the seed is ignored: all films are identical at {before.samples} samples and all at"
                                       f" {rung.samples}, yet the two steps differ, so there are no replicates to judge by")
    return _find_noiseless(rung, before)


def _find_noiseless(rung: Rung, before: Rung | None) -> _Finding:
    if rung.passes:
        return _Finding(Outcome.PASS, _margin(rung))
    confirmed = np.zeros_like(rung.votes)
    if before is not None:
        confirmed = rung.votes * ((rung.votes == before.votes) & rung.stopped_shrinking(before))
    if confirmed.any():
        return _Finding(Outcome.FAIL, f"{_accusation(rung, confirmed)} at two steps")
    return _Finding(Outcome.UNDECIDED, _doubt(rung), ladder.FACTOR * rung.samples)


def _find_noisy(rung: Rung, before: Rung | None) -> _Finding:
    if rung.passes:
        return _passed(rung, before)
    confirmed = rung.votes * (rung.votes == before.votes) if before is not None else np.zeros_like(rung.votes)
    if confirmed.any():
        return _Finding(Outcome.FAIL, f"{_accusation(rung, confirmed)} at two steps")
    needed = ladder.FACTOR * rung.samples if rung.votes.any() else rung.samples_needed
    return _Finding(Outcome.UNDECIDED, _doubt(rung), needed)


def _passed(rung: Rung, before: Rung | None) -> _Finding:
    side = _mean_side(rung)
    if side == 0 or before is None or before.noiseless or _mean_side(before) != side:
        return _Finding(Outcome.PASS, _margin(rung))
    mean = rung.scale.tiles
    return _Finding(Outcome.PASS, f"biased by {_interval(rung, mean)}, within the tolerance", biased=True)


def _mean_side(rung: Rung) -> int:
    """-1 or +1 where the film mean's interval excludes zero, else 0."""
    mean = rung.scale.tiles
    return int(np.sign(rung.bias[mean])) if abs(rung.bias[mean]) > rung.half_width[mean] else 0


def _margin(rung: Rung) -> str:
    return f"every tile within {100 * rung.reach[:rung.scale.tiles + 1].max():.2g} % of the exact light"


def _accusation(rung: Rung, votes: np.ndarray) -> str:
    """What is off: the film's mean where it votes, else the interval farthest out."""
    mean = rung.scale.tiles
    worst = mean if votes[mean] else int(np.argmax(np.abs(votes) * (np.abs(rung.bias) - rung.half_width)))
    tiles = f" ({np.count_nonzero(votes[:mean])} of {mean} tiles are)" if votes[:mean].any() else ""
    return f"{rung.scale.place(worst)} is off by {_interval(rung, worst)}{tiles}"


def _doubt(rung: Rung) -> str:
    tiles = rung.scale.tiles
    if rung.votes.any():
        return f"unconfirmed: {_accusation(rung, rung.votes)} at one step"
    if rung.unlit[:tiles].any():
        return f"no sample has reached the light in {np.count_nonzero(rung.unlit[:tiles])} of {tiles} tiles"
    worst = int(np.argmax(rung.reach[:tiles + 1]))
    if rung.uncertainty[worst] >= rung.tolerance:
        blur = f"±{100 * rung.uncertainty[worst]:.2g} %"
        return f"no number of samples decides: the output's steps leave {blur}, tolerance {100 * rung.tolerance:g} %"
    return f"{rung.scale.place(worst)} is off by {_interval(rung, worst)}, tolerance {100 * rung.tolerance:g} %"


def _interval(rung: Rung, index: int) -> str:
    return f"{100 * rung.bias[index]:+.3g} ± {100 * rung.half_width[index]:.2g} %"


def _error(errors: Sequence[Result]) -> _Finding:
    first = errors[0]
    others = f" (and {len(errors) - 1} more like it)" if len(errors) > 1 else ""
    return _Finding(Outcome.ERROR, f"{first.trial.samples} samples, replicate {first.trial.replicate}: {first.message}{others}")


def _final(rungs: Sequence[Rung], findings: Sequence[_Finding], errors: Sequence[Result]) -> _Finding:
    """The finding at the last complete step; errors count where it decides nothing."""
    complete = [finding for rung, finding in zip(rungs, findings, strict=True) if rung.complete]
    final = complete[-1] if complete else _Finding(Outcome.UNDECIDED, "no step of the ladder is complete")
    return _error(errors) if errors and final.outcome is Outcome.UNDECIDED else final


def _diagnosed(final: _Finding, rungs: Sequence[Rung], reference: Reference, scene: Scene) -> str:
    """The reason, with the likely mistake behind a failing film where it can be told."""
    if final.outcome is not Outcome.FAIL:
        return final.message
    last = [rung for rung in rungs if rung.complete][-1]
    mistake = diagnose.diagnose(last.films.mean(axis=0), last.element_error, reference.value, scene)
    return f"{final.message}; {mistake}" if mistake else final.message


def _step(rung: Rung, finding: _Finding) -> Step:
    mean, worst = rung.scale.tiles, int(np.argmax(rung.reach[:rung.scale.tiles]))
    low, high = rung.bias - rung.half_width, rung.bias + rung.half_width
    return Step(
        samples=rung.samples,
        replicates=len(rung.results),
        outcome=finding.outcome,
        bias=float(rung.bias[mean]),
        bias_low=float(low[mean]),
        bias_high=float(high[mean]),
        worst_tile_bias=float(rung.bias[worst]),
        worst_tile_low=float(low[worst]),
        worst_tile_high=float(high[worst]),
        detectable_bias=rung.detectable_bias,
        rmse=rung.rmse,
        max_error=float(np.abs(rung.bias[mean + 1:]).max()),
        seconds_setup=_median_seconds(rung, "setup"),
        seconds_compile=_median_seconds(rung, "compile"),
        seconds_render=_median_seconds(rung, "render"),
        peak_memory_mb=max(result.peak_memory_mb for result in rung.results),
        message=finding.message,
    )


def _median_seconds(rung: Rung, phase: str) -> float:
    return float(np.median([result.seconds.get(phase, 0.0) for result in rung.results]))
