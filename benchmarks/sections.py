"""The sections of the page: what each benchmark found, as charts with their tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import plots
from ladders import AT_MOST, ERRORS, EXTRAPOLATED, MEASURED, NEVER, SHORTEST, ladders
from lightproof.reporting import wording
from powers import Power, fitted
from rows import Estimate, Row

SIGNS = {MEASURED: "", SHORTEST: "", AT_MOST: "≤ ", EXTRAPOLATED: "≈ ", NEVER: ""}
WHOLE = "the whole loop"
ONCE = {"setup": "set-up", "compile": "compile"}  # phases, and what a table calls them
SET_UP_FOR = ("elements", "lights", "blockers")  # what a scene is set up for
GROWN = 10  # times the least set-up, of the greatest: a curve has an exponent
NONE = "—"
COUNTED = ("compiled", "hits", "misses")


@dataclass(frozen=True)
class Part:
    """A chart with its title and the table below it: `head` and `body` of the table."""

    title: str
    chart: dict[str, Any] | None
    head: Sequence[str] = ()
    body: Sequence[Sequence[str]] = ()


def interval(estimate: Estimate) -> str:
    """From where to where; empty where that is not known."""
    known = not math.isnan(estimate.low + estimate.high)
    return f"{wording.number(estimate.low)} to {wording.number(estimate.high)}" if known else ""


def throughput(rows: Sequence[Row]) -> list[Part]:
    """A chart for each scene and number of samples."""
    races: dict[tuple[str, float], list[Row]] = {}
    for row in rows:
        if row.unit == "samples/s" and row.each:
            races.setdefault((row.scene, row.value), []).append(row)
    parts = []
    for (scene, samples), raced in races.items():
        once = _once([row for row in rows if (row.scene, row.value) == (scene, samples)])
        body = [[row.method, wording.count(row.median), " to ".join(map(wording.count, row.interval)), *once(row.method)]
                for row in sorted(raced, key=lambda row: -row.median)]
        title = f"{scene}, {samples:,.0f} samples per element"
        parts.append(Part(title, plots.rates(raced), ("method", "samples/s", "interval", *ONCE.values()), body))
    return parts


def _once(rows: Sequence[Row]) -> Callable[[str], list[str]]:
    """What a method took but once: the cells of `ONCE`."""
    found = {(row.method, row.phase): row.median for row in rows}
    return lambda method: [wording.seconds(found.get((method, phase), math.nan)) for phase in ONCE]


def choice(rows: Sequence[Row]) -> list[Part]:
    """What every configuration came to, and which took part."""
    tried = [row for row in rows if row.phase == "render" and math.isfinite(row.median)]
    body = [[row.scene, row.method, *_reached(row), row.note] for row in tried]
    return [Part("Tried", None, ("scene", "configuration", "to", "time, or samples/s", ""), body)] if body else []


def _reached(row: Row) -> tuple[str, str]:
    """An error and the time to it, or how many samples a second."""
    rate = row.unit == "samples/s"
    return ("", wording.count(row.median)) if rate else (f"{100 * row.value:g} %", wording.seconds(row.median))


def accuracy(rows: Sequence[Row]) -> list[Part]:
    """A chart for each scene, and the times that it comes to."""
    climbed = ladders(rows)
    methods = list(dict.fromkeys(one.method for one in climbed))
    times = {(row.scene, row.method, row.value): row for row in rows if row.parameter == "rms error"}
    parts = []
    for scene in dict.fromkeys(one.scene for one in climbed):
        here = [one for one in climbed if one.scene == scene]
        once = _once([row for row in rows if row.scene == scene])
        body = [[one.method, *(_time(times.get((scene, one.method, error))) for error in ERRORS), *once(one.method)]
                for one in sorted(here, key=lambda one: (one.time_to(ERRORS[1]), one.method))]
        head = ("method", *(f"render to {100 * error:g} %" for error in ERRORS), *ONCE.values())
        parts.append(Part(scene, plots.races(here, methods), head, body))
    return parts


def _time(row: Row | None) -> str:
    if row is None or not math.isfinite(row.median):
        return NONE if row is None else "never"
    known = f", {EXTRAPOLATED}" if row.note == EXTRAPOLATED else ""
    return f"{SIGNS[row.note]}{wording.seconds(row.median)}{known}{_span(*row.interval)}"


def _span(low: float, high: float) -> str:
    return "" if math.isnan(low + high) else f" ({wording.seconds(low)} to {wording.seconds(high)})"


def hardware(rows: Sequence[Row]) -> list[Part]:
    """The loop's variants as a chart, with what a sample is made of."""
    rates = [row for row in rows if row.unit == "samples/s" and row.each]
    peak = [row for row in rows if row.unit == "operations/s" and row.each]
    whole = next((row.median for row in rates if row.method == WHOLE), math.nan)
    body = [[row.method, f"{wording.number(1e12 / row.median)} ps", wording.percent(whole / row.median)] for row in rates]
    counted = [row for row in rows if row.phase == "operations" and not row.note]
    made = [[row.method, row.parameter, wording.number(row.median)] for row in counted]
    made += [[row.method, "floating-point operations per second", wording.count(row.median)] for row in peak]
    loop = Part("Parts of the loop left out", plots.rates(rates) if rates else None,
                ("", "a sample takes", "of the whole loop's time"), body)
    return [loop, Part("What a sample is made of", None, ("", "operations", "number"), made)]


