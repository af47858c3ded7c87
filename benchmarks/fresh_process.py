"""A process that starts from nothing: seconds after `import numba` until each kernel has run once, and what was compiled.

    python benchmarks/fresh_process.py square-light=mc-area occluded-square=mc-area
"""

# ruff: noqa: E402, I001, F401
import numba
import time

START = time.perf_counter()  # the clock starts when numba is there

import gc
import importlib
import json
import sys

from numba.core import event
from numba.core.caching import NullCache
from numba.core.dispatcher import Dispatcher


class Compilations(event.Listener):
    """Counts what numba compiles."""

    def __init__(self) -> None:
        self.count = 0

    def on_start(self, event: event.Event) -> None:
        self.count += 1

    def on_end(self, event: event.Event) -> None:
        pass


def main() -> None:
    compilations = Compilations()
    event.register("numba:compile", compilations)
    taken: list[dict] = []
    for pair in sys.argv[1:]:
        scene, method = pair.split("=")
        seconds = first_film(scene, method, start=None if taken else START)
        taken.append({"seconds": seconds, "compiled": compilations.count, **asked()})
    print(json.dumps([differences(*pair) for pair in zip([dict.fromkeys(taken[0], 0), *taken], taken, strict=False)]))


def first_film(scene_name: str, method_name: str, start: float | None) -> float:
    """Seconds of a first film of a scene by a method, which needs every kernel of it once; from `start`, or without reading the
    scene."""
    from lightproof import suite
    from lightproof.renderers.registry import METHODS

    scene = suite.default().scene(scene_name)
    start = time.perf_counter() if start is None else start
    module, name = METHODS[method_name].target.split(":")
    getattr(importlib.import_module(module), name)(method_name, threads=1).prepare(scene)
    return time.perf_counter() - start


def differences(before: dict, now: dict) -> dict:
    """What came on top of the counts before."""
    return {name: number if name == "seconds" else number - before[name] for name, number in now.items()}


def asked() -> dict[str, int]:
    """How many kernels the cache on disk had, and how many not, over all that are kept there."""
    kept = [one.stats for one in gc.get_objects() if isinstance(one, Dispatcher) and not isinstance(one._cache, NullCache)]
    return {"hits": sum(sum(stats.cache_hits.values()) for stats in kept),
            "misses": sum(sum(stats.cache_misses.values()) for stats in kept)}


if __name__ == "__main__":
    main()
