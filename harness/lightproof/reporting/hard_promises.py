"""Whether our methods hold on the hard cases what they promise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lightproof.renderers.registry import family, is_ours
from lightproof.reporting.hard import Row, Square
from lightproof.reporting.hard_deviation import ROUNDING
from lightproof.reporting.hard_findings import BROKEN, SAID, absence
from lightproof.reporting.hard_rounding import Rounding, roundings
from lightproof.reporting.sweeps import place
from lightproof.reporting.wording import short
from lightproof.trial import Status

EXACT = 1e-12  # what `analytic` may be off by
SINGLE_PRECISION = ROUNDING  # what Monte Carlo in float32 may be off by
FOIL = "textbook"


@dataclass(frozen=True)
class Promise:
    """What holds everywhere (`kept`), or does not, or is open (None); what is not `promised` is only told beside."""

    kept: bool | None
    text: str
    promised: bool = True


def promises(rows: Sequence[Row]) -> list[Promise]:
    """Of our own methods, as far as the run has them."""
    ours = [square for row in rows for square in row.squares
            if square.cell and is_ours(square.method) and family(square.method) != FOIL]
    drawn = [square for square in ours if square.deviation and not square.deviation.certain
             and square.cell.final[0].precision == "float32"]
    exact = [square for row in rows for square in row.squares if square.method == "analytic"]
    found = (_exact(exact), _single(drawn), _alone(roundings(ours)), _light(ours), *_foil(rows))
    return [promise for promise in found if promise]


def _exact(exact: Sequence[Square]) -> Promise | None:
    measured = [square for square in exact if square.deviation]
    if not measured:
        return None
    unknown = sum(square.no_light is not None or absence(square) != "" for square in exact)
    worst = max(measured, key=lambda square: square.deviation.level)
    level, units = worst.deviation.level, f" ({worst.ulps})" if worst.ulps else ""
    open_ = f"; {unknown} more have no result" if unknown else ""
    return Promise(False if level > EXACT else None if unknown else True,
                   f"analytic, in float64, is within {short(EXACT)} of each exact value: in the {len(measured)} cases measured"
                   f" the worst is {short(level)}{units}, on {worst.cell.scene.name} {worst.deviation.place}{open_}.")


def _single(drawn: Sequence[Square]) -> Promise | None:
    """Kept only where every square could have shown such an error."""
    if not drawn:
        return None
    visible = np.array([square.deviation.noise.max() for square in drawn])
    seeing = int((visible <= SINGLE_PRECISION).sum())
    worst = max(drawn, key=lambda square: square.deviation.systematic.max())
    largest, at = worst.deviation.systematic.max(), int(np.argmax(worst.deviation.systematic))
    found = (f"the largest that noise does not explain is {short(largest)}, by {worst.method} on {worst.cell.scene.name}"
             f" {place(worst.cell.scene, at)}") if largest > 0 else "none was seen beyond noise"
    count, least = len({square.method for square in drawn}), short(SINGLE_PRECISION)
    return Promise(False if largest > SINGLE_PRECISION else True if seeing == len(drawn) else None,
                   f"Monte Carlo in float32 ({count} methods) shows no systematic error above {least}: {found}. Noise is small"
                   f" enough to see {least} at every point in {seeing} of {len(drawn)} squares; in the median square the smallest"
                   f" error that could have been seen is {short(np.median(visible))}.")


def _alone(found: Sequence[Rounding]) -> Promise | None:
    """Kept only where every pair could have shown such an error."""
    if not found:
        return None
    worst = max(found, key=lambda one: one.systematic.max())
    largest, at, cell = worst.systematic.max(), int(np.argmax(worst.systematic)), worst.single
    seeing = sum(one.noise.max() <= SINGLE_PRECISION for one in found)
    least = short(SINGLE_PRECISION)
    beyond = (f"by up to {short(largest)} beyond their scatter, of {cell.method} on {cell.scene.name}"
              f" {place(cell.scene, at)}") if largest > 0 else "by no more than their scatter"
    return Promise(False if largest > SINGLE_PRECISION else True if seeing == len(found) else None,
                   f"Rounding alone shifts no light of Monte Carlo in float32 by more than {least}: films of the same points in"
                   f" float64 differ in the mean {beyond}. {least} could be seen at every point in {seeing} of {len(found)}"
                   " pairs.")


def _light(ours: Sequence[Square]) -> Promise | None:
    if not ours:
        return None
    broken = [f"{square.method} on {square.cell.scene.name} ({square.no_light[0]})" for square in ours if square.no_light]
    films = sum(result.status is Status.OK for square in ours for result in square.cell.results)
    named = f": {', '.join(broken)}" if broken else f": looked at were {films:,}."
    return Promise(False if broken else True if films else None,
                   f"No film of ours holds a NaN, an infinity or negative light{named}")


def _foil(rows: Sequence[Row]) -> list[Promise]:
    """What the textbook's formulas do."""
    squares = [square for row in rows for square in row.squares if square.method == FOIL]
    judged = [square for square in squares if square.deviation or square.no_light]
    if not judged:
        return []
    nothing = sum(bool(square.no_light) for square in judged)
    wrong = sum(square.deviation is not None and square.deviation.level > BROKEN for square in judged)
    return [Promise(None, f"The textbook's formulas in float64 are off by more than {SAID} in {wrong} of {len(judged)} cases,"
                    f" and give no number in {nothing} more: that is what stability buys.", promised=False)]
