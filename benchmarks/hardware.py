"""How near `mc-area` without blockers is to what the cores can do, and what eats the rest.

The arithmetic of a sample is counted in the compiled loop, and its rate set against the multiply-adds that the same cores do in
the same rounds. The loop is then measured with parts of it left out.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numba import njit

import multiply_adds
import operations
from lightproof import suite
from lightproof.estimators.compiled import FAST
from lightproof.estimators.estimator import TASKS
from lightproof.estimators.kernel import estimate
from lightproof.estimators.mc_area import McArea
from lightproof.estimators.points import BLOCK, Random
from operations import Operations
from race import Track
from rows import Estimate, Row
from variants import VARIANTS, compiled

NAME = "hardware"
SCENE = "square-light"
SAMPLES = 2**19  # per element of the scene's film
PEAK, METHOD = "multiply-add peak", "mc-area"

Add = Callable[[Iterable[Row]], None]
Rate = Callable[[], float]


def measure(track: Track, add: Add, rounds: int, quick: bool) -> None:
    """Operations of a sample, then rates of the peak, of the method and of the loop's variants in turn."""
    samples = SAMPLES // 64 if quick else SAMPLES
    method = McArea("mc-area", track.threads)
    scene = suite.default().scene(SCENE)
    method.prepare(scene)
    add(counted(operations.count(assembly())))
    rates = {PEAK: peak(track.threads, quick), METHOD: film(method, samples)}
    rates |= {name: loop(method, compiled(*parts), track.threads, samples) for name, parts in VARIANTS.items()}
    each: dict[str, list[float]] = {name: [] for name in rates}
    for rate in rates.values():
        rate()
    try:
        for _ in range(rounds):
            for name, rate in rates.items():
                each[name].append(rate())
    finally:
        add(Row(NAME, SCENE, name, "threads", track.threads, "render", "operations/s" if name == PEAK else "samples/s",
                tuple(found)) for name, found in each.items())


def assembly() -> str:
    """Of the kernel as `mc-area` has it on the scene; compiled anew, for what comes from the cache cannot be looked at."""
    anew = njit(nogil=True, fastmath=FAST, error_model="numpy")(estimate.py_func)
    anew.compile(estimate.signatures[-1])
    return next(iter(anew.inspect_asm().values()))


def counted(found: Operations | None) -> list[Row]:
    """What a sample does, and whether the peak is one of packed multiply-adds."""
    peak = operations.packed_multiply_adds(multiply_adds.assembly())
    rows = [_count(PEAK, "packed multiply-adds in the loop", peak),
            _count(METHOD, "floating-point, by hand", operations.BY_HAND)]
    if found is None:
        return [*rows, Row(NAME, SCENE, METHOD, "", 0, "operations", "", note="the count knows only x86 with AVX2 or AVX-512")]
    return [*rows, *(_count(METHOD, name, number) for name, number in {
        "floating-point": found.floating,
        "of whole numbers": found.whole,
        "conversions": found.conversions,
        "vector instructions": found.instructions,
        "packed multiply-adds in the loop": found.packed_multiply_adds,
        "lanes": found.lanes,
    }.items())]


def _count(method: str, what: str, number: float) -> Row:
    return Row(NAME, SCENE, method, what, 0, "operations", "1", estimate=Estimate(number))


def peak(threads: int, quick: bool) -> Rate:
    """Floating-point operations a second of multiply-adds on all threads."""
    rounds = 2**12 if quick else 2**17

    def chains(_: int) -> None:
        multiply_adds.multiply_add(*multiply_adds.arguments(rounds))

    return timed(chains, range(threads), threads, threads * multiply_adds.operations(rounds))


def film(method: McArea, samples: int) -> Rate:
    """Samples a second of a whole film."""
    return timed(lambda seed: method.render(samples, seed), [1], 1, samples * method.size)


def loop(method: McArea, run: Callable, threads: int, samples: int) -> Rate:
    """Samples a second of a variant of the loop, elements spread over threads."""
    lamp, blocks = method.pieces[0].source, max(1, samples // BLOCK)

    def part(receivers: np.ndarray) -> None:
        run(lamp, receivers, Random(blocks * BLOCK, 1), blocks, np.float32(1))

    pieces = min(TASKS, method.size)
    return timed(part, np.array_split(method.receivers, pieces), threads, blocks * BLOCK * method.size)


def timed(work: Callable, pieces: Iterable, threads: int, amount: float) -> Rate:
    """A function that does all pieces of work on threads and says how much of it was done in a second."""
    pool = ThreadPoolExecutor(threads)

    def rate() -> float:
        start = time.perf_counter()
        list(pool.map(work, pieces))
        return amount / (time.perf_counter() - start)

    return rate
