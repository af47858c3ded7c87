"""Has anything become worse? A run's verdicts and noise against the accepted state in reports/baseline.csv.

A gate fails on any `fail`, on an outcome worse than the accepted one, and on more variance per sample than the accepted
interval allows, confirmed by a second draw. Seconds are reported elsewhere and never gated.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from lightproof import baseline, ladder, plan, statistics, store
from lightproof.baseline import Key, State
from lightproof.judging import Judge
from lightproof.references import Reference
from lightproof.renderers.pool import Pool
from lightproof.renderers.registry import METHODS, Entry
from lightproof.runner import FACTOR, FIRST_SAMPLES, REPLICATES, Cell, Progress, Runner
from lightproof.scale import Scale
from lightproof.scene import Scene
from lightproof.store import Store
from lightproof.suite import Suite
from lightproof.trial import Result
from lightproof.verdict import Outcome, Verdict

SEEDS = (0, 1)  # of the draw and of the one that confirms it
CELL_SECONDS = 300.0  # a cell that takes longer hangs; nothing else here depends on the clock
LEVEL = 0.001  # chance that equal variances are told apart, at one draw
BEST_FIRST = (Outcome.PASS, Outcome.UNDECIDED, Outcome.UNSUPPORTED, Outcome.NO_REFERENCE, Outcome.ERROR, Outcome.FAIL)
RANK = {outcome.value: rank for rank, outcome in enumerate(BEST_FIRST)}


@dataclass(frozen=True)
class Finding:
    """What is worse, and by how much; `outcome` is that of the row now. `noisier` marks a variance above the baseline's
    interval, which counts once a second draw confirms it."""

    state: State
    message: str
    noisier: bool = False


@dataclass(frozen=True)
class Report:
    """What the gate found: the rows as they are now, what is worse, and of what could not be run why not."""

    states: tuple[State, ...]
    findings: tuple[Finding, ...]
    missing: tuple[str, ...]

    @property
    def undecided(self) -> list[State]:
        """Rows that no verdict could be reached for."""
        return [state for state in self.states if state.outcome in (Outcome.UNDECIDED, Outcome.ERROR, Outcome.NO_REFERENCE)]

    @property
    def exit_status(self) -> int:
        """0 all as good as the baseline, 1 something is worse, 3 something is undecided or was not run."""
        return 1 if self.findings else 3 if self.undecided or self.missing else 0


@dataclass(frozen=True)
class Gate:
    """Judges rows of a baseline again. `suite` has their scenes; runs are recorded in `folder`; `tell` hears of progress."""

    suite: Suite
    folder: Path
    threads: int
    tell: Callable[[Progress], None] = lambda progress: None

    def check(self, accepted: Mapping[Key, State]) -> Report:
        """Run the rows with the gate's own seeds. Raises SceneError, StoreError."""
        with Pool(self.threads) as pool:
            missing = {name: reason for name in {key[2] for key in accepted} if (reason := _missing(name, pool))}
            here = [state for state in accepted.values() if state.method not in missing]
            return self._confirmed(self._draw(here, SEEDS[0], pool), accepted, pool, missing)

    def check_run(self, record: Store, accepted: Mapping[Key, State]) -> Report:
        """Judge what a stored run has already measured. Raises StoreError, FilmError."""
        with Pool(self.threads) as pool:
            return self._confirmed(observe_run(record, accepted), accepted, pool, {})

    def _confirmed(self, states: Sequence[State], accepted: Mapping[Key, State], pool: Pool,
                   missing: Mapping[str, str]) -> Report:
        """What is worse; a row that is only noisier must be so with the second seed too."""
        findings = _worse(states, accepted)
        noisier = [accepted[finding.state.key] for finding in findings if finding.noisier]
        again = {finding.state.key for finding in _worse(self._draw(noisier, SEEDS[1], pool), accepted)} if noisier else set()
        confirmed = [finding for finding in findings if not finding.noisier or finding.state.key in again]
        absent = accepted.keys() - {state.key for state in states}
        unasked = [f"{accepted[key].name}: the run has no result of it" for key in sorted(absent) if key[2] not in missing]
        return Report(tuple(states), tuple(confirmed), (*missing.values(), *unasked))

    def _draw(self, rows: Sequence[State], seed: int, pool: Pool) -> list[State]:
        """The rows measured with one seed: each climbs to its accepted step, and one further where that does not decide."""
        scenes = {row.key[:2]: self.suite.scene(f"{row.scene}:{row.case}") for row in rows}
        entries = {row.method: METHODS[row.method] for row in rows}
        header = plan.describe(dict.fromkeys(scenes.values(), self.suite), entries.values(), self.threads, seed, {})
        record = store.create(self.folder, header, list(scenes.values()))
        cells = [_cell(scenes[row.key[:2]], entries[row.method], row) for row in rows]
        Runner(cells, CELL_SECONDS * len(cells), record, pool, Judge(record).decide, self.tell).run()
        return observe_run(record, {row.key: row for row in rows})


