"""Time to a given error: every in-house method and every renderer at its best configurations, on the same scenes.

Each climbs a ladder of samples until its error is small enough or the next film would take too long; then all films of all
ladders are rendered in turn, once a round, with a seed of their own each time. Errors are fractions of the tolerance scale,
against the proven reference.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from endings import CLAIMED, FACTOR, Limit
from ladders import DETERMINISTIC, ERRORS, SINGLE, Ladder, ladders
from lightproof import suite
from lightproof.references import ReferenceError
from lightproof.renderers.registry import Entry
from lightproof.scale import Scale
from lightproof.scene import Scene
from lightproof.scene_file import BASE
from lightproof.trial import Result, Status
from race import Film, Track, failure, ours, phases, renderers
from rows import Estimate, Row

NAME = "accuracy"
TAGS = ("direct", "shadow", "furnace")
FIRST, MOST = 1, 4**15  # samples per element
STRETCH = 6  # times the seconds of a renderer's film, for that which may lead beyond a claimed error
OURS_SHARE = 0.2  # of a renderer's time that a film of ours may take: there are many of them, and the best need far less
CHOICE_SHARE = 0.2  # of a renderer's time that a film may take while its configuration is chosen

Add = Callable[[Iterable[Row]], None]


def measure(track: Track, add: Add, rounds: int, quick: bool, everything: bool = False) -> None:
    """Scene by scene; one without a reference is told of and left out."""
    chosen = [scene for scene in suite.default().scenes() if is_asked(scene, everything)]
    for scene in chosen[:1] if quick else chosen:
        try:
            reference = suite.default().reference(scene)
        except ReferenceError as error:
            track.tell(str(error))
            continue
        track.tell(f"{NAME}: {scene.name}")
        race(track, scene, Scale.of(scene, reference), ours(float64=everything), add, rounds)


def is_asked(scene: Scene, everything: bool) -> bool:
    """The quick base cases of direct light, shadows and furnaces, or all of those."""
    return bool(set(scene.tags) & set(TAGS)) and (everything or ("quick" in scene.tags and scene.case == BASE))


def race(track: Track, scene: Scene, scale: Scale, own: Sequence[Entry], add: Add, rounds: int) -> None:
    """Every method's ladder, `own` and those of each renderer that are best for an error, then all their films in turn."""
    short, long = OURS_SHARE * track.seconds, track.seconds
    climbs = [climb(track, scene, scale, entry, Limit(short, short)) for entry in track.there(own)]
    climbs += [climb(track, scene, scale, entry, Limit(long, STRETCH * long)) for entry in best(track, scene, scale, add)]
    taken: dict[Film, list[Result]] = {}
    for films, results in climbs:
        add(failure(NAME, result) for result in results if result.status is not Status.OK)
        whole = [film for film, result in zip(films, results, strict=True) if result.status is Status.OK]
        add(phases(NAME, results[0]) if whole else [])
        taken |= {film: [] for film in whole}
    try:
        track.race(taken, rounds)
    finally:
        measured = [row for film, results in taken.items() for row in rows(film, results, scale)]
        add([*measured, *times(ladders(measured))])


def climb(track: Track, scene: Scene, scale: Scale, entry: Entry, limit: Limit) -> tuple[list[Film], list[Result]]:
    """One film a step, until there are enough of them or the next would be beyond the `limit`."""
    films: list[Film] = []
    results: list[Result] = []
    samples = FIRST
    while samples <= MOST:
        films.append(Film(entry, scene, samples))
        results.append(track.steady(films[-1], 0))
        if results[-1].status is not Status.OK or limit.ends(*steps(results, scale)):
            break
        samples *= FACTOR
    return films, results


def steps(results: Iterable[Result], scale: Scale) -> tuple[list[float], list[float]]:
    """Error and seconds of each film."""
    return [rms(result, scale) for result in results], [result.seconds["render"] for result in results]


def best(track: Track, scene: Scene, scale: Scale, add: Add) -> list[Entry]:
    """Each renderer's configurations that take part."""
    return [entry for configurations in renderers().values()
            for entry in chosen(track, scene, scale, track.there(configurations), add)]


def chosen(track: Track, scene: Scene, scale: Scale, configurations: Sequence[Entry], add: Add) -> list[Entry]:
    """Those of a renderer's configurations that come soonest to an error that claims are about, by a ladder of one film a step;
    the only one without a try; none where none can."""
    if len(configurations) < 2:
        return list(configurations)
    found: dict[Entry, Ladder] = {}
    seconds = CHOICE_SHARE * track.seconds
    for entry in configurations:
        films, results = climb(track, scene, scale, entry, Limit(seconds, STRETCH * seconds))
        tried = [row for film, result in zip(films, results, strict=True) for row in rows(film, ok(result), scale)]
        for one in ladders(tried):
            found[entry] = one
    soonest = {error: min(found, key=lambda entry: found[entry].time_to(error)) for error in CLAIMED if found}
    add(Row("choice", scene.name, entry.name, "rms error", error, "render", "s", estimate=Estimate(one.time_to(error)),
            note=", ".join(filter(None, (one.kind(error), "chosen" if entry == first else ""))))
        for error, first in soonest.items() for entry, one in found.items())
    return list(dict.fromkeys(soonest.values()))


def ok(result: Result) -> list[Result]:
    """The result, if it is a film."""
    return [result] if result.status is Status.OK else []


def rows(film: Film, results: Sequence[Result], scale: Scale) -> list[Row]:
    """Render time and error of one film in every round."""
    about = (NAME, film.scene.name, film.entry.name, "samples", film.samples)
    single = SINGLE if all(result.samples == 1 for result in results) else ""
    noiseless = DETERMINISTIC if any(result.deterministic for result in results) else ""
    return [Row(*about, "render", "s", tuple(result.seconds["render"] for result in results), single),
            Row(*about, "error", "1", tuple(rms(result, scale) for result in results), noiseless)]


def rms(result: Result, scale: Scale) -> float:
    """Root mean square over the elements of a film's error, as a fraction of the tolerance scale."""
    return float(np.sqrt((((result.film - scale.value) / scale.unit) ** 2).mean()))


def times(climbed: Iterable[Ladder]) -> list[Row]:
    """Seconds to each of `ERRORS`, and how they are known."""
    return [Row(NAME, one.scene, one.method, "rms error", error, "render", "s", note=one.kind(error),
                estimate=one.estimate(error))
            for one in climbed for error in ERRORS]
