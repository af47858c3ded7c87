"""Hard cases in sentences: where each method breaks."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from lightproof.reporting.configurations import together
from lightproof.reporting.hard import Group, Row, Square
from lightproof.reporting.hard_deviation import Deviation
from lightproof.reporting.sweeps import Sweep
from lightproof.reporting.wording import amount, percent, short, unbroken
from lightproof.verdict import Outcome

BROKEN, SAID = 0.01, "1 %"  # a systematic error worth a sentence
SOUND = f"no systematic error of more than {SAID}"


def findings(group: Group) -> dict[str, list[str]]:
    """Sentence -> the methods of which it is true, with how much in brackets where it is of each another amount; the last is of
    those of which there is nothing to say."""
    said: dict[str, dict[str, str]] = {}
    for squares in zip(*(row.squares for row in group.rows), strict=True):
        for sentence, most in _sentences(group, squares).items():
            said.setdefault(sentence, {})[squares[0].method] = most
    order = sorted(said, key=lambda sentence: sentence.startswith(SOUND))
    return {sentence: together(said[sentence], group.methods) for sentence in order}


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
        if reason := absence(square):
            without.setdefault(reason, []).append(row.scene.name)
    return {reason if len(rows) == 1 else f"{reason} on {', '.join(names)}": "" for reason, names in without.items()}


def absence(square: Square) -> str:
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
