"""A renderer that misbehaves in the way its option names: misbehaving.py:Misbehaving/segfault. Without an option it is honest.

It knows the exact light of scenes/point-light.toml, and adds noise to it unless told otherwise.
"""

from __future__ import annotations

import ctypes
import fcntl
import json
import os
import signal
import stat
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from lightproof import films
from lightproof.method import Method, Rendering, Unavailable
from lightproof.scene import PointLight, Scene


def light(scene: Scene) -> np.ndarray:
    """Irradiance (n,) at the centre of each cell under the scene's point light: I cos / r2 [W/m2]."""
    (lamp,), film = scene.lights, scene.film
    rows, columns = film.grid
    row, column = np.divmod(np.arange(scene.size), columns)
    u, v = (column[:, None] + 0.5) / columns, (row[:, None] + 0.5) / rows
    towards = np.array(lamp.position) - (np.array(film.origin) + u * np.array(film.u) + v * np.array(film.v))
    return lamp.intensity * np.maximum(towards @ film.normal, 0) / np.linalg.norm(towards, axis=1) ** 3


class Misbehaving(Method):
    """Honest light with relative noise of 1 / sqrt(samples), then the fault."""

    def open(self) -> None:
        self.fault = self.name.partition("/")[2]
        self.renders = 0
        if self.fault == "not-installed":
            raise Unavailable("pip install 'lightproof[misbehaving]'")
        if self.fault == "exits-at-once":
            os._exit(7)
        if self.fault == "hangs-before":
            _hangs(self, None)
        if self.fault == "starts-slowly":
            time.sleep(1)
        if self.fault == "ignores-sigterm":
            signal.signal(signal.SIGTERM, signal.SIG_IGN)

    def version(self) -> str:
        return "1.0"

    def unsupported(self, scene: Scene) -> str | None:
        return None if isinstance(scene.lights[0], PointLight) else "misbehaving has point lights only"

    def prepare(self, scene: Scene) -> dict[str, float]:
        if self.fault == "raises-while-preparing":
            raise RuntimeError("the scene is too beautiful")
        self.scene = scene
        return {}

    def render(self, samples: int, seed: int) -> Rendering:
        self.renders += 1
        noise = np.random.default_rng(0 if self.fault == "ignores-seed" else seed).normal(size=self.scene.size)
        film = light(self.scene) * (1 + noise / np.sqrt(samples))
        film = FAULTS.get(self.fault, lambda method, film: film)(self, film)
        return Rendering(film=film, samples=-samples if self.fault == "counts-backwards" else samples)


def _raises(method: Misbehaving, film: np.ndarray) -> None:
    raise RuntimeError("out of photons\n\x1b[2J(really)")


def _exits(method: Misbehaving, film: np.ndarray) -> None:
    print("the licence has expired")
    os._exit(9)


def _calls_exit(method: Misbehaving, film: np.ndarray) -> None:
    sys.exit(5)


def _segfaults(method: Misbehaving, film: np.ndarray) -> None:
    ctypes.string_at(0)


def _sends_itself(number: signal.Signals) -> Callable:
    def send(method: Misbehaving, film: np.ndarray) -> None:
        print("the end is near")
        os.kill(os.getpid(), number)

    return send


def _crashes_once(method: Misbehaving, film: np.ndarray) -> np.ndarray:
    flag = Path(os.environ["MISBEHAVING_FLAG"])
    if not flag.exists():
        flag.touch()
        _segfaults(method, film)
    return film


def _hangs(method: Misbehaving, film: np.ndarray) -> None:
    print("thinking about it")
    time.sleep(3600)


def _floods(method: Misbehaving, film: np.ndarray) -> None:
    while True:
        for stream in (sys.stdout, sys.stderr):
            print("light " * 10_000, file=stream)


def _chatters(method: Misbehaving, film: np.ndarray) -> np.ndarray:
    print("light " * 100_000)
    return film


def _fills_the_disk(method: Misbehaving, film: np.ndarray) -> None:
    print("saving every path")
    with tempfile.TemporaryFile() as scratch:
        while True:
            scratch.write(bytes(1 << 16))


