"""From a trial to its result: one worker per renderer, kept up between trials and replaced when it dies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from lightproof import films
from lightproof.checked import plain
from lightproof.films import FilmError
from lightproof.method import Unavailable
from lightproof.renderers import scratch
from lightproof.renderers.process import LARGEST_FILE, Worker, WorkerDied, WorkerTimeout
from lightproof.renderers.registry import Entry
from lightproof.scene import Scene
from lightproof.trial import Result, Status, Trial

PATIENCE = 60.0
PREPARING = 5  # times the patience: to compile may take a minute of a machine that has nothing else to do
UNBOUNDED = ("tessellation", "peak", "bound")  # channels that may be infinite
DOING = {"open": "starting the renderer", "prepare": "preparing the scene", "render": "rendering"}


class MethodFailed(Exception):
    """A method raised; the message says what, and during which operation."""


class Unsupported(Exception):
    """A method cannot do a scene; the message is its reason."""


@dataclass(frozen=True)
class About:
    """What an opened method says of itself; see `method.Method`."""

    version: str
    deterministic: bool
    samples_lights: bool


@dataclass(frozen=True)
class Preparation:
    """The scene that a method has prepared, what it took [s], and how the method is set; see `method.Method`."""

    scene: str
    digest: str
    seconds: Mapping[str, float] = field(default_factory=dict)
    settings: Mapping[str, Any] = field(default_factory=dict)
    precision: str = ""
    caveat: str = ""


class Pool:
    """The workers of a run. `patience` [s] is what a renderer may take to start; to prepare a scene it may take `PREPARING`
    times as long. Workers import from the folders of `path` first."""

    def __init__(self, threads: int, patience: float = PATIENCE, file_limit: int = LARGEST_FILE, path: Sequence[str] = ()):
        scratch.sweep()
        self.threads = threads
        self._patience = patience
        self._file_limit = file_limit
        self._path = path
        self._workers: dict[str, Worker] = {}
        self._opened: dict[str, dict[str, About]] = {}
        self._unable: dict[str, Exception] = {}
        self._prepared: dict[str, Preparation] = {}

    def __enter__(self) -> Pool:
        return self

    def __exit__(self, *exception: object) -> None:
        for family in list(self._workers):
            self._discard(family)

    def open(self, entry: Entry) -> About:
        """Start a method. Raises Unavailable where it is not installed, MethodFailed or WorkerDied where it breaks; what
        failed to start once is not started again."""
        if entry.name in self._unable:
            raise self._unable[entry.name]
        opened = self._opened.setdefault(entry.worker, {})
        if entry.name not in opened:
            try:
                opened[entry.name] = self._start(entry)
            except (Unavailable, MethodFailed, WorkerDied) as error:
                self._unable[entry.name] = error
                raise
        return opened[entry.name]

    def _start(self, entry: Entry) -> About:
        answer = self._ask(entry, "open", self._patience, target=entry.target, threads=self.threads)
        if "unavailable" in answer:
            under = f" (for {entry.python})" if entry.python else ""
            raise Unavailable(plain(answer["unavailable"]) + under)
        return About(plain(answer.pop("version")), **answer)

    def render(self, entry: Entry, scene: Scene, trial: Trial, film: Path, timeout: float) -> Result:
        """The result of one trial, its film written to the path `film`. Never raises on a renderer's fault: a worker that
        dies is replaced and the trial tried once more; one that hangs for `timeout` [s], or dies as it starts, is not."""
        try:
            return self._attempt(entry, scene, trial, film, timeout)
        except WorkerDied as error:
            if isinstance(error, WorkerTimeout) or entry.name in self._unable:
                return self._failed(trial, str(error))
            return self._second_attempt(entry, scene, trial, film, timeout, first=str(error))

    def _second_attempt(self, entry: Entry, scene: Scene, trial: Trial, film: Path, timeout: float, first: str) -> Result:
        try:
            result = self._attempt(entry, scene, trial, film, timeout)
        except WorkerDied as error:
            return self._failed(trial, f"{error} (at the second attempt too)")
        return replace(result, message=" ".join(filter(None, [result.message, f"(the first attempt failed {first})"])))

    def _attempt(self, entry: Entry, scene: Scene, trial: Trial, film: Path, timeout: float) -> Result:
        try:
            about = self.open(entry)
            prepared = self._prepare(entry, scene)
            film.parent.mkdir(parents=True, exist_ok=True)
            film.unlink(missing_ok=True)
            answer = self._ask(entry, "render", timeout, samples=trial.samples, seed=trial.seed, film=str(film))
            if "unsupported" in answer:
                raise Unsupported(plain(answer["unsupported"]))
            return self._filled(trial, about, prepared, answer, read_film(film, scene))
        except (Unavailable, Unsupported) as reason:
            return Result(trial, Status.UNSUPPORTED, threads=self.threads, message=str(reason))
        except (MethodFailed, FilmError, OSError) as error:
            self._prepared.pop(entry.name, None)
            told = isinstance(error, MethodFailed)
            return self._failed(trial, str(error) if told else f"{plain(str(error))}{self._last_words(entry)}")
        finally:
            film.with_suffix(films.PARTIAL).unlink(missing_ok=True)
            self._thin_out(entry)

    def _filled(self, trial: Trial, about: About, prepared: Preparation, answer: Mapping[str, Any],
                channels: Mapping[str, np.ndarray]) -> Result:
        return Result(
            trial=trial,
            status=Status.OK,
            film=channels["Y"],
            variance=channels.get("variance"),
            quantization=channels.get("quantization", 0.0),
            tessellation=channels.get("tessellation"),
            peak=channels.get("peak"),
            bound=channels.get("bound"),
            samples=answer["samples"],
            seconds={**prepared.seconds, **answer["seconds"]},
            version=about.version,
            settings=prepared.settings,
            precision=prepared.precision,
            caveat=prepared.caveat,
            deterministic=about.deterministic,
            samples_lights=about.samples_lights,
            threads=self.threads,
            peak_memory_mb=answer["peak_memory_mb"],
        )

    def _failed(self, trial: Trial, message: str) -> Result:
        return Result(trial, Status.ERROR, threads=self.threads, message=message)

    def _prepare(self, entry: Entry, scene: Scene) -> Preparation:
        prepared = self._prepared.get(entry.name)
        if prepared and (prepared.scene, prepared.digest) == (scene.name, scene.digest):
            return prepared
        told = {"scene_id": scene.id, "case": scene.case, "table": scene.to_table()}
        answer = self._ask(entry, "prepare", PREPARING * self._patience, **told)
        if "unsupported" in answer:
            raise Unsupported(plain(answer["unsupported"]))
        said = {name: plain(answer.pop(name)) for name in ("precision", "caveat")}
        self._prepared[entry.name] = Preparation(scene.name, scene.digest, **answer, **said)
        return self._prepared[entry.name]

    def _ask(self, entry: Entry, op: str, timeout: float, **arguments: Any) -> dict[str, Any]:
        try:
            if entry.worker not in self._workers:
                self._workers[entry.worker] = Worker(self.threads, self._file_limit, entry.python, self._path)
            answer = self._workers[entry.worker].ask(op, timeout, method=entry.name, **arguments)
        except WorkerDied as error:
            self._discard(entry.worker)
            raise type(error)(f"while {DOING[op]}: {error}") from None
        if "error" in answer:
            raise MethodFailed(f"while {DOING[op]}: {plain(answer['error'])}{self._workers[entry.worker].last_words()}")
        return answer

    def _last_words(self, entry: Entry) -> str:
        """What a renderer said before it failed, if anything."""
        return self._workers[entry.worker].last_words() if entry.worker in self._workers else ""

    def _thin_out(self, entry: Entry) -> None:
        """Replace a worker that leaves processes behind before they are too many."""
        if entry.worker in self._workers and self._workers[entry.worker].crowded:
            self._discard(entry.worker)

    def _discard(self, family: str) -> None:
        if family in self._workers:
            self._workers.pop(family).close()
        for name in self._opened.pop(family, {}):
            self._prepared.pop(name, None)


def read_film(path: Path, scene: Scene) -> dict[str, np.ndarray]:
    """The channels of a film, (n,) each. Raises FilmError where it is no film of `scene`, or not finite, or negative; only what
    triangles change, what one sample can add and what a method proves may be infinite: not known, and not bounded."""
    grid, channels, header = films.read(path)
    if header.get("digest") != scene.digest:
        raise FilmError(f"the film's header names another scene (digest {header.get('digest')});"
                        f" it must be {scene.digest} ({path})")
    if grid != scene.film.grid:
        raise FilmError(f"the film has {grid} rows and columns; it must have {scene.film.grid} ({path})")
    for name, values in channels.items():
        wrong = np.flatnonzero(~((values >= 0) & (np.isfinite(values) | (name in UNBOUNDED))))
        if wrong.size:
            first = f"the first {values[wrong[0]]:g} in element {wrong[0]}"
            raise FilmError(f"{wrong.size} of {values.size} values of {name} are no light, {first};"
                            f" every value must be finite and zero or more ({path})")
    return channels
