"""What to use when: of each kind of method the one that is soonest at an error, and how they compare."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import median

from lightproof.reporting.evaluation import Cell
from lightproof.reporting.front import external, samples
from lightproof.reporting.wording import multiple, percent, seconds

ERRORS = (0.01, 0.001, 0.0001)  # rms errors of one film
FROM_BELOW = ("", "at least ", "more than ")  # what stands before a ratio of which it is known how small it can be
NAMED = 4  # methods that a sentence has room for
INVERSE = {"at least ": "at most ", "at most ": "at least "}
SIGNS = {"": "", "at least ": "≥ ", "more than ": "> ", "at most ": "≤ ", "about ": "≈ "}


@dataclass(frozen=True)
class Arrival:
    """When a method is at an error; `bound`: its first film was better already, so that it may have been sooner."""

    method: str
    seconds: float
    bound: bool

    def __str__(self) -> str:
        return f"{self.method}, {'at most ' if self.bound else ''}{seconds(self.seconds)}"


@dataclass(frozen=True)
class Choice:
    """On one scene, to one `error`: the `fastest` of all, of ours that `sampling`, of `external` renderers, None where none came
    so far; `beyond` [s] is what each external renderer took without getting there, `nearest` what there is instead."""

    error: float
    fastest: Arrival | None
    sampling: Arrival | None
    external: Arrival | None
    beyond: float | None
    nearest: str

    @property
    def ratio(self) -> float | None:
        """How many times as fast as the fastest external renderer our fastest sampling method is; None where that is unknown."""
        if not self.sampling:
            return None
        if self.external:
            return self.external.seconds / self.sampling.seconds
        return self.beyond / self.sampling.seconds if self.beyond and self.beyond > self.sampling.seconds else None

    @property
    def relation(self) -> str:
        """What is to be said before the ratio: bounds make it one."""
        if not self.external:
            return "more than "
        return {(False, False): "", (True, False): "at least ", (False, True): "at most ",
                (True, True): "about "}[self.sampling.bound, self.external.bound]

    @property
    def heat(self) -> float | None:
        """How far ahead ours is, for a colour: 1 from a thousand times as fast, -1 where it is so much slower."""
        return None if self.ratio is None else max(-1.0, min(1.0, math.log10(self.ratio) / 3))

    @property
    def short(self) -> str:
        """The ratio in a few signs."""
        return "" if self.ratio is None else f"{SIGNS[self.relation]}{multiple(self.ratio)} ×"

    def __str__(self) -> str:
        """In a sentence without its end."""
        if self.fastest is None:
            return f"nothing came so far; {self.nearest}" if self.nearest else "nothing came so far"
        others = [self._ours(), self._theirs()]
        return "; ".join([str(self.fastest), *filter(None, others)])

    def _ours(self) -> str:
        if self.sampling is None:
            return "none of ours that sample came so far"
        return "" if self.sampling == self.fastest else f"of ours that sample {self.sampling}"

    def _theirs(self) -> str:
        if self.ratio is None:
            return f"the fastest external renderer is {self.external}" if self.external not in (None, self.fastest) else ""
        if not self.external:
            return f"no external renderer came so far, and ours is more than {multiple(self.ratio)} times as fast"
        speed = f"{multiple(self.ratio)} times as fast" if self.ratio >= 1 else f"{multiple(1 / self.ratio)} times as slow"
        relation = self.relation if self.ratio >= 1 else INVERSE.get(self.relation, self.relation)
        return f"ours is {relation}{speed} as the fastest external renderer, {self.external}"


def choose(cells: Sequence[Cell], error: float) -> Choice:
    """What there is to choose from among the usable cells of a scene."""
    usable = [cell for cell in cells if cell.usable]
    theirs = [cell for cell in usable if external(cell)]
    return Choice(
        error,
        _first(usable, error, lambda cell: True),
        _first(usable, error, samples),
        _first(usable, error, external),
        min((max(step.seconds_render for step in cell.drawable) for cell in theirs), default=None),
        _nearest(usable),
    )


def choices(cells: Sequence[Cell]) -> list[Choice]:
    """One for each error; none where no method's speed is known."""
    return [choose(cells, error) for error in ERRORS] if any(cell.usable for cell in cells) else []


def arrival(cell: Cell, error: float) -> Arrival | None:
    """When one method is at an error."""
    found = cell.seconds_to(error)
    return None if found is None else Arrival(cell.method, found, cell.verdict.steps[0].rmse <= error)


def _first(cells: Sequence[Cell], error: float, belongs: Callable[[Cell], bool]) -> Arrival | None:
    arrivals = [arrival(cell, error) for cell in cells if belongs(cell)]
    return min(filter(None, arrivals), key=lambda each: each.seconds, default=None)


def _nearest(cells: Sequence[Cell]) -> str:
    steps = [(step.rmse, step.seconds_render, cell.method) for cell in cells for step in cell.drawable]
    if not steps:
        return ""
    error, time, method = min(steps)
    return f"nearest is {method}, {percent(error)} in {seconds(time)}"


def overall(chosen: Sequence[Choice]) -> str:
    """One error over all scenes of a run, in sentences."""
    reached = [choice for choice in chosen if choice.fastest]
    if not reached:
        return f"To {percent(chosen[0].error, 1)}: nothing came so far on any scene."
    return " ".join(filter(None, [f"To {percent(chosen[0].error, 1)}: {_fastest(reached, len(chosen))}.", _compared(chosen)]))


def _fastest(reached: Sequence[Choice], scenes: int) -> str:
    counts = Counter(choice.fastest.method for choice in reached).most_common()
    if scenes == 1:
        return f"fastest of all is {counts[0][0]}"
    others = [("others", sum(count for _, count in counts[NAMED:]))] if len(counts) > NAMED else []
    fastest = ", ".join(f"{method} on {count}" for method, count in counts[:NAMED] + others)
    return f"fastest of all are {fastest} of {scenes} scenes"


def _compared(chosen: Sequence[Choice]) -> str:
    ratios = [choice.ratio for choice in chosen if choice.ratio is not None and choice.relation in FROM_BELOW]
    if not ratios:
        return ""
    spread = f"{multiple(min(ratios))} to {multiple(max(ratios))}" if len(ratios) > 1 else multiple(ratios[0])
    middle = f", {multiple(median(ratios))} in the median" if len(ratios) > 2 else ""
    scenes = "one scene" if len(ratios) == 1 else f"{len(ratios)} scenes"
    known = f"on the {scenes} where that is known or bounded from below"
    return f"Ours that sample are {spread} times as fast as the fastest external renderer{middle}, {known}."