def growth(rows: Sequence[Row]) -> list[Part]:
    """For each thing that was varied a chart of render times with exponents and memory, and one of set-up times."""
    timed = [row for row in rows if row.phase == "render" and row.each]
    methods = list(dict.fromkeys(row.method for row in timed))
    parts = []
    for parameter in dict.fromkeys(row.parameter for row in timed):
        here = [row for row in timed if row.parameter == parameter]
        powers = _powers(here)
        body = [[method, *_exponent(power), wording.seconds(power.overhead) if power.overhead else "",
                 _memory(rows, method, parameter)] for method, power in powers.items()]
        parts.append(Part(f"Time against {parameter}", plots.curves(here, powers, methods) if powers else None,
                          ("method", "exponent", "interval", "overhead", "memory"), body))
        once = [row for row in rows if row.parameter == parameter and row.phase == "setup" and row.median > 0]
        parts += [setting_up(once, methods)] if once and parameter in SET_UP_FOR else []
    return parts


def setting_up(rows: Sequence[Row], methods: Sequence[str]) -> Part:
    """Set-up of one parameter's scenes, each measured once; an exponent where it grows by more than noise."""
    amounts = sorted({row.value for row in rows})
    found: dict[str, dict[float, float]] = {}
    for row in rows:
        found.setdefault(row.method, {})[row.value] = row.median
    grown = [method for method, each in found.items() if max(each.values()) > GROWN * min(each.values())]
    powers = _powers([row for row in rows if row.method in grown])
    body = [[method, _exponent(powers[method])[0] if method in powers else NONE,
             *(wording.seconds(each[amount]) if amount in each else NONE for amount in amounts)]
            for method, each in found.items()]
    return Part(f"Set-up against {rows[0].parameter}", plots.curves(rows, powers, methods, "set-up") if powers else None,
                ("method", "exponent", *(f"{amount:,.0f}" for amount in amounts)), body)


def _powers(rows: Sequence[Row]) -> dict[str, Power]:
    """By method, where there are enough amounts."""
    each: dict[str, list[Row]] = {}
    for row in rows:
        each.setdefault(row.method, []).append(row)
    return {method: power for method, own in each.items() if (power := fitted(own))}


def _exponent(power: Power) -> tuple[str, str]:
    return wording.number(power.exponent.value), interval(power.exponent)


def _memory(rows: Sequence[Row], method: str, parameter: str) -> str:
    """Of the least amount and of the greatest."""
    asked = (method, parameter, "memory")
    found = {row.value: row.median for row in rows if row.each and (row.method, row.parameter, row.phase) == asked}
    return f"{found[min(found)]:.1f} to {found[max(found)]:.1f} MB"


def cache(rows: Sequence[Row]) -> list[Part]:
    """A line a kernel."""
    found: dict[float, dict[str, Row]] = {}
    for row in rows:
        found.setdefault(row.value, {})[row.phase] = row
    body = [[f"{kind['render'].scene}, {kind['render'].method}", wording.seconds(kind["render"].median),
             _span(*kind["render"].interval).strip(" ()"), *(wording.number(kind[name].median) for name in COUNTED)]
            for _, kind in sorted(found.items()) if kind["render"].each]
    return [Part("Fresh processes", None, ("kernel", "time", "interval", *COUNTED), body)] if body else []


SECTIONS: dict[str, tuple[str, Callable[[Sequence[Row]], list[Part]]]] = {
    "throughput": (
        "Samples per second over all elements and threads. All in one chart take the same number of samples per element, on a"
        " film of more elements than the scene's own.", throughput),
    "accuracy": (
        "Render time of one film until its rms error is so many per cent of the tolerance scale, against the proven light."
        " ≤: the first step of the ladder, which took more than one sample, was better than that; ≈: extrapolated by the slope"
        " of the last steps; never: the error has stopped falling. Set-up and compilation come once, before the first film; of"
        " a kernel found on disk the latter is what it takes to load.", accuracy),
    "choice": ("Configurations of renderers, tried on every scene; the best for each error took part.", choice),
    "hardware": (
        "The multiply-add peak is measured on the same threads in the same rounds; a multiply-add counts as two operations.",
        hardware),
    "growth": (
        "Lines are fitted: time = overhead + factor × amount ^ exponent. Lights have a fixed number of samples each. Set-up was"
        " measured once for each scene. Memory is the largest that was resident in the method's process, which it shares with"
        " its family, while a film was rendered, from the least amount to the greatest. The processes are fresh when samples,"
        " the first, are varied; what is varied later finds what was compiled before.", growth),
    "cache": (
        "Processes that start from nothing and find the compiled kernels on disk. The first kernel's time runs from the moment"
        " when numba is imported.", cache),
}
