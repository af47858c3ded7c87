"""Methods by family, a renderer in all its configurations or all that are ours, and which of them is best on a scene."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from lightproof.renderers.registry import METHODS, family, is_ours
from lightproof.reporting.evaluation import Cell, Evaluation
from lightproof.scene import Scene
from lightproof.verdict import Outcome

OUR_NAME = "ours"
BEST_FIRST = (Outcome.PASS, Outcome.UNDECIDED, Outcome.FAIL, Outcome.ERROR, Outcome.NO_REFERENCE, Outcome.UNSUPPORTED)
ERRORS = (0.001, 0.01)  # what is to be reached in the least render time


@dataclass(frozen=True)
class Family:
    """A column of verdicts: the `methods` of a run that share a `name`."""

    name: str
    methods: tuple[str, ...]

    def best(self, evaluation: Evaluation, scene: Scene) -> Cell | None:
        """The cell with the best verdict on a scene, of those the one that is soonest at an error of 0.1 %, or else of 1 %; None
        where the run has no result."""
        return best(filter(None, (evaluation.cell(scene, method) for method in self.methods)))


def families(methods: Iterable[str]) -> list[Family]:
    """A reader's own methods first, then ours as one, then the renderers."""
    found: dict[str, list[str]] = {}
    for method in methods:
        found.setdefault(_name(method), []).append(method)
    return [Family(name, tuple(found[name])) for name in sorted(found, key=lambda name: _rank(name, found[name]))]


def singly(methods: Iterable[str]) -> list[Family]:
    """Every method by itself."""
    return [Family(method, (method,)) for method in methods]


def best(cells: Iterable[Cell]) -> Cell | None:
    """The cell with the best verdict, of those the soonest; None where there is none."""
    return min(cells, key=_standing, default=None)


def _standing(cell: Cell) -> tuple[float, ...]:
    times = [cell.seconds_to(error) for error in ERRORS] if cell.verdict.steps else []
    return BEST_FIRST.index(cell.verdict.outcome), *(math.inf if time is None else time for time in times)


def _name(method: str) -> str:
    return OUR_NAME if is_ours(method) else family(method)


def _rank(name: str, methods: list[str]) -> int:
    return 1 if name == OUR_NAME else 2 * all(method in METHODS for method in methods)
