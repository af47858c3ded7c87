"""Is the light of a renderer right, or of a film? The verdict as an assertion, for tests."""

from __future__ import annotations

import inspect
import sys
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from lightproof import api, machine, plan, store
from lightproof.judging import Judge
from lightproof.renderers import naming
from lightproof.renderers.pool import Pool
from lightproof.renderers.registry import METHODS, Entry
from lightproof.runner import FIRST_SAMPLES, MOST_SAMPLES, REPLICATES, Cell, Runner
from lightproof.scene import Scene
from lightproof.suite import Suite
from lightproof.verdict import Outcome, Verdict


def check(judged: Any, scene: Scene | str, samples: int = MOST_SAMPLES, budget: float = 300.0) -> Verdict:
    """Assert that the light of a scene is right; returns the verdict where it is.

    `judged` is the name of a method, or what else --with takes; a function (scene, samples, seed) -> film or a class of
    methods, from the top level of a file; or a film (n,) or (rows, columns), or replicates and ladders of films as
    `lightproof.judge` takes them. What renders does so in a process of its own, with fixed seeds, in `budget` seconds and with
    at most `samples` per element. Raises AssertionError with the verdict's reason, ValueError, SceneError, ReferenceError.
    """
    __tracebackhide__ = True
    found, home = api.found(scene)
    if callable(judged) or isinstance(judged, str):
        entry = _own(judged) if callable(judged) else naming.entry(judged)
        limit = f" and at most {samples:,} samples" if samples < MOST_SAMPLES else ""
        name, effort = entry.name, f" (it had {budget:g} s{limit})"
        verdict = _render(entry, found, home, samples, budget)
    else:
        name, effort = "the film", ""
        verdict = api.judge(_grids(judged, found), found)
    if verdict.outcome is not Outcome.PASS:
        more = effort if verdict.outcome is Outcome.UNDECIDED else ""
        raise AssertionError(f"{name} on {found.name}: {verdict.outcome}: {verdict.reason}{more}")
    return verdict


def _own(renderer: Callable) -> Entry:
    """A function or class of the user's, to be found again by the worker."""
    name = getattr(renderer, "__qualname__", "<a nameless object>")
    if not name.isidentifier():
        raise ValueError(f"{name} is not at the top level of a file, where its own process could find it; move it there")
    file = Path(inspect.getfile(inspect.unwrap(renderer))).resolve()
    where = renderer.__module__ if (file.parent / "__init__.py").exists() else str(file)
    return Entry(f"{file.stem}:{name}", f"{where}:{name}", worker=where)


def _render(entry: Entry, scene: Scene, home: Suite, samples: int, budget: float) -> Verdict:
    """The verdict of one method on one scene, from a run that is not kept."""
    if samples < FIRST_SAMPLES:
        raise ValueError(f"{samples} samples are fewer than the first step takes; give at least {FIRST_SAMPLES}")
    threads = machine.usable_cores()
    path = () if entry.name in METHODS else tuple(filter(None, sys.path))
    with tempfile.TemporaryDirectory() as folder, Pool(threads, path=path) as pool:
        header = plan.describe({scene: home}, [entry], threads, seed=0, versions={}, replicates=REPLICATES)
        record = store.create(Path(folder), header, [scene])
        judge = Judge(record)
        cell = Cell(scene, entry, budget, REPLICATES, most_samples=samples, least_steps=1)
        Runner([cell], budget, record, pool, judge.decide, tell=lambda progress: None).run()
        return judge.judge(cell.results)


def _grids(films: Any, scene: Scene) -> Any:
    """Films as `lightproof.judge` takes them; a film (n,) is given its rows."""
    if isinstance(films, Mapping):
        return films
    films = np.asarray(films)
    return films.reshape(scene.film.grid) if films.shape == (scene.size,) else films
