"""The error of every method on a scene against its time, with the fronts that no method beats."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import altair as alt
import pandas as pd

from lightproof.reporting.charts import COLOURS, LEGEND, SECONDS, SHAPES, decades, finished, log_scale, looks
from lightproof.reporting.evaluation import Cell
from lightproof.reporting.families import best, families
from lightproof.reporting.front import FLOOR, Place, fronts
from lightproof.reporting.theory import slope
from lightproof.reporting.wording import percent, seconds

FEW = 12  # methods that can all be in the legend
DASHES = ([1, 0], [7, 4], [2, 3])


def error_against_time(cells: Sequence[Cell], methods: Sequence[str], tolerance: float) -> dict[str, Any] | None:
    """The error of a single film against its render time: a line a method, strong for those on a front and for the best of each
    renderer, and each group's front as a step line. None where nothing was measured. `methods` are those of the whole run: they
    fix a method's colour and shape on every chart."""
    drawn = [cell for cell in cells if cell.drawable]
    if not drawn:
        return None
    found = fronts(drawn)
    strong = _strong(drawn, found.values())
    data = pd.DataFrame([row for cell in drawn for row in _rows(cell, cell.method in strong)])
    look = [(cell.method, methods.index(cell.method)) for cell in drawn]
    legend = LEGEND.copy()
    legend["values"] = [cell.method for cell in drawn if cell.method in strong or len(drawn) <= FEW]
    chosen = alt.selection_point(fields=["method"], bind="legend")
    x = alt.X("seconds:Q", title="render time of one film", scale=log_scale(data.seconds), axis=decades(data.seconds, SECONDS))
    y = alt.Y("error:Q", title="rms error of one film [%]", scale=log_scale(data.error), axis=decades(data.error))
    lines = alt.Chart(data).mark_line(point={"size": 45, "filled": True}, strokeWidth=1.75).encode(
        x=x, y=y,
        color=alt.Color("method:N", scale=looks(look, COLOURS), legend=legend),
        shape=alt.Shape("method:N", scale=looks(look, SHAPES), legend=legend),
        order="samples:Q",
        opacity=alt.condition(chosen, alt.Opacity("strength:Q", scale=None, legend=None), alt.value(0.1)),
        tooltip=["method", "samples:Q", "time", "rms error", "slope"],
    ).add_params(chosen)
    return finished(alt.layer(*_tolerance(tolerance), _steps(found, data, x, y), lines), height=360)


def _rows(cell: Cell, strong: bool) -> Iterable[dict[str, Any]]:
    for step in cell.drawable:
        yield {"method": cell.method, "samples": step.samples, "seconds": float(f"{step.seconds_render:.4g}"),
               "error": float(f"{100 * max(step.rmse, FLOOR):.4g}"), "strength": 1 if strong else 0.35,
               "time": seconds(step.seconds_render), "rms error": percent(step.rmse), "slope": slope(cell)}


def _strong(cells: Sequence[Cell], found: Iterable[Sequence[Place]]) -> set[str]:
    """The methods to be told apart at a glance."""
    chosen = [best(cell for cell in cells if cell.method in family.methods) for family in families(cell.method for cell in cells)]
    return {cell.method for cell in chosen if cell} | {place.method for front in found for place in front}


def _steps(found: dict[str, Sequence[Place]], data: pd.DataFrame, x: alt.X, y: alt.Y) -> alt.Chart:
    """The fronts: down at the first film, then on until the next one is better, to the end of the chart."""
    top, end = log_scale(data.error).domain[-1], log_scale(data.seconds).domain[-1]
    corners = [{"front": name, "order": order, "seconds": time, "error": error} for name, front in found.items()
               for order, (time, error) in enumerate(_corners(front, top, end))]
    dashes = alt.Scale(domain=list(found), range=list(DASHES[:len(found)]))
    legend = alt.Legend(title="front of", orient="bottom", symbolStrokeColor="currentColor",
                        symbolStrokeWidth=2, symbolSize=900)
    return alt.Chart(pd.DataFrame(corners, columns=["front", "order", "seconds", "error"])).mark_line(
        interpolate="step-after", color="currentColor", strokeWidth=2.5, opacity=0.55,
    ).encode(x=x, y=y, order="order:Q", strokeDash=alt.StrokeDash("front:N", scale=dashes, legend=legend))


def _corners(front: Sequence[Place], top: float, end: float) -> list[tuple[float, float]]:
    return [(front[0].seconds, top), *((place.seconds, 100 * place.error) for place in front), (end, 100 * front[-1].error)]


def _tolerance(tolerance: float) -> tuple[alt.Chart, alt.Chart]:
    data = pd.DataFrame({"error": [100 * tolerance], "text": [f"tolerance {percent(tolerance, 1)}"]})
    base = alt.Chart(data).encode(y="error:Q")
    rule = base.mark_rule(strokeDash=[5, 4], color="currentColor", opacity=0.6)
    text = base.mark_text(align="right", baseline="bottom", dx=-4, dy=-3, color="currentColor", opacity=0.75)
    return rule, text.encode(x=alt.value("width"), text="text:N")
