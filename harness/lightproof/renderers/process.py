"""The parent's end of a worker: start it, ask it, and when it misbehaves say how and kill everything it started."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
import time
import uuid
from typing import Any

import psutil

MARK = "LIGHTPROOF_WORKER"
LARGEST_FILE = 1 << 29
POLL = 0.2
QUOTED_LINES = 3
LONGEST_LINE = 400


class WorkerDied(Exception):
    """The worker ended, hung or spoke nonsense in the middle of a request; the message says which, and its last words."""


class WorkerTimeout(WorkerDied):
    """The worker did not answer in time."""


def plain(text: str) -> str:
    """What somebody's renderer says, as one line of bearable length that no terminal obeys."""
    line = " ".join("".join(char if char.isprintable() else " " for char in text).split())
    return line if len(line) <= LONGEST_LINE else f"{line[:LONGEST_LINE]}..."


class Worker:
    """One child process that answers one request at a time.

    Start it from a thread that lasts: the kernel kills it when that thread ends. What it prints goes to a file that is
    emptied before each request and cannot grow beyond `file_limit` [bytes], as no file of the worker's can.
    """

    def __init__(self, threads: int, file_limit: int = LARGEST_FILE):
        self._mark = uuid.uuid4().hex
        self._log = tempfile.TemporaryFile("ab+")  # noqa: SIM115 - lives as long as the worker
        self._buffer = b""
        requests, self._requests = os.pipe()
        self._answers, answers = os.pipe()
        command = [sys.executable, "-u", "-m", "lightproof.renderers.worker"]
        numbers = (requests, answers, os.getpid(), file_limit)
        self._process = subprocess.Popen(
            [*command, *map(str, numbers)],
            pass_fds=(requests, answers),
            stdin=subprocess.DEVNULL,
            stdout=self._log,
            stderr=self._log,
            start_new_session=True,
            env={**os.environ, "OMP_NUM_THREADS": str(threads), MARK: self._mark},
        )
        os.close(requests)
        os.close(answers)

    def ask(self, op: str, timeout: float, **arguments: Any) -> dict[str, Any]:
        """The answer to one request within `timeout` [s]. Raises WorkerDied; the worker is closed then."""
        self._log.truncate(0)
        try:
            with contextlib.suppress(BrokenPipeError):
                os.write(self._requests, json.dumps({"op": op, **arguments}).encode() + b"\n")
            return self._answer(timeout)
        except WorkerDied:
            self.close()
            raise

    def _answer(self, timeout: float) -> dict[str, Any]:
        deadline = time.monotonic() + timeout
        while b"\n" not in self._buffer:
            left = deadline - time.monotonic()
            if left < 0:
                raise WorkerTimeout(f"no answer within {timeout:.3g} s{self._last_words()}")
            if select.select([self._answers], [], [], min(POLL, left))[0]:
                self._read()
            elif self._process.poll() is not None:
                raise WorkerDied(f"{self._ending()}{self._last_words()}")
        line, _, self._buffer = self._buffer.partition(b"\n")
        try:
            return json.loads(line)
        except ValueError:
            raise WorkerDied(f"it wrote {line[:80]!r} into the harness's pipe, which is no answer") from None

    def _read(self) -> None:
        chunk = os.read(self._answers, 1 << 16)
        if not chunk:
            raise WorkerDied(f"{self._ending()}{self._last_words()}")
        self._buffer += chunk

    def _ending(self) -> str:
        try:
            status = self._process.wait(timeout=1)
        except subprocess.TimeoutExpired:
            return "its process closed the harness's pipe"
        if status < 0:
            return f"its process was killed by {signal.Signals(-status).name}"
        return f"its process exited with status {status} before it answered"

    def _last_words(self) -> str:
        size = os.fstat(self._log.fileno()).st_size
        tail = os.pread(self._log.fileno(), 4096, max(0, size - 4096)).decode(errors="replace")
        lines = [plain(line) for line in tail.splitlines() if line.strip()]
        return f"; it last wrote: {' | '.join(lines[-QUOTED_LINES:])}" if lines else "; it wrote nothing"

    def close(self) -> None:
        """Kill the worker, its process group, and whatever of its descendants left the group. May be called twice."""
        if self._log.closed:
            return
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        for process in psutil.process_iter():
            with contextlib.suppress(psutil.Error):
                if process.environ().get(MARK) == self._mark:
                    process.kill()
        os.close(self._requests)
        os.close(self._answers)
        self._log.close()
