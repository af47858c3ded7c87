"""A renderer that misbehaves in the way its option names: misbehaving.py:Misbehaving/segfault. Without an option it is honest.

It knows the exact light of scenes/point-light.toml, and adds noise to it unless told otherwise.
"""

from __future__ import annotations

import fcntl
import os
import signal
import stat
import subprocess
import sys
import time
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
        return Rendering(film=film, samples=samples)


def _raises(method: Misbehaving, film: np.ndarray) -> None:
    raise RuntimeError("out of photons\n\x1b[2J(really)")


def _exits(method: Misbehaving, film: np.ndarray) -> None:
    print("the licence has expired")
    os._exit(9)


def _calls_exit(method: Misbehaving, film: np.ndarray) -> None:
    sys.exit(5)


def _segfaults(method: Misbehaving, film: np.ndarray) -> None:
    os.kill(os.getpid(), signal.SIGSEGV)


def _crashes_once(method: Misbehaving, film: np.ndarray) -> np.ndarray:
    flag = Path(os.environ["MISBEHAVING_FLAG"])
    if not flag.exists():
        flag.touch()
        _segfaults(method, film)
    return film


def _hangs(method: Misbehaving, film: np.ndarray) -> None:
    print("thinking about it")
    time.sleep(3600)


def _floods(method: Misbehaving, film: np.ndarray) -> np.ndarray:
    while True:
        print("light " * 10_000)


def _closes_pipe(method: Misbehaving, film: np.ndarray) -> None:
    os.closerange(3, 256)
    time.sleep(3600)


def _speaks_nonsense(method: Misbehaving, film: np.ndarray) -> np.ndarray:
    for fd in range(3, 64):
        try:
            os.write(fd, b"100% done\n")
        except OSError:
            continue
    return film


def _drones_on(method: Misbehaving, film: np.ndarray) -> None:
    while True:
        for fd in filter(_is_pipe_to_write, range(3, 64)):
            os.write(fd, b"light " * 100)


def _is_pipe_to_write(fd: int) -> bool:
    try:
        return stat.S_ISFIFO(os.fstat(fd).st_mode) and fcntl.fcntl(fd, fcntl.F_GETFL) & os.O_ACCMODE == os.O_WRONLY
    except OSError:
        return False


def _is_slow(method: Misbehaving, film: np.ndarray) -> np.ndarray:
    time.sleep(0.02)
    return film


def _child(method: Misbehaving, film: np.ndarray) -> np.ndarray:
    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(3600)"], start_new_session=True)
    Path(os.environ["MISBEHAVING_FLAG"]).write_text(str(child.pid))
    return film


def _half_an_image(method: Misbehaving, film: np.ndarray) -> np.ndarray:
    whole = films.write

    def write_half(path: Path, *arguments: object) -> None:
        whole(path, *arguments)
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
        films.write = whole

    films.write = write_half
    return film


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
    "crashes-once": _crashes_once,
    "hangs": _hangs,
    "slow": _is_slow,
    "ignores-sigterm": _hangs,
    "floods": _floods,
    "closes-pipe": _closes_pipe,
    "speaks-nonsense": _speaks_nonsense,
    "drones-on": _drones_on,
    "leaves-a-child": _child,
    "writes-half-an-image": _half_an_image,
    "nan": _set(3, np.nan),
    "infinite": _set(4, np.inf),
    "negative": _set(5, -1.0),
    "misshapen": lambda method, film: film[:-1],
    "two-dimensional": lambda method, film: film.reshape(method.scene.film.grid),
    "identical": lambda method, film: light(method.scene),
}
