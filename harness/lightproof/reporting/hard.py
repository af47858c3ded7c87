"""The hard cases of a run: a square for each method and case, row by row and sweep by sweep."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lightproof.reporting import sweeps
from lightproof.reporting.evaluation import Cell, Evaluation
from lightproof.reporting.hard_deviation import Deviation
from lightproof.reporting.sweeps import place
from lightproof.reporting.wording import short
from lightproof.scene import Scene
from lightproof.trial import Status
from lightproof.verdict import Outcome

TAG = "hard"
NO_LIGHT = re.compile(r"are no light, the first (\S+) in element (\d+)")


@dataclass(frozen=True)
class Square:
    """One square of the heat map: a `deviation`, or why there is none."""

    method: str
    cell: Cell | None

    @cached_property
    def deviation(self) -> Deviation | None:
        judged = self.cell is not None and self.cell.reference is not None and self.cell.final
        return Deviation(self.cell) if judged and self.cell.verdict.outcome is not Outcome.ERROR else None

    @cached_property
    def no_light(self) -> tuple[str, str] | None:
        """What of a film was no number or negative, and where; None where nothing was."""
        errors = [result for result in self.cell.results if result.status is Status.ERROR] if self.cell else []
        found = [(match, result) for result in errors if (match := NO_LIGHT.search(result.message))]
        return (_kind(found[0][0][1]), place(self.cell.scene, int(found[0][0][2]))) if found else None

    @property
    def text(self) -> str:
        """What is written in the square."""
        if self.deviation:
            mark = "" if self.deviation.off else "±"
            return "exact" if self.deviation.level == 0 else f"{mark}{short(self.deviation.level)}"
        if self.cell is None:
            return "·"
        return self.no_light[0] if self.no_light else "–" if self.cell.verdict.outcome is Outcome.UNSUPPORTED else "!"

    @property
    def ulps(self) -> str:
        """The worst error in units in the last place; empty where noise hides it."""
        known = self.deviation and self.deviation.off and self.deviation.ulps is not None
        worst = self.deviation.ulps[self.deviation.worst] if known else np.nan
        return f"{short(worst)} ulp" if np.isfinite(worst) and worst > 0.05 else ""

    @property
    def told(self) -> str:
        """The tooltip."""
        if self.deviation:
            return f"{self.method}, {self.deviation.told}"
        if self.cell is None:
            return "no result in this run"
        where = f" (the first {self.no_light[1]})" if self.no_light else ""
        return f"{self.method}: {self.cell.verdict.reason}{where}"


@dataclass(frozen=True)
class Row:
    """One hard case, with a square for each method."""

    scene: Scene
    squares: tuple[Square, ...]

    @cached_property
    def parameter(self) -> np.ndarray | None:
        """The sweep's parameter (n,); None where there is none."""
        return sweeps.values(self.scene)


@dataclass(frozen=True)
class Group:
    """The rows that make one sweep, and what one chart shows."""

    scene_id: str
    name: str
    rows: tuple[Row, ...]

    @property
    def anchor(self) -> str:
        return f"hard--{self.scene_id}--{self.name}"

    @property
    def title(self) -> str:
        """The rows' names in short."""
        names = [row.scene.name for row in self.rows]
        return names[0] if len(names) == 1 else f"{names[0]} … {names[-1].rpartition(':')[2]}"

    @property
    def methods(self) -> list[str]:
        """Those of the whole run."""
        return [square.method for square in self.rows[0].squares]

    @property
    def sweep(self) -> sweeps.Sweep | None:
        return sweeps.of(self.rows[0].scene)

    @cached_property
    def swept(self) -> bool:
        """Whether the parameter takes several values, so that there is something to draw."""
        known = [row.parameter for row in self.rows if row.parameter is not None]
        return len(np.unique(np.concatenate(known))) > 2 if known else False


def rows(evaluation: Evaluation) -> list[Row]:
    """Every hard case that a run has begun."""
    begun = {cell.scene.name for cell in evaluation.cells}
    hard = [scene for scene in evaluation.scenes if TAG in scene.tags and scene.name in begun]
    return [Row(scene, tuple(Square(method, evaluation.cell(scene, method)) for method in evaluation.methods)) for scene in hard]


def groups(found: Sequence[Row]) -> list[Group]:
    """Sweep by sweep, in the run's order."""
    together: dict[tuple[str, str], list[Row]] = {}
    for row in found:
        sweep = sweeps.of(row.scene)
        name = sweep.group(row.scene.case) if sweep else row.scene.case
        together.setdefault((row.scene.id, name), []).append(row)
    return [Group(scene_id, name, tuple(members)) for (scene_id, name), members in together.items()]


def _kind(found: str) -> str:
    return "NaN" if "nan" in found else "∞" if "inf" in found else "< 0"
