"""What float32 alone does to a method's light: films of the same points in both precisions, which differ for no other cause."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lightproof import statistics
from lightproof.reporting.evaluation import Cell
from lightproof.reporting.hard import Row
from lightproof.reporting.hard_deviation import LEVEL, Deviation
from lightproof.trial import Status, without_precision


@dataclass(frozen=True)
class Rounding:
    """One method on one hard case, by points (n,), in fractions as `Deviation` has them. `differences` (R, n): float32 less
    float64, film by film."""

    single: Cell
    differences: np.ndarray

    @cached_property
    def noise(self) -> np.ndarray:
        """The half-width of an interval about the mean difference, which holds at all points but for a chance of `LEVEL`."""
        count, points = self.differences.shape
        return statistics.simultaneous_quantile(LEVEL, points, count) * statistics.standard_error(self.differences)

    @cached_property
    def systematic(self) -> np.ndarray:
        """What of the mean difference scatter does not explain."""
        return np.maximum(np.abs(self.differences.mean(axis=0)) - self.noise, 0)


def roundings(rows: Sequence[Row]) -> list[Rounding]:
    """Of every method that draws samples and that a run has in both precisions."""
    return [found for row in rows for found in _of_row(row)]


def _of_row(row: Row) -> list[Rounding]:
    sampled = [square.cell for square in row.squares if square.deviation and not square.deviation.certain]
    double = {without_precision(cell.method): cell for cell in sampled if cell.final[0].precision == "float64"}
    single = [cell for cell in sampled if cell.final[0].precision == "float32" and without_precision(cell.method) in double]
    found = [rounding(cell, double[without_precision(cell.method)]) for cell in single]
    return [one for one in found if one]


def rounding(single: Cell, double: Cell) -> Rounding | None:
    """By the films of as many samples as both have the most of; None where they share no two."""
    films, others = _films(single), _films(double)
    steps: dict[int, list[tuple[int, int]]] = {}
    for step in films.keys() & others.keys():
        steps.setdefault(step[0], []).append(step)
    shared = max(steps.items(), key=lambda step: (len(step[1]), step[0]), default=(0, []))[1]
    if len(shared) < 2:
        return None
    unit = Deviation(single).unit
    return Rounding(single, np.array([(films[step] - others[step]) / unit for step in sorted(shared)]))


def _films(cell: Cell) -> dict[tuple[int, int], np.ndarray]:
    """By samples and replicate."""
    kept = [result for result in cell.results if result.status is Status.OK]
    return {(result.trial.samples, result.trial.replicate): result.film for result in kept}
