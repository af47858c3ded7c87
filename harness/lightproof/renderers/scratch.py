"""Folders for what a worker writes and nobody keeps: one on disk, and one in memory for what is read again at once.

The harness makes them, and removes them when the worker ends, however it does. Those of a harness that was killed are left
behind; the next one knows them by their names, and by the lock that only a living harness holds.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import shutil
import stat
import tempfile
import time
from pathlib import Path

PREFIX = "lightproof-worker-"
SHARED_MEMORY = Path("/dev/shm")
VARIABLE = "LIGHTPROOF_MEMORY"  # of a worker's environment: its folder in memory
YOUNG = 60.0  # s: a folder may not be locked yet


class Folder:
    """A folder in `place`, locked while this process lives."""

    def __init__(self, place: Path):
        self.path = Path(tempfile.mkdtemp(prefix=PREFIX, dir=place))
        self._lock = os.open(self.path, os.O_RDONLY)
        fcntl.flock(self._lock, fcntl.LOCK_EX)

    def remove(self) -> None:
        """The folder and all that is in it."""
        shutil.rmtree(self.path, ignore_errors=True)
        os.close(self._lock)


def places() -> tuple[Path, Path]:
    """Where the folder on disk is made, and the one in memory, if there is such a place."""
    disk = Path(tempfile.gettempdir())
    return disk, SHARED_MEMORY if os.access(SHARED_MEMORY, os.W_OK) else disk


def in_memory() -> str | None:
    """The folder in memory of the worker that asks, or None for the usual place of temporary files."""
    return os.environ.get(VARIABLE)


def sweep() -> None:
    """Remove what harnesses that were killed have left behind."""
    for place in set(places()):
        for folder in place.glob(f"{PREFIX}*"):
            with contextlib.suppress(OSError):
                if _is_abandoned(folder):
                    shutil.rmtree(folder)


def _is_abandoned(folder: Path) -> bool:
    """Whether a folder is this user's, has been there for a while and is locked by nobody. Raises OSError."""
    about = folder.lstat()
    mine = stat.S_ISDIR(about.st_mode) and about.st_uid == os.getuid()
    if not mine or time.time() - about.st_mtime < YOUNG:
        return False
    lock = os.open(folder, os.O_RDONLY | os.O_NOFOLLOW)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    finally:
        os.close(lock)
    return True
