"""Radiance's programs: oconv, and an rtrace that stays up and answers rays."""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

BLOCK = 2048  # rays at a time: their answers fit into a pipe, so that neither side waits for the other for ever


class RadianceFailed(Exception):
    """A program of Radiance ended; what it said is in the worker's log."""


class Programs:
    """The programs in `folder`/bin, which find their own files in `folder`/lib and a scene's beside it."""

    def __init__(self, folder: Path, scenes: Path):
        self.bin = folder / "bin"
        self.environment = {**os.environ, "RAYPATH": f"{scenes}:{folder / 'lib'}"}

    def output(self, program: str, *arguments: str | Path) -> bytes:
        """What a program prints. Raises RadianceFailed."""
        done = subprocess.run([self.bin / program, *arguments], stdout=subprocess.PIPE, env=self.environment, check=False)
        if done.returncode:
            raise RadianceFailed(f"{program} ended with status {done.returncode}")
        return done.stdout

    def rtrace(self, options: Sequence[str], octree: Path) -> Rtrace:
        """A running rtrace."""
        return Rtrace([str(self.bin / "rtrace"), "-h-", "-fdd", *options, str(octree)], self.environment)


class Rtrace:
    """One rtrace process, which draws its random numbers from one stream from ray to ray. It starts the stream anew from the
    clock's second, so no two processes are started in the same one."""

    second = 0

    def __init__(self, command: Sequence[str], environment: dict[str, str]):
        while int(time.time()) <= Rtrace.second:
            time.sleep(0.01)
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment)
        self.trace(np.eye(6)[-1:])  # any ray: when it is answered, the stream of random numbers has begun
        Rtrace.second = int(time.time())

    def trace(self, rays: np.ndarray) -> np.ndarray:
        """The first channel of what arrives along rays (n, 6), as (n,). Raises RadianceFailed."""
        return np.concatenate([self._answer(rays[i : i + BLOCK]) for i in range(0, len(rays), BLOCK)])

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.communicate()

    def _answer(self, rays: np.ndarray) -> np.ndarray:
        flush = np.zeros((1, 6))  # a ray without direction has rtrace write what it holds back
        try:
            self._process.stdin.write(np.vstack([rays, flush]).tobytes())
            self._process.stdin.flush()
        except BrokenPipeError:
            pass
        values = np.frombuffer(self._process.stdout.read(24 * (len(rays) + 1)))
        if len(values) < 3 * (len(rays) + 1):
            raise RadianceFailed(f"rtrace ended with status {self._process.wait()}")
        return values.reshape(-1, 3)[:-1, 0]
