"""Silence for libraries that report on a file descriptor what they also raise, or what nobody asked for."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator


@contextlib.contextmanager
def quiet(descriptor: int) -> Iterator[None]:
    """Nothing on a file descriptor: 1 is standard output, 2 standard error."""
    kept, nowhere = os.dup(descriptor), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, descriptor)
    try:
        yield
    finally:
        os.dup2(kept, descriptor)
        os.close(kept)
        os.close(nowhere)
