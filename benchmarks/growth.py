"""How time grows with samples, elements, lights, blockers and threads, and whether memory grows with samples.

Every method goes on until a film takes too long, or until it refuses. Lights and blockers are many small squares between the
same floor and lamp, so that the scene stays what it is. The workers are fresh, and samples are the first to be varied: workers
that have compiled what other parts need hold some GB, beside which a film is nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import numpy as np

from lightproof import scene_file, suite
from lightproof.renderers.registry import METHODS, Entry
from lightproof.scene import Scene
from lightproof.trial import Result, Status
from race import Film, Track, failure, race
from rows import Row

NAME = "growth"
NODES = "analytic"  # the method whose samples are nodes, each of which takes in every light
RACERS = ("mc-area", "mc-area/sobol", NODES, "mitsuba")
SCENE = "square-light"
FEW_SAMPLES, MORE_SAMPLES = 64, 1024
PER_NODE = 16  # samples: a node is worth more
GRID = [16, 12]
ELEMENTS = ([1, 1], [4, 3], [16, 12], [64, 48], [256, 192], [1000, 1000])
SAMPLES = tuple(4**power for power in range(3, 12))
COUNTS = (1, 3, 10, 30, 100, 300, 1000)  # of lights, of blockers
LONGEST = 4  # times what a renderer's film may take: a method that would take longer, in proportion, stops
THREADS_GRID = [64, 48]
THREADS_SAMPLES = {"mc-area": 2**18, "mc-area/sobol": 2**18, "analytic": 64, "mitsuba": 2048}  # of a film of some 0.2 s
SIDE = 0.7  # of its place, of a small square

Add = Callable[[Iterable[Row]], None]


@dataclass(frozen=True)
class Point:
    """Where a curve is measured: what is varied, how much of it there is, and the scene for it, with samples and nodes per
    element."""

    parameter: str
    amount: int
    scene: Scene
    samples: int
    nodes: int


def measure(track: Track, add: Add, rounds: int, quick: bool, tracks: dict[int, Track]) -> None:
    """Curve by curve; `tracks` has one for each number of threads."""
    entries = track.there(METHODS[name] for name in RACERS)
    with ExitStack() as stack:
        fresh = {count: stack.enter_context(other.fresh()) for count, other in tracks.items()}
        for points in (samples(), elements(), lights(), blockers()):
            curve(fresh[track.threads], list(points)[: 2 if quick else None], entries, add, rounds)
        threads(fresh, entries, add, rounds, quick)


def curve(track: Track, points: list[Point], entries: list[Entry], add: Add, rounds: int) -> None:
    """Every method at every point, in turn; a method that failed, or would take too long, goes no further."""
    running = list(entries)
    for point, following in zip(points, [*points[1:], points[-1]], strict=True):
        track.tell(f"{NAME}: {point.parameter} {point.amount:,}")
        films = [Film(entry, point.scene, point.nodes if entry.name == NODES else point.samples) for entry in running]
        firsts = {film: track.render(film, 0) for film in films}
        add(failure(NAME, result) for result in firsts.values() if result.status is not Status.OK)
        taken: dict[Film, list[Result]] = {film: [] for film, result in firsts.items() if result.status is Status.OK}
        try:
            track.race(taken, rounds)
        finally:
            add(row for film, results in taken.items() for row in rows(point.parameter, point.amount, film, results))
        longest = LONGEST * track.seconds * point.amount / following.amount
        running = [film.entry for film, results in taken.items() if results and results[-1].seconds["render"] < longest]


def threads(tracks: dict[int, Track], entries: list[Entry], add: Add, rounds: int, quick: bool) -> None:
    """Every method with every number of threads, in turn."""
    taken: dict[tuple[Track, Film], list[Result]] = {}
    for entry in entries:
        film = Film(entry, gridded(THREADS_GRID), max(1, THREADS_SAMPLES[entry.name] // (64 if quick else 1)))
        for track in tracks.values():
            first = track.render(film, 0)
            if first.status is Status.OK:
                taken[track, film] = []
            else:
                add([failure(NAME, first)])
    try:
        race(taken, rounds)
    finally:
        for (track, film), results in taken.items():
            add(rows("threads", track.threads, film, results))


def rows(parameter: str, amount: int, film: Film, results: list[Result]) -> list[Row]:
    """Render time, the worker's largest memory, and what it took to set the scene up."""
    about = (NAME, film.scene.name, film.entry.name, parameter, amount)
    return [Row(*about, "render", "s", tuple(result.seconds["render"] for result in results)),
            Row(*about, "memory", "MB", tuple(result.peak_memory_mb for result in results)),
            Row(*about, "setup", "s", tuple(result.seconds["setup"] for result in results[:1]))]


def elements() -> Iterator[Point]:
    for resolution in ELEMENTS:
        yield Point("elements", int(np.prod(resolution)), gridded(resolution), FEW_SAMPLES, FEW_SAMPLES // PER_NODE)


def samples() -> Iterator[Point]:
    for number in SAMPLES:
        yield Point("samples", number, gridded(GRID), number, number // PER_NODE)


def lights() -> Iterator[Point]:
    """The lamp cut into so many small ones; samples per element are those of one lamp times their number, which share them."""
    for number in COUNTS:
        table = base()
        lamp = table["light"].pop()
        corners = np.array(lamp["shape"]["vertices"])
        for place, square in enumerate(squares(corners, number)):
            shape = {"type": "polygon", "vertices": square}
            table["light"].append({"id": f"lamp-{place}", "kind": "area", "radiance": lamp["radiance"], "shape": shape})
        yield Point("lights", number, scene_file.from_table(table, "many-lights"), FEW_SAMPLES * number, FEW_SAMPLES // PER_NODE)


def blockers() -> Iterator[Point]:
    """Small squares half way between lamp and floor."""
    level = np.array([[-0.6, -0.6, 0.6], [-0.6, 0.6, 0.6], [0.6, 0.6, 0.6], [0.6, -0.6, 0.6]])
    for number in COUNTS:
        table = base()
        table["surface"] = [{"id": f"blocker-{place}", "reflectance": 0.0, "shape": {"type": "polygon", "vertices": square}}
                            for place, square in enumerate(squares(level, number))]
        yield Point("blockers", number, scene_file.from_table(table, "many-blockers"), MORE_SAMPLES, MORE_SAMPLES // PER_NODE)


def squares(corners: np.ndarray, number: int) -> list[list[list[float]]]:
    """The corners of so many small copies of a parallelogram (4, 3), side by side in it."""
    side = int(np.ceil(np.sqrt(number)))
    a, b, _, d = corners
    parts = SIDE / side * (corners - corners.mean(axis=0))
    return [(a + (place % side + 0.5) / side * (b - a) + (place // side + 0.5) / side * (d - a) + parts).tolist()
            for place in range(number)]


def gridded(resolution: list[int]) -> Scene:
    table = base()
    table["film"]["resolution"] = resolution
    return scene_file.from_table(table, SCENE)


def base() -> dict[str, Any]:
    return suite.default().scene(SCENE).to_table()
