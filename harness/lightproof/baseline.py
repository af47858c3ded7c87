"""The accepted state of a suite: a table to compare with, and to be replaced by a person only.

A row is one scene, case and method: its outcome, the step of the ladder that it was reached at, and the variance of one
sample there, as a fraction of the tolerance scale squared.
"""

from __future__ import annotations

import difflib
import fnmatch
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import get_type_hints

from lightproof.checked import plain
from lightproof.verdict import Outcome

Key = tuple[str, str, str]


class BaselineError(ValueError):
    """A baseline that cannot be read: says what, where and what would be right."""


@dataclass(frozen=True)
class State:
    """One row of the baseline. `log_error` is the standard error of the variance's logarithm from `replicates` films."""

    scene: str
    case: str
    method: str
    outcome: str
    samples: int
    variance_per_sample: float
    log_error: float
    replicates: int

    @property
    def key(self) -> Key:
        """What the row is about."""
        return self.scene, self.case, self.method

    @property
    def name(self) -> str:
        """`method on scene[:case]`."""
        return f"{self.method} on {self.scene}" + ("" if self.case == "base" else f":{self.case}")


def read(path: Path) -> dict[Key, State]:
    """The accepted state. Raises BaselineError."""
    import pandas  # takes a second that the command line, which imports this file, need not wait for

    columns = get_type_hints(State)
    try:
        table = pandas.read_csv(path, dtype=columns, keep_default_na=False)[list(columns)]
        states = [State(*row) for row in table.itertuples(index=False)]
    except (OSError, ValueError, KeyError) as error:
        advice = "make one with 'lightproof gate --run RUN' and copy its state here"
        raise BaselineError(f"{path}: is no baseline ({plain(str(error))}); {advice}") from None
    unknown = sorted({state.outcome for state in states} - set(Outcome))
    if unknown:
        raise BaselineError(f"{path}: {unknown[0]!a} is no outcome; the outcomes are {', '.join(Outcome)}")
    return {state.key: state for state in states}


def select(states: Mapping[Key, State], scenes: Sequence[str] = (), methods: Sequence[str] = ()) -> dict[Key, State]:
    """The rows whose scene and method match one of the globs, or all where there are none."""
    return {key: state for key, state in states.items() if _matches(state.scene, scenes) and _matches(state.method, methods)}


def _matches(name: str, globs: Sequence[str]) -> bool:
    return not globs or any(fnmatch.fnmatchcase(name, glob) for glob in globs)


def to_csv(states: Iterable[State]) -> str:
    """The text of a baseline with these rows, sorted; the variance to the three digits that its interval is worth."""
    import pandas

    rows = [asdict(state) for state in sorted(states, key=lambda state: state.key)]
    table = pandas.DataFrame(rows, columns=[field.name for field in fields(State)])
    return table.to_csv(index=False, float_format="%.3g", lineterminator="\n")


def difference(accepted: Path, proposed: Path) -> str:
    """The unified diff from one baseline file to another."""
    old = accepted.read_text().splitlines(keepends=True) if accepted.exists() else []
    return "".join(difflib.unified_diff(old, proposed.read_text().splitlines(keepends=True), str(accepted), str(proposed)))
