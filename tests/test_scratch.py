"""What workers write and nobody keeps goes when they end; what a harness that was killed left behind goes with the next."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from lightproof.renderers import scratch
from lightproof.renderers.process import Worker

KILLED = """
import os, signal, sys
from pathlib import Path
from lightproof.renderers import scratch
print(scratch.Folder(Path(sys.argv[1])).path, flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder in which all scratch folders are made."""
    monkeypatch.setattr(scratch, "places", lambda: (tmp_path, tmp_path))
    return tmp_path


def test_a_workers_folders_end_with_it(place):
    worker = Worker(threads=1)
    assert len(list(place.iterdir())) == 2
    worker.close()
    assert not list(place.iterdir())


def test_what_a_killed_harness_left_is_removed(place):
    """Four folders that have been there for a while, but for one: that of a process which was killed, that of a living one, a
    stranger's, and one of a process just killed. The first goes."""
    killed, young = (Path(subprocess.run([sys.executable, "-c", KILLED, place], capture_output=True, text=True).stdout.strip())
                     for _ in range(2))
    living, stranger = scratch.Folder(place), place / "lightproof-runs"
    stranger.mkdir()
    (killed / "film.exr").write_bytes(b"half")
    for folder in (killed, living.path, stranger):
        os.utime(folder, (0, 0))
    scratch.sweep()
    assert set(place.iterdir()) == {living.path, stranger, young}
    living.remove()
