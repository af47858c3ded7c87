"""Numba, set up once for every kernel here: flags, registers, and a cache that notices an edit in any file of this folder.

Numba's own cache looks at the file of the kernel alone, so that an edit in a helper would leave a stale answer. Here the
cache folder is named by a hash of all sources and of the versions that compile them.
"""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import llvmlite
import numba
import numpy as np
from numba import njit
from numba.core.codegen import get_host_cpu_features

SOURCES = Path(__file__).parent
STRICT = {"contract", "nnan", "nsz"}  # leaves the order of operations alone: cancellations stay under control

FAST = {"contract", "reassoc", "nnan", "ninf", "nsz", "afn"}  # all but the reciprocals that stand for divisions: refining an
#                                                                estimate takes four slots of the multipliers, dividing three

strict = njit(fastmath=STRICT, error_model="numpy")
inlined = njit(fastmath=STRICT, error_model="numpy", forceinline=True)  # strict, and part of the loop that calls it
fast = njit(fastmath=FAST, error_model="numpy")
exact = njit(error_model="numpy")

INLINED = {"forceinline": True}  # of an overload: where the compiler sees fit to call it, a loop leaves the vector registers


def digest(folder: Path) -> str:
    """SHA-256 of every Python source in `folder` (names and bytes) and of the versions that compile them and their constants."""
    state = hashlib.sha256(repr((sys.version, numba.__version__, llvmlite.__version__, np.__version__)).encode())
    for path in sorted(folder.glob("*.py")):
        source = path.read_bytes()
        state.update(f"{path.name}:{len(source)}:".encode() + source)
    return state.hexdigest()


def cache_folder() -> Path | None:
    """Where compiled kernels are kept, kernels-<digest> in $XDG_CACHE_HOME/lightproof; None where it cannot be written."""
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    folder = base / "lightproof" / f"kernels-{digest(SOURCES)[:16]}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return None
    return folder


CACHE = cache_folder()


def wide(features: str) -> str:
    """A processor's features as LLVM names them, with registers of 512 bits used where there are any: on Intel's processors LLVM
    spares them, for the clock of the first that had them, and a loop takes a quarter more time."""
    return f"{features},-prefer-256-bit" if "+avx512f" in features.split(",") else features


if numba.config.CPU_FEATURES is None:  # what a user has asked of numba, it does
    numba.config.CPU_FEATURES = wide(get_host_cpu_features())


def kernel(fastmath: bool | set[str]) -> Callable[[Callable], Callable]:
    """Decorator for a function that threads call: compiled, cached, without the interpreter's lock."""

    def compile_lazily(function: Callable) -> Callable:
        before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(CACHE or "")
        try:
            return njit(cache=CACHE is not None, nogil=True, fastmath=fastmath, error_model="numpy")(function)
        finally:
            numba.config.CACHE_DIR = before

    return compile_lazily


fast_kernel = kernel(fastmath=FAST)
strict_kernel = kernel(fastmath=STRICT)
exact_kernel = kernel(fastmath=False)
