"""The raw record of a run: one folder, appended to and never overwritten.

    run.json       what was run, where and with what (Run)
    trials.jsonl   one line per trial as it ended
    films/         one OpenEXR per film
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Run:
    """What was run, where and with what. `versions`: of lightproof, Python, numpy and each renderer; `options`: of the command."""

    id: str
    started: str
    suite_digest: str
    machine: str
    threads: int
    seed: int
    versions: Mapping[str, str]
    commit: str
    options: Mapping[str, Any]
