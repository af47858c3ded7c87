"""Climb the ladder of every (scene, method) until its verdict is decided or its budget is spent.

The runner asks `decide` whether a cell's results decide it; it knows no reference and no rule. Time is counted in the
seconds of set-up and rendering that the results themselves record, so a resumed run goes on exactly where it stopped;
compiling does not count, so cold caches change no verdict.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from statistics import median

from lightproof.renderers.pool import Pool
from lightproof.renderers.registry import Entry
from lightproof.scene import Scene
from lightproof.store import Store, StoreError
from lightproof.trial import Result, Status, Trial

FIRST_SAMPLES = 64
FACTOR = 4
REPLICATES = 16  # films a step, which the rule of the verdict is made for
MOST_SAMPLES = 2**30
STEPS_FOR_A_SLOPE = 3
SLOPE_CAN_WAIT = 4  # a step that serves only the slope gives way to one for a verdict that costs up to so many times as much
CHEAP = 0.02  # of a cell's budget: a step that costs less is taken without looking further ahead
SPARE = 0.5  # s: a step that costs a run less is taken for what it tells of error against time, whatever is decided
SLOPE = 10.0  # s: a step that costs a run more is not taken for a slope alone
LIKELY = 0.5  # of the samples that nearly always decide: what decides as a rule
SHORTEST_TIMEOUT = 30.0
SLOWER_THAN_EXPECTED = 10


@dataclass(frozen=True)
class Decision:
    """What the runner may know of a verdict: whether it stands, and if not the samples per element that would decide it, None
    where no number is known to."""

    decided: bool
    samples_needed: int | None = None


@dataclass
class Cell:
    """One method on one scene: its results so far by step of the ladder (samples per element), and what they decide.
    `budget` [s] is what set-up and rendering may take; `replicates` is the number of films a step; no step has more than
    `most_samples` per element; where fewer decide, `least_steps` are taken as long as each takes less than `slope` [s], and every
    step that takes less than `spare` [s]."""

    scene: Scene
    entry: Entry
    budget: float
    replicates: int
    most_samples: int = MOST_SAMPLES
    least_steps: int = STEPS_FOR_A_SLOPE
    slope: float = math.inf
    spare: float = 0.0
    steps: dict[int, list[Result]] = field(default_factory=dict)
    decision: Decision = Decision(False)

    @property
    def name(self) -> str:
        """Scene and method."""
        return f"{self.scene.name} {self.entry.name}"

    @property
    def results(self) -> list[Result]:
        """All results, step by step."""
        return [result for step in self.steps.values() for result in step]

    @property
    def broken(self) -> bool:
        """Whether the method cannot or did not do this scene: no further trial is worth its time."""
        return any(result.status is not Status.OK for result in self.results)

    @property
    def seconds(self) -> float:
        """What the cell has cost: every render, and the set-up of each step once."""
        return sum(_setup(step) + sum(_renders(step)) for step in self.steps.values())

    @property
    def height(self) -> int:
        """Number of complete steps."""
        return sum(len(step) >= self._films for step in self.steps.values())

    @property
    def next_samples(self) -> int:
        """Samples per element of the first step that is not complete."""
        return FIRST_SAMPLES * FACTOR**self.height

    @property
    def next_seconds(self) -> float:
        """What completes the next step, judged by the films of that step (the first of them may compile, so not by it
        alone), else by the step before; 0 where nothing was measured yet."""
        step, before = self.steps.get(self.next_samples, []), self.steps.get(self.next_samples // FACTOR, [])
        if len(step) > 1:
            return min(_renders(step)) * (self._films - len(step))
        return _setup(before) + self._films * self._film_seconds(self.next_samples)

    def _film_seconds(self, samples: int) -> float:
        """What a film takes, by the line through the last two complete steps (small films are mostly overhead), or in
        proportion to the only one; 0 where nothing was measured yet."""
        known = [(each, median(_renders(step))) for each, step in sorted(self.steps.items()) if len(step) >= self._films]
        if len(known) < 2:
            return sum(seconds * samples / each for each, seconds in known)
        (few, faster), (many, slower) = known[-2:]
        return slower + max(0.0, slower - faster) * (samples - many) / (many - few)

    @property
    def wants_more(self) -> bool:
        """Whether another film would say something and its step fits into the cell's own budget."""
        if self.broken or self.next_samples > self.most_samples or self.seconds + self.next_seconds > self.budget:
            return False
        if self.decision.decided and self.next_seconds > self.slope:
            return False
        return self.height < self.least_steps or self.next_seconds < self.spare or self.decidable

    @property
    def decidable(self) -> bool:
        """Whether the verdict is open and the samples that would decide it fit into the budget."""
        if self.decision.decided or self.decision.samples_needed is None:
            return False
        if self.next_seconds < CHEAP * self.budget:
            return True
        step, total = self.next_samples, self.seconds + self.next_seconds
        while step < LIKELY * self.decision.samples_needed:
            step *= FACTOR
            total += self._films * self._film_seconds(step)
        return total <= self.budget

    @property
    def timeout(self) -> float:
        """Seconds after which a render counts as hanging."""
        slowest = max(map(max, filter(None, map(_renders, self.steps.values()))), default=0.0)
        return max(SHORTEST_TIMEOUT, self.budget, SLOWER_THAN_EXPECTED * FACTOR * slowest)

    def next_trial(self, run_seed: int) -> Trial:
        """The first trial of the ladder that is not recorded."""
        samples, scene = self.next_samples, self.scene
        done = {result.trial.replicate for result in self.steps.get(samples, [])}
        replicate = next(number for number in range(len(done) + 1) if number not in done)
        return Trial(scene.id, scene.case, scene.digest, self.entry.name, samples, replicate, run_seed)

    def add(self, result: Result) -> None:
        """Take up a result."""
        self.steps.setdefault(result.trial.samples, []).append(result)

    @property
    def _films(self) -> int:
        first = next((step[0] for step in self.steps.values()), None)
        return 1 if first and first.deterministic else self.replicates


