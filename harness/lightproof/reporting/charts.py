"""Charts of a run as Vega-Lite specifications. Ink is `currentColor`, so that they follow the page into the dark."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import altair as alt
import pandas as pd

from lightproof.reporting.evaluation import Cell
from lightproof.reporting.wording import percent, seconds
from lightproof.verdict import Outcome

ROW = 26  # pixels
FLOOR = 1e-4  # per cent; smaller errors are drawn here, or an exact method would flatten all others
# Okabe and Ito's, with a blue that also shows on black, and a few more; 12 colours times 5 shapes tell 60 methods apart.
COLOURS = ("#1f83c7", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8c6bb1", "#a6761d", "#5b8c3a", "#e0457b",
           "#6b7a8f", "#2fa7a0")
SHAPES = ("circle", "square", "triangle-up", "diamond", "cross")
LEGEND = alt.Legend(title=None, orient="bottom", columns=alt.ExprRef(expr="width < 420 ? 1 : width < 800 ? 2 : 4"))
SECONDS = ("datum.value >= 1 ? format(datum.value, '~g') + ' s' : datum.value >= 0.001 ? format(1000 * datum.value, '~g') + ' ms'"
           " : format(1000000 * datum.value, '~g') + ' µs'")


def error_against_time(cells: Sequence[Cell], methods: Sequence[str], tolerance: float) -> dict[str, Any] | None:
    """The error of a single film against its render time, a line a method; None where nothing was measured.

    `methods` are those of the whole run: they fix a method's colour and shape on every chart.
    """
    drawn = [cell for cell in cells if cell.drawable]
    if not drawn:
        return None
    data = pd.DataFrame([row for cell in drawn for row in _rows(cell)])
    look = [(_label(cell), methods.index(cell.method)) for cell in drawn]
    chosen = alt.selection_point(fields=["method"], bind="legend")
    lines = alt.Chart(data).mark_line(point={"size": 45, "filled": True}, strokeWidth=1.75).encode(
        x=alt.X("seconds:Q", title="render time of one film", scale=_log(data.seconds), axis=_decades(data.seconds, SECONDS)),
        y=alt.Y("error:Q", title="rms error of one film [%]", scale=_log(data.error), axis=_decades(data.error)),
        color=alt.Color("method:N", scale=_range(look, COLOURS), legend=LEGEND),
        shape=alt.Shape("method:N", scale=_range(look, SHAPES), legend=LEGEND),
        order="samples:Q",
        opacity=alt.condition(chosen, alt.value(1), alt.value(0.15)),
        tooltip=["method", "samples:Q", "time", "rms error", "slope"],
    ).add_params(chosen)
    return _finished(alt.layer(*_tolerance(tolerance), lines), height=320)


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
        x=alt.X("seconds:Q", title="render time to 1 % error", scale=_log(data.seconds),
                axis=_decades(data.seconds, SECONDS)),
        y=alt.Y("scene:N", title=None, sort=None, axis=alt.Axis(grid=True, labelLimit=220)),
        color=alt.Color("method:N", scale=_range(look, COLOURS), legend=LEGEND),
        shape=alt.Shape("method:N", scale=_range(look, SHAPES), legend=LEGEND),
        fill=alt.condition("datum.bound", alt.value("transparent"), alt.Fill("method:N", scale=_range(look, COLOURS))),
        opacity=alt.condition(chosen, alt.value(1), alt.value(0.15)),
        tooltip=["scene", "method", "time"],
    ).add_params(chosen)
    return _finished(points, height=ROW * data.scene.nunique())


def _cost(cell: Cell, found: float) -> dict[str, Any]:
    bound = cell.verdict.steps[0].rmse <= 0.01
    return {"scene": cell.scene.name, "method": cell.method, "seconds": found, "bound": bound,
            "time": f"{'at most ' if bound else ''}{seconds(found)}"}


def _rows(cell: Cell) -> Iterable[dict[str, Any]]:
    for step in cell.drawable:
        yield {
            "method": _label(cell),
            "samples": step.samples,
            "seconds": step.seconds_render,
            "error": max(100 * step.rmse, FLOOR),
            "time": seconds(step.seconds_render),
            "rms error": percent(step.rmse),
            "slope": slope(cell),
        }


def slope(cell: Cell) -> str:
    """The fitted slope d log error / d log samples with half its 95 % interval, as far as the steps tell."""
    value, low, high = cell.slope
    if math.isnan(value):
        return "\N{EM DASH}"
    half = f" ± {(high - low) / 2:.2f}" if math.isfinite(high - low) else ""
    return f"{value:.2f}{half}".replace("-", "\N{MINUS SIGN}")


def _label(cell: Cell) -> str:
    return f"{cell.method} (slope {slope(cell).partition(' ')[0]})"


def _range(look: list[tuple[str, int]], values: tuple[str, ...]) -> alt.Scale:
    return alt.Scale(domain=[label for label, _ in look], range=[values[place % len(values)] for _, place in look])


def _tolerance(tolerance: float) -> tuple[alt.Chart, alt.Chart]:
    data = pd.DataFrame({"error": [100 * tolerance], "text": [f"tolerance {percent(tolerance, 1)}"]})
    base = alt.Chart(data).encode(y="error:Q")
    rule = base.mark_rule(strokeDash=[5, 4], color="currentColor", opacity=0.6)
    text = base.mark_text(align="right", baseline="bottom", dx=-4, dy=-3, color="currentColor", opacity=0.75)
    return rule, text.encode(x=alt.value("width"), text="text:N")


def _powers(values: pd.Series) -> list[float]:
    return [10.0**power for power in range(math.floor(math.log10(values.min())), math.ceil(math.log10(values.max())) + 1)]


def _log(values: pd.Series) -> alt.Scale:
    return alt.Scale(type="log", domain=[_powers(values)[0], _powers(values)[-1]], nice=False)


def _decades(values: pd.Series, label: str = "format(datum.value, '~r')") -> alt.Axis:
    return alt.Axis(values=_powers(values), labelExpr=label, labelOverlap=True)


def _finished(chart: alt.Chart | alt.LayerChart, height: int) -> dict[str, Any]:
    ink = {"labelColor": "currentColor", "titleColor": "currentColor", "domainColor": "currentColor", "tickColor": "currentColor"}
    config = {
        "background": "transparent",
        "font": "system-ui, sans-serif",
        "axis": {**ink, "gridColor": "currentColor", "gridOpacity": 0.12, "domainOpacity": 0.4, "tickOpacity": 0.4,
                 "labelFontSize": 11, "titleFontSize": 12, "titleFontWeight": "normal", "titlePadding": 8},
        "legend": {**ink, "labelFontSize": 12, "labelLimit": 260, "symbolSize": 80},
        "view": {"stroke": None},
    }
    return {**chart.properties(width="container", height=height).to_dict(), "config": config}
