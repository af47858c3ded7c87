"""hard.html: a heat map of all hard cases, then sweep by sweep where each method breaks; one file that opens offline."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import jinja2

from lightproof.renderers.registry import family
from lightproof.reporting import hard, hard_charts, hard_findings, hard_promises, hard_spread, sweeps
from lightproof.reporting.colours import ColourMap
from lightproof.reporting.evaluation import Evaluation
from lightproof.reporting.hard import Group, Row, Square
from lightproof.reporting.hard_promises import FOIL, Promise
from lightproof.reporting.wording import short

LEAST, MOST = -16, 0  # powers of ten at the colours' ends
# YlOrRd (C. Brewer, colorbrewer2.org) after a pale grey: ever darker, so that no hue need be told from another.
ERRORS = ColourMap(("f4f5f2", "f8f6da", "ffffcc", "ffeda0", "fed976", "feb24c", "fd8d3c", "fc4e2a", "e31a1c", "bd0026", "800026"))
DARK = 0.72  # of the scale: what is beyond takes white letters


@dataclass(frozen=True)
class HardPage:
    """What the template shows: `methods` head the columns."""

    methods: Sequence[str]
    rows: Sequence[Row]

    @cached_property
    def groups(self) -> list[Group]:
        return hard.groups(self.rows)

    @cached_property
    def scenes(self) -> dict[str, list[Group]]:
        """The sweeps of each scene."""
        return {group.scene_id: [each for each in self.groups if each.scene_id == group.scene_id] for group in self.groups}

    @cached_property
    def anchors(self) -> dict[str, str]:
        """Where on the page the sweep of a row stands, by the scene's name."""
        return {row.scene.name: group.anchor for group in self.groups for row in group.rows}

    @property
    def promises(self) -> list[Promise]:
        return hard_promises.promises(self.rows)

    @property
    def precisions(self) -> list[str]:
        """Of each column, where any square of it tells."""
        told = [[square.deviation.cell.final[0].precision for square in column if square.deviation]
                for column in zip(*(row.squares for row in self.rows), strict=True)]
        return [precisions[0] if precisions else "" for precisions in told]

    @property
    def naive(self) -> bool:
        """Whether the textbook's formulas are in the run."""
        return any(family(method) == FOIL for method in self.methods)

    @property
    def bar(self) -> str:
        """The colours as a CSS gradient."""
        return ERRORS.css

    @property
    def ticks(self) -> list[str]:
        """Labels under the gradient."""
        return [short(10.0**power) for power in range(LEAST, MOST + 1, 4)]

    def findings(self, group: Group) -> dict[str, list[str]]:
        return hard_findings.findings(group)

    def chart(self, group: Group) -> dict[str, Any] | None:
        return hard_charts.error_along(group, self.methods)

    def spread(self, group: Group) -> dict[str, list[str]]:
        return hard_spread.sentences(group)

    def spread_chart(self, group: Group) -> dict[str, Any] | None:
        return hard_charts.spread_along(group, self.methods)

    def textbook(self, scene_id: str) -> str:
        """What the hard case does to the textbook's formula."""
        return sweeps.TEXTBOOK.get(scene_id, "") if self.naive else ""

    def look(self, square: Square) -> tuple[str, str]:
        """A square's classes and its style."""
        if square.deviation is None:
            return ("broken" if square.no_light else "none"), ""
        share = _share(square.deviation.level)
        ink = "dark" if share > DARK else "pale"
        noise = "" if square.deviation.off else " noise"
        return f"{ink}{noise}", f"background-color: #{_colour(share)}"


def render(evaluation: Evaluation, environment: jinja2.Environment, bundle: str) -> str:
    """The whole page; empty where the run holds no hard case. `bundle` is the charts' script."""
    rows = hard.rows(evaluation)
    if not rows:
        return ""
    page = HardPage(evaluation.methods, rows)
    return environment.get_template("hard.html.j2").render(hard=page, run=evaluation.run, bundle=bundle)


def _share(level: float) -> float:
    """Place of an error on the scale, 0 to 1."""
    if level == 0:
        return 0.0
    power = math.log10(level) if math.isfinite(level) else MOST
    return min(1.0, max(0.0, (power - LEAST) / (MOST - LEAST)))


def _colour(share: float) -> str:
    palette = ERRORS.palette
    return bytes(palette[round(share * (len(palette) - 1))]).hex()
