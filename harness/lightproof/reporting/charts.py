"""Charts of a run as Vega-Lite specifications. Ink is `currentColor`, so that they follow the page into the dark."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import altair as alt
import pandas as pd

from lightproof.reporting.evaluation import Cell
from lightproof.reporting.wording import seconds
from lightproof.verdict import Outcome

ROW = 26  # pixels
# Okabe and Ito's, with a blue that also shows on black, and a few more; 12 colours times 5 shapes tell 60 methods apart.
COLOURS = ("#1f83c7", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8c6bb1", "#a6761d", "#5b8c3a", "#e0457b",
           "#6b7a8f", "#2fa7a0")
SHAPES = ("circle", "square", "triangle-up", "diamond", "cross")
LEGEND = alt.Legend(title=None, orient="bottom", symbolLimit=0,  # all of them, however many
                    columns=alt.ExprRef(expr="width < 420 ? 1 : width < 800 ? 2 : 4"))
SECONDS = ("datum.value >= 1 ? format(datum.value, '~g') + ' s' : datum.value >= 0.001 ? format(1000 * datum.value, '~g') + ' ms'"
           " : format(1000000 * datum.value, '~g') + ' µs'")


def time_to_one_percent(cells: Sequence[Cell], methods: Sequence[str]) -> dict[str, Any] | None:
    """What a right answer costs: for each scene the render time to 1 % error of every method that passes there; hollow where
    the ladder began below it, so that the time is a bound. None where no method passes."""
    rows = [_cost(cell, found) for cell in cells if cell.verdict.outcome is Outcome.PASS and (found := cell.seconds_to(0.01))]
    if not rows:
        return None
    data = pd.DataFrame(rows)
    look = [(method, place) for place, method in enumerate(methods) if method in set(data.method)]
    chosen = alt.selection_point(fields=["method"], bind="legend")
    points = alt.Chart(data).mark_point(size=70, strokeWidth=1.75).encode(
        x=alt.X("seconds:Q", title="render time to 1 % error", scale=log_scale(data.seconds),
                axis=decades(data.seconds, SECONDS)),
        y=alt.Y("scene:N", title=None, sort=None, axis=alt.Axis(grid=True, labelLimit=220)),
        color=alt.Color("method:N", scale=looks(look, COLOURS), legend=LEGEND),
        shape=alt.Shape("method:N", scale=looks(look, SHAPES), legend=LEGEND),
        fill=alt.condition("datum.bound", alt.value("transparent"), alt.Fill("method:N", scale=looks(look, COLOURS))),
        opacity=alt.condition(chosen, alt.value(1), alt.value(0.15)),
        tooltip=["scene", "method", "time"],
    ).add_params(chosen)
    return finished(points, height=ROW * data.scene.nunique())


def _cost(cell: Cell, found: float) -> dict[str, Any]:
    bound = cell.verdict.steps[0].rmse <= 0.01
    return {"scene": cell.scene.name, "method": cell.method, "seconds": found, "bound": bound,
            "time": f"{'at most ' if bound else ''}{seconds(found)}"}


def looks(look: list[tuple[str, int]], values: tuple[str, ...]) -> alt.Scale:
    """Colours or shapes of labels, each with its method's place among all methods of the run."""
    return alt.Scale(domain=[label for label, _ in look], range=[values[place % len(values)] for _, place in look])


def _powers(values: pd.Series) -> list[float]:
    return [10.0**power for power in range(math.floor(math.log10(values.min())), math.ceil(math.log10(values.max())) + 1)]


def log_scale(values: pd.Series) -> alt.Scale:
    """From a power of ten to a power of ten."""
    return alt.Scale(type="log", domain=[_powers(values)[0], _powers(values)[-1]], nice=False)


def decades(values: pd.Series, label: str = "format(datum.value, '~r')", **others: Any) -> alt.Axis:
    """An axis with a tick at each power of ten."""
    return alt.Axis(values=_powers(values), labelExpr=label, labelOverlap=True, **others)


def finished(chart: alt.Chart | alt.LayerChart, height: int) -> dict[str, Any]:
    """The specification, `height` pixels high and as wide as its place on the page."""
    ink = {"labelColor": "currentColor", "titleColor": "currentColor", "domainColor": "currentColor", "tickColor": "currentColor"}
    config = {
        "background": "transparent",
        "font": "system-ui, sans-serif",
        "axis": {**ink, "gridColor": "currentColor", "gridOpacity": 0.12, "domainOpacity": 0.4, "tickOpacity": 0.4,
                 "labelFontSize": 11, "titleFontSize": 12, "titleFontWeight": "normal", "titlePadding": 8},
        "legend": {**ink, "labelFontSize": 12, "labelLimit": 260, "symbolSize": 80, "symbolOpacity": 1,
                   "titleFontWeight": "normal", "titleOrient": "left",
                   "layout": {side: {"direction": "vertical", "anchor": "start"} for side in ("bottom", "top")}},
        "view": {"stroke": None},
    }
    return {**chart.properties(width="container", height=height).to_dict(), "config": config}
