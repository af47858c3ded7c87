"""What was promised, held against what was measured in one run."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from ladders import AT_MOST, EXTRAPOLATED, SHORTEST, Ladder, ladders
from lightproof import suite
from lightproof.renderers.registry import family, is_ours
from ratios import difference, over_rounds, ratio
from rows import Estimate, Row

MET, MISSED, OPEN, UNMEASURED, TOLD = "met", "missed", "open", "not measured", ""
LEAST, MOST = "at least", "at most"
EXACT, SQUARE = "analytic", "square-light"
ALIASES = {"path": "mc-area", "path/sobol": "mc-area/sobol"}  # where there is the latter, which takes no interreflection
FLAT = 1.0  # MB: of the samples that are tried, those of one element would be more, at a float32 each


@dataclass(frozen=True)
class Claim:
    """A number, its `target` (None: it is only told), and whether that is the `least` or the `most` that it may be. The number
    may be `extrapolated`, or known only from `above`, where it may be less."""

    text: str
    scene: str
    measured: Estimate
    target: float | None = None
    sense: str = LEAST
    note: str = ""
    extrapolated: bool = False
    above: bool = False

    @property
    def sign(self) -> str:
        """What stands before the number."""
        return "≈ " if self.extrapolated else "≤ " if self.above else ""

    @property
    def outcome(self) -> str:
        """Met or missed where the whole interval is on one side of the target, open where it holds it, or where less than is
        known would not do."""
        if math.isnan(self.measured.value):
            return UNMEASURED
        if self.target is None:
            return TOLD
        ends = [end for end in (self.measured.value, self.measured.low, self.measured.high) if not math.isnan(end)]
        keeps = [end >= self.target if self.sense == LEAST else end <= self.target for end in ends]
        certain = not (self.above and self.sense == LEAST)
        return (MET if certain else OPEN) if all(keeps) else OPEN if any(keeps) else MISSED


def claims(rows: Sequence[Row]) -> list[Claim]:
    """Every claim of the benchmarks that these rows are from."""
    parts = {"throughput": throughput, "accuracy": accuracy, "hardware": hardware, "growth": growth, "cache": cache}
    grouped = {name: [row for row in rows if row.bench == name] for name in parts}
    return [claim for name, part in parts.items() if grouped[name] for claim in part(grouped[name])]


def throughput(rows: Sequence[Row]) -> list[Claim]:
    """Samples per second of `mc-area` over each renderer's at as many samples, of which Mitsuba's two ways have targets."""
    rates = {(row.scene, row.value, row.method): row.each for row in rows if row.phase == "render" and row.each}
    found = []
    for (scene, samples, method), each in rates.items():
        own = rates.get((scene, samples, "mc-area"), ())
        if not is_ours(method):
            most = max(value for name, value, other in rates if name == scene and family(other) == family(method))
            target = {"mitsuba-loop": 15.0, "mitsuba": 100.0}.get(family(method)) if samples == most else None
            text = f"mc-area over {method}, samples/s at {samples:.0f} samples an element"
            found.append(Claim(text, scene, ratio(own, each), target))
    return found


def accuracy(rows: Sequence[Row]) -> list[Claim]:
    """Time of the fastest renderer over that of the best of ours: sampling alone to 0.1 %, of any kind to 0.01 %."""
    scenes: dict[str, list[Ladder]] = {}
    for one in ladders(rows):
        scenes.setdefault(one.scene, []).append(one)
    return [claim for scene, climbed in scenes.items() for claim in (
        race(scene, climbed, 0.001, 30.0 if "furnace" in suite.default().scene(scene).tags else 100.0, sampling=True),
        race(scene, climbed, 0.0001, 1000.0, sampling=False),
    )]


def race(scene: str, climbed: Sequence[Ladder], error: float, target: float, sampling: bool) -> Claim:
    """The ratio of times to an error, with the names of both, and whether `analytic` is the fastest. A bound on the renderer's
    time is one on the ratio; ours counts as it is, for no shorter film can be asked for."""
    ours = [one for one in own(climbed) if not (sampling and one.deterministic)]
    best, other = fastest(ours, error), fastest([one for one in climbed if not is_ours(one.method)], error)
    text = f"time to {100 * error:g} %, fastest renderer over our best {'sampling method' if sampling else 'method'}"
    if best is None or other is None:
        missing = "none of ours" if best is None else "no renderer"
        return Claim(text, scene, Estimate(math.nan), target, note=f"{missing} gets there")
    rounds = min(len(best.rounds), len(other.rounds))
    measured = over_rounds(rounds, lambda chosen: other.time_to(error, chosen) / best.time_to(error, chosen))
    notes = [f"{spoken(other, error)} over {spoken(best, error)}"]
    kinds = {best.kind(error), other.kind(error)}
    if kinds <= {AT_MOST, SHORTEST}:
        notes.append("both from the first sample on, so that only overheads are compared")
    if not sampling and best.method != EXACT and any(one.method == EXACT for one in ours):
        notes.append(f"{EXACT} is not the fastest")
    return Claim(text, scene, measured, target, note="; ".join(notes),
                 extrapolated=EXTRAPOLATED in kinds, above=other.kind(error) == AT_MOST)


def own(climbed: Sequence[Ladder]) -> list[Ladder]:
    """Ours on one scene, but those that are the same kernel as another there, a second chance to be lucky."""
    there = {one.method for one in climbed}
    return [one for one in climbed if is_ours(one.method) and ALIASES.get(one.method) not in there]


def fastest(climbed: Iterable[Ladder], error: float) -> Ladder | None:
    """Who comes soonest to an error; None where nobody does."""
    times = {one.method: (one.time_to(error), one) for one in climbed}
    reached = [pair for pair in times.values() if math.isfinite(pair[0])]
    return min(reached, key=lambda pair: pair[0])[1] if reached else None


def spoken(one: Ladder, error: float) -> str:
    """A method, and how its time is known where that is not plainly measured."""
    kind = one.kind(error)
    return f"{one.method} ({kind})" if kind in (AT_MOST, SHORTEST, EXTRAPOLATED) else one.method


def hardware(rows: Sequence[Row]) -> list[Claim]:
    """The share of the peak that the arithmetic of `mc-area` makes up."""
    rates = {row.method: row.each for row in rows if row.unit in ("samples/s", "operations/s")}
    done = {row.parameter: row.median for row in rows if row.phase == "operations" and row.method == "mc-area"}
    share = ratio(rates.get("mc-area", ()), rates.get("multiply-add peak", ()))
    told = {"floating-point": ("as compiled", 0.5), "floating-point, by hand": ("as written", None)}
    return [Claim(f"share of the multiply-add peak, operations {how}", SQUARE, scaled(share, done.get(what, math.nan)), target)
            for what, (how, target) in told.items()]


def scaled(estimate: Estimate, factor: float) -> Estimate:
    """The estimate times a number."""
    return Estimate(factor * estimate.value, factor * estimate.low, factor * estimate.high)


def growth(rows: Sequence[Row]) -> list[Claim]:
    """Memory that the most samples take beyond that of the fewest; how many blockers were tried with success."""
    memory = ends([row for row in rows if row.method == "mc-area" and row.phase == "memory" and row.parameter == "samples"])
    blockers = [row.value for row in rows if row.method == "mc-area" and row.parameter == "blockers" and row.each]
    found = [Claim(f"MB that {memory[1].value:,.0f} samples an element take beyond {memory[0].value:,.0f}, mc-area",
                   memory[0].scene, difference(memory[1].each, memory[0].each), FLAT, MOST)] if memory else []
    most = Estimate(max(blockers, default=math.nan))
    return [*found, Claim("blockers that mc-area works with", "many-blockers", most, 100.0)]


def ends(rows: Sequence[Row]) -> tuple[Row, Row] | None:
    """The rows with the least and the greatest amount."""
    measured = sorted((row for row in rows if row.each), key=lambda row: row.value)
    return (measured[0], measured[-1]) if measured else None


def cache(rows: Sequence[Row]) -> list[Claim]:
    """Seconds to the first kernel and to the slowest of the others, and that nothing was compiled."""
    seconds = {row.value: row for row in rows if row.phase == "render" and row.each}
    first = seconds.pop(1, None)
    slowest = max(seconds.values(), key=lambda row: row.median, default=None)
    compiled = [max(row.each) for row in rows if row.phase in ("compiled", "misses") and row.each]
    timed: Mapping[str, tuple[Row | None, float]] = {
        "seconds from import numba to the first kernel": (first, 0.5),
        "seconds to each further kernel, the slowest": (slowest, 0.05),
    }
    found = [Claim(text, f"{row.scene}, {row.method}", Estimate(row.median, *row.interval), most, MOST)
             for text, (row, most) in timed.items() if row]
    none = Estimate(max(compiled, default=math.nan))
    return [*found, Claim("kernels compiled, or missing from the cache", "all", none, 0.0, MOST)]
