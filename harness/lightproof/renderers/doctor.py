"""A renderer examined: is it there, and does it render?"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from lightproof.method import Unavailable
from lightproof.renderers.pool import MethodFailed, Pool
from lightproof.renderers.process import WorkerDied
from lightproof.renderers.registry import Entry
from lightproof.scene import Scene
from lightproof.trial import Result, Status, Trial

SAMPLES = 64
PATIENCE = 60.0


@dataclass(frozen=True)
class Examination:
    """`version` is empty where the renderer does not start and `message` says why; `scene` and `result` are those of the first
    trial scene that it supports, None where there is none."""

    entry: Entry
    version: str = ""
    message: str = ""
    scene: Scene | None = None
    result: Result | None = None


def examine(entry: Entry, scenes: Sequence[Scene], threads: int) -> Examination:
    """Start one method and have it render the first of `scenes` that it can, at a few samples per element."""
    with Pool(threads, patience=PATIENCE) as pool, tempfile.TemporaryDirectory() as folder:
        try:
            version = pool.open(entry).version
        except (Unavailable, MethodFailed, WorkerDied) as error:
            return Examination(entry, message=str(error))
        for scene in scenes:
            trial = Trial(scene.id, scene.case, scene.digest, entry.name, SAMPLES, replicate=0)
            result = pool.render(entry, scene, trial, Path(folder) / "trial.exr", PATIENCE)
            if result.status is not Status.UNSUPPORTED:
                return Examination(entry, version, result.message, scene, result)
    return Examination(entry, version, "supports none of the trial scenes")
