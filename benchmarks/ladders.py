"""Error against time of one method on one scene, and from it the time to a given error."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from lightproof import statistics
from ratios import over_rounds
from rows import Estimate, Row

ERRORS = (0.01, 0.001, 0.0001)
LAST = 4  # steps of the ladder that tell how the error falls beyond it
FLATTEST = -0.1  # d log error / d log samples: an error that falls no faster has a floor
DETERMINISTIC, SINGLE = "no noise", "one sample"  # what rows note: of such a method, of films that took no more
MEASURED, SHORTEST, AT_MOST, EXTRAPOLATED, NEVER = "", "with one sample", "at most", "extrapolated", "never"


@dataclass(frozen=True)
class Ladder:
    """`seconds` and rms `errors` (R, S) of films in R rounds at `samples` (S,) per element; `single`: the first step really
    took one sample, so that there is no shorter film."""

    scene: str
    method: str
    samples: np.ndarray
    seconds: np.ndarray
    errors: np.ndarray
    deterministic: bool
    single: bool = False

    @property
    def rounds(self) -> np.ndarray:
        """The indices of all rounds."""
        return np.arange(len(self.seconds))

    def points(self, rounds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Median seconds and root mean square error (S,) over some of the rounds."""
        return np.median(self.seconds[rounds], axis=0), np.sqrt((self.errors[rounds] ** 2).mean(axis=0))

    def time_to(self, error: float, rounds: np.ndarray | None = None) -> float:
        """Seconds until the error is `error`: interpolated between steps, extrapolated by the slope of the last ones, infinite
        where the error has stopped falling."""
        seconds, errors = self.points(self.rounds if rounds is None else rounds)
        found = statistics.seconds_to(error, seconds, errors)
        return self._beyond(error, seconds, errors) if found is None else found

    def kind(self, error: float) -> str:
        """How `time_to` is known."""
        errors = self.points(self.rounds)[1]
        if errors[0] <= error:
            return SHORTEST if self.single else AT_MOST
        if errors.min() <= error:
            return MEASURED
        return EXTRAPOLATED if np.isfinite(self.time_to(error)) else NEVER

    def _beyond(self, error: float, seconds: np.ndarray, errors: np.ndarray) -> float:
        """Samples by the fitted slope, each of them as long as one of the last step."""
        slope = statistics.slope(self.samples[-LAST:], errors[-LAST:])[0]
        return float(seconds[-1] * (error / errors[-1]) ** (1 / slope)) if slope < FLATTEST else np.inf

    def estimate(self, error: float) -> Estimate:
        """`time_to` with its interval."""
        return over_rounds(len(self.rounds), lambda chosen: self.time_to(error, chosen))


def ladders(rows: Iterable[Row]) -> list[Ladder]:
    """One for each method on each scene, of the rounds that all its films have."""
    found: dict[tuple[str, str], dict[str, dict[float, Row]]] = {}
    for row in rows:
        if row.parameter == "samples" and row.phase in ("render", "error") and row.each:
            found.setdefault((row.scene, row.method), {"render": {}, "error": {}})[row.phase][row.value] = row
    return [_ladder(scene, method, **steps) for (scene, method), steps in found.items() if steps["error"]]


def _ladder(scene: str, method: str, render: dict[float, Row], error: dict[float, Row]) -> Ladder:
    samples = sorted(set(render) & set(error))
    rounds = min(len(render[step].each) for step in samples)
    columns = [np.array([kind[step].each[:rounds] for step in samples]).T for kind in (render, error)]
    first = samples[0]
    return Ladder(scene, method, np.array(samples), *columns, error[first].note == DETERMINISTIC, render[first].note == SINGLE)
