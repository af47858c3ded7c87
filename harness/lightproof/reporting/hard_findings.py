"""Hard cases in sentences: where each method breaks, and whether ours hold what they promise."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from lightproof.renderers.registry import METHODS, OURS
from lightproof.reporting import hard
from lightproof.reporting.hard import Deviation, Group, Row, Square, amount, short
from lightproof.reporting.sweeps import Sweep
from lightproof.reporting.wording import percent, unbroken
from lightproof.trial import Status
from lightproof.verdict import Outcome

BROKEN, SAID = 0.01, "1 %"  # a systematic error worth a sentence
ROUNDING = 1e-12  # that `analytic` may have
SINGLE_PRECISION = hard.ROUNDING  # that Monte Carlo in float32 may have
FOIL = "textbook"
SOUND = f"no systematic error of more than {SAID}"


@dataclass(frozen=True)
class Promise:
    """What holds everywhere (`kept`), or does not, or is open (None); what is not `promised` is only told beside."""

    kept: bool | None
    text: str
    promised: bool = True


def findings(group: Group) -> dict[str, list[str]]:
    """Sentence -> the methods of which it is true, with how much in brackets where it is of each another amount; the last is of
    those of which there is nothing to say."""
    said: dict[str, list[str]] = {}
    for squares in zip(*(row.squares for row in group.rows), strict=True):
        for sentence, most in _sentences(group, squares).items():
            said.setdefault(sentence, []).append(squares[0].method + (f" ({most})" if most else ""))
    return dict(sorted(said.items(), key=lambda item: item[0].startswith(SOUND)))


def _sentences(group: Group, squares: Sequence[Square]) -> dict[str, str]:
    """Of one method, each with what goes into brackets: sound only where every case that the method accepts was measured, and
    nowhere could noise hide an error to speak of."""
    faults, absent = _faults(group, squares), missing(group.rows, squares)
    if faults or not any(square.deviation for square in squares):
        return faults | absent
    return absent | {f"{SOUND} elsewhere" if absent else SOUND: ""}


def _faults(group: Group, squares: Sequence[Square]) -> dict[str, str]:
    measured = [(row, square.deviation) for row, square in zip(group.rows, squares, strict=True) if square.deviation]

    def at(marked: Callable[[Deviation], np.ndarray]) -> str:
        return where(group, [(row, marked(one)) for row, one in measured])

    off = at(lambda one: one.systematic > BROKEN)
    blind, unlit = at(_blind), at(lambda one: one.unlit)
    hider, most = _hidden([one for _, one in measured]) if blind else ("", "")
    broken = next((square.no_light for square in squares if square.no_light), None)
    said = {
        f"off by more than {SAID} {off}": (off, ""),
        f"blind to errors of more than {SAID} {blind}: {hider}": (blind, most),
        f"meets no light {unlit}": (unlit, ""),
        "no light but {}, first {}".format(*broken or ("", "")): (broken, ""),
    }
    return {sentence: brackets for sentence, (true, brackets) in said.items() if true}


def _blind(one: Deviation) -> np.ndarray:
    """Where (n,) noise could hide an error to speak of; of light that is not met at all there is another sentence."""
    return (one.noise > BROKEN) & (one.systematic <= BROKEN) & ~one.unlit


def _hidden(measured: Sequence[Deviation]) -> tuple[str, str]:
    """What hides errors, and of up to how much."""
    one = max(measured, key=lambda each: np.where(_blind(each), each.noise, 0).max())
    worst = int(np.argmax(np.where(_blind(one), one.noise, 0)))
    hider = "a single sample can weigh" if one.leap[worst] > one.noise[worst] / 2 else "noise hides"
    return f"{hider} up to the share of the light in brackets", unbroken(_share(float(one.noise[worst])))


def _share(value: float) -> str:
    return percent(value) if value < 10 else f"{short(value)} times"


def missing(rows: Sequence[Row], squares: Sequence[Square]) -> dict[str, str]:
    """Which cases nothing is known of, and why: none of what a method does not support, nor of what is no light."""
    without: dict[str, list[str]] = {}
    for row, square in zip(rows, squares, strict=True):
        if reason := _absence(square):
            without.setdefault(reason, []).append(row.scene.name)
    return {reason if len(rows) == 1 else f"{reason} on {', '.join(names)}": "" for reason, names in without.items()}


def _absence(square: Square) -> str:
    """Why next to nothing is known of a case; empty where something is."""
    if square.deviation:
        return "a single film, of unknown noise," if square.deviation.alone else ""
    if square.cell is None:
        return "not reached by this run"
    if square.cell.verdict.outcome is Outcome.ERROR and not square.no_light:
        return "nothing but an error"
    return ""


def where(group: Group, marked: Sequence[tuple[Row, np.ndarray]]) -> str:
    """At which values of the sweep's parameter any point of the rows is marked (n,), in words; empty where none is."""
    marks = np.concatenate([each for _, each in marked]) if marked else np.zeros(0, bool)
    if not marks.any():
        return ""
    if not group.swept:
        return f"at {marks.sum()} of {len(marks)} points"
    values = np.concatenate([row.parameter for row, _ in marked])
    steps = np.unique(values)
    return ranges(steps, np.array([marks[values == step].any() for step in steps]), group.sweep)


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
    drawn = [square for square in ours if square.deviation and not square.deviation.certain
             and square.cell.final[0].precision == "float32"]
    exact = [square for row in rows for square in row.squares if square.method == "analytic"]
    return [promise for promise in (_rounding(exact), _single(drawn), _light(ours), *_foil(rows)) if promise]


def _name(square: Square) -> str:
    return square.method.partition("/")[0]


def _rounding(exact: Sequence[Square]) -> Promise | None:
    measured = [square for square in exact if square.deviation]
    if not measured:
        return None
    unknown = sum(square.no_light is not None or _absence(square) != "" for square in exact)
    worst = max(measured, key=lambda square: square.deviation.level)
    level, units = worst.deviation.level, f" ({worst.ulps})" if worst.ulps else ""
    open_ = f"; {unknown} more have no result" if unknown else ""
    return Promise(False if level > ROUNDING else None if unknown else True,
                   f"analytic, in float64, is within {short(ROUNDING)} of each exact value: in the {len(measured)} cases measured"
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
             f" {hard.place(worst.cell.scene, at)}") if largest > 0 else "none was seen beyond noise"
    count, least = len({square.method for square in drawn}), short(SINGLE_PRECISION)
    return Promise(False if largest > SINGLE_PRECISION else True if seeing == len(drawn) else None,
                   f"Monte Carlo in float32 ({count} methods) shows no systematic error above {least}: {found}. Noise is small"
                   f" enough to see {least} at every point in {seeing} of {len(drawn)} squares; in the median square the smallest"
                   f" error that could have been seen is {short(np.median(visible))}.")


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
