"""The slope that theory expects of a method on a scene, and whether the measured one agrees."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lightproof.estimators.rates import DOMAINS, GRIDS, POINTS, Rate
from lightproof.renderers.registry import family, is_ours
from lightproof.reporting import smoothness
from lightproof.reporting.evaluation import Cell
from lightproof.reporting.wording import number

ROUNDING = 1e-6  # of the tolerance scale: a method whose first film is as exact has no error to fall but that of its arithmetic
STUCK = 0.7  # of a film's error: where the mean over replicates is off by more, the rest is not noise
NAMED = 6  # slopes that a sentence has room for
INDEPENDENT = ("independent", "random")  # how renderers' settings call points that do not depend on one another


@dataclass(frozen=True)
class Slope:
    """d log(error) / d log(samples) of a cell with its 95 % interval; `rate` is theory's, None where it says nothing."""

    cell: Cell
    rate: Rate | None

    @property
    def theory(self) -> tuple[float, float]:
        """The steepest and the flattest slope that theory allows around the samples measured; NaN where it says nothing."""
        if self.rate is None:
            return math.nan, math.nan
        return self.rate.slopes(math.exp(np.mean([math.log(step.samples) for step in self.cell.drawable])))

    @property
    def comparable(self) -> bool:
        """Whether there is an interval to hold against theory."""
        return self.rate is not None and not math.isnan(self.cell.slope[1])

    @property
    def departs(self) -> str:
        """How the interval excludes theory: flatter, steeper, or not at all."""
        (_, low, high), (steepest, flattest) = self.cell.slope, self.theory
        return "flatter" if low > flattest else "steeper" if high < steepest else ""

    @property
    def stuck(self) -> bool:
        """Whether most of the last film's error is none that more samples reduce: a bias, or rounding."""
        return bool(np.sqrt(np.mean(self.cell.error**2)) > STUCK * self.cell.step.rmse)

    def __str__(self) -> str:
        """A slope that departs, in words."""
        reason = ", as most of its error is bias or rounding" if self.departs == "flatter" and self.stuck else ""
        return f"{self.cell.method} ({slope(self.cell)}) is {self.departs} than {power(*self.theory)}{reason}"


def slopes(cells: Iterable[Cell]) -> list[Slope]:
    """Of every usable method whose error falls by more than rounding."""
    falling = [cell for cell in cells if cell.usable and not math.isnan(cell.slope[0]) and cell.verdict.steps[0].rmse > ROUNDING]
    return [Slope(cell, expected(cell)) for cell in falling]


def expected(cell: Cell) -> Rate | None:
    """Theory's rate; where some of a film's elements lie at an edge, from theirs to that of the others. None for closed forms,
    for what has nothing to sample, and for a renderer whose points are not known to be independent."""
    settings, name = cell.final[0].settings, family(cell.method)
    if not is_ours(cell.method):
        return POINTS["independent"].point[0] if independent(settings) else None
    rates = GRIDS.get(name) or POINTS.get(settings.get("points", "independent"))
    size = smoothness.coordinates(cell.scene, DOMAINS[name]) if name in DOMAINS else 0
    if not size or rates is None:
        return None
    smooth, shadowed = rates.element if size == 4 else rates.point
    if not smoothness.edges(cell.scene, DOMAINS[name]):
        return smooth
    return Rate(max(smooth.flattest, shadowed.flattest), min(smooth.steepest, shadowed.steepest))


def independent(settings: Mapping[str, Any]) -> bool:
    """Whether a renderer's settings say that its sampler draws independent points."""
    return any("sampler" in name and str(value).lower() in INDEPENDENT for name, value in settings.items())


def slope(cell: Cell) -> str:
    """The fitted slope with half its 95 % interval, as far as the steps tell."""
    value, low, high = cell.slope
    if math.isnan(value):
        return "\N{EM DASH}"
    half = (high - low) / 2
    decimals = min(4, max(2, 1 - math.floor(math.log10(half)))) if half > 0 else 2
    text = f"{value:.{decimals}f} ± {half:.{decimals}f}" if math.isfinite(half) else f"{value:.2f}"
    return text.replace("-", "\N{MINUS SIGN}")


def power(steepest: float, flattest: float) -> str:
    """Theory's slope, or the range of it."""
    if steepest == flattest:
        return number(flattest)
    return f"{number(flattest)} to {number(steepest)}"


def in_words(found: Sequence[Slope]) -> str:
    """How many slopes agree, and which do not."""
    known = [each for each in found if each.comparable]
    if not known:
        return ""
    apart = [each for each in known if each.departs]
    count = f"{len(known) - len(apart)} of {len(known)} slopes agree with theory"
    more = [f"and {len(apart) - NAMED} more are apart"] if len(apart) > NAMED else []
    return "; ".join([count, *map(str, apart[:NAMED]), *more])
