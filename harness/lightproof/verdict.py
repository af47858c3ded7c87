"""judge(results, reference, scene) -> Verdict: pure, recomputed from raw results whenever it is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lightproof import diagnose, ladder
from lightproof.finding import Finding, Outcome, find
from lightproof.ladder import Rung
from lightproof.references import Reference
from lightproof.scale import Scale
from lightproof.scene import Scene
from lightproof.trial import Result, Status, Trial


@dataclass(frozen=True)
class Step:
    """One step of the ladder, judged with the step before it where there is one. Errors are fractions of the tolerance
    scale; `bound` is the largest that the method proves itself, None where it proves none; `seconds_*` are medians for one film;
    a number that cannot be told is NaN."""

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
    bound: float | None
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


def judge(results: Sequence[Result], reference: Reference | None, scene: Scene, *,
          triples: int = ladder.TRIPLES, replicates: int = 2) -> Verdict:
    """The verdict of one method on one scene from all its results, in any order.

    `triples` is how many (scene, case, method) the suite holds: more than 1,600 widen the tiles' intervals. A step with fewer
    films than `replicates` is not judged. What a method says of itself comes first: `unsupported`, whatever else there is;
    then an `error`, where it leaves no step that decides (with or without a reference: it is the renderer's); then
    `no-reference`. A trial repeated after an error counts once. Raises ValueError where the results belong to several methods.
    """
    if len({result.trial.method for result in results}) > 1:
        raise ValueError("these results belong to several methods; judge one at a time")
    results = _once([_sound(result, scene) for result in results])
    refusal = _refusal(results, reference)
    if refusal:
        return Verdict(refusal.outcome, refusal.message, scene.tolerance)
    try:
        scale = Scale.of(scene, reference)
    except ValueError as error:
        return Verdict(Outcome.ERROR, str(error), scene.tolerance)
    rungs = ladder.climb(results, scene, scale, triples, replicates)
    findings = [find(rung, _before(rung, rungs)) for rung in rungs]
    final = _final(rungs, findings, _with(Status.ERROR, results))
    steps = tuple(_step(rung, finding) for rung, finding in zip(rungs, findings, strict=True))
    reason = _reason(final, rungs, reference, scene)
    return Verdict(final.outcome, reason, scene.tolerance, steps, final.samples_needed, final.biased)


def _with(status: Status, results: Sequence[Result]) -> list[Result]:
    return [result for result in results if result.status is status]


def _refusal(results: Sequence[Result], reference: Reference | None) -> Finding | None:
    """What there is to say where no step can be judged."""
    unsupported, errors = _with(Status.UNSUPPORTED, results), _with(Status.ERROR, results)
    if unsupported:
        return Finding(Outcome.UNSUPPORTED, unsupported[0].message)
    if reference is None:
        return _error(errors) if errors else Finding(Outcome.NO_REFERENCE, "the exact light of this scene is not known")
    return None


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


def _error(errors: Sequence[Result]) -> Finding:
    first = errors[0]
    others = f" (and {len(errors) - 1} more like it)" if len(errors) > 1 else ""
    return Finding(Outcome.ERROR, f"{first.trial.samples} samples, replicate {first.trial.replicate}: {first.message}{others}")


def _final(rungs: Sequence[Rung], findings: Sequence[Finding], errors: Sequence[Result]) -> Finding:
    """The finding at the last complete step; errors count where it decides nothing."""
    complete = [finding for rung, finding in zip(rungs, findings, strict=True) if rung.complete]
    final = complete[-1] if complete else Finding(Outcome.UNDECIDED, "no step of the ladder is complete")
    return _error(errors) if errors and final.outcome is Outcome.UNDECIDED else final


def _reason(final: Finding, rungs: Sequence[Rung], reference: Reference, scene: Scene) -> str:
    """In words, with the samples that would decide an undecided verdict, or the likely mistake behind a failing film, where they
    can be told."""
    if final.samples_needed:
        return final.message + demand(final.samples_needed)
    if final.outcome is not Outcome.FAIL:
        return final.message
    last = [rung for rung in rungs if rung.complete][-1]
    mistake = diagnose.diagnose(last.films.mean(axis=0), last.element_error, reference.value, scene)
    return f"{final.message}; {mistake}" if mistake else final.message


def demand(samples_needed: int) -> str:
    """How the reason of an undecided verdict ends."""
    return f"; {samples_needed:,} samples would decide"


def uncounted(judged: Verdict) -> Verdict:
    """The verdict without the samples that would decide it: for films of which nobody knows how many went into them."""
    if not judged.samples_needed:
        return judged
    return replace(judged, samples_needed=None, reason=judged.reason.removesuffix(demand(judged.samples_needed)))


def _step(rung: Rung, finding: Finding) -> Step:
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
        bound=float(rung.bound.max()) if np.isfinite(rung.bound).all() else None,
        seconds_setup=_median_seconds(rung, "setup"),
        seconds_compile=_median_seconds(rung, "compile"),
        seconds_render=_median_seconds(rung, "render"),
        peak_memory_mb=max(result.peak_memory_mb for result in rung.results),
        message=finding.message,
    )


def _median_seconds(rung: Rung, phase: str) -> float:
    return float(np.median([result.seconds.get(phase, 0.0) for result in rung.results]))
