"""The raw record of a run: one folder, appended to and never overwritten.

    run.json       what was run, where and with what (Run), and the scenes as they were
    trials.jsonl   one line per trial as it ended
    films/         one OpenEXR per film
"""

from __future__ import annotations

import fcntl
import json
import os
import re
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from lightproof import films, scene_file, typed
from lightproof.checked import plain, shown
from lightproof.scene import Scene
from lightproof.trial import Result, Status, Trial

FORMAT = "lightproof run 1"


class StoreError(ValueError):
    """A folder that is no run, or that cannot be written: says which and what would be right."""


@dataclass(frozen=True)
class Run:
    """What was run, where and with what. `versions`: of lightproof, Python, numpy and each renderer; `options`: the plan, and
    under "suites" the folder that holds each scene's reference."""

    id: str
    started: str
    suite_digest: str
    machine: str
    threads: int
    seed: int
    versions: Mapping[str, str]
    commit: str
    options: Mapping[str, Any]


class Store:
    """A run's folder. Get one from `create` or `open`."""

    def __init__(self, folder: Path, run: Run, scenes: Sequence[Scene]):
        self.folder = folder
        self.run = run
        self.scenes = tuple(scenes)

    @property
    def _trials(self) -> Path:
        return self.folder / "trials.jsonl"

    def film_path(self, trial: Trial) -> Path:
        """Where the film of a trial stands: by scene, method, samples and replicate, for people; with its key, to be unique."""
        scene, case, method = (re.sub(r"^\.|[^A-Za-z0-9.-]+", "_", name) for name in (trial.scene, trial.case, trial.method))
        return self.folder / "films" / scene / case / method / f"{trial.samples}-{trial.replicate}-{trial.key[:8]}.exr"

    @cached_property
    def _lines(self) -> Any:
        """The trials file, open for appending by this process alone, without the torn line that a kill may have left.
        Raises StoreError where another process is writing to the run."""
        lines = self._trials.open("a+b")
        try:
            fcntl.flock(lines, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            lines.close()
            raise StoreError(f"{self.folder}: another process is writing to this run; wait for it, or start a new run") from None
        lines.seek(0)
        lines.truncate(lines.read().rfind(b"\n") + 1)
        return lines

    def append(self, result: Result) -> None:
        """Record one result: safe from a kill of the harness when this returns, and from a power cut after `sync`. Raises
        StoreError."""
        record = {field.name: getattr(result, field.name) for field in fields(Result) if field.name not in ABSENT}
        film = self.film_path(result.trial).relative_to(self.folder) if result.film is not None else None
        record |= {"trial": asdict(result.trial), "film": film and str(film)}
        try:
            self._lines.write(json.dumps(record, default=dict).encode() + b"\n")
            self._lines.flush()
        except OSError as error:
            raise StoreError(f"{self._trials}: cannot be written ({error.strerror}); mend that, then --resume the run") from None

    def sync(self) -> None:
        """Have what was recorded written to the disk: some milliseconds, so once for several results."""
        os.fsync(self._lines.fileno())

    def results(self) -> list[Result]:
        """Every recorded result with its film, in the order in which they ended. Raises StoreError, FilmError."""
        if not self._trials.is_file():
            return []
        lines = self._trials.read_bytes().split(b"\n")[:-1]
        return [self._read(number, line) for number, line in enumerate(lines, start=1)]

    def _read(self, number: int, line: bytes) -> Result:
        try:
            record = json.loads(line)
            has_film = record.pop("film")
            trial = typed.check(Trial(**record.pop("trial")))
            result = typed.check(Result(trial, Status(record.pop("status")), **record), besides=("trial", "status", *ARRAYS))
            if (trial.scene, trial.case) not in {(scene.id, scene.case) for scene in self.scenes}:
                raise ValueError(f"there is no scene {shown(trial.scene)} with the case {shown(trial.case)} in run.json")
        except (AttributeError, TypeError, KeyError, ValueError, RecursionError) as error:
            problem = f"line {number} is no trial ({plain(str(error))})"
            raise StoreError(f"{self._trials}: {problem}; mend the file or start a new run") from None
        return replace(result, **self._arrays(trial)) if has_film else result

    def _arrays(self, trial: Trial) -> dict[str, Any]:
        _, channels, _ = films.read(self.film_path(trial))
        known = {name: channels.get(name) for name in ("variance", "tessellation", "peak", "bound")}
        return {"film": channels["Y"], "quantization": channels.get("quantization", 0.0), **known}


ARRAYS = ("film", "variance", "quantization", "tessellation", "peak", "bound")
ABSENT = ("trial", *ARRAYS)
OPTIONS = {"budget": "float", "cell_budget": "float", "replicates": "int", "methods": "list", "suites": "Mapping[str, str]"}


def create(parent: Path, run: Run, scenes: Sequence[Scene]) -> Store:
    """A new run folder `parent`/`run.id`. Raises StoreError where it cannot be written."""
    folder = parent / run.id
    tables = [{"id": scene.id, "case": scene.case, "table": scene.to_table()} for scene in scenes]
    try:
        folder.mkdir(parents=True)
        partial = folder / "run.json.partial"
        partial.write_text(json.dumps({"format": FORMAT, **asdict(run), "scenes": tables}, indent=1) + "\n")
        partial.rename(folder / "run.json")
    except OSError as error:
        raise StoreError(f"{folder}: cannot be written ({error.strerror}); give a folder that can, with --out") from None
    return Store(folder, run, scenes)


def check_writable(parent: Path) -> None:
    """Raise StoreError where no run could be created in `parent`, before anything has run."""
    try:
        parent.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=parent).close()
    except OSError as error:
        raise StoreError(f"{parent}: cannot be written ({error.strerror}); give a folder that can, with --out") from None


def open(folder: Path) -> Store:
    """The run in `folder`. Raises StoreError where there is none, or one of another format."""
    try:
        if not (folder / "run.json").is_file():
            raise ValueError("there is no file run.json")
        about = json.loads((folder / "run.json").read_bytes())
    except (OSError, ValueError, RecursionError):
        raise StoreError(f"{folder}: is no run of lightproof; give a folder that 'lightproof run' made") from None
    if not isinstance(about, dict) or about.pop("format", None) != FORMAT:
        raise StoreError(f"{folder}: run.json is not of the format '{FORMAT}'; give a run that this version of lightproof made")
    try:
        scenes = [scene_file.from_table(scene["table"], scene["id"], scene["case"]) for scene in about.pop("scenes")]
        typed.check_keys(about["options"], OPTIONS)
        return Store(folder, typed.check(Run(**about)), scenes)
    except (AttributeError, TypeError, KeyError, ValueError) as error:
        problem = f"is broken ({plain(str(error))}); restore the file, or start a new run"
        raise StoreError(f"{folder / 'run.json'}: {problem}") from None


def latest(parent: Path) -> Store:
    """The newest run in `parent`. Raises StoreError where there is none."""
    folders = sorted(path.parent for path in parent.glob("*/run.json"))
    if not folders:
        raise StoreError(f"{parent}: holds no run; make one with 'lightproof run'")
    return open(folders[-1])
