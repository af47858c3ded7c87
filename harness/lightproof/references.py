"""The exact light of one scene: value and uncertainty of every film element, with provenance.

`references/<id>.csv` holds case, element, value, uncertainty; `references/<id>.toml` holds, for each case, the scene's
digest, the engines and how far they agree, and for the scene its formula and citations.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lightproof import scene_file
from lightproof.checked import SceneError, shown
from lightproof.scene import Scene


class ReferenceError(ValueError):
    """A reference that is missing, stale or broken: says which, where, and what would mend it."""


@dataclass(frozen=True)
class Reference:
    """`value` and `uncertainty` (n,) in the film's unit, row-major; `uncertainty` bounds |value - true value|. `source` says in
    a sentence where the formula is from, `kind` what the uncertainty is worth: an enclosure or a quadrature estimate."""

    scene_id: str
    case: str
    value: np.ndarray
    uncertainty: np.ndarray
    engine: str
    second_engine: str
    agreement: float
    formula: str
    citations: tuple[str, ...]
    scene_digest: str
    source: str = ""
    kind: str = ""


def read(folder: Path, scene: Scene) -> Reference:
    """The reference of `scene` in a suite's references/ folder.

    Raises ReferenceError where there is none, where it was made for another version of the scene, or where it is broken.
    """
    path = folder / f"{scene.id}.toml"
    try:
        return _read(path, scene, _about(path))
    except (AttributeError, KeyError, TypeError) as error:
        raise ReferenceError(f"{path}: is broken ({error!r}); run 'lightproof certify {scene.id}'") from None


def _read(path: Path, scene: Scene, about: dict[str, Any]) -> Reference:
    case = about.get("cases", {}).get(scene.case)
    if case is None:
        raise ReferenceError(f"{path}: no reference for case '{scene.case}'; run 'lightproof certify {scene.id}'")
    if case["scene_digest"] != scene.digest:
        raise ReferenceError(f"{path}: the reference of case '{scene.case}' was made for another version of the scene;"
                             f" run 'lightproof certify {scene.id}'")
    value, uncertainty = _values(path.with_suffix(".csv"), scene)
    return Reference(
        scene_id=scene.id,
        case=scene.case,
        value=value,
        uncertainty=uncertainty,
        engine=case["engine"],
        second_engine=case["second_engine"],
        agreement=case["agreement"],
        formula=about["formula"],
        citations=tuple(about["citations"]),
        scene_digest=case["scene_digest"],
        source=about.get("source", ""),
        kind=case.get("kind", ""),
    )


def _about(path: Path) -> dict[str, Any]:
    if not path.exists():
        raise ReferenceError(f"{path}: there is no reference for this scene; run 'lightproof certify {path.stem}'")
    try:
        return scene_file.read_table(path, "reference")
    except SceneError as error:
        raise ReferenceError(f"{path}: {error}") from None


def _values(path: Path, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    try:
        if path.exists() and not path.is_file():
            raise ValueError("it is no file")
        with path.open(encoding="utf-8", newline="") as lines:
            rows = [row for row in csv.DictReader(lines) if row["case"] == scene.case]
        elements = [int(row["element"]) for row in rows]
        numbers = np.array([[float(row["value"]), float(row["uncertainty"])] for row in rows]).reshape(-1, 2)
    except (OSError, KeyError, TypeError, ValueError, csv.Error) as error:
        raise ReferenceError(f"{path}: cannot be read: {shown(str(error))};"
                             " the columns are case, element, value, uncertainty") from None
    if elements != list(range(scene.size)):
        raise ReferenceError(f"{path}: case '{scene.case}' has {len(elements)} rows;"
                             f" it needs elements 0 to {scene.size - 1} in order")
    if not np.isfinite(numbers).all() or (numbers[:, 1] < 0).any():
        raise ReferenceError(f"{path}: case '{scene.case}' holds a value that is not finite or a negative uncertainty")
    return numbers[:, 0], numbers[:, 1]
