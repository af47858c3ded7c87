"""The cache of compiled kernels: how soon a fresh process that finds it warm has its first kernel, and each further one.

Each process runs `fresh_process.py`, which says how long each kernel took after `import numba` and what was compiled. It keeps
bytecode, as Python does if nobody forbids it: to compile the sources anew would be 40 % of the imports.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

from race import Track
from rows import Row

NAME = "cache"
PROGRAM = Path(__file__).parent / "fresh_process.py"
KERNELS = (
    ("square-light", "mc-area"), ("occluded-square", "mc-area"), ("picket-fence", "mc-area"), ("disk-light", "mc-area"),
    ("square-light", "mc-area/sobol"), ("square-light", "mc-area/jitter"), ("square-light", "mc-area/lattice"),
    ("square-light", "mc-cosine"), ("square-light", "mc-hemisphere"), ("square-light", "mc-mis"),
    ("sphere-light", "mc-solid-angle"), ("square-light", "mc-projected-solid-angle"),
    ("square-light", "riemann-area"), ("square-light", "riemann-hemisphere"), ("occluded-square", "cubature"),
    ("square-light", "analytic"), ("sphere-furnace", "path"), ("cube-room", "path"), ("sphere-furnace", "path/recursion"),
)  # of each kind one at least
LONGEST = 600.0  # s: a process that has to compile everything
FORBIDS = "PYTHONDONTWRITEBYTECODE"

Add = Callable[[Iterable[Row]], None]


def measure(track: Track, add: Add, rounds: int, quick: bool) -> None:
    """One process fills the cache, and is not counted; then one a round."""
    kernels = KERNELS[: 2 if quick else None]
    fresh(kernels)
    taken: list[list[dict]] = []
    try:
        for _ in range(rounds):
            taken.append(fresh(kernels))
    finally:
        add(row for place, (scene, method) in enumerate(kernels) for row in rows(scene, method, place, taken))


def rows(scene: str, method: str, place: int, taken: list[list[dict]]) -> list[Row]:
    """Of the kernel at a place in the order: seconds, kernels compiled, and what the cache was asked and had."""
    asked = {"seconds": "s", "compiled": "1", "hits": "1", "misses": "1"}
    return [Row(NAME, scene, method, "kernel", place + 1, "render" if name == "seconds" else name, unit,
                tuple(one[place][name] for one in taken)) for name, unit in asked.items()]


def fresh(kernels: Iterable[tuple[str, str]]) -> list[dict]:
    """What a fresh process says of each kernel in turn. Raises RuntimeError with its last words where it fails."""
    names = [f"{scene}={method}" for scene, method in kernels]
    done = subprocess.run([sys.executable, PROGRAM, *names], capture_output=True, text=True, timeout=LONGEST, env=environment())
    if done.returncode:
        raise RuntimeError(f"{PROGRAM.name}: {done.stderr.strip()[-500:]}")
    return json.loads(done.stdout)


def environment() -> dict[str, str]:
    """This process's, in which Python may keep bytecode."""
    return {name: value for name, value in os.environ.items() if name != FORBIDS}
