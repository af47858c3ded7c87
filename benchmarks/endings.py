"""When a ladder of films has enough steps, and which films are too long."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ladders import ERRORS

FACTOR = 4  # samples of a step over those of the one before
ENOUGH = 0.5 * min(ERRORS)
SURE = 2  # successive steps that are good enough: one alone may be luck
FEWEST, PATIENCE = 5, 5  # steps that tell how the error falls, and so many times the seconds that their films may take
CLAIMED = ERRORS[1:]  # what claims are about
NEAR = (0.8, 2.5)  # times such an error, between which one more step leads beyond it, for sure or nearly


@dataclass(frozen=True)
class Limit:
    """Seconds that a film may take, and those of the film that may lead beyond a claimed error."""

    seconds: float
    last: float

    def ends(self, errors: Sequence[float], seconds: Sequence[float]) -> bool:
        """Whether these steps are enough, or the next film would take too long; errors and seconds of one film a step."""
        sure = len(errors) >= SURE and max(errors[-SURE:]) <= ENOUGH
        return sure or FACTOR * seconds[-1] > self._longest(errors)

    def _longest(self, errors: Sequence[float]) -> float:
        most = self.last if near(errors[-1]) else self.seconds
        return max(most, PATIENCE * self.seconds) if len(errors) < FEWEST else most


def near(error: float) -> bool:
    """Whether one more step may lead beyond a claimed error."""
    return any(NEAR[0] * claimed < error <= NEAR[1] * claimed for claimed in CLAIMED)
