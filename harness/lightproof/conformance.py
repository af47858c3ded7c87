"""Does a renderer outside keep to the protocol, and is its light right? A few checks, each answered in plain words."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from lightproof import rightness, statistics
from lightproof.method import Unavailable
from lightproof.renderers.pool import MethodFailed, Pool
from lightproof.renderers.process import WorkerDied
from lightproof.renderers.registry import Entry
from lightproof.scene import Scene
from lightproof.suite import Suite
from lightproof.trial import Result, Status, Trial

KNOWN = ("square-light", "disk-light", "sphere-light", "point-light", "beam", "overcast-sky", "white-furnace-plane",
         "square-light-seen", "sphere-furnace", "solid-angle-rectangle")
FEW, MORE = 16, 64  # samples per element
FILMS = (8, 16, 32, 64)  # for a variance, until it is clear; elements may depend on one another
FILMS_FOR_UNITS = 4
PATIENCE = 60.0  # s for one film
OUTSIDE, UNDECLARED = ".toml:Outside", ".toml:Undeclared"  # how targets end: see renderers/outside.py
CLOSE = 1e-5  # of the light: what films of the same seed may differ by, as sums in another order do


@dataclass(frozen=True)
class Check:
    """One line of the examination."""

    name: str
    passed: bool
    reason: str


def applies(entry: Entry) -> bool:
    """Whether a method is a renderer outside."""
    return entry.target.endswith(OUTSIDE)


def examine(entry: Entry, home: Suite, threads: int) -> Iterator[Check]:
    """The checks of a renderer, each as soon as it is known; those that the ones before make impossible are left out."""
    with Pool(threads, patience=PATIENCE) as pool, tempfile.TemporaryDirectory() as folder:
        try:
            about = pool.open(entry)
        except (Unavailable, MethodFailed, WorkerDied) as error:
            yield Check("version", False, str(error))
            return
        yield Check("version", True, about.version)
        yield from Examination(entry, home, pool, Path(folder) / "film.exr", about.deterministic).checks()


@dataclass
class Examination:
    """A renderer that has started, and the films that it has given."""

    entry: Entry
    home: Suite
    pool: Pool
    path: Path
    deterministic: bool
    results: dict[Trial, Result] = field(default_factory=dict)

    def checks(self) -> Iterator[Check]:
        """All checks after the first."""
        trials = {scene: self.render(scene, FEW) for scene in map(self.home.scene, KNOWN)}
        able = [scene for scene, result in trials.items() if result.status is Status.OK]
        yield _renders(trials)
        if not able:
            return
        yield self.declines({scene: result for scene, result in trials.items() if result.status is Status.UNSUPPORTED})
        noisy = next((scene for scene in able if not self.is_same(scene)), able[0])
        yield self.same_seed(noisy)
        yield self.other_seed(noisy)
        if not self.deterministic:
            yield from self.variance(noisy)
        for scene in able:
            yield self.units(scene)

    def render(self, scene: Scene, samples: int, replicate: int = 0) -> Result:
        """One film, rendered once however often it is asked for."""
        trial = Trial(scene.id, scene.case, scene.digest, self.entry.name, samples, replicate)
        if trial not in self.results:
            self.results[trial] = self.pool.render(self.entry, scene, trial, self.path, PATIENCE)
        return self.results[trial]

    def films(self, scene: Scene, samples: int, count: int) -> np.ndarray:
        """(count, n) Films with different seeds. Raises MethodFailed where one fails."""
        results = [self.render(scene, samples, replicate) for replicate in range(count)]
        failed = next((result.message for result in results if result.film is None), None)
        if failed is not None:
            raise MethodFailed(f"at {samples} samples: {failed}")
        return np.array([result.film for result in results])

    def declines(self, declined: dict[Scene, Result]) -> Check:
        """Asked in spite of its manifest, the program itself says what it cannot do."""
        if not declined:
            return Check("declines", True, "nothing: it supports every trial scene")
        asked = replace(self.entry, name=f"{self.entry.name}/undeclared", worker=f"{self.entry.worker}/undeclared",
                        target=self.entry.target.removesuffix(OUTSIDE) + UNDECLARED)
        for scene in declined:
            trial = Trial(scene.id, scene.case, scene.digest, asked.name, FEW, 0)
            result = self.pool.render(asked, scene, trial, self.path, PATIENCE)
            if result.status is not Status.UNSUPPORTED:
                what = "rendered it" if result.status is Status.OK else f"failed {result.message}"
                return Check("declines", False, f"asked for {scene.name}, which it does not support ({declined[scene].message}),"
                                                f" it {what}; it must answer \"unsupported\", with the reason")
        return Check("declines", True, f"{scene.name}: {result.message}")

    def same_seed(self, scene: Scene) -> Check:
        """The same seed again, after another one."""
        first = self.render(scene, FEW)
        self.render(scene, FEW, replicate=1)
        self.results.pop(first.trial)
        again = self.render(scene, FEW)
        if again.film is None:
            return Check("same seed", False, again.message)
        apart = _apart(first.film, again.film)
        return Check("same seed", apart <= CLOSE, "same film" if apart <= CLOSE else
                     f"another film, {apart:.2g} of the light away: what does it depend on besides job, seed and samples?")

    def other_seed(self, scene: Scene) -> Check:
        """Another seed, another film, unless the renderer says that chance plays no part."""
        other = self.render(scene, FEW, replicate=1)
        if other.film is None:
            return Check("other seed", False, other.message)
        same = self.is_same(scene)
        if self.deterministic:
            return Check("other seed", same, "same film, as deterministic in its manifest has it" if same else
                         "another film, although its manifest says deterministic")
        return Check("other seed", not same, "another film" if not same else
                     "the same film: is the seed ignored? If chance plays no part, the manifest says deterministic = true")

    def is_same(self, scene: Scene) -> bool:
        """Whether the films of two seeds are the same."""
        one, other = self.render(scene, FEW).film, self.render(scene, FEW, replicate=1).film
        return one is not None and other is not None and _apart(one, other) <= CLOSE

    def variance(self, scene: Scene) -> Iterator[Check]:
        """Four times the samples, a quarter of the variance or less; and the renderer's own word on it."""
        try:
            yield self._falls(scene)
        except MethodFailed as error:
            yield Check("samples", False, str(error))
            return
        more = [result for trial, result in self.results.items() if trial.samples == MORE]
        measured, error = statistics.variance_per_sample(np.array([result.film for result in more]), 1)
        if measured and all(result.variance is not None for result in more):
            yield Check("its variance", *_honest(np.mean([result.variance for result in more]) / measured, error))

    def _falls(self, scene: Scene) -> Check:
        wanted = FEW / MORE
        for count in FILMS:
            few, more = self.films(scene, FEW, count), self.films(scene, MORE, count)
            if not (np.ptp(few, axis=0).any() and np.ptp(more, axis=0).any()):
                return Check("samples", False, f"{count} films with different seeds are the same: no variance to measure")
            ratio, least, most = statistics.variance_ratio(more, 1, few, 1)
            if least > wanted or most < 1:
                break
        found = f"{MORE // FEW} times the samples, {ratio:.3g} of the variance"
        if least > wanted:
            return Check("samples", False, f"{found}, not {wanted:g}{': are the samples ignored?' if most > 0.9 else ''}")
        return Check("samples", most < 1, found if most < 1 else f"{found}: anything from {least:.2g} to {most:.2g} is possible")

    def units(self, scene: Scene) -> Check:
        """The film against the exact light."""
        name = f"units, {scene.name}"
        try:
            films = self.films(scene, MORE, FILMS_FOR_UNITS)
        except MethodFailed as error:
            return Check(name, False, str(error))
        return Check(name, *rightness.compare(films, self.home.reference(scene).value, scene))


