"""What a benchmark measures, as rows of one shape, kept as they come."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from scipy.stats import binom

LEVEL = 0.95
ABOUT = ("bench", "scene", "method", "parameter", "value", "phase", "unit", "note")
COLUMNS = (*ABOUT, "median", "low", "high", "rounds", "each")


@dataclass(frozen=True)
class Estimate:
    """A number with its interval."""

    value: float
    low: float = np.nan
    high: float = np.nan


@dataclass(frozen=True)
class Row:
    """One quantity, measured once a round: `each` in the order of the rounds, in `unit`. `parameter` is what was varied
    (samples, elements, threads) and `value` what it was; `phase` what was measured: setup, compile, render, error, memory.
    What was computed from other rows is an `estimate` instead. A row with neither says why in `note`."""

    bench: str
    scene: str
    method: str
    parameter: str
    value: float
    phase: str
    unit: str
    each: tuple[float, ...] = ()
    note: str = ""
    estimate: Estimate | None = None

    @property
    def median(self) -> float:
        """Over the rounds; NaN where nothing was measured."""
        if self.estimate:
            return self.estimate.value
        return float(np.median(self.each)) if self.each else np.nan

    @property
    def interval(self) -> tuple[float, float]:
        """Two order statistics that hold the median with a chance of at least `LEVEL`; of fewer than six rounds the range."""
        if not self.each:
            return (self.estimate.low, self.estimate.high) if self.estimate else (np.nan, np.nan)
        ordered = sorted(self.each)
        skipped = max(0, int(binom.ppf((1 - LEVEL) / 2, len(ordered), 0.5)) - 1)
        return ordered[skipped], ordered[-1 - skipped]

    def record(self) -> dict[str, Any]:
        """The row as the CSV has it."""
        known = dict(zip(("median", "low", "high"), (self.median, *self.interval), strict=True))
        numbers = {name: "" if np.isnan(value) else f"{value:.6g}" for name, value in known.items()}
        each = " ".join(f"{one:.6g}" for one in self.each)
        return {**{name: getattr(self, name) for name in ABOUT}, **numbers, "rounds": len(self.each), "each": each}


class Table:
    """Rows, each written to the CSV at `path` as soon as it is there."""

    def __init__(self, path: Path):
        path.parent.mkdir(parents=True, exist_ok=True)
        self._rows: list[Row] = []
        self._file: TextIO = path.open("w", encoding="utf-8", newline="")
        self._writer = csv.DictWriter(self._file, COLUMNS)
        self._writer.writeheader()

    def __enter__(self) -> Table:
        return self

    def __exit__(self, *exception: object) -> None:
        self._file.close()

    def __iter__(self) -> Iterator[Row]:
        return iter(self._rows)

    def add(self, rows: Iterable[Row]) -> None:
        """Take up rows, and have them on disk."""
        for row in rows:
            self._rows.append(row)
            self._writer.writerow(row.record())
        self._file.flush()


def read(path: Path) -> list[Row]:
    """The rows of a CSV."""
    with path.open(encoding="utf-8", newline="") as lines:
        return [_row(record) for record in csv.DictReader(lines)]


def _row(record: dict[str, str]) -> Row:
    about = {name: record[name] for name in ABOUT} | {"value": float(record["value"])}
    each = tuple(map(float, record["each"].split()))
    known = Estimate(*(float(record[name] or "nan") for name in ("median", "low", "high")))
    return Row(**about, each=each, estimate=None if each or np.isnan(known.value) else known)
