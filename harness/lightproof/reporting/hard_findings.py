"""Hard cases in sentences: where each method breaks, and whether ours hold what they promise."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from lightproof.renderers.registry import METHODS, OURS
from lightproof.reporting import hard
from lightproof.reporting.hard import Deviation, Group, Row, Square, amount, short
from lightproof.reporting.sweeps import Sweep

BROKEN, SAID = 0.01, "1 %"  # a systematic error worth a sentence
ROUNDING = 1e-12  # that `analytic` may have
SINGLE_PRECISION = hard.ROUNDING  # that Monte Carlo in float32 may have
FOIL = "textbook"
SOUND = f"no systematic error of more than {SAID}"


@dataclass(frozen=True)
class Promise:
    """What holds everywhere, or does not; None for what nobody promised."""

    kept: bool | None
    text: str


def findings(group: Group) -> dict[str, list[str]]:
    """Sentence -> the methods of which it is true; the last is of those of which there is nothing to say."""
    said: dict[str, list[str]] = {}
    for squares in zip(*(row.squares for row in group.rows), strict=True):
        sound = [SOUND] if any(square.deviation for square in squares) else []
        for sentence in _sentences(group, squares) or sound:
            said.setdefault(sentence, []).append(squares[0].method)
    return dict(sorted(said.items(), key=lambda item: item[0] == SOUND))


def _sentences(group: Group, squares: Sequence[Square]) -> list[str]:
    def where(marked: Callable[[Deviation], np.ndarray]) -> str:
        known = [(row.parameter, marked(square.deviation)) for row, square in zip(group.rows, squares, strict=True)
                 if square.deviation]
        return _where(group.sweep if group.swept else None, known)

    off = where(lambda one: one.systematic > BROKEN)
    blind = where(lambda one: (one.leap > BROKEN) & (one.systematic <= BROKEN) & ~one.unlit)
    unlit = where(lambda one: one.unlit)
    broken = next((square.no_light for square in squares if square.no_light), None)
    said = {
        f"off by more than {SAID} {off}": off,
        f"blind to errors of more than {SAID} {blind}: a single sample can weigh that much": blind,
        f"meets no light {unlit}": unlit,
        "no light but {}, first {}".format(*broken or ("", "")): broken,
    }
    return [sentence for sentence, true in said.items() if true]


def _where(sweep: Sweep | None, known: Sequence[tuple[np.ndarray | None, np.ndarray]]) -> str:
    """At which values of the parameter (n,) any point is marked, in words; empty where none is."""
    marks = np.concatenate([marked for _, marked in known]) if known else np.zeros(0, bool)
    if not marks.any():
        return ""
    if sweep is None:
        return f"at {marks.sum()} of {len(marks)} points"
    values = np.concatenate([parameter for parameter, _ in known])
    steps = np.unique(values)
    return ranges(steps, np.array([marks[values == step].any() for step in steps]), sweep)


def ranges(steps: np.ndarray, marked: np.ndarray, sweep: Sweep) -> str:
    """The marked ones of rising values: everywhere, from one on, or one by one."""
    if marked.all():
        return "everywhere"
    below, above = int(np.argmin(marked)), int(np.argmin(marked[::-1]))
    middle = [step for step, mark in zip(steps[below:len(steps) - above], marked[below:len(steps) - above], strict=True) if mark]
    said = [f"{amount(steps[below - 1], sweep.unit)} and less"] if below else []
    said += [amount(step, sweep.unit) for step in middle]
    said += [f"{amount(steps[-above], sweep.unit)} and more"] if above else []
    return f"at a{'n' if sweep.parameter[0] in 'aeiou' else ''} {sweep.parameter} of {', '.join(said)}"


def promises(rows: Sequence[Row]) -> list[Promise]:
    """Of our own methods, as far as the run has them."""
    ours = [square for row in rows for square in row.squares
            if square.cell and square.method in METHODS and METHODS[square.method].worker == OURS and _name(square) != FOIL]
    measured = [square for square in ours if square.deviation]
    exact = [square for square in measured if square.method == "analytic"]
    drawn = [square for square in measured
             if not square.cell.final[0].deterministic and square.cell.final[0].precision == "float32"]
    return [promise for promise in (_rounding(exact), _single(drawn), _light(ours), *_foil(rows)) if promise]


def _name(square: Square) -> str:
    return square.method.partition("/")[0]


def _rounding(exact: Sequence[Square]) -> Promise | None:
    if not exact:
        return None
    worst = max(exact, key=lambda square: square.deviation.level)
    units = f" ({worst.ulps})" if worst.ulps else ""
    return Promise(worst.deviation.level <= ROUNDING, f"analytic, in float64, is within {short(ROUNDING)} of each exact value:"
                   f" the worst is {short(worst.deviation.level)}{units}, on {worst.cell.scene.name} {worst.deviation.place}.")


def _single(drawn: Sequence[Square]) -> Promise | None:
    if not drawn:
        return None
    worst = max(drawn, key=lambda square: square.deviation.systematic.max())
    largest = worst.deviation.systematic.max()
    count = len({square.method for square in drawn})
    if largest == 0:
        return Promise(True, f"Monte Carlo in float32 ({count} methods) shows no systematic error at all beyond its noise.")
    return Promise(largest <= SINGLE_PRECISION, f"Monte Carlo in float32 ({count} methods) shows no systematic error above"
                   f" {short(SINGLE_PRECISION)}: the largest that noise does not explain is {short(largest)}, by"
                   f" {worst.method} on {worst.cell.scene.name} {worst.deviation.place}.")


def _light(ours: Sequence[Square]) -> Promise | None:
    if not ours:
        return None
    broken = [f"{square.method} on {square.cell.scene.name} ({square.no_light[0]})" for square in ours if square.no_light]
    named = f": {', '.join(broken)}" if broken else "."
    return Promise(not broken, f"No film of ours holds a NaN, an infinity or negative light{named}")


def _foil(rows: Sequence[Row]) -> list[Promise]:
    """What the textbook's formulas do."""
    squares = [square for row in rows for square in row.squares if square.method == FOIL]
    judged = [square for square in squares if square.deviation or square.no_light]
    if not judged:
        return []
    nothing = sum(bool(square.no_light) for square in judged)
    wrong = sum(square.deviation is not None and square.deviation.level > BROKEN for square in judged)
    return [Promise(None, f"The textbook's formulas in float64 are off by more than {SAID} in {wrong} of {len(judged)} cases,"
                    f" and give no number in {nothing} more: that is what stability buys.")]