def _renders(trials: dict[Scene, Result]) -> Check:
    """Each trial scene gives a film, or a reason why not; and some give a film."""
    of = {status: [scene.name for scene, result in trials.items() if result.status is status] for status in Status}
    broken, able = of[Status.ERROR], of[Status.OK]
    if broken:
        message = next(result.message for result in trials.values() if result.status is Status.ERROR)
        return Check("renders", False, f"{', '.join(broken)}: {message}")
    if not able:
        return Check("renders", False, f"it supports none of {', '.join(trial.name for trial in trials)}: nothing to try")
    return Check("renders", True, ", ".join(able))


def _apart(one: np.ndarray, other: np.ndarray) -> float:
    """The largest difference, as a part of the largest value."""
    return float(np.abs(one - other).max() / max(np.abs(one).max(), np.finfo(float).tiny))


def _honest(ratio: float, error: float) -> tuple[bool, str]:
    """Of a variance that is `ratio` times the measured one, whose logarithm is known to `error`."""
    undivided = ": is it that of one sample, not divided by their number?" if MORE / 2 < ratio < MORE * 2 else ""
    fair = ratio > 0 and abs(np.log(ratio)) < np.log(2) + rightness.NOISE * error
    return bool(fair), f"the variance that it gives is {ratio:.3g} times that of its films{undivided}"