def _renders(step: Sequence[Result]) -> list[float]:
    return [result.seconds.get("render", 0.0) for result in step]


def _setup(step: Sequence[Result]) -> float:
    return max((result.seconds.get("setup", 0.0) for result in step), default=0.0)


@dataclass(frozen=True)
class Progress:
    """Where a run stands: told before each step of a cell, and when it is over (`cell` None)."""

    cell: Cell | None
    finished: int
    cells: int
    seconds: float
    budget: float


class Runner:
    """Runs cells, the cheapest step first, those for a verdict before those for a slope, and records each result as it comes.

    `budget` [s] is that of all cells together, `decide` gets all results of one cell, `tell` hears of the progress. Raises
    StoreError where the record cannot be written.
    """

    def __init__(self, cells: Sequence[Cell], budget: float, store: Store, pool: Pool,
                 decide: Callable[[Sequence[Result]], Decision], tell: Callable[[Progress], None]):
        self._cells = {(cell.scene.id, cell.scene.case, cell.entry.name): cell for cell in cells}
        self._budget = budget
        self._store = store
        self._pool = pool
        self._decide = decide
        self._tell = tell
        self._queue: list[tuple[float, int, Cell]] = []
        self._spent: dict[str, float] = {}

    def run(self) -> list[Cell]:
        """All cells with their results, once the budget is spent or nothing is left that is worth its time. What the store
        already holds is taken up and not run again."""
        for result in self._store.results():
            self._cell(result.trial).add(result)
        for cell in self._cells.values():
            self._judge(cell)
        while self._queue:
            *_, cell = heapq.heappop(self._queue)
            if self._seconds + cell.next_seconds <= self._budget:
                self._report(cell)
                self._climb(cell)
                self._judge(cell)
        self._report(None)
        return list(self._cells.values())

    def _cell(self, trial: Trial) -> Cell:
        """The cell that a recorded trial belongs to."""
        try:
            return self._cells[trial.scene, trial.case, trial.method]
        except KeyError:
            unknown = f"holds a trial of {trial.method!a} on {trial.scene}:{trial.case}, which is not in its plan"
            raise StoreError(f"{self._store.folder}: {unknown}; start a new run") from None

    def _climb(self, cell: Cell) -> None:
        """Complete one step of a cell's ladder, or stop where it breaks or turns out not to fit."""
        height = cell.height
        while cell.height == height and cell.wants_more:
            trial = cell.next_trial(self._store.run.seed)
            film = self._store.film_path(trial)
            result = self._pool.render(cell.entry, cell.scene, trial, film, cell.timeout)
            self._store.append(result)
            cell.add(result)
        self._store.sync()

    def _judge(self, cell: Cell) -> None:
        """Learn what a cell's results decide, and queue its next step if it wants one."""
        self._spent[cell.name] = cell.seconds
        if cell.steps:
            cell.decision = self._decide(cell.results)
        if cell.wants_more:
            urgency = cell.next_seconds * (1 if cell.decidable else SLOPE_CAN_WAIT)
            heapq.heappush(self._queue, (urgency, list(self._spent).index(cell.name), cell))

    @property
    def _seconds(self) -> float:
        return sum(self._spent.values())

    def _report(self, cell: Cell | None) -> None:
        waiting = len(self._queue) + (cell is not None)
        self._tell(Progress(cell, len(self._cells) - waiting, len(self._cells), self._seconds, self._budget))
