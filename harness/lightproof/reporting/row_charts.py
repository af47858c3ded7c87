"""Charts of one scene with a row for each method: time to an error, efficiency, slope."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import altair as alt
import pandas as pd

from lightproof.reporting.charts import SECONDS, decades, finished, log_scale
from lightproof.reporting.choice import ERRORS, arrival
from lightproof.reporting.evaluation import Cell
from lightproof.reporting.front import external, samples
from lightproof.reporting.theory import Slope, slope
from lightproof.reporting.wording import number, percent

ROW = 25  # pixels: a name, and what is said of it below
KINDS = {"ours, sampling": "#1f83c7", "ours, without noise": "#009e73", "external": "#e69f00"}
MARKS = {"as theory": ("#1f83c7", "circle"), "apart from theory": ("#d55e00", "triangle-up"), "no theory": ("#8b95a0", "square")}
SHAPES = dict(zip("●■◆", ("circle", "square", "diamond"), strict=True))  # of the errors, as a title writes and a chart draws them
BELOW, ABOVE = 6, -7  # pixels from the middle of a row
SPREAD = (-2.0, 0.25)  # slopes that are drawn; an interval may reach beyond
EXPONENT = "format(datum.value, '~s')"


def in_order(cells: Sequence[Cell]) -> list[Cell]:
    """The usable cells, those first that are soonest at 0.1 %, or else at 1 %."""
    return sorted((cell for cell in cells if cell.usable), key=lambda cell: [
        math.inf if (time := cell.seconds_to(error)) is None else time for error in (ERRORS[1], ERRORS[0])])


def time_title() -> str:
    """What the chart of times is called, which tells its marks apart too."""
    return "Time to " + ", ".join(f"{sign} {percent(error, 1)}" for sign, error in zip(SHAPES, ERRORS, strict=True))


def time_to_errors(cells: Sequence[Cell]) -> dict[str, Any] | None:
    """Render time to each error that a method came to, a row a method; hollow where its first film was better. None where none
    came to any."""
    found = [(cell, error, when) for cell in cells for error in ERRORS if (when := arrival(cell, error))]
    if not found:
        return None
    data = pd.DataFrame([{"method": cell.method, "kind": kind(cell), "error": percent(error, 1), "seconds": when.seconds,
                          "bound": when.bound, "time": str(when).partition(", ")[2]} for cell, error, when in found])
    x = {"title": "render time", "scale": log_scale(data.seconds), "axis": decades(data.seconds, SECONDS, orient="top")}
    shapes = alt.Scale(domain=[percent(error, 1) for error in ERRORS], range=list(SHAPES.values()))
    base = alt.Chart(data).encode(y=_y(cells), color=_kinds(data))
    bars = base.mark_rule(strokeWidth=7, opacity=0.35, strokeCap="round", yOffset=BELOW).encode(
        x=alt.X("min(seconds):Q", **x), x2="max(seconds):Q")
    marks = base.mark_point(size=42, strokeWidth=1.5, opacity=1, yOffset=BELOW).encode(
        x=alt.X("seconds:Q", **x), tooltip=["method", "error", "time"],
        shape=alt.Shape("error:N", scale=shapes, legend=None),
        fill=alt.condition("datum.bound", alt.value("transparent"), _kinds(data, alt.Fill)))
    names = _names(cells, {cell.method for cell, *_ in found}, f"not to {percent(ERRORS[0], 1)}")
    return finished(alt.layer(bars, marks, names), ROW * len(cells))


def efficiency(cells: Sequence[Cell]) -> dict[str, Any] | None:
    """1 / (variance x seconds) at the last step, a bar a method; None where nothing scatters."""
    rows = [{"method": cell.method, "kind": kind(cell), "efficiency": cell.efficiency, "value": f"{number(cell.efficiency)} /s"}
            for cell in cells if cell.efficiency]
    if not rows:
        return None
    data = pd.DataFrame(rows)
    scale = log_scale(data.efficiency)
    axis = decades(data.efficiency, EXPONENT, orient="top")
    bars = alt.Chart(data.assign(start=scale.domain[0])).mark_bar(size=8, yOffset=BELOW).encode(
        x=alt.X("efficiency:Q", title="1 / (variance × seconds) [1/s]", scale=scale, axis=axis),
        x2="start:Q", y=_y(cells), color=_kinds(data), tooltip=["method", "value"])
    return finished(alt.layer(bars, _names(cells, set(data.method), "without noise")), ROW * len(cells))


def slopes(found: Sequence[Slope], cells: Sequence[Cell]) -> dict[str, Any] | None:
    """Fitted slopes with their 95 % intervals, and theory's as a grey bar, a row a method; None where there is none."""
    if not found:
        return None
    data = pd.DataFrame([_slope_row(each) for each in found])
    scale = alt.Scale(domain=list(SPREAD), nice=False, zero=False, clamp=True)
    axis = alt.Axis(orient="top", values=[-2, -1.5, -1, -0.5, 0], labelExpr="replace(datum.label, '-', '−')")
    x = {"title": "d log error / d log samples", "scale": scale, "axis": axis}
    colour, shape = (alt.Scale(domain=list(MARKS), range=[mark[i] for mark in MARKS.values()]) for i in (0, 1))
    legend = alt.Legend(title=None, orient="top")
    base = alt.Chart(data).encode(y=_y(cells))
    marked = base.encode(color=alt.Color("standing:N", scale=colour, legend=legend))
    band = base.transform_filter("isValid(datum.flattest)").mark_bar(
        size=12, color="currentColor", opacity=0.22, yOffset=BELOW,
    ).encode(x=alt.X("steepest:Q", **x), x2="flattest:Q")
    interval = marked.transform_filter("isValid(datum.low)").mark_rule(strokeWidth=1.75, yOffset=BELOW).encode(
        x=alt.X("low:Q", **x), x2="high:Q")
    points = marked.mark_point(size=50, filled=True, opacity=1, yOffset=BELOW).encode(
        x=alt.X("slope:Q", **x), shape=alt.Shape("standing:N", scale=shape, legend=legend),
        tooltip=["method", "fitted", "theory", "standing"])
    names = _names(cells, {each.cell.method for each in found}, "no error but rounding")
    return finished(alt.layer(band, interval, points, names), ROW * len(cells))


