"""What the in-house estimators share: phases timed, elements spread over threads."""

from __future__ import annotations

import time
from abc import abstractmethod
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from importlib.metadata import version
from itertools import pairwise
from typing import ClassVar

import numpy as np

from lightproof.estimators.limits import extreme
from lightproof.estimators.moments import variance_of_mean
from lightproof.method import Method
from lightproof.scene import Scene

TASKS = 64  # pieces of work for one film, at most: fixed, so that the number of threads changes nothing
TRACED = 2**12  # samples that follow rays: a task of them takes longer than to hand it to a thread


class Estimator(Method):
    """A method of ours: `limits` say what it cannot do, `lengths` [m] between which the largest of a scene has to be; `build`
    takes a scene, `warm_up` runs every kernel once."""

    precision: ClassVar[str] = "float64"
    lengths: ClassVar[tuple[float, float]] = (1e-9, 1e9)  # as float32 allows
    limits: ClassVar[tuple[Callable[[Scene], str | None], ...]] = ()

    def version(self) -> str:
        return version("lightproof")

    def unsupported(self, scene: Scene) -> str | None:
        return extreme(scene, *self.lengths) or next((reason for limit in self.limits if (reason := limit(scene))), None)

    def prepare(self, scene: Scene) -> Mapping[str, float]:
        start = time.perf_counter()
        self.size = scene.size
        self.build(scene)
        built = time.perf_counter()
        self.warm_up()
        return {"setup": built - start, "compile": time.perf_counter() - built}

    @abstractmethod
    def build(self, scene: Scene) -> None:
        """Turn the scene into what the kernels take."""

    @abstractmethod
    def warm_up(self) -> None:
        """Run every kernel that this scene needs once, as little as it can do."""


def sampled(add: Callable, size: int, samples: int, threads: int) -> tuple[np.ndarray, int, np.ndarray | None]:
    """Film, samples and variance of a kernel that follows rays and adds up values and their squares."""
    sums = spread(add, size, samples, 2, threads, tasks(size * samples, TRACED))
    return sums[:, 0] / samples, samples, variance_of_mean(*sums.T, samples) if samples > 1 else None


def tasks(samples: int, worthwhile: int) -> int:
    """Into how many pieces so many samples of all elements are cut, each of which is `worthwhile` or so."""
    return min(max(1, samples // worthwhile), TASKS)


def spread(add: Callable, size: int, steps: int, columns: int, threads: int, most: int = TASKS) -> np.ndarray:
    """Runs `add(first, last, (begin, end), out)` over all elements and steps, cut into `most` pieces or so; the sums (size,
    columns) do not depend on `threads`."""
    tiles, spans = cuts(size, most), cuts(steps, most // size)
    sums = np.zeros((len(spans), size, columns))
    if len(tiles) == len(spans) == 1:
        add(0, size, spans[0], sums[0])
        return sums[0]
    pieces = [(part, tile) for part in range(len(spans)) for tile in tiles]
    waiting = iter(pieces)

    def work() -> None:
        for part, (first, last) in waiting:
            add(first, last, spans[part], sums[part, first:last])

    helpers = [workers(threads).submit(work) for _ in range(min(threads, len(pieces)) - 1)]
    work()
    for helper in helpers:
        helper.result()
    return sums.sum(axis=0)


@cache
def cuts(count: int, pieces: int) -> list[tuple[int, int]]:
    """0 to `count` in so many pieces of about one size, none empty: first and last + 1 of each."""
    pieces = max(1, min(count, pieces))
    return list(pairwise(count * k // pieces for k in range(pieces + 1)))


@cache
def workers(threads: int) -> ThreadPoolExecutor:
    """Threads that help the one that asks, and stay: starting them would take longer than a small film."""
    return ThreadPoolExecutor(threads - 1)
