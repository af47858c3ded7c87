"""The parent's end of a worker: start it, ask it, and when it misbehaves say how and kill everything it started."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
import time
import uuid
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import psutil

from lightproof.checked import plain
from lightproof.renderers import scratch

BOOTSTRAP = Path(__file__).with_name("bootstrap.py")
MARK = "LIGHTPROOF_WORKER"
LARGEST_FILE = 1 << 29
LONGEST_ANSWER = 1 << 20
CHILDREN_PER_THREAD = 4
POLL = 0.2
QUOTED_LINES = 3
SILENCE = "; it wrote nothing"


class WorkerDied(Exception):
    """The worker ended, hung or spoke nonsense in the middle of a request; the message says which, and its last words."""


class WorkerTimeout(WorkerDied):
    """The worker did not answer in time."""


def ending(status: int) -> str:
    """How a process ended, by the status that `subprocess` gives."""
    if status >= 0:
        return f"exited with status {status}"
    names = {number.value: number.name for number in signal.Signals}
    killer = names.get(-status, f"signal {-status}")
    return f"was killed by {killer}{' (out of memory?)' if killer == 'SIGKILL' else ''}"


class Worker:
    """One child process that answers one request at a time.

    Start it from a thread that lasts: the kernel kills it when that thread ends. What it prints goes to a file that is
    emptied before each request and cannot grow beyond `file_limit` [bytes], as no file of the worker's can. It runs under the
    interpreter `python` (a path), by default the harness's own, and imports from the folders of `path` first; raises WorkerDied
    where there is no such interpreter. Its temporary files are in folders of its own, which go when it ends, however it does.
    """

    def __init__(self, threads: int, file_limit: int = LARGEST_FILE, python: str = "", path: Sequence[str] = ()):
        self._mark = uuid.uuid4().hex
        self._log = tempfile.TemporaryFile()  # noqa: SIM115 - lives as long as the worker
        fcntl.fcntl(self._log, fcntl.F_SETFL, os.O_APPEND)  # else the worker would write on where it was before it was emptied
        self._folders = [scratch.Folder(place) for place in scratch.places()]
        self._buffer = b""
        self._asked = 0
        self._most_children = CHILDREN_PER_THREAD * (threads + 4)
        requests, self._requests = os.pipe()
        self._answers, answers = os.pipe()
        command = [python or sys.executable, "-u", str(BOOTSTRAP)]
        numbers = (requests, answers, os.getpid(), file_limit)
        disk, memory = (str(folder.path) for folder in self._folders)
        variables = {"OMP_NUM_THREADS": str(threads), "TMPDIR": disk, scratch.VARIABLE: memory, MARK: self._mark}
        imports = {"PYTHONPATH": os.pathsep.join(path)} if path else {}
        try:
            self._process = subprocess.Popen(
                [*command, *map(str, numbers)],
                pass_fds=(requests, answers),
                stdin=subprocess.DEVNULL,
                stdout=self._log,
                stderr=self._log,
                start_new_session=True,
                env={**os.environ, **imports, **variables},
            )
        except OSError as error:
            self._release()
            raise WorkerDied(f"{python} cannot be run ({error.strerror}); give the path of a Python interpreter") from None
        finally:
            os.close(requests)
            os.close(answers)
        os.set_blocking(self._requests, False)

    def ask(self, op: str, timeout: float, **arguments: Any) -> dict[str, Any]:
        """The answer to one request within `timeout` [s]. Raises WorkerDied; the worker is closed then."""
        self._log.truncate(0)
        self._asked += 1
        deadline = time.monotonic() + timeout
        try:
            self._send(json.dumps({"id": self._asked, "op": op, **arguments}).encode() + b"\n", deadline)
            return self._answer(deadline)
        except WorkerDied as error:
            problem = f"no answer within {timeout:.3g} s" if isinstance(error, WorkerTimeout) else error
            words = self.last_words() or SILENCE
            self.close()
            raise type(error)(f"{problem}{words}") from None

    def _send(self, line: bytes, deadline: float) -> None:
        """Write a request; a worker that does not read has until the deadline, one that has ended is told of by its answer."""
        with contextlib.suppress(BrokenPipeError):
            while line:
                if select.select([], [self._requests], [], self._patience(deadline))[1]:
                    line = line[os.write(self._requests, line):]

    def _answer(self, deadline: float) -> dict[str, Any]:
        """The answer to the last request; what comes late, or twice, to one before it is passed over."""
        while True:
            line = self._line(deadline)
            try:
                answer = json.loads(line)
                number = answer.pop("id")
            except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
                raise WorkerDied(f"it wrote {line[:80]!r} into the harness's pipe, which is no answer") from None
            if number == self._asked:
                return answer

    def _line(self, deadline: float) -> bytes:
        """The next line from the worker."""
        while b"\n" not in self._buffer:
            if len(self._buffer) > LONGEST_ANSWER:
                raise WorkerDied(f"it wrote {self._buffer[:40]!r} and so on into the harness's pipe, without end")
            if select.select([self._answers], [], [], self._patience(deadline))[0]:
                self._read()
            elif self._process.poll() is not None:
                raise WorkerDied(self._ending())
        line, _, self._buffer = self._buffer.partition(b"\n")
        return line

    def _patience(self, deadline: float) -> float:
        left = deadline - time.monotonic()
        if left < 0:
            raise WorkerTimeout
        return min(POLL, left)

    def _read(self) -> None:
        chunk = os.read(self._answers, 1 << 16)
        if not chunk:
            raise WorkerDied(self._ending())
        self._buffer += chunk

    def _ending(self) -> str:
        try:
            status = self._process.wait(timeout=1)
        except subprocess.TimeoutExpired:
            return "its process closed the harness's pipe"
        return f"its process {ending(status)} before it answered"

    def last_words(self) -> str:
        """What the renderer printed last during the present request, as the end of a sentence; empty if nothing."""
        size = os.fstat(self._log.fileno()).st_size
        tail = os.pread(self._log.fileno(), 4096, max(0, size - 4096)).decode(errors="replace")
        lines = [plain(line) for line in tail.splitlines() if line.strip()]
        return f"; it last wrote: {' | '.join(lines[-QUOTED_LINES:])}" if lines else ""

    @property
    def crowded(self) -> bool:
        """Whether the worker has left more processes behind than a renderer needs; unknown but on Linux."""
        with contextlib.suppress(OSError):
            lists = Path(f"/proc/{self._process.pid}/task").glob("*/children")
            return sum(len(each.read_text().split()) for each in lists) > self._most_children
        return False

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
        self._release()

    def _release(self) -> None:
        os.close(self._requests)
        os.close(self._answers)
        self._log.close()
        for folder in self._folders:
            folder.remove()
