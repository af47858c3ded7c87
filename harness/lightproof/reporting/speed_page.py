"""speed.html: what to use when, and what every method's error costs on every scene; one file that opens offline."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import jinja2

from lightproof.reporting import front, race_chart, row_charts, theory
from lightproof.reporting.choice import ERRORS, Choice, choices, overall
from lightproof.reporting.evaluation import Cell, Evaluation
from lightproof.reporting.theory import Slope
from lightproof.scene import Scene

OPEN = 16  # methods of which a scene shows rows without being asked


@dataclass(frozen=True)
class SpeedView:
    """The speed of every method on one scene."""

    scene: Scene
    cells: Sequence[Cell]
    methods: Sequence[str]

    @property
    def anchor(self) -> str:
        """The scene's id on both pages."""
        return f"{self.scene.id}--{self.scene.case}"

    @cached_property
    def choices(self) -> list[Choice]:
        """What to use, for each error."""
        return choices(self.cells)

    @property
    def fronts(self) -> dict[str, str]:
        """The members of each front, in words."""
        return {name: front.in_words(members) for name, members in front.fronts(self.cells).items()}

    @cached_property
    def slopes(self) -> list[Slope]:
        """Every usable method's, with theory's."""
        return theory.slopes(self.cells)

    @property
    def agreement(self) -> str:
        """Whether slopes agree with theory, in words; empty where that cannot be told of any."""
        return theory.in_words(self.slopes)

    @property
    def race(self) -> dict[str, Any] | None:
        """Error against time."""
        return race_chart.error_against_time(self.cells, self.methods, self.scene.tolerance)

    @cached_property
    def rows(self) -> list[Cell]:
        """The methods of the charts by row."""
        return row_charts.in_order(self.cells)

    @property
    def unfolded(self) -> bool:
        """Whether the charts by row are short enough to be shown at once."""
        return len(self.rows) <= OPEN

    @property
    def charts(self) -> dict[str, dict[str, Any]]:
        """The charts by row that there is something for, by title."""
        drawn = {
            row_charts.time_title(): row_charts.time_to_errors(self.rows),
            "Efficiency": row_charts.efficiency(self.rows),
            "Slope": row_charts.slopes(self.slopes, self.rows),
        }
        return {title: chart for title, chart in drawn.items() if chart}


def views(evaluation: Evaluation) -> list[SpeedView]:
    """Every scene of which some method's speed is known."""
    found = [SpeedView(scene, [cell for method in evaluation.methods if (cell := evaluation.cell(scene, method))],
                       evaluation.methods) for scene in evaluation.scenes]
    return [view for view in found if view.choices]


def sentences(found: Sequence[SpeedView]) -> list[str]:
    """Each error over all scenes."""
    return [overall(chosen) for chosen in zip(*(view.choices for view in found), strict=True)]


def chance(found: Sequence[SpeedView]) -> str:
    """How many slopes of the run depart from theory, and how many would by chance."""
    known = [slope for view in found for slope in view.slopes if slope.comparable]
    if not known:
        return ""
    apart = sum(bool(slope.departs) for slope in known)
    by_chance = f"by chance alone as many as {len(known) / 20:.0f} would, one in 20"
    return f"{apart} of {len(known)} intervals exclude theory; {by_chance}"


def render(found: Sequence[SpeedView], evaluation: Evaluation, environment: jinja2.Environment, bundle: str) -> str:
    """The whole page."""
    return environment.get_template("speed.html.j2").render(
        run=evaluation.run, views=found, errors=ERRORS, sentences=sentences(found), chance=chance(found), bundle=bundle)
