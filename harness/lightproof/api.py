"""The calls for a notebook: load a scene, render it, know its exact light, judge a film."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from lightproof import suite, verdict
from lightproof.references import Reference
from lightproof.renderers import naming
from lightproof.renderers.pool import Pool
from lightproof.scene import Scene
from lightproof.trial import Result, Status, Trial
from lightproof.verdict import Verdict

_homes: dict[Scene, suite.Suite] = {}  # where the references of loaded scenes are


class RenderError(RuntimeError):
    """A method that could not fill the film: says why."""


def load(scene: str) -> Scene:
    """A scene by its id, `id:case`, or the path of a file. Raises SceneError."""
    found, _homes[found] = suite.find(scene, suite.default())
    return found


def reference(scene: Scene | str) -> Reference:
    """The exact light: `value` and `uncertainty` (n,) in the film's unit. Raises SceneError, ReferenceError."""
    scene, home = found(scene)
    return home.reference(scene)


def render(scene: Scene | str, method: str = "mc-area", samples: int = 1024, replicates: int | None = None, seed: int = 0,
           threads: int | None = None) -> np.ndarray:
    """A film (rows, columns) of a scene in the film's unit, or `replicates` of them (R, rows, columns) with independent seeds,
    at `samples` per element; rendered in a process of its own on `threads` (default: all cores).

    `method` is what the command line's --with takes: a name, `module:name`, `file.py:name` or the path of a manifest. Raises
    MethodError (a ValueError) where there is none, RenderError where it cannot do the scene or fails, SceneError.
    """
    (scene, _), entry = found(scene), naming.entry(method)
    with tempfile.TemporaryDirectory() as folder, Pool(threads or os.cpu_count() or 1) as pool:
        trials = [Trial(scene.id, scene.case, scene.digest, entry.name, samples, replicate, seed)
                  for replicate in range(replicates or 1)]
        results = [pool.render(entry, scene, trial, Path(folder) / "film.exr", math.inf) for trial in trials]
    for result in results:
        if result.status is not Status.OK:
            raise RenderError(f"{entry.name} on {scene.name}: {result.message}")
    films = np.array([result.film.reshape(scene.film.grid) for result in results])
    return films[0] if replicates is None else films


def judge(films: ArrayLike | Mapping[int, ArrayLike], scene: Scene | str) -> Verdict:
    """The verdict on one film (rows, columns), on replicates (R, rows, columns) that differ in nothing but their seed, or on
    a ladder {samples: replicates}, in the film's unit.

    One film is judged as noise-free: whatever is off counts as bias. A fail needs two steps of a ladder, each 4 times the
    samples of the one before; without a ladder nothing is known of samples, so none are asked for. Raises ValueError where
    the shape does not fit, SceneError, ReferenceError.
    """
    scene, home = found(scene)
    counted = isinstance(films, Mapping)
    ladder = films if counted else {1: films}
    results = [result for samples, step in ladder.items() for result in _results(np.asarray(step, float), samples, scene)]
    judged = verdict.judge(results, home.reference(scene), scene)
    return judged if counted else verdict.uncounted(judged)


def found(scene: Scene | str) -> tuple[Scene, suite.Suite]:
    """A scene, given itself or by name or path, with the suite that holds its reference. Raises SceneError."""
    return suite.find(scene, suite.default()) if isinstance(scene, str) else (scene, _homes.get(scene, suite.default()))


def _results(films: np.ndarray, samples: int, scene: Scene) -> list[Result]:
    if films.shape[-2:] != scene.film.grid or films.ndim not in (2, 3):
        rows, columns = scene.film.grid
        fits = f"({rows}, {columns}) or (R, {rows}, {columns})"
        raise ValueError(f"films of shape {films.shape} do not fit {scene.name}; give {fits}")
    return [
        Result(Trial(scene.id, scene.case, scene.digest, "given", samples, replicate), Status.OK, film=film.ravel(),
               samples=samples, deterministic=films.ndim == 2)
        for replicate, film in enumerate(films.reshape(-1, *scene.film.grid))
    ]
