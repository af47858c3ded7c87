"""What float32 alone does to a method's light: films of the same points in both precisions, which differ for no other cause."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lightproof import statistics
from lightproof.reporting.evaluation import Cell
from lightproof.reporting.hard import Square
from lightproof.reporting.hard_deviation import LEVEL, Deviation
from lightproof.trial import Status, Trial, without_precision


@dataclass(frozen=True)
class Rounding:
    """One method on one hard case, by points (n,), in fractions as `Deviation` has them. `differences` (R, n): float32 less
    float64, film by film; `lit` (n,): where any of the films met light, or none is due."""

    single: Cell
    differences: np.ndarray
    lit: np.ndarray

    @cached_property
    def noise(self) -> np.ndarray:
        """The half-width of an interval about the mean difference, which holds at all points but for a chance of `LEVEL`; without
        bound where films are black that should not be."""
        count, points = self.differences.shape
        scatter = statistics.simultaneous_quantile(LEVEL, points, count) * statistics.standard_error(self.differences)
        return np.where(self.lit, scatter, np.inf)

    @cached_property
    def systematic(self) -> np.ndarray:
        """What of the mean difference scatter does not explain."""
        return np.maximum(np.abs(self.differences.mean(axis=0)) - self.noise, 0)


def roundings(squares: Sequence[Square]) -> list[Rounding]:
    """Of every method of ours that draws samples and that a run has in both precisions."""
    sampled = [square.cell for square in squares if square.deviation and not square.deviation.certain]
    double = {_points(cell): cell for cell in sampled if cell.final[0].precision == "float64"}
    single = [cell for cell in sampled if cell.final[0].precision == "float32" and _points(cell) in double]
    found = [rounding(cell, double[_points(cell)]) for cell in single]
    return [one for one in found if one]


def rounding(single: Cell, double: Cell) -> Rounding | None:
    """By the step of which both have the most films, of those the one with most samples; None where they share no two."""
    films, others = _films(single), _films(double)
    shared = Counter(trial.samples for trial in films.keys() & others.keys())
    samples, count = max(shared.items(), key=lambda step: (step[1], step[0]), default=(0, 0))
    if count < 2:
        return None
    pairs = np.array([(film, others[trial]) for trial, film in films.items() if trial in others and trial.samples == samples])
    lit = (pairs != 0).any(axis=(0, 1)) | (single.reference.value == 0)
    return Rounding(single, (pairs[:, 0] - pairs[:, 1]) / Deviation(single).unit, lit)


def _points(cell: Cell) -> tuple[str, str]:
    """What methods share that draw the same points."""
    return cell.scene.name, without_precision(cell.method)


def _films(cell: Cell) -> dict[Trial, np.ndarray]:
    """By the trial, but for the precision."""
    kept = [result for result in cell.results if result.status is Status.OK]
    return {replace(result.trial, method=without_precision(cell.method)): result.film for result in kept}
