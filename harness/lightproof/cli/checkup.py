"""Is every stored reference still the scene's? Digests of all, and a random sample of values computed again."""

from __future__ import annotations

import random
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from dataclasses import dataclass

from lightproof import machine
from lightproof.certify import spot_check
from lightproof.references import Reference, ReferenceError
from lightproof.scene import Scene
from lightproof.suite import Suite

SECONDS = 12.0  # after which nothing more is computed


@dataclass(frozen=True)
class Checkup:
    """What is wrong with the references of `cases` (scene, case) pairs; an element of `sampled` of them was computed again."""

    complaints: tuple[str, ...]
    cases: int
    sampled: int
    seed: int

    @property
    def summary(self) -> str:
        """One line."""
        return (f"{self.cases} references fit their scenes, an element of {self.sampled} computed again (seed {self.seed}):"
                f" {len(self.complaints)} complaints")


def checkup(scenes: Iterable[tuple[Scene, Suite]], seed: int | None = None) -> Checkup:
    """Read every reference, then compute one random element of each again, in random order, for SECONDS at most."""
    seed = random.SystemRandom().randrange(2**31) if seed is None else seed
    stored, complaints = _read(scenes)
    tasks = _drawn(stored, random.Random(seed))
    found = list(_computed(tasks))
    return Checkup((*complaints, *filter(None, found)), len(stored) + len(complaints), len(found), seed)


def _read(scenes: Iterable[tuple[Scene, Suite]]) -> tuple[list[tuple[Scene, Reference]], list[str]]:
    stored, complaints = [], []
    for scene, home in scenes:
        try:
            stored.append((scene, home.reference(scene)))
        except ReferenceError as error:
            complaints.append(str(error))
    return stored, complaints


def _drawn(stored: list[tuple[Scene, Reference]], draw: random.Random) -> list[tuple[Scene, Reference, int]]:
    tasks = [(scene, reference, draw.randrange(scene.size)) for scene, reference in stored]
    draw.shuffle(tasks)
    return tasks


def _computed(tasks: list[tuple[Scene, Reference, int]]) -> Iterator[str]:
    """The finding of each task that was begun in time."""
    end = time.monotonic() + SECONDS
    cores = machine.usable_cores()
    with ProcessPoolExecutor(cores) as pool:
        waiting, running = iter(tasks), set()
        while True:
            while len(running) < cores and time.monotonic() < end and (task := next(waiting, None)):
                running.add(pool.submit(spot_check.difference, *task))
            if not running:
                return
            done, running = wait(running, return_when=FIRST_COMPLETED)
            yield from (future.result() for future in done)
