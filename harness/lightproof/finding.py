"""What one step of a ladder comes to, judged with the step before it: the outcome, and why in words."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from lightproof import ladder
from lightproof.ladder import Rung


class Outcome(StrEnum):
    """What a verdict says."""

    PASS = "pass"
    FAIL = "fail"
    UNDECIDED = "undecided"
    UNSUPPORTED = "unsupported"
    ERROR = "error"
    NO_REFERENCE = "no-reference"


@dataclass(frozen=True)
class Finding:
    """What one step comes to; see `verdict.Verdict` for the fields."""

    outcome: Outcome
    message: str
    samples_needed: int | None = None
    biased: bool = False


def find(rung: Rung, before: Rung | None) -> Finding:
    """The outcome of one step, judged with the one before it."""
    if not rung.complete:
        return Finding(Outcome.UNDECIDED, f"{len(rung.results)} of {rung.replicates} replicates")
    if rung.declared and not rung.identical:
        return Finding(Outcome.ERROR, "the method is declared deterministic, but its films differ")
    if rung.disproves.any():
        return Finding(Outcome.ERROR, _disproof(rung))
    if rung.declared:
        return _find_noiseless(rung, before)
    if rung.repeated:
        return Finding(Outcome.ERROR, "repeated random stream: some of the replicates are identical and some are not")
    if rung.noiseless:
        return _find_identical(rung, before)
    return _find_noisy(rung, before)


def _find_identical(rung: Rung, before: Rung | None) -> Finding:
    if before is None or not before.noiseless:
        count = len(rung.results)
        return Finding(Outcome.UNDECIDED, f"all {count} films are identical: the next step tells whether the seed is ignored",
                       ladder.FACTOR * rung.samples)
    if not rung.agrees(before):
        return Finding(Outcome.ERROR, f"the seed is ignored: all films are identical at {before.samples} samples and all at"
                                      f" {rung.samples}, yet the two steps differ, so there are no replicates to judge by")
    return _find_noiseless(rung, before)


def _find_noiseless(rung: Rung, before: Rung | None) -> Finding:
    if rung.passes:
        return Finding(Outcome.PASS, _margin(rung))
    confirmed = _confirmed(rung, before) * (before is not None and rung.stopped_shrinking(before))
    if confirmed.any():
        return Finding(Outcome.FAIL, f"{_accusation(rung, confirmed)} at two steps")
    converging = before is not None and rung.votes.any()
    doubt = f"still converging: {_accusation(rung, rung.votes)}" if converging else _doubt(rung)
    needed = max(ladder.FACTOR * rung.samples, rung.unseen.max())
    hopeless = (rung.uncertainty >= rung.tolerance).any() or np.isinf(needed)
    return Finding(Outcome.UNDECIDED, doubt, None if hopeless else int(needed))


def _find_noisy(rung: Rung, before: Rung | None) -> Finding:
    if rung.passes:
        return _passed(rung, before)
    confirmed = _confirmed(rung, before)
    if confirmed.any():
        return Finding(Outcome.FAIL, f"{_accusation(rung, confirmed)} at two steps")
    needed = ladder.FACTOR * rung.samples if rung.votes.any() else rung.samples_needed
    return Finding(Outcome.UNDECIDED, _doubt(rung), needed)


def _confirmed(rung: Rung, before: Rung | None) -> np.ndarray:
    """The votes that were cast the step before as well, (J + 1 + n,)."""
    return np.zeros_like(rung.votes) if before is None else rung.votes * (rung.votes == before.votes)


def _passed(rung: Rung, before: Rung | None) -> Finding:
    side = _mean_side(rung)
    if side == 0 or before is None or before.noiseless or _mean_side(before) != side:
        return Finding(Outcome.PASS, _margin(rung))
    mean = rung.scale.tiles
    return Finding(Outcome.PASS, f"biased by {_interval(rung, mean)}, within the tolerance", biased=True)


def _mean_side(rung: Rung) -> int:
    """-1 or +1 where the film mean's interval excludes zero, else 0."""
    mean = rung.scale.tiles
    return int(np.sign(rung.bias[mean])) if abs(rung.bias[mean]) > rung.half_width[mean] else 0


def _margin(rung: Rung) -> str:
    margin = f"every tile within {100 * rung.reach[:rung.scale.tiles + 1].max():.2g} % of the exact light"
    proven = rung.bound.max()
    return f"{margin}, every element within {100 * proven:.2g} % by the method's own proof" if np.isfinite(proven) else margin


def _accusation(rung: Rung, votes: np.ndarray) -> str:
    """What is off: the film's mean where it votes, else the interval farthest out."""
    mean = rung.scale.tiles
    worst = mean if votes[mean] else int(np.argmax(np.abs(votes) * (np.abs(rung.bias) - rung.half_width)))
    tiles = f" ({np.count_nonzero(votes[:mean])} of {mean} tiles are)" if votes[:mean].any() else ""
    return f"{rung.scale.place(worst)} is off by {_interval(rung, worst)}{tiles}"


def _doubt(rung: Rung) -> str:
    tiles = rung.scale.tiles
    if rung.votes.any():
        return f"unconfirmed: {_accusation(rung, rung.votes)} at one step"
    if rung.unseen.any():
        return _blindness(rung)
    if rung.unlit[:tiles].any():
        return f"no sample has reached the light in {np.count_nonzero(rung.unlit[:tiles])} of {tiles} tiles"
    worst = int(np.argmax(rung.reach[:tiles + 1]))
    if rung.uncertainty[worst] >= rung.tolerance:
        blur = f"±{100 * rung.uncertainty[worst]:.2g} %"
        return f"no number of samples decides: the output's steps leave {blur}, tolerance {100 * rung.tolerance:g} %"
    return f"{rung.scale.place(worst)} is off by {_interval(rung, worst)}, tolerance {100 * rung.tolerance:g} %"


def _blindness(rung: Rung) -> str:
    """What lies outside the tolerance, and why its scatter proves nothing."""
    worst = int(np.argmax(rung.unseen))
    leap = "without bound" if np.isinf(rung.leap[worst]) else f"by up to {100 * rung.leap[worst]:.2g} %"
    return (f"{rung.scale.place(worst)} is off by {_interval(rung, worst)}, yet a single sample could move it {leap}, so that"
            " what no sample met cannot be told from what is not there; directions into the light, as mc-solid-angle draws them,"
            " weigh 4 pi L at most")


def _disproof(rung: Rung) -> str:
    """Where a method's own bound of its error does not hold."""
    worst = int(np.argmax(rung.disproves * np.abs(rung.errors).max(axis=0)))
    place = rung.scale.place(rung.scale.tiles + 1 + worst)
    off = 100 * rung.errors[:, worst][np.argmax(np.abs(rung.errors[:, worst]))]
    return f"{place} is off by {off:+.3g} %, which the method says it proves to be {100 * rung.bound[worst]:.2g} % at most"


def _interval(rung: Rung, index: int) -> str:
    return f"{100 * rung.bias[index]:+.3g} ± {100 * rung.half_width[index]:.2g} %"
