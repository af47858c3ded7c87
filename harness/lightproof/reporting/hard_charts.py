"""Error, and the scatter of one sample, against the parameter of a sweep, a line for each method: where it breaks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import altair as alt
import numpy as np
import pandas as pd

from lightproof.reporting import hard_spread
from lightproof.reporting.charts import COLOURS, LEGEND, SHAPES, decades, finished, log_scale, looks
from lightproof.reporting.hard import Group, Row, Square
from lightproof.reporting.hard_deviation import Deviation
from lightproof.reporting.wording import number

FLOOR = 1e-17  # smaller errors are drawn here
LEAST_SPREAD = 1e-3  # and samples that scatter less
POWERS = "format(datum.value, '~e')"


def error_along(group: Group, methods: Sequence[str]) -> dict[str, Any] | None:
    """The worst error of the points that share a value of the parameter, hollow where noise explains it; `methods` are those of
    the whole run. None where nothing is swept or measured."""
    records = [record for row, square in _swept(group) if square.deviation for record in _errors(row, square)]
    layers = _along(group, methods, records, "worst error", ["off", "noise"])
    return finished(alt.layer(*layers), height=320) if layers else None


def spread_along(group: Group, methods: Sequence[str]) -> dict[str, Any] | None:
    """The largest standard deviation of one sample at a value of the parameter, hollow where it is only known to be no less. None
    where nothing is swept or no method scatters."""
    records = [record for row, square in _swept(group) for record in _spreads(row, square)]
    layers = _along(group, methods, records, "deviation of a sample / exact light", ["deviation"])
    limit = alt.Chart(pd.DataFrame({"most": [hard_spread.MOST]})).mark_rule(strokeDash=[5, 4], color="currentColor", opacity=0.6)
    return finished(alt.layer(limit.encode(y="most:Q"), *layers), height=320) if layers else None


def _swept(group: Group) -> Iterator[tuple[Row, Square]]:
    yield from ((row, square) for row in group.rows for square in row.squares) if group.swept else ()


def _along(group: Group, methods: Sequence[str], records: Sequence[dict[str, Any]], title: str,
           told: Sequence[str]) -> list[alt.Chart]:
    """Lines and points of the largest `value` of each method at each value of the parameter; `told` is for the tooltip."""
    if not records:
        return []
    data = pd.DataFrame(records)
    data = data.loc[data.groupby(["method", "parameter"], sort=False).value.idxmax()]
    look = [(method, place) for place, method in enumerate(methods) if method in set(data.method)]
    chosen = alt.selection_point(fields=["method"], bind="legend")
    sweep = group.sweep
    lines = alt.Chart(data).mark_line(strokeWidth=1.5).encode(
        x=alt.X("parameter:Q", title=f"{sweep.parameter}{f' [{sweep.unit}]' if sweep.unit else ''}",
                scale=log_scale(data.parameter), axis=decades(data.parameter, POWERS)),
        y=alt.Y("value:Q", title=title, scale=log_scale(data.value), axis=decades(data.value, POWERS)),
        color=alt.Color("method:N", scale=looks(look, COLOURS), legend=LEGEND),
        order="parameter:Q",
        opacity=alt.condition(chosen, alt.value(1), alt.value(0.12)),
    )
    points = lines.mark_point(size=45, strokeWidth=1.5).encode(
        shape=alt.Shape("method:N", scale=looks(look, SHAPES), legend=LEGEND),
        fill=alt.condition("datum.hidden", alt.value("transparent"), alt.Fill("method:N", scale=looks(look, COLOURS))),
        tooltip=["method", "at", *told],
    ).add_params(chosen)
    return [lines, points]


def _errors(row: Row, square: Square) -> Iterator[dict[str, Any]]:
    one: Deviation = square.deviation
    for at, parameter in enumerate(row.parameter):
        error = float(np.abs(one.error[at]))
        yield {
            "method": square.method,
            "parameter": float(parameter),
            "value": max(error, FLOOR),
            "at": f"{row.scene.name}, point {at}",
            "off": number(float(one.error[at]), 2),
            "noise": "none" if one.certain else f"± {number(float(one.noise[at]), 2)}",
            "hidden": bool(error <= one.noise[at]),
        }


def _spreads(row: Row, square: Square) -> Iterator[dict[str, Any]]:
    spread = hard_spread.of(square)
    for at, relative in enumerate(spread.relative if spread else ()):
        if not np.isnan(relative):
            yield {
                "method": square.method,
                "parameter": float(row.parameter[at]),
                "value": max(float(relative), LEAST_SPREAD),
                "at": f"{row.scene.name}, point {at}",
                "deviation": f"{'at least, if right, ' if spread.hidden[at] else ''}{number(float(relative), 2)} times the light",
                "hidden": bool(spread.hidden[at]),
            }
