"""Methods in their worker processes, as a run has them, and films of them in turn."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median

from lightproof.method import Unavailable
from lightproof.renderers.pool import MethodFailed, Pool
from lightproof.renderers.process import WorkerDied
from lightproof.renderers.registry import METHODS, OURS, Entry, family
from lightproof.scene import Scene
from lightproof.scene_file import BASE
from lightproof.trial import Result, Status, Trial
from rows import Row

SHORTEST_TIMEOUT = 60.0
SLOWER_THAN_EXPECTED = 20
SHORT, REPEATS = 0.01, 3  # s: a film that takes less is rendered so many times a round
NAIVE = "textbook"  # formulas as they are not to be used
FAILURES = (Unavailable, MethodFailed, WorkerDied)


@dataclass(frozen=True)
class Film:
    """One to be rendered again and again."""

    entry: Entry
    scene: Scene
    samples: int


class Track:
    """What is raced on: workers, a folder for their films, and somebody to `tell`. `seconds` is what a film may take;
    `left_out` says why a renderer does not take part."""

    def __init__(self, pool: Pool, folder: Path, tell: Callable[[str], None], seconds: float):
        self.threads = pool.threads
        self.seconds = seconds
        self.tell = tell
        self._pool = pool
        self._folder = folder
        self.left_out: dict[str, str] = {}
        self._told: set[str] = set()

    @contextmanager
    def fresh(self) -> Iterator[Track]:
        """The same with workers that hold nothing yet."""
        with Pool(self.threads) as pool:
            yield Track(pool, self._folder, self.tell, self.seconds)

    def there(self, entries: Iterable[Entry]) -> list[Entry]:
        """Those of the methods that start; why the others do not is told once."""
        return [entry for entry in entries if self._opens(entry)]

    def _opens(self, entry: Entry) -> bool:
        try:
            self._pool.open(entry)
        except FAILURES as reason:
            self.left_out[family(entry.name)] = str(reason)
            self._tell_once(f"{family(entry.name)} is left out: {reason}")
            return False
        return True

    def render(self, film: Film, turn: int) -> Result:
        """The film once, with a seed for each turn; a renderer's fault is in the result."""
        scene, method = film.scene, film.entry.name
        trial = Trial(scene.id, scene.case, scene.digest, method, film.samples, turn)
        timeout = max(SHORTEST_TIMEOUT, SLOWER_THAN_EXPECTED * self.seconds)
        result = self._pool.render(film.entry, scene, trial, self._folder / "film.exr", timeout)
        if result.status is Status.ERROR:
            self._tell_once(f"{scene.name}, {method}: {result.message}")
        return result

    def race(self, taken: Mapping[Film, list[Result]], rounds: int) -> None:
        """Every film once a round, in turn; the results are added to `taken`. One that fails has no further turn."""
        race({(self, film): results for film, results in taken.items()}, rounds)

    def steady(self, film: Film, turn: int) -> Result:
        """The film of a round. A short one takes the median time of a few, for what rendered before has emptied the caches."""
        result = self.render(film, turn)
        if result.status is not Status.OK or result.seconds["render"] > SHORT:
            return result
        again = [result, *(self.render(film, turn) for _ in range(REPEATS - 1))]
        times = [one.seconds["render"] for one in again if one.status is Status.OK]
        return replace(result, seconds={**result.seconds, "render": median(times)})

    def _tell_once(self, message: str) -> None:
        if message not in self._told:
            self._told.add(message)
            self.tell(message)


def race(taken: Mapping[tuple[Track, Film], list[Result]], rounds: int) -> None:
    """Every film once a round, in turn, each on its track; the results are added to `taken`. One that fails has no further
    turn."""
    running = dict(taken)
    for turn in range(1, rounds + 1):
        for (track, film), results in list(running.items()):
            result = track.steady(film, turn)
            if result.status is Status.OK:
                results.append(result)
            else:
                del running[track, film]


def ours(float64: bool = False) -> list[Entry]:
    """The in-house methods but the naive one, those in float64 as well or not."""
    kept = [entry for entry in METHODS.values() if entry.worker == OURS and family(entry.name) != NAIVE]
    return [entry for entry in kept if float64 or not entry.name.endswith("float64")]


def renderers() -> dict[str, list[Entry]]:
    """Every configuration of every renderer, by its name."""
    found: dict[str, list[Entry]] = {}
    for entry in METHODS.values():
        if entry.worker != OURS:
            found.setdefault(family(entry.name), []).append(entry)
    return found


def phases(bench: str, result: Result) -> list[Row]:
    """What it took, once, to set a scene up and to compile for it, before the films that are timed."""
    trial = result.trial
    return [Row(bench, name(trial), trial.method, "samples", trial.samples, phase, "s", (result.seconds.get(phase, 0.0),))
            for phase in ("setup", "compile")]


def failure(bench: str, result: Result) -> Row:
    """Why there is no measurement."""
    trial = result.trial
    return Row(bench, name(trial), trial.method, "samples", trial.samples, str(result.status), "", note=result.message)


def name(trial: Trial) -> str:
    """The name of a trial's scene."""
    return trial.scene if trial.case == BASE else f"{trial.scene}:{trial.case}"
