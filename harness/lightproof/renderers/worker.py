"""The child process in which methods live: answers JSON lines over two inherited pipes.

Each request names an operation of `Host` and its arguments; each answer is a table, with `error` where a method raised.
A worker sees scenes and never a reference. It dies with the harness, and it leaves through `os._exit`, because some
renderers crash while they are torn down.
"""

from __future__ import annotations

import contextlib
import ctypes
import errno
import importlib
import importlib.util
import json
import os
import resource
import signal
import sys
import time
import traceback
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from lightproof import films, radiometry, scene_file
from lightproof.method import Method, Rendering, Unavailable
from lightproof.renderers.function import as_method
from lightproof.scene import Scene

PR_SET_PDEATHSIG = 1
PR_SET_CHILD_SUBREAPER = 36


def load(target: str) -> Any:
    """The class or function that `module:name` or `path/to/file.py:name` names. Raises ImportError, AttributeError,
    OSError, and what the file itself raises."""
    where, _, name = target.rpartition(":")
    if where.endswith(".toml"):
        return getattr(importlib.import_module("lightproof.renderers.outside"), name).at(Path(where))
    if not where.endswith(".py"):
        return getattr(importlib.import_module(where), name)
    return getattr(sys.modules.get(where) or _execute(where), name)


def _execute(path: str) -> ModuleType:
    """The module that a file makes. It is known by its path, so that it shadows nothing; it finds the files beside it."""
    spec = importlib.util.spec_from_file_location(path, path)
    module = importlib.util.module_from_spec(spec)
    sys.path.append(str(Path(path).parent))
    sys.modules[path] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[path]
        raise
    return module


class Host:
    """The methods of this process and the scene that each has prepared."""

    def __init__(self) -> None:
        self._methods: dict[str, Method] = {}
        self._scenes: dict[str, Scene] = {}
        self._tessellations: dict[str, np.ndarray | None] = {}

    def open(self, method: str, target: str, threads: int) -> dict[str, Any]:
        """What a method says about itself, or why it is unavailable."""
        opened = as_method(load(target), method, threads)
        try:
            opened.open()
        except Unavailable as missing:
            return {"unavailable": str(missing)}
        self._methods[method] = opened
        return {
            "version": str(opened.version()),
            "deterministic": bool(opened.deterministic),
            "samples_lights": bool(opened.samples_lights),
        }

    def prepare(self, method: str, scene_id: str, case: str, table: dict[str, Any]) -> dict[str, Any]:
        """What there is to say of a prepared scene, or why it is unsupported."""
        asked, opened = scene_file.from_table(table, scene_id, case), self._methods[method]
        scene = asked.tangible
        reason = opened.unsupported(scene)
        if reason is not None:
            return {"unsupported": reason}
        start = time.perf_counter()
        named = opened.prepare(scene)
        seconds = phases(named, time.perf_counter() - start, rest="setup")
        self._scenes[method], self._tessellations[method] = asked, opened.tessellation(scene)
        return {"seconds": seconds, "settings": dict(opened.settings()), "precision": str(opened.precision),
                "caveat": str(opened.caveat(scene))}

    def render(self, method: str, samples: int, seed: int, film: str) -> dict[str, Any]:
        """One film of the prepared scene, written to the path `film`, or why it is unsupported after all."""
        opened, scene = self._methods[method], self._scenes[method]
        forget_peak_memory()
        start = time.perf_counter()
        try:
            rendering = opened.render(samples, seed)
        except NotImplementedError as reason:
            return {"unsupported": str(reason) or f"{method} does not implement it"}
        seconds = phases(rendering.seconds, time.perf_counter() - start, rest="render")
        header = {"method": method, "method_version": opened.version(), "samples": str(rendering.samples), "seed": str(seed)}
        given = channels(rendering, scene.size, self._tessellations[method])
        films.write(Path(film), scene.film.grid, given, {**about(scene), **header})
        return {"samples": int(rendering.samples), "seconds": seconds, "peak_memory_mb": peak_memory_mb()}


