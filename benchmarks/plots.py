"""Charts of the benchmarks, drawn as those of a run's page are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import altair as alt
import numpy as np
import pandas as pd

from ladders import Ladder
from lightproof.reporting.charts import COLOURS, LEGEND, ROW, SECONDS, SHAPES, decades, finished, log_scale, looks
from lightproof.reporting.wording import count, percent, seconds
from powers import Power
from rows import Row

FLOOR = 1e-7  # of the tolerance scale; smaller errors are drawn here
STEPS = 40  # points of a fitted curve
FILM = "render time of one film"
COUNT = "format(datum.value, '~s')"


def rates(rows: Sequence[Row]) -> dict[str, Any]:
    """Median rate with its interval, a line a method, the fastest on top."""
    ranked = sorted(rows, key=lambda row: -row.median)
    data = pd.DataFrame([{"method": row.method, "rate": row.median, "low": row.interval[0], "high": row.interval[1],
                          "samples/s": count(row.median)} for row in ranked])
    y = alt.Y("method:N", title=None, sort=[row.method for row in ranked], axis=alt.Axis(labelLimit=260, grid=True))
    x = alt.X("rate:Q", title="samples per second", scale=log_scale(data.rate), axis=decades(data.rate, COUNT))
    base = alt.Chart(data)
    points = base.mark_point(filled=True, size=60, color=COLOURS[0]).encode(x=x, y=y, tooltip=["method", "samples/s"])
    spread = base.mark_rule(color=COLOURS[0]).encode(x="low:Q", x2="high:Q", y=y)
    return finished(spread + points, height=ROW * len(ranked))


def races(climbed: Sequence[Ladder], methods: Sequence[str]) -> dict[str, Any]:
    """Error against time of every method on one scene; `methods`, those of all scenes, fix colours and shapes."""
    data = pd.DataFrame([row for one in climbed for row in _steps(one)])
    look = [(one.method, methods.index(one.method)) for one in climbed]
    chosen = alt.selection_point(fields=["method"], bind="legend")
    lines = alt.Chart(data).mark_line(point={"size": 40, "filled": True}, strokeWidth=1.5).encode(
        x=alt.X("seconds:Q", title=FILM, scale=log_scale(data.seconds), axis=decades(data.seconds, SECONDS)),
        y=alt.Y("error:Q", title="rms error [%]", scale=log_scale(data.error), axis=decades(data.error)),
        color=alt.Color("method:N", scale=looks(look, COLOURS), legend=LEGEND),
        shape=alt.Shape("method:N", scale=looks(look, SHAPES), legend=LEGEND),
        order="samples:Q",
        opacity=alt.condition(chosen, alt.value(1), alt.value(0.1)),
        tooltip=["method", "samples:Q", "time", "rms error"],
    ).add_params(chosen)
    return finished(lines, height=360)


def _steps(one: Ladder) -> list[dict[str, Any]]:
    taken, errors = one.points(one.rounds)
    return [{"method": one.method, "samples": samples, "seconds": time, "error": 100 * max(error, FLOOR), "time": seconds(time),
             "rms error": percent(error)} for samples, time, error in zip(one.samples, taken, errors, strict=True)]


def curves(rows: Sequence[Row], powers: dict[str, Power], methods: Sequence[str], what: str = FILM) -> dict[str, Any]:
    """Time against what was varied, with the fitted curves."""
    parameter = rows[0].parameter
    data = pd.DataFrame([{"method": row.method, "amount": row.value, "seconds": row.median, "time": seconds(row.median)}
                         for row in rows])
    lines = pd.concat(_line(method, power, data[data.method == method]) for method, power in powers.items())
    look = [(method, methods.index(method)) for method in data.method.unique()]
    colour = alt.Color("method:N", scale=looks(look, COLOURS), legend=LEGEND)
    x = alt.X("amount:Q", title=parameter, scale=log_scale(data.amount), axis=decades(data.amount, COUNT))
    y = alt.Y("seconds:Q", title=what, scale=log_scale(data.seconds), axis=decades(data.seconds, SECONDS))
    points = alt.Chart(data).mark_point(filled=True, size=50, clip=True).encode(
        x=x, y=y, color=colour, shape=alt.Shape("method:N", scale=looks(look, SHAPES), legend=LEGEND),
        tooltip=["method", "amount:Q", "time"])
    fit = alt.Chart(lines).mark_line(strokeWidth=1.25, clip=True).encode(x=x, y=y, color=colour)
    return finished(fit + points, height=300)


def _line(method: str, power: Power, data: pd.DataFrame) -> pd.DataFrame:
    amounts = np.geomspace(data.amount.min(), data.amount.max(), STEPS)
    return pd.DataFrame({"method": method, "amount": amounts, "seconds": power(amounts)})
