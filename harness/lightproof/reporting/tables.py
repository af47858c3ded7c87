"""results.csv and summary.csv: the run as tables. Errors are fractions of the tolerance scale, times are in seconds."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pandas as pd

from lightproof.reporting.evaluation import Cell, Evaluation
from lightproof.reporting.wording import printable
from lightproof.verdict import Step

RESULTS = (
    "run", "scene", "case", "method", "version", "settings", "precision", "threads", "machine", "seed", "samples", "replicates",
    "outcome", "bias", "bias_low", "bias_high", "worst_tile_bias", "worst_tile_low", "worst_tile_high", "detectable_bias",
    "tolerance", "rmse", "max_error", "bound", "tessellation", "seconds_setup", "seconds_compile", "seconds_render",
    "samples_per_second", "peak_memory_mb", "message",
)  # fmt: skip
SUMMARY = (
    "scene", "case", "method", "outcome", "samples", "bias", "bias_low", "bias_high", "detectable_bias", "tolerance",
    "seconds_to_1_percent", "seconds_to_0_1_percent", "seconds_to_0_01_percent", "slope", "efficiency", "message",
)  # fmt: skip
COUNTS = ("samples", "replicates", "threads", "seed")
OF_STEP = (
    "samples", "replicates", "outcome", "bias", "bias_low", "bias_high", "worst_tile_bias", "worst_tile_low", "worst_tile_high",
    "detectable_bias", "rmse", "max_error", "bound", "seconds_setup", "seconds_compile", "seconds_render", "peak_memory_mb",
    "message",
)  # fmt: skip


def results(evaluation: Evaluation) -> pd.DataFrame:
    """One row per scene, case, method and ladder step, and one with empty numbers where there is no step."""
    return _table([row for cell in evaluation.cells for row in _rows(evaluation, cell)], RESULTS)


def _table(rows: list[dict[str, Any]], columns: tuple[str, ...]) -> pd.DataFrame:
    harmless = [{name: printable(value) if isinstance(value, str) else value for name, value in row.items()} for row in rows]
    table = pd.DataFrame(harmless, columns=list(columns))
    return table.astype({name: "Int64" for name in COUNTS if name in columns})  # whole numbers that may be absent


def _rows(evaluation: Evaluation, cell: Cell) -> Iterator[dict[str, Any]]:
    run, last = evaluation.run, cell.results[-1]
    shared = {
        **_names(cell),
        "run": run.id,
        "version": last.version,
        "settings": json.dumps(dict(last.settings), sort_keys=True, separators=(",", ":")),
        "precision": last.precision,
        "threads": last.threads,
        "machine": run.machine,
        "seed": run.seed,
        "tolerance": cell.verdict.tolerance,
        "tessellation": cell.tessellation,
    }
    if not cell.verdict.steps:
        yield {**shared, "outcome": str(cell.verdict.outcome), "message": cell.verdict.reason}
    for step in cell.verdict.steps:
        yield {**shared, **{name: getattr(step, name) for name in OF_STEP}, "samples_per_second": samples_per_second(cell, step)}


def samples_per_second(cell: Cell, step: Step) -> float | None:
    """Samples over all elements in a second of rendering; None where the time is below the clock's tick."""
    return step.samples * cell.scene.size / step.seconds_render if step.seconds_render > 0 else None


def summary(evaluation: Evaluation) -> pd.DataFrame:
    """One row per scene, case and method: its final verdict, and what its error costs."""
    return _table([_summary(cell) for cell in evaluation.cells], SUMMARY)


def _summary(cell: Cell) -> dict[str, Any]:
    final = {name: getattr(cell.step, name) for name in SUMMARY if name in OF_STEP} if cell.step else {}
    return {
        **final,
        **_names(cell),
        "outcome": str(cell.verdict.outcome),
        "tolerance": cell.verdict.tolerance,
        "seconds_to_1_percent": cell.seconds_to(0.01),
        "seconds_to_0_1_percent": cell.seconds_to(0.001),
        "seconds_to_0_01_percent": cell.seconds_to(0.0001),
        "slope": cell.slope[0],
        "efficiency": cell.efficiency,
        "message": cell.verdict.reason,
    }


def _names(cell: Cell) -> dict[str, str]:
    return {"scene": cell.scene.id, "case": cell.scene.case, "method": cell.method}