def _slope_row(each: Slope) -> dict[str, Any]:
    value, low, high = each.cell.slope
    steepest, flattest = each.theory
    standing = "no theory" if each.rate is None else "apart from theory" if each.departs else "as theory"
    return {"method": each.cell.method, "slope": value, "low": low, "high": high, "fitted": slope(each.cell),
            "standing": standing, "theory": str(each.rate or "none"), "steepest": steepest - 0.012, "flattest": flattest + 0.012}


def kind(cell: Cell) -> str:
    """Which of the three kinds a method is of."""
    return list(KINDS)[2 if external(cell) else 0 if samples(cell) else 1]


def _kinds(data: pd.DataFrame, channel: type[alt.Color | alt.Fill] = alt.Color) -> alt.Color | alt.Fill:
    present = [name for name in KINDS if name in set(data.kind)]
    scale = alt.Scale(domain=present, range=[KINDS[name] for name in present])
    return channel("kind:N", scale=scale, legend=alt.Legend(title=None, orient="top"))


def _y(cells: Sequence[Cell]) -> alt.Y:
    return alt.Y("method:N", scale=alt.Scale(domain=[cell.method for cell in cells]), axis=None)


def _names(cells: Sequence[Cell], present: set[str], otherwise: str) -> alt.Chart:
    """The methods' names above their rows: beside them they would leave no room on a phone."""
    rows = [{"method": cell.method, "name": cell.method if cell.method in present else f"{cell.method}: {otherwise}"}
            for cell in cells]
    return alt.Chart(pd.DataFrame(rows)).mark_text(
        align="left", baseline="middle", fontSize=11, dy=ABOVE, color="currentColor",
    ).encode(x=alt.value(2), y=_y(cells), text="name:N")
