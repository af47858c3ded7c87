"""Error against the parameter of a sweep, a line for each method: where it breaks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import altair as alt
import numpy as np
import pandas as pd

from lightproof.reporting.charts import COLOURS, LEGEND, SHAPES, decades, finished, log_scale, looks
from lightproof.reporting.hard import Deviation, Group, Row, Square
from lightproof.reporting.wording import number

FLOOR = 1e-17  # smaller errors are drawn here
POWERS = "format(datum.value, '~e')"


def error_along(group: Group, methods: Sequence[str]) -> dict[str, Any] | None:
    """The worst error of the points that share a value of the parameter, hollow where noise explains it; `methods` are those of
    the whole run. None where nothing is swept or measured."""
    if not group.swept:
        return None
    records = [record for row in group.rows for square in row.squares if square.deviation for record in _records(row, square)]
    if not records:
        return None
    data = pd.DataFrame(records)
    data = data.loc[data.groupby(["method", "parameter"], sort=False).error.idxmax()]
    look = [(method, place) for place, method in enumerate(methods) if method in set(data.method)]
    chosen = alt.selection_point(fields=["method"], bind="legend")
    sweep = group.sweep
    lines = alt.Chart(data).mark_line(strokeWidth=1.5).encode(
        x=alt.X("parameter:Q", title=f"{sweep.parameter}{f' [{sweep.unit}]' if sweep.unit else ''}",
                scale=log_scale(data.parameter), axis=decades(data.parameter, POWERS)),
        y=alt.Y("error:Q", title="worst error", scale=log_scale(data.error), axis=decades(data.error, POWERS)),
        color=alt.Color("method:N", scale=looks(look, COLOURS), legend=LEGEND),
        order="parameter:Q",
        opacity=alt.condition(chosen, alt.value(1), alt.value(0.12)),
    )
    points = lines.mark_point(size=45, strokeWidth=1.5).encode(
        shape=alt.Shape("method:N", scale=looks(look, SHAPES), legend=LEGEND),
        fill=alt.condition("datum.hidden", alt.value("transparent"), alt.Fill("method:N", scale=looks(look, COLOURS))),
        tooltip=["method", "at", "off", "noise"],
    ).add_params(chosen)
    return finished(alt.layer(lines, points), height=320)


def _records(row: Row, square: Square) -> Iterator[dict[str, Any]]:
    one: Deviation = square.deviation
    for at, parameter in enumerate(row.parameter):
        error = float(np.abs(one.error[at]))
        yield {
            "method": square.method,
            "parameter": float(parameter),
            "error": max(error, FLOOR),
            "at": f"{row.scene.name}, point {at}",
            "off": number(float(one.error[at]), 2),
            "noise": "none" if one.certain else f"± {number(float(one.noise[at]), 2)}",
            "hidden": bool(error <= one.noise[at]),
        }
