"""A run read back and judged: each (scene, method) with its films and its verdict, recomputed from the raw results."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lightproof import statistics
from lightproof.judging import Judge
from lightproof.references import Reference
from lightproof.renderers.registry import METHODS, is_ours
from lightproof.scale import Scale
from lightproof.scene import Scene
from lightproof.store import Run, Store
from lightproof.suite import Suite
from lightproof.trial import Result, Status
from lightproof.verdict import Outcome, Step, Verdict


@dataclass(frozen=True)
class Cell:
    """One method on one scene."""

    scene: Scene
    method: str
    results: tuple[Result, ...]
    reference: Reference | None
    verdict: Verdict

    @cached_property
    def final(self) -> list[Result]:
        """The films of the last complete step: of those with most replicates the one with most samples."""
        steps: dict[int, list[Result]] = {}
        for result in self.results:
            if result.status is Status.OK:
                steps.setdefault(result.trial.samples, []).append(result)
        return max(steps.items(), key=lambda step: (len(step[1]), step[0]))[1] if steps else []

    @property
    def step(self) -> Step | None:
        """What was found at the last complete step; None where nothing could be judged."""
        return next((step for step in self.verdict.steps if self.final and step.samples == self.final[0].trial.samples), None)

    @property
    def caveat(self) -> str:
        """What the method itself knows to be wrong with its renderer on this scene."""
        return self.results[0].caveat

    @property
    def tessellation(self) -> float | None:
        """What triangles in the place of round shapes change at most, as a fraction of the tolerance scale: infinite where it is
        not known, None where there are none."""
        change = self.final[0].tessellation if self.final else None
        return None if change is None or self.reference is None else float((change / self.scale).max())

    @cached_property
    def film(self) -> np.ndarray:
        """Mean over the last step's replicates (n,) in the film's unit."""
        return np.mean([result.film for result in self.final], axis=0)

    @cached_property
    def standard_error(self) -> np.ndarray | None:
        """That of `film` (n,), from the scatter between replicates; None where they do not scatter."""
        films = np.array([result.film for result in self.final])
        scatters = len(films) > 1 and (films != films[0]).any()
        return np.std(films, axis=0, ddof=1) / np.sqrt(len(films)) if scatters else None

    @cached_property
    def scale(self) -> np.ndarray:
        """What errors are fractions of (n,), in the film's unit."""
        return Scale.of(self.scene, self.reference).unit

    @cached_property
    def error(self) -> np.ndarray:
        """`film` minus reference (n,), as a fraction of the tolerance scale."""
        return (self.film - self.reference.value) / self.scale

    @cached_property
    def deviation(self) -> np.ndarray | None:
        """`standard_error` (n,) as a fraction of the tolerance scale."""
        return None if self.standard_error is None else self.standard_error / self.scale

    @cached_property
    def z_score(self) -> np.ndarray | None:
        """`film` minus reference (n,) in standard errors; infinite where a certain value is off."""
        if self.standard_error is None:
            return None
        difference = self.film - self.reference.value
        exact = np.where(difference == 0, 0.0, np.copysign(np.inf, difference))
        return np.divide(difference, self.standard_error, out=exact, where=self.standard_error > 0)

    @property
    def usable(self) -> bool:
        """Whether its speed is worth knowing: its light is not known to be wrong, and what it took is."""
        return self.verdict.outcome in (Outcome.PASS, Outcome.UNDECIDED) and self.timed and bool(self.final and self.drawable)

    @property
    def drawable(self) -> list[Step]:
        """The steps whose error and time are known; a time below the clock's tick is not."""
        return [step for step in self.verdict.steps if step.rmse >= 0 and step.seconds_render > 0]

    @property
    def timed(self) -> bool:
        """Whether it is known what a film took; nobody knows of a picture from elsewhere."""
        return not any(math.isnan(step.seconds_render) for step in self.verdict.steps)

    def seconds_to(self, error: float) -> float | None:
        """Render seconds until a single film's rms error is `error` (a fraction); None beyond what was measured."""
        steps = self.verdict.steps if self.timed else ()
        return statistics.seconds_to(error, [step.seconds_render for step in steps], [step.rmse for step in steps])

    @cached_property
    def slope(self) -> tuple[float, float, float]:
        """d log rmse / d log samples with the ends of its 95 % interval; NaN where the steps are too few."""
        return statistics.slope([step.samples for step in self.drawable], [step.rmse for step in self.drawable])

    @property
    def efficiency(self) -> float | None:
        """1 / (variance x seconds) of a single film [1/s] at the last step, variance in squares of the tolerance scale."""
        if self.reference is None or self.deviation is None or not self.timed:
            return None
        variance = len(self.final) * np.mean(self.deviation**2)
        return float(1 / (variance * np.median([result.seconds["render"] for result in self.final])))


@dataclass(frozen=True)
class Evaluation:
    """Every cell that a run has begun, scene by scene in the run's order; for the order of methods see `_rank`."""

    run: Run
    scenes: tuple[Scene, ...]
    cells: tuple[Cell, ...]

    @cached_property
    def methods(self) -> list[str]:
        """Each method once."""
        return sorted({cell.method for cell in self.cells}, key=_rank)

    @property
    def tags(self) -> set[str]:
        """Of any scene."""
        return {tag for scene in self.scenes for tag in scene.tags}

    def cell(self, scene: Scene, method: str) -> Cell | None:
        """The cell of a scene and a method, None where the run has no result."""
        return self._by_name.get((scene.name, method))

    @cached_property
    def _by_name(self) -> dict[tuple[str, str], Cell]:
        return {(cell.scene.name, cell.method): cell for cell in self.cells}


def _rank(method: str) -> tuple[int, int, str]:
    """A reader's own methods first, then renderers, then ours, in the registry's order: renderers are what is asked about."""
    if method not in METHODS:
        return 0, 0, method
    return (2 if is_ours(method) else 1), list(METHODS).index(method), method


def evaluate(record: Store, suite: Suite) -> Evaluation:
    """Judge every (scene, case, method) of a run by the references of `suite`. Raises StoreError, FilmError."""
    groups: dict[tuple[str, str], dict[str, list[Result]]] = {}
    for result in record.results():
        of_scene = groups.setdefault((result.trial.scene, result.trial.case), {})
        of_scene.setdefault(result.trial.method, []).append(result)
    judge = Judge(record, suite)
    cells = [
        Cell(scene, method, tuple(results), judge.reference(results), _timed(judge.judge(results), results))
        for scene in record.scenes
        for method, results in sorted(groups.get((scene.id, scene.case), {}).items(), key=lambda item: _rank(item[0]))
    ]
    return Evaluation(record.run, record.scenes, tuple(cells))


def _timed(judged: Verdict, results: Sequence[Result]) -> Verdict:
    """The verdict; times that no result tells are no numbers."""
    if all("render" in result.seconds for result in results if result.status is Status.OK):
        return judged
    return replace(judged, steps=tuple(replace(step, seconds_render=math.nan) for step in judged.steps))