def phases(named: Mapping[str, float], elapsed: float, rest: str) -> dict[str, float]:
    """Seconds by phase: those that the method names, which cannot be more than the clock says, and the rest of that."""
    others = {phase: min(max(0.0, float(seconds)), elapsed) for phase, seconds in (named or {}).items() if phase != rest}
    return {**others, rest: max(0.0, elapsed - sum(others.values()))}


def channels(rendering: Rendering, size: int, tessellation: np.ndarray | None = None) -> dict[str, np.ndarray]:
    """The arrays of a rendering, (n,) each. Raises FilmError where one is misshapen."""
    if not rendering.samples >= 1:
        raise films.FilmError(f"the film has {rendering.samples!r:.40} samples; it must be those spent per element, 1 or more")
    given = {"Y": rendering.film, "variance": rendering.variance, "tessellation": tessellation, "peak": rendering.peak,
             "bound": rendering.bound}
    if np.any(rendering.quantization):
        given["quantization"] = np.broadcast_to(rendering.quantization, (size,))
    for name, values in given.items():
        if values is not None and np.shape(values) != (size,):
            raise films.FilmError(f"the film's {name} has shape {np.shape(values)}; it must be ({size},), row by row")
    return {name: np.asarray(values, float) for name, values in given.items() if values is not None}


def about(scene: Scene) -> dict[str, str]:
    """What a film's header says of its scene."""
    quantity = radiometry.QUANTITIES[scene.film.quantity]
    return {"scene": scene.id, "case": scene.case, "digest": scene.digest, "quantity": quantity.name, "unit": quantity.unit}


def forget_peak_memory() -> None:
    """Start the peak anew, where the kernel lets us: a worker renders many scenes."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def peak_memory_mb() -> float:
    """Largest resident memory since `forget_peak_memory` [MB]."""
    with contextlib.suppress(OSError, StopIteration, ValueError):
        lines = Path("/proc/self/status").read_text().splitlines()
        return int(next(line for line in lines if line.startswith("VmHWM")).split()[1]) * 1024 / 1e6
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 1e6 if sys.platform == "darwin" else peak * 1024 / 1e6


def answer(host: Host, request: dict[str, Any]) -> dict[str, Any]:
    """What one request comes to; whatever a method raises is an answer too."""
    try:
        return getattr(host, request.pop("op"))(**request)
    except Exception as error:
        return {"error": f"{type(error).__name__}: {error}{_limit(error)}{_place(error)}"}


def _limit(error: Exception) -> str:
    """What was too large, where a file or the output was."""
    most = resource.getrlimit(resource.RLIMIT_FSIZE)[0]
    return f": no file and no output may have more than {most:,} bytes" if getattr(error, "errno", 0) == errno.EFBIG else ""


def _place(error: Exception) -> str:
    """The last line of a file named on the command line that an error went through."""
    lines = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename in sys.modules]
    return f" ({Path(lines[-1].filename).name}, line {lines[-1].lineno})" if lines else ""


def die_with(parent: int) -> None:
    """Have the kernel kill this process when its parent dies, however it dies."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(1)


def adopt_orphans() -> None:
    """Have the kernel leave to this process what its children leave behind, so that the harness sees it."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)


def main(requests_fd: int, answers_fd: int, parent: int, file_limit: int) -> None:
    """Answer until the pipe closes."""
    die_with(parent)
    adopt_orphans()
    resource.setrlimit(resource.RLIMIT_FSIZE, (file_limit, file_limit))
    for fd in (requests_fd, answers_fd):
        os.set_inheritable(fd, False)
    host = Host()
    with os.fdopen(requests_fd) as requests, os.fdopen(answers_fd, "w") as answers:
        for line in requests:
            request = json.loads(line)
            answers.write(json.dumps({"id": request.pop("id"), **answer(host, request)}, default=str) + "\n")
            answers.flush()
        os._exit(0)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