def _missing(method: str, pool: Pool) -> str:
    """Why a method cannot be run here, or an empty text."""
    if method not in METHODS:
        return f"{method}: there is no such method; it has to leave the baseline"
    try:
        pool.open(METHODS[method])
    except Exception as error:  # whatever keeps a renderer from starting is reported, and the others are judged
        return f"{method}: {error}"
    return ""


def _cell(scene: Scene, entry: Entry, row: State) -> Cell:
    """A row's cell: up to the accepted step whatever decides before it, and one step beyond where that does not decide."""
    steps = 1 + round(math.log(max(row.samples, FIRST_SAMPLES) / FIRST_SAMPLES, FACTOR))
    return Cell(scene, entry, CELL_SECONDS, REPLICATES, most_samples=max(row.samples, 1) * FACTOR, least_steps=steps)


def _worse(states: Iterable[State], accepted: Mapping[Key, State]) -> list[Finding]:
    """What is worse than accepted; a row that is new is worse only where it fails."""
    found = (compare(state, accepted.get(state.key, state)) for state in states)
    return [finding for finding in found if finding]


def observe_run(record: Store, accepted: Mapping[Key, State]) -> list[State]:
    """The states of everything that a run has measured, at the accepted steps where there are such."""
    judge = Judge(record)
    cells: dict[Key, list[Result]] = {}
    for result in record.results():
        cells.setdefault((result.trial.scene, result.trial.case, result.trial.method), []).append(result)
    return [observe(key, results, judge, accepted[key].samples if key in accepted else None) for key, results in cells.items()]


def observe(key: Key, results: Sequence[Result], judge: Judge, samples: int | None = None) -> State:
    """The state of one method on one scene: its variance at the step of `samples`, by default the one that decided."""
    judged = judge.judge(results)
    step = samples or _deciding_step(judged)
    noise = (0.0, 0.0, 0)
    if judged.outcome in (Outcome.PASS, Outcome.FAIL, Outcome.UNDECIDED):
        noise = _variance(results, judge.scene(results), judge.reference(results), step)
    return State(*key, judged.outcome.value, step, *noise)


def _deciding_step(judged: Verdict) -> int:
    return min((step.samples for step in judged.steps if step.outcome is judged.outcome), default=0)


def _variance(results: Sequence[Result], scene: Scene, reference: Reference, samples: int) -> tuple[float, float, int]:
    """Variance of one sample at a step as a fraction of the tolerance scale squared, its logarithm's standard error, and the
    films that they come from; zeros where the films have no noise."""
    for rung in ladder.climb(results, scene, Scale.of(scene, reference)):
        if rung.samples == samples and rung.complete and not rung.noiseless:
            return *statistics.variance_per_sample(rung.errors, samples), len(rung.films)
    return 0.0, 0.0, 0


def compare(now: State, accepted: State) -> Finding | None:
    """What is worse about a row, or None."""
    if now.outcome == Outcome.FAIL:
        return Finding(now, f"{now.name}: fails")
    if RANK[now.outcome] > RANK[accepted.outcome]:
        return Finding(now, f"{now.name}: was {accepted.outcome}, is {now.outcome}")
    measured, known = (now.variance_per_sample, now.log_error), (accepted.variance_per_sample, accepted.log_error)
    ratio, low, high = statistics.ratio_interval(measured, known, max(1, now.replicates + accepted.replicates - 2), LEVEL)
    if low > 1:
        noise = f"variance per sample is {ratio:.2f} times the baseline's ({low:.2f} to {high:.2f})"
        return Finding(now, f"{now.name}: {noise}", noisier=True)
    return None


def proposal(report: Report, accepted: Mapping[Key, State]) -> str:
    """The baseline that would be accepted next: only what passed becomes a row, or replaces one."""
    passed = {state.key: state for state in report.states if state.outcome == Outcome.PASS}
    return baseline.to_csv({**accepted, **passed}.values())
