"""The process of a renderer outside: it gets jobs and gives lines, for as long as it stays up.

Nothing here has a time limit: a program that hangs is killed with the worker that waits for it.
"""

from __future__ import annotations

import contextlib
import os
import select
import subprocess
from collections.abc import Sequence
from pathlib import Path

import psutil

from lightproof.renderers.process import POLL, ending
from lightproof.renderers.protocol import LONGEST_ANSWER, AnswerError
from lightproof.renderers.worker import die_with


class Program:
    """A command started in `folder`, which `listens` to its standard input or not. It dies with this process; its standard error
    is this process's own."""

    def __init__(self, command: Sequence[str], folder: Path, listens: bool):
        mother = os.getpid()
        self._buffer = bytearray()
        try:
            self._process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, bufsize=0,
                                             stdin=subprocess.PIPE if listens else subprocess.DEVNULL,
                                             preexec_fn=lambda: die_with(mother))
        except OSError as error:
            raise AnswerError(f"{command[0]} cannot be run: {error.strerror}") from None

    @property
    def ended(self) -> bool:
        """Whether the program is no longer there to be asked."""
        return self._process.poll() is not None

    def ask(self, request: bytes) -> bytes:
        """The line that answers a line. Raises AnswerError where there is none, more than one, or one that nobody asked for."""
        if self._readable(0) and self._read():
            raise AnswerError(f"it wrote {self._quoted()} before it was asked; it must answer each job once")
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.write(request + b"\n")
        line = self.line()
        self._only_one()
        return line

    def line(self) -> bytes:
        """The next line, or what there is at the end of the output. Raises AnswerError where there is nothing."""
        searched = 0
        while (end := self._buffer.find(b"\n", searched)) < 0:
            searched = len(self._buffer)
            if searched > LONGEST_ANSWER:
                raise AnswerError(f"it wrote {self._quoted()} and so on; an answer is a line of at most {LONGEST_ANSWER:,} bytes")
            if self._is_silent():
                if not self._buffer:
                    raise AnswerError(self._silence())
                end = len(self._buffer)
                break
        line = bytes(self._buffer[:end])
        del self._buffer[: end + 1]
        return line

    def end(self) -> None:
        """Wait until a program that has answered ends. Raises AnswerError where it fails, or writes more."""
        self._only_one()
        while not self._is_silent():
            self._only_one()
        if self._process.wait():
            raise AnswerError(f"it answered, but then it {ending(self._process.returncode)}")

    def close(self) -> None:
        """Kill the program and the processes that it has started."""
        if not self.ended:
            self._kill()
        self._process.stdout.close()
        if self._process.stdin:
            self._process.stdin.close()

    def _kill(self) -> None:
        family = psutil.Process(self._process.pid)
        for process in (*family.children(recursive=True), family):
            with contextlib.suppress(psutil.Error):
                process.kill()
        self._process.wait()

    def _is_silent(self) -> bool:
        """Wait a little for more; whether there will be none."""
        if self._readable(POLL):
            return not self._read()
        return self.ended and not self._readable(0)

    def _silence(self) -> str:
        try:
            return f"it {ending(self._process.wait(timeout=1))} before it answered"
        except subprocess.TimeoutExpired:
            return "it closed its standard output before it answered"

    def _only_one(self) -> None:
        if self._buffer.strip():
            raise AnswerError(f"it wrote {self._quoted()} after its answer; it must answer each job once")

    def _readable(self, patience: float) -> bool:
        return bool(select.select([self._process.stdout], [], [], patience)[0])

    def _read(self) -> bool:
        """Take up what there is; whether there was anything."""
        chunk = self._process.stdout.read(1 << 16)
        self._buffer += chunk
        return bool(chunk)

    def _quoted(self) -> str:
        return repr(self._buffer[:40].decode(errors="replace"))
