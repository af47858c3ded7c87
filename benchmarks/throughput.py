"""Samples per second: `mc-area` against Mitsuba's fastest configuration, a hand-written Mitsuba loop, Cycles and the others.

The film has more elements than the scene's own, because that suits renderers which work on all pixels side by side. Those
compared with each other take the same number of samples per element; methods that sample nothing have no place here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from lightproof import suite
from lightproof.estimators.rates import DOMAINS
from lightproof.renderers.registry import METHODS, Entry, family
from lightproof.scene import Scene
from lightproof.trial import Result, Status
from race import Film, Track, failure, ours, phases, renderers
from rows import Row

NAME = "throughput"
SCENES = ("square-light", "occluded-square")
RESOLUTION = (128, 96)
MANY, FEW = 2048, 64  # samples per element: of what is compared with Mitsuba, and with the slower renderers
BY_HAND = Path(__file__).parent / "mitsuba_loop.py"
LOOP = Entry("mitsuba-loop", f"{BY_HAND}:Loop", worker="mitsuba-loop", extra="mitsuba")
BUNDLE = Entry("mitsuba-bundle", f"{BY_HAND}:Bundle", worker="mitsuba-bundle", extra="mitsuba")
CHOOSING = 3  # rounds that choose Mitsuba's configuration, at half the samples


def measure(track: Track, add: Callable[[Iterable[Row]], None], rounds: int, quick: bool) -> None:
    """One race a scene and number of samples."""
    sampling = [entry for entry in ours() if family(entry.name) in DOMAINS]
    for name in SCENES[: 1 if quick else None]:
        many, resolution = (MANY // 8, (32, 24)) if quick else (MANY, RESOLUTION)
        scene = suite.default().scene(name)
        scene = replace(scene, film=replace(scene.film, resolution=resolution))
        slower = [entry for renderer, entries in renderers().items() if renderer != "mitsuba" for entry in entries[:1]]
        race(track, scene, [*sampling, LOOP, BUNDLE, *fastest(track, scene, many, add)], many, rounds, add)
        race(track, scene, [METHODS["mc-area"], METHODS["mitsuba"], *slower], FEW, rounds, add)


def fastest(track: Track, scene: Scene, samples: int, add: Callable[[Iterable[Row]], None]) -> list[Entry]:
    """Mitsuba's LLVM configuration with most samples a second, out of all; none where there is no Mitsuba."""
    vectorised = [entry for entry in renderers()["mitsuba"] if entry.name not in ("mitsuba/scalar", "mitsuba/spectral")]
    rows: list[Row] = []
    race(track, scene, vectorised, samples // 2, CHOOSING, rows.extend, name="choice")
    rates = {row.method: row.median for row in rows if row.phase == "render" and row.each}
    best = max(rates, key=rates.get, default=None)
    add(replace(row, note="chosen") if row.method == best and row.phase == "render" else row for row in rows)
    return [METHODS[best]] if best else []


def race(track: Track, scene: Scene, entries: Sequence[Entry], samples: int, rounds: int,
         add: Callable[[Iterable[Row]], None], name: str = NAME) -> None:
    """Films in turn, round after round, after a first one of each that is not counted."""
    firsts = {film: track.render(film, 0) for film in (Film(entry, scene, samples) for entry in track.there(entries))}
    add(failure(name, result) for result in firsts.values() if result.status is not Status.OK)
    taken: dict[Film, list[Result]] = {film: [] for film, result in firsts.items() if result.status is Status.OK}
    try:
        track.race(taken, rounds)
    finally:
        for film, results in taken.items():
            each = tuple(rate(result) for result in results)
            rates = Row(name, scene.name, film.entry.name, "samples", samples, "render", "samples/s", each)
            add([rates, *phases(name, firsts[film])])


def rate(result: Result) -> float:
    """Samples a second over all elements."""
    return result.samples * result.film.size / result.seconds["render"]
