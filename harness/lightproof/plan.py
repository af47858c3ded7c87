"""What a run is going to do, written into its record before anything is rendered, so that it can be resumed."""

from __future__ import annotations

import hashlib
import secrets
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from datetime import UTC, datetime
from typing import Any

from lightproof import machine, typed
from lightproof.checked import plain
from lightproof.renderers.registry import Entry
from lightproof.runner import SLOPE, SPARE, Cell
from lightproof.scene import Scene
from lightproof.store import Run, Store, StoreError
from lightproof.suite import Suite


def describe(scenes: Mapping[Scene, Suite], methods: Iterable[Entry], threads: int, seed: int, versions: Mapping[str, str],
             **options: Any) -> Run:
    """The header of a new run of `methods` on `scenes`, each with the suite that holds its reference."""
    now = datetime.now(UTC)
    digests = "".join(sorted(scene.digest for scene in scenes))
    return Run(
        id=f"{now:%Y%m%d-%H%M%S}-{secrets.token_hex(2)}",
        started=now.isoformat(timespec="seconds"),
        suite_digest=hashlib.sha256(digests.encode()).hexdigest(),
        machine=machine.description(),
        threads=threads,
        seed=seed,
        versions={**machine.versions(), **versions},
        commit=machine.commit(),
        options={
            **options,
            "methods": [asdict(entry) for entry in methods],
            "suites": {scene.name: str(home.root.resolve()) for scene, home in scenes.items()},
        },
    )


def cells(record: Store) -> list[Cell]:
    """Every method on every scene of a run, as its options say. Raises StoreError."""
    options = record.run.options
    try:
        entries = [typed.check(Entry(**entry)) for entry in options["methods"]]
        budget, replicates = options["cell_budget"], options["replicates"]
    except (KeyError, TypeError) as error:
        raise StoreError(f"{record.folder / 'run.json'}: its plan is broken ({plain(str(error))}); start a new run") from None
    return [Cell(scene, entry, budget, replicates, slope=SLOPE, spare=SPARE) for scene in record.scenes for entry in entries]
