"""Radiance's programs: oconv, and an rtrace that stays up and answers rays."""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from lightproof.renderers.worker import die_with

LAG = 0.05  # s: more than the clock that rtrace reads is behind
FAR = 1e9  # m
BLOCK = 2048  # rays at a time: their answers fit into a pipe, so that neither side waits for the other for ever


class RadianceFailed(Exception):
    """A program of Radiance ended; the message holds what it said last."""


class Programs:
    """The programs in `folder`/bin, which find their own files in `folder`/lib and a scene's beside it."""

    def __init__(self, folder: Path, scenes: Path):
        self.bin = folder / "bin"
        self.environment = {**os.environ, "RAYPATH": f"{scenes}:{folder / 'lib'}"}
        self.said = scenes / "said.txt"

    def output(self, program: str, *arguments: str | Path, given: bytes = b"") -> bytes:
        """What a program prints. Raises RadianceFailed."""
        done = subprocess.run([self.bin / program, *arguments], input=given, capture_output=True, env=self.environment)
        if done.returncode:
            raise RadianceFailed(_ending(program, done.returncode, done.stderr))
        return done.stdout

    def rtraces(self, options: Sequence[str], octree: Path, most: int) -> Rtraces:
        """Running rtraces, `most` of them in the end."""
        command = [str(self.bin / "rtrace"), "-h-", "-fdd", *options, str(octree)]
        return Rtraces(lambda: Rtrace(command, self.environment, self.said), most, by_clock="-u+" in options)


class Rtraces:
    """Several rtrace processes that share the rays. With `by_clock` each starts its stream of random numbers from the clock's
    second, so no two may start in the same one: the first waits for a new second, the others join when one has come."""

    second = 0

    def __init__(self, start: Callable[[], Rtrace], most: int, by_clock: bool):
        self._start = start
        self._most = most
        self._by_clock = by_clock
        self._running: list[Rtrace] = []
        while by_clock and not self._new_second():
            time.sleep(0.01)
        self._join()

    def trace(self, rays: np.ndarray, skipped: Callable[[], int] = lambda: 0) -> np.ndarray:
        """The first channel of what arrives along rays (n, 6), as (n,); each process first skips `skipped()` rays. Raises
        RadianceFailed."""
        while len(self._running) < self._most and (not self._by_clock or self._new_second()):
            self._join()
        with ThreadPoolExecutor(len(self._running)) as threads:
            shares = np.array_split(rays, len(self._running))
            return np.concatenate([*threads.map(Rtrace.trace, self._running, shares, [skipped() for _ in shares])])

    def close(self) -> None:
        """End the processes."""
        for rtrace in self._running:
            rtrace.close()

    @staticmethod
    def _new_second() -> bool:
        return time.time() > Rtraces.second + 1 + LAG

    def _join(self) -> None:
        self._running.append(self._start())
        Rtraces.second = int(time.time())


class Rtrace:
    """One rtrace process, which draws its random numbers from one stream from ray to ray."""

    def __init__(self, command: Sequence[str], environment: dict[str, str], said: Path):
        self._said = said
        pipe, mother = subprocess.PIPE, os.getpid()
        with said.open("wb") as errors:
            self._process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=errors, env=environment,
                                             preexec_fn=lambda: die_with(mother))
        self._answer(np.eye(6)[-1:])  # any ray: when it is answered, the stream of random numbers has begun

    def trace(self, rays: np.ndarray, skipped: int = 0) -> np.ndarray:
        """As `Rtraces.trace`; what is skipped is a ray from far away into the void, which costs little."""
        away = rays[:1] + np.hstack([FAR * rays[:1, 3:], np.zeros((len(rays[:1]), 3))])
        rays = np.vstack([np.tile(away, (skipped, 1)), rays])
        return np.concatenate([self._answer(rays[i : i + BLOCK]) for i in range(0, max(len(rays), 1), BLOCK)])[skipped:]

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.communicate()

    def _answer(self, rays: np.ndarray) -> np.ndarray:
        if not len(rays):
            return np.zeros(0)
        flush = np.zeros((1, 6))  # a ray without direction has rtrace write what it holds back
        try:
            self._process.stdin.write(np.vstack([rays, flush]).tobytes())
            self._process.stdin.flush()
        except BrokenPipeError:
            pass
        values = np.frombuffer(self._process.stdout.read(24 * (len(rays) + 1)))
        if len(values) < 3 * (len(rays) + 1):
            raise RadianceFailed(_ending("rtrace", self._process.wait(), self._said.read_bytes()))
        return values.reshape(-1, 3)[:-1, 0]


def _ending(program: str, status: int, said: bytes) -> str:
    lines = said.decode(errors="replace").strip().splitlines() or ["nothing"]
    return f"{program} ended with status {status}; it said: {lines[-1]}"