def _closes_pipe(method: Misbehaving, film: np.ndarray) -> None:
    os.closerange(3, 256)
    time.sleep(3600)


def _answers(line: bytes) -> None:
    for fd in filter(_is_pipe_to_write, range(3, 64)):
        os.write(fd, line)


def _speaks_nonsense(method: Misbehaving, film: np.ndarray) -> np.ndarray:
    _answers(b"100% done\n")
    return film


def _answers_late(method: Misbehaving, film: np.ndarray) -> np.ndarray:
    _answers(b'{"id": 1, "error": "out of photons"}\n')
    return film


def _drones_on(method: Misbehaving, film: np.ndarray) -> None:
    while True:
        _answers(b"light " * 100)


def _is_pipe_to_write(fd: int) -> bool:
    try:
        return stat.S_ISFIFO(os.fstat(fd).st_mode) and fcntl.fcntl(fd, fcntl.F_GETFL) & os.O_ACCMODE == os.O_WRONLY
    except OSError:
        return False


def _is_slow(method: Misbehaving, film: np.ndarray) -> np.ndarray:
    time.sleep(0.02)
    return film


def _child(method: Misbehaving, film: np.ndarray) -> np.ndarray:
    subprocess.Popen(["sleep", "3600"], start_new_session=True)
    return film


def _writes(change: Callable) -> Callable:
    """What `change(write, path, grid, channels, header)` makes of the next film that is written."""

    def patched(method: Misbehaving, film: np.ndarray) -> np.ndarray:
        write = films.write

        def write_once(*arguments: object) -> None:
            films.write = write
            change(write, *arguments)

        films.write = write_once
        return film

    return patched


def _half_an_image(write: Callable, path: Path, *arguments: object) -> None:
    write(path, *arguments)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def _another_size(write: Callable, path: Path, grid: tuple, channels: dict, header: dict) -> None:
    write(path, (1, 2), {"Y": np.ones(2)}, header)


def _another_scene(write: Callable, path: Path, grid: tuple, channels: dict, header: dict) -> None:
    write(path, grid, channels, {**header, "digest": "\x1b[2J0123"})


def _hangs_after(write: Callable, *arguments: object) -> None:
    write(*arguments)
    _hangs(None, None)


def _answers_twice(write: Callable, *arguments: object) -> None:
    """The third request of a fresh worker answered, before the worker answers it."""
    write(*arguments)
    _answers(json.dumps({"id": 3, "samples": 64, "seconds": {}, "peak_memory_mb": 1.0}).encode() + b"\n")


def _set(element: int, value: float):
    def change(method: Misbehaving, film: np.ndarray) -> np.ndarray:
        film[element] = value
        return film

    return change


FAULTS = {
    "raises": _raises,
    "exits-mid-job": _exits,
    "calls-exit": _calls_exit,
    "segfaults": _segfaults,
    "killed": _sends_itself(signal.SIGKILL),
    "dies-of-an-odd-signal": _sends_itself(signal.SIGRTMIN + 1),
    "stops": _sends_itself(signal.SIGSTOP),
    "crashes-once": _crashes_once,
    "hangs": _hangs,
    "slow": _is_slow,
    "ignores-sigterm": _hangs,
    "floods": _floods,
    "chatters": _chatters,
    "fills-the-disk": _fills_the_disk,
    "closes-pipe": _closes_pipe,
    "speaks-nonsense": _speaks_nonsense,
    "drones-on": _drones_on,
    "answers-late": _answers_late,
    "answers-twice": _writes(_answers_twice),
    "hangs-after": _writes(_hangs_after),
    "leaves-a-child": _child,
    "writes-nothing": _writes(lambda *arguments: None),
    "writes-half-an-image": _writes(_half_an_image),
    "writes-another-size": _writes(_another_size),
    "writes-another-scene": _writes(_another_scene),
    "nan": _set(3, np.nan),
    "infinite": _set(4, np.inf),
    "negative": _set(5, -1.0),
    "misshapen": lambda method, film: film[:-1],
    "two-dimensional": lambda method, film: film.reshape(method.scene.film.grid),
    "identical": lambda method, film: light(method.scene),
}
