"""The scripts of a suite's references/ folder: derivations that stand alone and share no code with the first engine.

A script serves the scenes that it lists in SCENES, or the one that it is named after. Its function `values(table, elements)`
takes a scene as `Scene.to_table` gives it; its docstring begins with "Second derivation for ...: " and what it does.
"""

from __future__ import annotations

import ast
import runpy
from collections.abc import Iterable
from functools import cache
from pathlib import Path

import numpy as np

from lightproof.scene import Scene


@cache
def scenes_of(script: Path) -> tuple[str, ...]:
    """The ids of the scenes that a script serves."""
    return tuple(runpy.run_path(str(script)).get("SCENES", (script.stem,)))


def find(scene_id: str, folder: Path) -> Path | None:
    """The script that serves a scene; None where there is none."""
    return next((script for script in sorted(folder.glob("*.py")) if scene_id in scenes_of(script)), None)


def values(script: Path, scene: Scene, elements: Iterable[int]) -> np.ndarray:
    """(m,) Values of m film elements, in the film's unit. The script runs anew: it sets the precision that all of mpmath has."""
    return np.array(runpy.run_path(str(script))["values"](scene.to_table(), list(elements)))


def derivation(script: Path) -> str:
    """What a script does: the first sentence of its docstring, after the name of what it derives."""
    text = " ".join((ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))) or "").split())
    return text.partition(": ")[2].partition(". ")[0].rstrip(".")
