"""The harness is killed at any moment: what was recorded stays, and --resume ends with the records of a run left alone."""

from __future__ import annotations

import random
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from test_process import TARGET

from lightproof import store, suite
from lightproof.trial import Result

PLAN = ("--budget", "600", "--cell-budget", "300", "--threads", "1", "--with", f"{TARGET}/slow")


def make_suite(folder: Path) -> Path:
    """A suite of one scene, the point light."""
    for name in ("scenes/point-light.toml", "references/point-light.csv", "references/point-light.toml"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(suite.default().root / name, folder / name)
    return folder


def start(root: Path, out: Path) -> subprocess.Popen:
    """A run, or the rest of the one that was begun in `out`."""
    begun = [path.parent for path in out.glob("*/run.json")]
    arguments = ["--resume", *begun] if begun else ["--suite", root, "--out", out, *PLAN]
    command = [sys.executable, "-m", "lightproof.cli", "run", *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def finish(root: Path, out: Path) -> float:
    """Carry a run to its end; the seconds that it took."""
    begun = time.monotonic()
    running = start(root, out)
    output, _ = running.communicate()
    assert running.returncode == 0, output
    return time.monotonic() - begun


def kill(root: Path, out: Path, moments: Iterator[float]) -> int:
    """Kill a run at `moments` [s] after each start until it ends before one or there are no more; how often it was killed."""
    kept: list[bytes] = []
    for count, moment in enumerate(moments):
        running = start(root, out)
        try:
            running.communicate(timeout=moment)
            return count
        except subprocess.TimeoutExpired:
            running.kill()
            running.communicate()
        lines = recorded(out)
        assert lines[: len(kept)] == kept
        kept = lines
    return count + 1


def recorded(out: Path) -> list[bytes]:
    """The whole lines of a record; none where the run was killed before it had one."""
    return [line for path in out.glob("*/trials.jsonl") for line in path.read_bytes().split(b"\n")[:-1]]


def records(out: Path) -> dict[str, Result]:
    """What a run has recorded of each trial, without what the clock and the kernel say."""
    results = [result for result in store.latest(out).results()]
    found = {result.trial.key: replace(result, film=None, seconds={}, peak_memory_mb=0.0) for result in results}
    assert len(found) == len(results)
    return found


def films(out: Path) -> dict[str, bytes]:
    """Every film, by its trial."""
    return {result.trial.key: result.film.tobytes() for result in store.latest(out).results()}


def test_a_killed_run_ends_as_if_nothing_had_happened(tmp_path):
    """SIGKILL at random moments, from the first import to the last trial: no line is lost, none is there twice."""
    root = make_suite(tmp_path / "suite")
    seconds = finish(root, tmp_path / "alone")
    draw = random.Random(1)
    assert kill(root, tmp_path / "killed", (draw.uniform(0, seconds) for _ in range(3))) > 0
    finish(root, tmp_path / "killed")
    assert records(tmp_path / "killed") == records(tmp_path / "alone")
    assert films(tmp_path / "killed") == films(tmp_path / "alone")
    assert not list((tmp_path / "killed").rglob("*.partial"))
